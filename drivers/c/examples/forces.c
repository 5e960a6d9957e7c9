/* SPDX-License-Identifier: MIT OR Apache-2.0 */
/* Frames in, forces out: a line of values (pascals, or counts) for each frame of FRAMES or of standard input becomes a
 * line of forces on standard output.
 *
 *   forces_linux FRAMES                on the board, through /dev/uio* and u-dma-buf
 *   forces_simulated CORE.so FRAMES    on the desk, through the simulated core
 *   ... --queue N                      N frames on their way at a time, by a DMA with descriptors. Lines come when so many
 *                                      frames were read, or all of them
 *   ... --metadata metadata.json       of a core without registers (control = false): what the design is */
#define _POSIX_C_SOURCE 200809L
#include "metadata.h"
#include "sptfra_queue.h"
#include "system.h"
#include "text.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A simulated frame is soon there; on the board the interrupt has come before anybody asks. */
#ifndef POLLS
#define POLLS 1000000u
#endif

static size_t whole_lines(size_t bytes) { return (bytes + SPTFRA_LINE - 1u) / SPTFRA_LINE * SPTFRA_LINE; }

static int fail(const char *what, int code)
{
    fprintf(stderr, "%s: %s%s%s\n", what, sptfra_error(code), code == SPTFRA_SYSTEM ? ": " : "",
        code == SPTFRA_SYSTEM ? strerror(errno) : "");
    return 0;
}

/* ---- Frames in */

typedef struct {
    FILE *file;
    char *line;
    size_t room;
    unsigned long number; /* of the line */
    int seen;             /* a line that was a frame or might have been one */
    int good;             /* no line so far that is no frame */
} source;

/* The next line that holds a frame, as words; 0 at the end, or after a message. */
static int next_frame(source *frames, const sptfra_shape *shape, void *words)
{
    const size_t taxels = (size_t)shape->columns * shape->rows;

    while (frames->good && getline(&frames->line, &frames->room, frames->file) > 0) {
        const char *start = frames->line + strspn(frames->line, " \t\r\n");
        const int first = !frames->seen;

        frames->number++;
        /* A header has no number in it. */
        if (*start == '\0' || *start == '#'
            || (frames->number == 1 && strpbrk(frames->line, "0123456789") == NULL)) {
            continue;
        }
        frames->seen = 1;
        if (first && text_numbers_columns(start, taxels)) {
            fprintf(stderr, "line %lu: the columns' numbers: read as a header\n", frames->number);
            continue;
        }
        frames->good = text_parse(shape, start, frames->number, words);
        return frames->good;
    }
    return 0;
}

/* ---- One at a time */

/* Prints an answer. */
static int answered(const sptfra_shape *shape, const void *words)
{
    sptfra_result result;
    const int code = sptfra_decode(shape, words, &result);

    if (code == SPTFRA_OK) {
        text_answer(&result);
    }
    return code;
}

/* Sends the frame in `stress` and prints its answer; 0 after a message. */
static int process(sptfra *device, const sptfra_buffer *stress, const sptfra_buffer *forces)
{
    int code = sptfra_start(device, stress, forces);

    code = code == SPTFRA_OK ? system_wait() : code;
    /* No interrupt comes of a transfer that failed: the DMA says why. */
    code = code == SPTFRA_OK ? sptfra_wait(device, forces, POLLS)
        : code == SPTFRA_TIMEOUT ? sptfra_wait(device, forces, 0) : code;
    code = code == SPTFRA_OK ? answered(&device->shape, forces->data) : code;
    if (code != SPTFRA_OK) {
        const int recovered = sptfra_recover(device, stress, forces, POLLS);

        fail("frame", code);
        return recovered == SPTFRA_OK ? 0 : fail("recovery", recovered);
    }
    return 1;
}

static int run_one_by_one(sptfra *device, const sptfra_buffer *memory, source *frames)
{
    const size_t in = whole_lines(4u * (size_t)device->shape.words_in);
    const sptfra_buffer stress = {memory->data, memory->address, in};
    const sptfra_buffer forces = {(char *)memory->data + in, memory->address + in, memory->bytes - in};
    int good = 1;

    if (memory->bytes < in + whole_lines(4u * (size_t)device->shape.words_out)) {
        fprintf(stderr, "the buffer has %zu bytes, too few for a frame\n", memory->bytes);
        return 0;
    }
    /* What follows a frame's last value in its last beat should be zero. */
    memset(memory->data, 0, in);
    while (good && next_frame(frames, &device->shape, stress.data)) {
        good = process(device, &stress, &forces);
    }
    return good && frames->good;
}

/* ---- Many at a time */

