/* SPDX-License-Identifier: MIT OR Apache-2.0 */
/* An AXI DMA as its product guide (AMD PG021) describes it: registers, transfers one by one or by descriptors. */
#ifndef DMA_H
#define DMA_H

#include <stdint.h>

enum { DMA_SEND, DMA_RECEIVE };
/* Bits of a channel's status that are errors. */
enum {
    DMA_INTERNAL = 1 << 4,
    DMA_SLAVE = 1 << 5,
    DMA_DECODE = 1 << 6,
    DMA_DESCRIPTOR = 1 << 8 /* one was fetched that is complete already */
};

typedef struct {
    uint32_t control, status, length;
    uint64_t address, current, tail;
    uint64_t place; /* of the transfer, on the bus */
    uint32_t bytes; /* of the transfer */
    uint32_t moved; /* of those */
    int busy;       /* beats may move */
    int closing;    /* all moved, and the descriptor does not say so yet */
    int goes_on;    /* descriptors up to the tail are to come */
    int in_packet;  /* the next descriptor continues a packet */
    int at_end, at_start;
    uint32_t countdown; /* cycles to the next step */
} dma_channel;

typedef struct {
    dma_channel channels[2];
    int scatter_gather;
    uint32_t step;  /* cycles from a transfer's start or from one descriptor to the next, at most */
    int even;       /* always so many, not at random */
    uint32_t noise;
    uint32_t faults; /* accesses that hit nothing, or came at the wrong moment */
    uint32_t beat;   /* bytes of a beat */
    uint64_t offset; /* what the bus' addresses lie above the processor's */
} dma;

void dma_reset(dma *of);
uint32_t dma_read(dma *of, uint32_t offset);
void dma_write(dma *of, uint32_t offset, uint32_t value);
/* A cycle without a beat: fetches and closes descriptors. */
void dma_cycle(dma *of);
/* Where the next bytes of a busy channel are. */
uint32_t *dma_memory(const dma *of, int channel);
/* So many bytes of a busy channel were moved; `last` ends a packet that comes in. */
void dma_moved(dma *of, int channel, uint32_t bytes, int last);
/* Stops a channel with an error, as the bus would. */
void dma_fail(dma *of, int channel, uint32_t error);

#endif
