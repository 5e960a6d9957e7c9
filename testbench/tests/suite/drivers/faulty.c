// SPDX-License-Identifier: MIT OR Apache-2.0
/* The desk of the examples, with a DMA that stops in the middle of a frame. When the program has done with it, one more
 * frame goes through: what the fault left behind must be gone.
 *
 *   faulty CORE.so AT RECEIVING ERROR CYCLES WAKES < FRAMES
 *
 * AT: the frame, from 1 on. RECEIVING: which channel stops. ERROR: the bit of its status. CYCLES: from the frame's start
 * on. WAKES: whether an interrupt comes all the same. */
#define system_usage desk_usage
#define system_arguments desk_arguments
#define system_open desk_open
#define system_wait desk_wait
#define system_close desk_close
#include "simulated.c"
#undef system_usage
#undef system_arguments
#undef system_open
#undef system_wait
#undef system_close

#include "check.h"
#include "sptfra_queue.h"

#include <stdlib.h>
#include <string.h>

const char system_usage[] = "CORE.so AT RECEIVING ERROR CYCLES WAKES ";
const int system_arguments = 6;

int system_open(sptfra *device, sptfra_buffer *memory, const system_options *options, char **arguments);
int system_wait(void);
void system_close(void);

static sptfra *opened;
static sptfra_buffer *room;
static int at, receiving, error, cycles, wakes, frame;

int system_open(sptfra *device, sptfra_buffer *memory, const system_options *options, char **arguments)
{
    int *const numbers[] = {&at, &receiving, &error, &cycles, &wakes};
    int index;

    for (index = 0; index < 5; index++) {
        *numbers[index] = atoi(arguments[index + 1]);
    }
    opened = device;
    room = memory;
    return desk_open(device, memory, options, arguments);
}

int system_wait(void)
{
    frame++;
    if (frame != at) {
        return desk_wait();
    }
    machine_run(system_machine, (uint64_t)cycles);
    machine_fail(system_machine, receiving, (uint32_t)error);
    return wakes ? SPTFRA_OK : SPTFRA_TIMEOUT;
}

void system_close(void)
{
    const size_t in = (4u * (size_t)opened->shape.words_in + SPTFRA_LINE - 1u) / SPTFRA_LINE * SPTFRA_LINE;
    const sptfra_buffer stress = {room->data, room->address, in};
    const sptfra_buffer forces = {(char *)room->data + in, room->address + in, room->bytes - in};
    const void *answer = forces.data;
    sptfra_queue queue;
    sptfra_result result;

    if (opened->scatter_gather) {
        CHECK(sptfra_queue_open(&queue, opened, room, SPTFRA_LEAST_QUEUED) == SPTFRA_OK);
        memset(sptfra_queue_room(&queue), 0, in);
        CHECK(sptfra_queue_send(&queue) == SPTFRA_OK);
        CHECK(sptfra_queue_take(&queue, &answer, 100000u) == SPTFRA_OK);
    } else {
        memset(room->data, 0, in);
        CHECK(sptfra_process(opened, &stress, &forces, 100000u) == SPTFRA_OK);
    }
    CHECK(sptfra_decode(&opened->shape, answer, &result) == SPTFRA_OK);
    CHECK(result.status == 1u);
    CHECK(machine_faults(system_machine) == 0);
    printf("afterwards: no contact\n");
    desk_close();
}
