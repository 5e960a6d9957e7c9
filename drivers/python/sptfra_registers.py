# SPDX-License-Identifier: MIT OR Apache-2.0
"""The register bank of a core, as control/NAME.rdl has it."""

import enum

MAGIC = 0x54465241
MAP_VERSION = 3
#: CONTROL, STATUS and CALIBRATION_STATUS.
SOFT_RESET = 1
RESETTING = 1
CALIBRATION_BUSY = 1 << 9
#: `CALIBRATION_INDEX`: of the active bank.
INDEX_ACTIVE = 1 << 31


class Register(enum.IntEnum):
    """Offsets of the registers, as in control/NAME.rdl."""

    IDENTITY = 0x000
    VERSION = 0x004
    HASH_LOW = 0x008
    HASH_HIGH = 0x00C
    GEOMETRY = 0x010
    FRAME = 0x014
    FEATURES = 0x018
    CLOCK = 0x01C
    FULL_SCALE = 0x020
    PREDICTED_LATENCY = 0x024
    PREDICTED_INTERVAL = 0x028
    CONTROL = 0x040
    STATUS = 0x044
    INTERRUPT_ENABLE = 0x048
    INTERRUPT_STATUS = 0x04C
    FRAMES_IN = 0x050
    FRAMES_OUT = 0x054
    FRAMES_BAD = 0x058
    LAST_STATUS = 0x05C
    LAST_LATENCY = 0x060
    LAST_INTERVAL = 0x064
    FRAMES_DROPPED = 0x068
    SMOOTHING = 0x06C
    CALIBRATION = 0x080
    CALIBRATION_OFFSET_LIMIT = 0x084
    CALIBRATION_STEPS_LOW = 0x088
    CALIBRATION_STEPS_HIGH = 0x08C
    CALIBRATION_INDEX = 0x090
    CALIBRATION_DATA = 0x094
    CALIBRATION_COMMIT = 0x098
    TARE = 0x09C
    CALIBRATION_STATUS = 0x0A0
    CALIBRATION_ERRORS = 0x0A4
    CALIBRATION_CRC = 0x0A8
    CALIBRATION_CURVE = 0x0AC


class Event(enum.IntFlag):
    """Events that can interrupt."""

    FRAME_DONE = 1
    FRAME_ERROR = 2
    BAD_ACCESS = 4


class CalibrationError(enum.IntFlag):
    """Why a calibration was refused; nothing has changed."""

    OUT_OF_RANGE = 1
    BUSY = 2
    WRONG_CRC = 4
    NOT_AT_REST = 8
    BAD_FRAME = 16
    CONTRADICTION = 32
