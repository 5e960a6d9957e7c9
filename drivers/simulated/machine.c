/* SPDX-License-Identifier: MIT OR Apache-2.0 */
/* See machine.h. The core is the shared object that the testbench builds, driven through its C interface. */
#include "machine.h"

#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define RUN (UINT64_C(1) << 35)
#define READY (UINT64_C(1) << 34)
#define LAST (UINT64_C(1) << 33)
#define VALID (UINT64_C(1) << 32)
#define FAILED (UINT64_C(1) << 63)
#define PATIENCE 1000
#define MOST_WORDS 4 /* of a beat */

/* One channel of the DMA. */
struct channel {
    uint32_t control, status, address, address_high, length;
    uint32_t moved; /* bytes */
    int busy;
};

struct machine {
    void *library, *core;
    uint32_t words; /* of a beat */
    uint64_t (*step)(void *, uint64_t, const uint32_t *, uint32_t *, char *, size_t);
    void (*drive)(void *, uint32_t, uint32_t, uint32_t);
    uint64_t (*port)(void *);
    void (*discard)(void *);
    struct channel send, receive;
    int has_registers;
    int offering; /* a beat is on offer and stays until taken */
    uint32_t noise, faults;
    int interrupt;
};

/* Halted, idle. */
static void reset_channel(struct channel *channel)
{
    memset(channel, 0, sizeof *channel);
    channel->status = 1;
}

static uint32_t *memory(const struct channel *channel)
{
    const uint64_t bus = (uint64_t)channel->address_high << 32 | channel->address;

    return (uint32_t *)(uintptr_t)(bus - MACHINE_BUS_OFFSET + channel->moved);
}

static void finish(struct channel *channel)
{
    channel->busy = 0;
    channel->length = channel->moved;
    channel->status |= 0x1002; /* idle, interrupt on completion */
}

static void cycle(struct machine *system, int run)
{
    char text[256];
    uint64_t inputs = run ? RUN : 0, outputs;
    uint32_t in[MOST_WORDS], out[MOST_WORDS], word, last_word = 0;
    int ready;

    system->noise = system->noise * 1664525u + 1013904223u;
    /* Both ends pause now and then, but a beat on offer stays. */
    system->offering = run && system->send.busy && (system->offering || (system->noise >> 28) != 0);
    ready = run && system->receive.busy && (system->noise >> 24 & 3) != 0;
    /* What fills the last beat behind the transfer is not known. */
    memset(in, 0xFF, sizeof in);
    if (system->offering) {
        const uint32_t left = (system->send.length - system->send.moved) / 4;

        last_word = left < system->words ? left : system->words;
        memcpy(in, memory(&system->send), 4 * last_word);
        inputs |= VALID | (left <= system->words ? LAST : 0);
    }
    inputs |= ready ? READY : 0;
    outputs = system->step(system->core, inputs, in, out, text, sizeof text);
    if (outputs & FAILED) {
        fprintf(stderr, "machine: %s\n", text);
        exit(2);
    }
    if (system->offering && (outputs & READY)) {
        system->offering = 0;
        system->send.moved += 4 * last_word;
        if (system->send.moved == system->send.length) {
            finish(&system->send);
        }
    }
    if (ready && (outputs & VALID)) {
        for (word = 0; word < system->words && (outputs >> (4 * word) & 1) && system->receive.moved < system->receive.length;
             word++) {
            *memory(&system->receive) = out[word];
            system->receive.moved += 4;
        }
        if (outputs & LAST) {
            finish(&system->receive);
        } else if (system->receive.moved == system->receive.length) {
            /* A packet longer than the transfer stops the DMA with an internal error. */
            finish(&system->receive);
            system->receive.status |= 0x11;
        }
    }
    system->interrupt = system->has_registers && run && (system->port(system->core) >> 37 & 1);
}

machine *machine_open(const char *library, uint32_t seed, int has_registers)
{
    char text[256] = "";
    struct machine *system = calloc(1, sizeof *system);
    void *(*create)(uint32_t, char *, size_t);
    uint32_t (*words)(void);
    int index;

    /* A name without a folder would be looked for among the system's libraries. */
    snprintf(text, sizeof text, "./%s", library);
    system->library = dlopen(strchr(library, '/') == NULL ? text : library, RTLD_NOW | RTLD_LOCAL);
    text[0] = '\0';
    if (system->library == NULL) {
        fprintf(stderr, "machine: %s\n", dlerror());
        free(system);
        return NULL;
    }
    *(void **)&create = dlsym(system->library, "dut_new");
    *(void **)&words = dlsym(system->library, "dut_words");
    *(void **)&system->step = dlsym(system->library, "dut_step");
    *(void **)&system->drive = dlsym(system->library, "dut_drive_control");
    *(void **)&system->port = dlsym(system->library, "dut_read_control");
    *(void **)&system->discard = dlsym(system->library, "dut_delete");
    system->words = words();
    system->core = create(seed, text, sizeof text);
    if (system->core == NULL) {
        fprintf(stderr, "machine: %s\n", text);
        dlclose(system->library);
        free(system);
        return NULL;
    }
    system->has_registers = has_registers;
    system->noise = seed;
    reset_channel(&system->send);
    reset_channel(&system->receive);
    for (index = 0; index < 8; index++) {
        cycle(system, 0);
    }
    return system;
}

