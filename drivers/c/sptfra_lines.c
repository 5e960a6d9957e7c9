/* SPDX-License-Identifier: MIT OR Apache-2.0 */
/* See sptfra_lines.h. */
#include "sptfra_lines.h"

#include <errno.h>
#include <float.h>
#include <locale.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MOST_DIGITS 64u
/* Bytes of a locale's decimal point. */
#define MOST_POINT 15u
/* Of a path so many characters are told. */
#define SHOWN_PATH 200
#define SPACES " \t\v\f\r\n"

int sptfra_say(const sptfra_teller *said, int code, const char *path, unsigned long line, const char *format, ...)
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

int sptfra_system_error(const sptfra_teller *said, const char *path, const char *what)
{
    const int number = errno;

    sptfra_say(said, SPTFRA_SYSTEM, path, 0, "%s: %s", what, strerror(number));
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
static int part(sptfra_reader *from, char *line)
{
    const char at[2] = {from->separator, '\0'};

    from->count = 0;
    while (line != NULL) {
        char *end = from->separator == ' ' ? line + strcspn(line, SPACES) : line + strcspn(line, at);
        char *next = *end == '\0' ? NULL : end + 1;

        if (from->count > SPTFRA_MOST_FIELDS) {
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
    return from->count <= SPTFRA_MOST_FIELDS;
}

int sptfra_next_line(sptfra_reader *from)
{
    static const char mark[] = "\xEF\xBB\xBF";
    static const char separators[] = ";\t,";
    size_t length;
    char *line;
    const char *separator;

    for (;;) {
        errno = 0;
        if (fgets(from->line, SPTFRA_MOST_LINE, from->file) == NULL) {
            return ferror(from->file) ? sptfra_system_error(from->said, from->path, "cannot read the file") : 0;
        }
        from->number++;
        length = strlen(from->line);
        if (length == 0 || (from->line[length - 1] != '\n' && !feof(from->file))) {
            return sptfra_say(from->said, SPTFRA_BAD_FILE, from->path, from->number,
                "a line of more than %d characters, or no text", SPTFRA_MOST_LINE - 2);
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
    snprintf(from->shown, sizeof from->shown, "%.*s", SPTFRA_SHOWN_LINE, line);
    for (separator = separators; from->separator == '\0' && *separator != '\0'; separator++) {
        from->separator = strchr(line, *separator) != NULL ? *separator : '\0';
    }
    from->separator = from->separator == '\0' ? ' ' : from->separator;
    if (!part(from, line)) {
        return sptfra_say(
            from->said, SPTFRA_BAD_FILE, from->path, from->number, "more than %u values", SPTFRA_MOST_FIELDS);
    }
    return 1;
}

/* Whether a field is a decimal number, and which. Where it separates nothing, a comma is a decimal point. */
static int number_of(const sptfra_reader *from, const char *field, double *value)
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

int sptfra_numbers_of_line(const sptfra_reader *from, uint32_t count, double *values)
{
    uint32_t place;

    for (place = 0; place < count && place < from->count; place++) {
        if (!number_of(from, from->fields[place], &values[place])) {
            return 0;
        }
    }
    return from->count == count;
}

int sptfra_begins(const char *field, const char *name)
{
    const size_t length = strlen(name);
    size_t place;

    for (place = 0; place < length; place++) {
        const char given = field[place];

        if ((given >= 'A' && given <= 'Z' ? (char)(given - 'A' + 'a') : given) != name[place]) {
            return 0;
        }
    }
    return 1;
}

int sptfra_is_name(const char *field, const char *name)
{
    if (!sptfra_begins(field, name)) {
        return 0;
    }
    field += strlen(name);
    field += strspn(field, SPACES);
    return *field == '\0' || *field == '(' || *field == '[';
}

int sptfra_is_header(const sptfra_reader *from)
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

int sptfra_wrong_line(const sptfra_reader *from, const char *problem)
{
    return sptfra_say(from->said, SPTFRA_BAD_FILE, from->path, from->number, "\"%s\" %s", from->shown, problem);
}

int sptfra_open_lines(sptfra_reader *from, const char *path, const sptfra_teller *said)
{
    memset(from, 0, sizeof *from);
    from->path = path;
    from->said = said;
    errno = 0;
    from->file = fopen(path, "r");
    return from->file != NULL ? SPTFRA_OK : sptfra_system_error(said, path, "cannot open the file");
}
