/* SPDX-License-Identifier: MIT OR Apache-2.0 */
/* See sptfra_file.h, and docs/reference/files.md for the files. */
#include "sptfra_file.h"
#include "sptfra_lines.h"
#include "sptfra_private.h"

#include <stdlib.h>
#include <string.h>

#define MOST_POINTS 65u

/* What the files say. */
typedef struct {
    double *gain, *offset, *weights; /* the latter dead after dead */
    unsigned long *lines;            /* of each taxel */
    uint32_t taxels, taken;
    int has_header;
    uint16_t dead[SPTFRA_MOST_DEAD];
    uint32_t dead_count;
    unsigned long header;
    const char *curve; /* the file with the points, which begin behind a line; NULL without */
    unsigned long behind;
    double counts[MOST_POINTS], pascals[MOST_POINTS];
    unsigned long point_lines[MOST_POINTS];
    uint32_t points;
} content;

static int is_header_of_points(const sptfra_reader *from)
{
    return from->count == 2 && sptfra_is_name(from->fields[0], "count") && sptfra_is_name(from->fields[1], "pascals");
}

/* ---- Gains, offsets and dead taxels */

/* A header of gains and offsets, behind which dead taxels may stand. */
static int take_header(sptfra_reader *from, content *of)
{
    uint32_t place;

    if (from->count < 2 || !sptfra_is_name(from->fields[0], "gain") || !sptfra_is_name(from->fields[1], "offset")) {
        return sptfra_wrong_line(from, "is no header of gains and offsets: write gain,offset, or none");
    }
    of->has_header = 1;
    of->header = from->number;
    for (place = 2; place < from->count; place++) {
        const char *name = from->fields[place], *digits = name + strlen("taxel ");
        const size_t length = sptfra_begins(name, "taxel ") ? strspn(digits, "0123456789") : 0;
        const unsigned long taxel = length > 0 && length < 6 ? strtoul(digits, NULL, 10) : UINT16_MAX;

        if (length == 0 || digits[length] != '\0' || taxel >= of->taxels) {
            return sptfra_wrong_line(
                from, "has no number of a dead taxel of this core behind gain,offset, as in taxel 37");
        }
        of->dead[of->dead_count++] = (uint16_t)taxel;
    }
    return SPTFRA_OK;
}

static int take_taxel(sptfra_reader *from, content *of)
{
    double values[SPTFRA_MOST_FIELDS];
    uint32_t place;

    if (!sptfra_numbers_of_line(from, 2u + of->dead_count, values)) {
        return sptfra_wrong_line(from,
            of->dead_count > 0 ? "is no gain,offset and a weight for each taxel of the header"
                               : "is no gain,offset such as 1.02,-0.5");
    }
    if (of->taken >= of->taxels) {
        return sptfra_say(from->said, SPTFRA_BAD_FILE, from->path, from->number, "a taxel more than the %u of the core",
            (unsigned)of->taxels);
    }
    of->gain[of->taken] = values[0];
    of->offset[of->taken] = values[1];
    for (place = 0; place < of->dead_count; place++) {
        of->weights[place * of->taxels + of->taken] = values[2u + place];
    }
    of->lines[of->taken++] = from->number;
    return SPTFRA_OK;
}

/* ---- Points */

static int take_points(sptfra_reader *from, content *of)
{
    double values[2];
    int more;

    of->curve = from->path;
    of->behind = from->number;
    for (more = sptfra_next_line(from); more == 1; more = sptfra_next_line(from)) {
        if (!sptfra_numbers_of_line(from, 2, values)) {
            return sptfra_wrong_line(from, "is no count,pascals such as 120,-950.5");
        }
        if (of->points == MOST_POINTS) {
            return sptfra_say(
                from->said, SPTFRA_BAD_FILE, from->path, from->number, "more than %u points", MOST_POINTS);
        }
        of->counts[of->points] = values[0];
        of->pascals[of->points] = values[1];
        of->point_lines[of->points++] = from->number;
    }
    return more;
}

