/* SPDX-License-Identifier: MIT OR Apache-2.0 */
/* The words of a bank from gains, offsets, dead taxels and a curve: sptfra_calibration.c's own. */
#ifndef SPTFRA_BANK_H
#define SPTFRA_BANK_H

#include "sptfra_private.h"

/* Words of a curve: of a segment, and behind the last one. */
#define SPTFRA_SEGMENT_WORDS 4u
#define SPTFRA_END_WORDS 3u

/* What the core's registers say of its banks. */
typedef struct {
    double count_steps; /* steps of the stress for a count at a gain of 1 */
    int shift, lsb;
    double offset_limit;
    uint32_t taxels;
    uint32_t room; /* dead taxels that a bank has room for */
    uint32_t segments; /* of a curve for which a bank has room; 0: it has none */
    int number_exponent, value_lsb;
} sptfra_numbers;

void sptfra_numbers_of(const sptfra *device, sptfra_numbers *of);

/* Words of a taxel, and of the thresholds; these return 0 for what no bank takes. */
int sptfra_words_of_taxel(const sptfra_numbers *of, double gain, double offset, uint32_t words[2]);
int sptfra_words_of_noise(const sptfra_numbers *of, double noise_floor_pa, uint32_t words[2]);

/* These say why, too: by sptfra_refuse, which returns 0. */
int sptfra_refuse(sptfra_refusal *why, int what, uint32_t place);
int sptfra_replaceable(const sptfra_numbers *of, const sptfra_replaced *replaced, sptfra_refusal *why);
/* Whether something takes the place of each taxel of gain 0: else its contact would read nothing, and nobody would
 * know. */
int sptfra_all_stand(
    const sptfra_numbers *of, const double *gain, const uint16_t *dead, uint32_t count, sptfra_refusal *why);
int sptfra_curve_fits(const sptfra_numbers *of, const sptfra_curve *curve, sptfra_refusal *why);

/* Fraction bits that the weights have: the most with which each, and all of a sum together, have room. */
uint32_t sptfra_weight_shift(const sptfra_numbers *of, const sptfra_replaced *replaced);
/* Word by word: count and shift, numbers, then each taxel's weights. */
uint32_t sptfra_word_of_map(const sptfra_numbers *of, const sptfra_replaced *replaced, uint32_t shift, uint32_t place);
/* Word by word: each segment's, then the end. */
uint32_t sptfra_word_of_curve(const sptfra_numbers *of, const sptfra_curve *curve, uint32_t place);

#endif
