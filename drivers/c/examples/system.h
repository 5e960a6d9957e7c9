/* SPDX-License-Identifier: MIT OR Apache-2.0 */
/* Where a core is: on the board (linux.c) or simulated on the desk (simulated.c). */
#ifndef SYSTEM_H
#define SYSTEM_H

#include "sptfra.h"

/* What main() says of the arguments that system_open takes, and how many they are. */
extern const char system_usage[];
extern const int system_arguments;

/* What the command line says of the system. */
typedef struct {
    const sptfra_shape *shape; /* of a core without registers; NULL: it has some */
    uint32_t queue;            /* frames on their way at a time, by a DMA with descriptors; 0: one, by another DMA */
} system_options;

/* Opens the core with its DMA, and memory that both reach. 0 after a message on standard error, else 1. */
int system_open(sptfra *device, sptfra_buffer *memory, const system_options *options, char **arguments);
/* Sleeps until forces were received. SPTFRA_OK, or as sptfra_uio_wait. */
int system_wait(void);
void system_close(void);

#endif
