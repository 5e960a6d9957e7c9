// SPDX-License-Identifier: MIT OR Apache-2.0
/* The queue of the C driver against the simulated core and a DMA with descriptors: frames at random moments, errors and
 * resets of the DMA, and the account of every frame.
 *
 *   queue CORE.so REGISTERS FRAMES COLUMNS ROWS WORDS_OUT HAS_FIELD STREAM_BYTES SAMPLES
 *
 * As host.c. */
#include "check.h"
#include "machine.h"
#include "sptfra.h"
#include "sptfra_queue.h"
#include "sptfra_registers.h"

#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MOST_WORDS 4096
#define MOST_FRAMES 32
#define POLLS 100000u
#define RECOVERY 1000u
#define STEPS 2500
#define DMA_STEP 60u
#define EVENTS 0x7000u /* interrupts of the DMA's status */

static uint32_t frames[MOST_FRAMES][MOST_WORDS], answers[MOST_FRAMES][MOST_WORDS];
static int frame_count;
_Alignas(SPTFRA_LINE) static unsigned char bytes[1u << 20];
static uint32_t noise = 5;

/* What the queue should hold: indices of frames, the oldest first. */
static int expected[SPTFRA_MOST_QUEUED];
static uint32_t waiting;

static uint32_t random_below(uint32_t limit)
{
    noise = noise * 1664525u + 1013904223u;
    return (noise >> 8) % limit;
}

static void lines(void *context, const void *start, size_t count)
{
    (void)context;
    CHECK((uintptr_t)start % SPTFRA_LINE == 0 && count % SPTFRA_LINE == 0);
}

/* The registers of a core that drops frames. */
static uint32_t read_dropping(void *system, uintptr_t address)
{
    const uint32_t word = machine_read(system, address);

    return address == MACHINE_CORE + offsetof(sptfra_t, FEATURES) ? word | SPTFRA__FEATURES__DROPS_bm : word;
}

static void lines_back(void *context, void *start, size_t count) { lines(context, start, count); }

/* The frames that are whole. */
static void load(const char *path, const sptfra_shape *shape)
{
    FILE *file = fopen(path, "rb");
    uint32_t words;

    CHECK(file != NULL);
    while (fread(&words, 4, 1, file) == 1) {
        CHECK(words < MOST_WORDS && fread(frames[frame_count], 4, words, file) == words);
        CHECK(fread(answers[frame_count], 4, shape->words_out, file) == shape->words_out);
        frame_count += words == shape->words_in;
    }
    fclose(file);
    CHECK(frame_count > 10 && frame_count <= MOST_FRAMES);
}

static void send(sptfra_queue *queue, const sptfra_shape *shape)
{
    const int frame = (int)random_below((uint32_t)frame_count);
    void *room = sptfra_queue_room(queue);

    CHECK(room != NULL);
    memcpy(room, frames[frame], 4u * (size_t)shape->words_in);
    CHECK(sptfra_queue_send(queue) == SPTFRA_OK);
    expected[waiting++] = frame;
}

/* The answer is that to the oldest frame, word by word, and the queue still has that frame. */
static void check(const sptfra_queue *queue, const sptfra_shape *shape, const uint32_t *answer)
{
    const uint32_t *words = answers[expected[0]];
    const void *frame = sptfra_queue_frame(queue);

    CHECK((answer[0] & 0xFFFFu) == (words[0] & 0xFFFFu));
    CHECK(memcmp(answer + 2, words + 2, 4u * (shape->words_out - 2u)) == 0);
    CHECK(frame != NULL && memcmp(frame, frames[expected[0]], 4u * (size_t)shape->words_in) == 0);
    waiting--;
    memmove(expected, expected + 1, waiting * sizeof expected[0]);
}