static int take_point_file(sptfra_reader *from, content *of)
{
    double values[2];
    int more = sptfra_next_line(from);

    if (more == 1 && sptfra_is_header(from) && sptfra_is_name(from->fields[0], "gain")) {
        while (more == 1 && !is_header_of_points(from)) {
            more = sptfra_next_line(from);
        }
        if (more == 0) {
            return sptfra_say(from->said, SPTFRA_BAD_FILE, from->path, from->number, "gains and offsets, and no curve");
        }
    }
    if (more == 1 && from->count == 2 && sptfra_is_name(from->fields[0], "pascals")
        && sptfra_is_name(from->fields[1], "count")) {
        return sptfra_wrong_line(from, "has the pascals before the counts");
    }
    if (more == 1 && !sptfra_is_header(from)) {
        /* Without a header: the first point. */
        if (!sptfra_numbers_of_line(from, 2, values)) {
            return sptfra_wrong_line(from, "is no count,pascals such as 120,-950.5");
        }
        of->counts[0] = values[0];
        of->pascals[0] = values[1];
        of->point_lines[0] = from->number;
        of->points = 1;
    }
    return more == 1 ? take_points(from, of) : more;
}

static int take_calibration_file(sptfra_reader *from, content *of)
{
    int code = SPTFRA_OK, more, first = 1;

    for (more = sptfra_next_line(from); more == 1 && code == SPTFRA_OK; first = 0) {
        if (is_header_of_points(from)) {
            code = take_points(from, of);
            break;
        }
        code = first && sptfra_is_header(from) ? take_header(from, of) : take_taxel(from, of);
        more = code == SPTFRA_OK ? sptfra_next_line(from) : 0;
    }
    if (code == SPTFRA_OK && more >= 0 && of->taken < of->taxels) {
        return sptfra_say(from->said, SPTFRA_BAD_FILE, from->path, of->curve != NULL ? of->behind : from->number,
            "%u taxels, and the core has %u", (unsigned)of->taken, (unsigned)of->taxels);
    }
    return code == SPTFRA_OK ? more < 0 ? more : SPTFRA_OK : code;
}

/* Reads the curve from a file of its own. One that stands behind the taxels has to be the same: offsets are made for
 * it. */
static int take_curve(const char *path, content *of, const sptfra_teller *said)
{
    static const char other[] = "the curve is another than that behind the taxels, and offsets are made for it";
    content own;
    sptfra_reader from;
    uint32_t place;
    int code = sptfra_open_lines(&from, path, said);

    if (code != SPTFRA_OK) {
        return code;
    }
    memset(&own, 0, sizeof own);
    code = take_point_file(&from, &own);
    fclose(from.file);
    if (code == SPTFRA_OK && of->curve != NULL) {
        for (place = 0; place < own.points && place < of->points; place++) {
            if (own.counts[place] < of->counts[place] || own.counts[place] > of->counts[place]
                || own.pascals[place] < of->pascals[place] || own.pascals[place] > of->pascals[place]) {
                return sptfra_say(said, SPTFRA_BAD_FILE, path, own.point_lines[place], "%s", other);
            }
        }
        if (own.points != of->points) {
            return sptfra_say(said, SPTFRA_BAD_FILE, path, 0, "%s", other);
        }
    }
    of->curve = path;
    of->points = own.points;
    memcpy(of->counts, own.counts, sizeof of->counts);
    memcpy(of->pascals, own.pascals, sizeof of->pascals);
    memcpy(of->point_lines, own.point_lines, sizeof of->point_lines);
    return code;
}

/* ---- A bank */

/* Why a bank does not take it. */
static int refused(
    const content *of, const char *path, double noise_floor_pa, sptfra_refusal why, const sptfra_teller *said)
{
    const unsigned place = (unsigned)why.place;
    const unsigned long line = of->lines[why.place < of->taxels ? why.place : 0];
    const int code = SPTFRA_OUT_OF_RANGE;

    switch (why.what) {
    case SPTFRA_WRONG_TAXEL:
        return sptfra_say(said, code, path, line,
            "no bank takes a gain of %g with an offset of %g: gains from 1e-9 to 16 or 0, offsets of two full "
            "scales at most",
            of->gain[place], of->offset[place]);
    case SPTFRA_NOT_REPLACED:
        return sptfra_say(
            said, code, path, line, "nothing replaces taxel %u of gain 0: write the file with sptfra export-calibration", place);
    case SPTFRA_TOO_MANY_DEAD:
        return sptfra_say(said, code, path, of->header,
            "%u dead taxels, and the core has room for %u: [sensor] dead, room", (unsigned)of->dead_count, place);
    case SPTFRA_NO_SUCH_TAXEL:
        return sptfra_say(said, code, path, of->header, "dead taxels ascend, and taxel %u does not", place);
    case SPTFRA_WRONG_WEIGHT:
        return sptfra_say(said, code, path, line, "a dead taxel has a weight of 0, and no weight is beyond 131071");
    case SPTFRA_TOO_LARGE_WEIGHTS:
        return sptfra_say(
            said, code, path, of->header, "the weights of taxel %u add up to more than a bank takes", place);
    case SPTFRA_WRONG_POINTS:
        return sptfra_say(
            said, code, of->curve, 0, "a curve of %u points: use 2 to %u", (unsigned)of->points, place + 1u);
    case SPTFRA_WRONG_POINT:
        return sptfra_say(said, code, of->curve, of->point_lines[place],
            "%g,%g after %g,%g: counts ascend, pascals only rise or only fall, and no steeper or farther than a bank "
            "takes",
            of->counts[place], of->pascals[place], of->counts[place - 1], of->pascals[place - 1]);
    default:
        return sptfra_say(
            said, code, path, 0, "a noise floor of %g Pa: use one far below the full scale", noise_floor_pa);
    }
}

