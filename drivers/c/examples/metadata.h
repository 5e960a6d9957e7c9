/* SPDX-License-Identifier: MIT OR Apache-2.0 */
/* The shape of a core without registers (control = false), from the metadata.json of its generated folder. */
#ifndef METADATA_H
#define METADATA_H

#include "sptfra.h"

/* 0 after a message on standard error. */
int metadata_read(const char *path, sptfra_shape *shape);

#endif
