# SPDX-License-Identifier: MIT OR Apache-2.0
"""A calibration as the words of a bank in a core's RAM."""

import pathlib

import numpy as np

#: A gain's word: mantissa, and above it the exponent of the counts.
MANTISSA_BITS, EXPONENT_BITS = 18, 10


def read_calibration(path, taxels):
    """Gains and offsets of a file with a line `gain,offset` for each taxel. Raises ValueError, with the line."""
    gains, offsets = [], []
    for number, line in enumerate(pathlib.Path(path).read_text(encoding="utf-8-sig").splitlines(), 1):
        if not line.strip():
            continue
        try:
            gain, offset = map(float, line.split(","))
        except ValueError:
            raise ValueError(f"{path}, line {number}: {line.strip()!r} is no gain,offset such as 1.02,-0.5") from None
        if not (gain == 0 or 1e-9 <= gain <= 16) or not abs(offset) <= 1e6:
            raise ValueError(f"{path}, line {number}: use a gain from 1e-9 to 16 or 0, an offset from -1e6 to 1e6")
        gains.append(gain)
        offsets.append(offset)
    if len(gains) != taxels:
        raise ValueError(f"{path}: {len(gains)} lines, and the core has {taxels} taxels")
    return gains, offsets


def bank_words(gains, offsets, count_steps, shift, offset_limit):
    """The words of gains, then of offsets (in counts), as uint32; `count_steps` are steps of the stress for a count.

    A gain of 0 reads 0: for taxels that the design replaces. Raises ValueError on an offset beyond the limit.
    """
    words = np.zeros(2 * len(gains), dtype=np.uint32)
    for taxel, (gain, offset) in enumerate(zip(gains, offsets)):
        mantissa, exponent, scaled = 1 << (MANTISSA_BITS - 2), -(1 << (EXPONENT_BITS - 1)), 0
        if gain != 0:
            # Ties go away from zero.
            away = lambda value: int(np.copysign(np.floor(abs(value) + 0.5), value))  # noqa: E731
            steps = gain * count_steps
            exponent = int(np.frexp(steps)[1]) + 1 - MANTISSA_BITS
            while away(abs(steps) * 2.0**-exponent) >= 1 << (MANTISSA_BITS - 1):
                exponent += 1
            mantissa = away(steps * 2.0**-exponent)
            # By the gain as it is stored, so that the count of no stress at all gives none.
            scaled = away(offset / gain * mantissa * 2.0**exponent)
            exponent += shift
            if abs(scaled) > offset_limit:
                raise ValueError(f"taxel {taxel}: an offset of {offset} counts is beyond what a bank takes")
        words[taxel] = (exponent & ((1 << EXPONENT_BITS) - 1)) << MANTISSA_BITS | mantissa & ((1 << MANTISSA_BITS) - 1)
        words[len(gains) + taxel] = scaled & 0xFFFFFFFF
    return words
