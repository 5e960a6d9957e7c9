"""Contacts on the paper's prisms by finite elements: the frames in data/fe.

    apt-get install calculix-ccx
    .venv/bin/python tools/fe/make.py target/fe          # runs what is not there yet (hours), one thread
    .venv/bin/python tools/fe/make.py target/fe --write  # writes data/fe from what is there

A case is pressed down, then dragged; each increment of the drag is a frame, from held (partial slip) to sliding.
"""

import json
import math
import os
import sys
from pathlib import Path

import numpy as np

from prism import Model, Prism, block, cylinder, sphere

SENSORS = {
    "sensor1": Prism("sensor1", (40.0, 20.0, 3.0), (10, 10), (4.0, 2.0)),
    "sensor2": Prism("sensor2", (40.0, 40.0, 3.0), (10, 10), (4.0, 4.0)),
}
FRICTION = 0.5
PRESS_INCREMENTS, DRAG_INCREMENTS = 2, 5

# Name: sensor, indenter, centre in mm, Poisson's ratio, depth of the press in mm, drag in mm, its direction in degrees.
CASES = {
    "sphere-x": ("sensor1", sphere(15.0, 6.5), (20.0, 10.0), 0.49, 0.5, 0.6, 0.0),
    "block-tilted": ("sensor1", block((5.0, 4.0), (0.03, 0.0)), (20.6, 9.7), 0.49, 0.32, 0.6, 0.0),
    "sphere-45": ("sensor2", sphere(15.0, 6.5), (20.0, 20.0), 0.49, 0.5, 0.6, 45.0),
    "cylinder-turned": ("sensor1", cylinder(8.0, 6.0, 4.0, 30.0), (18.7, 10.4), 0.49, 0.4, 0.6, 120.0),
    "sphere-y": ("sensor1", sphere(15.0, 6.5), (20.0, 10.0), 0.49, 0.5, 0.6, 90.0),
    "block-2": ("sensor2", block((6.0, 6.0), (0.0, 0.02)), (21.3, 18.9), 0.49, 0.3, 0.6, 200.0),
    "sphere-border": ("sensor1", sphere(15.0, 6.5), (32.0, 6.5), 0.49, 0.5, 0.6, -30.0),
    "sphere-045": ("sensor2", sphere(15.0, 6.5), (18.4, 21.5), 0.45, 0.5, 0.6, 250.0),
}
# Size of elements near the contact and elsewhere in mm, and the planes between the layers of elements.
MESH = (4.0 / 3.0, 4.0, (0.0, 0.8, 1.8, 3.0))
# The first case once more on other meshes.
MESHES = {
    "mesh-coarse": (2.0, 4.0, (0.0, 1.2, 3.0)),
    "mesh-fine": (1.0, 2.0, (0.0, 0.5, 1.2, 2.0, 3.0)),
}
NEAR = 7.5


def planes(side, centre, fine, coarse):
    """Planes between elements along an axis: fine ones where the indenter touches."""
    near = [p for p in np.arange(0.0, side + 1e-9, fine) if abs(p - centre) <= NEAR]
    far = [p for p in np.arange(0.0, side + 1e-9, coarse) if not near[0] - 0.3 < p < near[-1] + 0.3]
    return np.array(sorted({0.0, side} | set(np.round(near + far, 9))))


def moves(depth, drag, angle):
    x, y = (drag * math.cos(math.radians(angle)), drag * math.sin(math.radians(angle)))
    return [((0.0, 0.0, -depth), PRESS_INCREMENTS), ((x, y, -depth), DRAG_INCREMENTS)]


def run(out, name, case, mesh):
    """The increments of a case, from its file in `out` if that is there."""
    kept = out / f"{name}.json"
    if not kept.exists():
        sensor, indenter, centre, poisson, depth, drag, angle = case
        prism = SENSORS[sensor]
        lines = [planes(prism.size[axis], centre[axis], mesh[0], mesh[1]) for axis in (0, 1)] + [np.array(mesh[2])]
        model = Model(prism, lines, indenter, centre, poisson, FRICTION)
        print(f"{name}: {len(model.nodes)} nodes", flush=True)
        command = ["nice", "-n", "15", "env", "OMP_NUM_THREADS=1", "ccx", "-i"]
        increments = model.run(out, name, moves(depth, drag, angle), command)
        kept.write_text(json.dumps({"elements": model.mesh, "nodes": len(model.nodes), "increments": increments}))
    return json.loads(kept.read_text())


def main():
    out = Path(sys.argv[1]).absolute()
    os.makedirs(out, exist_ok=True)
    for name in sys.argv[2:] or [*CASES, *MESHES]:
        case, mesh = (CASES[name], MESH) if name in CASES else (CASES["sphere-x"], MESHES[name])
        for time, force, stress in run(out, name, case, mesh)["increments"]:
            print(f"{name} {time:.3f}", np.round(force, 4), round(min(stress)), round(max(stress)), flush=True)


if __name__ == "__main__":
    main()
