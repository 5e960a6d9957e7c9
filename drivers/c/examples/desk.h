/* SPDX-License-Identifier: MIT OR Apache-2.0 */
/* The simulated core, for bare_metal.c: its only argument is what `sptfra build DESIGN` names. */
#ifndef DESK_H
#define DESK_H

#include "machine.h"

#include <stdio.h>

#define BOARD_DMA MACHINE_DMA
#define BOARD_CORE MACHINE_CORE
#define BOARD_ARGUMENTS int count, char **arguments
#define BOARD_BUS(pointer) ((uint64_t)(uintptr_t)(pointer) + MACHINE_BUS_OFFSET)
#define BOARD_PRINT printf
#define BOARD_PLATFORM (count == 2 ? board_platform(arguments[1]) : NULL)

static const sptfra_platform *board_platform(const char *library)
{
    static sptfra_platform platform = {NULL, machine_read, machine_write, NULL, NULL, NULL};

    platform.context = machine_open(library, 1u, 1);
    return platform.context == NULL ? NULL : &platform;
}

#endif
