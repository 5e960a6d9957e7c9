/* SPDX-License-Identifier: MIT OR Apache-2.0 */
/* See sptfra.h. */
#if defined(__linux__) && !defined(SPTFRA_NO_UIO)
#define _POSIX_C_SOURCE 200809L
#endif

#include "sptfra.h"

#include <string.h>

#if !defined(__GNUC__)
#include <stdatomic.h>
#endif
#if defined(__linux__) && !defined(SPTFRA_NO_UIO)
#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <time.h>
#include <unistd.h>
#endif

/* "TFRA", and the version of the register map that this driver knows. */
#define MAGIC 0x54465241u
#define MAP_VERSION 2u

/* AXI DMA, direct register mode: offsets of both channels, registers of a channel, bits. */
#define SEND 0x00u
#define RECEIVE 0x30u
#define DMA_CONTROL 0x00u
#define DMA_STATUS 0x04u
#define DMA_ADDRESS 0x18u
#define DMA_ADDRESS_HIGH 0x1Cu
#define DMA_LENGTH 0x28u
#define CONTROL_RUN 0x0001u
#define CONTROL_RESET 0x0004u
#define CONTROL_INTERRUPT 0x1000u /* on completion */
#define STATUS_HALTED 0x0001u
#define STATUS_IDLE 0x0002u
#define STATUS_FAULTS 0x0070u
#define STATUS_INTERRUPTS 0x7000u
#define RESET_POLLS 100000u
#define RECOVERY_POLLS 1000000u
#define MOST_PACKETS 32 /* more than a core holds */

#define FIELD(word, name) (((word) & SPTFRA__##name##_bm) >> SPTFRA__##name##_bp)
#define GET(device, register) get(device, offsetof(sptfra_t, register))
#define SET(device, register, value) set(device, offsetof(sptfra_t, register), value)

const char *sptfra_error(int code)
{
    switch (code) {
    case SPTFRA_OK: return "no error";
    case SPTFRA_NOT_A_CORE: return "no core at this address: IDENTITY is not TFRA";
    case SPTFRA_OTHER_MAP: return "the core's register map is of another version than this driver";
    case SPTFRA_NO_REGISTERS: return "the core was opened without registers";
    case SPTFRA_BAD_BUFFER: return "a buffer is too small or not on a multiple of a beat's bytes, or of a cache line";
    case SPTFRA_TIMEOUT: return "no answer in the polls given";
    case SPTFRA_DMA_FAULT: return "the DMA stopped with an error; its status register says which";
    case SPTFRA_CUT_SHORT: return "the answer is shorter than a frame's";
    case SPTFRA_SYSTEM: return "the operating system refused; errno says why";
    case SPTFRA_BUSY: return "a frame is on its way or has failed: wait for it, or recover";
    case SPTFRA_OUT_OF_STEP: return "the answer is that to another frame: recover";
    case SPTFRA_NOT_STARTED: return "no frame was started";
    case SPTFRA_NO_CALIBRATION: return "the design's calibration is in ROM: it needs calibration = \"ram\"";
    case SPTFRA_CALIBRATION_BUSY: return "a commit or a tare is under way: wait for it";
    case SPTFRA_OUT_OF_RANGE: return "a value, or an offset that the tare found, is out of bounds; nothing has changed";
    case SPTFRA_WRONG_CRC: return "the bank holds other words than were sent; nothing has changed";
    case SPTFRA_NOT_AT_REST: return "a taxel moved by more than the noise floor during the tare; nothing has changed";
    case SPTFRA_BAD_REST: return "a frame of the tare was clipped, no number, cut or lost; nothing has changed";
    default: return "unknown code";
    }
}

size_t sptfra_frame_bytes(const sptfra_shape *shape)
{
    return (shape->samples == SPTFRA_FLOAT32 ? 4u : 2u) * (size_t)shape->columns * shape->rows;
}

/* ---- Registers */

