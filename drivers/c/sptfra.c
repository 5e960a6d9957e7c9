/* See sptfra.h. */
#if defined(__linux__) && !defined(SPTFRA_NO_UIO)
#define _POSIX_C_SOURCE 200809L
#endif

#include "sptfra.h"

#include <string.h>

#if defined(__linux__) && !defined(SPTFRA_NO_UIO)
#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
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
    case SPTFRA_BAD_BUFFER: return "a buffer is too small or not on a multiple of four bytes";
    case SPTFRA_TIMEOUT: return "no answer in the polls given";
    case SPTFRA_DMA_FAULT: return "the DMA stopped with an error; its status register says which";
    case SPTFRA_CUT_SHORT: return "the answer is shorter than a frame's";
    case SPTFRA_SYSTEM: return "the operating system refused; errno says why";
    default: return "unknown code";
    }
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

const sptfra_platform sptfra_memory_mapped = {NULL, mapped_read, mapped_write, NULL, NULL};

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
    counters->last_status = GET(device, LAST_STATUS);
    counters->last_latency = GET(device, LAST_LATENCY);
    counters->last_interval = GET(device, LAST_INTERVAL);
    return SPTFRA_OK;
}

int sptfra_soft_reset(const sptfra *device, uint32_t polls)
{
    if (!device->has_registers) {
        return SPTFRA_NO_REGISTERS;
    }
    SET(device, CONTROL, SPTFRA__CONTROL__SOFT_RESET_bm);
    while (FIELD(GET(device, STATUS), STATUS__RESETTING)) {
        if (polls == 0) {
            return SPTFRA_TIMEOUT;
        }
        polls -= polls != SPTFRA_FOREVER;
    }
    return SPTFRA_OK;
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

static int fits(const sptfra_buffer *buffer, size_t words)
{
    return buffer->data != NULL && buffer->address % 4u == 0 && buffer->bytes >= 4u * words;
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

int sptfra_start_words(const sptfra *device, const sptfra_buffer *stress, size_t words, const sptfra_buffer *forces)
{
    const sptfra_platform *platform = &device->platform;
    const size_t answer = 4u * (size_t)device->shape.words_out;

    if (words == 0 || !fits(stress, words) || !fits(forces, device->shape.words_out)) {
        return SPTFRA_BAD_BUFFER;
    }
    if (platform->flush != NULL) {
        platform->flush(platform->context, stress->data, 4u * words);
        /* No dirty line may be written over the answer later. */
        platform->flush(platform->context, forces->data, answer);
    }
    transfer(device, RECEIVE, forces->address, answer);
    transfer(device, SEND, stress->address, 4u * words);
    return SPTFRA_OK;
}

int sptfra_start(const sptfra *device, const sptfra_buffer *stress, const sptfra_buffer *forces)
{
    return sptfra_start_words(device, stress, device->shape.words_in, forces);
}

int sptfra_wait(const sptfra *device, const sptfra_buffer *forces, uint32_t polls)
{
    const sptfra_platform *platform = &device->platform;
    const size_t answer = 4u * (size_t)device->shape.words_out;

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
    if (platform->invalidate != NULL) {
        platform->invalidate(platform->context, forces->data, answer);
    }
    return SPTFRA_OK;
}

int sptfra_process(const sptfra *device, const sptfra_buffer *stress, const sptfra_buffer *forces, uint32_t polls)
{
    const int code = sptfra_start(device, stress, forces);

    return code == SPTFRA_OK ? sptfra_wait(device, forces, polls) : code;
}

int sptfra_reset_dma(const sptfra *device, uint32_t polls)
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

void sptfra_decode(const sptfra_shape *shape, const void *words, sptfra_result *result)
{
    const uint32_t *raw = words;
    const float *values = words;
    const uint32_t census = raw[SPTFRA_WORD_CENSUS];

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

int sptfra_uio_wait(const sptfra_uio *uio, int milliseconds)
{
    struct pollfd waits = {.fd = uio->file, .events = POLLIN};
    uint32_t word = 1;
    int ready;

    /* A UIO driver masks the interrupt when it comes; writing 1 unmasks it. */
    if (write(uio->file, &word, sizeof word) != (ssize_t)sizeof word) {
        return SPTFRA_SYSTEM;
    }
    ready = poll(&waits, 1, milliseconds);
    if (ready < 0) {
        return SPTFRA_SYSTEM;
    }
    if (ready == 0) {
        return SPTFRA_TIMEOUT;
    }
    return read(uio->file, &word, sizeof word) == (ssize_t)sizeof word ? SPTFRA_OK : SPTFRA_SYSTEM;
}

#endif
