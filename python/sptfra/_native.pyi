"""The native half of the package."""

import os
from collections.abc import Callable, Sequence
from typing import Any, Literal, final, overload

import numpy as np
import numpy.typing as npt

from .forces import Forces
from .results import Beyond, Finding, Scene, Unloaded

class Error(ValueError):
    """What is wrong with a design, with frames, or with a file: what, where, and what to do."""

@final
class Design:
    """A sensor, the algorithm for it, and its hardware; every key is checked. Designs do not change."""

    def __new__(
        cls,
        name: str = "my_sensor",
        *,
        columns: int,
        rows: int,
        pitch_mm: Sequence[float] | float,
        depth_mm: float,
        tension: str,
        estimator: str = "joint",
        counts: int | None = None,
        full_scale_pa: float = 100000.0,
        noise: float = 0.005,
    ) -> Design:
        """The design that `sptfra new` writes: for a grid of taxels, under a layer of `depth_mm`. With tension
        "read" taxels read tension, with "clipped" they read nothing of it. With `counts` its frames are those of a converter of so many bits. `noise` is `sensor.noise`. The joint estimator's constants are fitted to it, which takes a second."""

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Design:
        """The design of a file; the ending `.toml` may be left out."""

    @classmethod
    def from_toml(cls, text: str, origin: str = "design") -> Design:
        """The design of a text; messages call it `origin`, and files that it names are looked for in that one's folder."""

    def to_toml(self) -> str:
        """Every key. Files that it names, such as the weights of a network, are written by `save`."""

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the design and, beside it, the files that it names: all or none, and never over those it came from."""

    @property
    def name(self) -> str:
        """A Verilog identifier: top module and folder."""

    @property
    def columns(self) -> int:
        """Taxels in x."""

    @property
    def rows(self) -> int:
        """Taxels in y."""

    @property
    def taxels(self) -> int:
        """Taxels of the grid, m."""

    @property
    def pitch_mm(self) -> tuple[float, float]:
        """Distance of neighbouring taxels in x and y."""

    @property
    def depth_mm(self) -> float:
        """Thickness of the layer above the taxels."""

    @property
    def tension(self) -> str:
        """"read", or "clipped" if the sensor reads pressure alone."""

    @property
    def counts(self) -> bool:
        """Whether frames hold counts; else they hold pascals."""

    @property
    def samples(self) -> str:
        """What a sample on the stream is: "float32", "int16" or "uint16"."""

    @property
    def plan(self) -> str:
        """"reduced" or "paper"."""

    @property
    def estimator(self) -> str:
        """"joint" or "line"."""

    @property
    def contacts(self) -> int:
        """Largest number of contacts that the solver separates."""

    @property
    def outputs(self) -> str:
        """"field", or "resultants" if there is none."""

    @property
    def noise_floor_pa(self) -> float:
        """Stress below which a taxel tells nothing."""

    @property
    def full_scale_pa(self) -> float:
        """Stress at the end of the sensor's range."""

    @property
    def lanes(self) -> int:
        """Multipliers that work on the products."""

    @property
    def clock_mhz(self) -> float:
        """The clock that times assume."""

    @property
    def part(self) -> str:
        """The FPGA."""

@final
class Past:
    """What the frames of a stream leave to the next ones: averages and creep; empty at first."""

    def __new__(cls) -> Past: ...

@final
class Solver:
    """Forces from frames in double precision, as `sptfra solve` finds them."""

    def __new__(cls, design: Design) -> Solver: ...
    @property
    def design(self) -> Design:
        """The design that it was made for."""

    def solve(
        self, frames: npt.ArrayLike, *, slips: bool | Forces | None = None, past: Past | None = None
    ) -> Forces:
        """Forces of frames that follow each other, on all cores, without Python's lock; Ctrl-C ends it.

        Frames are numbers of shape (n, rows, columns) or (n, taxels); (rows, columns) and (taxels,) are one frame. In Pa,
        compression negative, or in counts if the design counts. For designs with a limit of
        slip, `slips` are the forces of the frame before them, or whether that one slipped, with all contacts in it.
        With smoothing or creep, `past` is what the frames before have left, and then these; without it these begin a
        stream.
        """