static uint32_t mapped_read(void *context, uintptr_t address)
{
    (void)context;
    return *(volatile uint32_t *)address;
}

static void mapped_write(void *context, uintptr_t address, uint32_t value)
{
    (void)context;
    *(volatile uint32_t *)address = value;
}

const sptfra_platform sptfra_memory_mapped = {NULL, mapped_read, mapped_write, NULL, NULL, NULL};

/* Registers are volatile, buffers are not: neither the compiler nor the processor may move one past the other. */
static void barrier(const sptfra *device)
{
    if (device->platform.barrier != NULL) {
        device->platform.barrier(device->platform.context);
        return;
    }
#if defined(__aarch64__)
    __asm__ volatile("dsb sy" ::: "memory");
#elif defined(__ARM_ARCH) && __ARM_ARCH >= 7
    __asm__ volatile("dsb" ::: "memory");
#elif defined(__GNUC__)
    __sync_synchronize();
#else
    atomic_thread_fence(memory_order_seq_cst);
#endif
}

static uint32_t get(const sptfra *device, size_t offset)
{
    return device->platform.read(device->platform.context, device->core + offset);
}

static void set(const sptfra *device, size_t offset, uint32_t value)
{
    device->platform.write(device->platform.context, device->core + offset, value);
}

static uint32_t dma_get(const sptfra *device, uint32_t offset)
{
    return device->platform.read(device->platform.context, device->dma + offset);
}

static void dma_set(const sptfra *device, uint32_t offset, uint32_t value)
{
    device->platform.write(device->platform.context, device->dma + offset, value);
}

/* ---- The core */

/* The core numbers frames as they come in. */
static void follow_number(sptfra *device)
{
    device->knows_number = device->has_registers;
    device->next_number = device->has_registers ? (uint16_t)GET(device, FRAMES_IN) : 0;
}

int sptfra_open(sptfra *device, const sptfra_platform *platform, uintptr_t core, uintptr_t dma)
{
    uint32_t geometry, frame, features;

    memset(device, 0, sizeof *device);
    device->platform = *platform;
    device->core = core;
    device->dma = dma;
    device->has_registers = 1;
    if (GET(device, IDENTITY) != MAGIC) {
        return SPTFRA_NOT_A_CORE;
    }
    if (FIELD(GET(device, VERSION), VERSION__MAP) != MAP_VERSION) {
        return SPTFRA_OTHER_MAP;
    }
    geometry = GET(device, GEOMETRY);
    frame = GET(device, FRAME);
    features = GET(device, FEATURES);
    device->shape.columns = (uint16_t)FIELD(geometry, GEOMETRY__COLUMNS);
    device->shape.rows = (uint16_t)FIELD(geometry, GEOMETRY__ROWS);
    device->shape.words_in = (uint16_t)FIELD(frame, FRAME__WORDS_IN);
    device->shape.words_out = (uint16_t)FIELD(frame, FRAME__WORDS_OUT);
    device->shape.has_field = (uint8_t)FIELD(features, FEATURES__FIELD_OUT);
    device->shape.has_counts = (uint8_t)FIELD(features, FEATURES__COUNTS);
    device->shape.stream_bytes = (uint8_t)FIELD(features, FEATURES__STREAM_BYTES);
    device->shape.samples = (uint8_t)FIELD(features, FEATURES__SAMPLES);
    follow_number(device);
    return sptfra_reset_dma(device, RESET_POLLS);
}

int sptfra_open_streams(sptfra *device, const sptfra_platform *platform, uintptr_t dma, const sptfra_shape *shape)
{
    memset(device, 0, sizeof *device);
    device->platform = *platform;
    device->dma = dma;
    device->shape = *shape;
    return sptfra_reset_dma(device, RESET_POLLS);
}

