// SPDX-License-Identifier: MIT OR Apache-2.0
/* The C driver on the host, against the simulated core: frames, names, counters, interrupts, soft reset, refusals.
 *
 *   host CORE.so REGISTERS FRAMES COLUMNS ROWS WORDS_OUT HAS_FIELD STREAM_BYTES
 *
 * FRAMES is binary, little-endian: for each frame the number of words, the words, and words_out words of the answer.
 * With REGISTERS 0 the core has no bank. */
#include "check.h"
#include "machine.h"
#include "sptfra.h"

#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#define MOST_WORDS 16384
#define POLLS 1000000u
#define MOST_TICKS 200
#define RATE 3u /* as in mod.rs */
#ifndef MOMENTS
#define MOMENTS 7 /* cycles from one moment of a recovery to the next */
#endif
/* More than a frame takes: three cycles each. */
#define RECOVERY 1000u

/* The driver has cache functions here, so its buffers are whole lines. */
_Alignas(SPTFRA_LINE) static uint32_t stress_words[MOST_WORDS], force_words[MOST_WORDS];
static uint32_t expected[MOST_WORDS];
static int flushed, invalidated, fenced;
/* Since the last barrier a buffer was flushed, or a status of the DMA read. */
static int buffers_open, status_open;

static void flush(void *context, const void *start, size_t bytes)
{
    (void)context;
    (void)start;
    CHECK(bytes % SPTFRA_LINE == 0);
    flushed += bytes != 0;
    buffers_open = 1;
}

static void fence(void *context)
{
    (void)context;
    fenced++;
    buffers_open = 0;
    status_open = 0;
}

static void invalidate(void *context, void *start, size_t bytes)
{
    (void)context;
    (void)start;
    CHECK(bytes % SPTFRA_LINE == 0);
    /* An answer is read behind a barrier behind the status that says that it is there. */
    CHECK(!status_open);
    invalidated += bytes != 0;
}

/* Registers as the driver reaches them: a length is written behind a barrier behind the buffers. */
static uint32_t read_register(void *context, uintptr_t address)
{
    status_open |= address == MACHINE_DMA + 0x04u || address == MACHINE_DMA + 0x34u;
    return machine_read(context, address);
}

static void write_register(void *context, uintptr_t address, uint32_t value)
{
    CHECK(!buffers_open || (address != MACHINE_DMA + 0x28u && address != MACHINE_DMA + 0x58u));
    machine_write(context, address, value);
}

static int next_frame(FILE *file, uint32_t *words, size_t words_out)
{
    if (fread(words, 4, 1, file) != 1) {
        return 0;
    }
    CHECK(*words < MOST_WORDS && fread(stress_words, 4, *words, file) == *words);
    CHECK(fread(expected, 4, words_out, file) == words_out);
    return 1;
}

/* All words but the timestamp, which the file's words cannot know. */
static int is_expected(const sptfra_shape *shape)
{
    return force_words[0] == expected[0]
        && memcmp(force_words + 2, expected + 2, 4u * (shape->words_out - 2u)) == 0;
}

/* Lengths that no core has are refused. */
static void check_shapes(const sptfra_shape *shape)
{
    const int known = 16 + (shape->has_field ? 3 * shape->columns * shape->rows : 0);
    const int wrong[] = {0, 15, known - 1, known + 1, known + 8};
    sptfra_shape other = *shape;
    sptfra device;
    size_t index;

    for (index = 0; index < sizeof wrong / sizeof wrong[0]; index++) {
        other.words_out = (uint16_t)wrong[index];
        CHECK(sptfra_open_streams(&device, &sptfra_memory_mapped, 0, &other) == SPTFRA_BAD_SHAPE);
    }
    CHECK(strncmp(sptfra_error(SPTFRA_BAD_SHAPE), "words_out is not", 16) == 0);
}

/* What a separator was given. */
static unsigned marked;
static const void *marked_frame;
static uint16_t marked_number;

static int separate(void *context, const sptfra_result *result, const void *frame)
{
    ++*(unsigned *)context;
    marked_number = result->number;
    marked_frame = frame;
    return -77;
}

