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

    Returns the matplotlib axes, `ax` if given. The title's second line is the scale of the arrows: the largest
    tangential force of a taxel. Raises `ImportError` without matplotlib and `ValueError` where the forces have no field or there is no such
    frame.
    """
    plt = pyplot()
    if forces.field is None:
        raise ValueError("the forces have no field: the design puts out resultants only, or they are a scene's truth")
    _has(forces, index)
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
    edges = _edges(design)
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
        ax.quiver(
            x, y, field[..., 0], field[..., 1], angles="xy", scale_units="xy", scale=scale, pivot="mid", width=0.004,
            edgecolor="white", linewidth=0.4,
        )
    _label(ax, forces, index, f"\nlongest arrow: {longest:.3g} N")
    return ax


def plot_contacts(design: Design, forces: Forces, index: int = 0, ax: Any = None) -> Any:
    """Draws the contacts of a frame on the grid in millimetres, of a design with `contacts` of 2 or more.

    A dot is a contact's centre, as wide as its normal force is large, an arrow its tangential force; the circle around the
    arrow's tip is its standard error, where the design states one. Returns the matplotlib axes, `ax` if given. Raises
    `ImportError` without matplotlib and `ValueError` where no contacts are known or there is no such frame.
    """
    plt = pyplot()
    if forces.records is None:
        raise ValueError(
            f"the forces have no contacts: write contacts = 2, or more, under [algorithm] of {design.name}, or draw plot_field"
        )
    _has(forces, index)
    if ax is None:
        _, ax = plt.subplots()
    left, right, low, high = _edges(design)
    ax.add_patch(plt.Rectangle((left, low), right - left, high - low, fill=False, edgecolor="0.6"))
    contacts = forces.records[index]
    # What is true of a scene is known of no taxels.
    contacts = contacts[contacts["F_z"] != 0.0]
    largest = float(np.abs(contacts["F_z"]).max(initial=0.0)) or 1.0
    # The longest arrow is a third of the grid's shorter side.
    longest = float(np.hypot(contacts["F_x"], contacts["F_y"]).max(initial=0.0)) or 1.0
    scale = min(right - left, high - low) / (3.0 * longest)
    for number, contact in enumerate(contacts):
        x, y = 1e3 * contact["x"], 1e3 * contact["y"]
        tip = (x + scale * contact["F_x"], y + scale * contact["F_y"])
        colour = f"C{number}"
        ax.scatter([x], [y], s=200.0 * abs(contact["F_z"]) / largest, color=colour, alpha=0.6)
        ax.annotate("", tip, (x, y), arrowprops={"arrowstyle": "->", "color": colour, "shrinkA": 0, "shrinkB": 0})
        if contact["standard_error"] > 0.0:
            ax.add_patch(plt.Circle(tip, scale * contact["standard_error"], fill=False, edgecolor=colour, linestyle=":"))
        ax.annotate(
            f"{abs(contact['F_z']):.2f} N, µ {contact['mu']:.2f}",
            (x, y),
            (6, -14),
            textcoords="offset points",
            fontsize="small",
        )
    ax.set(xlim=(left, right), ylim=(low, high))
    _label(ax, forces, index)
    return ax


def _has(forces: Forces, index: int) -> None:
    if not -len(forces) <= index < len(forces):
        raise ValueError(f"there is no frame {index} of {len(forces)}")


def _edges(design: Design) -> tuple[float, float, float, float]:
    """Left, right, lower and upper edge of the grid in mm from the first taxel."""
    pitch_x, pitch_y = design.pitch_mm
    return (-pitch_x / 2, (design.columns - 0.5) * pitch_x, -pitch_y / 2, (design.rows - 0.5) * pitch_y)


def _label(ax: Any, forces: Forces, index: int, scale: str = "") -> None:
    ax.set(xlabel="x in mm", ylabel="y in mm", aspect="equal")
    force = forces.resultant[index]
    names = ", ".join(forces.names(index)).lower().replace("_", " ") or "good"
    ax.set_title(f"F = ({force[0]:.2f}, {force[1]:.2f}, {force[2]:.2f}) N, {names}{scale}", loc="left", fontsize="medium")
