/* SPDX-License-Identifier: MIT OR Apache-2.0 */
/* The simulated core on the desk: CORE.so is what `testbench build DESIGN` names. */
#include "system.h"

#include "machine.h"

#include <stdio.h>

#define SEED 1u

const char system_usage[] = "CORE.so ";
const int system_arguments = 1;

_Alignas(SPTFRA_LINE) static unsigned char bytes[1u << 20];
static machine *system_machine;

int system_open(sptfra *device, sptfra_buffer *memory, char **arguments)
{
    sptfra_platform platform = {NULL, machine_read, machine_write, NULL, NULL, NULL};
    int code;

    system_machine = machine_open(arguments[0], SEED, 1);
    if (system_machine == NULL) {
        return 0;
    }
    platform.context = system_machine;
    code = sptfra_open(device, &platform, MACHINE_CORE, MACHINE_DMA);
    if (code != SPTFRA_OK) {
        fprintf(stderr, "core: %s (the design needs control = true)\n", sptfra_error(code));
    }
    *memory = (sptfra_buffer){bytes, (uintptr_t)bytes + MACHINE_BUS_OFFSET, sizeof bytes};
    return code == SPTFRA_OK;
}

/* Time passes while registers are read. */
int system_wait(void) { return SPTFRA_OK; }

void system_close(void) { machine_close(system_machine); }