int sptfra_identify(const sptfra *device, sptfra_identity *identity)
{
    uint32_t version, features, full_scale;

    if (!device->has_registers) {
        return SPTFRA_NO_REGISTERS;
    }
    version = GET(device, VERSION);
    features = GET(device, FEATURES);
    full_scale = GET(device, FULL_SCALE);
    identity->map_version = (uint8_t)FIELD(version, VERSION__MAP);
    identity->major = (uint8_t)FIELD(version, VERSION__MAJOR);
    identity->minor = (uint8_t)FIELD(version, VERSION__MINOR);
    identity->patch = (uint8_t)FIELD(version, VERSION__PATCH);
    identity->design_hash = (uint64_t)GET(device, HASH_HIGH) << 32 | GET(device, HASH_LOW);
    identity->lanes = (uint8_t)FIELD(GET(device, GEOMETRY), GEOMETRY__LANES);
    identity->reduced = (uint8_t)FIELD(features, FEATURES__REDUCED);
    identity->skips_zeros = (uint8_t)FIELD(features, FEATURES__SKIPS_ZEROS);
    identity->clock_khz = GET(device, CLOCK);
    identity->latency_cycles = GET(device, PREDICTED_LATENCY);
    identity->interval_cycles = GET(device, PREDICTED_INTERVAL);
    memcpy(&identity->full_scale_pa, &full_scale, sizeof full_scale);
    return SPTFRA_OK;
}

int sptfra_count(const sptfra *device, sptfra_counters *counters)
{
    if (!device->has_registers) {
        return SPTFRA_NO_REGISTERS;
    }
    counters->frames_in = GET(device, FRAMES_IN);
    counters->frames_out = GET(device, FRAMES_OUT);
    counters->frames_bad = GET(device, FRAMES_BAD);
    counters->frames_dropped = FIELD(GET(device, FEATURES), FEATURES__DROPS) ? GET(device, FRAMES_DROPPED) : 0;
    counters->last_status = GET(device, LAST_STATUS);
    counters->last_latency = GET(device, LAST_LATENCY);
    counters->last_interval = GET(device, LAST_INTERVAL);
    return SPTFRA_OK;
}

/* Until the soft reset has taken place. */
static int reset_over(sptfra *device, uint32_t polls)
{
    while (FIELD(GET(device, STATUS), STATUS__RESETTING)) {
        if (polls == 0) {
            return SPTFRA_TIMEOUT;
        }
        polls -= polls != SPTFRA_FOREVER;
    }
    follow_number(device);
    return SPTFRA_OK;
}

int sptfra_soft_reset(sptfra *device, uint32_t polls)
{
    if (!device->has_registers) {
        return SPTFRA_NO_REGISTERS;
    }
    SET(device, CONTROL, SPTFRA__CONTROL__SOFT_RESET_bm);
    return reset_over(device, polls);
}

int sptfra_enable_interrupts(const sptfra *device, uint32_t events)
{
    if (!device->has_registers) {
        return SPTFRA_NO_REGISTERS;
    }
    SET(device, INTERRUPT_ENABLE, events);
    return SPTFRA_OK;
}

int sptfra_take_interrupts(const sptfra *device, uint32_t *events)
{
    if (!device->has_registers) {
        return SPTFRA_NO_REGISTERS;
    }
    *events = GET(device, INTERRUPT_STATUS);
    SET(device, INTERRUPT_STATUS, *events);
    return SPTFRA_OK;
}

/* ---- Frames */

static int fits(const sptfra *device, const sptfra_buffer *buffer, size_t words)
{
    const sptfra_platform *platform = &device->platform;
    const size_t unit = platform->flush != NULL || platform->invalidate != NULL ? SPTFRA_LINE : 4u;
    /* The DMA does not realign; a line begins with a beat. */
    const size_t beat = device->shape.stream_bytes > 4u ? device->shape.stream_bytes : 4u;

    return buffer->data != NULL && (uintptr_t)buffer->data % unit == 0 && buffer->address % unit == 0
        && buffer->address % beat == 0 && buffer->bytes % unit == 0 && buffer->bytes / 4u >= words;
}

