# SPDX-License-Identifier: MIT OR Apache-2.0
"""What a count is worth, and what each taxel's is, from recordings with measured forces or pressures."""

from __future__ import annotations

import json
import os

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
    return _recorded(_native.calibrate_forces(design, frames, forces, name=name))


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
    return _recorded(_native.calibrate_uniform(design, frames, pressures, name=name))


def _recorded(found: tuple[_native.Design, str, str]) -> Recorded:
    design, answer, page = found
    details = json.loads(answer)
    told = {name: tuple(details[name]) for name in ("determined", "undetermined", "remarks")}
    return Recorded(design=design, errors=details["errors"], page=page, details=details, **told)