/* The oldest frame's answer, which an interrupt tells of. */
static int take(sptfra_queue *queue, const void **answer)
{
    int code;

    sptfra_queue_acknowledge(queue);
    code = sptfra_queue_take(queue, answer, 0);
    if (code != SPTFRA_TIMEOUT) {
        return code;
    }
    code = system_wait();
    return code == SPTFRA_OK ? sptfra_queue_take(queue, answer, POLLS)
        : code == SPTFRA_TIMEOUT ? sptfra_queue_take(queue, answer, 0) : code;
}

static int run_queued(sptfra *device, const sptfra_buffer *memory, uint32_t depth, source *frames)
{
    const size_t wanted = sptfra_queue_bytes(&device->shape, depth);
    sptfra_queue queue;
    uint32_t lost;
    int code, recovered, more = 1;

    if (memory->bytes < wanted) {
        fprintf(stderr, "the buffer has %zu bytes, and %u frames take %zu\n", memory->bytes, (unsigned)depth, wanted);
        return 0;
    }
    code = sptfra_queue_open(&queue, device, memory, depth);
    if (code != SPTFRA_OK) {
        return fail("queue", code);
    }
    while (code == SPTFRA_OK && (more || sptfra_queue_length(&queue) > 0)) {
        const void *answer;
        void *room;

        while (more && code == SPTFRA_OK && (room = sptfra_queue_room(&queue)) != NULL) {
            more = next_frame(frames, &device->shape, room);
            code = more ? sptfra_queue_send(&queue) : code;
        }
        if (code == SPTFRA_OK && sptfra_queue_length(&queue) > 0) {
            code = take(&queue, &answer);
            code = code == SPTFRA_OK ? answered(&device->shape, answer) : code;
        }
    }
    if (code == SPTFRA_OK) {
        return frames->good;
    }
    fail("frame", code);
    recovered = sptfra_queue_recover(&queue, POLLS, &lost);
    if (recovered != SPTFRA_OK) {
        return fail("recovery", recovered);
    }
    fprintf(stderr, "frames that were sent and have no answer: %u\n", (unsigned)lost);
    return 0;
}

/* ---- The command line */

/* Takes the options off the arguments; how many are left, or 0 after a message. */
static int options(int count, char **arguments, system_options *wanted, sptfra_shape *shape)
{
    int index, left = 1;

    for (index = 1; index < count; index++) {
        const int queue = strcmp(arguments[index], "--queue") == 0;

        if (!queue && strcmp(arguments[index], "--metadata") != 0) {
            arguments[left++] = arguments[index];
            continue;
        }
        if (++index == count) {
            fprintf(stderr, "%s: no value\n", arguments[index - 1]);
            return 0;
        }
        if (queue) {
            char *end;
            const unsigned long depth = strtoul(arguments[index], &end, 10);

            if (*end != '\0' || depth < SPTFRA_LEAST_QUEUED || depth > SPTFRA_MOST_QUEUED) {
                fprintf(stderr, "--queue %s: %u to %u frames\n", arguments[index], SPTFRA_LEAST_QUEUED,
                    SPTFRA_MOST_QUEUED);
                return 0;
            }
            wanted->queue = (uint32_t)depth;
        } else if (!metadata_read(arguments[index], shape)) {
            return 0;
        } else {
            wanted->shape = shape;
        }
    }
    return left;
}

int main(int count, char **arguments)
{
    system_options wanted = {NULL, 0};
    source frames = {.file = stdin, .good = 1};
    sptfra_shape shape;
    sptfra device;
    sptfra_buffer memory;
    int good = 0;

    count = options(count, arguments, &wanted, &shape);
    if (count == 0) {
        return 2;
    }
    if (count < system_arguments + 1 || count > system_arguments + 2) {
        fprintf(stderr, "usage: %s %s[--queue N] [--metadata FILE] [FRAMES]\n", arguments[0], system_usage);
        return 2;
    }
    if (count == system_arguments + 2) {
        frames.file = fopen(arguments[count - 1], "r");
        if (frames.file == NULL) {
            perror(arguments[count - 1]);
            return 1;
        }
    }
    if (!system_open(&device, &memory, &wanted, arguments + 1)) {
        return 1;
    }
    if (wanted.queue == 0 && device.scatter_gather) {
        fprintf(stderr, "the DMA has descriptors, and takes frames through a queue alone: --queue 8\n");
    } else {
        text_header();
        good = wanted.queue > 0 ? run_queued(&device, &memory, wanted.queue, &frames)
                                : run_one_by_one(&device, &memory, &frames);
    }
    free(frames.line);
    system_close();
    if (frames.file != stdin) {
        fclose(frames.file);
    }
    return !good;
}