static size_t whole_lines(size_t bytes)
{
    return (bytes + SPTFRA_LINE - 1u) / SPTFRA_LINE * SPTFRA_LINE;
}

static void transfer(const sptfra *device, uint32_t channel, uint64_t address, size_t bytes)
{
    /* What an earlier transfer left; ones clear. */
    dma_set(device, channel + DMA_STATUS, STATUS_INTERRUPTS);
    dma_set(device, channel + DMA_ADDRESS, (uint32_t)address);
    dma_set(device, channel + DMA_ADDRESS_HIGH, (uint32_t)(address >> 32));
    /* Writing the length starts it. */
    dma_set(device, channel + DMA_LENGTH, (uint32_t)bytes);
}

/* Offers the buffers to the DMA: what the processor wrote is in memory, and it has nothing to write over them. */
static void hand_over(const sptfra *device, const sptfra_buffer *stress, size_t words, const sptfra_buffer *forces)
{
    const sptfra_platform *platform = &device->platform;

    if (platform->flush != NULL) {
        platform->flush(platform->context, stress->data, whole_lines(4u * words));
        platform->flush(platform->context, forces->data, whole_lines(4u * (size_t)device->shape.words_out));
    }
    barrier(device);
}

int sptfra_start_words(sptfra *device, const sptfra_buffer *stress, size_t words, const sptfra_buffer *forces)
{
    if (device->busy) {
        return SPTFRA_BUSY;
    }
    if (words == 0 || !fits(device, stress, words) || !fits(device, forces, device->shape.words_out)) {
        return SPTFRA_BAD_BUFFER;
    }
    hand_over(device, stress, words, forces);
    device->busy = 1;
    transfer(device, RECEIVE, forces->address, 4u * (size_t)device->shape.words_out);
    transfer(device, SEND, stress->address, 4u * words);
    return SPTFRA_OK;
}

int sptfra_start(sptfra *device, const sptfra_buffer *stress, const sptfra_buffer *forces)
{
    return sptfra_start_words(device, stress, device->shape.words_in, forces);
}

int sptfra_wait(sptfra *device, const sptfra_buffer *forces, uint32_t polls)
{
    const sptfra_platform *platform = &device->platform;
    const size_t answer = 4u * (size_t)device->shape.words_out;
    uint32_t status;
    uint16_t number;

    if (!device->busy) {
        return SPTFRA_NOT_STARTED;
    }
    for (;;) {
        const uint32_t sent = dma_get(device, SEND + DMA_STATUS);
        const uint32_t received = dma_get(device, RECEIVE + DMA_STATUS);

        if ((sent | received) & STATUS_FAULTS) {
            return SPTFRA_DMA_FAULT;
        }
        if (sent & received & STATUS_IDLE) {
            break;
        }
        if (polls == 0) {
            return SPTFRA_TIMEOUT;
        }
        polls -= polls != SPTFRA_FOREVER;
    }
    /* The register now has the length of what came. */
    if (dma_get(device, RECEIVE + DMA_LENGTH) != answer) {
        return SPTFRA_CUT_SHORT;
    }
    /* Nothing of the answer is read before the DMA was seen to be done. */
    barrier(device);
    if (platform->invalidate != NULL) {
        platform->invalidate(platform->context, forces->data, whole_lines(answer));
    }
    memcpy(&status, forces->data, sizeof status);
    number = (uint16_t)FIELD(status, LAST_STATUS__NUMBER);
    if (device->knows_number && number != device->next_number) {
        return SPTFRA_OUT_OF_STEP;
    }
    device->knows_number = 1;
    device->next_number = (uint16_t)(number + 1u);
    device->busy = 0;
    return SPTFRA_OK;
}

