/* SPDX-License-Identifier: MIT OR Apache-2.0 */
/* See sptfra_queue.h. Two rings of descriptors, as AMD's PG021 has them: frame k is descriptor k modulo the depth of
 * either, and has its own place for values and for forces. */
#include "sptfra_queue.h"

#include <string.h>

#include "sptfra_private.h"

#define FIRST 0x08u /* of the descriptors, while the channel is halted */
#define LAST 0x10u /* the channel pauses behind it */

/* Words of a descriptor, which fills a line. */
enum { NEXT, NEXT_HIGH, ADDRESS, ADDRESS_HIGH, CONTROL = 6, STATUS };
#define DESCRIPTOR 64u
#define LENGTH_MASK 0x03FFFFFFu
#define PACKET_END (1u << 26)
#define PACKET_START (1u << 27)
#define WHOLE_PACKET (PACKET_START | PACKET_END)
#define FAULTS 0x70000000u
#define COMPLETE 0x80000000u

static size_t bytes_in(const sptfra_shape *shape) { return 4u * (size_t)shape->words_in; }

static size_t bytes_out(const sptfra_shape *shape) { return 4u * (size_t)shape->words_out; }

size_t sptfra_queue_bytes(const sptfra_shape *shape, uint32_t depth)
{
    return depth * (2u * DESCRIPTOR + whole_lines(bytes_in(shape)) + whole_lines(bytes_out(shape)));
}

/* ---- Descriptors: those of frames to the core, then those of answers */

static size_t place(const sptfra_queue *queue, uint32_t channel, uint32_t slot)
{
    return DESCRIPTOR * (size_t)(channel == RECEIVE ? queue->depth + slot : slot);
}

static void *at(const sptfra_queue *queue, size_t offset) { return (char *)queue->memory.data + offset; }

static uint64_t address_of(const sptfra_queue *queue, size_t offset) { return queue->memory.address + offset; }

static void set_address(const sptfra_queue *queue, uint32_t offset, uint64_t address)
{
    dma_set(queue->device, offset, (uint32_t)address);
    /* Behind more than 32 bits of address this write is the one that counts, and for a DMA with 32 it is none. */
    dma_set(queue->device, offset + 4u, (uint32_t)(address >> 32));
}

/* Makes a descriptor new for a transfer of so many bytes. */
static void renew(const sptfra_queue *queue, uint32_t channel, uint32_t slot, size_t bytes)
{
    volatile uint32_t *words = at(queue, place(queue, channel, slot));
    const uint64_t next = address_of(queue, place(queue, channel, (slot + 1u) % queue->depth));
    const uint64_t data = channel == RECEIVE ? address_of(queue, queue->forces + slot * queue->stride_out)
                                             : address_of(queue, queue->stress + slot * queue->stride_in);

    words[NEXT] = (uint32_t)next;
    words[NEXT_HIGH] = (uint32_t)(next >> 32);
    words[ADDRESS] = (uint32_t)data;
    words[ADDRESS_HIGH] = (uint32_t)(data >> 32);
    words[CONTROL] = (uint32_t)bytes | (channel == SEND ? WHOLE_PACKET : 0u);
    words[STATUS] = 0;
    flush_lines(queue->device, (const void *)at(queue, place(queue, channel, slot)), DESCRIPTOR);
}

/* What has become of a descriptor. */
static uint32_t status_of(const sptfra_queue *queue, uint32_t channel, uint32_t slot)
{
    volatile uint32_t *words = at(queue, place(queue, channel, slot));

    invalidate_lines(queue->device, at(queue, place(queue, channel, slot)), DESCRIPTOR);
    return words[STATUS];
}

/* Lets a channel go on up to this descriptor. */
static void offer(const sptfra_queue *queue, uint32_t channel, uint32_t slot)
{
    barrier(queue->device);
    set_address(queue, channel + LAST, address_of(queue, place(queue, channel, slot)));
}

/* Offers the place of an answer to the DMA. */
static void offer_answer(const sptfra_queue *queue, uint32_t slot)
{
    renew(queue, RECEIVE, slot, bytes_out(&queue->device->shape));
    /* Nothing may be written over the answer later. */
    flush_lines(queue->device, at(queue, queue->forces + slot * queue->stride_out), queue->stride_out);
    offer(queue, RECEIVE, slot);
}

/* Sends the first bytes of a place. */
static void send(const sptfra_queue *queue, uint32_t slot, size_t bytes)
{
    flush_lines(queue->device, at(queue, queue->stress + slot * queue->stride_in), queue->stride_in);
    renew(queue, SEND, slot, bytes);
    offer(queue, SEND, slot);
}

