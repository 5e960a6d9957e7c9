# SPDX-License-Identifier: MIT OR Apache-2.0
"""Shows the forces of frames as they come: `some-sensor | python -m sptfra.live DESIGN`.

A frame is a line, as in a file of frames: on standard input, or from a socket (`--connect`, `--listen`). Prints a line for
each, or draws the force field in a window.
"""

from __future__ import annotations

import argparse
import math
import re
import socket
import sys
import time
from collections.abc import Iterable
from typing import BinaryIO

import numpy as np

from ._native import Design, Error, FrameLines, Past, Solver, check
from .forces import Forces
from .plot import plot_field, pyplot

#: Seconds between drawings; frames between them are solved, not drawn.
PAUSE = 0.05
#: So many frames are looked at, whether they are wrong.
LOOKED_AT = 32


def line_of(number: int, forces: Forces) -> str:
    """A frame's forces for people."""
    x, y, z = forces.resultant[0]
    names = ", ".join(forces.names(0)).lower().replace("_", " ") or "good"
    # Without the sign of a zero.
    x, y, z = (round(value, 3) + 0.0 for value in (x, y, z))
    degrees = round(math.degrees(forces.direction[0]), 1) + 0.0
    return f"{number:>6}  F = ({x:8.3f}, {y:8.3f}, {z:8.3f}) N  mu = {forces.friction[0]:5.3f}  phi = {degrees:6.1f}°  {names}"


def has_display() -> bool:
    """Whether matplotlib can open a window here. Without a display it draws into memory and shows nothing."""
    plt = pyplot()
    figure = plt.figure()
    shows = type(figure.canvas.manager).show
    plt.close(figure)
    return shows is not plt.FigureManagerBase.show


class Window:
    """The force field of the last frame."""

    def __init__(self, design: Design):
        self._pyplot, self._design = pyplot(), design
        self._drawn = -math.inf
        self._waiting: Forces | None = None
        self._figure = self._pyplot.figure()
        self._pyplot.ion()
        self._figure.show()

    def show(self, forces: Forces) -> None:
        """Draws the frame, unless one was drawn just now."""
        self._waiting = forces
        if time.monotonic() >= self._drawn + PAUSE:
            self._draw()

    def hold(self) -> None:
        """Draws the last frame and leaves it there until the user closes the window."""
        self._draw()
        self._pyplot.ioff()
        self._pyplot.show()

    def _draw(self) -> None:
        if self._waiting is None:
            return
        self._figure.clear()
        plot_field(self._design, self._waiting, ax=self._figure.add_subplot())
        self._figure.canvas.draw_idle()
        self._figure.canvas.flush_events()
        self._drawn, self._waiting = time.monotonic(), None


def warn(design: Design, frames: list[np.ndarray]) -> None:
    """Says what is suspicious in the first frames."""
    for finding in check(design, np.array(frames)):
        print(f"warning: {finding}", file=sys.stderr, flush=True)


def is_cut(message: str) -> bool:
    """Whether a line is wrong as one is that was cut off at its beginning."""
    ends = re.search(r"ends at column (\d+) where (\d+) values", message)
    return ", column 1: " in message if ends is None else int(ends[1]) < int(ends[2])


def run(design: Design, lines: Iterable[bytes], origin: str, labels: int, window: Window | None) -> None:
    """Solves the frame of each line and shows its forces."""
    reader, solver = FrameLines(design, labels=labels, origin=origin), Solver(design)
    number, forces, first = 0, None, []
    past = Past()
    cut = None
    for index, line in enumerate(lines):
        try:
            frame = reader.frame(line)
        except Error as error:
            # Who opens a port while a frame goes through it gets the end of one.
            if index > 0 or not is_cut(str(error)):
                raise
            print(f"warning: {error}; the first line is passed over", file=sys.stderr, flush=True)
            cut = error
            continue
        if frame is None:
            continue
        if number < LOOKED_AT:
            first.append(frame)
        if number + 1 == LOOKED_AT:
            warn(design, first)
        forces = solver.solve(frame, slips=forces, past=past)
        if window is None:
            print(line_of(number, forces), flush=True)
        else:
            window.show(forces)
        number += 1
    if number == 0 and cut is not None:
        raise cut
    if 0 < number < LOOKED_AT:
        warn(design, first)
    if window is not None:
        window.hold()


def place(text: str) -> tuple[str, int]:
    """Host and port of `HOST:PORT`; without a host, this machine."""
    host, _, port = text.rpartition(":")
    if not port.isdecimal() or int(port) > 65535:
        raise argparse.ArgumentTypeError(f"{text!r}: write HOST:PORT, or a port of this machine alone")
    return host.strip("[]") or "localhost", int(port)


def stream(options: argparse.Namespace) -> tuple[BinaryIO, str]:
    """Where the lines come from, and what messages call it."""
    if options.connect is not None:
        with socket.create_connection(options.connect) as connection:
            return connection.makefile("rb"), "{}:{}".format(*options.connect)
    if options.listen is not None:
        with socket.create_server(options.listen) as server:
            host, port = server.getsockname()[:2]
            print(f"waiting for frames at {host}:{port}", file=sys.stderr, flush=True)
            connection, sender = server.accept()
        with connection:
            return connection.makefile("rb"), "{}:{}".format(*sender[:2])
    return sys.stdin.buffer, "standard input"


def main(arguments: list[str] | None = None) -> int:
    """The command; its exit code."""
    parser = argparse.ArgumentParser(prog="python -m sptfra.live", description=__doc__)
    parser.add_argument("design", metavar="DESIGN", help="design file (TOML)")
    parser.add_argument("--labels", type=int, default=0, metavar="N", help="columns of labels before the values of a frame")
    parser.add_argument("--plot", action="store_true", help="a window in place of lines, by matplotlib")
    source = parser.add_mutually_exclusive_group()
    source.add_argument("--connect", type=place, metavar="HOST:PORT", help="read from a TCP server that sends the lines")
    source.add_argument("--listen", type=place, metavar="[HOST:]PORT", help="wait for one that connects and sends them")
    options = parser.parse_args(arguments)
    try:
        design = Design.load(options.design)
        if options.plot and not has_display():
            raise Error("--plot: there is no display for a window; set DISPLAY, or leave out --plot to print lines")
        window = Window(design) if options.plot else None
        lines, origin = stream(options)
        run(design, lines, origin, options.labels, window)
    except (ImportError, ValueError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    except (KeyboardInterrupt, BrokenPipeError):
        # The user has seen enough, or the reader has gone.
        sys.stderr.close()
    except OSError as error:
        print(f"error: {error}; is there somebody at the other end, and is the port free?", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
