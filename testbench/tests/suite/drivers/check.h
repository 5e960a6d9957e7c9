// SPDX-License-Identifier: MIT OR Apache-2.0
/* What the driver's tests say when something is not so. */
#ifndef CHECK_H
#define CHECK_H

#include <stdio.h>
#include <stdlib.h>

#define CHECK(condition)                                                      \
    do {                                                                      \
        if (!(condition)) {                                                   \
            printf("FAIL: line %d: %s\n", __LINE__, #condition);              \
            exit(1);                                                          \
        }                                                                     \
    } while (0)

#endif
