#!/usr/bin/env python3
# SPDX-License-Identifier: MIT OR Apache-2.0
"""Standard error by a network on the whole frame: confidence_study.py SPTFRA OUT.csv

The network learns the size of a shipped design's error from kinds of contact and noises. It is judged on other contacts
of the same kinds. So it estimates how good a standard error can be that does not know the kind. Takes minutes.
"""

import os
import sys
import tempfile
from pathlib import Path

# The sums of a product depend on the number of threads.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np

from estimator_study import ROOT, SIDE, STRESS_SCALE, TAXELS, designs_hashes, noisy, scene, solved

KINDS = (
    "sliding", "tilted-along", "tilted-across", "held", "even-shear", "turned", "soft-edge", "hard-edge", "spinning",
    "large-taxels", "deeper", "shallower", "lower-poisson", "gain-spread", "mixed-inside",
)
DESIGNS = ("sensor1-fast", "sensor1-wide", "sensor2-fast", "sensor2-wide")
NOISES = (0.2, 0.5, 1.0, 2.0)
TRAINED, TRAINED_SEED, JUDGED, JUDGED_SEED = 400, 50_000, 200, 90_000
UNITS, STEPS, BATCH = 96, 6000, 256
# Logarithms of a variance over the mean one, as far as the network follows them.
REACH = 6.0

HEAD = """\
# Percent of errors of the tangential force within one and two standard errors, with one that a network predicts from the
# whole frame. The network has two layers of {units} units and knows the noise. It learns the size of the design's error
# from {trained} contacts of each kind at each noise, and is judged on {judged} others. Goal: 55 to 72, and 94 or more.
# noise: standard deviation in percent of the largest reading of a frame. The designs' own s: confidence.csv.
# command: python3 tools/confidence_study.py SPTFRA results/confidence-study.csv
# designs: {designs}
design,noise,kind,within_one,within_two
"""


def samples(sptfra, design, count, seed, folder):
    """Inputs (n, taxels + 1), errors in percent of the normal force, and numbers of noise and kind, of all frames."""
    random, inputs, found, labels = np.random.default_rng(seed), [], [], []
    for at, kind in enumerate(KINDS):
        frames, truth = scene(sptfra, design, kind, folder, count, seed)
        for level, noise in enumerate(NOISES):
            read = noisy(frames, 0.01 * noise, random)
            share = STRESS_SCALE * read / np.abs(read).sum(1, keepdims=True)
            inputs.append(np.c_[share, np.full(count, np.log(noise))])
            found.append(solved(sptfra, design, read, truth, folder))
            labels += [(level, at)] * count
    return np.concatenate(inputs), np.concatenate(found), np.array(labels)


def mirrored(inputs):
    """The frames and their mirror images, whose errors are as large."""
    frames, told = inputs[:, :TAXELS].reshape(-1, SIDE, SIDE), inputs[:, TAXELS:]
    images = (frames, frames[:, ::-1], frames[:, :, ::-1], frames[:, ::-1, ::-1])
    return np.concatenate([np.c_[image.reshape(-1, TAXELS), told] for image in images])


class Predictor:
    """Two layers of rectifiers that answer the logarithm of an error's variance, over the mean one."""

    def __init__(self, inputs, random):
        self.mean, self.spread = inputs.mean(0), inputs.std(0) + 0.02
        sizes = (inputs.shape[1], UNITS, UNITS, 1)
        self.weights = [
            (random.standard_normal((a + 1, b)) * (np.sqrt(1 / a) if b > 1 else 0)).astype(np.float32)
            for a, b in zip(sizes, sizes[1:])
        ]

    def scaled(self, inputs):
        return ((inputs - self.mean) / self.spread).astype(np.float32)

    def layers(self, values):
        """What each layer sees, its constant 1 last, and the answer."""
        inputs = []
        for weights in self.weights:
            inputs.append(np.c_[values, np.ones(len(values), np.float32)])
            values = np.maximum(inputs[-1] @ weights, 0) if weights.shape[1] > 1 else inputs[-1] @ weights
        return inputs, values[:, 0]

    def train(self, inputs, squares, random):
        """Adam on the likelihood of errors with two normal components."""
        inputs = self.scaled(inputs)
        moments = [[np.zeros_like(of) for of in self.weights] for _ in range(2)]
        for step in range(1, STEPS + 1):
            index = random.integers(0, len(inputs), BATCH)
            layers, answer = self.layers(inputs[index])
            # An error far above its variance pulls no more than one 20 times as large.
            slope = (1 - np.minimum(squares[index] * np.exp(-np.clip(answer, -REACH, REACH)), 20)) / BATCH
            back, rate = slope[:, None].astype(np.float32), 1e-3 * (1 + np.cos(np.pi * step / STEPS))
            for weights, layer, mean, square in reversed(list(zip(self.weights, layers, *moments))):
                gradient = layer.T @ back
                back = (back @ weights[:-1].T) * (layer[:, :-1] > 0)
                mean += 0.1 * (gradient - mean)
                square += 0.001 * (gradient**2 - square)
                length = np.sqrt(square / np.float32(1 - 0.999**step)) + np.float32(1e-8)
                weights -= np.float32(rate) * (mean / np.float32(1 - 0.9**step) / length + np.float32(0.01) * weights)

    def __call__(self, inputs):
        return np.exp(np.clip(self.layers(self.scaled(inputs))[1], -REACH, REACH))


def main() -> None:
    if len(sys.argv) != 3:
        sys.exit(__doc__.splitlines()[0])
    sptfra, out = sys.argv[1], Path(sys.argv[2])
    sizes = {"units": UNITS, "trained": TRAINED, "judged": JUDGED}
    lines = [HEAD.format(**sizes, designs=designs_hashes(sptfra, DESIGNS))]
    for name in DESIGNS:
        design, random = ROOT / f"designs/{name}.toml", np.random.default_rng(1)
        with tempfile.TemporaryDirectory() as folder:
            inputs, found, _ = samples(sptfra, design, TRAINED, TRAINED_SEED, Path(folder))
            judged, errors, labels = samples(sptfra, design, JUDGED, JUDGED_SEED, Path(folder))
        mean = (found**2).mean()
        inputs, squares = mirrored(inputs), np.tile(found**2 / mean, 4)
        predictor = Predictor(inputs, random)
        predictor.train(inputs, squares, random)
        over = errors / np.sqrt(mean * predictor(judged))
        for level, noise in enumerate(NOISES):
            for at, kind in enumerate(KINDS):
                of = over[(labels == (level, at)).all(1)]
                one, two = (100 * (of < limit).mean() for limit in (1, 2))
                lines.append(f"{name},{noise:g},{kind},{one:.0f},{two:.0f}\n")
        print(f"{name}: judged", flush=True)
    out.write_text("".join(lines))


if __name__ == "__main__":
    main()
