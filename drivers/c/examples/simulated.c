/* SPDX-License-Identifier: MIT OR Apache-2.0 */
/* The simulated core on the desk: CORE.so is what `sptfra build DESIGN` names. */
#include "system.h"

#include "machine.h"

#include <stdio.h>

#define SEED 1u

const char system_usage[] = "CORE.so ";
const int system_arguments = 1;

_Alignas(SPTFRA_LINE) static unsigned char bytes[1u << 20];
static machine *system_machine;

int system_open(sptfra *device, sptfra_buffer *memory, const system_options *options, char **arguments)
{
    sptfra_platform platform = {NULL, machine_read, machine_write, NULL, NULL, NULL};
    int code;

    system_machine = machine_open(arguments[0], SEED, options->shape == NULL);
    if (system_machine == NULL) {
        return 0;
    }
    platform.context = system_machine;
    if (options->queue > 0) {
        machine_scatter_gather(system_machine);
    }
    code = options->shape == NULL ? sptfra_open(device, &platform, MACHINE_CORE, MACHINE_DMA)
                                  : sptfra_open_streams(device, &platform, MACHINE_DMA, options->shape);
    if (code != SPTFRA_OK) {
        fprintf(stderr, "core: %s (a design without control = true needs --metadata)\n", sptfra_error(code));
    }
    *memory = (sptfra_buffer){bytes, (uintptr_t)bytes + MACHINE_BUS_OFFSET, sizeof bytes};
    return code == SPTFRA_OK;
}

/* Time passes while registers are read. */
int system_wait(void) { return SPTFRA_OK; }

void system_close(void) { machine_close(system_machine); }
