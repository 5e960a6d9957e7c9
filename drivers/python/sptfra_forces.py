# SPDX-License-Identifier: MIT OR Apache-2.0
"""A core's answers as numpy arrays."""

import enum
import json
import pathlib
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

#: Edition of metadata.json, and of the streams that it describes.
FORMAT = 3


class Status(enum.IntFlag):
    """Status bits of a frame."""

    NO_CONTACT = 1
    DIRECTION_UNKNOWN = 2
    AT_BOUND = 4
    SATURATED = 8
    NOT_FINITE = 16
    BAD_LENGTH = 32
    LOW_CONFIDENCE = 64
    SEVERAL_CONTACTS = 128
    REPLACED = 256
    TOO_MANY_REPLACED = 512
    SLIP = 1024
    NO_TENSION = 2048
    DROPPED = 4096


def read_metadata(path):
    """A design's metadata.json. Raises ValueError for one of another edition."""
    metadata = json.loads(pathlib.Path(path).read_text())
    if metadata.get("format") != FORMAT:
        raise ValueError(f"{path}: format is {metadata.get('format')}, not {FORMAT}: generate the folder anew")
    return metadata


def _place(value):
    """Word, lowest bit and mask of a value of metadata.json."""
    high, low = value.get("bits", (31, 0))
    return value["index"], low, None if value["type"] == "float32" else (1 << (high - low + 1)) - 1


def _read(words, place):
    """A value out of words whose last axis is `place`'s."""
    index, low, mask = place
    column = words[..., index]
    return column.copy().view(np.float32) if mask is None else column >> low & mask


