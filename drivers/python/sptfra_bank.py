# SPDX-License-Identifier: MIT OR Apache-2.0
"""A calibration as the words of a bank in a core's RAM."""

import pathlib
import re

import numpy as np

#: A gain's word: mantissa, and above it the exponent of the counts.
MANTISSA_BITS, EXPONENT_BITS = 18, 10
#: What the weights of a dead taxel add up to at most, in their steps.
MOST_WEIGHTS = (1 << 21) - 1
#: Of a curve: numbers, values, slopes' shifts; words of a segment, and behind all of them.
MOST_NUMBER, MOST_VALUE, MOST_CURVE_SHIFT = (1 << 25) - 1, (1 << 26) - 1 - (1 << 12), 40
SEGMENT_WORDS, END_WORDS = 4, 3


def _rows(path):
    """The lines of a file that are neither blank nor a remark: number, text, fields, and their numbers or None."""
    separator, rows = None, []
    for number, line in enumerate(pathlib.Path(path).read_text(encoding="utf-8-sig").splitlines(), 1):
        line = line.strip()
        if not line or line.startswith("#"):
            continue
        if separator is None:
            separator = next((each for each in ";\t," if each in line), " ")
        fields = [field.strip() for field in (line.split() if separator == " " else line.split(separator))]
        if len(fields) > 1 and not fields[-1]:
            fields.pop()
        fields = [field[1:-1] if len(field) > 1 and field[0] == field[-1] == '"' else field for field in fields]
        # Where it separates nothing, a comma is a decimal point.
        numbers = [_number(field.replace(",", ".") if separator in ";\t" else field) for field in fields]
        rows.append((number, line, fields, numbers))
    return rows


def _number(field):
    try:
        value = float(field) if set(field) <= set("0123456789+-.eE") else None
    except ValueError:
        return None
    return None if value is None or abs(value) > 3.4028234663852886e38 else value


def _names(row):
    """The names of a header, in small letters and without units; nothing of a line with a number."""
    _, _, fields, numbers = row
    return [re.split(r"[(\[]", field)[0].strip().lower() for field in fields] if set(numbers) == {None} else []


def _points(path, rows):
    points = []
    for number, line, _, numbers in rows:
        if len(numbers) != 2 or None in numbers:
            raise ValueError(f"{path}, line {number}: {line!r} is no count,pascals such as 120,-950.5")
        points.append(tuple(numbers))
    return points


def read_curve(path):
    """The points (count, pascals) of a file with a line for each, or of those behind the taxels of one of `sptfra export-calibration`.

    Raises ValueError, with the line.
    """
    rows = _rows(path)
    names = _names(rows[0]) if rows else []
    if names[:1] == ["gain"]:
        while rows and _names(rows[0]) != ["count", "pascals"]:
            rows.pop(0)
        if not rows:
            raise ValueError(f"{path}: gains and offsets, and no curve")
    if names == ["pascals", "count"]:
        raise ValueError(f"{path}, line {rows[0][0]}: the pascals stand before the counts")
    return _points(path, rows[1:] if names else rows)


def read_calibration(path, taxels):
    """Gains and offsets of a file with a line `gain,offset` for each taxel, and what it says of dead taxels and a curve.

    A file of `sptfra export-calibration` has a header, `gain,offset,taxel 37,...`, and in each line the taxel's weight in the stress of
    each dead one: `{37: [weights], ...}`, of files without a header None. Behind a header `count,pascals` stand the points
    of a curve, else it is None. Values are separated as those of frames. Raises ValueError, with the line.
    """
    rows = _rows(path)
    behind = next((place for place, row in enumerate(rows) if _names(row) == ["count", "pascals"]), len(rows))
    points = _points(path, rows[behind + 1 :]) if behind < len(rows) else None
    gains, offsets, dead = [], [], None
    for place, (number, line, fields, numbers) in enumerate(rows[:behind]):
        names = _names(rows[place]) if place == 0 else []
        if names:
            named = [name.split() for name in names[2:]]
            if names[:2] != ["gain", "offset"] or any(
                len(name) != 2 or name[0] != "taxel" or not name[1].isdecimal() for name in named
            ):
                raise ValueError(f"{path}, line {number}: a header is gain,offset,taxel 37,... as sptfra export-calibration writes it")
            dead = {int(name[1]): [] for name in named}
            if list(dead) != sorted(dead) or len(dead) != len(named) or any(taxel >= taxels for taxel in dead):
                raise ValueError(f"{path}, line {number}: dead taxels ascend, and the core has {taxels} taxels")
            continue
        if len(numbers) != 2 + len(dead or {}) or None in numbers:
            like = "gain,offset such as 1.02,-0.5" + " and a weight for each dead taxel" * bool(dead)
            raise ValueError(f"{path}, line {number}: {line!r} is no {like}")
        gain, offset, *weights = numbers
        for of_taxel, weight in zip((dead or {}).values(), weights):
            of_taxel.append(weight)
        if not (gain == 0 or 1e-9 <= gain <= 16) or not abs(offset) <= 1e6:
            raise ValueError(f"{path}, line {number}: use a gain from 1e-9 to 16 or 0, an offset from -1e6 to 1e6")
        gains.append(gain)
        offsets.append(offset)
    if len(gains) != taxels:
        raise ValueError(f"{path}: {len(gains)} lines, and the core has {taxels} taxels")
    return gains, offsets, dead, points


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