/* A frame of more than one contact goes to the separator, whose code comes back; no other does. */
static void check_separator(const sptfra_shape *shape)
{
    const sptfra_separator separator = {&marked, separate};
    const unsigned before = marked;
    const uint32_t status = force_words[0];
    sptfra_result result;

    force_words[0] = status & ~(uint32_t)SPTFRA_SEVERAL_CONTACTS;
    CHECK(sptfra_decode_and_separate(shape, force_words, stress_words, &separator, &result) == SPTFRA_OK);
    CHECK(marked == before && result.number == status >> 16);
    force_words[0] = status | SPTFRA_SEVERAL_CONTACTS;
    CHECK(sptfra_decode_and_separate(shape, force_words, stress_words, &separator, &result) == -77);
    CHECK(marked == before + 1 && marked_frame == stress_words && marked_number == status >> 16);
    CHECK(sptfra_decode_and_separate(shape, force_words, NULL, &separator, &result) == SPTFRA_NOT_STARTED);
    CHECK(sptfra_decode_and_separate(shape, (const char *)force_words + 2, stress_words, &separator, &result)
        == SPTFRA_BAD_BUFFER);
    CHECK(marked == before + 1);
    force_words[0] = status;
}

static void check_result(const sptfra_shape *shape)
{
    sptfra_result result;
    const float *values = (const float *)force_words;
    unsigned bit;

    CHECK(sptfra_decode(shape, (const char *)force_words + 2, &result) == SPTFRA_BAD_BUFFER);
    CHECK(sptfra_decode(shape, force_words, &result) == SPTFRA_OK);
    CHECK(result.number == force_words[0] >> 16 && result.status == (force_words[0] & 0xFFFF));
    CHECK(result.timestamp == force_words[1]);
    CHECK(memcmp(result.force, values + 2, 12) == 0 && memcmp(result.torque, values + 5, 12) == 0);
    CHECK(memcmp(&result.friction, values + 8, 4) == 0 && memcmp(&result.direction, values + 9, 4) == 0);
    CHECK(memcmp(result.friction_xy, values + 10, 8) == 0 && memcmp(&result.standard_error, values + 12, 4) == 0);
    CHECK((result.contacts | result.version << 8 | result.replaced << 16) == (int)force_words[13]);
    CHECK(result.field == (shape->has_field ? values + shape->words_out - 3 * shape->columns * shape->rows : NULL));
    check_separator(shape);
    for (bit = 0; bit < 16; bit++) {
        CHECK((sptfra_status_name(bit) != NULL) == (bit < 13));
    }
    CHECK(strcmp(sptfra_status_name(4), "NaN or infinity") == 0 && SPTFRA_NOT_FINITE == 1 << 4);
}

static void check_uio(void)
{
    char path[] = "/tmp/sptfra_uio_XXXXXX";
    const int file = mkstemp(path);
    const uint32_t words[1024] = {0x54465241u, 42u};
    sptfra_uio uio;
    sptfra device;

    CHECK(file >= 0 && write(file, words, sizeof words) == (ssize_t)sizeof words);
    CHECK(sptfra_uio_open(&uio, path, sizeof words) == SPTFRA_OK);
    CHECK(sptfra_memory_mapped.read(NULL, uio.base + 4) == 42u);
    sptfra_memory_mapped.write(NULL, uio.base + 8, 7u);
    CHECK(sptfra_memory_mapped.read(NULL, uio.base + 8) == 7u);
    /* A core of another map is refused before its DMA is touched. */
    CHECK(sptfra_open(&device, &sptfra_memory_mapped, uio.base, 0) == SPTFRA_OTHER_MAP);
    sptfra_uio_close(&uio);
    close(file);
    unlink(path);
    CHECK(sptfra_uio_open(&uio, path, sizeof words) == SPTFRA_SYSTEM);
}

/* Signals while the driver waits for an interrupt, which comes with the third if there is somebody to send it. */
static volatile sig_atomic_t ticks;
static int waker;

