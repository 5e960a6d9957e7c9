/* SPDX-License-Identifier: MIT OR Apache-2.0 */
/* See dma.h. */
#include "dma.h"

#include <string.h>

#define HALTED 0x0001u
#define IDLE 0x0002u
#define SCATTER_GATHER 0x0008u
#define DONE 0x1000u
#define EVENTS 0x7000u

/* Words of a descriptor. */
enum { NEXT, NEXT_HIGH, ADDRESS, ADDRESS_HIGH, CONTROL = 6, STATUS };
#define LENGTH_MASK 0x03FFFFFFu
#define PACKET_END (1u << 26)
#define PACKET_START (1u << 27)
#define COMPLETE (1u << 31)
#define DESCRIPTOR_BYTES 64u

static uint32_t *words_at(const dma *of, uint64_t bus) { return (uint32_t *)(uintptr_t)(bus - of->offset); }

static uint64_t pair(const uint32_t *words) { return (uint64_t)words[1] << 32 | words[0]; }

/* Cycles until the next step. */
static uint32_t wait(dma *of)
{
    of->noise = of->noise * 1664525u + 1013904223u;
    return of->even || of->step == 0 ? of->step : (of->noise >> 16) % (of->step + 1u);
}

void dma_reset(dma *of)
{
    memset(of->channels, 0, sizeof of->channels);
    of->channels[DMA_SEND].status = of->channels[DMA_RECEIVE].status = HALTED | (of->scatter_gather ? SCATTER_GATHER : 0u);
}

void dma_fail(dma *of, int channel, uint32_t error)
{
    dma_channel *stopped = &of->channels[channel];

    stopped->status |= error | HALTED;
    stopped->control &= ~1u;
    stopped->busy = stopped->closing = stopped->goes_on = 0;
}

static uint32_t *plain_register(dma *of, dma_channel *channel, uint32_t offset)
{
    uint64_t *address = offset < 0x10 ? &channel->current : offset < 0x18 ? &channel->tail : &channel->address;

    switch (offset) {
    case 0x00: return &channel->control;
    case 0x04: return &channel->status;
    case 0x28: return of->scatter_gather ? NULL : &channel->length;
    case 0x08: case 0x0C: case 0x10: case 0x14:
        return of->scatter_gather ? (uint32_t *)address + (offset >> 2 & 1u) : NULL;
    case 0x18: case 0x1C:
        return of->scatter_gather ? NULL : (uint32_t *)address + (offset >> 2 & 1u);
    default: return NULL;
    }
}

uint32_t dma_read(dma *of, uint32_t offset)
{
    const uint32_t *source = plain_register(of, &of->channels[offset >= 0x30], offset >= 0x30 ? offset - 0x30 : offset);

    of->faults += source == NULL;
    return source == NULL ? 0 : *source;
}

static void begin(dma *of, dma_channel *channel)
{
    /* Only a running channel without a transfer takes one, from where a beat may begin. */
    if ((channel->status & HALTED) || channel->busy || channel->goes_on || channel->length == 0
        || channel->address % of->beat != 0) {
        of->faults++;
        return;
    }
    channel->place = channel->address;
    channel->bytes = channel->length;
    channel->at_start = channel->at_end = 1;
    channel->moved = 0;
    channel->goes_on = 1;
    channel->countdown = wait(of);
    channel->status &= ~IDLE;
}