@final
class FrameLines:
    """Frames from lines of text, as a sensor sends them; messages call it `origin`."""

    def __new__(cls, design: Design, *, labels: int = 0, origin: str = "standard input") -> FrameLines: ...
    def frame(self, line: bytes) -> npt.NDArray[np.float64] | None:
        """The frame (rows, columns) of the next line; None for a header, a blank line and a remark."""

@overload
def load_frames(
    path: str | os.PathLike[str],
    design: Design,
    *,
    labels: int = 0,
    columns: tuple[int, int] | None = None,
    skip_lines: int = 0,
    skip_bad: Literal[False] = False,
) -> npt.NDArray[np.float64]: ...
@overload
def load_frames(
    path: str | os.PathLike[str],
    design: Design,
    *,
    labels: int = 0,
    columns: tuple[int, int] | None = None,
    skip_lines: int = 0,
    skip_bad: Literal[True],
) -> tuple[npt.NDArray[np.float64], list[int]]:
    """Frames (n, rows, columns) of a CSV or .npy file.

    Its lines begin with `labels` other columns, or the values are the `columns` (first, last), from 1. `skip_lines` are
    passed over at the beginning. With `skip_bad` frames with a value that is no number are left out; returned are the
    frames, and the places of those left out among all, from 0.
    """

def scene(
    design: Design | None = None,
    path: str | os.PathLike[str] | None = None,
    *,
    kind: str | None = None,
    count: int = 60,
    friction: float = 0.5,
    seed: int = 1,
) -> Scene:
    """Frames with their true forces: of a scene file, else a round contact that suits the design, in 36 directions.

    With `kind`, such as "held" or "mixed-inside", so many contacts of that kind on the design's sensor, one of each seed:
    what `sptfra scene --kind` makes.
    """

def check(design: Design, frames: npt.ArrayLike) -> list[Finding]:
    """What is wrong with frames, as far as they show it: unit, sign, tare, order of the taxels, end of the converter."""

def beyond(design: Design, frames: npt.ArrayLike) -> Beyond:
    """How much of frames lies beyond what the design is calibrated for: the full scale, or the ends of its curve."""

def unloaded(design: Design, frames: npt.ArrayLike) -> Unloaded:
    """What ten or more frames of an unloaded sensor measure: each taxel's offset, noise and drift."""

def calibrate(
    design: Design | str | os.PathLike[str],
    *,
    name: str | None = None,
    training_set: str | None = None,
    seed: int = 1,
    hidden: int | None = None,
    quick: bool = False,
    thorough: bool = False,
    progress: Callable[[int, int], Any] | None = None,
) -> Design:
    """The design with constants and a network fitted to its sensor, in a minute or some; Ctrl-C ends it.

    `training_set` is "sliding" or "general"; a path may be that of a design whose constants are those of another sensor.
    Without a `name` it is that of the design with `_calibrated` behind it.
    `progress` is called with the pieces of work done and all, ten times a second.
    """

def calibrate_recorded(
    design: Design,
    frames: npt.ArrayLike,
    measured: np.ndarray | str | os.PathLike[str],
    *,
    uniform: bool,
    name: str | None = None,
) -> tuple[Design, str, str]: ...
def errors(forces: np.ndarray, truth: np.ndarray) -> list[tuple[str, float, float]]: ...
def inspect(design: Design) -> str: ...
def generate(design: Design, folder: str | os.PathLike[str] | None = None) -> tuple[str, list[str]]: ...
def simulate(design: Design, frames: npt.ArrayLike, *, seed: int = 1) -> tuple[Forces, str]: ...

def command(words: Sequence[str]) -> int:
    """Runs a command line, whose first word is the program's name, and returns the exit code."""