static void tick(int number)
{
    const uint32_t word = 1;

    (void)number;
    ticks++;
    if (waker >= 0 && ticks == 3 && write(waker, &word, sizeof word) != (ssize_t)sizeof word) {
        ticks = MOST_TICKS;
    }
    if (ticks >= MOST_TICKS) {
        const struct itimerval never = {{0, 0}, {0, 0}};

        setitimer(ITIMER_REAL, &never, NULL);
    }
}

static void check_uio_wait(void)
{
    const struct sigaction action = {.sa_handler = tick};
    const struct itimerval often = {{0, 5000}, {0, 5000}}, never = {{0, 0}, {0, 0}};
    const int patience[] = {60, 10000, -1};
    uint32_t word;
    int ends[2], turn;
    sptfra_uio uio;

    /* What is written unmasks the interrupt, which is a word to read. */
    CHECK(socketpair(AF_UNIX, SOCK_STREAM, 0, ends) == 0 && sigaction(SIGALRM, &action, NULL) == 0);
    memset(&uio, 0, sizeof uio);
    uio.file = ends[0];
    for (turn = 0; turn < 3; turn++) {
        ticks = 0;
        waker = turn == 0 ? -1 : ends[1];
        CHECK(setitimer(ITIMER_REAL, &often, NULL) == 0);
        CHECK(sptfra_uio_wait(&uio, patience[turn]) == (turn == 0 ? SPTFRA_TIMEOUT : SPTFRA_OK));
        CHECK(setitimer(ITIMER_REAL, &never, NULL) == 0);
        CHECK(ticks >= 3 && ticks < MOST_TICKS);
        CHECK(read(ends[1], &word, sizeof word) == (ssize_t)sizeof word && word == 1);
    }
    uio.file = -1;
    CHECK(sptfra_uio_wait(&uio, 1) == SPTFRA_SYSTEM);
    close(ends[0]);
    close(ends[1]);
}

