/* SPDX-License-Identifier: MIT OR Apache-2.0 */
/* See machine.h. The core is the shared object that the testbench builds, driven through its C interface. */
#include "machine.h"

#include "dma.h"

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

struct machine {
    void *library, *core;
    uint32_t words; /* of a beat */
    uint64_t (*step)(void *, uint64_t, const uint32_t *, uint32_t *, char *, size_t);
    void (*drive)(void *, uint32_t, uint32_t, uint32_t);
    uint64_t (*port)(void *);
    void (*discard)(void *);
    dma dma;
    uint64_t cycles;
    uint32_t access; /* cycles of an access to the DMA's registers */
    int even;        /* neither end of the streams pauses */
    int has_registers;
    int offering; /* a beat is on offer and stays until taken */
    uint32_t noise, faults;
    int interrupt;
};

static void cycle(struct machine *system, int run)
{
    char text[256];
    uint64_t inputs = run ? RUN : 0, outputs;
    uint32_t in[MOST_WORDS], out[MOST_WORDS], word, last_word = 0;
    const dma_channel *send = &system->dma.channels[DMA_SEND], *receive = &system->dma.channels[DMA_RECEIVE];
    int ready;

    system->cycles++;
    if (run) {
        dma_cycle(&system->dma);
    }
    system->noise = system->noise * 1664525u + 1013904223u;
    /* Both ends pause now and then, but a beat on offer stays. */
    system->offering = run && send->busy && (system->offering || system->even || (system->noise >> 28) != 0);
    ready = run && receive->busy && (system->even || (system->noise >> 24 & 3) != 0);
    /* What fills the last beat behind the transfer is not known. */
    memset(in, 0xFF, sizeof in);
    if (system->offering) {
        const uint32_t left = (send->bytes - send->moved) / 4;

        last_word = left < system->words ? left : system->words;
        memcpy(in, dma_memory(&system->dma, DMA_SEND), 4 * last_word);
        inputs |= VALID | (left <= system->words && send->at_end ? LAST : 0);
    }
    inputs |= ready ? READY : 0;
    outputs = system->step(system->core, inputs, in, out, text, sizeof text);
    if (outputs & FAILED) {
        fprintf(stderr, "machine: %s\n", text);
        exit(2);
    }
    if (system->offering && (outputs & READY)) {
        system->offering = 0;
        dma_moved(&system->dma, DMA_SEND, 4 * last_word, 0);
    }
    if (ready && (outputs & VALID)) {
        for (word = 0; word < system->words && (outputs >> (4 * word) & 1); word++) {
            if (receive->moved + 4 * word < receive->bytes) {
                dma_memory(&system->dma, DMA_RECEIVE)[word] = out[word];
            }
        }
        if (receive->moved + 4 * word > receive->bytes) {
            word = (receive->bytes - receive->moved) / 4;
        }
        dma_moved(&system->dma, DMA_RECEIVE, 4 * word, (outputs & LAST) != 0);
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
    system->access = 3;
    system->dma.noise = seed;
    system->dma.beat = 4 * system->words;
    system->dma.offset = MACHINE_BUS_OFFSET;
    dma_reset(&system->dma);
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

int machine_sends(const machine *system) { return system->dma.channels[DMA_SEND].busy; }

uint32_t machine_faults(const machine *system) { return system->faults + system->dma.faults; }

uint64_t machine_cycles(const machine *system) { return system->cycles; }

void machine_scatter_gather(machine *system)
{
    system->dma.scatter_gather = 1;
    dma_reset(&system->dma);
}

void machine_dma_cycles(machine *system, uint32_t most) { system->dma.step = most; }

void machine_even(machine *system, uint32_t access, uint32_t step)
{
    system->even = system->dma.even = 1;
    system->access = access;
    system->dma.step = step;
}

void machine_fail(machine *system, int receiving, uint32_t error)
{
    dma_fail(&system->dma, receiving ? DMA_RECEIVE : DMA_SEND, error);
}

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

static int is_dma(uintptr_t address) { return address >= MACHINE_DMA && address < MACHINE_DMA + 0x60u; }

uint32_t machine_read(void *context, uintptr_t address)
{
    struct machine *system = context;

    if (address >= MACHINE_CORE && address < MACHINE_CORE + 0x1000u && system->has_registers) {
        return access_core(system, (uint32_t)(address - MACHINE_CORE), 0, 0);
    }
    machine_run(system, system->access);
    if (!is_dma(address)) {
        system->faults++;
        return 0;
    }
    return dma_read(&system->dma, (uint32_t)(address - MACHINE_DMA));
}

void machine_write(void *context, uintptr_t address, uint32_t value)
{
    struct machine *system = context;

    if (address >= MACHINE_CORE && address < MACHINE_CORE + 0x1000u && system->has_registers) {
        access_core(system, (uint32_t)(address - MACHINE_CORE), 1, value);
        return;
    }
    machine_run(system, system->access);
    if (is_dma(address)) {
        dma_write(&system->dma, (uint32_t)(address - MACHINE_DMA), value);
    } else {
        system->faults++;
    }
}