class Layout:
    """Where the values stand in an answer's words, by name: (index of the word, its lowest bit, mask; None: float32)."""

    def __init__(self, values, field, units):
        """`field` is the first word of the taxels' forces, `units` the unit of each value; "" for plain numbers."""
        self.values, self.field, self.units = values, field, units

    @classmethod
    def load(cls, path):
        """That of a design, from its metadata.json. Raises ValueError for one of another edition, or one whose words
        contradict each other."""
        metadata = read_metadata(path)
        values, field, units, end = {}, None, {}, 0
        for value in metadata["output"]:
            if value["name"] == "field":
                field, end = value["index"], max(end, value["index"] + value["count"])
            else:
                values[value["name"]] = _place(value)
            units[value["name"]] = value["unit"]
        if end not in (0, metadata["bytes_out"] // 4):
            raise ValueError(f"{path}: the words of \"output\" do not fit each other and bytes_out; generate the design anew")
        return cls(values, field, units)

    def get(self, words, name):
        """The value of each answer in (n, words_out) uint32."""
        return _read(words, self.values[name])

    def vector(self, words, *names):
        """Several values of each answer, side by side."""
        return np.column_stack([self.get(words, name) for name in names])


#: What stands in each array of `Forces`: a value of that unit.
_OF = {
    "status": "status", "number": "frame", "timestamp": "timestamp", "resultant": "F_x", "torque": "T_x",
    "friction": "mu", "direction": "phi", "friction_xy": "mu_x", "standard_error": "standard_error",
    "contacts": "contacts", "version": "version", "replaced": "replaced_taxels", "field": "field",
}  # fmt: skip
_UNITS = {
    "N": "F_x F_y F_z standard_error field", "N m": "T_x T_y T_z", "rad": "phi", "cycles": "timestamp",
    "taxels": "replaced_taxels", "": "status frame mu mu_x mu_y contacts version",
}  # fmt: skip
_FLOATS = {"F_x": 2, "F_y": 3, "F_z": 4, "T_x": 5, "T_y": 6, "T_z": 7, "mu": 8, "phi": 9, "mu_x": 10, "mu_y": 11}
#: The layout of every core.
LAYOUT = Layout(
    {name: (index, 0, None) for name, index in (_FLOATS | {"standard_error": 12}).items()}
    | {"status": (0, 0, 0xFFFF), "frame": (0, 16, 0xFFFF), "timestamp": (1, 0, 0xFFFFFFFF)}
    | {"contacts": (13, 0, 0xFF), "version": (13, 8, 0xFF), "replaced_taxels": (13, 16, 0xFF)},
    field=16,
    units={name: unit for unit, names in _UNITS.items() for name in names.split()},
)


@dataclass(frozen=True)
class Forces:
    """Answers to n frames; of a frame whose status says NOT_FINITE, BAD_LENGTH or NO_CONTACT all results are zeros."""

    #: (n,) uint16: bits of `Status`.
    status: np.ndarray
    #: (n,) uint16: number of the frame since the core was reset, modulo 65536.
    number: np.ndarray
    #: (n,) uint32: when its first beat came in, in cycles since the reset, modulo 2**32.
    timestamp: np.ndarray
    #: (n, 3) float32: F_x, F_y, F_z in N.
    resultant: np.ndarray
    #: (n, 3) float32: T_x, T_y, T_z in N m about the middle of the grid.
    torque: np.ndarray
    #: (n,) float32: friction coefficient.
    friction: np.ndarray
    #: (n,) float32: direction of the push in rad.
    direction: np.ndarray
    #: (n, 2) float32: friction along x and y.
    friction_xy: np.ndarray
    #: (n,) float32: standard error of (F_x, F_y) in N; 0 where the design has none.
    standard_error: np.ndarray
    #: (n,) uint8: contacts; at most 1 in a design with `count_contacts = false`.
    contacts: np.ndarray
    #: (n,) uint8: version of the calibration.
    version: np.ndarray
    #: (n,) uint8: taxels whose stress was made up.
    replaced: np.ndarray
    #: (n, rows, columns, 3) float32: f_x, f_y, f_z of each taxel in N; None if the design has resultants only.
    field: np.ndarray | None
    #: Unit of each array, by its name: `units["torque"]` is "N m"; "" for plain numbers.
    units: dict[str, str]

    def names(self, index):
        """Names of a frame's status bits."""
        return [bit.name for bit in Status if int(self.status[index]) & bit]


def decode(words, rows, columns, has_field, layout=LAYOUT):
    """Forces from (n, words_out) words of uint32 as the core sends them."""
    words = np.ascontiguousarray(words, dtype=np.uint32)
    field = None
    if has_field:
        taxels = words[:, layout.field : layout.field + 3 * rows * columns]
        field = np.ascontiguousarray(taxels).view(np.float32).reshape(len(words), rows, columns, 3)
    return Forces(
        status=layout.get(words, "status").astype(np.uint16),
        number=layout.get(words, "frame").astype(np.uint16),
        timestamp=layout.get(words, "timestamp"),
        resultant=layout.vector(words, "F_x", "F_y", "F_z"),
        torque=layout.vector(words, "T_x", "T_y", "T_z"),
        friction=layout.get(words, "mu"),
        direction=layout.get(words, "phi"),
        friction_xy=layout.vector(words, "mu_x", "mu_y"),
        standard_error=layout.get(words, "standard_error"),
        contacts=layout.get(words, "contacts").astype(np.uint8),
        version=layout.get(words, "version").astype(np.uint8),
        replaced=layout.get(words, "replaced_taxels").astype(np.uint8),
        field=field,
        units={array: layout.units[name] for array, name in _OF.items() if has_field or array != "field"},
    )


def separate(forces, frames, solver):
    """The forces of each contact, by software, of the frames that the core marks by `SEVERAL_CONTACTS`.

    `frames` are those that `Sptfra.reconstruct` was given for these forces. `solver` has `solve(frames)`, as the
    `sptfra.Solver` of a design with `contacts = N`; or it maps versions of the calibration to solvers.
    Yields, for each version, the indices of its marked frames and what its solver returns for them. Raises ValueError
    on another number of frames, KeyError for a version without a solver.
    """
    count = len(forces.status)
    frames = np.asarray(frames)
    if frames.ndim == 0 or len(frames) != count and count != 1:
        raise ValueError(f"frames of shape {frames.shape} for the forces of {count}")
    frames = frames.reshape(count, -1)
    marked = np.flatnonzero(forces.status & Status.SEVERAL_CONTACTS)
    for version in np.unique(forces.version[marked]):
        indices = marked[forces.version[marked] == version]
        of_version = solver[int(version)] if isinstance(solver, Mapping) else solver
        yield indices, of_version.solve(frames[indices])