int main(int count, char **arguments)
{
    const sptfra_buffer stress = {stress_words, (uintptr_t)stress_words + MACHINE_BUS_OFFSET, sizeof stress_words};
    const sptfra_buffer forces = {force_words, (uintptr_t)force_words + MACHINE_BUS_OFFSET, sizeof force_words};
    sptfra_buffer wrong = stress;
    sptfra_shape shape;
    sptfra_platform platform = {NULL, read_register, write_register, flush, invalidate, fence};
    sptfra_counters counters;
    sptfra_identity identity;
    machine *system;
    sptfra device;
    FILE *file;
    uint32_t words, frames = 0, bad = 0, last = 0, events = 0, timestamp = 0;

    CHECK(count == 10);
    const int has_registers = atoi(arguments[2]);
    memset(&shape, 0, sizeof shape);
    shape.columns = (uint16_t)atoi(arguments[4]);
    shape.rows = (uint16_t)atoi(arguments[5]);
    shape.words_out = (uint16_t)atoi(arguments[6]);
    shape.has_field = (uint8_t)atoi(arguments[7]);
    shape.stream_bytes = (uint8_t)atoi(arguments[8]);
    shape.samples = (uint8_t)atoi(arguments[9]);
    shape.has_counts = shape.samples != SPTFRA_FLOAT32;
    /* Whole beats. */
    shape.words_in = (uint16_t)((sptfra_frame_bytes(&shape) + shape.stream_bytes - 1u) / shape.stream_bytes);
    shape.words_in = (uint16_t)(shape.words_in * shape.stream_bytes / 4u);
    system = machine_open(arguments[1], 7, has_registers);
    CHECK(system != NULL);
    platform.context = system;
    if (has_registers) {
        CHECK(sptfra_open(&device, &platform, MACHINE_CORE + 4, MACHINE_DMA) == SPTFRA_NOT_A_CORE);
        CHECK(sptfra_open(&device, &platform, MACHINE_CORE, MACHINE_DMA) == SPTFRA_OK);
        CHECK(memcmp(&device.shape, &shape, sizeof shape) == 0);
        CHECK(sptfra_identify(&device, &identity) == SPTFRA_OK);
        printf("hash %016llx lanes %u clock %u latency %u interval %u full scale %g drops %u\n",
            (unsigned long long)identity.design_hash, identity.lanes, identity.clock_khz, identity.latency_cycles,
            identity.interval_cycles, (double)identity.full_scale_pa, identity.drops_frames);
        CHECK(!identity.calibration_in_ram && !identity.curve_in_ram && identity.replaceable == 0);
        CHECK(sptfra_enable_interrupts(&device, SPTFRA_FRAME_ERROR) == SPTFRA_OK);
        if (identity.averages_frames) {
            CHECK(sptfra_set_smoothing(&device, 9) == SPTFRA_OUT_OF_RANGE);
            CHECK(sptfra_set_smoothing(&device, RATE) == SPTFRA_OK);
            CHECK(platform.read(system, MACHINE_CORE + offsetof(sptfra_t, SMOOTHING)) == RATE);
        } else {
            CHECK(sptfra_set_smoothing(&device, 1) == SPTFRA_NO_SMOOTHING);
        }
    } else {
        CHECK(sptfra_open_streams(&device, &platform, MACHINE_DMA, &shape) == SPTFRA_OK);
        CHECK(sptfra_identify(&device, &identity) == SPTFRA_NO_REGISTERS);
        CHECK(sptfra_soft_reset(&device, POLLS) == SPTFRA_NO_REGISTERS);
        CHECK(sptfra_set_smoothing(&device, 1) == SPTFRA_NO_REGISTERS);
    }

    /* Every frame, good and bad, word by word. */
    file = fopen(arguments[3], "rb");
    CHECK(file != NULL);
    while (next_frame(file, &words, shape.words_out)) {
        if (words == shape.words_in) {
            CHECK(sptfra_process(&device, &stress, &forces, POLLS) == SPTFRA_OK);
        } else {
            CHECK(sptfra_start_words(&device, &stress, words, &forces) == SPTFRA_OK);
            CHECK(sptfra_wait(&device, &forces, POLLS) == SPTFRA_OK);
        }
        CHECK(is_expected(&shape));
        CHECK(frames == 0 || force_words[1] - timestamp >= words);
        timestamp = force_words[1];
        check_result(&shape);
        last = force_words[0];
        frames++;
        bad += (last & (SPTFRA_NOT_FINITE | SPTFRA_BAD_LENGTH)) != 0;
        if (has_registers) {
            const int faulty = (last & (SPTFRA_NOT_FINITE | SPTFRA_BAD_LENGTH)) != 0;

            machine_run(system, 4);
            CHECK(machine_interrupt(system) == faulty);
            CHECK(sptfra_take_interrupts(&device, &events) == SPTFRA_OK);
            CHECK(events == (SPTFRA_FRAME_DONE | (faulty ? SPTFRA_FRAME_ERROR : 0u)));
            machine_run(system, 4);
            CHECK(!machine_interrupt(system));
        }
    }
    CHECK(frames > 10 && bad >= 2 && flushed > 0 && invalidated > 0 && fenced == 2 * (int)frames);
    if (has_registers) {
        CHECK(sptfra_count(&device, &counters) == SPTFRA_OK);
        CHECK(counters.frames_in == frames && counters.frames_out == frames && counters.frames_bad == bad);
        CHECK(counters.frames_dropped == 0);
        CHECK(counters.last_status == last && counters.last_latency >= identity.latency_cycles);
        CHECK(counters.last_interval > 0);
    }

    /* What is refused before anything moves. */
    CHECK(sptfra_wait(&device, &forces, POLLS) == SPTFRA_NOT_STARTED);
    wrong.bytes = 0;
    CHECK(sptfra_start(&device, &wrong, &forces) == SPTFRA_BAD_BUFFER);
    wrong = stress;
    wrong.address += 4;
    CHECK(sptfra_start(&device, &wrong, &forces) == SPTFRA_BAD_BUFFER);
    wrong = stress;
    wrong.bytes -= 4;
    CHECK(sptfra_start(&device, &wrong, &forces) == SPTFRA_BAD_BUFFER);
    CHECK(sptfra_start_words(&device, &stress, 0, &forces) == SPTFRA_BAD_BUFFER);
    CHECK(sptfra_start_words(&device, &stress, SIZE_MAX / 4u + 2u, &forces) == SPTFRA_BAD_BUFFER);
    /* The patience of one call is no end of the transfer, and until then nothing else starts. */
    CHECK(sptfra_process(&device, &stress, &forces, 0) == SPTFRA_TIMEOUT);
    CHECK(sptfra_start(&device, &stress, &forces) == SPTFRA_BUSY);
    CHECK(sptfra_wait(&device, &forces, POLLS) == SPTFRA_OK);

    /* A timeout, and only the DMA is reset: the next answer is the one before, and is not taken for the next. */
    rewind(file);
    CHECK(next_frame(file, &words, shape.words_out) && words == shape.words_in);
    CHECK(sptfra_process(&device, &stress, &forces, 0) == SPTFRA_TIMEOUT);
    while (machine_sends(system)) {
        machine_run(system, 1);
    }
    CHECK(sptfra_reset_dma(&device, POLLS) == SPTFRA_OK);
    device.busy = 0;
    device.next_number++; /* somebody who goes on as if nothing had been */
    CHECK(sptfra_process(&device, &stress, &forces, POLLS) == SPTFRA_OUT_OF_STEP);
    CHECK(sptfra_start(&device, &stress, &forces) == SPTFRA_BUSY);

    /* A recovery at any moment of a frame, and the next one is right. */
    for (words = 0; words < 1500; words += MOMENTS) {
        CHECK(sptfra_recover(&device, &stress, &forces, RECOVERY) == SPTFRA_OK);
        rewind(file);
        CHECK(next_frame(file, &events, shape.words_out) && events == shape.words_in);
        CHECK(sptfra_process(&device, &stress, &forces, POLLS) == SPTFRA_OK);
        CHECK((force_words[0] & 0xFFFFu) == (expected[0] & 0xFFFFu));
        CHECK(memcmp(force_words + 2, expected + 2, 4u * (shape.words_out - 2u)) == 0);
        CHECK(sptfra_start(&device, &stress, &forces) == SPTFRA_OK);
        machine_run(system, words);
    }
    CHECK(sptfra_recover(&device, &stress, &forces, RECOVERY) == SPTFRA_OK);

    /* A soft reset with a frame inside: the counters start anew, and the next frame is right again. */
    if (has_registers) {
        rewind(file);
        CHECK(next_frame(file, &words, shape.words_out) && words == shape.words_in);
        CHECK(sptfra_start(&device, &stress, &forces) == SPTFRA_OK);
        machine_run(system, 40);
        CHECK(sptfra_soft_reset(&device, POLLS) == SPTFRA_OK);
        CHECK(sptfra_wait(&device, &forces, 1000u) == SPTFRA_TIMEOUT);
        CHECK(sptfra_recover(&device, &stress, &forces, RECOVERY) == SPTFRA_OK);
        CHECK(sptfra_soft_reset(&device, POLLS) == SPTFRA_OK);
        CHECK(sptfra_count(&device, &counters) == SPTFRA_OK && counters.frames_out == 0);
        rewind(file);
        CHECK(next_frame(file, &words, shape.words_out) && words == shape.words_in);
        CHECK(sptfra_process(&device, &stress, &forces, POLLS) == SPTFRA_OK);
        CHECK(is_expected(&shape) && force_words[0] >> 16 == 0 && force_words[1] < timestamp);
    }
    CHECK(machine_faults(system) == 0);
    check_shapes(&shape);
    fclose(file);
    machine_close(system);
    check_uio();
    check_uio_wait();
    CHECK(strcmp(sptfra_error(SPTFRA_TIMEOUT), "no answer in the polls given") == 0);
    CHECK(strcmp(sptfra_error(-99), "unknown code") == 0);
    printf("PASS: %u frames, %u bad\n", frames, bad);
    return 0;
}
