/* SPDX-License-Identifier: MIT OR Apache-2.0 */
/* Frames in, forces out: a line of values (pascals, or counts) for each frame of FRAMES or of standard input becomes a
 * line of forces on standard output; of a core that tells bodies apart (contacts) with a record of each behind the status.
 *
 *   forces_linux FRAMES                on the board, through /dev/uio* and u-dma-buf
 *   forces_simulated CORE.so FRAMES    on the desk, through the simulated core */
#define _POSIX_C_SOURCE 200809L
#include "system.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A simulated frame is soon there; on the board the interrupt has come before anybody asks. */
#define POLLS 1000000u

static size_t whole_lines(size_t bytes) { return (bytes + SPTFRA_LINE - 1u) / SPTFRA_LINE * SPTFRA_LINE; }

/* The values of a line as the core takes them; 0 after a message. */
static int parse(const sptfra_shape *shape, const char *line, unsigned long number, void *words)
{
    const size_t taxels = (size_t)shape->columns * shape->rows;
    const double least = shape->samples == SPTFRA_INT16 ? -32768.0 : 0.0;
    const double most = shape->samples == SPTFRA_INT16 ? 32767.0 : 65535.0;
    const char *at = line;
    size_t index;
    char *end;

    for (index = 0; index < taxels; index++) {
        const double value = strtod(at, &end);

        if (end == at) {
            fprintf(stderr, "line %lu: %zu values, and the core has %zu taxels\n", number, index, taxels);
            return 0;
        }
        if (shape->samples == SPTFRA_FLOAT32) {
            ((float *)words)[index] = (float)value;
        } else if (value >= least && value <= most && value == floor(value)) {
            ((uint16_t *)words)[index] = (uint16_t)(int32_t)value;
        } else {
            fprintf(stderr, "line %lu, value %zu: %g is no count from %g to %g\n", number, index + 1, value, least, most);
            return 0;
        }
        at = end + strspn(end, " \t,;\r\n");
    }
    if (*at != '\0') {
        fprintf(stderr, "line %lu: more than %zu values\n", number, taxels);
        return 0;
    }
    return 1;
}

/* Whether a line has the numbers of its columns alone, from 0 or 1 on, as pandas writes them above frames. */
static int numbers_columns(const char *line, size_t taxels)
{
    const char *at = line;
    double first = 0.0;
    size_t index;
    char *end;

    for (index = 0; index < taxels; index++) {
        const double value = strtod(at, &end);

        first = index == 0 ? value : first;
        if (end == at || (first != 0.0 && first != 1.0) || value != first + (double)index) {
            return 0;
        }
        at = end + strspn(end, " \t,;\r\n");
    }
    return *at == '\0';
}

static int fail(const char *what, int code)
{
    fprintf(stderr, "%s: %s%s%s\n", what, sptfra_error(code), code == SPTFRA_SYSTEM ? ": " : "",
        code == SPTFRA_SYSTEM ? strerror(errno) : "");
    return 0;
}

/* Each body's record, by the columns of print_header. */
static void print_bodies(const sptfra_shape *shape, const sptfra_result *result)
{
    const int records = sptfra_records(shape);
    int index;

    if (records > 0) {
        printf(",%u", (unsigned)result->bodies);
    }
    for (index = 0; index < records; index++) {
        const sptfra_body *body = &result->body[index];

        printf(",%u,%u,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g", (unsigned)body->taxels, (unsigned)body->status,
            (double)body->centre[0], (double)body->centre[1], (double)body->force[0], (double)body->force[1],
            (double)body->force[2], (double)body->friction, (double)body->standard_error);
    }
}

/* Names of the columns; those of bodies as in the force files of `golden solve`. */
static void print_header(const sptfra_shape *shape)
{
    static const char *const names[] = {"taxels", "status", "x", "y", "F_x", "F_y", "F_z", "mu", "standard_error"};
    const int records = sptfra_records(shape);
    int index;
    size_t name;

    printf("frame,F_x,F_y,F_z,mu,phi,status%s", records > 0 ? ",bodies" : "");
    for (index = 0; index < records; index++) {
        for (name = 0; name < sizeof names / sizeof names[0]; name++) {
            printf(",body%d_%s", index, names[name]);
        }
    }
    printf("\n");
}

