/* SPDX-License-Identifier: MIT OR Apache-2.0 */
/* How many cycles a frame takes from one answer to the next, one at a time and through the queue, on the simulated core:
 *
 *   rate_simulated CORE.so [SOFTWARE [ACCESS [STEP]]]
 *
 * SOFTWARE cycles pass for each frame while the processor writes it and reads its answer (250), ACCESS for each access to
 * a register of the DMA (25), STEP from a transfer's start to its first beat, and to fetch or close a descriptor (40). */
#include "machine.h"
#include "sptfra.h"
#include "sptfra_queue.h"

#include <stdio.h>
#include <stdlib.h>

#define POLLS 1000000u
#define SETTLE 40u  /* frames until a queue has settled */
#define COUNTED 200u

_Alignas(SPTFRA_LINE) static unsigned char bytes[1u << 22];

static int fail(const char *what, int code)
{
    fprintf(stderr, "%s: %s\n", what, sptfra_error(code));
    return 0;
}

/* Frames of no stress, one after the other; cycles of a frame, 0 after a message. */
static uint64_t one_at_a_time(machine *system, sptfra *device, uint32_t software)
{
    const uint64_t bus = (uintptr_t)bytes + MACHINE_BUS_OFFSET;
    const sptfra_buffer stress = {bytes, bus, sizeof bytes / 2u};
    const sptfra_buffer forces = {bytes + sizeof bytes / 2u, bus + sizeof bytes / 2u, sizeof bytes / 2u};
    uint64_t begin = 0;
    uint32_t frame;

    for (frame = 0; frame < SETTLE + COUNTED; frame++) {
        int code;

        if (frame == SETTLE) {
            begin = machine_cycles(system);
        }
        machine_run(system, software);
        code = sptfra_process(device, &stress, &forces, POLLS);
        if (code != SPTFRA_OK) {
            return (uint64_t)fail("frame", code);
        }
    }
    return (machine_cycles(system) - begin) / COUNTED;
}

/* The same with as many on their way as a queue takes. */
static uint64_t through_queue(machine *system, sptfra *device, uint32_t depth, uint32_t software)
{
    const sptfra_buffer memory = {bytes, (uintptr_t)bytes + MACHINE_BUS_OFFSET, sizeof bytes};
    sptfra_queue queue;
    const void *answer;
    uint64_t begin = 0;
    uint32_t frame;
    int code = sptfra_queue_open(&queue, device, &memory, depth);

    for (frame = 0; frame < SETTLE + COUNTED && code == SPTFRA_OK; frame++) {
        if (frame == SETTLE) {
            begin = machine_cycles(system);
        }
        while (sptfra_queue_room(&queue) != NULL && code == SPTFRA_OK) {
            machine_run(system, software);
            code = sptfra_queue_send(&queue);
        }
        code = code == SPTFRA_OK ? sptfra_queue_take(&queue, &answer, POLLS) : code;
    }
    return code == SPTFRA_OK ? (machine_cycles(system) - begin) / COUNTED : (uint64_t)fail("queue", code);
}

/* A core anew, with the DMA's registers and steps as slow as said. */
static machine *opened(sptfra *device, const char *library, int queued, uint32_t access, uint32_t step)
{
    sptfra_platform platform = {NULL, machine_read, machine_write, NULL, NULL, NULL};
    machine *system = machine_open(library, 1u, 1);
    int code;

    if (system == NULL) {
        return NULL;
    }
    platform.context = system;
    machine_even(system, access, step);
    if (queued) {
        machine_scatter_gather(system);
    }
    code = sptfra_open(device, &platform, MACHINE_CORE, MACHINE_DMA);
    if (code != SPTFRA_OK) {
        fail("core", code);
        machine_close(system);
        return NULL;
    }
    return system;
}

static uint32_t number(int count, char **arguments, int index, uint32_t otherwise)
{
    return index < count ? (uint32_t)strtoul(arguments[index], NULL, 10) : otherwise;
}

int main(int count, char **arguments)
{
    static const uint32_t depths[] = {0, 2, 4, 8, 16};
    const uint32_t software = number(count, arguments, 2, 250), access = number(count, arguments, 3, 25);
    const uint32_t step = number(count, arguments, 4, 40);
    sptfra_identity identity;
    size_t index;

    if (count < 2 || count > 5) {
        fprintf(stderr, "usage: %s CORE.so [SOFTWARE [ACCESS [STEP]]]\n", arguments[0]);
        return 2;
    }
    for (index = 0; index < sizeof depths / sizeof depths[0]; index++) {
        sptfra device;
        machine *system = opened(&device, arguments[1], depths[index] > 0, access, step);
        uint64_t cycles;

        if (system == NULL) {
            return 1;
        }
        if (index == 0) {
            sptfra_identify(&device, &identity);
            printf("interval %u\n", identity.interval_cycles);
        }
        cycles = depths[index] == 0 ? one_at_a_time(system, &device, software)
                                    : through_queue(system, &device, depths[index], software);
        machine_close(system);
        if (cycles == 0) {
            return 1;
        }
        if (depths[index] == 0) {
            printf("one at a time %llu\n", (unsigned long long)cycles);
        } else {
            printf("queue of %u %llu\n", depths[index], (unsigned long long)cycles);
        }
    }
    return 0;
}