int sptfra_process(sptfra *device, const sptfra_buffer *stress, const sptfra_buffer *forces, uint32_t polls)
{
    const int code = sptfra_start(device, stress, forces);

    return code == SPTFRA_OK ? sptfra_wait(device, forces, polls) : code;
}

/* Takes one packet and drops it; SPTFRA_TIMEOUT if none comes. */
static int drop_packet(sptfra *device, const sptfra_buffer *forces, uint32_t polls)
{
    transfer(device, RECEIVE, forces->address, 4u * (size_t)device->shape.words_out);
    while (!(dma_get(device, RECEIVE + DMA_STATUS) & (STATUS_IDLE | STATUS_FAULTS))) {
        if (polls-- == 0) {
            return SPTFRA_TIMEOUT;
        }
    }
    return dma_get(device, RECEIVE + DMA_STATUS) & STATUS_FAULTS ? SPTFRA_DMA_FAULT : SPTFRA_OK;
}

int sptfra_recover(sptfra *device, const sptfra_buffer *stress, const sptfra_buffer *forces, uint32_t polls)
{
    int code, packets;

    if (!fits(device, stress, 1u) || !fits(device, forces, device->shape.words_out)) {
        return SPTFRA_BAD_BUFFER;
    }
    if (polls == SPTFRA_FOREVER) {
        polls = RECOVERY_POLLS;
    }
    code = sptfra_reset_dma(device, RESET_POLLS);
    if (code != SPTFRA_OK) {
        return code;
    }
    if (device->has_registers) {
        SET(device, CONTROL, SPTFRA__CONTROL__SOFT_RESET_bm);
    }
    /* One word with TLAST: the end of a packet that the reset has cut, else a bad frame of its own. */
    memset(stress->data, 0, 4u);
    hand_over(device, stress, 1u, forces);
    transfer(device, SEND, stress->address, 4u);
    for (packets = 0; packets < MOST_PACKETS && code == SPTFRA_OK; packets++) {
        code = drop_packet(device, forces, polls);
    }
    if (code != SPTFRA_TIMEOUT) {
        return code == SPTFRA_OK ? SPTFRA_TIMEOUT : code;
    }
    /* The transfer that waits for one packet more goes. */
    code = sptfra_reset_dma(device, RESET_POLLS);
    if (code == SPTFRA_OK && device->has_registers) {
        code = reset_over(device, polls);
    }
    if (code == SPTFRA_OK) {
        follow_number(device);
        device->busy = 0;
    }
    return code;
}

int sptfra_reset_dma(sptfra *device, uint32_t polls)
{
    static const uint32_t channels[2] = {SEND, RECEIVE};
    size_t index;

    /* A reset on either channel resets both. */
    dma_set(device, SEND + DMA_CONTROL, CONTROL_RESET);
    while (dma_get(device, SEND + DMA_CONTROL) & CONTROL_RESET) {
        if (polls == 0) {
            return SPTFRA_TIMEOUT;
        }
        polls -= polls != SPTFRA_FOREVER;
    }
    for (index = 0; index < 2; index++) {
        dma_set(device, channels[index] + DMA_CONTROL, CONTROL_RUN | CONTROL_INTERRUPT);
        while (dma_get(device, channels[index] + DMA_STATUS) & STATUS_HALTED) {
            if (polls == 0) {
                return SPTFRA_TIMEOUT;
            }
            polls -= polls != SPTFRA_FOREVER;
        }
    }
    return SPTFRA_OK;
}

const char *sptfra_status_name(unsigned bit)
{
    static const char *const names[] = {
        "no contact",
        "direction unknown",
        "optimum at the bound",
        "saturated",
        "NaN or infinity in",
        "frame length wrong",
        "doubtful",
        "more bodies than records",
        "dead taxel replaced",
        "too many replaced",
        "slip",
        "no tension",
        "frames dropped before",
    };

    return bit < sizeof names / sizeof names[0] ? names[bit] : NULL;
}

