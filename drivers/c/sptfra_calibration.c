/* SPDX-License-Identifier: MIT OR Apache-2.0 */
/* Calibration in RAM and tare: see sptfra.h, and docs/reference/registers.md for the words of a bank. */
#include "sptfra_bank.h"

#define ALL_ERRORS 0x3Fu

static int is_there(const sptfra *device)
{
    if (!device->has_registers) {
        return SPTFRA_NO_REGISTERS;
    }
    return FIELD(GET(device, FEATURES), FEATURES__CALIBRATION_RAM) ? SPTFRA_OK : SPTFRA_NO_CALIBRATION;
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

/* The dead taxels of the active map, at most as many as fit into the count's four bits. */
static int acting_map(const sptfra *device, const sptfra_numbers *of, uint16_t dead[15], uint32_t *count)
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

int sptfra_check_bank(const sptfra *device, const double *gain, const double *offset, const sptfra_replaced *replaced,
    const sptfra_curve *curve, double noise_floor_pa, sptfra_refusal *why)
{
    sptfra_numbers of;
    uint32_t taxel, count, words[2];
    uint16_t dead[15];
    int found, taken = 1;

    found = is_there(device);
    if (found != SPTFRA_OK) {
        return found;
    }
    sptfra_numbers_of(device, &of);
    for (taxel = 0; taxel < of.taxels && taken; taxel++) {
        taken = sptfra_words_of_taxel(&of, gain[taxel], offset[taxel], words)
            || sptfra_refuse(why, SPTFRA_WRONG_TAXEL, taxel);
    }
    if (taken && replaced != NULL) {
        taken = sptfra_replaceable(&of, replaced, why)
            && sptfra_all_stand(&of, gain, replaced->taxels, replaced->count, why);
    } else if (taken && of.room > 0) {
        found = acting_map(device, &of, dead, &count);
        if (found != SPTFRA_OK) {
            return found;
        }
        taken = sptfra_all_stand(&of, gain, dead, count, why);
    }
    taken = taken && (curve == NULL || sptfra_curve_fits(&of, curve, why));
    taken = taken
        && (!(noise_floor_pa > 0.0) || sptfra_words_of_noise(&of, noise_floor_pa, words)
            || sptfra_refuse(why, SPTFRA_WRONG_NOISE, 0));
    return taken ? SPTFRA_OK : SPTFRA_OUT_OF_RANGE;
}

int sptfra_load_bank_and_curve(const sptfra *device, const double *gain, const double *offset,
    const sptfra_replaced *replaced, const sptfra_curve *curve, double noise_floor_pa, uint32_t polls)
{
    sptfra_numbers of;
    sptfra_refusal why;
    uint32_t taxel, place, word, in_map, in_curve, shift, crc = UINT32_MAX, thresholds[2];
    uint32_t words[2];
    int kind, found;

    /* Before anything is written. */
    found = sptfra_check_bank(device, gain, offset, replaced, curve, noise_floor_pa, &why);
    if (found != SPTFRA_OK) {
        return found;
    }
    sptfra_numbers_of(device, &of);
    shift = replaced != NULL ? sptfra_weight_shift(&of, replaced) : 0;
    if (noise_floor_pa > 0.0) {
        sptfra_words_of_noise(&of, noise_floor_pa, thresholds);
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
            sptfra_words_of_taxel(&of, gain[taxel], offset[taxel], words);
            SET(device, CALIBRATION_DATA, words[kind]);
            crc = crc_of(crc, words[kind]);
        }
    }
    for (kind = 0; kind < 2; kind++) {
        SET(device, CALIBRATION_DATA, thresholds[kind]);
        crc = crc_of(crc, thresholds[kind]);
    }
    in_map = of.room > 0 ? 1u + of.room * (1u + of.taxels) : 0u;
    in_curve = of.segments > 0 ? SPTFRA_SEGMENT_WORDS * of.segments + SPTFRA_END_WORDS : 0u;
    for (place = 0; place < in_map + in_curve; place++) {
        const uint32_t index = 2u * of.taxels + 2u + place;

        if (place >= in_map && curve != NULL) {
            word = sptfra_word_of_curve(&of, curve, place - in_map);
        } else if (place < in_map && replaced != NULL) {
            word = sptfra_word_of_map(&of, replaced, shift, place);
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
