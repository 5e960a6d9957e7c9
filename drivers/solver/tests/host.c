/* SPDX-License-Identifier: MIT OR Apache-2.0 */
/* Solves the frames of a file and prints every figure: host DESIGN FRAMES FRAME_BYTES VERSION. With a version above 0 all
 * gains are 2 and all offsets 3 in that version, and taxel 7 is dead. */
#include "sptfra_solver.h"

#include <stdio.h>
#include <stdlib.h>

#define MOST 4096

static void print(const double *values, int count)
{
    int index;

    for (index = 0; index < count; index++) {
        printf(" %.17g", values[index]);
    }
}

int main(int count, char **arguments)
{
    static unsigned char frame[MOST];
    static double gain[MOST], offset[MOST];
    static const uint16_t dead = 7, none = 60000;
    char message[200] = "";
    sptfra_solver_forces forces;
    sptfra_solver *solver;
    uint8_t version;
    size_t bytes;
    uint32_t at;
    FILE *file;

    if (count != 5) {
        return 2;
    }
    solver = sptfra_solver_open(arguments[1], message, sizeof message);
    if (solver == NULL) {
        printf("%s\n", message);
        return 1;
    }
    bytes = (size_t)atoi(arguments[3]);
    version = (uint8_t)atoi(arguments[4]);
    for (at = 0; at < MOST; at++) {
        gain[at] = 2.0;
        offset[at] = 3.0;
    }
    if (version > 0
        && (sptfra_solver_solve(solver, version, frame, &forces) != SPTFRA_SOLVER_NO_VERSION
            || sptfra_solver_calibrate(solver, version, gain, offset, &none, 1) != SPTFRA_SOLVER_BAD_ARGUMENT
            || sptfra_solver_calibrate(solver, version, gain, NULL, &dead, 1) != SPTFRA_SOLVER_BAD_ARGUMENT
            || sptfra_solver_calibrate(solver, version, gain, offset, &dead, 1) != SPTFRA_SOLVER_OK)) {
        return 3;
    }
    if (sptfra_solver_solve(solver, version, NULL, &forces) != SPTFRA_SOLVER_BAD_ARGUMENT
        || sptfra_solver_solve(NULL, version, frame, &forces) != SPTFRA_SOLVER_BAD_ARGUMENT) {
        return 4;
    }
    file = fopen(arguments[2], "rb");
    while (file != NULL && fread(frame, 1, bytes, file) == bytes) {
        if (sptfra_solver_solve(solver, version, frame, &forces) != SPTFRA_SOLVER_OK) {
            return 5;
        }
        printf("%u %u %u", (unsigned)forces.status, (unsigned)forces.contacts, (unsigned)forces.separated);
        print(forces.force, 3);
        print(forces.torque, 3);
        print(&forces.friction, 1);
        print(&forces.direction, 1);
        print(forces.friction_xy, 2);
        print(&forces.standard_error, 1);
        for (at = 0; at < SPTFRA_SOLVER_CONTACTS; at++) {
            printf(" %u %u", (unsigned)forces.contact[at].taxels, (unsigned)forces.contact[at].status);
            print(forces.contact[at].centre, 2);
            print(forces.contact[at].force, 3);
            print(forces.contact[at].torque, 3);
            print(&forces.contact[at].friction, 1);
            print(&forces.contact[at].standard_error, 1);
        }
        printf("\n");
    }
    sptfra_solver_close(solver);
    sptfra_solver_close(NULL);
    return file == NULL || fclose(file) != 0;
}
