# SPDX-License-Identifier: MIT OR Apache-2.0
"""What a core is: from its registers, or of a core without them (`control = false`) from its metadata.json."""

from dataclasses import dataclass

import numpy as np
from sptfra_forces import Status, read_metadata
from sptfra_registers import MAGIC, MAP_VERSION, Register


@dataclass(frozen=True)
class Identity:
    """What the core says of itself; None is what metadata.json does not say of one without registers. Cycles are the
    predicted ones."""

    version: str
    design_hash: str
    columns: int
    rows: int
    lanes: int | None
    words_in: int
    words_out: int
    has_field: bool
    reduced: bool | None
    has_counts: bool | None
    stream_bits: int
    #: Whether gains and offsets are in RAM: see `Sptfra.load_calibration`.
    calibration_in_ram: bool
    #: Whether a calibration has a curve from counts to pascals.
    curve_in_ram: bool
    #: Dead taxels that a calibration can have replaced.
    replaceable: int
    #: Whether frames that find no room are dropped, and the source never held.
    drops_frames: bool
    #: Whether a register sets the average of frames: see `Sptfra.set_smoothing`. False without registers.
    averages_frames: bool
    #: What a sample of a frame is: float32, int16 or uint16.
    samples: np.dtype
    clock_mhz: float
    full_scale_pa: float | None
    latency_cycles: int
    interval_cycles: int

    @classmethod
    def read(cls, core):
        """That of a core with registers. Raises RuntimeError if there is none that this driver knows."""
        magic = core.read(Register.IDENTITY)
        if magic != MAGIC:
            raise RuntimeError(f"no core here: IDENTITY is {magic:#010x}, expected {MAGIC:#010x}")
        version, geometry, frame, features = (
            core.read(register) for register in (Register.VERSION, Register.GEOMETRY, Register.FRAME, Register.FEATURES)
        )
        if version >> 24 != MAP_VERSION:
            raise RuntimeError(
                f"the core's register map is version {version >> 24}, not {MAP_VERSION}: take the drivers of its release"
            )
        full_scale = np.array([core.read(Register.FULL_SCALE)], dtype=np.uint32).view(np.float32)[0]
        return cls(
            version=f"{version >> 16 & 0xFF}.{version >> 8 & 0xFF}.{version & 0xFF}",
            design_hash=f"{core.read(Register.HASH_HIGH):08x}{core.read(Register.HASH_LOW):08x}",
            columns=geometry & 0xFF,
            rows=geometry >> 8 & 0xFF,
            lanes=geometry >> 16 & 0xFF,
            words_in=frame & 0xFFFF,
            words_out=frame >> 16,
            has_field=bool(features & 1),
            reduced=bool(features & 2),
            has_counts=bool(features & 4),
            calibration_in_ram=bool(features & 16),
            curve_in_ram=bool(features & 64),
            replaceable=features >> 20 & 15,
            drops_frames=bool(features & 32),
            averages_frames=bool(features & 128),
            stream_bits=8 * (features >> 8 & 0xFF) or 32,
            samples=np.dtype((np.float32, np.int16, np.uint16)[features >> 16 & 3]),
            clock_mhz=core.read(Register.CLOCK) / 1e3,
            full_scale_pa=float(full_scale),
            latency_cycles=core.read(Register.PREDICTED_LATENCY),
            interval_cycles=core.read(Register.PREDICTED_INTERVAL),
        )

    @classmethod
    def load(cls, path):
        """That of a design, from its metadata.json. Raises ValueError for one of another edition."""
        metadata = read_metadata(path)
        predicted = metadata["predicted"]
        return cls(
            version=metadata["generator"].split()[-1],
            design_hash=metadata["design_hash"],
            columns=metadata["columns"],
            rows=metadata["rows"],
            lanes=None,
            words_in=metadata["bytes_in"] // 4,
            words_out=metadata["bytes_out"] // 4,
            has_field=any(value["name"] == "field" for value in metadata["output"]),
            reduced=None,
            has_counts=None,
            calibration_in_ram=False,
            curve_in_ram=False,
            replaceable=0,
            drops_frames=metadata["overrun"] == "drop",
            averages_frames=False,
            stream_bits=metadata["stream_bits"],
            samples=np.dtype(metadata["samples"]),
            clock_mhz=metadata["clock_mhz"],
            full_scale_pa=None,
            latency_cycles=predicted["latency_cycles"],
            interval_cycles=predicted["interval_cycles"],
        )


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

    @classmethod
    def read(cls, core):
        """Those of a core with registers."""
        return cls(
            frames_in=core.read(Register.FRAMES_IN),
            frames_out=core.read(Register.FRAMES_OUT),
            frames_bad=core.read(Register.FRAMES_BAD),
            frames_dropped=core.read(Register.FRAMES_DROPPED) if core.read(Register.FEATURES) & 32 else 0,
            last_status=Status(core.read(Register.LAST_STATUS) & 0xFFFF),
            last_latency=core.read(Register.LAST_LATENCY),
            last_interval=core.read(Register.LAST_INTERVAL),
        )
