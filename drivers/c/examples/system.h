/* SPDX-License-Identifier: MIT OR Apache-2.0 */
/* Where a core is: on the board (linux.c) or simulated on the desk (simulated.c). */
#ifndef SYSTEM_H
#define SYSTEM_H

#include "sptfra.h"

/* What main() says of the arguments that system_open takes, and how many they are. */
extern const char system_usage[];
extern const int system_arguments;

/* Opens the core with its DMA, and memory that both reach. 0 after a message on standard error, else 1. */
int system_open(sptfra *device, sptfra_buffer *memory, char **arguments);
/* Sleeps until forces were received. SPTFRA_OK, or as sptfra_uio_wait. */
int system_wait(void);
void system_close(void);

#endif
