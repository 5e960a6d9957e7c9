/* SPDX-License-Identifier: MIT OR Apache-2.0 */
/* Calibration in RAM and tare: see sptfra.h, and docs/control.md for the words of a bank. */
#include "sptfra_private.h"

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
#define ALL_ERRORS 0x3Fu
/* Of the weights of dead taxels. */
#define MOST_WEIGHT_SHIFT 17u
#define MOST_WEIGHTS 2097151.0
/* Of a curve. */
#define MOST_NUMBER 33554431.0
#define MOST_VALUE 67104767.0
#define MOST_CURVE_SHIFT 40
#define SEGMENT_WORDS 4u
#define END_WORDS 3u

static int is_there(const sptfra *device)
{
    if (!device->has_registers) {
        return SPTFRA_NO_REGISTERS;
    }
    return FIELD(GET(device, FEATURES), FEATURES__CALIBRATION_RAM) ? SPTFRA_OK : SPTFRA_NO_CALIBRATION;
}

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

typedef struct {
    double count_steps; /* steps of the stress for a count at a gain of 1 */
    int shift, lsb;
    double offset_limit;
    uint32_t taxels;
    uint32_t room; /* dead taxels that a bank has room for */
    uint32_t segments; /* of a curve for which a bank has room; 0: it has none */
    int number_exponent, value_lsb;
} numbers;

static int signed_byte(uint32_t byte)
{
    return (int)byte - (byte > 127u ? 256 : 0);
}

static void numbers_of(const sptfra *device, numbers *of)
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

/* The words of a taxel; 0 if one of the values is none that a bank takes. */
static int words_of(const numbers *of, double gain, double offset, uint32_t words[2])
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

/* CRC-32 as of Ethernet and zlib, a word more. */
static uint32_t crc_of(uint32_t crc, uint32_t word)
{
    int bit;

    crc ^= word;
    for (bit = 0; bit < 32; bit++) {
        crc = crc >> 1 ^ (0xEDB88320u & (0u - (crc & 1u)));
    }
    return crc;
}

/* ---- Banks */

int sptfra_read_calibration(const sptfra *device, uint16_t index, int acting, uint32_t *word)
{
    const int there = is_there(device);

    if (there != SPTFRA_OK) {
        return there;
    }
    if (FIELD(GET(device, CALIBRATION_STATUS), CALIBRATION_STATUS__BUSY)) {
        return SPTFRA_CALIBRATION_BUSY;
    }
    SET(device, CALIBRATION_INDEX, (acting ? SPTFRA__CALIBRATION_INDEX__ACTIVE_bm : 0u) | index);
    *word = GET(device, CALIBRATION_DATA);
    return SPTFRA_OK;
}

int sptfra_calibration_wait(const sptfra *device, uint32_t polls)
{
    const int there = is_there(device);
    uint32_t errors;

    if (there != SPTFRA_OK) {
        return there;
    }
    while (FIELD(GET(device, CALIBRATION_STATUS), CALIBRATION_STATUS__BUSY)) {
        if (polls == 0) {
            return SPTFRA_TIMEOUT;
        }
        polls -= polls != SPTFRA_FOREVER;
    }
    errors = GET(device, CALIBRATION_ERRORS);
    SET(device, CALIBRATION_ERRORS, errors);
    if (errors & SPTFRA__CALIBRATION_ERRORS__BAD_FRAME_bm) {
        return SPTFRA_BAD_REST;
    }
    if (errors & SPTFRA__CALIBRATION_ERRORS__NOT_AT_REST_bm) {
        return SPTFRA_NOT_AT_REST;
    }
    if (errors & SPTFRA__CALIBRATION_ERRORS__WRONG_CRC_bm) {
        return SPTFRA_WRONG_CRC;
    }
    if (errors & SPTFRA__CALIBRATION_ERRORS__CONTRADICTION_bm) {
        return SPTFRA_CONTRADICTION;
    }
    if (errors & SPTFRA__CALIBRATION_ERRORS__BUSY_bm) {
        return SPTFRA_CALIBRATION_BUSY;
    }
    return errors ? SPTFRA_OUT_OF_RANGE : SPTFRA_OK;
}

/* ---- Dead taxels */

/* Fraction bits that the weights have: the most with which each, and all of a sum together, have room. */
static uint32_t weight_shift(const numbers *of, const sptfra_replaced *replaced)
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

static int refuse(sptfra_refusal *why, int what, uint32_t place)
{
    *why = (sptfra_refusal){what, place};
    return 0;
}

