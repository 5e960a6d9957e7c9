/* SPDX-License-Identifier: MIT OR Apache-2.0 */
/* See sptfra_bank.h, and docs/reference/registers.md for the words of a bank. */
#include "sptfra_bank.h"

#include <string.h>

#define MANTISSA_BITS 18
#define MANTISSA_MASK 0x3FFFFu
#define EXPONENT_MASK 0x3FFu
#define LEAST_MANTISSA 65536
#define MOST_MANTISSA 131071.0
#define LEAST_EXPONENT (-512)
/* Of a design file's calibration. */
#define LEAST_GAIN 1e-9
#define MOST_GAIN 16.0
#define MOST_OFFSET 1e6
/* Of the weights of dead taxels. */
#define MOST_WEIGHT_SHIFT 17u
#define MOST_WEIGHTS 2097151.0
/* Of a curve. */
#define MOST_NUMBER 33554431.0
#define MOST_VALUE 67104767.0
#define MOST_CURVE_SHIFT 40

/* ---- Numbers, without a library of mathematics */

/* 2^exponent, of a normal number. */
static double power(int exponent)
{
    const uint64_t bits = (uint64_t)(1023 + exponent) << 52;
    double value;

    memcpy(&value, &bits, sizeof value);
    return value;
}

/* The exponent of the highest bit. */
static int exponent_of(double value)
{
    uint64_t bits;

    memcpy(&bits, &value, sizeof bits);
    return (int)(bits >> 52 & 0x7FFu) - 1023;
}

static double magnitude(double value)
{
    return value < 0.0 ? -value : value;
}

/* To the nearest, ties away from zero; of values that an int64_t holds. */
static int64_t rounded(double value)
{
    const int64_t whole = (int64_t)value;

    if (magnitude(value - (double)whole) < 0.5) {
        return whole;
    }
    return value < 0.0 ? whole - 1 : whole + 1;
}

static int signed_byte(uint32_t byte)
{
    return (int)byte - (byte > 127u ? 256 : 0);
}

void sptfra_numbers_of(const sptfra *device, sptfra_numbers *of)
{
    const uint32_t word = GET(device, CALIBRATION);
    const uint64_t bits
        = (uint64_t)GET(device, CALIBRATION_STEPS_HIGH) << 32 | GET(device, CALIBRATION_STEPS_LOW);

    memcpy(&of->count_steps, &bits, sizeof of->count_steps);
    of->shift = (int)FIELD(word, CALIBRATION__SHIFT);
    of->lsb = signed_byte(FIELD(word, CALIBRATION__LSB));
    of->offset_limit = (double)GET(device, CALIBRATION_OFFSET_LIMIT);
    of->room = FIELD(GET(device, FEATURES), FEATURES__REPLACEABLE);
    of->taxels = (uint32_t)device->shape.columns * device->shape.rows;
    of->segments = 0;
    if (FIELD(GET(device, FEATURES), FEATURES__CURVE_IN_RAM)) {
        const uint32_t curve = GET(device, CALIBRATION_CURVE);

        of->segments = FIELD(curve, CALIBRATION_CURVE__ROOM);
        of->number_exponent = signed_byte(FIELD(curve, CALIBRATION_CURVE__EXPONENT));
        of->value_lsb = signed_byte(FIELD(curve, CALIBRATION_CURVE__LSB));
    }
}

int sptfra_words_of_taxel(const sptfra_numbers *of, double gain, double offset, uint32_t words[2])
{
    double steps, scaled;
    int64_t mantissa;
    int exponent;

    if (gain == 0.0) {
        words[0] = ((uint32_t)LEAST_EXPONENT & EXPONENT_MASK) << MANTISSA_BITS | LEAST_MANTISSA;
        words[1] = 0;
        return 1;
    }
    if (!(gain >= LEAST_GAIN && gain <= MOST_GAIN && magnitude(offset) <= MOST_OFFSET)) {
        return 0;
    }
    steps = gain * of->count_steps;
    exponent = exponent_of(steps) + 2 - MANTISSA_BITS;
    while ((double)rounded(magnitude(steps) * power(-exponent)) > MOST_MANTISSA) {
        exponent++;
    }
    mantissa = rounded(steps * power(-exponent));
    /* By the gain as it is stored, so that the count of no stress at all gives none. */
    scaled = offset / gain * (double)mantissa * power(exponent);
    if (!(magnitude(scaled) < of->offset_limit + 0.5)) {
        return 0;
    }
    exponent += of->shift;
    words[0] = ((uint32_t)exponent & EXPONENT_MASK) << MANTISSA_BITS | ((uint32_t)mantissa & MANTISSA_MASK);
    words[1] = (uint32_t)rounded(scaled);
    return 1;
}

