# SPDX-License-Identifier: MIT OR Apache-2.0
"""From a recording to forces to hardware: recording.py [--picture FILE]

The recording is that of a mat of 1,728 taxels under a lying person, raw counts, which comes with the project.
"""

import argparse
from pathlib import Path

import numpy as np
import sptfra

ROOT = Path(__file__).resolve().parents[2]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--picture", help="draw the frame with the largest force into this file")
    options = parser.parse_args()

    # What the sensor is, and what it recorded: two columns of labels, then a count of each taxel.
    design = sptfra.Design.load(ROOT / "designs" / "bed-mat.toml")
    frames = sptfra.load_frames(ROOT / "data" / "bed_mat_64x27.csv", design, labels=2)
    print(f"{design.name}: {len(frames)} frames of {design.rows} x {design.columns} taxels")

    # Is anything wrong with it?
    for finding in sptfra.check(design, frames):
        print(f"{finding.kind}: {finding}")

    # The forces, in f64 on this computer.
    forces = sptfra.Solver(design).solve(frames)
    normal = -forces.resultant[:, 2]
    loaded = ~forces.has(sptfra.Status.NO_CONTACT)
    print(f"{loaded.sum()} frames with a person: {normal[loaded].min():.0f} to {normal[loaded].max():.0f} N")
    print(f"{forces.has(sptfra.Status.DIRECTION_UNKNOWN).sum()} frames have no direction: the mat reads no tension")

    # The same in hardware.
    plan = sptfra.plan(design)
    print(
        f"in hardware: {plan.latency_cycles} cycles, {plan.latency_us:.0f} us, {plan.frames_per_second:.0f} frames a second "
        f"on {plan.dsp} DSP and {plan.bram36} RAMB36"
    )

    if options.picture:
        axes = sptfra.plot_field(design, forces, int(np.argmax(normal)))
        axes.figure.savefig(options.picture, dpi=150)


if __name__ == "__main__":
    main()
