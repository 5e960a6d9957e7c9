# SPDX-License-Identifier: MIT OR Apache-2.0
"""A core's answers as numpy arrays."""

import enum
import json
import pathlib
from dataclasses import dataclass

import numpy as np

#: Edition of metadata.json, and of the streams that it describes.
FORMAT = 2


class Status(enum.IntFlag):
    """Status bits of a frame."""

    NO_CONTACT = 1
    DIRECTION_UNKNOWN = 2
    AT_BOUND = 4
    SATURATED = 8
    NOT_FINITE = 16
    BAD_LENGTH = 32
    DOUBTFUL = 64
    MORE_BODIES = 128
    REPLACED = 256
    TOO_MANY_REPLACED = 512
    SLIP = 1024
    NO_TENSION = 2048
    DROPPED = 4096


def read_metadata(path):
    """A design's metadata.json. Raises ValueError for one of another edition."""
    metadata = json.loads(pathlib.Path(path).read_text())
    if metadata.get("format") != FORMAT:
        raise ValueError(f"{path}: format {metadata.get('format')}, this driver knows {FORMAT}")
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


@dataclass(frozen=True)
class Records:
    """Where the records of bodies stand in an answer: `count` of them, of `words` words each, from the word `first` on."""

    first: int
    count: int
    words: int
    #: Where each value stands in a record, as in `Layout`, and its unit.
    values: dict[str, tuple[int, int, int | None]]
    units: dict[str, str]

    @classmethod
    def load(cls, value):
        """Those of an entry of metadata.json."""
        values = value["of_each_body"]
        return cls(
            value["index"],
            value["count"],
            value["words"],
            {each["name"]: _place(each) for each in values},
            {each["name"]: each["unit"] for each in values},
        )

    @property
    def end(self):
        """The first word behind them."""
        return self.first + self.count * self.words

    def get(self, words):
        """(n, count) structured records of (n, words_out) uint32."""
        own = words[:, self.first : self.end].reshape(len(words), self.count, self.words)
        kinds = [(name, np.float32 if mask is None else np.uint16) for name, (_, _, mask) in self.values.items()]
        records = np.empty(own.shape[:2], dtype=kinds)
        for name, place in self.values.items():
            records[name] = _read(own, place)
        return records


class Layout:
    """Where the values stand in an answer's words, by name: (index of the word, its lowest bit, mask; None: float32)."""

    def __init__(self, values, field, units, records=None):
        """`field` is the first word of the taxels' forces, `units` the unit of each value; "" for plain numbers. `records`
        are the `Records` of a core that tells bodies apart."""
        self.values, self.field, self.units, self.records = values, field, units, records

    @classmethod
    def load(cls, path):
        """That of a design, from its metadata.json. Raises ValueError for one of another edition, or one whose words
        contradict each other."""
        metadata = read_metadata(path)
        values, field, units, records, end = {}, None, {}, None, 0
        for value in metadata["output"]:
            if value["name"] == "body":
                records = Records.load(value)
                end = max(end, records.end)
                continue
            if value["name"] == "field":
                field, end = value["index"], max(end, value["index"] + value["count"])
            else:
                values[value["name"]] = _place(value)
            units[value["name"]] = value["unit"]
        if records is not None and field not in (None, records.end) or end not in (0, metadata["bytes_out"] // 4):
            raise ValueError(f"{path}: the words of \"output\" do not fit each other and bytes_out; generate the design anew")
        return cls(values, field, units, records)

    def with_records(self, count):
        """The same with so many records of bodies before the field, as every core has them."""
        if not count:
            return self
        records = Records(self.field, count, RECORD_WORDS, _RECORD, _RECORD_UNITS)
        return Layout(self.values, records.end, self.units, records)

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
    "bodies": "bodies", "generation": "generation", "replaced": "replaced_taxels", "field": "field",
}  # fmt: skip
_UNITS = {
    "N": "F_x F_y F_z standard_error field", "N m": "T_x T_y T_z", "rad": "phi", "cycles": "timestamp",
    "taxels": "replaced_taxels", "": "status frame mu mu_x mu_y bodies generation",
}  # fmt: skip
_FLOATS = {"F_x": 2, "F_y": 3, "F_z": 4, "T_x": 5, "T_y": 6, "T_z": 7, "mu": 8, "phi": 9, "mu_x": 10, "mu_y": 11}
#: A body's record: words, where its values stand, and their units.
RECORD_WORDS = 8
_RECORD = {"taxels": (0, 0, 0xFFFF), "status": (0, 16, 0xFFFF)} | {
    name: (index, 0, None) for index, name in enumerate("x y F_x F_y F_z mu standard_error".split(), 1)
}
_RECORD_UNITS = {"taxels": "taxels", "status": "", "x": "m", "y": "m", "F_x": "N", "F_y": "N", "F_z": "N", "mu": ""} | {
    "standard_error": "N"
}
#: The layout of every core for one body; of one that tells several apart `LAYOUT.with_records(identity.records)`.
LAYOUT = Layout(
    {name: (index, 0, None) for name, index in (_FLOATS | {"standard_error": 12}).items()}
    | {"status": (0, 0, 0xFFFF), "frame": (0, 16, 0xFFFF), "timestamp": (1, 0, 0xFFFFFFFF)}
    | {"bodies": (13, 0, 0xFF), "generation": (13, 8, 0xFF), "replaced_taxels": (13, 16, 0xFF)},
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
    #: (n,) uint8: bodies in touch; at most 1 in a design that neither tells them apart nor counts them.
    bodies: np.ndarray
    #: (n,) uint8: generation of the calibration.
    generation: np.ndarray
    #: (n,) uint8: taxels whose stress was made up.
    replaced: np.ndarray
    #: (n, contacts) structured: `taxels`, `status`, `x`, `y` in m from the first taxel, `F_x`, `F_y`, `F_z` in N, `mu`,
    #: `standard_error` of each body, the one that presses most first, then zeros; None if the design has one body.
    records: np.ndarray | None
    #: (n, rows, columns, 3) float32: f_x, f_y, f_z of each taxel in N; None if the design has resultants only.
    field: np.ndarray | None
    #: Unit of each array, and of each value of `records`, by its name: `units["torque"]` is "N m"; "" for plain numbers.
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
        bodies=layout.get(words, "bodies").astype(np.uint8),
        generation=layout.get(words, "generation").astype(np.uint8),
        replaced=layout.get(words, "replaced_taxels").astype(np.uint8),
        records=None if layout.records is None else layout.records.get(words),
        field=field,
        units=({} if layout.records is None else layout.records.units)
        | {array: layout.units[name] for array, name in _OF.items() if has_field or array != "field"},
    )
