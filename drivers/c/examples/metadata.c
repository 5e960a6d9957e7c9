/* SPDX-License-Identifier: MIT OR Apache-2.0 */
/* See metadata.h. No reader of JSON: the keys looked for stand at the beginning of what `sptfra generate` writes, once each. */
#include "metadata.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define FORMAT 3u
/* Far beyond the last key that counts, for the largest answer too. */
#define ROOM (1u << 16)

/* Behind `"key": `; NULL if there is none. */
static const char *value_of(const char *text, const char *key)
{
    char quoted[32];
    const char *at;

    snprintf(quoted, sizeof quoted, "\"%s\":", key);
    at = strstr(text, quoted);
    return at == NULL ? NULL : at + strlen(quoted) + strspn(at + strlen(quoted), " \t\r\n");
}

/* A number from 1 to `most`; 0 if there is none. */
static unsigned long number_of(const char *text, const char *key, unsigned long most)
{
    const char *at = value_of(text, key);
    unsigned long value;
    char *end;

    if (at == NULL) {
        return 0;
    }
    value = strtoul(at, &end, 10);
    return end == at || value > most ? 0 : value;
}

static int shape_of(const char *text, sptfra_shape *shape)
{
    static const char *const samples[] = {"\"float32\"", "\"int16\"", "\"uint16\""};
    const char *const sample = value_of(text, "samples");
    const unsigned long columns = number_of(text, "columns", UINT16_MAX), rows = number_of(text, "rows", UINT16_MAX);
    const unsigned long in = number_of(text, "bytes_in", 4u * UINT16_MAX);
    const unsigned long out = number_of(text, "bytes_out", 4u * UINT16_MAX);
    const unsigned long bits = number_of(text, "stream_bits", 128);
    /* The answer's values are named before the status bits; a block further on has the same name. */
    const char *const field = strstr(text, "\"name\": \"field\""), *const behind = strstr(text, "\"status_bits\"");
    unsigned kind = 0;

    while (kind < 3 && (sample == NULL || strncmp(sample, samples[kind], strlen(samples[kind])) != 0)) {
        kind++;
    }
    if (number_of(text, "format", FORMAT) != FORMAT || kind == 3 || columns == 0 || rows == 0 || in == 0 || out == 0
        || bits == 0 || behind == NULL) {
        return 0;
    }
    *shape = (sptfra_shape){.columns = (uint16_t)columns, .rows = (uint16_t)rows, .words_in = (uint16_t)(in / 4u),
        .words_out = (uint16_t)(out / 4u), .has_field = field != NULL && field < behind,
        .stream_bytes = (uint8_t)(bits / 8u), .samples = (uint8_t)kind};
    return 1;
}

int metadata_read(const char *path, sptfra_shape *shape)
{
    FILE *file = fopen(path, "r");
    char *text = malloc(ROOM);
    size_t bytes;
    int good;

    if (file == NULL || text == NULL) {
        fprintf(stderr, "%s: %s\n", path, strerror(errno));
        free(text);
        if (file != NULL) {
            fclose(file);
        }
        return 0;
    }
    bytes = fread(text, 1, ROOM - 1u, file);
    text[bytes] = '\0';
    good = shape_of(text, shape);
    if (!good) {
        fprintf(stderr, "%s: no metadata.json of format %u: generate the folder anew\n", path, FORMAT);
    }
    free(text);
    fclose(file);
    return good;
}