/* An empty queue, and places for as many answers as it has. */
static int begin(sptfra_queue *queue)
{
    static const uint32_t channels[2] = {SEND, RECEIVE};
    int code = sptfra_halt_dma(queue->device, RESET_POLLS);
    uint32_t slot;
    size_t index;

    if (code == SPTFRA_OK && !queue->device->scatter_gather) {
        code = SPTFRA_NO_QUEUE;
    }
    for (slot = 0; slot < queue->depth && code == SPTFRA_OK; slot++) {
        renew(queue, SEND, slot, bytes_in(&queue->device->shape));
        renew(queue, RECEIVE, slot, bytes_out(&queue->device->shape));
        flush_lines(queue->device, at(queue, queue->forces + slot * queue->stride_out), queue->stride_out);
    }
    barrier(queue->device);
    for (index = 0; index < 2 && code == SPTFRA_OK; index++) {
        set_address(queue, channels[index] + FIRST, address_of(queue, place(queue, channels[index], 0)));
        code = sptfra_run_dma(queue->device, channels[index], RESET_POLLS);
    }
    queue->sent = queue->taken = 0;
    queue->next_in = queue->next_out = 0;
    queue->held = 0;
    queue->failed = code != SPTFRA_OK;
    if (code == SPTFRA_OK) {
        offer(queue, RECEIVE, queue->depth - 1u);
    }
    return code;
}

int sptfra_queue_open(sptfra_queue *queue, sptfra *device, const sptfra_buffer *memory, uint32_t depth)
{
    memset(queue, 0, sizeof *queue);
    queue->failed = 1;
    if (depth < SPTFRA_LEAST_QUEUED || depth > SPTFRA_MOST_QUEUED || memory->data == NULL
        || (uintptr_t)memory->data % SPTFRA_LINE != 0 || memory->address % SPTFRA_LINE != 0
        || memory->bytes < sptfra_queue_bytes(&device->shape, depth)) {
        return SPTFRA_BAD_BUFFER;
    }
    if (device->has_registers && FIELD(GET(device, FEATURES), FEATURES__DROPS)) {
        return SPTFRA_DROPS;
    }
    queue->device = device;
    queue->memory = *memory;
    queue->depth = depth;
    queue->stride_in = whole_lines(bytes_in(&device->shape));
    queue->stride_out = whole_lines(bytes_out(&device->shape));
    queue->stress = 2u * DESCRIPTOR * (size_t)depth;
    queue->forces = queue->stress + depth * queue->stride_in;
    memset(at(queue, queue->stress), 0, depth * queue->stride_in);
    return begin(queue);
}

/* ---- Frames */

void *sptfra_queue_room(const sptfra_queue *queue)
{
    if (queue->failed || queue->sent - queue->taken == queue->depth) {
        return NULL;
    }
    return at(queue, queue->stress + queue->next_in * queue->stride_in);
}

uint32_t sptfra_queue_length(const sptfra_queue *queue)
{
    return queue->sent - queue->taken - (queue->held ? 1u : 0u);
}

int sptfra_queue_send(sptfra_queue *queue)
{
    if (sptfra_queue_room(queue) == NULL) {
        return SPTFRA_BUSY;
    }
    send(queue, queue->next_in, bytes_in(&queue->device->shape));
    queue->sent++;
    queue->next_in = (queue->next_in + 1u) % queue->depth;
    return SPTFRA_OK;
}

/* Gives back the place of the answer that the caller has. */
static void release(sptfra_queue *queue)
{
    if (queue->held) {
        offer_answer(queue, queue->next_out);
        queue->taken++;
        queue->next_out = (queue->next_out + 1u) % queue->depth;
        queue->held = 0;
    }
}

/* Until a frame's two descriptors say that it has gone and its answer has come; what the latter says. */
static int await(const sptfra_queue *queue, uint32_t slot, uint32_t polls, uint32_t *received)
{
    for (;;) {
        const uint32_t sent = status_of(queue, SEND, slot);

        *received = status_of(queue, RECEIVE, slot);
        if ((sent | *received) & FAULTS) {
            return SPTFRA_DMA_FAULT;
        }
        if (sent & *received & COMPLETE) {
            return SPTFRA_OK;
        }
        /* One that has halted was reset by somebody else. */
        if ((dma_get(queue->device, SEND + DMA_STATUS) | dma_get(queue->device, RECEIVE + DMA_STATUS))
            & (STATUS_FAULTS | STATUS_HALTED)) {
            return SPTFRA_DMA_FAULT;
        }
        if (polls == 0) {
            return SPTFRA_TIMEOUT;
        }
        polls -= polls != SPTFRA_FOREVER;
    }
}

