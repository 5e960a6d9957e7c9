#!/usr/bin/env python3
# SPDX-License-Identifier: MIT OR Apache-2.0
"""Estimators of the tangential force under noise, compared: estimator_study.py SPTFRA OUT.csv

Contacts that no training draws, from `sptfra scene`, with noise of 0.2 to 2 % of the largest reading. Beside the
shipped designs stand candidates that are trained here, and a parametric fit. Takes half an hour.
"""

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

# The sums of a product depend on the number of threads.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
PITCHES_MM = {1: (4.0, 2.0), 2: (4.0, 4.0)}
SIDE, DEPTH, POISSON = 10, 3e-3, 0.49
TAXELS = SIDE * SIDE
NOISES, DRAWS = (0.2, 0.5, 1.0, 2.0), 10
CONTACTS, SEED = 200, 90_000
SAMPLES, STEPS, BATCH, UNITS, MANY_UNITS, MANY_SAMPLES = 40_000, 4000, 256, 64, 256, 200_000
NOISE = 0.01
# The network on the frame alone: units of its layers, and steps of training.
DEEP, DEEP_STEPS, DEEP_BATCH = (256, 256, 256), 20_000, 512
# Constants of the grid search in golden/src/estimators/joint.
DEAD_ZONE = LEVEL = 1 / 256
LARGEST, STRESS_SCALE = 0.25, 16.0
GRID = 0.25 * np.arange(-6, 7)


def bessel():
    """J0 and J1 on a table, by the mean over a circle."""
    x, angles = np.arange(0, 720, 0.005), (np.arange(400) + 0.5) * np.pi / 400
    j0, j1 = np.zeros_like(x), np.zeros_like(x)
    for angle in angles:
        j0 += np.cos(x * np.sin(angle)) / len(angles)
        j1 += np.cos(angle - x * np.sin(angle)) / len(angles)
    return lambda at: np.interp(at, x, j0), lambda at: np.interp(at, x, j1)


def transfer(kh):
    """H_P and H_Q of a layer that is bonded to a rigid base, at wave number times depth."""
    both = np.empty((2, len(kh)))
    for index, k in enumerate(kh):

        def derivatives(z, n, k=k):
            down, up = np.exp(-k * z), np.exp(k * (z - 1))
            linear = [z if n == 0 else s**n * z + n * s ** (n - 1) for s in (-k, k)]
            return np.array([(-k) ** n * down, linear[0] * down, k**n * up, linear[1] * up])

        rows = [
            derivatives(0, 0) * k * k,
            derivatives(0, 1) * k,
            ((1 - POISSON) * derivatives(1, 2) + POISSON * k * k * derivatives(1, 0)) / k**2,
            ((1 - POISSON) * derivatives(1, 3) - (2 - POISSON) * k * k * derivatives(1, 1)) / k**3,
        ]
        both[:, index] = k * k * (derivatives(1, 0) @ np.linalg.solve(np.array(rows), np.eye(4)[:, :2]))
    return both


