/* SPDX-License-Identifier: MIT OR Apache-2.0 */
/* See text.h. */
#include "text.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int text_parse(const sptfra_shape *shape, const char *line, unsigned long number, void *words)
{
    const size_t taxels = (size_t)shape->columns * shape->rows;
    const double least = shape->samples == SPTFRA_INT16 ? -32768.0 : 0.0;
    const double most = shape->samples == SPTFRA_INT16 ? 32767.0 : 65535.0;
    const char *at = line;
    size_t index;
    char *end;

    for (index = 0; index < taxels; index++) {
        const double value = strtod(at, &end);

        if (end == at) {
            fprintf(stderr, "line %lu: %zu values, and the core has %zu taxels\n", number, index, taxels);
            return 0;
        }
        if (shape->samples == SPTFRA_FLOAT32) {
            ((float *)words)[index] = (float)value;
        } else if (value >= least && value <= most && value == floor(value)) {
            ((uint16_t *)words)[index] = (uint16_t)(int32_t)value;
        } else {
            fprintf(stderr, "line %lu, value %zu: %g is no count from %g to %g\n", number, index + 1, value, least, most);
            return 0;
        }
        at = end + strspn(end, " \t,;\r\n");
    }
    if (*at != '\0') {
        fprintf(stderr, "line %lu: more than %zu values\n", number, taxels);
        return 0;
    }
    return 1;
}

int text_numbers_columns(const char *line, size_t taxels)
{
    const char *at = line;
    double first = 0.0;
    size_t index;
    char *end;

    for (index = 0; index < taxels; index++) {
        const double value = strtod(at, &end);

        first = index == 0 ? value : first;
        if (end == at || (first != 0.0 && first != 1.0) || value != first + (double)index) {
            return 0;
        }
        at = end + strspn(end, " \t,;\r\n");
    }
    return *at == '\0';
}

void text_header(void)
{
    printf("frame,F_x,F_y,F_z,mu,phi,status\n");
}

void text_answer(const sptfra_result *result)
{
    unsigned bit;

    printf("%u,%.9g,%.9g,%.9g,%.9g,%.9g,", (unsigned)result->number, (double)result->force[0], (double)result->force[1],
        (double)result->force[2], (double)result->friction, (double)result->direction);
    for (bit = 0; sptfra_status_name(bit) != NULL; bit++) {
        if (result->status >> bit & 1u) {
            printf("%s%s", result->status & ((1u << bit) - 1u) ? "; " : "", sptfra_status_name(bit));
        }
    }
    printf("\n");
    fflush(stdout);
}