def map_words(dead, room, taxels):
    """The words of dead taxels, `{taxel: weights of all taxels}`, in a bank with room for so many, as uint32.

    Raises ValueError where there are more, or where weights are none that a bank takes.
    """
    if len(dead) > room:
        raise ValueError(f"{len(dead)} dead taxels, and the core has room for {room}: [sensor] dead, room")
    if room == 0:
        return np.zeros(0, dtype=np.uint32)
    weights = np.zeros((taxels, room))
    for place, of_taxel in enumerate(dead.values()):
        weights[:, place] = of_taxel
    if not np.all(np.isfinite(weights)) or np.any(weights[list(dead)]):
        raise ValueError("a dead taxel has no weight, and others have a number")
    for shift in reversed(range(MANTISSA_BITS)):
        # Ties go away from zero.
        steps = np.copysign(np.floor(np.abs(weights) * 2.0**shift + 0.5), weights)
        if np.max(np.abs(steps)) < 1 << (MANTISSA_BITS - 1) and np.max(np.sum(np.abs(steps), axis=0)) <= MOST_WEIGHTS:
            break
    else:
        raise ValueError("weights of dead taxels so large that no bank takes them")
    numbers = np.zeros(room, dtype=np.uint32)
    numbers[: len(dead)] = list(dead)
    head = np.array([len(dead) | shift << 8], dtype=np.uint32)
    return np.concatenate([head, numbers, steps.astype(np.int64).astype(np.uint32).ravel()])


def _away(value):
    """To the nearest; ties go away from zero."""
    return int(np.copysign(np.floor(abs(value) + 0.5), value))


def curve_length(room):
    """Words of a curve in a bank with room for so many parts."""
    return SEGMENT_WORDS * room + END_WORDS


def curve_words(points, room, exponent, lsb):
    """The words of a curve of (count, pascals), in a bank with room for so many parts, as uint32.

    Raises ValueError where no bank takes it: counts ascend, pascals only rise or only fall.
    """
    if not 2 <= len(points) <= room + 1 or not np.all(np.isfinite(points)):
        raise ValueError(f"a curve of {len(points)} points: use 2 to {room + 1}")
    counts, pascals = np.array(points).T
    numbers = [_away(count * 2.0**exponent) for count in counts]
    values = [_away(pascal * 2.0**-lsb) for pascal in pascals]
    if max(map(abs, numbers)) > MOST_NUMBER or max(map(abs, values)) > MOST_VALUE:
        most = MOST_NUMBER * 2.0**-exponent, MOST_VALUE * 2.0**lsb
        raise ValueError(f"a curve beyond {most[0]:.0f} counts or {most[1]:.0f} Pa, for which a bank has room")
    ways = np.diff(pascals)
    if np.any(np.diff(numbers) <= 0) or not (np.all(ways > 0) or np.all(ways < 0)):
        raise ValueError("the points of a curve ascend by counts, and pascals only rise or only fall")
    words = np.zeros(SEGMENT_WORDS * room + END_WORDS, dtype=np.int64)
    words[SEGMENT_WORDS - 1 : SEGMENT_WORDS * room : SEGMENT_WORDS] = 1
    for place, (number, value) in enumerate(zip(numbers[:-1], values[:-1])):
        rise = (values[place + 1] - value) / (numbers[place + 1] - number)
        mantissa, dropped = 0, MANTISSA_BITS - 2
        if rise != 0:
            dropped = MANTISSA_BITS - 1 - int(np.frexp(rise)[1])
            while _away(abs(rise) * 2.0**dropped) >= 1 << (MANTISSA_BITS - 1):
                dropped -= 1
            mantissa = _away(rise * 2.0**dropped)
        if dropped < 1:
            raise ValueError(f"between the counts {counts[place]} and {counts[place + 1]} a curve rises too steeply")
        # A slope of next to nothing has fewer bits.
        less = min(max(dropped - MOST_CURVE_SHIFT, 0), 60)
        mantissa = mantissa if less == 0 else (mantissa + (1 << (less - 1))) >> less
        words[SEGMENT_WORDS * place :][:SEGMENT_WORDS] = number, value, mantissa, min(dropped, MOST_CURVE_SHIFT)
    words[-END_WORDS:] = len(points) - 1, numbers[-1], values[-1]
    return words.astype(np.uint32)
