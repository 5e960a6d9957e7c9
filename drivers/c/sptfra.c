/* SPDX-License-Identifier: MIT OR Apache-2.0 */
/* See sptfra.h. */
#include "sptfra_private.h"

#include <string.h>

/* "TFRA", and the version of the register map that this driver knows. */
#define MAGIC 0x54465241u
#define MAP_VERSION 3u

/* AXI DMA in direct register mode. */
#define DMA_ADDRESS 0x18u
#define DMA_ADDRESS_HIGH 0x1Cu
#define DMA_LENGTH 0x28u

size_t sptfra_frame_bytes(const sptfra_shape *shape)
{
    return (shape->samples == SPTFRA_FLOAT32 ? 4u : 2u) * (size_t)shape->columns * shape->rows;
}

/* Words of an answer: the summary, and with a field three forces of each taxel. */
static size_t answer_words(const sptfra_shape *shape)
{
    return SPTFRA_SUMMARY_WORDS + (shape->has_field ? 3u * (size_t)shape->columns * shape->rows : 0u);
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

/* ---- The core */

/* The core numbers frames as they come in. */
void sptfra_follow_number(sptfra *device)
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
    sptfra_follow_number(device);
    return sptfra_reset_dma(device, RESET_POLLS);
}

int sptfra_open_streams(sptfra *device, const sptfra_platform *platform, uintptr_t dma, const sptfra_shape *shape)
{
    memset(device, 0, sizeof *device);
    device->platform = *platform;
    device->dma = dma;
    device->shape = *shape;
    if (shape->words_out != answer_words(shape)) {
        return SPTFRA_BAD_SHAPE;
    }
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
    identity->calibration_in_ram = (uint8_t)FIELD(features, FEATURES__CALIBRATION_RAM);
    identity->curve_in_ram = (uint8_t)FIELD(features, FEATURES__CURVE_IN_RAM);
    identity->replaceable = (uint8_t)FIELD(features, FEATURES__REPLACEABLE);
    identity->drops_frames = (uint8_t)FIELD(features, FEATURES__DROPS);
    identity->averages_frames = (uint8_t)FIELD(features, FEATURES__AVERAGES);
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

int sptfra_set_smoothing(const sptfra *device, uint32_t k)
{
    if (!device->has_registers) {
        return SPTFRA_NO_REGISTERS;
    }
    if (!FIELD(GET(device, FEATURES), FEATURES__AVERAGES)) {
        return SPTFRA_NO_SMOOTHING;
    }
    if (k > 8u) {
        return SPTFRA_OUT_OF_RANGE;
    }
    SET(device, SMOOTHING, k);
    return SPTFRA_OK;
}

int sptfra_reset_over(sptfra *device, uint32_t polls)
{
    while (FIELD(GET(device, STATUS), STATUS__RESETTING)) {
        if (polls == 0) {
            return SPTFRA_TIMEOUT;
        }
        polls -= polls != SPTFRA_FOREVER;
    }
    sptfra_follow_number(device);
    return SPTFRA_OK;
}

int sptfra_soft_reset(sptfra *device, uint32_t polls)
{
    if (!device->has_registers) {
        return SPTFRA_NO_REGISTERS;
    }
    if (device->scatter_gather) {
        /* What is on its way would be numbered anew. */
        return SPTFRA_QUEUE_ONLY;
    }
    SET(device, CONTROL, SPTFRA__CONTROL__SOFT_RESET_bm);
    return sptfra_reset_over(device, polls);
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
    flush_lines(device, stress->data, whole_lines(4u * words));
    flush_lines(device, forces->data, whole_lines(4u * (size_t)device->shape.words_out));
    barrier(device);
}

int sptfra_start_words(sptfra *device, const sptfra_buffer *stress, size_t words, const sptfra_buffer *forces)
{
    if (device->busy) {
        return SPTFRA_BUSY;
    }
    if (device->scatter_gather) {
        return SPTFRA_QUEUE_ONLY;
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
    const size_t answer = 4u * (size_t)device->shape.words_out;

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
    invalidate_lines(device, forces->data, whole_lines(answer));
    if (!sptfra_in_step(device, forces->data)) {
        return SPTFRA_OUT_OF_STEP;
    }
    device->busy = 0;
    return SPTFRA_OK;
}

int sptfra_in_step(sptfra *device, const void *answer)
{
    uint32_t status;
    uint16_t number;

    memcpy(&status, answer, sizeof status);
    number = (uint16_t)FIELD(status, LAST_STATUS__NUMBER);
    if (device->knows_number && number != device->next_number) {
        return 0;
    }
    device->knows_number = 1;
    device->next_number = (uint16_t)(number + 1u);
    return 1;
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

    if (device->scatter_gather) {
        return SPTFRA_QUEUE_ONLY;
    }
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
        code = sptfra_reset_over(device, polls);
    }
    if (code == SPTFRA_OK) {
        sptfra_follow_number(device);
        device->busy = 0;
    }
    return code;
}

int sptfra_halt_dma(sptfra *device, uint32_t polls)
{
    /* A reset on either channel resets both. */
    dma_set(device, SEND + DMA_CONTROL, CONTROL_RESET);
    while (dma_get(device, SEND + DMA_CONTROL) & CONTROL_RESET) {
        if (polls == 0) {
            return SPTFRA_TIMEOUT;
        }
        polls -= polls != SPTFRA_FOREVER;
    }
    device->scatter_gather = (dma_get(device, SEND + DMA_STATUS) & STATUS_SCATTER_GATHER) != 0;
    return SPTFRA_OK;
}

int sptfra_run_dma(sptfra *device, uint32_t channel, uint32_t polls)
{
    dma_set(device, channel + DMA_CONTROL, CONTROL_RUN | CONTROL_INTERRUPT);
    while (dma_get(device, channel + DMA_STATUS) & STATUS_HALTED) {
        if (polls == 0) {
            return SPTFRA_TIMEOUT;
        }
        polls -= polls != SPTFRA_FOREVER;
    }
    return SPTFRA_OK;
}

int sptfra_reset_dma(sptfra *device, uint32_t polls)
{
    int code = sptfra_halt_dma(device, polls);

    /* Descriptors have to be there before it runs: the queue's affair. */
    if (code == SPTFRA_OK && !device->scatter_gather) {
        code = sptfra_run_dma(device, SEND, polls);
        code = code == SPTFRA_OK ? sptfra_run_dma(device, RECEIVE, polls) : code;
    }
    return code;
}
