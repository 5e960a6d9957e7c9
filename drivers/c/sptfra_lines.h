/* SPDX-License-Identifier: MIT OR Apache-2.0 */
/* Files of numbers, line by line, and what is wrong with them: sptfra_file.c's own; programs include sptfra_file.h. */
#ifndef SPTFRA_LINES_H
#define SPTFRA_LINES_H

#include "sptfra.h"

#include <stdio.h>

/* Characters of a line, of it in messages; dead taxels in a header, fields in a line. */
#define SPTFRA_MOST_LINE 2048
#define SPTFRA_SHOWN_LINE 40
#define SPTFRA_MOST_DEAD 15u
#define SPTFRA_MOST_FIELDS (2u + SPTFRA_MOST_DEAD)

/* Where messages go. */
typedef struct {
    char *text;
    size_t bytes;
} sptfra_teller;

/* A file that is read line by line. */
typedef struct {
    FILE *file;
    const char *path;
    const sptfra_teller *said;
    unsigned long number; /* of the line */
    char separator;       /* ' ' for any spaces; 0 before the first line that has one */
    char line[SPTFRA_MOST_LINE];
    char shown[SPTFRA_SHOWN_LINE + 1]; /* the line, for messages */
    char *fields[SPTFRA_MOST_FIELDS + 1u];
    uint32_t count;
} sptfra_reader;

/* Puts file, line (0: none) and reason into the message; the code. */
int sptfra_say(const sptfra_teller *said, int code, const char *path, unsigned long line, const char *format, ...);
/* The same with errno's reason: SPTFRA_SYSTEM. */
int sptfra_system_error(const sptfra_teller *said, const char *path, const char *what);
/* The same of the reader's line, which is quoted: SPTFRA_BAD_FILE. */
int sptfra_wrong_line(const sptfra_reader *from, const char *problem);

/* Opens a file; the caller closes it. */
int sptfra_open_lines(sptfra_reader *from, const char *path, const sptfra_teller *said);
/* The next line that is neither blank nor a remark: 1, at the end 0, else a code. */
int sptfra_next_line(sptfra_reader *from);
/* So many numbers, and no more; 0 if the line has others. */
int sptfra_numbers_of_line(const sptfra_reader *from, uint32_t count, double *values);
/* Whether the line has no number at all. */
int sptfra_is_header(const sptfra_reader *from);
/* Whether a field begins so, in small or large letters. */
int sptfra_begins(const char *field, const char *name);
/* Whether a field is this name, in small or large letters, with a unit or without. */
int sptfra_is_name(const char *field, const char *name);

#endif