class Layer:
    """Stress under round contacts of 1 N, from a table over radius and distance: Hertz's pressure, and an even one."""

    def __init__(self, pitch_mm):
        self.pitch = np.array(pitch_mm) * 1e-3
        places = np.arange(TAXELS)
        self.x, self.y = (places % SIDE) * self.pitch[0], (places // SIDE) * self.pitch[1]
        far, pitch = (SIDE - 1) * self.pitch, self.pitch.max()
        # As golden/src/calibrate/contacts.rs has the radii.
        self.radii = np.array([1.1 * pitch, max(1.1 * pitch, min(2.75 * pitch, 0.6 * far.min()))])
        self.table_radii = np.linspace(0.8 * self.radii[0], 1.15 * self.radii[1], 240)
        self.distances = np.linspace(0, 0.062, 1400)
        waves = np.linspace(1e-6, 30 / DEPTH, 4001)
        weights = np.where(np.arange(4001) % 2 == 1, 4.0, 2.0)
        weights[[0, -1]] = 1.0
        weights *= (waves[1] - waves[0]) / 3 * waves / (2 * np.pi)
        press, push = transfer(np.maximum(waves * DEPTH, 1e-3))
        j0, j1 = bessel()
        along = np.outer(self.distances, waves)
        normal, tangential = -j0(along) * (weights * press), -j1(along) * (weights * push)
        across = np.maximum(np.outer(waves, self.table_radii), 1e-3)
        pressures = [3 * (np.sin(across) - across * np.cos(across)) / across**3, 2 * j1(across) / across]
        self.tables = [((normal @ of).T.ravel(), (tangential @ of).T.ravel()) for of in pressures]

    def unit(self, shape, centre, radius):
        """(n, taxels, 3): stress of 1 N that presses, and of 1 N along x and along y."""
        dx, dy = self.x - centre[:, :1], self.y - centre[:, 1:]
        distance = np.hypot(dx, dy)

        def place(value, of):
            at = np.clip((value - of[0]) / (of[1] - of[0]), 0, len(of) - 1.001)
            return at.astype(int), at % 1.0

        (row, row_share), (column, share) = place(radius[:, None], self.table_radii), place(distance, self.distances)
        width, found = len(self.distances), []
        for table in self.tables[shape]:
            near, next_row = table[row * width + column], table[(row + 1) * width + column]
            near = near + share * (table[row * width + column + 1] - near)
            next_row = next_row + share * (table[(row + 1) * width + column + 1] - next_row)
            found.append(near + row_share * (next_row - near))
        distance = np.maximum(distance, 1e-9)
        return np.stack([found[0], found[1] * dx / distance, found[1] * dy / distance], -1)

    def contacts(self, count, random):
        """Frames of contacts as the training set `sliding` has them, round ones; and their forces, F_z = -1 N."""
        radius = random.uniform(*self.radii, count)
        far = (SIDE - 1) * self.pitch
        room = far - 2 * radius[:, None]
        inside = radius[:, None] + room * random.random((count, 2))
        centre = np.where(room > 0, inside, far / 2 + (random.random((count, 2)) - 0.5) * self.pitch)
        # A quarter of the pressures lie between both shapes or beyond the even one.
        even = np.where(random.random(count) < 0.25, 1.3 * random.random(count), random.integers(0, 2, count))
        hertz, disc = self.unit(0, centre, radius), self.unit(1, centre, radius)
        angle = 2 * np.pi * random.random(count)
        push = random.random(count)[:, None] * np.stack([np.cos(angle), np.sin(angle)], 1)
        unit = hertz + even[:, None, None] * (disc - hertz)
        return unit[..., 0] + np.einsum("nti,ni->nt", unit[..., 1:], push), np.c_[push, -np.ones(count)]


def noisy(frames, share, random):
    """Frames with noise of a deviation that is a share of each one's largest reading."""
    deviation = share * np.abs(frames).max(1, keepdims=True)
    return frames + deviation * random.standard_normal(frames.shape)


class Search:
    """The grid search up to its features; `wiener` is the noise's share of a reading's power, 0 for the exact inverse."""

    def __init__(self, layer, wiener=0.0, dead_zone=DEAD_ZONE, level=LEVEL):
        dx, dy = layer.x - layer.x[:, None], layer.y - layer.y[:, None]
        c0 = 3 * DEPTH**2 / (2 * np.pi * (dx**2 + dy**2 + DEPTH**2) ** 2.5)
        c31, c32, c33 = c0 * dx, c0 * dy, c0 * DEPTH
        both = np.hstack([c31, c32, c33])
        a = np.split(both.T @ np.linalg.inv(both @ both.T), 3)
        power = c33 @ c33.T
        self.inverse = c33.T @ np.linalg.inv(power + wiener * np.trace(power) / TAXELS * np.eye(TAXELS))
        e = c33 @ a[2]
        self.k = (np.eye(TAXELS) - e) @ c33, e @ c31, e @ c32
        self.sums = [[of.sum(0) @ c33, -of.sum(0) @ c31, -of.sum(0) @ c32] for of in a]
        self.dead_zone, self.level = dead_zone, level
        reach = layer.radii[1] + DEPTH
        self.half = [int(np.clip(np.ceil(reach / pitch), 1, SIDE - 1)) for pitch in layer.pitch]

    def see(self, frames):
        """Centroids of the level set (n, 2), features (n, inputs), and sums G_pq (n, 3, 3)."""
        parts = [self._see(frames[start : start + 4000]) for start in range(0, len(frames), 4000)]
        return [np.concatenate(of) for of in zip(*parts)]

    def _see(self, frames):
        forces = frames @ self.inverse.T
        w, y = np.maximum(-forces, 0), np.maximum(forces, 0)
        u0, u1, u2 = (of.astype(np.float32) for of in (frames - y @ self.k[0].T, -w @ self.k[1].T, -w @ self.k[2].T))
        total, largest = np.abs(frames).sum(1), np.abs(frames).max(1)
        dead = (self.dead_zone * largest).astype(np.float32)[:, None]
        values = np.empty((len(frames), len(GRID), len(GRID)))
        for column, x in enumerate(GRID.astype(np.float32)):
            start = u0 + x * u1 - dead
            for row, along_y in enumerate(GRID.astype(np.float32)):
                values[:, row, column] = np.maximum(start + along_y * u2, 0).sum(1)
        weights = np.maximum(values.min((1, 2)) + self.level * total - values.transpose(1, 2, 0), 0) ** 2
        mu = np.stack([(weights.sum(0).T @ GRID), (weights.sum(1).T @ GRID)], 1) / weights.sum((0, 1))[:, None]
        g = np.stack([np.stack([y @ row[0], w @ row[1], w @ row[2]], 1) for row in self.sums], 1)
        g[:, 0, 1] += w.sum(1)
        g[:, 1, 2] += w.sum(1)
        g[:, 2, 0] -= w.sum(1)
        return mu, self.window(u0 + mu[:, :1] * u1 + mu[:, 1:] * u2, mu, total), g

    def window(self, normal, mu, total):
        """The normal forces' stress around the contact, the centroid, the place within a pitch, and 1."""
        weight, places = np.maximum(-normal, 0), np.arange(TAXELS)
        at = np.stack([weight @ (places % SIDE), weight @ (places // SIDE)], 1) / weight.sum(1)[:, None]
        centre = np.floor(at + 0.5).astype(int)
        half_x, half_y = self.half
        room = np.zeros((len(normal), 3 * SIDE + 2 * half_y, 3 * SIDE + 2 * half_x))
        room[:, SIDE + half_y : 2 * SIDE + half_y, SIDE + half_x : 2 * SIDE + half_x] = normal.reshape(-1, SIDE, SIDE)
        rows = SIDE + centre[:, 1, None, None] + np.arange(2 * half_y + 1)[:, None]
        columns = SIDE + centre[:, 0, None, None] + np.arange(2 * half_x + 1)
        seen = room[np.arange(len(normal))[:, None, None], rows, columns] * (STRESS_SCALE / total)[:, None, None]
        return np.c_[seen.reshape(len(normal), -1), mu, at - centre, np.ones(len(mu))].astype(np.float32)


def vectors(length, odd):
    """An orthonormal basis of a line's even or odd part."""
    found = []
    for index in range((length + 1) // 2):
        vector = np.zeros(length)
        vector[index] += 1
        vector[length - 1 - index] += -1 if odd else 1
        if vector.any():
            found.append(vector / np.linalg.norm(vector))
    return np.array(found).reshape(-1, length)


def butterfly(a, b, c, d):
    """Sums of four with the signs of the mirror images; its own inverse but for a factor of 4."""
    return a + b + c + d, a - b + c - d, a + b - c - d, a - b - c + d


class Network:
    """One layer of rectifiers, mean over the mirror images; inputs by parity component and whitened, as `calibrate` has it."""

    def __init__(self, inputs, windows, shape, units, random):
        size, places, bases = windows * shape[0] * shape[1], inputs.shape[1], []
        for parity in range(4):
            window = np.einsum("ay,bx->abyx", vectors(shape[1], parity > 1), vectors(shape[0], parity % 2 == 1))
            window = window.reshape(-1, shape[0] * shape[1])
            basis = np.zeros((0, places))
            for start in range(0, size, shape[0] * shape[1]):
                basis = np.r_[basis, np.pad(window, ((0, 0), (start, places - start - window.shape[1])))]
            behind = [size + i for i, of in enumerate((1, 2, 1, 2, 0)[: places - size]) if of == parity]
            basis = np.r_[basis, np.eye(places)[behind]]
            values = inputs[:20_000] @ basis.T
            covariance = values.T @ values / len(values)
            if parity == 0 and places > size:
                # The constant stays apart.
                covariance[-1], covariance[:, -1], covariance[-1, -1] = 0, 0, 1
            spread, turn = np.linalg.eigh(covariance)
            bases.append((basis.T @ (turn / np.sqrt(np.maximum(spread, 0) + 1e-3)) @ turn.T).astype(np.float32))
        self.cuts, self.basis = np.cumsum([of.shape[1] for of in bases])[:-1], np.concatenate(bases, 1)
        scales = [((places, units), np.sqrt(2 / places)), ((units, 2), 0.03 / np.sqrt(units))]
        self.weights = [(scale * random.standard_normal(of)).astype(np.float32) for of, scale in scales]

    def __call__(self, inputs):
        return np.clip(self.forward(inputs @ self.basis)[-1], -LARGEST, LARGEST)

    def forward(self, inputs):
        hidden, output = self.weights
        components = [x @ w for x, w in zip(np.split(inputs, self.cuts, 1), np.split(hidden, self.cuts, 0))]
        images = butterfly(*components)
        _, odd_x, odd_y, _ = butterfly(*(np.maximum(image, 0) for image in images))
        return images, (odd_x, odd_y), np.stack([odd_x @ output[:, 0], odd_y @ output[:, 1]], 1) / 4

    def train(self, inputs, wanted, random):
        """Adam on the squared error, its rate along a cosine."""
        inputs = inputs @ self.basis
        moments = [[np.zeros_like(of) for of in self.weights] for _ in range(2)]
        for step in range(1, STEPS + 1):
            index = random.integers(0, len(wanted), BATCH)
            batch = inputs[index]
            images, (odd_x, odd_y), found = self.forward(batch)
            error = (found - wanted[index]) / (4 * BATCH)
            output = self.weights[1]
            along_x, along_y = error[:, :1] * output[:, 0], error[:, 1:] * output[:, 1]
            slopes = [(signed * (image > 0)).astype(np.float32) for signed, image in zip(
                (along_x + along_y, along_y - along_x, along_x - along_y, -along_x - along_y), images)]
            back = butterfly(*slopes)
            gradients = (
                np.concatenate([x.T @ slope for x, slope in zip(np.split(batch, self.cuts, 1), back)]),
                np.stack([odd_x.T @ error[:, 0], odd_y.T @ error[:, 1]], 1).astype(np.float32),
            )
            rate = 1.5e-3 * (1 + np.cos(np.pi * step / STEPS))
            for weights, gradient, mean, square in zip(self.weights, gradients, *moments):
                mean += 0.1 * (gradient - mean)
                square += 0.001 * (gradient**2 - square)
                length = np.sqrt(square / np.float32(1 - 0.999**step)) + np.float32(1e-9)
                weights -= np.float32(rate) * (mean / np.float32(1 - 0.9**step) / length + np.float32(0.1) * weights)


def product_of_forces(g):
    """Sums for which (F_x, F_y) is the friction pair times |F_z| without friction, in place of the sums over |w|."""
    made = np.zeros_like(g)
    made[:, 2], made[:, 0, 1], made[:, 1, 2] = g[:, 2], -g[:, 2, 0], -g[:, 2, 0]
    return made


def fit(mu, g, forces):
    """Gain, the pair that makes each resultant right, and the polynomial of the friction."""
    wanted, gain = mu, 1.0
    for _ in range(4):
        gain = np.median(forces[:, 2] / (g[:, 2, 0] + (g[:, 2, 1:] * wanted).sum(1)))
        found = np.linalg.solve(g[:, :2, 1:], (forces[:, :2] / gain - g[:, :2, 0])[..., None])[..., 0]
        wanted = np.where((np.abs(found) < 2).all(1)[:, None], found, mu)
    square = (mu**2).sum(1)
    terms = np.r_[np.c_[mu[:, 0], mu[:, 0] * square], np.c_[mu[:, 1], mu[:, 1] * square]]
    return gain, wanted, np.linalg.lstsq(terms, np.r_[wanted[:, 0], wanted[:, 1]], rcond=None)[0]


def searched(layer, samples, sets, least=0.0, most=1.0, other=None, product=False, units=UNITS, **search):
    """Errors of the grid search with a network, by noise; trained at `least` to `most` of the noise."""
    frames, forces = samples
    random = np.random.default_rng(2)
    share = NOISE * (least + (most - least) * random.random(len(frames)))
    read = noisy(frames, share[:, None], random)
    first, second = Search(layer, **search), other and Search(layer, **other)

    def see(frames):
        mu, features, g = first.see(frames)
        if second:
            features = np.c_[second.see(frames)[1][:, :-5], features]
        return mu, features, product_of_forces(g) if product else g

    mu, features, g = see(read)
    gain, wanted, (c1, c3) = fit(mu, g, forces)

    def scaled(mu):
        return mu * (c1 + c3 * (mu**2).sum(1))[:, None]

    shape = [2 * half + 1 for half in first.half]
    network = Network(features, 2 if second else 1, shape, units, random)
    network.train(features, (wanted - scaled(mu)).astype(np.float32), random)
    for frames, truth in sets.values():
        mu, features, g = see(frames)
        pair = scaled(mu) + network(features)
        yield errors(gain * (g[:, :2, 0] + np.einsum("npq,nq->np", g[:, :2, 1:], pair)), truth)


def whole_frame(samples, sets, most=1.0):
    """Errors of a plain network on the frame alone, whose answer is the tangential force over the normal one."""
    frames, forces = samples
    random = np.random.default_rng(3)

    def inputs(frames):
        return (10 * frames / np.sqrt((frames**2).sum(1, keepdims=True))).astype(np.float32)

    sizes = [TAXELS, *DEEP, 2]
    weights = [(np.sqrt(2 / n) * random.standard_normal((n, m))).astype(np.float32) for n, m in zip(sizes, sizes[1:])]
    parameters = [*weights, *(np.zeros(m, np.float32) for m in sizes[1:])]
    moments = [[np.zeros_like(of) for of in parameters] for _ in range(2)]

    def forward(values):
        found = [values]
        for layer, (weight, offset) in enumerate(zip(parameters, parameters[len(weights) :])):
            values = found[-1] @ weight + offset
            found.append(np.maximum(values, 0) if layer < len(DEEP) else values)
        return found

    for step in range(1, DEEP_STEPS + 1):
        index = random.integers(0, len(frames), DEEP_BATCH)
        share = most * NOISE * random.random((DEEP_BATCH, 1))
        found = forward(inputs(noisy(frames[index], share, random)))
        slope, weight_slopes, offset_slopes = (found[-1] - forces[index, :2].astype(np.float32)) / DEEP_BATCH, [], []
        for layer in reversed(range(len(weights))):
            weight_slopes.insert(0, found[layer].T @ slope)
            offset_slopes.insert(0, slope.sum(0))
            slope = (slope @ parameters[layer].T) * (found[layer] > 0)
        rate = np.float32(5e-4 * (1 + np.cos(np.pi * step / DEEP_STEPS)))
        for of, gradient, mean, square in zip(parameters, [*weight_slopes, *offset_slopes], *moments):
            mean += 0.1 * (gradient - mean)
            square += 0.001 * (gradient**2 - square)
            of -= rate * (mean / np.float32(1 - 0.9**step)) / (np.sqrt(square / np.float32(1 - 0.999**step)) + 1e-8)
    for frames, truth in sets.values():
        yield errors(forward(inputs(frames))[-1] * np.abs(truth[:, 2:]), truth)


class Parametric:
    """Gauss-Newton on place, radius and force of a round contact, of that pressure of two that fits better."""

    def __init__(self, layer):
        self.layer = layer

    def stress(self, shape, place, force):
        return np.einsum("nti,ni->nt", self.layer.unit(shape, place[:, :2], place[:, 2]), force)

    def slopes(self, shape, place, force, by=1e-4):
        found = [self.layer.unit(shape, place[:, :2], place[:, 2])]
        for axis in by * np.eye(3):
            both = [self.stress(shape, place + sign * axis, force) for sign in (1, -1)]
            found.append((both[0] - both[1])[..., None] / (2 * by))
        return np.concatenate(found, -1)

    def forces(self, shape, place, frames):
        unit = self.layer.unit(shape, place[:, :2], place[:, 2])
        square = np.einsum("nti,ntj->nij", unit, unit)
        force = np.linalg.solve(square, np.einsum("nti,nt->ni", unit, frames)[..., None])[..., 0]
        return force, frames - np.einsum("nti,ni->nt", unit, force)

    def fit(self, frames, steps, shape):
        """Place (x, y, radius), force (pressing, along x and y), and remaining power."""
        layer = self.layer
        weight = np.maximum(-frames, 0)
        weight[weight < 0.1 * weight.max(1, keepdims=True)] = 0
        total = weight.sum(1)
        x, y = weight @ layer.x / total, weight @ layer.y / total
        spread = (weight * ((layer.x - x[:, None]) ** 2 + (layer.y - y[:, None]) ** 2)).sum(1) / total
        ends = np.array([[0, 0, 1.02 * layer.table_radii[0]], [layer.x[-1], layer.y[-1], 0.98 * layer.table_radii[-1]]])
        place = np.clip(np.stack([x, y, np.sqrt(2 * spread)], 1), *ends)
        force, rest = self.forces(shape, place, frames)
        damping = np.full((len(frames), 1, 1), 1e-3)
        for _ in range(steps):
            slopes = self.slopes(shape, place, force)
            square = np.einsum("nti,ntj->nij", slopes, slopes)
            damped = square * (1 + damping * np.eye(6))
            step = np.linalg.solve(damped, np.einsum("nti,nt->ni", slopes, rest)[..., None])[:, 3:, 0]
            next_place = np.clip(place + np.clip(step, -2e-3, 2e-3), *ends)
            next_force, next_rest = self.forces(shape, next_place, frames)
            better = ((next_rest**2).sum(1) < (rest**2).sum(1))[:, None]
            place, force, rest = (
                np.where(better, *of) for of in ((next_place, place), (next_force, force), (next_rest, rest))
            )
            damping = np.where(better[..., None], 0.2 * damping, 8 * damping)
        return place, force, (rest**2).sum(1)

    def errors(self, frames, truth, steps):
        (_, hertz, rest), (_, disc, other) = (self.fit(frames, steps, shape) for shape in (0, 1))
        return errors(np.where((other < rest)[:, None], disc, hertz)[:, 1:], truth)


def errors(found, truth):
    """Length of the error of (F_x, F_y) in percent of the normal force."""
    return 100 * np.hypot(*(found - truth[:, :2]).T) / np.abs(truth[:, 2])


def scene(sptfra, design, kind, folder, count=CONTACTS, seed=SEED):
    """Frames and true forces of contacts of a kind."""
    frames = folder / f"{kind}.csv"
    options = ["--kind", kind, "--count", str(count), "--seed", str(seed), "--out", str(frames)]
    subprocess.run([sptfra, "scene", "--design", str(design), *options], check=True, capture_output=True)
    truth = np.genfromtxt(frames.with_suffix(".forces.csv"), delimiter=",", skip_header=1)[:, 1:4]
    return np.loadtxt(frames, delimiter=","), truth


def solved(sptfra, design, frames, truth, folder):
    """Errors of a shipped design."""
    names = [str(folder / name) for name in ("read.csv", "found.csv")]
    np.savetxt(names[0], frames, delimiter=",", fmt="%.9g")
    command = [sptfra, "solve", str(design), "--frames", names[0], "--out", names[1]]
    subprocess.run(command, check=True, capture_output=True)
    return errors(np.genfromtxt(names[1], delimiter=",", skip_header=1)[:, 1:3], truth)


HEAD = """\
# Estimators of the tangential force under noise: error in percent of the normal force.
# {contacts} contacts of a kind at a friction of 0.5, {draws} draws of noise each, none of them drawn by a training.
# noise: standard deviation in percent of the largest reading of a frame. Trained at a noise up to {noise:.0%}.
# fast, wide: the shipped designs. The bound (Cramér-Rao) is in noise.csv.
# search: the grid search with {units} hidden units, trained as those below; high-noise: at {half:.1%} to {noise:.0%} only.
# wiener: an inverse regularised for the noise in place of C33^-1; wiener-strong: 25 times more.
# dead-zone: of two deviations of the noise; level-low, -high: a quarter and four times the level of the grid search.
# both: features of C33^-1 and of wiener-strong. NAME-2: trained at a noise up to {twice:.0%}.
# product: (F_x, F_y) is friction times F_z, in place of sums over |w|; large: high-noise too, with {many} hidden units.
# frame: a plain network of {deep} units in three layers, on the frame alone; {many_samples} contacts, noise drawn anew.
# parametric: two steps of Gauss-Newton on place, radius and force of a round contact.
# command: python3 tools/estimator_study.py SPTFRA results/estimator-study.csv
# designs: {designs}
sensor,kind,estimator,noise,median,p95
"""


def designs_hashes(sptfra, names):
    """Designs with their hashes, for the head of a table."""
    hashes = []
    with tempfile.TemporaryDirectory() as folder:
        for name in names:
            design, generated = ROOT / "designs" / f"{name}.toml", Path(folder) / name
            command = [sptfra, "generate", str(design), "--out", str(generated)]
            subprocess.run(command, check=True, capture_output=True)
            hashes.append(f"{name} {json.loads((generated / 'metadata.json').read_text())['design_hash']}")
    return ", ".join(hashes)


def head(sptfra):
    """What the table is, with the designs' hashes."""
    designs = designs_hashes(sptfra, (f"sensor{sensor}-{name}" for sensor in PITCHES_MM for name in ("fast", "wide")))
    sizes = {"contacts": CONTACTS, "draws": DRAWS, "units": UNITS, "many": MANY_UNITS}
    sizes |= {"twice": 2 * NOISE, "deep": " + ".join(map(str, DEEP)), "many_samples": MANY_SAMPLES}
    return HEAD.format(**sizes, noise=NOISE, half=NOISE / 2, designs=designs)


def main() -> None:
    if len(sys.argv) != 3:
        sys.exit(__doc__.splitlines()[0])
    sptfra, out = sys.argv[1], Path(sys.argv[2])
    lines = [head(sptfra)]

    def row(sensor, kind, estimator, noise, of):
        of = np.sort(of)
        median, most = (of[int(np.ceil(len(of) * share)) - 1] for share in (0.5, 0.95))
        lines.append(f"{sensor},{kind},{estimator},{noise:g},{median:.2f},{most:.2f}\n")
        print(lines[-1], end="", flush=True)

    for sensor, pitch_mm in PITCHES_MM.items():
        layer = Layer(pitch_mm)
        parametric = Parametric(layer)
        samples = layer.contacts(SAMPLES, np.random.default_rng(1))
        # Of a reading, over the square of the frame's largest.
        power = (samples[0] ** 2).mean() / (np.abs(samples[0]).max(1) ** 2).mean()
        strong = {"wiener": 25 * NOISE**2 / power}
        designs = {name: ROOT / "designs" / f"sensor{sensor}-{name}.toml" for name in ("fast", "wide")}
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            for kind in ("sliding", "tilted-along", "held", "turned"):
                frames, truth = scene(sptfra, designs["fast"], kind, folder)
                random = np.random.default_rng(SEED)
                many, truths = np.tile(frames, (DRAWS, 1)), np.tile(truth, (DRAWS, 1))
                sets = {noise: (noisy(many, 0.01 * noise, random), truths) for noise in NOISES}
                if kind != "sliding":
                    sets = {1.0: sets[1.0]}
                for noise, of in sets.items():
                    row(sensor, kind, "parametric", noise, parametric.errors(*of, 2))
                    for estimator, design in designs.items():
                        row(sensor, kind, estimator, noise, solved(sptfra, design, *of, folder))
                if kind != "sliding":
                    continue
                candidates = {
                    "search": {},
                    "product": {"product": True},
                    "search-high-noise": {"least": 0.5},
                    "product-high-noise": {"product": True, "least": 0.5},
                    "product-large": {"product": True, "least": 0.5, "units": MANY_UNITS},
                    "wiener": {"wiener": NOISE**2 / power},
                    "wiener-strong": strong,
                    "dead-zone": {"dead_zone": 2 * NOISE},
                    "level-low": {"level": LEVEL / 4},
                    "level-high": {"level": 4 * LEVEL},
                    "both": {"other": strong},
                    "search-2": {"most": 2.0},
                    "product-high-noise-2": {"product": True, "least": 1.0, "most": 2.0},
                }
                for estimator, options in candidates.items():
                    for noise, of in zip(sets, searched(layer, samples, sets, **options)):
                        row(sensor, kind, estimator, noise, of)
                many_samples = layer.contacts(MANY_SAMPLES, np.random.default_rng(4))
                for estimator, most in [("frame", 1.0), ("frame-2", 2.0)]:
                    for noise, of in zip(sets, whole_frame(many_samples, sets, most)):
                        row(sensor, kind, estimator, noise, of)
    out.write_text("".join(lines), encoding="utf-8")


if __name__ == "__main__":
    main()
