# SPDX-License-Identifier: MIT OR Apache-2.0
"""Driver of a generated core in PYNQ's style: numpy arrays in, numpy arrays out.

    from pynq import Overlay, allocate
    from sptfra_board import Sptfra

    overlay = Overlay("system.bit")
    sensor = Sptfra(overlay.core, overlay.dma, allocate)
    forces = sensor.reconstruct(frames)          # frames: (n, rows, columns) or (rows, columns), pascals or counts
    forces.resultant, forces.field, forces.status

`core` is the IP with the register bank (`control = true` in the design): anything with `read(offset)` and
`write(offset, value)`. `dma` is an AXI DMA without descriptors as PYNQ presents it. Beside this file belong `sptfra_registers.py`,
`sptfra_forces.py` (answers) and `sptfra_bank.py` (calibration in RAM).
"""

import time
import zlib
from dataclasses import dataclass

import numpy as np
from sptfra_bank import bank_words, map_words, read_calibration
from sptfra_forces import LAYOUT, Forces, Layout, Status, decode
from sptfra_registers import (
    CALIBRATION_BUSY,
    INDEX_ACTIVE,
    MAGIC,
    MAP_VERSION,
    RESETTING,
    SOFT_RESET,
    CalibrationError,
    Event,
    Register,
)

__all__ = ["LAYOUT", "CalibrationError", "Counters", "Event", "Forces", "Identity", "Layout", "Register", "Sptfra", "Status"]

#: Bit of the DMA's control register.
DMA_RESET = 4
#: More than a core holds.
MOST_PACKETS = 32
MOST_TARE_LOG2 = 10


@dataclass(frozen=True)
class Identity:
    """What the core says of itself. Cycles are the predicted ones."""

    version: str
    design_hash: str
    columns: int
    rows: int
    lanes: int
    words_in: int
    words_out: int
    has_field: bool
    reduced: bool
    has_counts: bool
    skips_zeros: bool
    stream_bits: int
    #: Whether gains and offsets are in RAM: see `Sptfra.load_calibration`.
    calibration_in_ram: bool
    #: Dead taxels that a calibration can have replaced.
    replaceable: int
    #: Whether frames that find no room are dropped, and the source never held.
    drops_frames: bool
    #: What a sample of a frame is: float32, int16 or uint16.
    samples: np.dtype
    clock_mhz: float
    full_scale_pa: float
    latency_cycles: int
    interval_cycles: int


@dataclass(frozen=True)
class Counters:
    """Since the last reset, modulo 2**32; cycles are those of the last frame."""

    frames_in: int
    frames_out: int
    frames_bad: int
    #: Those that found no room: 0 without `overrun = "drop"`.
    frames_dropped: int
    last_status: Status
    last_latency: int
    last_interval: int


