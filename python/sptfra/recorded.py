# SPDX-License-Identifier: MIT OR Apache-2.0
"""What a count is worth, and what each taxel's is, from recordings with measured forces or pressures."""

from __future__ import annotations

import json
import os

import numpy as np
import numpy.typing as npt

from . import _native
from .results import Recorded


def calibrate_forces(
    design: _native.Design,
    frames: npt.ArrayLike,
    forces: npt.ArrayLike | str | os.PathLike[str],
    *,
    name: str | None = None,
) -> Recorded:
    """Curve, common gain, taxels' gains and friction constants, from contacts with measured forces.

    Frames as for `Solver.solve`. Forces in newtons: F_z alone, (n,), or (n, 3), NaN where one is not known; or the path of
    a file as `sptfra calibrate --forces` reads it. What the recording cannot tell is not fitted.
    """
    measured = _measured(forces)
    if isinstance(measured, np.ndarray):
        if measured.ndim == 1:
            measured = np.column_stack([np.full((len(measured), 2), np.nan), measured])
        if measured.shape[1:] != (3,):
            raise _wrong("forces", measured, "(n,), the normal force, or (n, 3)")
        measured = measured.ravel()
    return _recorded(_native.calibrate_recorded(design, frames, measured, uniform=False, name=name))


def calibrate_uniform(
    design: _native.Design,
    frames: npt.ArrayLike,
    pressures: npt.ArrayLike | str | os.PathLike[str],
    *,
    name: str | None = None,
) -> Recorded:
    """Taxels' gains, curve and dead taxels from frames under uniform pressure, of a bladder over all taxels.

    Pressures (n,) in pascals, NaN where one is not known; or the path of a file as `sptfra calibrate --pressures` reads it.
    """
    measured = _measured(pressures)
    if isinstance(measured, np.ndarray) and measured.ndim != 1:
        raise _wrong("pressures", measured, "(n,)")
    return _recorded(_native.calibrate_recorded(design, frames, measured, uniform=True, name=name))


def _measured(values: npt.ArrayLike | str | os.PathLike[str]) -> np.ndarray | str | os.PathLike[str]:
    """Numbers in double precision, NaN for masked ones; the path of a file as it is."""
    if isinstance(values, (str, os.PathLike)):
        return values
    return np.ma.filled(np.ma.asarray(values, np.float64), np.nan)


def _wrong(name: str, values: np.ndarray, wanted: str) -> ValueError:
    entries = "one entry a frame, NaN where it is not known"
    return ValueError(f"{name} of {values.ndim} axes; give an array of shape {wanted}, {entries}")


def _recorded(found: tuple[_native.Design, str, str]) -> Recorded:
    design, answer, page = found
    details = json.loads(answer)
    told = {name: tuple(details[name]) for name in ("determined", "undetermined", "remarks")}
    return Recorded(design=design, errors=details["errors"], page=page, details=details, **told)
