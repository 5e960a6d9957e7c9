/* SPDX-License-Identifier: MIT OR Apache-2.0 */
/* Many frames on their way at a time, through a DMA with descriptors (block_design.tcl with the word `queue`).
 *
 *   sptfra_queue queue;
 *   sptfra_queue_open(&queue, &core, &memory, 8);
 *   for (;;) {
 *       while ((room = sptfra_queue_room(&queue)) != NULL) {
 *           memcpy(room, next_frame(), sptfra_frame_bytes(&core.shape));
 *           sptfra_queue_send(&queue);
 *       }
 *       sptfra_queue_take(&queue, &answer, SPTFRA_FOREVER);
 *       sptfra_decode(&core.shape, answer, &result);
 *   }
 *
 * Answers come in the order of the frames, each is checked by its number, and none is lost that is not reported: after
 * any error but SPTFRA_TIMEOUT, sptfra_queue_recover says how many frames will have no answer. */
#ifndef SPTFRA_QUEUE_H
#define SPTFRA_QUEUE_H

#include "sptfra.h"

#ifdef __cplusplus
extern "C" {
#endif

#define SPTFRA_LEAST_QUEUED 2u
#define SPTFRA_MOST_QUEUED 256u

typedef struct {
    sptfra *device;
    sptfra_buffer memory;
    uint32_t depth;          /* frames on their way at most */
    size_t stress, forces;   /* where the frames and answers begin in the memory, behind the descriptors */
    size_t stride_in, stride_out;
    uint32_t sent, taken;    /* frames since the last recovery, modulo 2^32 */
    uint32_t next_in, next_out; /* their places in the rings */
    int held;                /* the answer of frame `taken` is the caller's */
    int failed;
} sptfra_queue;

/* Bytes of memory that a queue of so many frames needs. */
size_t sptfra_queue_bytes(const sptfra_shape *shape, uint32_t depth);
/* Takes over the DMA of an open device. The memory, which the DMA reaches and which begins on a multiple of SPTFRA_LINE
 * for either side, belongs to the queue until the device is opened anew. 2 to 256 frames. SPTFRA_NO_QUEUE if the DMA has
 * no descriptors, SPTFRA_BAD_BUFFER for memory or a depth that will not do, SPTFRA_DROPS for a core that drops frames, whose
 * answers nobody could tell apart. */
int sptfra_queue_open(sptfra_queue *queue, sptfra *device, const sptfra_buffer *memory, uint32_t depth);
/* Where to write the next frame, words_in words; NULL while as many are on their way as there may be, or after an error. */
void *sptfra_queue_room(const sptfra_queue *queue);
/* Sends what was written there. SPTFRA_BUSY if there is no room. */
int sptfra_queue_send(sptfra_queue *queue);
/* Waits for the answer to the oldest frame, asking at most so many times: words_out words, the caller's until the next
 * call but sptfra_queue_send and _room. SPTFRA_NOT_STARTED if no frame is on its way. */
int sptfra_queue_take(sptfra_queue *queue, const void **answer, uint32_t polls);
/* The frame that the caller's answer is the answer to, words_in words as they were sent, as long as that is the caller's;
 * else NULL. */
const void *sptfra_queue_frame(const sptfra_queue *queue);
/* Lets the DMA's interrupts come again. To wait by them: this, then _take with 0 polls, and if that is SPTFRA_TIMEOUT wait
 * for the interrupt, and once more from the beginning. */
void sptfra_queue_acknowledge(const sptfra_queue *queue);
/* Frames that were sent and whose answers were not taken. */
uint32_t sptfra_queue_length(const sptfra_queue *queue);
/* After any error: resets DMA and core, drops what the core still sends, and begins anew with an empty queue. `lost`
 * frames, the last ones sent, will have no answer. The core counts as empty when none has come in so many polls. */
int sptfra_queue_recover(sptfra_queue *queue, uint32_t polls, uint32_t *lost);

#ifdef __cplusplus
}
#endif

#endif