/* Whether a bank takes it; with a shift of 0 it may still be too much. */
static int replaceable(const numbers *of, const sptfra_replaced *replaced, sptfra_refusal *why)
{
    uint32_t dead, taxel, other;

    if (replaced->count > of->room) {
        return refuse(why, SPTFRA_TOO_MANY_DEAD, of->room);
    }
    for (dead = 0; dead < replaced->count; dead++) {
        double sum = 0.0;

        if (replaced->taxels[dead] >= of->taxels || (dead > 0 && replaced->taxels[dead] <= replaced->taxels[dead - 1])) {
            return refuse(why, SPTFRA_NO_SUCH_TAXEL, replaced->taxels[dead]);
        }
        for (taxel = 0; taxel < of->taxels; taxel++) {
            const double weight = replaced->weights[dead * of->taxels + taxel];

            if (!(magnitude(weight) < MOST_MANTISSA + 0.5)) {
                return refuse(why, SPTFRA_WRONG_WEIGHT, taxel);
            }
            sum += (double)rounded(magnitude(weight));
        }
        for (other = 0; other < replaced->count; other++) {
            if (replaced->weights[dead * of->taxels + replaced->taxels[other]] != 0.0) {
                return refuse(why, SPTFRA_WRONG_WEIGHT, replaced->taxels[other]);
            }
        }
        if (sum > MOST_WEIGHTS) {
            return refuse(why, SPTFRA_TOO_LARGE_WEIGHTS, replaced->taxels[dead]);
        }
    }
    return 1;
}

/* Word by word: count and shift, numbers, then each taxel's weights. */
static uint32_t word_of_map(const numbers *of, const sptfra_replaced *replaced, uint32_t shift, uint32_t place)
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

/* Whether something takes the place of each taxel of gain 0: else its contact would read nothing, and nobody would know. */
static int all_stand(
    const numbers *of, const double *gain, const uint16_t *dead, uint32_t count, sptfra_refusal *why)
{
    uint32_t taxel, next = 0;

    for (taxel = 0; taxel < of->taxels; taxel++) {
        if (next < count && dead[next] == taxel) {
            next++;
        } else if (gain[taxel] == 0.0) {
            return refuse(why, SPTFRA_NOT_REPLACED, taxel);
        }
    }
    return 1;
}

/* The dead taxels of the map that acts, at most as many as fit into the count's four bits. */
static int acting_map(const sptfra *device, const numbers *of, uint16_t dead[15], uint32_t *count)
{
    uint32_t place, word;
    int found = sptfra_read_calibration(device, (uint16_t)(2u * of->taxels + 2u), 1, &word);

    *count = found == SPTFRA_OK ? word & 15u : 0u;
    for (place = 0; place < *count && found == SPTFRA_OK; place++) {
        found = sptfra_read_calibration(device, (uint16_t)(2u * of->taxels + 3u + place), 1, &word);
        dead[place] = (uint16_t)word;
    }
    return found;
}

/* ---- Curves */

/* Words of a segment: number and value, slope and its shift; 0 if it is none that a bank takes. */
static int words_of_segment(const numbers *of, const sptfra_curve *curve, uint32_t place, uint32_t words[4])
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

/* Whether a bank takes it. */
static int fits(const numbers *of, const sptfra_curve *curve, sptfra_refusal *why)
{
    uint32_t place, words[4];
    int falls;

    if (curve->count < 2 || curve->count > of->segments + 1) {
        return refuse(why, SPTFRA_WRONG_POINTS, of->segments);
    }
    falls = curve->pascals[1] < curve->pascals[0];
    for (place = 0; place + 1 < curve->count; place++) {
        const double from = curve->pascals[place], to = curve->pascals[place + 1];

        if (!(falls ? to < from : to > from) || !words_of_segment(of, curve, place, words)) {
            return refuse(why, SPTFRA_WRONG_POINT, place + 1);
        }
    }
    return 1;
}

static uint32_t word_of_curve(const numbers *of, const sptfra_curve *curve, uint32_t place)
{
    uint32_t words[4] = {0, 0, 0, 1};

    if (place < SEGMENT_WORDS * of->segments) {
        if (place / SEGMENT_WORDS + 1 < curve->count) {
            words_of_segment(of, curve, place / SEGMENT_WORDS, words);
        }
        return words[place % SEGMENT_WORDS];
    }
    switch (place - SEGMENT_WORDS * of->segments) {
    case 0:
        return curve->count - 1;
    case 1:
        return (uint32_t)rounded(curve->counts[curve->count - 1] * power(of->number_exponent));
    default:
        return (uint32_t)rounded(curve->pascals[curve->count - 1] * power(-of->value_lsb));
    }
}

/* ---- A whole bank */

int sptfra_load_calibration(
    const sptfra *device, const double *gain, const double *offset, double noise_floor_pa, uint32_t polls)
{
    return sptfra_load_bank(device, gain, offset, NULL, noise_floor_pa, polls);
}

int sptfra_load_bank(const sptfra *device, const double *gain, const double *offset, const sptfra_replaced *replaced,
    double noise_floor_pa, uint32_t polls)
{
    return sptfra_load_bank_and_curve(device, gain, offset, replaced, NULL, noise_floor_pa, polls);
}

/* The words of the thresholds; 0 if they are none that a bank takes. */
static int words_of_noise(const numbers *of, double noise_floor_pa, uint32_t words[2])
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