int main(int count, char **arguments)
{
    static const uint32_t errors[] = {1u << 4, 1u << 5, 1u << 6, 1u << 8};
    sptfra_buffer memory = {bytes, (uintptr_t)bytes + MACHINE_BUS_OFFSET, sizeof bytes};
    sptfra_platform platform = {NULL, machine_read, machine_write, lines, lines_back, NULL};
    uint32_t depth, step, lost, sent = 0, taken = 0, missing = 0, recoveries = 0, most = 0;
    sptfra_shape shape = {0};
    sptfra_queue queue;
    sptfra device;
    machine *system;
    const void *answer;
    int has_registers, code;

    CHECK(count == 10);
    has_registers = atoi(arguments[2]);
    shape.columns = (uint16_t)atoi(arguments[4]);
    shape.rows = (uint16_t)atoi(arguments[5]);
    shape.words_out = (uint16_t)atoi(arguments[6]);
    shape.has_field = (uint8_t)atoi(arguments[7]);
    shape.stream_bytes = (uint8_t)atoi(arguments[8]);
    shape.samples = (uint8_t)atoi(arguments[9]);
    shape.words_in = (uint16_t)((sptfra_frame_bytes(&shape) + shape.stream_bytes - 1u) / shape.stream_bytes);
    shape.words_in = (uint16_t)(shape.words_in * shape.stream_bytes / 4u);
    load(arguments[3], &shape);
    system = machine_open(arguments[1], 7, has_registers);
    CHECK(system != NULL);
    platform.context = system;

    /* A DMA without descriptors has no queue. */
    CHECK((has_registers ? sptfra_open(&device, &platform, MACHINE_CORE, MACHINE_DMA)
                         : sptfra_open_streams(&device, &platform, MACHINE_DMA, &shape)) == SPTFRA_OK);
    CHECK(sptfra_queue_open(&queue, &device, &memory, 4) == SPTFRA_NO_QUEUE);
    machine_scatter_gather(system);
    machine_dma_cycles(system, DMA_STEP);
    CHECK(sptfra_reset_dma(&device, POLLS) == SPTFRA_OK);
    /* And one with descriptors nothing else. */
    CHECK(sptfra_start(&device, &memory, &memory) == SPTFRA_QUEUE_ONLY);
    CHECK(sptfra_recover(&device, &memory, &memory, RECOVERY) == SPTFRA_QUEUE_ONLY);
    for (depth = 0; depth < 2; depth++) {
        CHECK(sptfra_queue_open(&queue, &device, &memory, depth) == SPTFRA_BAD_BUFFER);
    }
    memory.address += 4;
    CHECK(sptfra_queue_open(&queue, &device, &memory, 2) == SPTFRA_BAD_BUFFER);
    memory.address -= 4;
    memory.bytes = sptfra_queue_bytes(&shape, 3) - 1u;
    CHECK(sptfra_queue_open(&queue, &device, &memory, 3) == SPTFRA_BAD_BUFFER);
    /* One that was not opened answers, too. */
    CHECK(sptfra_queue_take(&queue, &answer, 0) == SPTFRA_BUSY && sptfra_queue_room(&queue) == NULL);
    CHECK(sptfra_queue_recover(&queue, RECOVERY, &lost) == SPTFRA_BAD_BUFFER && lost == 0);
    sptfra_queue_acknowledge(&queue);
    CHECK(sptfra_soft_reset(&device, POLLS) == (has_registers ? SPTFRA_QUEUE_ONLY : SPTFRA_NO_REGISTERS));
    memory.bytes = sizeof bytes;
    device.platform.read = read_dropping;
    CHECK(!has_registers || sptfra_queue_open(&queue, &device, &memory, 4) == SPTFRA_DROPS);
    device.platform.read = machine_read;

    for (depth = 2; depth <= 9; depth += depth == 2 ? 1 : 6) {
        memory.bytes = sptfra_queue_bytes(&shape, depth);
        /* Behind it nothing is written. */
        memset(bytes + memory.bytes, 0x5A, SPTFRA_LINE);
        CHECK(sptfra_queue_open(&queue, &device, &memory, depth) == SPTFRA_OK);
        CHECK(sptfra_queue_take(&queue, &answer, 0) == SPTFRA_NOT_STARTED);
        /* As after four thousand million frames. */
        queue.sent = queue.taken = 0xFFFFFFF0u;
        for (step = 0; step < STEPS; step++) {
            const uint32_t what = random_below(400);

            if (what < 180 && sptfra_queue_room(&queue) != NULL) {
                send(&queue, &shape);
                sent++;
            } else if (what < 180) {
                CHECK(sptfra_queue_send(&queue) == SPTFRA_BUSY);
            } else if (what < 200) {
                machine_run(system, random_below(500));
            } else if (what == 200) {
                machine_fail(system, (int)random_below(2), errors[random_below(4)]);
            } else if (what == 201) {
                /* Somebody else resets the DMA. */
                machine_write(system, MACHINE_DMA, 4u);
            }
            most = waiting > most ? waiting : most;
            CHECK(sptfra_queue_length(&queue) == waiting);
            if (what < 300) {
                continue;
            }
            code = sptfra_queue_take(&queue, &answer, what < 310 ? 0 : POLLS);
            if (code == SPTFRA_OK) {
                check(&queue, &shape, answer);
                taken++;
                continue;
            }
            if (code == SPTFRA_NOT_STARTED) {
                CHECK(waiting == 0);
                continue;
            }
            if (code == SPTFRA_TIMEOUT && what < 310) {
                continue;
            }
            CHECK(code == SPTFRA_DMA_FAULT);
            CHECK(sptfra_queue_room(&queue) == NULL && sptfra_queue_take(&queue, &answer, 1) == SPTFRA_BUSY);
            CHECK(sptfra_queue_recover(&queue, RECOVERY, &lost) == SPTFRA_OK);
            CHECK(lost == waiting && sptfra_queue_length(&queue) == 0);
            missing += lost;
            waiting = 0;
            recoveries++;
        }
        CHECK(sptfra_queue_recover(&queue, RECOVERY, &lost) == SPTFRA_OK && lost == waiting);
        missing += lost;
        waiting = 0;
        /* Nothing is on its way after this one: its interrupts are the last. */
        send(&queue, &shape);
        sent++;
        CHECK(sptfra_queue_take(&queue, &answer, POLLS) == SPTFRA_OK);
        check(&queue, &shape, answer);
        taken++;
        CHECK((machine_read(system, MACHINE_DMA + 0x04) & machine_read(system, MACHINE_DMA + 0x34) & EVENTS) != 0);
        sptfra_queue_acknowledge(&queue);
        CHECK(((machine_read(system, MACHINE_DMA + 0x04) | machine_read(system, MACHINE_DMA + 0x34)) & EVENTS) == 0);
        for (step = 0; step < SPTFRA_LINE; step++) {
            CHECK(bytes[memory.bytes + step] == 0x5A);
        }
    }
    CHECK(sent == taken + missing && most == 9 && recoveries > 15 && taken > 600);
    /* An answer that somebody took away: the next one is not taken for it. */
    send(&queue, &shape);
    device.next_number++;
    CHECK(!has_registers || sptfra_queue_take(&queue, &answer, POLLS) == SPTFRA_OUT_OF_STEP);
    CHECK(sptfra_queue_recover(&queue, RECOVERY, &lost) == SPTFRA_OK && lost == 1);
    /* One that says that frames were dropped, of a core without registers: nobody knows whose it is. */
    send(&queue, &shape);
    machine_run(system, POLLS);
    *(uint32_t *)(bytes + queue.forces + queue.next_out * queue.stride_out) |= SPTFRA_DROPPED;
    CHECK(sptfra_queue_take(&queue, &answer, 0) == SPTFRA_OUT_OF_STEP);
    CHECK(sptfra_queue_recover(&queue, RECOVERY, &lost) == SPTFRA_OK && lost == 1);
    CHECK(machine_faults(system) == 0);
    machine_close(system);
    printf("PASS: %u frames, %u lost and reported in %u recoveries\n", sent, missing, recoveries);
    return 0;
}
