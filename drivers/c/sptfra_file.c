/* SPDX-License-Identifier: MIT OR Apache-2.0 */
/* See sptfra_file.h, and docs/formats.md for the files. */
#include "sptfra_file.h"
#include "sptfra_private.h"

#include <errno.h>
#include <float.h>
#include <locale.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Characters of a line, fields in it, dead taxels in a header, points of a curve. */
#define MOST_LINE 2048
#define MOST_DEAD 15u
#define MOST_FIELDS (2u + MOST_DEAD)
#define MOST_POINTS 65u
#define MOST_DIGITS 64u
/* Bytes of a locale's decimal point. */
#define MOST_POINT 15u
/* Of a path so many characters are told. */
#define SHOWN_PATH 200
#define SHOWN_LINE 40
#define SPACES " \t\v\f\r\n"

typedef struct {
    char *text;
    size_t bytes;
} teller;

/* A file that is read line by line. */
typedef struct {
    FILE *file;
    const char *path;
    const teller *said;
    unsigned long number; /* of the line */
    char separator;       /* ' ' for any spaces; 0 before the first line that has one */
    char line[MOST_LINE];
    char shown[SHOWN_LINE + 1]; /* the line, for messages */
    char *fields[MOST_FIELDS + 1u];
    uint32_t count;
} reader;

/* What the files say. */
typedef struct {
    double *gain, *offset, *weights; /* the latter dead after dead */
    unsigned long *lines;            /* of each taxel */
    uint32_t taxels, taken;
    int has_header;
    uint16_t dead[MOST_DEAD];
    uint32_t dead_count;
    unsigned long header;
    const char *curve; /* the file with the points, which begin behind a line; NULL without */
    unsigned long behind;
    double counts[MOST_POINTS], pascals[MOST_POINTS];
    unsigned long point_lines[MOST_POINTS];
    uint32_t points;
} content;

static int say(const teller *said, int code, const char *path, unsigned long line, const char *format, ...)
{
    const size_t length = strlen(path);
    va_list arguments;
    size_t used;
    int written;

    if (said->bytes == 0) {
        return code;
    }
    written = snprintf(said->text, said->bytes, "%s%s", length > SHOWN_PATH ? "..." : "",
        length > SHOWN_PATH ? path + length - SHOWN_PATH : path);
    used = written < 0 ? 0 : (size_t)written;
    if (line > 0 && used < said->bytes) {
        written = snprintf(said->text + used, said->bytes - used, ", line %lu", line);
        used += written < 0 ? 0 : (size_t)written;
    }
    if (used < said->bytes) {
        written = snprintf(said->text + used, said->bytes - used, ": ");
        used += written < 0 ? 0 : (size_t)written;
    }
    if (used < said->bytes) {
        va_start(arguments, format);
        vsnprintf(said->text + used, said->bytes - used, format, arguments);
        va_end(arguments);
    }
    return code;
}

/* ---- Lines */

static int system_error(const teller *said, const char *path, const char *what)
{
    const int number = errno;

    say(said, SPTFRA_SYSTEM, path, 0, "%s: %s", what, strerror(number));
    errno = number;
    return SPTFRA_SYSTEM;
}

/* Without spaces around it. */
static char *trimmed(char *text)
{
    size_t length;

    text += strspn(text, SPACES);
    length = strlen(text);
    while (length > 0 && strchr(SPACES, text[length - 1]) != NULL) {
        length--;
    }
    text[length] = '\0';
    return text;
}

/* Without the quotes that some programs put around a field. */
static char *bare(char *field)
{
    size_t length;

    field = trimmed(field);
    length = strlen(field);
    if (length > 1 && field[0] == '"' && field[length - 1] == '"') {
        field[length - 1] = '\0';
        field++;
    }
    return field;
}

/* Parts a line; 0 if it has more fields than any that is right. */
static int part(reader *from, char *line)
{
    const char at[2] = {from->separator, '\0'};

    from->count = 0;
    while (line != NULL) {
        char *end = from->separator == ' ' ? line + strcspn(line, SPACES) : line + strcspn(line, at);
        char *next = *end == '\0' ? NULL : end + 1;

        if (from->count > MOST_FIELDS) {
            return 0;
        }
        *end = '\0';
        from->fields[from->count++] = bare(line);
        line = next != NULL && from->separator == ' ' ? next + strspn(next, SPACES) : next;
    }
    /* The last one may end with the separator, too. */
    if (from->count > 1 && *from->fields[from->count - 1] == '\0') {
        from->count--;
    }
    return from->count <= MOST_FIELDS;
}

