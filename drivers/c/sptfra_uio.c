/* SPDX-License-Identifier: MIT OR Apache-2.0 */
/* UIO devices of Linux: see sptfra.h. With -DSPTFRA_NO_UIO, and elsewhere, there is nothing in it. */
#if defined(__linux__) && !defined(SPTFRA_NO_UIO)
#define _POSIX_C_SOURCE 200809L
#endif

#include "sptfra.h"

#if defined(__linux__) && !defined(SPTFRA_NO_UIO)
#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <time.h>
#include <unistd.h>

int sptfra_uio_open(sptfra_uio *uio, const char *path, size_t bytes)
{
    void *base;

    uio->file = open(path, O_RDWR | O_CLOEXEC);
    if (uio->file < 0) {
        return SPTFRA_SYSTEM;
    }
    base = mmap(NULL, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, uio->file, 0);
    if (base == MAP_FAILED) {
        const int why = errno;

        close(uio->file);
        errno = why;
        return SPTFRA_SYSTEM;
    }
    uio->bytes = bytes;
    uio->base = (uintptr_t)base;
    return SPTFRA_OK;
}

void sptfra_uio_close(sptfra_uio *uio)
{
    munmap((void *)uio->base, uio->bytes);
    close(uio->file);
    uio->file = -1;
}

static int64_t now(void)
{
    struct timespec time;

    clock_gettime(CLOCK_MONOTONIC, &time);
    return (int64_t)time.tv_sec * 1000 + time.tv_nsec / 1000000;
}

int sptfra_uio_wait(const sptfra_uio *uio, int milliseconds)
{
    const int64_t end = now() + milliseconds;
    struct pollfd waits = {.fd = uio->file, .events = POLLIN};
    uint32_t word = 1;
    ssize_t moved;
    int ready;

    /* A UIO driver masks the interrupt when it comes; writing 1 unmasks it. */
    do {
        moved = write(uio->file, &word, sizeof word);
    } while (moved < 0 && errno == EINTR);
    if (moved != (ssize_t)sizeof word) {
        return SPTFRA_SYSTEM;
    }
    do {
        const int64_t left = end - now();

        ready = poll(&waits, 1, milliseconds < 0 ? -1 : left < 0 ? 0 : (int)left);
    } while (ready < 0 && errno == EINTR);
    if (ready < 0) {
        return SPTFRA_SYSTEM;
    }
    if (ready == 0) {
        return SPTFRA_TIMEOUT;
    }
    do {
        moved = read(uio->file, &word, sizeof word);
    } while (moved < 0 && errno == EINTR);
    return moved == (ssize_t)sizeof word ? SPTFRA_OK : SPTFRA_SYSTEM;
}

#else
/* A file of C declares something. */
typedef int sptfra_no_uio;
#endif