int sptfra_decode(const sptfra_shape *shape, const void *words, sptfra_result *result)
{
    const uint32_t *raw = words;
    const float *values = words;
    uint32_t census;

    if ((uintptr_t)words % sizeof *raw != 0) {
        return SPTFRA_BAD_BUFFER;
    }
    census = raw[SPTFRA_WORD_CENSUS];

    result->status = (uint16_t)(raw[SPTFRA_WORD_STATUS] & 0xFFFFu);
    result->number = (uint16_t)FIELD(raw[SPTFRA_WORD_STATUS], LAST_STATUS__NUMBER);
    result->timestamp = raw[SPTFRA_WORD_TIMESTAMP];
    memcpy(result->force, values + SPTFRA_WORD_FORCE, sizeof result->force);
    memcpy(result->torque, values + SPTFRA_WORD_TORQUE, sizeof result->torque);
    memcpy(&result->friction, values + SPTFRA_WORD_FRICTION, sizeof result->friction);
    memcpy(&result->direction, values + SPTFRA_WORD_DIRECTION, sizeof result->direction);
    memcpy(result->friction_xy, values + SPTFRA_WORD_FRICTION_XY, sizeof result->friction_xy);
    memcpy(&result->standard_error, values + SPTFRA_WORD_STANDARD_ERROR, sizeof result->standard_error);
    result->bodies = (uint8_t)(census & 0xFFu);
    result->generation = (uint8_t)(census >> 8 & 0xFFu);
    result->replaced = (uint8_t)(census >> 16 & 0xFFu);
    result->field = shape->has_field ? values + SPTFRA_SUMMARY_WORDS : NULL;
    return SPTFRA_OK;
}

/* ---- Linux user space */

#if defined(__linux__) && !defined(SPTFRA_NO_UIO)

int sptfra_uio_open(sptfra_uio *uio, const char *path, size_t bytes)
{
    void *base;

    uio->file = open(path, O_RDWR | O_CLOEXEC);
    if (uio->file < 0) {
        return SPTFRA_SYSTEM;
    }
    base = mmap(NULL, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, uio->file, 0);
    if (base == MAP_FAILED) {
        const int why = errno;

        close(uio->file);
        errno = why;
        return SPTFRA_SYSTEM;
    }
    uio->bytes = bytes;
    uio->base = (uintptr_t)base;
    return SPTFRA_OK;
}

void sptfra_uio_close(sptfra_uio *uio)
{
    munmap((void *)uio->base, uio->bytes);
    close(uio->file);
    uio->file = -1;
}

static int64_t now(void)
{
    struct timespec time;

    clock_gettime(CLOCK_MONOTONIC, &time);
    return (int64_t)time.tv_sec * 1000 + time.tv_nsec / 1000000;
}

int sptfra_uio_wait(const sptfra_uio *uio, int milliseconds)
{
    const int64_t end = now() + milliseconds;
    struct pollfd waits = {.fd = uio->file, .events = POLLIN};
    uint32_t word = 1;
    ssize_t moved;
    int ready;

    /* A UIO driver masks the interrupt when it comes; writing 1 unmasks it. */
    do {
        moved = write(uio->file, &word, sizeof word);
    } while (moved < 0 && errno == EINTR);
    if (moved != (ssize_t)sizeof word) {
        return SPTFRA_SYSTEM;
    }
    do {
        const int64_t left = end - now();

        ready = poll(&waits, 1, milliseconds < 0 ? -1 : left < 0 ? 0 : (int)left);
    } while (ready < 0 && errno == EINTR);
    if (ready < 0) {
        return SPTFRA_SYSTEM;
    }
    if (ready == 0) {
        return SPTFRA_TIMEOUT;
    }
    do {
        moved = read(uio->file, &word, sizeof word);
    } while (moved < 0 && errno == EINTR);
    return moved == (ssize_t)sizeof word ? SPTFRA_OK : SPTFRA_SYSTEM;
}

#endif