int sptfra_words_of_noise(const sptfra_numbers *of, double noise_floor_pa, uint32_t words[2])
{
    const double noise = noise_floor_pa * power(-of->lsb);
    const double contact = noise_floor_pa * (double)of->taxels * power(-of->lsb);

    if (!(noise <= 67108863.0 && contact <= 4294967295.0)) {
        return 0;
    }
    words[0] = contact < 1.0 ? 1u : (uint32_t)rounded(contact);
    words[1] = noise < 1.0 ? 1u : (uint32_t)rounded(noise);
    return 1;
}

/* ---- Dead taxels */

uint32_t sptfra_weight_shift(const sptfra_numbers *of, const sptfra_replaced *replaced)
{
    uint32_t shift, dead, taxel;

    for (shift = MOST_WEIGHT_SHIFT; shift > 0; shift--) {
        int fits = 1;

        for (dead = 0; dead < replaced->count && fits; dead++) {
            double sum = 0.0;

            for (taxel = 0; taxel < of->taxels; taxel++) {
                const double weight = magnitude(replaced->weights[dead * of->taxels + taxel]) * power((int)shift);

                fits = fits && weight < MOST_MANTISSA + 0.5;
                sum += fits ? (double)rounded(weight) : 0.0;
            }
            fits = fits && sum <= MOST_WEIGHTS;
        }
        if (fits) {
            break;
        }
    }
    return shift;
}

int sptfra_refuse(sptfra_refusal *why, int what, uint32_t place)
{
    *why = (sptfra_refusal){what, place};
    return 0;
}

int sptfra_replaceable(const sptfra_numbers *of, const sptfra_replaced *replaced, sptfra_refusal *why)
{
    uint32_t dead, taxel, other;

    if (replaced->count > of->room) {
        return sptfra_refuse(why, SPTFRA_TOO_MANY_DEAD, of->room);
    }
    for (dead = 0; dead < replaced->count; dead++) {
        double sum = 0.0;

        if (replaced->taxels[dead] >= of->taxels
            || (dead > 0 && replaced->taxels[dead] <= replaced->taxels[dead - 1])) {
            return sptfra_refuse(why, SPTFRA_NO_SUCH_TAXEL, replaced->taxels[dead]);
        }
        for (taxel = 0; taxel < of->taxels; taxel++) {
            const double weight = replaced->weights[dead * of->taxels + taxel];

            if (!(magnitude(weight) < MOST_MANTISSA + 0.5)) {
                return sptfra_refuse(why, SPTFRA_WRONG_WEIGHT, taxel);
            }
            sum += (double)rounded(magnitude(weight));
        }
        for (other = 0; other < replaced->count; other++) {
            if (replaced->weights[dead * of->taxels + replaced->taxels[other]] != 0.0) {
                return sptfra_refuse(why, SPTFRA_WRONG_WEIGHT, replaced->taxels[other]);
            }
        }
        if (sum > MOST_WEIGHTS) {
            return sptfra_refuse(why, SPTFRA_TOO_LARGE_WEIGHTS, replaced->taxels[dead]);
        }
    }
    return 1;
}

uint32_t sptfra_word_of_map(const sptfra_numbers *of, const sptfra_replaced *replaced, uint32_t shift, uint32_t place)
{
    uint32_t dead, taxel;

    if (place == 0) {
        return replaced->count | shift << 8;
    }
    if (place <= of->room) {
        return place <= replaced->count ? replaced->taxels[place - 1] : 0u;
    }
    dead = (place - 1u - of->room) % of->room;
    taxel = (place - 1u - of->room) / of->room;
    if (dead >= replaced->count) {
        return 0u;
    }
    return (uint32_t)rounded(replaced->weights[dead * of->taxels + taxel] * power((int)shift));
}

