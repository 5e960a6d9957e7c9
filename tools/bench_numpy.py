#!/usr/bin/env python3
# SPDX-License-Identifier: MIT OR Apache-2.0
"""Frames a second of the paper's plan in numpy, beside those of `cargo xtask solver`: bench_numpy.py [--add] [SOLVER.json]

The sixteen products of the paper's list and the search along the line, for a batch of frames at a time, on one BLAS
thread, as somebody would write them down who has the matrices. These are random here: the time does not depend on what
they hold. SOLVER.json is what `cargo xtask solver --json` prints; of its designs with the paper's plan the ratio is printed.
With --add the frames a second are added to it, for the page of `cargo xtask bench --solver`.
"""

import argparse
import json
import os
import time
from pathlib import Path

for library in ("OPENBLAS", "OMP", "MKL", "BLIS", "VECLIB"):
    os.environ[f"{library}_NUM_THREADS"] = "1"

import numpy as np  # noqa: E402, after the number of its threads is said

FRAMES = 128  # of a batch, as golden has them
REPETITIONS = 7
SECONDS = 0.5  # of a repetition, at least
ALLOWANCE = 2.0**-9  # of sum |b|, above the least value
COMPONENTS = (1, 2, 3)


class Matrices:
    """m x m matrices of the method: C33^-1, C33, A_p and D_pq."""

    def __init__(self, taxels: int, random: np.random.Generator) -> None:
        def matrix() -> np.ndarray:
            return np.eye(taxels) + random.normal(scale=0.3 / np.sqrt(taxels), size=(taxels, taxels))

        self.inverse, self.c33 = matrix(), matrix()
        self.a = {p: matrix() for p in COMPONENTS}
        self.d = {(p, q): matrix() for p in COMPONENTS for q in range(3)}


def search(alpha: np.ndarray, beta: np.ndarray, allowance: np.ndarray) -> np.ndarray:
    """The middle of the level set of B(t) = sum max(0, alpha + t beta) on [-1, 1], of each column: bisection over knots."""

    def value(t: np.ndarray) -> np.ndarray:
        return np.maximum(alpha + t * beta, 0.0).sum(axis=0)

    def bisect(low: np.ndarray, high: np.ndarray, rises) -> np.ndarray:
        while (low < high).any():
            middle = (low + high) // 2
            up = rises(middle)
            low, high = np.where(up | (low >= high), low, middle + 1), np.where(up, middle, high)
        return low

    def at(index: np.ndarray) -> np.ndarray:
        return np.take_along_axis(knots, np.minimum(index, len(knots) - 1)[None], axis=0)[0]

    def slope_is_positive(index: np.ndarray) -> np.ndarray:
        middle = (at(index) + at(index + 1)) / 2
        return np.where(alpha + middle * beta > 0, beta, 0.0).sum(axis=0) >= 0

    ends = np.ones((1, alpha.shape[1]))
    knots = np.sort(np.concatenate([np.clip(-alpha / beta, -1, 1), -ends, ends]), axis=0)
    first, last = np.zeros(alpha.shape[1], dtype=int), np.full(alpha.shape[1], len(knots) - 1)
    optimum = bisect(first, last, slope_is_positive)
    level = value(at(optimum)) + allowance
    left = bisect(first, optimum, lambda index: value(at(index)) <= level)
    right = bisect(optimum, last, lambda index: value(at(index)) > level)

    def crossing(inside: np.ndarray, outside: np.ndarray) -> np.ndarray:
        low, high = value(inside), value(outside)
        share = (level - low) / np.where(high > low, high - low, 1.0)
        return inside + (outside - inside) * np.clip(share, 0, 1)

    left_end = crossing(at(left), at(np.maximum(left - 1, 0)))
    return (left_end + crossing(at(np.maximum(right - 1, 0)), at(right))) / 2


def solve(of: Matrices, places: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Forces (3, taxels, frames) of stresses (taxels, frames), with filters or without: the products are dense."""
    w = np.maximum(-(of.inverse @ b), 0.0)
    g = {(p, 0): of.a[p] @ b - of.d[p, 0] @ w for p in COMPONENTS}
    g |= {(p, q): of.d[p, q] @ w for p in COMPONENTS for q in (1, 2)}
    u0, u1, u2 = (of.c33 @ g[3, q] for q in range(3))
    # The direction of the push: from the centroid of the compression to that of the tension
    pressed, pulled = np.maximum(-b, 0.0), np.maximum(b, 0.0)
    direction = places @ pressed / pressed.sum(axis=0) - places @ pulled / pulled.sum(axis=0)
    along = direction / np.hypot(*direction)
    t = search(u0, along[0] * u1 + along[1] * u2, ALLOWANCE * np.abs(b).sum(axis=0))
    mu = along * t
    return np.stack([g[p, 0] + mu[0] * g[p, 1] + mu[1] * g[p, 2] for p in COMPONENTS])


def frames_per_second(taxels: int) -> float:
    """Median over the repetitions."""
    random = np.random.default_rng(0)
    of = Matrices(taxels, random)
    side = int(np.sqrt(taxels))
    places = np.stack([np.arange(taxels) % side, np.arange(taxels) // side]).astype(float)
    b = random.normal(loc=-1.0, size=(taxels, FRAMES))
    assert np.isfinite(solve(of, places, b)).all()
    rates = []
    for _ in range(REPETITIONS):
        start, batches = time.perf_counter(), 0
        while time.perf_counter() - start < SECONDS:
            solve(of, places, b)
            batches += 1
        rates.append(FRAMES * batches / (time.perf_counter() - start))
    return float(np.median(rates))


def main() -> None:
    """Prints a line for 100 taxels, or for each design of a file with the paper's plan."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--add", action="store_true", help="write the frames a second into SOLVER.json")
    parser.add_argument("solver", metavar="SOLVER.json", nargs="?", type=Path)
    arguments = parser.parse_args()
    if arguments.solver is None:
        if arguments.add:
            parser.error("--add needs the SOLVER.json that it writes to")
        print(f"numpy: {frames_per_second(100):,.0f} frames of 100 taxels a second in batches")
        return
    designs = json.loads(arguments.solver.read_text(encoding="utf-8"))
    for design in designs:
        if design["plan"] != "paper":
            continue
        rate = frames_per_second(design["taxels"])
        design["numpy_frames_per_second"] = rate
        golden = design["in_batches"]["frames_per_second"]
        print(f"{design['design']}: golden {golden:,.0f} frames a second in batches, numpy {rate:,.0f}: "
              f"{golden / rate:.1f} times as many")
    if arguments.add:
        arguments.solver.write_text(json.dumps(designs, indent=2) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
