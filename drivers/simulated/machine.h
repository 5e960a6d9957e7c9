/* SPDX-License-Identifier: MIT OR Apache-2.0 */
/* A processor's view of a simulated system: the core's registers, an AXI DMA and memory. Time passes only while
 * registers are accessed, a few cycles each. */
#ifndef MACHINE_H
#define MACHINE_H

#include <stdint.h>

#define MACHINE_DMA 0xA0000000u
#define MACHINE_CORE 0xA0010000u
/* What the DMA's addresses lie above the processor's: they are not to be mixed up. */
#define MACHINE_BUS_OFFSET 0x100000000000u

typedef struct machine machine;

/* Loads the simulated core; NULL and a message on standard error if that fails. `has_registers`: it has a bank. */
machine *machine_open(const char *library, uint32_t seed, int has_registers);
void machine_close(machine *system);
uint32_t machine_read(void *system, uintptr_t address);
void machine_write(void *system, uintptr_t address, uint32_t value);
/* Lets cycles pass. */
void machine_run(machine *system, uint64_t cycles);
int machine_interrupt(const machine *system);
/* Whether a transfer to the core is under way. */
int machine_sends(const machine *system);
/* Accesses that were answered by an error or hit nothing. */
uint32_t machine_faults(const machine *system);

/* Since it was opened. */
uint64_t machine_cycles(const machine *system);

/* ---- How the DMA and the streams behave; at first transfers start at once, and both ends pause at random */

/* The DMA goes by descriptors, before anything else is done with it. */
void machine_scatter_gather(machine *system);
/* A transfer starts, a descriptor is fetched and closed in so many cycles at most, at random. */
void machine_dma_cycles(machine *system, uint32_t most);
/* For measuring: no pauses, so many cycles for each access to a register of the DMA and for each of its steps. */
void machine_even(machine *system, uint32_t access, uint32_t step);
/* Stops a channel with an error: a bit of its status, as in dma.h. */
void machine_fail(machine *system, int receiving, uint32_t error);

#endif