int sptfra_all_stand(
    const sptfra_numbers *of, const double *gain, const uint16_t *dead, uint32_t count, sptfra_refusal *why)
{
    uint32_t taxel, next = 0;

    for (taxel = 0; taxel < of->taxels; taxel++) {
        if (next < count && dead[next] == taxel) {
            next++;
        } else if (gain[taxel] == 0.0) {
            return sptfra_refuse(why, SPTFRA_NOT_REPLACED, taxel);
        }
    }
    return 1;
}

/* ---- Curves */

/* Words of a segment: number and value, slope and its shift; 0 if it is none that a bank takes. */
static int words_of_segment(const sptfra_numbers *of, const sptfra_curve *curve, uint32_t place, uint32_t words[4])
{
    int64_t points[2][2], mantissa = 0;
    double rise;
    int which, dropped = MANTISSA_BITS - 2, less;

    for (which = 0; which < 2; which++) {
        const double number = curve->counts[place + (uint32_t)which] * power(of->number_exponent);
        const double value = curve->pascals[place + (uint32_t)which] * power(-of->value_lsb);

        if (!(magnitude(number) < MOST_NUMBER + 0.5 && magnitude(value) < MOST_VALUE + 0.5)) {
            return 0;
        }
        points[which][0] = rounded(number);
        points[which][1] = rounded(value);
    }
    if (points[1][0] <= points[0][0]) {
        return 0;
    }
    rise = (double)(points[1][1] - points[0][1]) / (double)(points[1][0] - points[0][0]);
    if (points[1][1] != points[0][1]) {
        dropped = MANTISSA_BITS - 2 - exponent_of(rise);
        while ((double)rounded(magnitude(rise) * power(dropped)) > MOST_MANTISSA) {
            dropped--;
        }
        mantissa = rounded(rise * power(dropped));
    }
    if (dropped < 1) {
        return 0;
    }
    /* A slope of next to nothing has fewer bits. */
    less = dropped - MOST_CURVE_SHIFT;
    if (less > 0) {
        mantissa = (mantissa + ((int64_t)1 << (less - 1))) >> less;
        dropped = MOST_CURVE_SHIFT;
    }
    words[0] = (uint32_t)points[0][0];
    words[1] = (uint32_t)points[0][1];
    words[2] = (uint32_t)mantissa;
    words[3] = (uint32_t)dropped;
    return 1;
}

int sptfra_curve_fits(const sptfra_numbers *of, const sptfra_curve *curve, sptfra_refusal *why)
{
    uint32_t place, words[4];
    int falls;

    if (curve->count < 2 || curve->count > of->segments + 1) {
        return sptfra_refuse(why, SPTFRA_WRONG_POINTS, of->segments);
    }
    falls = curve->pascals[1] < curve->pascals[0];
    for (place = 0; place + 1 < curve->count; place++) {
        const double from = curve->pascals[place], to = curve->pascals[place + 1];

        if (!(falls ? to < from : to > from) || !words_of_segment(of, curve, place, words)) {
            return sptfra_refuse(why, SPTFRA_WRONG_POINT, place + 1);
        }
    }
    return 1;
}

uint32_t sptfra_word_of_curve(const sptfra_numbers *of, const sptfra_curve *curve, uint32_t place)
{
    uint32_t words[4] = {0, 0, 0, 1};

    if (place < SPTFRA_SEGMENT_WORDS * of->segments) {
        if (place / SPTFRA_SEGMENT_WORDS + 1 < curve->count) {
            words_of_segment(of, curve, place / SPTFRA_SEGMENT_WORDS, words);
        }
        return words[place % SPTFRA_SEGMENT_WORDS];
    }
    switch (place - SPTFRA_SEGMENT_WORDS * of->segments) {
    case 0:
        return curve->count - 1;
    case 1:
        return (uint32_t)rounded(curve->counts[curve->count - 1] * power(of->number_exponent));
    default:
        return (uint32_t)rounded(curve->pascals[curve->count - 1] * power(-of->value_lsb));
    }
}
