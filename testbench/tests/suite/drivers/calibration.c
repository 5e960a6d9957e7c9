// SPDX-License-Identifier: MIT OR Apache-2.0
/* The C driver's calibration on the host, against the simulated core.
 *
 *   calibration CORE.so BANKS COLUMNS ROWS
 *
 * BANKS is binary, little-endian: gains and offsets of each taxel (float64), a noise floor in Pa (float64, 0: none), the
 * count of dead taxels (-1: nothing is said of them), two numbers and two weights of each taxel (float64), the points of
 * a curve (-1: nothing is said of it), 17 counts and 17 pascals (float64), and the words of the bank (uint32); then the same
 * for the next one. */
#include "check.h"
#include "machine.h"
#include "sptfra.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MOST_TAXELS 64
#define MOST_POINTS 17
#define POLLS 1000000u

_Alignas(SPTFRA_LINE) static uint32_t stress_words[1024], force_words[1024];

static void send(sptfra *device, float count, sptfra_result *result)
{
    const sptfra_buffer stress = {stress_words, (uintptr_t)stress_words + MACHINE_BUS_OFFSET, sizeof stress_words};
    const sptfra_buffer forces = {force_words, (uintptr_t)force_words + MACHINE_BUS_OFFSET, sizeof force_words};
    uint32_t word;

    for (word = 0; word < device->shape.words_in; word++) {
        memcpy(&stress_words[word], &count, sizeof count);
    }
    CHECK(sptfra_process(device, &stress, &forces, POLLS) == SPTFRA_OK);
    CHECK(sptfra_decode(&device->shape, force_words, result) == SPTFRA_OK);
}

