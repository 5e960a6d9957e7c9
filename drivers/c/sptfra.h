/* SPDX-License-Identifier: MIT OR Apache-2.0 */
/* Driver of a generated core behind an AXI DMA, bare metal or Linux UIO: one frame on its way at a time, or many by
 * sptfra_queue.h. C11, no allocation.
 *
 *   sptfra core;
 *   sptfra_open(&core, &sptfra_memory_mapped, CORE_BASE, DMA_BASE);
 *   memcpy(stress.data, frame, sptfra_frame_bytes(&core.shape));
 *   sptfra_process(&core, &stress, &forces, SPTFRA_FOREVER);
 *   sptfra_decode(&core.shape, forces.data, &result);
 *
 * The caller owns the DMA buffers. Functions return SPTFRA_OK or one of the other codes, see sptfra_error(). */
#ifndef SPTFRA_H
#define SPTFRA_H

#include <stddef.h>
#include <stdint.h>

#include "sptfra_registers.h"

#ifdef __cplusplus
extern "C" {
#endif

enum {
    SPTFRA_OK = 0,
    SPTFRA_NOT_A_CORE = -1, /* IDENTITY has another value */
    SPTFRA_OTHER_MAP = -2,  /* the register map is of another version than this driver */
    SPTFRA_NO_REGISTERS = -3,
    SPTFRA_BAD_BUFFER = -4, /* too small, or not on a multiple of a beat's bytes, or of SPTFRA_LINE with a cache */
    SPTFRA_TIMEOUT = -5,    /* the frame is still on its way: wait again, or recover */
    SPTFRA_DMA_FAULT = -6,
    SPTFRA_CUT_SHORT = -7,   /* the packet of forces has another length than a frame's */
    SPTFRA_SYSTEM = -8,      /* errno says why */
    SPTFRA_BUSY = -9,        /* a frame is on its way, or the last one failed: wait, or recover */
    SPTFRA_OUT_OF_STEP = -10, /* the answer is that to another frame */
    SPTFRA_NOT_STARTED = -11,
    SPTFRA_NO_CALIBRATION = -12,   /* the design's calibration is in ROM */
    SPTFRA_CALIBRATION_BUSY = -13, /* a commit or a tare is under way */
    SPTFRA_OUT_OF_RANGE = -14,     /* a value, or an offset that a tare found: nothing has changed */
    SPTFRA_WRONG_CRC = -15,        /* the bank holds other words than were sent: nothing has changed */
    SPTFRA_NOT_AT_REST = -16,      /* a taxel spread by more than the noise floor: nothing has changed */
    SPTFRA_BAD_REST = -17,         /* a frame of the tare was clipped, no number, cut or lost: nothing has changed */
    SPTFRA_QUEUE_ONLY = -18,       /* the DMA goes by descriptors: sptfra_queue.h */
    SPTFRA_NO_QUEUE = -19,         /* the DMA has none */
    SPTFRA_DROPS = -20,            /* the core drops frames that come too fast: send it one at a time */
    SPTFRA_CONTRADICTION = -21,    /* the words of a bank do not go together: nothing has changed */
    SPTFRA_BAD_FILE = -22,         /* a file that is no calibration: nothing has changed */
    SPTFRA_BAD_SHAPE = -23,        /* words_out is not what taxels and field take */
    SPTFRA_NO_SMOOTHING = -24      /* the design averages no frames */
};

/* What went wrong, in words. */
const char *sptfra_error(int code);

/* ---- How registers and memory are reached */

/* Polls without an end. */
#define SPTFRA_FOREVER UINT32_MAX

typedef struct {
    void *context;
    uint32_t (*read)(void *context, uintptr_t address);
    void (*write)(void *context, uintptr_t address, uint32_t value);
    /* Data cache, where the DMA does not see it; NULL if it does or if buffers are uncached. Lines are whole ones. */
    void (*flush)(void *context, const void *start, size_t bytes);
    void (*invalidate)(void *context, void *start, size_t bytes);
    /* Orders accesses to buffers and to registers; NULL for the processor's own barrier. */
    void (*barrier)(void *context);
} sptfra_platform;

/* Where there are cache functions, buffers begin and end on multiples of so many bytes, so that no other data share a
 * line with them. */
#define SPTFRA_LINE 64u

/* Registers at their addresses, coherent memory. */
extern const sptfra_platform sptfra_memory_mapped;

/* ---- The core */

typedef struct {
    uint16_t columns, rows;
    uint16_t words_in, words_out; /* of a frame */
    uint8_t has_field;            /* three forces of each taxel follow the words of the summary */
    uint8_t has_counts;           /* frames hold counts, else pascals */
    uint8_t stream_bytes;         /* of a beat: 4, 8 or 16. Buffers begin on a multiple of it; 0 is as 4 */
    uint8_t samples;              /* what a value in a frame is: SPTFRA_FLOAT32, _INT16 or _UINT16 */
} sptfra_shape;

enum { SPTFRA_FLOAT32 = 0, SPTFRA_INT16 = 1, SPTFRA_UINT16 = 2 };

/* Bytes of a frame's values. words_in of them go to the core: what follows the last value should be zero. */
size_t sptfra_frame_bytes(const sptfra_shape *shape);

typedef struct {
    sptfra_platform platform;
    uintptr_t core; /* base of the registers; not used if has_registers is 0 */
    uintptr_t dma;
    int has_registers;
    int scatter_gather; /* the DMA goes by descriptors: frames go through a queue, sptfra_queue.h */
    sptfra_shape shape;
    int busy;             /* a frame was started whose answer has not come as it should */
    int knows_number;     /* whether next_number is known: not before the first answer of a core without registers */
    uint16_t next_number; /* which the core gives to the next frame */
} sptfra;

/* Looks for a core with registers at `core` and its DMA at `dma`, and resets and starts the DMA. */
int sptfra_open(sptfra *device, const sptfra_platform *platform, uintptr_t core, uintptr_t dma);
/* The same for a core without registers, whose shape the caller knows from metadata.json (words_out: bytes_out / 4). */
int sptfra_open_streams(sptfra *device, const sptfra_platform *platform, uintptr_t dma, const sptfra_shape *shape);

typedef struct {
    uint8_t map_version, major, minor, patch; /* of the generator */
    uint64_t design_hash;
    uint8_t lanes, reduced;
    uint8_t calibration_in_ram; /* sptfra_load_calibration, sptfra_tare */
    uint8_t curve_in_ram;       /* sptfra_load_bank_and_curve */
    uint8_t replaceable;        /* dead taxels that a bank has room for */
    uint8_t drops_frames;       /* those that find no room */
    uint8_t averages_frames;    /* sptfra_set_smoothing */
    uint32_t clock_khz, latency_cycles, interval_cycles; /* as predicted */
    float full_scale_pa;
} sptfra_identity;

int sptfra_identify(const sptfra *device, sptfra_identity *identity);

typedef struct {
    uint32_t frames_in, frames_out, frames_bad;
    uint32_t frames_dropped; /* that found no room: 0 without overrun = "drop" */
    uint32_t last_status, last_latency, last_interval;
} sptfra_counters;

int sptfra_count(const sptfra *device, sptfra_counters *counters);

/* Averages frames with the weight 2^-k from the next frame on; 0 averages nothing. k above 8: SPTFRA_OUT_OF_RANGE; a design
 * without smoothing: SPTFRA_NO_SMOOTHING, without registers: SPTFRA_NO_REGISTERS. */
int sptfra_set_smoothing(const sptfra *device, uint32_t k);

/* Resets the core without cutting a packet, see docs/reference/registers.md. Frames inside are lost; the packet going out still
 * needs a transfer that takes it. With a queue SPTFRA_QUEUE_ONLY: sptfra_queue_recover does it. */
int sptfra_soft_reset(sptfra *device, uint32_t polls);

/* Events of the registers INTERRUPT_ENABLE and INTERRUPT_STATUS. */
#define SPTFRA_FRAME_DONE SPTFRA__INTERRUPT_STATUS__FRAME_DONE_bm
#define SPTFRA_FRAME_ERROR SPTFRA__INTERRUPT_STATUS__FRAME_ERROR_bm
#define SPTFRA_BAD_ACCESS SPTFRA__INTERRUPT_STATUS__BAD_ACCESS_bm /* to an address without a register */

int sptfra_enable_interrupts(const sptfra *device, uint32_t events);
/* The events since they were acknowledged last; acknowledges them. */
int sptfra_take_interrupts(const sptfra *device, uint32_t *events);

/* ---- Frames */

/* Memory that the DMA reaches: where the processor sees it, and at which address the DMA does. */
typedef struct {
    void *data;
    uint64_t address;
    size_t bytes;
} sptfra_buffer;

/* Sends a frame of words_in words and takes words_out words. A word is a float32, or two counts of 16 bits, the first in
 * the lower half: in memory the values stand one behind the other. Returns at once; both buffers belong to the DMA until
 * sptfra_wait says otherwise. One frame is on its way at a time. */
int sptfra_start(sptfra *device, const sptfra_buffer *stress, const sptfra_buffer *forces);
/* The same for a packet of another length, of which the core makes an answer with the status BAD_LENGTH: at most as many
 * bytes as the DMA's length register counts, 16,383 unless a frame, in or out, has more. */
int sptfra_start_words(sptfra *device, const sptfra_buffer *stress, size_t words, const sptfra_buffer *forces);
/* Waits for the answer to sptfra_start, asking at most so many times, and checks that it is the answer to that frame.
 * After SPTFRA_TIMEOUT it can be called again; after any other error nothing starts before sptfra_recover. */
int sptfra_wait(sptfra *device, const sptfra_buffer *forces, uint32_t polls);
/* Both. */
int sptfra_process(sptfra *device, const sptfra_buffer *stress, const sptfra_buffer *forces, uint32_t polls);
/* After any error: resets the DMA and, where it has registers, the core, ends a packet that was cut on its way in, and
 * takes and drops whatever the core still sends. The core counts as empty when no answer has come in so many polls:
 * give more than a frame takes. Uses both buffers. */
int sptfra_recover(sptfra *device, const sptfra_buffer *stress, const sptfra_buffer *forces, uint32_t polls);
/* Stops a transfer and starts the DMA anew. What the core has inside stays there: see sptfra_recover. */
int sptfra_reset_dma(sptfra *device, uint32_t polls);

/* Status bits of a frame: those of the register LAST_STATUS. */
enum {
    SPTFRA_NO_CONTACT = SPTFRA__LAST_STATUS__NO_CONTACT_bm,
    SPTFRA_DIRECTION_UNKNOWN = SPTFRA__LAST_STATUS__DIRECTION_UNKNOWN_bm,
    SPTFRA_AT_BOUND = SPTFRA__LAST_STATUS__AT_BOUND_bm,
    SPTFRA_SATURATED = SPTFRA__LAST_STATUS__SATURATED_bm,
    SPTFRA_NOT_FINITE = SPTFRA__LAST_STATUS__NOT_FINITE_bm,
    SPTFRA_BAD_LENGTH = SPTFRA__LAST_STATUS__BAD_LENGTH_bm,
    SPTFRA_LOW_CONFIDENCE = SPTFRA__LAST_STATUS__LOW_CONFIDENCE_bm,
    SPTFRA_SEVERAL_CONTACTS = SPTFRA__LAST_STATUS__SEVERAL_CONTACTS_bm,
    SPTFRA_REPLACED = SPTFRA__LAST_STATUS__REPLACED_bm,
    SPTFRA_TOO_MANY_REPLACED = SPTFRA__LAST_STATUS__TOO_MANY_REPLACED_bm,
    SPTFRA_SLIP = SPTFRA__LAST_STATUS__SLIP_bm,
    SPTFRA_NO_TENSION = SPTFRA__LAST_STATUS__NO_TENSION_bm,
    SPTFRA_DROPPED = SPTFRA__LAST_STATUS__DROPPED_bm
};

/* Name of a status bit, 0 to 12; NULL for any other. */
const char *sptfra_status_name(unsigned bit);

/* Where the values stand in the words of an answer: "output" in metadata.json. */
enum {
    SPTFRA_WORD_STATUS = 0, /* and the frame's number above it */
    SPTFRA_WORD_TIMESTAMP = 1,
    SPTFRA_WORD_FORCE = 2,
    SPTFRA_WORD_TORQUE = 5,
    SPTFRA_WORD_FRICTION = 8,
    SPTFRA_WORD_DIRECTION = 9,
    SPTFRA_WORD_FRICTION_XY = 10,
    SPTFRA_WORD_STANDARD_ERROR = 12,
    SPTFRA_WORD_COUNTERS = 13,
    SPTFRA_SUMMARY_WORDS = 16
};

typedef struct {
    uint16_t status;      /* bits as above */
    uint16_t number;      /* of the frame since the core was reset, modulo 65536 */
    uint32_t timestamp;   /* of its first beat in, in cycles since the reset, modulo 2^32 */
    float force[3];       /* F_x, F_y, F_z in N */
    float torque[3];      /* T_x, T_y, T_z in N m about the middle of the grid */
    float friction;       /* mu */
    float direction;      /* phi in rad */
    float friction_xy[2];
    float standard_error; /* of (F_x, F_y) in N; 0 where the design has none */
    uint8_t contacts;     /* at most 1 in a design with count_contacts = false */
    uint8_t version;      /* of the calibration */
    uint8_t replaced;     /* taxels */
    /* f_x, f_y, f_z in N of taxel iy * columns + ix, taxel after taxel, in the buffer; NULL without a field. */
    const float *field;
} sptfra_result;

/* Reads the words of an answer, float32 as the processor has it. SPTFRA_BAD_BUFFER if they do not stand on a multiple
 * of four bytes. */
int sptfra_decode(const sptfra_shape *shape, const void *words, sptfra_result *result);

/* What separates the contacts of a frame that the core marks by SPTFRA_SEVERAL_CONTACTS: on Linux the library of
 * drivers/solver, on bare metal a function of the program. `frame` is what was sent, words_in words; `result` has the
 * frame's number and the version of the calibration that it was computed by. Returns SPTFRA_OK or any other
 * code. */
typedef struct {
    void *context;
    int (*separate)(void *context, const sptfra_result *result, const void *frame);
} sptfra_separator;

/* As sptfra_decode, and hands a marked frame to the separator. `frame` is the one that the words answer: the buffer of
 * sptfra_start, or sptfra_queue_frame. Returns the separator's code. */
int sptfra_decode_and_separate(const sptfra_shape *shape, const void *words, const void *frame,
    const sptfra_separator *separator, sptfra_result *result);

/* ---- Calibration in RAM (calibration = "ram" in the design), in sptfra_calibration.c and sptfra_bank.c; from files by
 * sptfra_file.h */

/* Gain and offset (in counts) of each taxel, as in a design's calibration.csv: gains 1e-9 to 16, offsets to 1e6. A gain of
 * 0 reads 0: for taxels that the design or the map replaces, SPTFRA_OUT_OF_RANGE for others of a core with a map. With a
 * noise floor above 0, in Pa, it is that of the frames and of a tare, and the threshold of contact is as many times it as
 * there are taxels, as of a design made with it; else both stay. Writes the bank that is not active, has its CRC compared
 * and makes it active from the next frame on; frames may run. On any error the active bank stays. */
int sptfra_load_calibration(
    const sptfra *device, const double *gain, const double *offset, double noise_floor_pa, uint32_t polls);
/* Dead taxels, ascending, and the weights of all taxels in the stress of each, one after the other: the columns of a
 * file of `sptfra export-calibration`. */
typedef struct {
    uint32_t count;
    const uint16_t *taxels; /* count of them */
    const double *weights;  /* count times as many as there are taxels; 0 of dead ones */
} sptfra_replaced;
/* The same, and from then on these taxels are replaced, with a count of 0 none; SPTFRA_OUT_OF_RANGE if there are more
 * than a bank has room for. Without this, or with NULL, those are that were before. */
int sptfra_load_bank(const sptfra *device, const double *gain, const double *offset, const sptfra_replaced *replaced,
    double noise_floor_pa, uint32_t polls);
/* Points of a curve from counts to pascals: counts ascend, pascals only rise or only fall. */
typedef struct {
    uint32_t count;
    const double *counts;
    const double *pascals;
} sptfra_curve;
/* The same with another curve, of a core that has one in its banks ([sensor] curve): then offsets are in pascals.
 * SPTFRA_OUT_OF_RANGE for one that no bank takes, and of cores without one. With NULL the curve is that which was. */
int sptfra_load_bank_and_curve(const sptfra *device, const double *gain, const double *offset,
    const sptfra_replaced *replaced, const sptfra_curve *curve, double noise_floor_pa, uint32_t polls);
/* A word of the active bank, or of the other one. */
int sptfra_read_calibration(const sptfra *device, uint16_t index, int acting, uint32_t *word);
#define SPTFRA_MOST_TARE_LOG2 10u
/* Begins to average the next 2^log2_frames frames, which are to be unloaded; sptfra_calibration_wait says what came of
 * it, once they were sent. */
int sptfra_tare(const sptfra *device, unsigned log2_frames);
/* Waits for the end of a commit or a tare, asking at most so many times; SPTFRA_TIMEOUT: it is still under way. */
int sptfra_calibration_wait(const sptfra *device, uint32_t polls);

/* ---- Linux user space: a UIO device for each block of registers */

#if defined(__linux__) && !defined(SPTFRA_NO_UIO)
typedef struct {
    int file;
    size_t bytes;
    uintptr_t base; /* for sptfra_open, with sptfra_memory_mapped */
} sptfra_uio;

int sptfra_uio_open(sptfra_uio *uio, const char *path, size_t bytes);
void sptfra_uio_close(sptfra_uio *uio);
/* Unmasks the device's interrupt and sleeps until it comes, at most so many milliseconds (-1: for ever). Signals in
 * between are no reason to return. */
int sptfra_uio_wait(const sptfra_uio *uio, int milliseconds);
#endif

#ifdef __cplusplus
}
#endif

#endif
