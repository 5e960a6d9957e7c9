/* SPDX-License-Identifier: MIT OR Apache-2.0 */
/* Without an operating system: a frame that presses the middle of the grid, over and over, and its forces.
 *
 * BOARD_H says where the registers are and how caches and text work: zynq.h for AMD's standalone platform, desk.h for
 * the simulated core. */
#include "sptfra.h"

#include BOARD_H

#define FRAMES 4
#define MOST_BYTES 65536u
#define PRESSED_PA (-20000.0f)
#define POLLS 10000000u

/* Whole cache lines, shared with nothing. */
_Alignas(SPTFRA_LINE) static unsigned char stress_bytes[MOST_BYTES], force_bytes[MOST_BYTES];

/* Pressure on the four taxels in the middle. Counts of 16 bits would be written as such. */
static void press(const sptfra_shape *shape, float *stress)
{
    const unsigned taxels = (unsigned)shape->columns * shape->rows;
    unsigned index;

    for (index = 0; index < taxels; index++) {
        const unsigned x = index % shape->columns, y = index / shape->columns;
        const int inside = (x + 1u == shape->columns / 2u || x == shape->columns / 2u)
            && (y + 1u == shape->rows / 2u || y == shape->rows / 2u);

        stress[index] = inside ? PRESSED_PA : 0.0f;
    }
}

int main(BOARD_ARGUMENTS)
{
    sptfra core;
    sptfra_result result;
    int frame, code;
    const sptfra_buffer stress = {stress_bytes, BOARD_BUS(stress_bytes), sizeof stress_bytes};
    const sptfra_buffer forces = {force_bytes, BOARD_BUS(force_bytes), sizeof force_bytes};
    const sptfra_platform *platform = BOARD_PLATFORM;

    code = platform == 0 ? SPTFRA_NOT_A_CORE : sptfra_open(&core, platform, BOARD_CORE, BOARD_DMA);
    if (code != SPTFRA_OK) {
        BOARD_PRINT("core: %s\r\n", sptfra_error(code));
        return 1;
    }
    if (core.shape.samples != SPTFRA_FLOAT32) {
        BOARD_PRINT("this example sends float32, and the core takes counts of 16 bits\r\n");
        return 1;
    }
    for (frame = 0; frame < FRAMES; frame++) {
        press(&core.shape, (float *)(void *)stress_bytes);
        code = sptfra_process(&core, &stress, &forces, POLLS);
        code = code == SPTFRA_OK ? sptfra_decode(&core.shape, force_bytes, &result) : code;
        if (code != SPTFRA_OK) {
            BOARD_PRINT("frame %d: %s\r\n", frame, sptfra_error(code));
            code = sptfra_recover(&core, &stress, &forces, POLLS);
            BOARD_PRINT("recovery: %s\r\n", sptfra_error(code));
            return 1;
        }
        /* xil_printf knows no fractions: millinewtons. */
        BOARD_PRINT("frame %d: F_x %d mN, F_y %d mN, F_z %d mN, status 0x%x\r\n", (int)result.number,
            (int)(1000.0f * result.force[0]), (int)(1000.0f * result.force[1]), (int)(1000.0f * result.force[2]),
            (unsigned)result.status);
    }
    return 0;
}