static int load(const sptfra *device, const char *path, const content *of, double noise_floor_pa, uint32_t polls,
    const sptfra_teller *said)
{
    const sptfra_replaced replaced = {of->dead_count, of->dead, of->weights};
    const sptfra_curve curve = {of->points, of->counts, of->pascals};
    const sptfra_replaced *with_dead;
    const sptfra_curve *with_curve = of->curve != NULL ? &curve : NULL;
    sptfra_identity identity;
    sptfra_refusal why;
    int code = sptfra_identify(device, &identity);

    if (code != SPTFRA_OK) {
        return sptfra_say(said, code, path, 0, "%s", sptfra_error(code));
    }
    if (with_curve != NULL && !identity.curve_in_ram) {
        return sptfra_say(said, SPTFRA_OUT_OF_RANGE, of->curve, of->behind,
            "a curve, and the core has none in its banks: [sensor] curve");
    }
    /* Without room for a map those of gain 0 are the design's. */
    with_dead = of->has_header && (identity.replaceable > 0 || of->dead_count > 0) ? &replaced : NULL;
    code = sptfra_check_bank(device, of->gain, of->offset, with_dead, with_curve, noise_floor_pa, &why);
    if (code == SPTFRA_OUT_OF_RANGE) {
        return refused(of, path, noise_floor_pa, why, said);
    }
    if (code == SPTFRA_OK) {
        code = sptfra_load_bank_and_curve(device, of->gain, of->offset, with_dead, with_curve, noise_floor_pa, polls);
    }
    return code == SPTFRA_OK ? code : sptfra_say(said, code, path, 0, "%s", sptfra_error(code));
}

int sptfra_load_calibration_file(const sptfra *device, const char *path, const char *curve, double noise_floor_pa,
    uint32_t polls, char *message, size_t bytes)
{
    const sptfra_teller said = {message, message == NULL ? 0 : bytes};
    const size_t taxels = (size_t)device->shape.columns * device->shape.rows;
    sptfra_reader from;
    content of;
    uint32_t word;
    /* Before a file is read. */
    int code = sptfra_read_calibration(device, 0, 1, &word);

    if (said.bytes > 0) {
        *message = '\0';
    }
    if (code != SPTFRA_OK) {
        return sptfra_say(&said, code, path, 0, "%s", sptfra_error(code));
    }
    code = sptfra_open_lines(&from, path, &said);
    if (code != SPTFRA_OK) {
        return code;
    }
    memset(&of, 0, sizeof of);
    of.taxels = (uint32_t)taxels;
    of.gain = calloc((2u + SPTFRA_MOST_DEAD) * taxels, sizeof *of.gain);
    of.lines = calloc(taxels, sizeof *of.lines);
    if (of.gain == NULL || of.lines == NULL) {
        code = sptfra_system_error(&said, path, "no memory");
    } else {
        of.offset = of.gain + taxels;
        of.weights = of.offset + taxels;
        code = take_calibration_file(&from, &of);
    }
    fclose(from.file);
    if (code == SPTFRA_OK && curve != NULL) {
        code = take_curve(curve, &of, &said);
    }
    if (code == SPTFRA_OK) {
        code = load(device, path, &of, noise_floor_pa, polls, &said);
    }
    free(of.gain);
    free(of.lines);
    return code;
}
