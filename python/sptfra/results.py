# SPDX-License-Identifier: MIT OR Apache-2.0
"""What the package's functions return."""

from __future__ import annotations

import contextlib
import os
import pathlib
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from . import _native
from ._native import Design, Error
from .forces import Forces


class Finding(NamedTuple):
    """One thing that is suspicious in frames, with its likely cause and what to change."""

    #: What it is about: empty, unloaded, range, sign, no_tension, tension, tare, dead, order, stuck, scaled, noise,
    #: contacts or crosstalk (`docs/reference/files.md`).
    kind: str
    message: str

    def __str__(self) -> str:
        return self.message


class Beyond(NamedTuple):
    """Readings at the full scale or beyond it, or beyond the ends of the design's curve."""

    #: Of taxels that are not dead.
    readings: int
    #: Of all readings, from 0 to 1.
    share: float
    #: With any of them.
    frames: int


@dataclass(frozen=True)
class Unloaded:
    """What frames of an unloaded sensor measure, in their units unless a name says pascals."""

    #: (rows, columns): mean of each taxel.
    offset: np.ndarray = field(repr=False)
    #: (rows, columns): standard deviation about a straight line over time.
    noise: np.ndarray = field(repr=False)
    #: (rows, columns): mean of the last third of the frames less that of the first.
    drift: np.ndarray = field(repr=False)
    #: Taxels that never change while the others do, and those of the design.
    dead: tuple[int, ...]
    #: Taxels that never change and read what no unloaded taxel does.
    stuck: tuple[int, ...]
    #: Taxels that vary four times as much as the median one.
    noisy: tuple[int, ...]
    median_noise: float
    median_drift: float
    #: The median deviation in pascals.
    noise_pa: float
    #: For `algorithm.noise_floor_pa`: three deviations.
    noise_floor_pa: float
    #: The deviation over `full_scale_pa`: the noise of contacts that reach it.
    noise_of_full_scale: float
    #: Signs that something pressed.
    warnings: tuple[str, ...]
    _calibration: str = field(repr=False)
    _tared: Design | None = field(repr=False)
    _refused: str = field(repr=False)

    @property
    def tared(self) -> Design:
        """The design with these offsets taken off, dead and stuck taxels replaced, and this noise floor.

        Raises `Error` where `save` does.
        """
        if self._tared is None:
            raise Error(self._refused)
        return self._tared

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the calibration that takes the offsets off, for `[sensor] calibration`: gain 0 for dead and stuck taxels.

        Raises `Error` where the design's frames are in pascals, or more taxels are dead than can be replaced.
        """
        if self._refused:
            raise Error(self._refused)
        pathlib.Path(path).write_text(self._calibration, encoding="utf-8", newline="\n")


class Scene(NamedTuple):
    """Frames of contacts whose forces are known."""

    #: (n, rows, columns): stress in Pa, or the design's counts.
    frames: np.ndarray
    #: The true forces, without a field.
    truth: Forces


class Spread(NamedTuple):
    """An error over many frames, in percent."""

    max: float
    #: The standard deviation, which the paper calls the standard error.
    standard_error: float


def errors(forces: Forces | npt.ArrayLike, truth: Forces | npt.ArrayLike) -> dict[str, Spread]:
    """Errors e_Fx, e_Fy, e_Fz in percent of the normal force, e_mu of 1, e_phi of a turn.

    In place of `Forces` also numbers (n, 3): F_x, F_y, F_z in N.
    """
    found, known = _outcomes(forces), _outcomes(truth)
    if len(found) != len(known):
        raise ValueError(f"forces of {len(found)} frames and true forces of {len(known)}; give those of the same frames")
    return {name: Spread(most, deviation) for name, most, deviation in _native.errors(found, known)}


def _outcomes(forces: Forces | npt.ArrayLike) -> np.ndarray:
    """F_x, F_y, F_z of each frame, and of `Forces` friction and direction."""
    if hasattr(forces, "resultant"):
        parts = [np.asarray(part, np.float64) for part in (forces.resultant, forces.friction, forces.direction)]
        if parts[0].shape[1:] != (3,) or len({len(part) for part in parts}) > 1:
            raise ValueError("resultant, friction and direction are not those of the same frames")
        return np.column_stack(parts)
    array = np.asarray(forces)
    if array.shape[1:] == (3,):
        with contextlib.suppress(TypeError, ValueError):
            return array.astype(np.float64)
    wanted = "what Solver.solve returns, or numbers of shape (n, 3): F_x, F_y, F_z in N"
    raise ValueError(f"forces of shape {list(array.shape)}; give {wanted}")


@dataclass(frozen=True)
class Plan:
    """What the hardware of a design will be: cycles are exact, DSP and memories what the modules infer."""

    #: From the first beat in to the last beat out of a frame alone, at `clock_mhz`.
    latency_cycles: int
    #: Between frames back to back.
    interval_cycles: int
    clock_mhz: float
    lanes: int
    #: DSP48E2.
    dsp: int
    #: RAMB36.
    bram36: float
    rom_bits: int
    #: What to look at before it is built.
    warnings: tuple[str, ...]
    #: All that `sptfra inspect --json` prints.
    details: dict[str, Any] = field(repr=False)

    @property
    def latency_us(self) -> float:
        """Latency in microseconds."""
        return self.latency_cycles / self.clock_mhz

    @property
    def interval_us(self) -> float:
        """Interval in microseconds."""
        return self.interval_cycles / self.clock_mhz

    @property
    def frames_per_second(self) -> float:
        """Frames a second."""
        return 1e6 / self.interval_us


@dataclass(frozen=True)
class Recorded:
    """What a recording with measured forces or pressures could tell."""

    #: The design with the constants from it.
    design: Design
    #: What the recording determined, what it could not and why, and what else is to be known; in words.
    determined: tuple[str, ...]
    undetermined: tuple[str, ...]
    remarks: tuple[str, ...]
    #: In percent of the load where that was left out: `median`, `most` (95 %), `worst`, of so many `holds`; None if there
    #: was too little to leave any out.
    errors: dict[str, float] | None
    #: An HTML page with plots.
    page: str = field(repr=False)
    #: All that `sptfra calibrate --json` prints of it.
    details: dict[str, Any] = field(repr=False)


@dataclass(frozen=True)
class Simulation:
    """What the simulated core did."""

    #: Its answers, free-running.
    forces: Forces = field(repr=False)
    #: Whether every word, in all stream modes, was that of the integer model.
    bit_exact: bool
    latency_cycles: int
    interval_cycles: int
    predicted_latency_cycles: int
    predicted_interval_cycles: int
    clock_mhz: float
    #: All that is wrong, in words; empty if the hardware is right.
    faults: tuple[str, ...]

    @property
    def latency_us(self) -> float:
        """Latency in microseconds."""
        return self.latency_cycles / self.clock_mhz
