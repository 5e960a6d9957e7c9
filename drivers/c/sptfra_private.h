/* SPDX-License-Identifier: MIT OR Apache-2.0 */
/* What the driver's own files share; programs include sptfra.h and sptfra_queue.h. */
#ifndef SPTFRA_PRIVATE_H
#define SPTFRA_PRIVATE_H

#include "sptfra.h"

#if !defined(__GNUC__)
#include <stdatomic.h>
#endif

/* AXI DMA: offsets of both channels, registers of a channel, bits. */
#define SEND 0x00u
#define RECEIVE 0x30u
#define DMA_CONTROL 0x00u
#define DMA_STATUS 0x04u
#define CONTROL_RUN 0x0001u
#define CONTROL_RESET 0x0004u
#define CONTROL_INTERRUPT 0x1000u /* on completion */
#define STATUS_HALTED 0x0001u
#define STATUS_IDLE 0x0002u
#define STATUS_SCATTER_GATHER 0x0008u /* it goes by descriptors, and knows no other way */
#define STATUS_FAULTS 0x0770u
#define STATUS_INTERRUPTS 0x7000u
#define RESET_POLLS 100000u
#define RECOVERY_POLLS 1000000u
#define MOST_PACKETS 32 /* more than a core holds */

#define FIELD(word, name) (((word) & SPTFRA__##name##_bm) >> SPTFRA__##name##_bp)
#define GET(device, register) get(device, offsetof(sptfra_t, register))
#define SET(device, register, value) set(device, offsetof(sptfra_t, register), value)

static inline uint32_t get(const sptfra *device, size_t offset)
{
    return device->platform.read(device->platform.context, device->core + offset);
}

static inline void set(const sptfra *device, size_t offset, uint32_t value)
{
    device->platform.write(device->platform.context, device->core + offset, value);
}

static inline uint32_t dma_get(const sptfra *device, uint32_t offset)
{
    return device->platform.read(device->platform.context, device->dma + offset);
}

static inline void dma_set(const sptfra *device, uint32_t offset, uint32_t value)
{
    device->platform.write(device->platform.context, device->dma + offset, value);
}

/* Registers are volatile, buffers are not: neither the compiler nor the processor may move one past the other. */
static inline void barrier(const sptfra *device)
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

static inline void flush_lines(const sptfra *device, const void *start, size_t bytes)
{
    if (device->platform.flush != NULL) {
        device->platform.flush(device->platform.context, start, bytes);
    }
}

static inline void invalidate_lines(const sptfra *device, void *start, size_t bytes)
{
    if (device->platform.invalidate != NULL) {
        device->platform.invalidate(device->platform.context, start, bytes);
    }
}

static inline size_t whole_lines(size_t bytes)
{
    return (bytes + SPTFRA_LINE - 1u) / SPTFRA_LINE * SPTFRA_LINE;
}

/* Resets both channels of the DMA and leaves them halted. */
int sptfra_halt_dma(sptfra *device, uint32_t polls);
/* Lets a channel run. */
int sptfra_run_dma(sptfra *device, uint32_t channel, uint32_t polls);
/* Until a soft reset has taken place. */
int sptfra_reset_over(sptfra *device, uint32_t polls);
/* Takes over the number that the core gives to the next frame. */
void sptfra_follow_number(sptfra *device);
/* Whether the answer is that to the next frame; counts on. */
int sptfra_in_step(sptfra *device, const void *answer);

/* Why no bank takes what it is given, and where. */
typedef struct {
    int what;
    uint32_t place;
} sptfra_refusal;

enum {
    SPTFRA_WRONG_TAXEL,       /* gain or offset of this taxel */
    SPTFRA_NOT_REPLACED,      /* this taxel of gain 0 */
    SPTFRA_TOO_MANY_DEAD,     /* for a bank with room for so many */
    SPTFRA_NO_SUCH_TAXEL,     /* this dead one, or it does not ascend */
    SPTFRA_WRONG_WEIGHT,      /* of this taxel */
    SPTFRA_TOO_LARGE_WEIGHTS, /* of all in this dead one */
    SPTFRA_WRONG_POINTS,      /* too few or many for a curve of so many segments */
    SPTFRA_WRONG_POINT,       /* this one, after the one before */
    SPTFRA_WRONG_NOISE
};

/* Whether sptfra_load_bank_and_curve would take it; of SPTFRA_OUT_OF_RANGE `why` tells more. */
int sptfra_check_bank(const sptfra *device, const double *gain, const double *offset, const sptfra_replaced *replaced,
    const sptfra_curve *curve, double noise_floor_pa, sptfra_refusal *why);

#endif
