/* SPDX-License-Identifier: MIT OR Apache-2.0 */
/* Forces of each contact of a frame, in double precision, for Linux: the library libsptfra_solver of the crate sptfra-solver.
 *
 *   sptfra_solver *solver = sptfra_solver_open("design.toml", message, sizeof message);
 *   sptfra_solver_solve(solver, result.version, frame, &forces);
 *   sptfra_solver_close(solver);
 *
 * The design states contacts = N: up to N contacts are separated. A frame is what went to the core: float32 or 16-bit
 * integers in taxel order, pascals or counts. Curve, calibration, dead taxels, crosstalk and clipped tension are the
 * design's. With smoothing or creep a solver follows the frames in the order of its calls: give it every frame of one stream.
 * A solver serves one thread at a time; several solvers serve several threads. */
#ifndef SPTFRA_SOLVER_H
#define SPTFRA_SOLVER_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum {
    SPTFRA_SOLVER_OK = 0,
    SPTFRA_SOLVER_BAD_ARGUMENT = -1, /* a null pointer, or a taxel that is not there */
    SPTFRA_SOLVER_NO_VERSION = -2,   /* no calibration of this version was given */
    SPTFRA_SOLVER_FAILED = -3        /* the library stopped in the middle; close this solver */
};

#define SPTFRA_SOLVER_CONTACTS 8

/* Status bits of contacts and frames are those of the core (SPTFRA_NO_CONTACT ... in sptfra.h). */
typedef struct {
    uint32_t taxels;       /* of the contact */
    uint32_t status;
    double centre[2];      /* x, y in m from the first taxel, where the normal force acts */
    double force[3];       /* F_x, F_y, F_z in N */
    double torque[3];      /* T_x, T_y, T_z in N m about the middle of the grid at the surface */
    double friction;       /* mu */
    double standard_error; /* of (F_x, F_y) in N; 0 where the design has none */
} sptfra_solver_contact;

typedef struct {
    uint32_t status;
    uint32_t contacts;  /* that there are */
    uint32_t separated; /* of them, those in `contact`; 0 with contacts = 1 */
    double force[3];    /* F_x, F_y, F_z in N, of all contacts */
    double torque[3];   /* T_x, T_y, T_z in N m about the middle of the grid at the surface */
    double friction;    /* mu */
    double direction;   /* phi in rad */
    double friction_xy[2];
    double standard_error;
    sptfra_solver_contact contact[SPTFRA_SOLVER_CONTACTS]; /* the one with the largest normal force first, then zeros */
} sptfra_solver_forces;

typedef struct sptfra_solver sptfra_solver;

/* Reads a design file and computes its matrices. NULL on an error, which `message` then states in at most `room` bytes
 * with the zero at its end; `message` may be NULL. */
sptfra_solver *sptfra_solver_open(const char *design, char *message, size_t room);
void sptfra_solver_close(sptfra_solver *solver);

/* Gain and offset of each taxel, and dead taxels, of a version of the calibration in RAM, as the driver loaded them. The
 * design's own are those of version 0. Dead taxels ascend; `offset` is in counts, with a curve in pascals. */
int sptfra_solver_calibrate(sptfra_solver *solver, uint8_t version, const double *gain, const double *offset,
    const uint16_t *dead, size_t dead_count);

/* Solves a frame by the calibration of a version, which the answer states (0 with calibration = "rom"). */
int sptfra_solver_solve(sptfra_solver *solver, uint8_t version, const void *frame, sptfra_solver_forces *forces);

#ifdef __cplusplus
}
#endif

#endif
