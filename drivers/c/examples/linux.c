/* SPDX-License-Identifier: MIT OR Apache-2.0 */
/* The core on the board, as linux/NAME_BOARD.dtso of the generated folder shows it to Linux: two UIO devices, found by
 * their nodes' names, and a buffer of u-dma-buf. */
#define _POSIX_C_SOURCE 200809L
#include "system.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#define BUFFER "sptfra-buffer"
#define DMA_BYTES 0x10000u
#define CORE_BYTES 0x1000u
#define PATIENCE_MS 1000

const char system_usage[] = "";
const int system_arguments = 0;

static sptfra_uio core, dma;
static int has_core;
static void *mapped;
static size_t mapped_bytes;

/* SPTFRA_ROOT is set where /sys and /dev are not at the root: in a test. */
static void path_of(char *path, size_t room, const char *format, const char *name)
{
    const char *root = getenv("SPTFRA_ROOT");
    const int length = snprintf(path, room, "%s", root != NULL ? root : "");

    if (length >= 0 && (size_t)length < room) {
        snprintf(path + length, room - (size_t)length, format, name);
    }
}

/* The first line of a file; 0 if there is none. */
static int first_line(const char *path, char *line, int room)
{
    FILE *file = fopen(path, "r");
    const int there = file != NULL && fgets(line, room, file) != NULL;

    if (file != NULL) {
        fclose(file);
    }
    if (there) {
        line[strcspn(line, "\n")] = '\0';
    }
    return there;
}

/* Maps the UIO device of the node `name`; 0 after a message. */
static int open_uio(sptfra_uio *uio, const char *name, size_t bytes)
{
    char path[512], found[64];
    const struct dirent *entry;
    DIR *devices;
    int known = 0;

    path_of(path, sizeof path, "/sys/class/uio", "");
    devices = opendir(path);
    while (!known && devices != NULL && (entry = readdir(devices)) != NULL) {
        char node[300];

        snprintf(node, sizeof node, "%s", entry->d_name);
        path_of(path, sizeof path, "/sys/class/uio/%s/name", node);
        known = first_line(path, found, sizeof found) && strcmp(found, name) == 0;
        path_of(path, sizeof path, "/dev/%s", node);
    }
    if (devices != NULL) {
        closedir(devices);
    }
    if (!known) {
        fprintf(stderr, "no UIO device %s: is the overlay loaded, and uio_pdrv_genirq with of_id=generic-uio?\n", name);
        return 0;
    }
    if (sptfra_uio_open(uio, path, bytes) != SPTFRA_OK) {
        perror(path);
        return 0;
    }
    return 1;
}

/* The buffer, not cached, and where the DMA finds it; 0 after a message. */
static int open_buffer(sptfra_buffer *memory)
{
    char path[512], address[32], bytes[32];
    int file;

    path_of(path, sizeof path, "/sys/class/u-dma-buf/%s/phys_addr", BUFFER);
    if (!first_line(path, address, sizeof address)) {
        fprintf(stderr, "no buffer %s: is the module u-dma-buf loaded?\n", BUFFER);
        return 0;
    }
    path_of(path, sizeof path, "/sys/class/u-dma-buf/%s/size", BUFFER);
    if (!first_line(path, bytes, sizeof bytes)) {
        perror(path);
        return 0;
    }
    path_of(path, sizeof path, "/dev/%s", BUFFER);
    file = open(path, O_RDWR | O_SYNC | O_CLOEXEC);
    if (file < 0) {
        perror(path);
        return 0;
    }
    mapped_bytes = strtoull(bytes, NULL, 0);
    mapped = mmap(NULL, mapped_bytes, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    close(file);
    if (mapped == MAP_FAILED) {
        perror(path);
        return 0;
    }
    *memory = (sptfra_buffer){mapped, strtoull(address, NULL, 0), mapped_bytes};
    return 1;
}

int system_open(sptfra *device, sptfra_buffer *memory, const system_options *options, char **arguments)
{
    int code;

    (void)arguments;
    has_core = options->shape == NULL;
    if ((has_core && !open_uio(&core, "sptfra-core", CORE_BYTES)) || !open_uio(&dma, "sptfra-dma", DMA_BYTES)
        || !open_buffer(memory)) {
        return 0;
    }
    code = has_core ? sptfra_open(device, &sptfra_memory_mapped, core.base, dma.base)
                    : sptfra_open_streams(device, &sptfra_memory_mapped, dma.base, options->shape);
    if (code != SPTFRA_OK) {
        fprintf(stderr, "core: %s\n", sptfra_error(code));
    }
    return code == SPTFRA_OK;
}

int system_wait(void) { return sptfra_uio_wait(&dma, PATIENCE_MS); }

void system_close(void)
{
    munmap(mapped, mapped_bytes);
    sptfra_uio_close(&dma);
    if (has_core) {
        sptfra_uio_close(&core);
    }
}
