// SPDX-License-Identifier: MIT OR Apache-2.0
/* Calibrations from files by the C driver, against the simulated core.
 *
 *   file CORE.so LIST
 *
 * A line of LIST: `good FILE CURVE NOISE WORDS`, the words of the bank in a file (uint32, little-endian); `bad FILE CURVE
 * NOISE CODE MESSAGE`, whose message has to hold what is behind the code; or `any FILE CURVE NOISE`, loaded or refused. A
 * CURVE of - is none. */
#include "check.h"
#include "machine.h"
#include "sptfra_file.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define POLLS 1000000u
#define NAME 64

/* What acts: its CRC, and how often it changed. */
static void acting(const sptfra *device, uint32_t state[2])
{
    state[0] = device->platform.read(device->platform.context, MACHINE_CORE + offsetof(sptfra_t, CALIBRATION_CRC));
    state[1] = device->platform.read(device->platform.context, MACHINE_CORE + offsetof(sptfra_t, CALIBRATION_STATUS));
}

static void compare(const sptfra *device, const char *name)
{
    FILE *file = fopen(name, "rb");
    uint32_t expected, word;
    uint16_t index;

    CHECK(file != NULL);
    for (index = 0; fread(&expected, sizeof expected, 1, file) == 1; index++) {
        CHECK(sptfra_read_calibration(device, index, 1, &word) == SPTFRA_OK);
        CHECK(word == expected);
    }
    CHECK(index > 20);
    fclose(file);
}

int main(int count, char **arguments)
{
    sptfra_platform platform = {NULL, machine_read, machine_write, NULL, NULL, NULL};
    sptfra device;
    machine *system;
    FILE *list;
    char line[512], kind[8], path[NAME], curve[NAME], rest[256], message[SPTFRA_MESSAGE_BYTES], small[9];
    unsigned good = 0, bad = 0, any = 0;

    CHECK(count == 3);
    system = machine_open(arguments[1], 5, 1);
    CHECK(system != NULL);
    platform.context = system;
    CHECK(sptfra_open(&device, &platform, MACHINE_CORE, MACHINE_DMA) == SPTFRA_OK);
    list = fopen(arguments[2], "r");
    CHECK(list != NULL);
    while (fgets(line, sizeof line, list) != NULL) {
        uint32_t before[2], after[2];
        double noise;
        int code, expected, used = 0;

        rest[0] = '\0';
        CHECK(sscanf(line, "%7s %63s %63s %lf %255[^\n]", kind, path, curve, &noise, rest) >= 4);
        acting(&device, before);
        memset(message, 'x', sizeof message);
        code = sptfra_load_calibration_file(
            &device, path, strcmp(curve, "-") == 0 ? NULL : curve, noise, POLLS, message, sizeof message);
        acting(&device, after);
        if (code != SPTFRA_OK && memcmp(before, after, sizeof before) != 0) {
            printf("%s: refused, and it acts\n", path);
            return 1;
        }
        if (strcmp(kind, "good") == 0) {
            if (code != SPTFRA_OK || message[0] != '\0') {
                printf("%s: %s\n", path, message);
                return 1;
            }
            compare(&device, rest);
            good++;
        } else if (strcmp(kind, "bad") == 0) {
            CHECK(sscanf(rest, "%d %n", &expected, &used) == 1);
            if (code != expected || strstr(message, rest + used) == NULL) {
                printf("%s: %d, %s, and not: %s\n", path, code, message, rest);
                return 1;
            }
            CHECK(code != SPTFRA_SYSTEM || errno != 0);
            /* As much as there is room for. */
            CHECK(sptfra_load_calibration_file(&device, path, strcmp(curve, "-") == 0 ? NULL : curve, noise, POLLS, small,
                      sizeof small) == expected);
            CHECK(strncmp(small, message, sizeof small - 1) == 0 && small[sizeof small - 1] == '\0');
            CHECK(sptfra_load_calibration_file(
                      &device, path, strcmp(curve, "-") == 0 ? NULL : curve, noise, POLLS, NULL, 0) == expected);
            bad++;
        } else {
            if (code != SPTFRA_OK && code != SPTFRA_BAD_FILE && code != SPTFRA_OUT_OF_RANGE) {
                printf("%s: %d, %s\n", path, code, message);
                return 1;
            }
            CHECK((code == SPTFRA_OK) == (message[0] == '\0'));
            any++;
        }
    }
    CHECK(strcmp(sptfra_error(SPTFRA_BAD_FILE), "unknown code") != 0);
    CHECK(machine_faults(system) == 0);
    fclose(list);
    machine_close(system);
    printf("PASS: %u good, %u bad, %u any\n", good, bad, any);
    return 0;
}