/* The next line that is neither blank nor a remark: 1, at the end 0, else a code. */
static int next_line(reader *from)
{
    static const char mark[] = "\xEF\xBB\xBF";
    static const char separators[] = ";\t,";
    size_t length;
    char *line;
    const char *separator;

    for (;;) {
        errno = 0;
        if (fgets(from->line, MOST_LINE, from->file) == NULL) {
            return ferror(from->file) ? system_error(from->said, from->path, "cannot read the file") : 0;
        }
        from->number++;
        length = strlen(from->line);
        if (length == 0 || (from->line[length - 1] != '\n' && !feof(from->file))) {
            return say(from->said, SPTFRA_BAD_FILE, from->path, from->number,
                "a line of more than %d characters, or no text", MOST_LINE - 2);
        }
        line = from->line;
        if (from->number == 1 && strncmp(line, mark, strlen(mark)) == 0) {
            line += strlen(mark);
        }
        line = trimmed(line);
        if (*line != '\0' && *line != '#') {
            break;
        }
    }
    snprintf(from->shown, sizeof from->shown, "%.*s", SHOWN_LINE, line);
    for (separator = separators; from->separator == '\0' && *separator != '\0'; separator++) {
        from->separator = strchr(line, *separator) != NULL ? *separator : '\0';
    }
    from->separator = from->separator == '\0' ? ' ' : from->separator;
    if (!part(from, line)) {
        return say(from->said, SPTFRA_BAD_FILE, from->path, from->number, "more than %u values", MOST_FIELDS);
    }
    return 1;
}

/* Whether a field is a decimal number, and which. Where it separates nothing, a comma is a decimal point. */
static int number_of(const reader *from, const char *field, double *value)
{
    /* As the program's locale has it, for strtod. */
    const char *point = localeconv()->decimal_point;
    const size_t length = strlen(field), wide = strlen(point);
    const char *points = from->separator == ';' || from->separator == '\t' ? ".," : ".";
    const char *at = strpbrk(field, points);
    char digits[MOST_DIGITS + MOST_POINT + 1u], *end;

    if (length == 0 || length > MOST_DIGITS || wide > MOST_POINT || strspn(field, "0123456789+-.,eE") != length) {
        return 0;
    }
    if (at == NULL) {
        strcpy(digits, field);
    } else {
        const size_t before = (size_t)(at - field);

        /* A second one ends the number too early. */
        memcpy(digits, field, before);
        memcpy(digits + before, point, wide);
        strcpy(digits + before + wide, at + 1);
    }
    *value = strtod(digits, &end);
    return *end == '\0' && *value >= -(double)FLT_MAX && *value <= (double)FLT_MAX;
}

/* So many numbers, and no more; 0 if the line has others. */
static int numbers_of_line(const reader *from, uint32_t count, double *values)
{
    uint32_t place;

    for (place = 0; place < count && place < from->count; place++) {
        if (!number_of(from, from->fields[place], &values[place])) {
            return 0;
        }
    }
    return from->count == count;
}

/* Whether a field is this name, in small or large letters, with a unit or without. */
static int is_name(const char *field, const char *name)
{
    const size_t length = strlen(name);
    size_t place;

    for (place = 0; place < length; place++) {
        const char letter = field[place] >= 'A' && field[place] <= 'Z' ? (char)(field[place] - 'A' + 'a') : field[place];

        if (letter != name[place]) {
            return 0;
        }
    }
    field += length + strspn(field + length, SPACES);
    return *field == '\0' || *field == '(' || *field == '[';
}

static int is_header(const reader *from)
{
    double value;
    uint32_t place;

    for (place = 0; place < from->count; place++) {
        if (number_of(from, from->fields[place], &value)) {
            return 0;
        }
    }
    return 1;
}

static int is_header_of_points(const reader *from)
{
    return from->count == 2 && is_name(from->fields[0], "count") && is_name(from->fields[1], "pascals");
}

static int wrong_line(const reader *from, const char *problem)
{
    return say(from->said, SPTFRA_BAD_FILE, from->path, from->number, "\"%s\" %s", from->shown, problem);
}

static int opened(reader *from, const char *path, const teller *said)
{
    memset(from, 0, sizeof *from);
    from->path = path;
    from->said = said;
    errno = 0;
    from->file = fopen(path, "r");
    return from->file != NULL ? SPTFRA_OK : system_error(said, path, "cannot open the file");
}

