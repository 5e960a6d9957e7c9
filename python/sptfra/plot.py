# SPDX-License-Identifier: MIT OR Apache-2.0
"""Pictures of forces, by matplotlib."""

from __future__ import annotations

from typing import Any

import numpy as np

from ._native import Design
from .forces import Forces


def pyplot() -> Any:
    """`matplotlib.pyplot`, which is no dependency of all. Raises `ImportError` that says how to get it."""
    try:
        import matplotlib.pyplot
    except ImportError as error:
        raise ImportError("pictures need matplotlib: pip install 'sptfra[plot]'") from error
    return matplotlib.pyplot


def plot_field(design: Design, forces: Forces, index: int = 0, ax: Any = None) -> Any:
    """Draws a frame's forces on the grid in millimetres: normal forces as colours, tangential ones as arrows.

    Returns the matplotlib axes, `ax` if given. The arrow above the grid is the scale: the largest tangential force of a
    taxel. Raises `ImportError` without matplotlib and `ValueError` where the forces have no field or there is no such
    frame.
    """
    plt = pyplot()
    if forces.field is None:
        raise ValueError("the forces have no field: the design puts out resultants only, or they are a scene's truth")
    if not -len(forces) <= index < len(forces):
        raise ValueError(f"there is no frame {index} of {len(forces)}")
    field = np.asarray(forces.field[index], dtype=float)
    if field.shape[:2] != (design.rows, design.columns):
        raise ValueError(
            f"forces of {field.shape[0]} rows of {field.shape[1]} taxels, the design {design.name} has {design.rows} of "
            f"{design.columns}; give the design that they are of"
        )
    if ax is None:
        _, ax = plt.subplots()
    pitch_x, pitch_y = design.pitch_mm
    x, y = np.arange(design.columns) * pitch_x, np.arange(design.rows) * pitch_y
    edges = (x[0] - pitch_x / 2, x[-1] + pitch_x / 2, y[0] - pitch_y / 2, y[-1] + pitch_y / 2)
    # Pressing is blue and pulling red, zero is white.
    largest = float(np.abs(field[..., 2]).max()) or 1.0
    image = ax.imshow(
        -field[..., 2], origin="lower", extent=edges, cmap="RdBu", vmin=-largest, vmax=largest, interpolation="nearest"
    )
    ax.figure.colorbar(image, ax=ax, label="pressing force of a taxel, $-f_z$ in N", shrink=0.6)
    shear = np.hypot(field[..., 0], field[..., 1])
    longest = float(shear.max())
    if longest > 0.0:
        # The longest arrow is as long as a taxel is wide, one and a half times.
        scale = longest / (1.5 * min(pitch_x, pitch_y))
        arrows = ax.quiver(
            x, y, field[..., 0], field[..., 1], angles="xy", scale_units="xy", scale=scale, pivot="mid", width=0.004,
            edgecolor="white", linewidth=0.4,
        )
        ax.quiverkey(arrows, 0.8, 1.05, longest, f"{longest:.3g} N", labelpos="E")
    ax.set(xlabel="x in mm", ylabel="y in mm", aspect="equal")
    force = forces.resultant[index]
    names = ", ".join(forces.names(index)).lower().replace("_", " ") or "good"
    ax.set_title(f"F = ({force[0]:.2f}, {force[1]:.2f}, {force[2]:.2f}) N, {names}", loc="left", fontsize="medium")
    return ax