void dma_write(dma *of, uint32_t offset, uint32_t value)
{
    dma_channel *channel = &of->channels[offset >= 0x30];
    uint32_t *target = plain_register(of, channel, offset >= 0x30 ? offset - 0x30 : offset);

    offset -= offset >= 0x30 ? 0x30 : 0;
    if (target == NULL) {
        of->faults++;
    } else if (offset == 0x00 && (value & 4)) {
        dma_reset(of);
    } else if (offset == 0x00) {
        channel->control = value;
        channel->status = (channel->status & ~HALTED) | !(value & 1);
    } else if (offset == 0x04) {
        channel->status &= ~(value & EVENTS);
    } else if (offset == 0x28) {
        *target = value;
        begin(of, channel);
    } else if (offset < 0x10 && !(channel->status & HALTED)) {
        of->faults++; /* the first descriptor of a running channel */
    } else {
        *target = value;
        /* Behind 32 bits of address it is the upper half that starts. */
        if (offset == 0x14 && !(channel->status & HALTED) && !channel->goes_on) {
            channel->goes_on = 1;
            channel->status &= ~IDLE;
            channel->countdown = wait(of);
        }
    }
}

/* Reads the descriptor whose turn it is. */
static void fetch(dma *of, int index)
{
    dma_channel *channel = &of->channels[index];
    const uint32_t *words;

    if (channel->current == 0 || channel->current % DESCRIPTOR_BYTES != 0) {
        of->faults++;
        dma_fail(of, index, DMA_INTERNAL);
        return;
    }
    words = words_at(of, channel->current);
    if (words[STATUS] & COMPLETE) {
        dma_fail(of, index, DMA_DESCRIPTOR);
        return;
    }
    channel->place = pair(words + ADDRESS);
    channel->bytes = words[CONTROL] & LENGTH_MASK;
    channel->at_start = index == DMA_SEND ? (words[CONTROL] & PACKET_START) != 0 : !channel->in_packet;
    channel->at_end = (words[CONTROL] & PACKET_END) != 0;
    channel->moved = 0;
    if (channel->bytes == 0 || channel->place % of->beat != 0 || (index == DMA_SEND && channel->at_start == channel->in_packet)) {
        of->faults++;
        dma_fail(of, index, DMA_INTERNAL);
        return;
    }
    channel->busy = 1;
}

/* Writes what became of the descriptor, and goes on to the next. */
static void close_descriptor(dma *of, int index)
{
    dma_channel *channel = &of->channels[index];
    uint32_t *words = words_at(of, channel->current);
    uint32_t flags = COMPLETE;

    if (index == DMA_RECEIVE) {
        flags |= (channel->at_start ? PACKET_START : 0u) | (channel->at_end ? PACKET_END : 0u);
    }
    words[STATUS] = flags | channel->moved;
    channel->closing = 0;
    channel->status |= DONE;
    channel->goes_on = channel->current != channel->tail;
    channel->current = pair(words + NEXT);
    if (channel->goes_on) {
        channel->countdown = wait(of);
    } else {
        channel->status |= IDLE;
    }
}

void dma_cycle(dma *of)
{
    int index;

    for (index = 0; index < 2; index++) {
        dma_channel *channel = &of->channels[index];

        if (channel->busy || !(channel->goes_on || channel->closing)) {
            continue;
        }
        if (channel->countdown > 0) {
            channel->countdown--;
        } else if (channel->closing) {
            close_descriptor(of, index);
        } else if (of->scatter_gather) {
            fetch(of, index);
        } else {
            channel->busy = 1;
        }
    }
}

uint32_t *dma_memory(const dma *of, int channel)
{
    return words_at(of, of->channels[channel].place + of->channels[channel].moved);
}

void dma_moved(dma *of, int index, uint32_t bytes, int last)
{
    dma_channel *channel = &of->channels[index];

    channel->moved += bytes;
    if (channel->moved < channel->bytes && !last) {
        return;
    }
    channel->busy = 0;
    if (index == DMA_RECEIVE) {
        channel->at_end = last;
    }
    channel->in_packet = !channel->at_end;
    if (of->scatter_gather) {
        channel->closing = 1;
        channel->countdown = wait(of);
        return;
    }
    channel->goes_on = 0;
    channel->length = channel->moved;
    channel->status |= IDLE | DONE;
    if (index == DMA_RECEIVE && !last) {
        /* A packet longer than the transfer stops the DMA. */
        dma_fail(of, index, DMA_INTERNAL);
    }
}