/* ---- Gains, offsets and dead taxels */

/* A header of gains and offsets, behind which dead taxels may stand. */
static int take_header(reader *from, content *of)
{
    uint32_t place;

    if (from->count < 2 || !is_name(from->fields[0], "gain") || !is_name(from->fields[1], "offset")) {
        return wrong_line(from, "is no header of gains and offsets: write gain,offset, or none");
    }
    of->has_header = 1;
    of->header = from->number;
    for (place = 2; place < from->count; place++) {
        const char *name = from->fields[place], *digits = name + strlen("taxel ");
        const size_t length = strncmp(name, "taxel ", strlen("taxel ")) == 0 ? strspn(digits, "0123456789") : 0;
        const unsigned long taxel = length > 0 && length < 6 ? strtoul(digits, NULL, 10) : UINT16_MAX;

        if (length == 0 || digits[length] != '\0' || taxel >= of->taxels) {
            return wrong_line(from, "has no number of a dead taxel of this core behind gain,offset, as in taxel 37");
        }
        of->dead[of->dead_count++] = (uint16_t)taxel;
    }
    return SPTFRA_OK;
}

static int take_taxel(reader *from, content *of)
{
    double values[MOST_FIELDS];
    uint32_t place;

    if (!numbers_of_line(from, 2u + of->dead_count, values)) {
        return wrong_line(from, of->dead_count > 0 ? "is no gain,offset and a weight for each taxel of the header"
                                                   : "is no gain,offset such as 1.02,-0.5");
    }
    if (of->taken >= of->taxels) {
        return say(from->said, SPTFRA_BAD_FILE, from->path, from->number, "a taxel more than the %u of the core",
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

static int take_points(reader *from, content *of)
{
    double values[2];
    int more;

    of->curve = from->path;
    of->behind = from->number;
    for (more = next_line(from); more == 1; more = next_line(from)) {
        if (!numbers_of_line(from, 2, values)) {
            return wrong_line(from, "is no count,pascals such as 120,-950.5");
        }
        if (of->points == MOST_POINTS) {
            return say(from->said, SPTFRA_BAD_FILE, from->path, from->number, "more than %u points", MOST_POINTS);
        }
        of->counts[of->points] = values[0];
        of->pascals[of->points] = values[1];
        of->point_lines[of->points++] = from->number;
    }
    return more;
}

static int take_point_file(reader *from, content *of)
{
    double values[2];
    int more = next_line(from);

    if (more == 1 && is_header(from) && is_name(from->fields[0], "gain")) {
        while (more == 1 && !is_header_of_points(from)) {
            more = next_line(from);
        }
        if (more == 0) {
            return say(from->said, SPTFRA_BAD_FILE, from->path, from->number, "gains and offsets, and no curve");
        }
    }
    if (more == 1 && from->count == 2 && is_name(from->fields[0], "pascals") && is_name(from->fields[1], "count")) {
        return wrong_line(from, "has the pascals before the counts");
    }
    if (more == 1 && !is_header(from)) {
        /* Without a header: the first point. */
        if (!numbers_of_line(from, 2, values)) {
            return wrong_line(from, "is no count,pascals such as 120,-950.5");
        }
        of->counts[0] = values[0];
        of->pascals[0] = values[1];
        of->point_lines[0] = from->number;
        of->points = 1;
    }
    return more == 1 ? take_points(from, of) : more;
}

static int take_calibration_file(reader *from, content *of)
{
    int code = SPTFRA_OK, more, first = 1;

    for (more = next_line(from); more == 1 && code == SPTFRA_OK; first = 0) {
        if (is_header_of_points(from)) {
            code = take_points(from, of);
            break;
        }
        code = first && is_header(from) ? take_header(from, of) : take_taxel(from, of);
        more = code == SPTFRA_OK ? next_line(from) : 0;
    }
    if (code == SPTFRA_OK && more >= 0 && of->taken < of->taxels) {
        return say(from->said, SPTFRA_BAD_FILE, from->path, of->curve != NULL ? of->behind : from->number,
            "%u taxels, and the core has %u", (unsigned)of->taken, (unsigned)of->taxels);
    }
    return code == SPTFRA_OK ? more < 0 ? more : SPTFRA_OK : code;
}

/* Reads the curve from a file of its own. One that stands behind the taxels has to be the same: offsets are made for it. */
static int take_curve(const char *path, content *of, const teller *said)
{
    static const char other[] = "the curve is another than that behind the taxels, and offsets are made for it";
    content own;
    reader from;
    uint32_t place;
    int code = opened(&from, path, said);

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
                return say(said, SPTFRA_BAD_FILE, path, own.point_lines[place], "%s", other);
            }
        }
        if (own.points != of->points) {
            return say(said, SPTFRA_BAD_FILE, path, 0, "%s", other);
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
static int refused(const content *of, const char *path, double noise_floor_pa, sptfra_refusal why, const teller *said)
{
    const unsigned place = (unsigned)why.place;
    const unsigned long line = of->lines[why.place < of->taxels ? why.place : 0];
    const int code = SPTFRA_OUT_OF_RANGE;

    switch (why.what) {
    case SPTFRA_WRONG_TAXEL:
        return say(said, code, path, line,
            "no bank takes a gain of %g with an offset of %g: gains from 1e-9 to 16 or 0, offsets of two full scales at most",
            of->gain[place], of->offset[place]);
    case SPTFRA_NOT_REPLACED:
        return say(said, code, path, line, "nothing replaces taxel %u of gain 0: write the file with golden bank", place);
    case SPTFRA_TOO_MANY_DEAD:
        return say(said, code, path, of->header, "%u dead taxels, and the core has room for %u: [hardware] replaceable",
            (unsigned)of->dead_count, place);
    case SPTFRA_NO_SUCH_TAXEL:
        return say(said, code, path, of->header, "dead taxels ascend, and taxel %u does not", place);
    case SPTFRA_WRONG_WEIGHT:
        return say(said, code, path, line, "a dead taxel has a weight of 0, and no weight is beyond 131071");
    case SPTFRA_TOO_LARGE_WEIGHTS:
        return say(said, code, path, of->header, "the weights of taxel %u add up to more than a bank takes", place);
    case SPTFRA_WRONG_POINTS:
        return say(said, code, of->curve, 0, "a curve of %u points: use 2 to %u", (unsigned)of->points, place + 1u);
    case SPTFRA_WRONG_POINT:
        return say(said, code, of->curve, of->point_lines[place],
            "%g,%g after %g,%g: counts ascend, pascals only rise or only fall, and no steeper or farther than a bank takes",
            of->counts[place], of->pascals[place], of->counts[place - 1], of->pascals[place - 1]);
    default:
        return say(said, code, path, 0, "a noise floor of %g Pa: use one far below the full scale", noise_floor_pa);
    }
}

static int load(const sptfra *device, const char *path, const content *of, double noise_floor_pa, uint32_t polls,
    const teller *said)
{
    const sptfra_replaced replaced = {of->dead_count, of->dead, of->weights};
    const sptfra_curve curve = {of->points, of->counts, of->pascals};
    const sptfra_replaced *with_dead;
    const sptfra_curve *with_curve = of->curve != NULL ? &curve : NULL;
    sptfra_identity identity;
    sptfra_refusal why;
    int code = sptfra_identify(device, &identity);

    if (code != SPTFRA_OK) {
        return say(said, code, path, 0, "%s", sptfra_error(code));
    }
    if (with_curve != NULL && !identity.curve_in_ram) {
        return say(said, SPTFRA_OUT_OF_RANGE, of->curve, of->behind,
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
    return code == SPTFRA_OK ? code : say(said, code, path, 0, "%s", sptfra_error(code));
}

int sptfra_load_calibration_file(const sptfra *device, const char *path, const char *curve, double noise_floor_pa,
    uint32_t polls, char *message, size_t bytes)
{
    const teller said = {message, message == NULL ? 0 : bytes};
    const size_t taxels = (size_t)device->shape.columns * device->shape.rows;
    reader from;
    content of;
    uint32_t word;
    /* Before a file is read. */
    int code = sptfra_read_calibration(device, 0, 1, &word);

    if (said.bytes > 0) {
        *message = '\0';
    }
    if (code != SPTFRA_OK) {
        return say(&said, code, path, 0, "%s", sptfra_error(code));
    }
    code = opened(&from, path, &said);
    if (code != SPTFRA_OK) {
        return code;
    }
    memset(&of, 0, sizeof of);
    of.taxels = (uint32_t)taxels;
    of.gain = calloc((2u + MOST_DEAD) * taxels, sizeof *of.gain);
    of.lines = calloc(taxels, sizeof *of.lines);
    if (of.gain == NULL || of.lines == NULL) {
        code = system_error(&said, path, "no memory");
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