class Sptfra:
    """A core between the two channels of an AXI DMA."""

    def __init__(self, core, dma, allocate, metadata=None):
        """`allocate` is `pynq.allocate`, `metadata` the path of the design's metadata.json, if the answers' layout is to
        be read from there. Raises RuntimeError if there is no core that this driver knows."""
        self._layout = LAYOUT if metadata is None else Layout.load(metadata)
        self._core = core
        self._dma = dma
        magic = core.read(Register.IDENTITY)
        if magic != MAGIC:
            raise RuntimeError(f"no core here: IDENTITY is {magic:#010x}, expected {MAGIC:#010x}")
        version = core.read(Register.VERSION) >> 24
        if version != MAP_VERSION:
            raise RuntimeError(f"the core's register map is version {version}, this driver knows {MAP_VERSION}")
        self.identity = self._identify()
        samples = self.identity.samples
        self._stress = allocate(shape=(4 * self.identity.words_in // samples.itemsize,), dtype=samples)
        self._forces = allocate(shape=(self.identity.words_out,), dtype=np.uint32)
        self._word = allocate(shape=(1,), dtype=np.uint32)
        self._failed = False
        self._follow_number()

    def _follow_number(self):
        """The core numbers frames as they come in."""
        self._next = self._core.read(Register.FRAMES_IN) & 0xFFFF

    def _identify(self):
        read = self._core.read
        version, geometry, frame, features = (
            read(register) for register in (Register.VERSION, Register.GEOMETRY, Register.FRAME, Register.FEATURES)
        )
        full_scale = np.array([read(Register.FULL_SCALE)], dtype=np.uint32).view(np.float32)[0]
        return Identity(
            version=f"{version >> 16 & 0xFF}.{version >> 8 & 0xFF}.{version & 0xFF}",
            design_hash=f"{read(Register.HASH_HIGH):08x}{read(Register.HASH_LOW):08x}",
            columns=geometry & 0xFF,
            rows=geometry >> 8 & 0xFF,
            lanes=geometry >> 16 & 0xFF,
            words_in=frame & 0xFFFF,
            words_out=frame >> 16,
            has_field=bool(features & 1),
            reduced=bool(features & 2),
            has_counts=bool(features & 4),
            skips_zeros=bool(features & 8),
            calibration_in_ram=bool(features & 16),
            replaceable=features >> 20 & 15,
            drops_frames=bool(features & 32),
            stream_bits=8 * (features >> 8 & 0xFF) or 32,
            samples=np.dtype((np.float32, np.int16, np.uint16)[features >> 16 & 3]),
            clock_mhz=read(Register.CLOCK) / 1e3,
            full_scale_pa=float(full_scale),
            latency_cycles=read(Register.PREDICTED_LATENCY),
            interval_cycles=read(Register.PREDICTED_INTERVAL),
        )

    def counters(self):
        """Frames, errors, and the cycles of the last frame."""
        read = self._core.read
        return Counters(
            frames_in=read(Register.FRAMES_IN),
            frames_out=read(Register.FRAMES_OUT),
            frames_bad=read(Register.FRAMES_BAD),
            frames_dropped=read(Register.FRAMES_DROPPED) if read(Register.FEATURES) & 32 else 0,
            last_status=Status(read(Register.LAST_STATUS) & 0xFFFF),
            last_latency=read(Register.LAST_LATENCY),
            last_interval=read(Register.LAST_INTERVAL),
        )

    def soft_reset(self, timeout=1.0):
        """Resets the core without cutting a packet. Raises TimeoutError, in seconds, if nothing takes the last one."""
        self._core.write(Register.CONTROL, SOFT_RESET)
        end = time.monotonic() + timeout
        while self._core.read(Register.STATUS) & RESETTING:
            if time.monotonic() > end:
                raise TimeoutError("the packet going out is not taken: recover()")
        self._follow_number()

    def recover(self, timeout=0.1):
        """After an exception: resets DMA and core, ends a packet that was cut, and drops what the core still sends.

        Without an answer for `timeout` seconds the core counts as empty: give more than a frame takes.
        """
        self._reset_dma(timeout)
        self._core.write(Register.CONTROL, SOFT_RESET)
        self._word[:] = 0
        self._word.flush()
        # One word with TLAST: the end of a packet that the reset has cut, else a bad frame of its own.
        self._dma.sendchannel.transfer(self._word)
        try:
            for _ in range(MOST_PACKETS):
                self._dma.recvchannel.transfer(self._forces)
                self._until(lambda: self._dma.recvchannel.idle, timeout)
            raise RuntimeError(f"the core is not empty after {MOST_PACKETS} packets: reset it by its aresetn")
        except TimeoutError:
            self._reset_dma(timeout)
        self._until(lambda: not self._core.read(Register.STATUS) & RESETTING, timeout)
        self._follow_number()
        self._failed = False

    def _reset_dma(self, timeout):
        # A reset on either channel resets both.
        self._dma.write(0, DMA_RESET)
        self._until(lambda: not self._dma.read(0) & DMA_RESET, timeout)
        self._dma.sendchannel.start()
        self._dma.recvchannel.start()

    def _until(self, reached, timeout):
        end = time.monotonic() + timeout
        while not reached():
            if self._dma.sendchannel.error or self._dma.recvchannel.error:
                raise RuntimeError("the DMA stopped with an error: recover()")
            if time.monotonic() > end:
                raise TimeoutError(f"nothing came in {timeout} s: recover()")

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
        counts that the core's samples cannot be, TimeoutError if a frame takes longer than so many seconds, RuntimeError if the DMA stops or an answer is that to
        another frame; after the last three nothing is sent before `recover`.
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
        rows, columns, taxels = self.identity.rows, self.identity.columns, frames.shape[1]
        answers = np.empty((len(frames), self.identity.words_out), dtype=np.uint32)
        for frame, answer in zip(frames, answers):
            self._stress[:taxels] = frame
            self._stress.flush()
            self._failed = True
            self._dma.recvchannel.transfer(self._forces)
            self._dma.sendchannel.transfer(self._stress)
            self._until(lambda: self._dma.sendchannel.idle and self._dma.recvchannel.idle, timeout)
            self._forces.invalidate()
            answer[:] = self._forces
            number = int(self._layout.get(answer[np.newaxis], "frame")[0])
            if number != self._next:
                raise RuntimeError(f"the answer is that to frame {number}, not {self._next}: recover()")
            self._next = (number + 1) & 0xFFFF
            self._failed = False
        return decode(answers, rows, columns, self.identity.has_field, self._layout)

    def load_calibration(self, path, noise_floor_pa=None, timeout=1.0):
        """Lets the gains and offsets of a `calibration.csv` act from the next frame on; frames may run meanwhile.

        The file has a line `gain,offset` for each taxel, as the design's own, or is one of `golden bank`: then the dead
        taxels of its header are replaced, and no others; else those that were. With `noise_floor_pa` the thresholds of
        contact and of rest are set by it, else they stay. What is written is compared by its CRC. Raises ValueError on a
        file or values that no bank takes, RuntimeError if the core refuses, TimeoutError; then what acted still does.
        """
        self._needs_calibration()
        gains, offsets, dead = read_calibration(path, self.identity.rows * self.identity.columns)
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
                raise ValueError(f"{path}: nothing replaces the taxels {bare} of gain 0: write it with golden bank")
        words = np.concatenate([words, np.array([*thresholds, *in_map], dtype=np.uint32)]).astype("<u4")
        crc = zlib.crc32(words.tobytes())
        self._calibration_idle()
        write(Register.CALIBRATION_INDEX, 0)
        for word in words:
            write(Register.CALIBRATION_DATA, int(word))
        write(Register.CALIBRATION_COMMIT, crc)
        self._calibration_done(timeout)
        if read(Register.CALIBRATION_CRC) != crc:
            raise RuntimeError("the bank that acts is not the one that was written")

    def read_calibration(self, index, acting=True):
        """A word of the bank that acts, or of the other one: gains, offsets, contact threshold, noise floor."""
        self._needs_calibration()
        self._core.write(Register.CALIBRATION_INDEX, index | (INDEX_ACTIVE if acting else 0))
        return self._core.read(Register.CALIBRATION_DATA)

    def tare(self, frames, timeout=1.0):
        """Takes the mean of 2**n frames at rest, n up to 10, off the offsets; returns their `Forces`, from before.

        Raises ValueError on another number of frames or another shape, before the core knows of a tare, RuntimeError if
        they are not at rest, a taxel's stress spreading by more than the noise floor, clipped or no numbers: then nothing
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

    def _calibration_idle(self):
        if self._core.read(Register.CALIBRATION_STATUS) & CALIBRATION_BUSY:
            raise RuntimeError("a commit or a tare is under way")
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
