# SPDX-License-Identifier: MIT OR Apache-2.0
"""Forces of frames as arrays, under the names that the driver of a board (`drivers/python`) has for them too."""

from __future__ import annotations

import enum
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import ClassVar

import numpy as np
import numpy.typing as npt


class Status(enum.IntFlag):
    """Status bits of a frame; what each means stands in `docs/reference/status-bits.md`."""

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


#: What is known of a contact, by the names that force files have for it.
CONTACT = {name: np.uint16 if name in ("taxels", "status") else np.float64 for name in
        "taxels status x y F_x F_y F_z mu standard_error T_x T_y T_z".split()}

#: Names with a unit, by unit.
_NAMES = {
    "N": "resultant field standard_error F_x F_y F_z f_x f_y f_z",
    "N m": "torque T_x T_y T_z",
    "rad": "direction phi",
    "m": "x y",
    "": "status friction mu friction_xy mu_x mu_y contacts taxels",
}
_UNITS = MappingProxyType({name: unit for unit, names in _NAMES.items() for name in names.split()})


@dataclass(frozen=True, eq=False)
class Forces:
    """Forces of n frames; of a frame whose status says NOT_FINITE, BAD_LENGTH or NO_CONTACT all are zeros."""

    #: The unit of each array, of each column of `table()` and of each name of `records`; "" for plain numbers.
    UNITS: ClassVar[Mapping[str, str]] = _UNITS

    #: (n,) uint16: bits of `Status`.
    status: np.ndarray
    #: (n, 3): F_x, F_y, F_z in N; F_z < 0 presses.
    resultant: np.ndarray
    #: (n, 3): T_x, T_y, T_z in N m about the middle of the grid at the surface.
    torque: np.ndarray
    #: (n,): friction coefficient, tangential over normal force.
    friction: np.ndarray
    #: (n,): direction of the tangential force in rad, atan2(F_y, F_x).
    direction: np.ndarray
    #: (n, 2): friction along x and y.
    friction_xy: np.ndarray
    #: (n,): standard error of (F_x, F_y) in N; 0 where the design has none.
    standard_error: np.ndarray
    #: (n,) uint8: contacts; at most 1 in a design that neither counts nor separates them.
    contacts: np.ndarray
    #: (n, contacts) structured: `taxels`, `status`, `x`, `y` in m from the first taxel, `F_x`, `F_y`, `F_z` in N, `mu`,
    #: `standard_error`, `T_x`, `T_y`, `T_z` in N m of each contact, the one that presses most first, then zeros;
    #: None where only one is known, as of hardware, which does not separate contacts.
    records: np.ndarray | None
    #: (n, rows, columns, 3): f_x, f_y, f_z of each taxel in N; None where only resultants are known.
    field: np.ndarray | None

    @property
    def mu(self) -> np.ndarray:
        """`friction`, by the name that force files have for it."""
        return self.friction

    @property
    def phi(self) -> np.ndarray:
        """`direction`, by the name that force files have for it."""
        return self.direction

    def __len__(self) -> int:
        return len(self.status)

    def __repr__(self) -> str:
        field = "no field" if self.field is None else f"a field of {self.field.shape[1]} x {self.field.shape[2]} taxels"
        return f"<sptfra.Forces of {len(self)} frames, {field}>"

    def names(self, index: int) -> list[str]:
        """Names of a frame's status bits; none for a good one."""
        return [str(bit.name) for bit in Status if int(self.status[index]) & bit]

    def has(self, bits: Status | int) -> np.ndarray:
        """(n,) bool: frames that have one of these status bits."""
        return np.asarray((self.status & np.uint16(bits)) != 0)

    def table(self) -> np.ndarray:
        """(n,) structured array with the columns of a force file, without the field."""
        names = "status F_x F_y F_z mu phi mu_x mu_y T_x T_y T_z standard_error contacts".split()
        columns = [self.status, *self.resultant.T, self.friction, self.direction, *self.friction_xy.T, *self.torque.T]
        columns += [self.standard_error, self.contacts]
        if self.records is not None:
            # As in a force file, the torques behind the records of all contacts.
            for behind in (False, True):
                of_contact = [name for name in CONTACT if name.startswith("T_") == behind]
                for contact in range(self.records.shape[1]):
                    names += [f"contact{contact + 1}_{name}" for name in of_contact]
                    columns += [self.records[name][:, contact] for name in of_contact]
        table = np.empty(len(self), dtype=[(name, column.dtype) for name, column in zip(names, columns)])
        for name, column in zip(names, columns):
            table[name] = column
        return table


def _forces(
    status: np.ndarray, numbers: np.ndarray, contacts: np.ndarray, records: np.ndarray | None, field: np.ndarray | None
) -> Forces:
    """Forces from the native half's arrays: the eleven numbers of each frame, one after the other."""
    parts = map(np.ascontiguousarray, np.split(numbers, [3, 6, 7, 8, 10], axis=1))
    resultant, torque, friction, direction, friction_xy, standard_error = parts
    return Forces(
        status=status,
        resultant=resultant,
        torque=torque,
        friction=friction.ravel(),
        direction=direction.ravel(),
        friction_xy=friction_xy,
        standard_error=standard_error.ravel(),
        contacts=contacts,
        records=None if records is None else _records(records),
        field=field,
    )


def _records(values: np.ndarray) -> np.ndarray:
    """Structured records of (n, contacts, len(CONTACT)) numbers."""
    records = np.empty(values.shape[:2], dtype=list(CONTACT.items()))
    for index, name in enumerate(CONTACT):
        records[name] = values[..., index]
    return records


def _double(frames: npt.ArrayLike) -> np.ndarray:
    """Frames in double precision, a copy only where the numbers are others."""
    if np.ma.is_masked(frames):
        # numpy would hand on what the mask hides.
        frames = np.ma.filled(np.ma.asarray(frames, np.float64), np.nan)
    array = np.asarray(frames)
    if array.dtype.kind not in "fiu":
        wanted = "numbers, such as float32: the stress in pascals or the sensor's counts"
        raise TypeError(f"frames are an array of {array.dtype}; give {wanted}")
    return np.asarray(array, np.float64)