int main(int count, char **arguments)
{
    static double gain[MOST_TAXELS], offset[MOST_TAXELS];
    static double map[3 + 2 * MOST_TAXELS];
    static double points[1 + 2 * MOST_POINTS];
    static uint32_t words[4 * MOST_TAXELS + 5 + 4 * (MOST_POINTS - 1) + 3];
    uint16_t dead[2];
    sptfra_replaced replaced = {0, dead, map + 3};
    sptfra_curve curve = {0, points + 1, points + 1 + MOST_POINTS};
    sptfra_platform platform = {NULL, machine_read, machine_write, NULL, NULL, NULL};
    sptfra_result result;
    sptfra_identity identity;
    sptfra device;
    machine *system;
    FILE *file;
    double noise_floor;
    uint32_t word, index, banks = 0, taxels, length;

    CHECK(count == 5);
    taxels = (uint32_t)atoi(arguments[3]) * (uint32_t)atoi(arguments[4]);
    CHECK(taxels <= MOST_TAXELS);
    system = machine_open(arguments[1], 5, 1);
    CHECK(system != NULL);
    platform.context = system;
    CHECK(sptfra_open(&device, &platform, MACHINE_CORE, MACHINE_DMA) == SPTFRA_OK);
    CHECK(sptfra_identify(&device, &identity) == SPTFRA_OK && identity.calibration_in_ram && identity.curve_in_ram);
    CHECK(identity.replaceable == 2 && !identity.drops_frames);
    send(&device, 5.0f, &result);
    CHECK(result.version == 0 && result.replaced == 1);
    length = 4u * taxels + 5u + 4u * (MOST_POINTS - 1u) + 3u;
    file = fopen(arguments[2], "rb");
    CHECK(file != NULL);
    while (fread(gain, sizeof *gain, taxels, file) == taxels) {
        CHECK(fread(offset, sizeof *offset, taxels, file) == taxels && fread(&noise_floor, 8, 1, file) == 1);
        CHECK(fread(map, 8, 3u + 2u * taxels, file) == 3u + 2u * taxels);
        CHECK(fread(points, 8, 1 + 2 * MOST_POINTS, file) == 1 + 2 * MOST_POINTS);
        CHECK(fread(words, 4, length, file) == length);
        replaced.count = map[0] < 0.0 ? 0u : (uint32_t)map[0];
        dead[0] = (uint16_t)map[1];
        dead[1] = (uint16_t)map[2];
        curve.count = points[0] < 0.0 ? 0u : (uint32_t)points[0];
        if (map[0] < 0.0 && points[0] < 0.0) {
            CHECK(sptfra_load_calibration(&device, gain, offset, noise_floor, POLLS) == SPTFRA_OK);
        } else if (points[0] < 0.0) {
            CHECK(sptfra_load_bank(&device, gain, offset, &replaced, noise_floor, POLLS) == SPTFRA_OK);
        } else {
            CHECK(sptfra_load_bank_and_curve(&device, gain, offset, map[0] < 0.0 ? NULL : &replaced, &curve, noise_floor,
                      POLLS) == SPTFRA_OK);
        }
        for (index = 0; index < length; index++) {
            CHECK(sptfra_read_calibration(&device, (uint16_t)index, 1, &word) == SPTFRA_OK);
            CHECK(word == words[index]);
        }
        banks++;
        send(&device, 5.0f, &result);
        CHECK(result.version == banks);
    }
    CHECK(banks > 3);
    /* What is refused before anything is written, and what the core refuses. */
    gain[taxels - 1] = 17.0;
    CHECK(sptfra_load_calibration(&device, gain, offset, 0.0, POLLS) == SPTFRA_OUT_OF_RANGE);
    gain[taxels - 1] = 1.0;
    memset(map, 0, sizeof map);
    dead[0] = 3;
    dead[1] = 3;
    replaced.count = 2;
    CHECK(sptfra_load_bank(&device, gain, offset, &replaced, 0.0, POLLS) == SPTFRA_OUT_OF_RANGE);
    dead[1] = (uint16_t)taxels;
    CHECK(sptfra_load_bank(&device, gain, offset, &replaced, 0.0, POLLS) == SPTFRA_OUT_OF_RANGE);
    dead[1] = 4;
    map[3 + 4] = 0.1;
    CHECK(sptfra_load_bank(&device, gain, offset, &replaced, 0.0, POLLS) == SPTFRA_OUT_OF_RANGE);
    map[3 + 4] = 0.0;
    map[3 + 5] = 2e5;
    CHECK(sptfra_load_bank(&device, gain, offset, &replaced, 0.0, POLLS) == SPTFRA_OUT_OF_RANGE);
    replaced.count = 3;
    CHECK(sptfra_load_bank(&device, gain, offset, &replaced, 0.0, POLLS) == SPTFRA_OUT_OF_RANGE);
    replaced.count = 0;
    offset[taxels - 1] = 1e6;
    CHECK(sptfra_load_calibration(&device, gain, offset, 0.0, POLLS) == SPTFRA_OUT_OF_RANGE);
    offset[taxels - 1] = 0.0;
    CHECK(sptfra_load_calibration(&device, gain, offset, 1e12, POLLS) == SPTFRA_OUT_OF_RANGE);
    CHECK(sptfra_calibration_wait(&device, POLLS) == SPTFRA_OK);
    for (index = 0; index < taxels; index++) {
        gain[index] = 1.0;
        offset[index] = 0.0;
    }
    /* Curves that no bank takes, then one like the design's. */
    for (word = 0; word < MOST_POINTS; word++) {
        points[1 + word] = 1000.0 * word;
        points[1 + MOST_POINTS + word] = -12500.0 * word;
    }
    for (word = 0; word < 6; word++) {
        const double counts[] = {0.0, 0.0, 0.0, 0.0, 1e5, -100.0}, pascals[] = {0.0, 0.0, 0.0, -1e7, -1e5, -1e5};

        curve.count = word == 0 ? 0u : word == 1 ? 1u : word == 2 ? 18u : 4u;
        points[1 + 3] = word < 3 ? 3000.0 : word == 3 ? 3000.0 : counts[word];
        points[1 + MOST_POINTS + 3] = word < 3 ? -37500.0 : pascals[word];
        CHECK(sptfra_load_bank_and_curve(&device, gain, offset, &replaced, &curve, 0.0, POLLS) == SPTFRA_OUT_OF_RANGE);
    }
    points[1 + 3] = 3000.0;
    points[1 + MOST_POINTS + 3] = -20000.0;
    CHECK(sptfra_load_bank_and_curve(&device, gain, offset, &replaced, &curve, 0.0, POLLS) == SPTFRA_OUT_OF_RANGE);
    points[1 + MOST_POINTS + 3] = -37500.0;
    CHECK(sptfra_load_bank_and_curve(&device, gain, offset, &replaced, &curve, 0.0, POLLS) == SPTFRA_OK);
    banks++;
    /* The noise floor is that of the frames: 12 taxels that read 62.5 Pa each are none of 20 Pa, and one of 100 Pa. */
    for (word = 0; word < 4; word++) {
        const double floors[] = {20.0, 100.0, 0.0, 20.0};
        const uint16_t none[] = {0, SPTFRA_NO_CONTACT, SPTFRA_NO_CONTACT, 0};

        CHECK(sptfra_load_bank(&device, gain, offset, &replaced, floors[word], POLLS) == SPTFRA_OK);
        banks++;
        send(&device, 5.0f, &result);
        CHECK(result.version == banks && (result.status & SPTFRA_NO_CONTACT) == none[word]);
    }
    /* Tare: four frames at rest, then nothing is read; then one that is not. */
    CHECK(sptfra_load_bank(&device, gain, offset, &replaced, 20.0, 0) == SPTFRA_TIMEOUT);
    CHECK(sptfra_tare(&device, 2) == SPTFRA_CALIBRATION_BUSY);
    CHECK(sptfra_calibration_wait(&device, POLLS) == SPTFRA_OK);
    CHECK(sptfra_tare(&device, 11) == SPTFRA_OUT_OF_RANGE);
    CHECK(sptfra_tare(&device, 2) == SPTFRA_OK);
    CHECK(sptfra_calibration_wait(&device, 10) == SPTFRA_TIMEOUT);
    CHECK(sptfra_read_calibration(&device, 0, 1, &word) == SPTFRA_CALIBRATION_BUSY);
    for (index = 0; index < 4; index++) {
        send(&device, 300.0f, &result);
        CHECK(result.version == (uint8_t)(banks + 1) && !(result.status & SPTFRA_NO_CONTACT));
    }
    CHECK(sptfra_calibration_wait(&device, POLLS) == SPTFRA_OK);
    send(&device, 300.0f, &result);
    CHECK(result.version == (uint8_t)(banks + 2) && (result.status & SPTFRA_NO_CONTACT));
    CHECK(sptfra_tare(&device, 1) == SPTFRA_OK);
    send(&device, 300.0f, &result);
    send(&device, 310.0f, &result);
    CHECK(sptfra_calibration_wait(&device, POLLS) == SPTFRA_NOT_AT_REST);
    CHECK(sptfra_tare(&device, 0) == SPTFRA_OK);
    send(&device, 1e9f, &result);
    CHECK(sptfra_calibration_wait(&device, POLLS) == SPTFRA_BAD_REST);
    CHECK(strcmp(sptfra_error(SPTFRA_NO_CALIBRATION), "unknown code") != 0);
    CHECK(machine_faults(system) == 0);
    fclose(file);
    machine_close(system);
    printf("PASS: %u banks\n", banks);
    return 0;
}
