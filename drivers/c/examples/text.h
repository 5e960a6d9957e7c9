/* SPDX-License-Identifier: MIT OR Apache-2.0 */
/* Frames and forces as lines of text: values separated by commas, blanks or semicolons in, columns out. */
#ifndef TEXT_H
#define TEXT_H

#include "sptfra.h"

/* The values of a line as the core takes them; 0 after a message. */
int text_parse(const sptfra_shape *shape, const char *line, unsigned long number, void *words);
/* Whether a line has the numbers of its columns alone, from 0 or 1 on, as pandas writes them above frames. */
int text_numbers_columns(const char *line, size_t taxels);
/* Names of the columns. */
void text_header(void);
/* An answer's line. */
void text_answer(const sptfra_result *result);

#endif
