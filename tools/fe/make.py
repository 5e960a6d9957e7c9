# SPDX-License-Identifier: MIT OR Apache-2.0
"""Contacts on the paper's prisms by finite elements: the frames in data/fe.

    apt-get install calculix-ccx
    .venv/bin/python tools/fe/make.py target/fe          # runs what is not there yet (an hour or two), one thread
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

# Name: sensor, indenter, centre in mm, Young's modulus in MPa, Poisson's ratio, depth of the press in mm, drag in mm, its
# direction in degrees. Stress scales with Young's modulus: it is chosen for some tens of kilopascals. What matters is the
# depth of the press: 0.12 mm of 3 mm is a layer as linear theory has it, 0.5 mm is a soft one.
CASES = {
    "sphere-soft": ("sensor1", sphere(15.0, 6.5), (20.0, 10.0), 0.4, 0.49, 0.5, 0.6, 0.0),
    "sphere-x": ("sensor1", sphere(100.0, 7.0), (20.0, 10.0), 1.2, 0.49, 0.12, 0.15, 0.0),
    "sphere-30": ("sensor1", sphere(100.0, 7.0), (18.7, 10.4), 1.2, 0.49, 0.12, 0.15, 30.0),
    "cylinder-turned": ("sensor1", cylinder(60.0, 6.5, 4.0, 30.0), (18.7, 10.4), 1.2, 0.49, 0.10, 0.15, 120.0),
    "block-tilted": ("sensor1", block((5.0, 4.0), (0.01, 0.0), 1.0), (20.6, 9.7), 1.2, 0.49, 0.08, 0.15, 0.0),
    "block-flat": ("sensor1", block((5.0, 4.0), (0.0, 0.0), 1.0), (19.3, 10.4), 1.2, 0.49, 0.08, 0.15, 30.0),
    "sphere-2": ("sensor2", sphere(100.0, 7.0), (20.0, 20.0), 1.2, 0.49, 0.12, 0.15, 45.0),
    "sphere-2-045": ("sensor2", sphere(150.0, 8.5), (18.4, 21.5), 1.2, 0.45, 0.12, 0.15, 250.0),
    "cylinder-2": ("sensor2", cylinder(60.0, 8.0, 5.0, 70.0), (21.3, 18.9), 1.2, 0.49, 0.10, 0.15, 200.0),
    "sphere-2-soft": ("sensor2", sphere(15.0, 6.5), (19.0, 21.0), 0.4, 0.49, 0.5, 0.6, 0.0),
}

# Size of elements near the contact and elsewhere in mm, and the planes between the layers of elements.
MESH = (4.0 / 3.0, 4.0, (0.0, 0.8, 1.8, 3.0))
COARSE = (2.0, 4.0, (0.0, 1.2, 3.0))
# Cases once more on other meshes: a body pressed hard, one on the other sensor, and one with an edge, on a finer one, too.
MESHES = {
    "sphere-soft-coarse": ("sphere-soft", COARSE),
    "sphere-2-coarse": ("sphere-2", COARSE),
    "block-flat-coarse": ("block-flat", COARSE),
    "block-flat-finer": ("block-flat", (1.0, 4.0, MESH[2])),
}
NEAR = 9.0


def planes(side, centre, fine, coarse):
    """Planes between elements along an axis: fine ones where the indenter touches."""
    near = [p for p in np.arange(0.0, side + 1e-9, fine) if abs(p - centre) <= NEAR]
    far = [p for p in np.arange(0.0, side + 1e-9, coarse) if not near[0] - 0.3 < p < near[-1] + 0.3]
    return np.array(sorted({0.0, side} | set(np.round(near + far, 9))))


def moves(depth, drag, angle):
    x, y = (drag * math.cos(math.radians(angle)), drag * math.sin(math.radians(angle)))
    return [((0.0, 0.0, -depth), PRESS_INCREMENTS), ((x, y, -depth), DRAG_INCREMENTS)]


def done(status):
    """Whether CalculiX came to the end of both steps; one that was stopped early has said nothing yet."""
    last = (status.read_text().splitlines() or [""])[-1].split()
    return last[:1] == ["2"] and float(last[5]) == 1.0


def run(out, name, case, mesh):
    """The increments of a case, from its file in `out` if that is there."""
    kept = out / f"{name}.json"
    if not kept.exists():
        sensor, indenter, centre, young, poisson, depth, drag, angle = case
        prism = SENSORS[sensor]
        lines = [planes(prism.size[axis], centre[axis], mesh[0], mesh[1]) for axis in (0, 1)] + [np.array(mesh[2])]
        model = Model(prism, lines, indenter, centre, young, poisson, FRICTION)
        print(f"{name}: {len(model.nodes)} nodes", flush=True)
        command = ["nice", "-n", "15", "env", "OMP_NUM_THREADS=1", "ccx", "-i"]
        if (out / f"{name}.sta").exists() and done(out / f"{name}.sta"):
            increments = model.read(out / f"{name}.dat")
        else:
            increments = model.run(out, name, moves(depth, drag, angle), command)
        kept.write_text(json.dumps({"elements": model.mesh, "nodes": len(model.nodes), "increments": increments}))
    return json.loads(kept.read_text())


def kept(out, name):
    """What is there of a case, or nothing."""
    file = out / f"{name}.json"
    return json.loads(file.read_text()) if file.exists() else None


def write(out):
    """Frames and true forces of each sensor, and a list of the cases, in data/fe."""
    folder = Path(__file__).resolve().parents[2] / "data" / "fe"
    folder.mkdir(parents=True, exist_ok=True)
    rows = ["frames,frame,case,poisson,press_mm,drag_mm,direction_deg,elements,nodes"]
    for sensor, prism in SENSORS.items():
        frames, forces = [], []
        for name, (of, _, _, _, poisson, depth, drag, angle) in CASES.items():
            found = kept(out, name)
            if of != sensor or found is None:
                continue
            for time, force, stress in found["increments"]:
                # The press before its end is no case of its own; its end is a contact without tangential force.
                if time < 1.0:
                    continue
                x, y, z = force
                mu, phi = math.hypot(x, y) / -z, math.atan2(y, x)
                rows.append(
                    f"{sensor}.csv,{len(frames)},{name},{poisson},{depth},{drag * (time - 1.0):.3f},{angle},"
                    f"{'x'.join(map(str, found['elements']))},{found['nodes']}"
                )
                forces.append(",".join(["0"] + [f"{v:.6g}" for v in (x, y, z, mu, phi, x / -z, y / -z)]))
                frames.append(",".join(f"{value:.1f}" for value in stress))
        (folder / f"{sensor}.csv").write_text("\n".join(frames) + "\n")
        (folder / f"{sensor}.forces.csv").write_text("\n".join(forces) + "\n")
        (nx, ny), (sx, sy) = prism.taxels, prism.pitch
        (folder / f"{sensor}.sensor.toml").write_text(
            "# The sensor of the frames beside this file; who reads them compares it with the design.\n"
            f"[sensor]\ncolumns = {nx}\nrows = {ny}\npitch_mm = [{sx}, {sy}]\ndepth_mm = {prism.size[2]}\n"
        )
    (folder / "cases.csv").write_text("\n".join(rows) + "\n")
    for name, (case, _) in MESHES.items():
        again, first = kept(out, name), kept(out, case)
        if again and first:
            at = {time: rest for time, *rest in first["increments"]}
            for time, force, stress in again["increments"]:
                if time not in at:
                    continue
                other, reference = at[time]
                peak, far = max(map(abs, reference)), np.abs(np.array(stress) - reference)
                print(f"{name} {time:.1f}: force", np.round(np.array(force) - other, 4),
                      f"N, stress max {100 * far.max() / peak:.1f} %, rms {100 * np.sqrt((far**2).mean()) / peak:.1f} % of the peak")


def main():
    out = Path(sys.argv[1]).absolute()
    if sys.argv[2:] == ["--write"]:
        write(out)
        return
    os.makedirs(out, exist_ok=True)
    for name in sys.argv[2:] or [*CASES, *MESHES]:
        case, mesh = MESHES.get(name, (name, MESH))
        for time, force, stress in run(out, name, CASES[case], mesh)["increments"]:
            print(f"{name} {time:.3f}", np.round(force, 4), round(min(stress)), round(max(stress)), flush=True)


if __name__ == "__main__":
    main()
