/* SPDX-License-Identifier: MIT OR Apache-2.0 */
/* AMD's standalone platform, for bare_metal.c. Addresses as vivado/block_design.tcl gives them: here those of a Zynq
 * UltraScale+; on a Zynq-7000 compile with -DBOARD_DMA=0x40000000u -DBOARD_CORE=0x40010000u. */
#ifndef ZYNQ_H
#define ZYNQ_H

#include <xil_cache.h>
#include <xil_printf.h>

#ifndef BOARD_DMA
#define BOARD_DMA 0xA0000000u
#define BOARD_CORE 0xA0010000u
#endif
#define BOARD_ARGUMENTS void
#define BOARD_BUS(pointer) ((uint64_t)(uintptr_t)(pointer))
#define BOARD_PRINT xil_printf
#define BOARD_PLATFORM board_platform()

static void board_flush(void *context, const void *start, size_t bytes)
{
    (void)context;
    Xil_DCacheFlushRange((INTPTR)start, (INTPTR)bytes);
}

static void board_invalidate(void *context, void *start, size_t bytes)
{
    (void)context;
    Xil_DCacheInvalidateRange((INTPTR)start, (INTPTR)bytes);
}

static const sptfra_platform *board_platform(void)
{
    static sptfra_platform platform;

    platform = sptfra_memory_mapped;
    platform.flush = board_flush;
    platform.invalidate = board_invalidate;
    return &platform;
}

#endif
