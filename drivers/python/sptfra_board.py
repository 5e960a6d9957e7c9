# SPDX-License-Identifier: MIT OR Apache-2.0
"""Driver of a generated core in PYNQ's style: numpy arrays in, numpy arrays out.

    from pynq import Overlay, allocate
    from sptfra_board import Sptfra

    overlay = Overlay("system.bit")
    sensor = Sptfra(overlay.core, overlay.dma, allocate)
    forces = sensor.reconstruct(frames)          # frames: (n, rows, columns) or (rows, columns), pascals or counts
    forces.resultant, forces.field, forces.status
    forces.contacts                              # how many; the forces are those of all together
    for indices, found in separate(forces, frames, sptfra.Solver(design)):      # of each, by software
        found.records["F_z"]                     # (len(indices), contacts)

`core` is the IP with the register bank (`control = true` in the design): anything with `read(offset)` and
`write(offset, value)`. A core without one is `None`, and the design's metadata.json says what it is:

    sensor = Sptfra(None, overlay.dma, allocate, metadata="metadata.json")

`dma` is an AXI DMA as PYNQ presents it. With descriptors (the block design's word `queue`) frames go in batches:

    sensor = Sptfra(overlay.core, overlay.dma, allocate, queue=64)      # 64 on their way while 64 are written and read

Beside this file belong the other `sptfra_*.py`, but for `sptfra_desk.py`.
"""

import time
import zlib

import numpy as np
from sptfra_bank import bank_words, curve_length, curve_words, map_words, read_calibration, read_curve
from sptfra_dma import Batches, OneByOne
from sptfra_forces import LAYOUT, Forces, Layout, Status, decode, separate
from sptfra_identity import Counters, Identity
from sptfra_registers import (
    CALIBRATION_BUSY,
    INDEX_ACTIVE,
    RESETTING,
    SOFT_RESET,
    CalibrationError,
    Event,
    Register,
)

__all__ = ["LAYOUT", "CalibrationError", "Counters", "Event", "Forces", "Identity", "Layout", "Register", "Sptfra", "Status", "separate"]

MOST_TARE_LOG2 = 10


class NoRegisters:
    """In place of the registers of a core that has none."""

    def read(self, offset):
        raise RuntimeError("the core has no registers: its design needs control = true")

    def write(self, offset, value):
        self.read(offset)