/* Sends the frame in `stress` and prints its answer; 0 after a message. */
static int process(sptfra *device, const sptfra_buffer *stress, const sptfra_buffer *forces)
{
    sptfra_result result;
    unsigned bit;
    int code = sptfra_start(device, stress, forces);

    code = code == SPTFRA_OK ? system_wait() : code;
    /* No interrupt comes of a transfer that failed: the DMA says why. */
    code = code == SPTFRA_OK ? sptfra_wait(device, forces, POLLS)
        : code == SPTFRA_TIMEOUT ? sptfra_wait(device, forces, 0) : code;
    code = code == SPTFRA_OK ? sptfra_decode(&device->shape, forces->data, &result) : code;
    if (code != SPTFRA_OK) {
        const int recovered = sptfra_recover(device, stress, forces, POLLS);

        fail("frame", code);
        return recovered == SPTFRA_OK ? 0 : fail("recovery", recovered);
    }
    printf("%u,%.9g,%.9g,%.9g,%.9g,%.9g,", (unsigned)result.number, (double)result.force[0], (double)result.force[1],
        (double)result.force[2], (double)result.friction, (double)result.direction);
    for (bit = 0; sptfra_status_name(bit) != NULL; bit++) {
        if (result.status >> bit & 1u) {
            printf("%s%s", result.status & ((1u << bit) - 1u) ? "; " : "", sptfra_status_name(bit));
        }
    }
    print_bodies(&device->shape, &result);
    printf("\n");
    fflush(stdout);
    return 1;
}

/* Every line that holds a frame; 0 after a message. */
static int run(sptfra *device, const sptfra_buffer *stress, const sptfra_buffer *forces, FILE *frames)
{
    const size_t taxels = (size_t)device->shape.columns * device->shape.rows;
    unsigned long number = 0;
    char *line = NULL;
    size_t room = 0;
    int good = 1, first = 1;

    print_header(&device->shape);
    while (good && getline(&line, &room, frames) > 0) {
        const char *start = line + strspn(line, " \t\r\n");

        number++;
        /* A header has no number in it. */
        if (*start == '\0' || *start == '#' || (number == 1 && strpbrk(line, "0123456789") == NULL)) {
            continue;
        }
        if (first && numbers_columns(start, taxels)) {
            fprintf(stderr, "line %lu: the columns' numbers: taken for a header\n", number);
            first = 0;
            continue;
        }
        first = 0;
        good = parse(&device->shape, start, number, stress->data) && process(device, stress, forces);
    }
    free(line);
    return good;
}

int main(int count, char **arguments)
{
    sptfra device;
    sptfra_buffer memory, stress, forces;
    FILE *frames = stdin;
    size_t in;
    int good;

    if (count < system_arguments + 1 || count > system_arguments + 2) {
        fprintf(stderr, "usage: %s %s[FRAMES]\n", arguments[0], system_usage);
        return 2;
    }
    if (count == system_arguments + 2) {
        frames = fopen(arguments[count - 1], "r");
        if (frames == NULL) {
            perror(arguments[count - 1]);
            return 1;
        }
    }
    if (!system_open(&device, &memory, arguments + 1)) {
        return 1;
    }
    in = whole_lines(4u * (size_t)device.shape.words_in);
    if (memory.bytes < in + whole_lines(4u * (size_t)device.shape.words_out)) {
        fprintf(stderr, "the buffer has %zu bytes, too few for a frame\n", memory.bytes);
        return 1;
    }
    /* What follows a frame's last value in its last beat should be zero. */
    memset(memory.data, 0, in);
    stress = (sptfra_buffer){memory.data, memory.address, in};
    forces = (sptfra_buffer){(char *)memory.data + in, memory.address + in, memory.bytes - in};
    good = run(&device, &stress, &forces, frames);
    system_close();
    if (frames != stdin) {
        fclose(frames);
    }
    return !good;
}
