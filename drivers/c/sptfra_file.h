/* SPDX-License-Identifier: MIT OR Apache-2.0 */
/* Calibrations from files, where there is an operating system with files: C11's library and memory of it. */
#ifndef SPTFRA_FILE_H
#define SPTFRA_FILE_H

#include "sptfra.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Room enough for a message. */
#define SPTFRA_MESSAGE_BYTES 512u

/* Loads the gains and offsets of the file that a design names as its calibration, or of one of `sptfra export-calibration`: then the
 * dead taxels of its header are replaced, and no others, and a curve behind them is used, too. A header without dead
 * taxels, `gain,offset` alone, says that none is, even of those that the design's `dead` names: the file of
 * `sptfra export-calibration` has them. `curve` is the file that the design names as its curve, or NULL: points stand in one file. What a
 * file does not say stays as it was, and so does the noise floor if `noise_floor_pa` is 0; see
 * sptfra_load_bank_and_curve, as which it ends.
 *
 * What is wrong is put into `message`, a line with file, line and reason, cut to so many bytes; nothing into NULL. Of
 * SPTFRA_SYSTEM errno says more. On any error the active bank stays. */
int sptfra_load_calibration_file(const sptfra *device, const char *path, const char *curve, double noise_floor_pa,
    uint32_t polls, char *message, size_t bytes);

#ifdef __cplusplus
}
#endif

#endif