class Sptfra:
    """A core between the two channels of an AXI DMA."""

    def __init__(self, core, dma, allocate, metadata=None, queue=0):
        """`allocate` is `pynq.allocate`, `metadata` the path of the design's metadata.json: the answers' layout is read
        from there, and all else of a core without registers, `core` None. `queue` is the number of frames of a batch, for
        a DMA with descriptors; 0: one frame at a time, for one without. Raises RuntimeError if there is no core that
        this driver knows, or no such DMA, ValueError if neither registers nor metadata say what the core is."""
        if core is None and metadata is None:
            raise ValueError("without registers the design's metadata.json says what the core is: give its path")
        self._has_registers = core is not None
        self._core = NoRegisters() if core is None else core
        self.identity = Identity.load(metadata) if core is None else Identity.read(core)
        if metadata is not None and core is not None:
            told = Identity.load(metadata).design_hash
            if told != self.identity.design_hash:
                raise RuntimeError(f"{metadata} is of the design {told}, the core is {self.identity.design_hash}")
        self._layout = LAYOUT if metadata is None else Layout.load(metadata)
        if queue:
            self._transfers = Batches(dma, allocate, self.identity, queue)
        else:
            self._transfers = OneByOne(dma, allocate, self.identity)
        self._failed = False
        self._follow_number()

    def _follow_number(self):
        """The core numbers frames as they come in; without registers the first answer says where it is."""
        self._next = self._core.read(Register.FRAMES_IN) & 0xFFFF if self._has_registers else None

    def counters(self):
        """Frames, errors, and the cycles of the last frame."""
        return Counters.read(self._core)

    def soft_reset(self, timeout=1.0):
        """Resets the core without cutting a packet. Raises TimeoutError, in seconds, if nothing takes the last one."""
        self._core.write(Register.CONTROL, SOFT_RESET)
        self._reset_over(timeout)
        self._follow_number()

    def _reset_over(self, timeout):
        end = time.monotonic() + timeout
        while self._core.read(Register.STATUS) & RESETTING:
            if time.monotonic() > end:
                raise TimeoutError("the packet going out is not taken: recover()")

    def recover(self, timeout=0.1):
        """After an exception: resets DMA and core, ends a packet that was cut, and drops what the core still sends.

        Without an answer for `timeout` seconds the core counts as empty: give more than a frame takes. A core without
        registers is not reset, and goes on numbering.
        """
        if self._has_registers:
            self._transfers.recover(lambda: self._core.write(Register.CONTROL, SOFT_RESET), timeout)
            self._reset_over(timeout)
        else:
            self._transfers.recover(lambda: None, timeout)
        self._follow_number()
        self._failed = False

    def set_smoothing(self, k):
        """Averages frames with the weight 2**-k from the next frame on; 0 averages nothing. Raises RuntimeError where the
        core has no register for it."""
        if not self.identity.averages_frames:
            raise RuntimeError("the core has no register SMOOTHING: its design needs smoothing and control = true")
        if not 0 <= k <= 8:
            raise ValueError(f"k is {k}: 0 to 8")
        self._core.write(Register.SMOOTHING, k)

    def enable_interrupts(self, events):
        """Lets these events, a combination of `Event`, raise the core's interrupt; none of the others."""
        self._core.write(Register.INTERRUPT_ENABLE, int(events))

    def take_interrupts(self):
        """The events since they were taken last, enabled or not."""
        events = self._core.read(Register.INTERRUPT_STATUS)
        self._core.write(Register.INTERRUPT_STATUS, events)
        return Event(events)

    def reconstruct(self, frames, timeout=1.0):
        """Forces of frames (n, rows, columns), (n, taxels), (rows, columns) or (taxels,), in pascals or counts.

        Returns `Forces` of n frames, in new arrays; a single frame is n = 1. Raises ValueError on another shape, and on
        counts that the core's samples cannot be, TimeoutError if frames take longer than so many seconds each,
        RuntimeError if the DMA stops or an answer is that to another frame; after the last three no frame of this call
        has an answer, and nothing is sent before `recover`.
        """
        return self._process(self._samples_of(frames), timeout)

    def _samples_of(self, frames):
        """Frames as the core takes them, (n, taxels). Raises as `reconstruct` does, before anything is sent."""
        rows, columns, samples = self.identity.rows, self.identity.columns, self.identity.samples
        taxels = rows * columns
        values = np.asarray(frames)
        if values.shape[-2:] != (rows, columns) and values.shape[-1:] != (taxels,) or values.ndim > 3:
            raise ValueError(f"frames of shape {values.shape}: the core has {rows} rows of {columns} taxels")
        frames = values.astype(samples)
        if samples != np.float32 and not np.array_equal(frames, values):
            raise ValueError(f"the core takes counts as {samples}: whole numbers within its range")
        if self._failed:
            raise RuntimeError("the last frame has failed: recover()")
        return frames.reshape(-1, taxels)

    def _process(self, frames, timeout):
        self._failed = True
        answers = self._transfers.exchange(frames, self._in_step, timeout)
        self._failed = False
        return decode(answers, self.identity.rows, self.identity.columns, self.identity.has_field, self._layout)

    def _in_step(self, answers):
        """Checks the numbers of answers, (n, words_out), which follow each other."""
        numbers = self._layout.get(answers, "frame").astype(np.int64)
        first = int(numbers[0]) if self._next is None else self._next
        wrong = np.flatnonzero(numbers != (first + np.arange(len(numbers))) & 0xFFFF)
        if len(wrong):
            wanted = (first + int(wrong[0])) & 0xFFFF
            raise RuntimeError(f"the answer is that to frame {numbers[wrong[0]]}, not {wanted}: recover()")
        self._next = (first + len(numbers)) & 0xFFFF

    def load_calibration(self, path, noise_floor_pa=None, timeout=1.0, *, curve=None):
        """Lets the gains and offsets of a `calibration.csv` act from the next frame on; frames may run meanwhile.

        The file has a line `gain,offset` for each taxel, as the design's own, or is one of `sptfra export-calibration`: then the dead
        taxels of its header are replaced, and no others, by a header `gain,offset` alone none, even of those that the
        design's `dead` names; without a header those that were. So with the points of a curve, whose
        offsets are in pascals: they stand in the same file, or in that of the design's curve, `curve`. `noise_floor_pa` is
        then that of the frames and of a tare, and the threshold of contact as many times it as there are taxels, as of a
        design made with it; without it both stay. What is written is compared by its CRC. Raises ValueError on a file or
        values that no bank takes, RuntimeError if the core refuses, TimeoutError; then the active bank stays.
        """
        self._needs_calibration()
        # What is kept of the active bank is read from it, and reads 0 while it changes.
        self._calibration_idle()
        gains, offsets, dead, points = read_calibration(path, self.identity.rows * self.identity.columns)
        if curve is not None:
            own = read_curve(curve)
            if points not in (None, own):
                raise ValueError(f"{curve}: the curve is another than that of {path}, and offsets are made for it")
            points = own
        room = self.identity.replaceable
        in_map = [] if dead is None else map_words(dead, room, len(gains))
        read, write = self._core.read, self._core.write
        numbers = read(Register.CALIBRATION)
        shift, lsb = numbers >> 16 & 0x3F, (numbers >> 24 ^ 0x80) - 0x80
        bits = read(Register.CALIBRATION_STEPS_HIGH) << 32 | read(Register.CALIBRATION_STEPS_LOW)
        steps = float(np.array([bits], dtype=np.uint64).view(np.float64)[0])
        words = bank_words(gains, offsets, steps, shift, read(Register.CALIBRATION_OFFSET_LIMIT))
        if noise_floor_pa is None:
            thresholds = [self.read_calibration(len(words) + place) for place in (0, 1)]
        else:
            thresholds = [max(1, int(noise_floor_pa * count * 2.0**-lsb + 0.5)) for count in (len(gains), 1)]
            if not 0 < noise_floor_pa or thresholds[0] >= 1 << 32 or thresholds[1] >= 1 << 26:
                raise ValueError(f"a noise floor of {noise_floor_pa} Pa: use one above 0, far below the full scale")
        if dead is None and room:
            first = len(words) + 2
            in_map = [self.read_calibration(first + place) for place in range(1 + room * (1 + len(gains)))]
        if room:
            replaced = {int(taxel) for taxel in in_map[1 : 1 + (int(in_map[0]) & 15)]}
            bare = [taxel for taxel, gain in enumerate(gains) if gain == 0 and taxel not in replaced]
            if bare:
                raise ValueError(f"{path}: nothing replaces the taxels {bare} of gain 0: write it with sptfra export-calibration")
        in_curve = self._curve_words(points, len(words) + 2 + len(in_map))
        words = np.concatenate([words, np.array([*thresholds, *in_map, *in_curve], dtype=np.uint32)]).astype("<u4")
        crc = zlib.crc32(words.tobytes())
        write(Register.CALIBRATION_INDEX, 0)
        for word in words:
            write(Register.CALIBRATION_DATA, int(word))
        write(Register.CALIBRATION_COMMIT, crc)
        self._calibration_done(timeout)
        if read(Register.CALIBRATION_CRC) != crc:
            raise RuntimeError("the active bank is not the one that was written")

    def _curve_words(self, points, first):
        """The words of a curve, which begin with this one: of its points, else of the active curve."""
        if not self.identity.curve_in_ram:
            if points is not None:
                raise ValueError("the file has a curve, and the core none in its banks: [sensor] curve")
            return []
        word = self._core.read(Register.CALIBRATION_CURVE)
        room, exponent, lsb = word & 0xFF, (word >> 8 & 0xFF ^ 0x80) - 0x80, (word >> 16 & 0xFF ^ 0x80) - 0x80
        if points is None:
            return [self.read_calibration(first + place) for place in range(curve_length(room))]
        return curve_words(points, room, exponent, lsb)

    def read_calibration(self, index, acting=True):
        """A word of the active bank, or of the other one: gains, offsets, contact threshold, noise floor, then the map of
        dead taxels and the curve. Raises RuntimeError while a commit or a tare is under way."""
        self._needs_calibration()
        self._refuse_while_busy()
        self._core.write(Register.CALIBRATION_INDEX, index | (INDEX_ACTIVE if acting else 0))
        return self._core.read(Register.CALIBRATION_DATA)

    def tare(self, frames, timeout=1.0):
        """Takes the mean of 2**n unloaded frames, n up to 10, off the offsets; returns their `Forces`, from before.

        Raises ValueError on another number of frames or another shape, before the core knows of a tare, RuntimeError if
        they are not unloaded, a taxel's stress spreading by more than the noise floor, clipped or no numbers: then nothing
        has changed.
        """
        self._needs_calibration()
        samples = self._samples_of(frames)
        count = len(samples)
        log2 = count.bit_length() - 1
        if count != 1 << max(log2, 0) or log2 > MOST_TARE_LOG2:
            raise ValueError(f"{count} frames: a tare takes 1, 2, 4, ... or 1024")
        self._calibration_idle()
        self._core.write(Register.TARE, log2)
        forces = self._process(samples, timeout)
        self._calibration_done(timeout)
        return forces

    def _needs_calibration(self):
        if not self.identity.calibration_in_ram:
            raise RuntimeError('the design\'s calibration is in ROM: it needs calibration = "ram"')

    def _refuse_while_busy(self):
        if self._core.read(Register.CALIBRATION_STATUS) & CALIBRATION_BUSY:
            raise RuntimeError("a commit or a tare is under way")

    def _calibration_idle(self):
        self._refuse_while_busy()
        self._core.write(Register.CALIBRATION_ERRORS, (1 << len(CalibrationError)) - 1)

    def _calibration_done(self, timeout):
        end = time.monotonic() + timeout
        while self._core.read(Register.CALIBRATION_STATUS) & CALIBRATION_BUSY:
            if time.monotonic() > end:
                raise TimeoutError(f"the calibration is busy after {timeout} s")
        errors = CalibrationError(self._core.read(Register.CALIBRATION_ERRORS))
        self._core.write(Register.CALIBRATION_ERRORS, int(errors))
        if errors:
            names = ", ".join(bit.name for bit in CalibrationError if bit & errors)
            raise RuntimeError(f"the core refuses the calibration, and nothing has changed: {names}")
