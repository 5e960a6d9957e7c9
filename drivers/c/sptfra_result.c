/* SPDX-License-Identifier: MIT OR Apache-2.0 */
/* Answers, status bits and errors in words: see sptfra.h. */
#include "sptfra_private.h"

#include <string.h>

const char *sptfra_error(int code)
{
    switch (code) {
    case SPTFRA_OK: return "no error";
    case SPTFRA_NOT_A_CORE: return "no core at this address: IDENTITY is not TFRA";
    case SPTFRA_OTHER_MAP: return "the core's register map is of another version: take the drivers of its release";
    case SPTFRA_NO_REGISTERS: return "the core was opened without registers";
    case SPTFRA_BAD_BUFFER: return "a buffer is too small or not on a multiple of a beat's bytes, or of a cache line";
    case SPTFRA_TIMEOUT: return "no answer in the polls given";
    case SPTFRA_DMA_FAULT: return "the DMA stopped with an error; its status register says which";
    case SPTFRA_CUT_SHORT: return "the answer is shorter than a frame's";
    case SPTFRA_SYSTEM: return "the operating system refused; errno says why";
    case SPTFRA_BUSY: return "a frame is on its way or has failed: wait for it, or recover";
    case SPTFRA_OUT_OF_STEP: return "the answer is that to another frame: recover";
    case SPTFRA_NOT_STARTED: return "no frame was started";
    case SPTFRA_NO_CALIBRATION: return "the design's calibration is in ROM: it needs calibration = \"ram\"";
    case SPTFRA_CALIBRATION_BUSY: return "a commit or a tare is under way: wait for it";
    case SPTFRA_OUT_OF_RANGE: return "a value, or an offset that the tare found, is out of bounds; nothing has changed";
    case SPTFRA_CONTRADICTION: return "the words of a bank do not go together; nothing has changed";
    case SPTFRA_BAD_FILE: return "the file is no calibration; nothing has changed";
    case SPTFRA_WRONG_CRC: return "the bank holds other words than were sent; nothing has changed";
    case SPTFRA_NOT_AT_REST: return "a taxel moved by more than the noise floor during the tare; nothing has changed";
    case SPTFRA_BAD_REST: return "a frame of the tare was clipped, no number, cut or lost; nothing has changed";
    case SPTFRA_DROPS: return "the core drops frames that come too fast (overrun = \"drop\"): send it one at a time";
    case SPTFRA_QUEUE_ONLY: return "the DMA goes by descriptors: use the queue (sptfra_queue.h)";
    case SPTFRA_NO_QUEUE: return "the DMA has no descriptors: make the block design with the word queue";
    case SPTFRA_BAD_SHAPE: return "words_out is not what taxels and field take";
    case SPTFRA_NO_SMOOTHING: return "the core averages no frames: its design needs smoothing";
    default: return "unknown code";
    }
}

const char *sptfra_status_name(unsigned bit)
{
    static const char *const names[] = {
        "no contact",
        "direction unknown",
        "optimum at the bound",
        "saturated",
        "NaN or infinity",
        "wrong frame length",
        "low confidence",
        "more than one contact",
        "dead taxel replaced",
        "too many replaced",
        "slip",
        "no tension",
        "frames dropped before",
    };

    return bit < sizeof names / sizeof names[0] ? names[bit] : NULL;
}

int sptfra_decode(const sptfra_shape *shape, const void *words, sptfra_result *result)
{
    const uint32_t *raw = words;
    const float *values = words;
    uint32_t counters;

    if ((uintptr_t)words % sizeof *raw != 0) {
        return SPTFRA_BAD_BUFFER;
    }
    counters = raw[SPTFRA_WORD_COUNTERS];

    result->status = (uint16_t)(raw[SPTFRA_WORD_STATUS] & 0xFFFFu);
    result->number = (uint16_t)FIELD(raw[SPTFRA_WORD_STATUS], LAST_STATUS__NUMBER);
    result->timestamp = raw[SPTFRA_WORD_TIMESTAMP];
    memcpy(result->force, values + SPTFRA_WORD_FORCE, sizeof result->force);
    memcpy(result->torque, values + SPTFRA_WORD_TORQUE, sizeof result->torque);
    memcpy(&result->friction, values + SPTFRA_WORD_FRICTION, sizeof result->friction);
    memcpy(&result->direction, values + SPTFRA_WORD_DIRECTION, sizeof result->direction);
    memcpy(result->friction_xy, values + SPTFRA_WORD_FRICTION_XY, sizeof result->friction_xy);
    memcpy(&result->standard_error, values + SPTFRA_WORD_STANDARD_ERROR, sizeof result->standard_error);
    result->contacts = (uint8_t)(counters & 0xFFu);
    result->version = (uint8_t)(counters >> 8 & 0xFFu);
    result->replaced = (uint8_t)(counters >> 16 & 0xFFu);
    result->field = shape->has_field ? values + SPTFRA_SUMMARY_WORDS : NULL;
    return SPTFRA_OK;
}

int sptfra_decode_and_separate(const sptfra_shape *shape, const void *words, const void *frame,
    const sptfra_separator *separator, sptfra_result *result)
{
    const int code = sptfra_decode(shape, words, result);

    if (code != SPTFRA_OK || !(result->status & SPTFRA_SEVERAL_CONTACTS)) {
        return code;
    }
    return frame == NULL ? SPTFRA_NOT_STARTED : separator->separate(separator->context, result, frame);
}