void machine_close(machine *system)
{
    system->discard(system->core);
    dlclose(system->library);
    free(system);
}

void machine_run(machine *system, uint64_t cycles)
{
    while (cycles-- > 0) {
        cycle(system, 1);
    }
}

int machine_interrupt(const machine *system) { return system->interrupt; }

int machine_sends(const machine *system) { return system->send.busy; }

uint32_t machine_faults(const machine *system) { return system->faults; }

/* One access on the register port: address and data of a write together, then the reply. */
static uint32_t access_core(struct machine *system, uint32_t offset, int is_write, uint32_t value)
{
    int address_taken = 0, data_taken = !is_write, wait;

    for (wait = 0; wait < PATIENCE; wait++) {
        uint32_t flags;
        uint64_t port;

        if (is_write) {
            flags = (uint32_t)!address_taken | (uint32_t)!data_taken << 1 | 1u << 2 | 0xFu << 8;
        } else {
            flags = (uint32_t)!address_taken << 3 | 1u << 4;
        }
        system->drive(system->core, offset | offset << 16, value, flags);
        cycle(system, 1);
        port = system->port(system->core);
        if (is_write && address_taken && data_taken && (port >> 34 & 1)) {
            system->faults += (port >> 40 & 3) != 0;
            break;
        }
        if (!is_write && address_taken && (port >> 36 & 1)) {
            system->faults += (port >> 42 & 3) != 0;
            value = (uint32_t)port;
            break;
        }
        address_taken |= (int)(port >> (is_write ? 32 : 35) & 1);
        data_taken |= (int)(port >> 33 & 1);
    }
    system->faults += wait == PATIENCE;
    system->drive(system->core, 0, 0, 0);
    return value;
}

static uint32_t *dma_register(struct machine *system, uint32_t offset)
{
    struct channel *channel = offset < 0x30 ? &system->send : &system->receive;

    switch (offset < 0x30 ? offset : offset - 0x30) {
    case 0x00: return &channel->control;
    case 0x04: return &channel->status;
    case 0x18: return &channel->address;
    case 0x1C: return &channel->address_high;
    case 0x28: return &channel->length;
    default: return NULL;
    }
}

static void write_dma(struct machine *system, uint32_t offset, uint32_t value)
{
    struct channel *channel = offset < 0x30 ? &system->send : &system->receive;
    uint32_t *target = dma_register(system, offset);

    if (target == NULL) {
        system->faults++;
    } else if (target == &channel->control && (value & 4)) {
        reset_channel(&system->send);
        reset_channel(&system->receive);
    } else if (target == &channel->control) {
        channel->control = value;
        channel->status = (channel->status & ~1u) | !(value & 1);
    } else if (target == &channel->status) {
        channel->status &= ~(value & 0x7000);
    } else if (target == &channel->length) {
        /* Only a running channel without a transfer takes one, from where a beat may begin. */
        if ((channel->status & 1) || channel->busy || value == 0 || channel->address % (4 * system->words) != 0) {
            system->faults++;
            return;
        }
        channel->length = value;
        channel->moved = 0;
        channel->busy = 1;
        channel->status &= ~2u;
    } else {
        *target = value;
    }
}

uint32_t machine_read(void *context, uintptr_t address)
{
    struct machine *system = context;
    uint32_t *source;

    if (address >= MACHINE_CORE && address < MACHINE_CORE + 0x1000u && system->has_registers) {
        return access_core(system, (uint32_t)(address - MACHINE_CORE), 0, 0);
    }
    machine_run(system, 3);
    source = address >= MACHINE_DMA && address < MACHINE_DMA + 0x60u
        ? dma_register(system, (uint32_t)(address - MACHINE_DMA)) : NULL;
    system->faults += source == NULL;
    return source == NULL ? 0 : *source;
}

void machine_write(void *context, uintptr_t address, uint32_t value)
{
    struct machine *system = context;

    if (address >= MACHINE_CORE && address < MACHINE_CORE + 0x1000u && system->has_registers) {
        access_core(system, (uint32_t)(address - MACHINE_CORE), 1, value);
        return;
    }
    machine_run(system, 3);
    if (address >= MACHINE_DMA && address < MACHINE_DMA + 0x60u) {
        write_dma(system, (uint32_t)(address - MACHINE_DMA), value);
    } else {
        system->faults++;
    }
}