int sptfra_queue_take(sptfra_queue *queue, const void **answer, uint32_t polls)
{
    uint32_t slot, received, status;
    size_t bytes;
    void *forces;
    int code;

    if (queue->failed) {
        return SPTFRA_BUSY;
    }
    release(queue);
    if (queue->sent == queue->taken) {
        return SPTFRA_NOT_STARTED;
    }
    bytes = bytes_out(&queue->device->shape);
    slot = queue->next_out;
    code = await(queue, slot, polls, &received);
    if (code == SPTFRA_TIMEOUT) {
        return code;
    }
    if (code == SPTFRA_OK && ((received & WHOLE_PACKET) != WHOLE_PACKET || (received & LENGTH_MASK) != bytes)) {
        code = SPTFRA_CUT_SHORT;
    }
    forces = at(queue, queue->forces + slot * queue->stride_out);
    if (code == SPTFRA_OK) {
        /* Nothing of the answer is read before its descriptor was. */
        barrier(queue->device);
        invalidate_lines(queue->device, forces, queue->stride_out);
        memcpy(&status, forces, sizeof status);
        /* A core without registers does not say beforehand that it drops frames; its numbers leave those out. */
        code = sptfra_in_step(queue->device, forces) && !(status & SPTFRA_DROPPED) ? SPTFRA_OK : SPTFRA_OUT_OF_STEP;
    }
    if (code != SPTFRA_OK) {
        queue->failed = 1;
        return code;
    }
    queue->held = 1;
    *answer = forces;
    return SPTFRA_OK;
}

const void *sptfra_queue_frame(const sptfra_queue *queue)
{
    return queue->held ? at(queue, queue->stress + queue->next_out * queue->stride_in) : NULL;
}

void sptfra_queue_acknowledge(const sptfra_queue *queue)
{
    if (queue->device != NULL) {
        dma_set(queue->device, SEND + DMA_STATUS, STATUS_INTERRUPTS);
        dma_set(queue->device, RECEIVE + DMA_STATUS, STATUS_INTERRUPTS);
    }
}

/* ---- After an error */

/* Takes and drops answers until none comes. */
static int drop_answers(sptfra_queue *queue, uint32_t polls)
{
    uint32_t packets, left;

    for (packets = 0; packets < queue->depth + MOST_PACKETS; packets++) {
        const uint32_t slot = packets % queue->depth;

        left = polls;
        while (!(status_of(queue, RECEIVE, slot) & COMPLETE)) {
            if (dma_get(queue->device, RECEIVE + DMA_STATUS) & STATUS_FAULTS) {
                return SPTFRA_DMA_FAULT;
            }
            if (left-- == 0) {
                return SPTFRA_OK;
            }
        }
        offer_answer(queue, slot);
    }
    return SPTFRA_TIMEOUT;
}

int sptfra_queue_recover(sptfra_queue *queue, uint32_t polls, uint32_t *lost)
{
    sptfra *device = queue->device;
    const uint32_t without = sptfra_queue_length(queue);
    int code;

    *lost = 0;
    if (device == NULL) {
        return SPTFRA_BAD_BUFFER;
    }
    if (polls == SPTFRA_FOREVER) {
        polls = RECOVERY_POLLS;
    }
    code = begin(queue);
    if (code == SPTFRA_OK) {
        if (device->has_registers) {
            SET(device, CONTROL, SPTFRA__CONTROL__SOFT_RESET_bm);
        }
        /* A beat with TLAST: the end of a packet that the reset has cut, else a bad frame of its own. */
        memset(at(queue, queue->stress), 0, DESCRIPTOR);
        send(queue, 0, device->shape.stream_bytes > 4u ? device->shape.stream_bytes : 4u);
        code = drop_answers(queue, polls);
    }
    code = code == SPTFRA_OK ? begin(queue) : code;
    if (code == SPTFRA_OK && device->has_registers) {
        code = sptfra_reset_over(device, polls);
    }
    if (code == SPTFRA_OK) {
        sptfra_follow_number(device);
    }
    /* A recovery that failed leaves the count for the next. */
    queue->failed = code != SPTFRA_OK;
    queue->sent = queue->taken + (code == SPTFRA_OK ? 0u : without);
    *lost = code == SPTFRA_OK ? without : 0u;
    return code;
}
