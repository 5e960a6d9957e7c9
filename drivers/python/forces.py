# SPDX-License-Identifier: MIT OR Apache-2.0
"""Frames in, forces out, on the board or on the desk:

    forces.py NAME_BOARD.bit FRAMES.csv       on a PYNQ image, as root
    forces.py core.so FRAMES.csv              the simulated core that `sptfra build DESIGN` names
    forces.py ... --plot forces.png           F_x, F_y and F_z over the frames, with matplotlib
    forces.py ... --metadata metadata.json    of a core without registers (control = false): what the design is
    forces.py ... --queue 64                  batches of so many frames, by a DMA with descriptors
"""

import argparse
import sys

import numpy as np

from sptfra_board import Sptfra


def opened(path, metadata, queue):
    """The core behind a bitstream, or the simulated one; with metadata, one without registers."""
    if path.endswith(".so"):
        from sptfra_desk import Overlay, allocate

        overlay = Overlay(path, registers=metadata is None, queue=queue > 0)
    else:
        from pynq import Overlay, allocate

        overlay = Overlay(path)
    core = overlay.core if metadata is None else None
    return Sptfra(core, overlay.dma, allocate, metadata, queue)


def plot(forces, path):
    """Writes the resultants over the frames as a picture."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(layout="constrained")
    for index, name in enumerate(("F_x", "F_y", "F_z")):
        axes.plot(forces.resultant[:, index], label=name)
    axes.set_xlabel("frame")
    axes.set_ylabel(f"force ({forces.units['resultant']})")
    axes.legend()
    figure.savefig(path)


def read(path):
    """The frames of a file; the numbers of its columns, as pandas writes them above, are none."""
    frames = np.loadtxt(path, delimiter=",", ndmin=2)
    if frames.shape[1] > 3 and any(np.array_equal(frames[0], first + np.arange(frames.shape[1])) for first in (0, 1)):
        print("line 1: the columns' numbers: read as a header", file=sys.stderr)
        return frames[1:]
    return frames


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("core")
    arguments.add_argument("frames")
    arguments.add_argument("--plot", metavar="FILE")
    arguments.add_argument("--metadata", metavar="FILE")
    arguments.add_argument("--queue", metavar="FRAMES", type=int, default=0)
    wanted = arguments.parse_args()
    try:
        forces = opened(wanted.core, wanted.metadata, wanted.queue).reconstruct(read(wanted.frames))
    except (OSError, RuntimeError, ValueError) as error:
        sys.exit(f"error: {error}")
    print("frame,F_x,F_y,F_z,mu,phi,status")
    for index, number in enumerate(forces.number):
        values = [*forces.resultant[index], forces.friction[index], forces.direction[index]]
        shown = (f"{value:.9g}" for value in values)
        words = (name.lower().replace("_", " ") for name in forces.names(index))
        print(number, *shown, "; ".join(words), sep=",")
    if wanted.plot:
        plot(forces, wanted.plot)


if __name__ == "__main__":
    main()
