# SPDX-License-Identifier: MIT OR Apache-2.0
"""Three-axis forces on every taxel of a pressure array, from normal stress alone, and the hardware that finds them.

    import sptfra

    design = sptfra.Design.load("designs/sensor1-fast.toml")
    scene = sptfra.scene(design)
    forces = sptfra.Solver(design).solve(scene.frames)
    forces.resultant, forces.field, forces.status

Stress is in pascals and negative in compression, or in the sensor's counts where the design says so; forces are in
newtons, `F_z < 0` presses. Whatever is wrong with a design, a file or frames raises `sptfra.Error` or, for arrays,
`ValueError` and `TypeError`, with the text that the commands print.
"""

from importlib.metadata import version as _version

from ._native import Design, Error, FrameLines, Past, Solver, beyond, calibrate, check, load_frames, scene, unloaded
from .forces import Forces, Status
from .hardware import generate, plan, simulate
from .plot import plot_contacts, plot_field
from .recorded import calibrate_forces, calibrate_uniform
from .results import Beyond, Finding, Plan, Recorded, Scene, Simulation, Spread, Unloaded, errors

#: That of the package, which is that of the commands.
__version__ = _version("sptfra")

__all__ = [
    "Beyond",
    "Design",
    "Error",
    "Finding",
    "Forces",
    "FrameLines",
    "Past",
    "Plan",
    "Recorded",
    "Scene",
    "Simulation",
    "Solver",
    "Spread",
    "Status",
    "Unloaded",
    "__version__",
    "beyond",
    "calibrate",
    "calibrate_forces",
    "calibrate_uniform",
    "check",
    "errors",
    "generate",
    "load_frames",
    "plan",
    "plot_contacts",
    "plot_field",
    "scene",
    "simulate",
    "unloaded",
]