int sptfra_check_bank(const sptfra *device, const double *gain, const double *offset, const sptfra_replaced *replaced,
    const sptfra_curve *curve, double noise_floor_pa, sptfra_refusal *why)
{
    numbers of;
    uint32_t taxel, count, words[2];
    uint16_t dead[15];
    int found, taken = 1;

    found = is_there(device);
    if (found != SPTFRA_OK) {
        return found;
    }
    numbers_of(device, &of);
    for (taxel = 0; taxel < of.taxels && taken; taxel++) {
        taken = words_of(&of, gain[taxel], offset[taxel], words) || refuse(why, SPTFRA_WRONG_TAXEL, taxel);
    }
    if (taken && replaced != NULL) {
        taken = replaceable(&of, replaced, why) && all_stand(&of, gain, replaced->taxels, replaced->count, why);
    } else if (taken && of.room > 0) {
        found = acting_map(device, &of, dead, &count);
        if (found != SPTFRA_OK) {
            return found;
        }
        taken = all_stand(&of, gain, dead, count, why);
    }
    taken = taken && (curve == NULL || fits(&of, curve, why));
    taken = taken
        && (!(noise_floor_pa > 0.0) || words_of_noise(&of, noise_floor_pa, words) || refuse(why, SPTFRA_WRONG_NOISE, 0));
    return taken ? SPTFRA_OK : SPTFRA_OUT_OF_RANGE;
}

int sptfra_load_bank_and_curve(const sptfra *device, const double *gain, const double *offset,
    const sptfra_replaced *replaced, const sptfra_curve *curve, double noise_floor_pa, uint32_t polls)
{
    numbers of;
    sptfra_refusal why;
    uint32_t taxel, place, word, in_map, in_curve, shift, crc = UINT32_MAX, thresholds[2];
    uint32_t words[2];
    int kind, found;

    /* Before anything is written. */
    found = sptfra_check_bank(device, gain, offset, replaced, curve, noise_floor_pa, &why);
    if (found != SPTFRA_OK) {
        return found;
    }
    numbers_of(device, &of);
    shift = replaced != NULL ? weight_shift(&of, replaced) : 0;
    if (noise_floor_pa > 0.0) {
        words_of_noise(&of, noise_floor_pa, thresholds);
    } else {
        for (kind = 0; kind < 2; kind++) {
            found = sptfra_read_calibration(device, (uint16_t)(2u * of.taxels + (uint32_t)kind), 1, &thresholds[kind]);
            if (found != SPTFRA_OK) {
                return found;
            }
        }
    }
    if (FIELD(GET(device, CALIBRATION_STATUS), CALIBRATION_STATUS__BUSY)) {
        return SPTFRA_CALIBRATION_BUSY;
    }
    SET(device, CALIBRATION_ERRORS, ALL_ERRORS);
    SET(device, CALIBRATION_INDEX, 0u);
    for (kind = 0; kind < 2; kind++) {
        for (taxel = 0; taxel < of.taxels; taxel++) {
            words_of(&of, gain[taxel], offset[taxel], words);
            SET(device, CALIBRATION_DATA, words[kind]);
            crc = crc_of(crc, words[kind]);
        }
    }
    for (kind = 0; kind < 2; kind++) {
        SET(device, CALIBRATION_DATA, thresholds[kind]);
        crc = crc_of(crc, thresholds[kind]);
    }
    in_map = of.room > 0 ? 1u + of.room * (1u + of.taxels) : 0u;
    in_curve = of.segments > 0 ? SEGMENT_WORDS * of.segments + END_WORDS : 0u;
    for (place = 0; place < in_map + in_curve; place++) {
        const uint32_t index = 2u * of.taxels + 2u + place;

        if (place >= in_map && curve != NULL) {
            word = word_of_curve(&of, curve, place - in_map);
        } else if (place < in_map && replaced != NULL) {
            word = word_of_map(&of, replaced, shift, place);
        } else {
            found = sptfra_read_calibration(device, (uint16_t)index, 1, &word);
            if (found != SPTFRA_OK) {
                return found;
            }
            SET(device, CALIBRATION_INDEX, index);
        }
        SET(device, CALIBRATION_DATA, word);
        crc = crc_of(crc, word);
    }
    SET(device, CALIBRATION_COMMIT, ~crc);
    found = sptfra_calibration_wait(device, polls);
    if (found == SPTFRA_OK && GET(device, CALIBRATION_CRC) != ~crc) {
        return SPTFRA_WRONG_CRC;
    }
    return found;
}

int sptfra_tare(const sptfra *device, unsigned log2_frames)
{
    const int there = is_there(device);

    if (there != SPTFRA_OK) {
        return there;
    }
    if (log2_frames > SPTFRA_MOST_TARE_LOG2) {
        return SPTFRA_OUT_OF_RANGE;
    }
    if (FIELD(GET(device, CALIBRATION_STATUS), CALIBRATION_STATUS__BUSY)) {
        return SPTFRA_CALIBRATION_BUSY;
    }
    SET(device, CALIBRATION_ERRORS, ALL_ERRORS);
    SET(device, TARE, log2_frames);
    return SPTFRA_OK;
}
