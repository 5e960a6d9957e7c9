# SPDX-License-Identifier: MIT OR Apache-2.0
"""A soft prism, bonded to a rigid ground, under a rigid indenter: input for CalculiX, and what it answers.

Millimetres, newtons, megapascals; z points out of the sensor. Nothing here knows of the project's own elasticity.
"""

import math
import re
import subprocess
from dataclasses import dataclass
from pathlib import Path

import numpy as np

# Penalties of contact and of stick, times Young's modulus: surfaces overlap by a few micrometres.
CONTACT_PER_MM = 10.0
STICK_PER_MM = 3.0
TAXEL_SHARE = 0.8  # of its pitch, along x and along y, over which a taxel averages


@dataclass(frozen=True)
class Prism:
    """A sensor: its layer and its grid of taxels, which lie in the middle of the base."""

    name: str
    size: tuple[float, float, float]
    taxels: tuple[int, int]
    pitch: tuple[float, float]

    def positions(self):
        """Coordinates of the taxels, x first."""
        (nx, ny), (sx, sy) = self.taxels, self.pitch
        left = 0.5 * (self.size[0] - (nx - 1) * sx)
        front = 0.5 * (self.size[1] - (ny - 1) * sy)
        return [(left + ix * sx, front + iy * sy) for iy in range(ny) for ix in range(nx)]


@dataclass(frozen=True)
class Indenter:
    """A rigid body: its height above its lowest point over a rectangle of half sides `reach`, in `cells` squares."""

    height: callable
    reach: tuple[float, float]
    cells: tuple[int, int]


def sphere(radius, reach):
    return Indenter(lambda x, y: radius - math.sqrt(radius**2 - x * x - y * y), (reach, reach), (20, 20))


def cylinder(radius, reach, half_length, turn_deg=0.0):
    """Lies on its side with ends rounded off, so that no edge cuts into the layer."""
    cos, sin = math.cos(math.radians(turn_deg)), math.sin(math.radians(turn_deg))

    def height(x, y):
        across, along = cos * x + sin * y, cos * y - sin * x
        across = min(abs(across), 0.98 * radius)
        beyond = max(0.0, abs(along) - half_length)
        return radius - math.sqrt(radius**2 - across**2) + 0.1 * beyond**2

    return Indenter(height, (reach, reach), (20, 20))


def block(half_sides, slope=(0.0, 0.0), edge=1.5):
    """Flat, with edges rounded by the radius `edge`, and tilted by a slope along x and y."""

    def height(x, y):
        rounding = 0.0
        for value, half in ((x, half_sides[0]), (y, half_sides[1])):
            beyond = min(abs(value) - (half - edge), 0.98 * edge)
            if beyond > 0.0:
                rounding += edge - math.sqrt(edge**2 - beyond**2)
        return rounding + slope[0] * x + slope[1] * y

    return Indenter(height, half_sides, (24, 24))


def _hexahedra(counts, lines):
    """Nodes and elements of 20 nodes over the lattice of `counts` elements; `lines` are the coordinates of its planes."""
    numbers, nodes = {}, []

    def node(i, j, k):
        if (i, j, k) not in numbers:
            numbers[i, j, k] = len(nodes) + 1
            place = [0.5 * (line[n // 2] + line[(n + 1) // 2]) for line, n in zip(lines, (i, j, k))]
            nodes.append(place)
        return numbers[i, j, k]

    corners = [(0, 0), (2, 0), (2, 2), (0, 2)]
    middles = [(1, 0), (2, 1), (1, 2), (0, 1)]
    elements = []
    for k in range(counts[2]):
        for j in range(counts[1]):
            for i in range(counts[0]):
                at = lambda dx, dy, dz: node(2 * i + dx, 2 * j + dy, 2 * k + dz)
                elements.append(
                    [at(*c, 0) for c in corners]
                    + [at(*c, 2) for c in corners]
                    + [at(*m, 0) for m in middles]
                    + [at(*m, 2) for m in middles]
                    + [at(*c, 1) for c in corners]
                )
    return nodes, elements


class Model:
    """A prism cut by the planes `lines` along x, y and z, with one indenter whose lowest point is above `centre`."""

    def __init__(self, prism, lines, indenter, centre, young, poisson, friction):
        self.prism, self.friction, self.young, self.poisson = prism, friction, young, poisson
        self.lines = lines
        self.mesh = mesh = tuple(len(line) - 1 for line in lines)
        self.nodes, self.elements = _hexahedra(mesh, lines)
        (rx, ry), (cx, cy) = indenter.reach, indenter.cells
        first = len(self.nodes)
        self.tool_nodes, self.tool_elements = [], []
        places = [
            (x, y) for y in np.linspace(-ry, ry, cy + 1) for x in np.linspace(-rx, rx, cx + 1)
        ]
        heights = [indenter.height(x, y) for x, y in places]
        lowest = min(heights)
        for layer in (0.0, 1.0):
            for (x, y), height in zip(places, heights):
                z = prism.size[2] + height - lowest + layer + 1e-4
                self.tool_nodes.append([centre[0] + x, centre[1] + y, z])
        number = lambda i, j, k: first + 1 + i + (cx + 1) * (j + (cy + 1) * k)
        for j in range(cy):
            for i in range(cx):
                ring = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
                self.tool_elements.append([number(*r, 0) for r in ring] + [number(*r, 1) for r in ring])

    def write(self, path, moves):
        """The input; `moves` are steps: displacement of the indenter since the beginning, and how many increments."""
        base = [n for n, place in enumerate(self.nodes, 1) if place[2] == 0.0]
        columns = self.mesh[0] * self.mesh[1]
        top = range(len(self.elements) - columns + 1, len(self.elements) + 1)
        out = ["*NODE, NSET=ALL"]
        for n, (x, y, z) in enumerate(self.nodes + self.tool_nodes, 1):
            out.append(f"{n}, {x:.9g}, {y:.9g}, {z:.9g}")
        out.append("*ELEMENT, TYPE=C3D20R, ELSET=LAYER")
        for n, element in enumerate(self.elements, 1):
            out.append(f"{n}, " + ", ".join(map(str, element[:10])) + ",")
            out.append(", ".join(map(str, element[10:])))
        out.append("*ELEMENT, TYPE=C3D8, ELSET=TOOL")
        for n, element in enumerate(self.tool_elements, len(self.elements) + 1):
            out.append(f"{n}, " + ", ".join(map(str, element)))
        first = len(self.nodes) + 1
        out += ["*NSET, NSET=BASE"] + [f"{n}," for n in base]
        out += ["*NSET, NSET=TOOLNODES, GENERATE", f"{first}, {len(self.nodes) + len(self.tool_nodes)}"]
        out += ["*SURFACE, NAME=SOFT"] + [f"{n}, S2" for n in top]
        tools = range(len(self.elements) + 1, len(self.elements) + len(self.tool_elements) + 1)
        out += ["*SURFACE, NAME=HARD"] + [f"{n}, S1" for n in tools]
        out += ["*MATERIAL, NAME=RUBBER", "*ELASTIC", f"{self.young}, {self.poisson}"]
        out += ["*MATERIAL, NAME=STEEL", "*ELASTIC", "200000., 0.3"]
        out += ["*SOLID SECTION, ELSET=LAYER, MATERIAL=RUBBER", "*SOLID SECTION, ELSET=TOOL, MATERIAL=STEEL"]
        out += ["*SURFACE INTERACTION, NAME=TOUCH", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR"]
        out += [f"{CONTACT_PER_MM * self.young}", "*FRICTION", f"{self.friction}, {STICK_PER_MM * self.young}"]
        out += ["*CONTACT PAIR, INTERACTION=TOUCH, TYPE=SURFACE TO SURFACE", "SOFT, HARD"]
        out += ["*BOUNDARY", "BASE, 1, 3, 0.", "TOOLNODES, 1, 3, 0."]
        for displacement, increments in moves:
            out += ["*STEP, NLGEOM, INC=500", "*STATIC", f"{1.0 / increments}, 1., 1e-5, {1.0 / increments}"]
            out += ["*BOUNDARY"]
            out += [f"TOOLNODES, {axis}, {axis}, {value:.9g}" for axis, value in enumerate(displacement, 1)]
            out += ["*NODE PRINT, NSET=BASE", "RF", "*END STEP"]
        Path(path).write_text("\n".join(out) + "\n")

    def run(self, folder, name, moves, command):
        """Runs CalculiX; for each increment the time, the force on the surface in N, the stress at the taxels in Pa."""
        folder.mkdir(parents=True, exist_ok=True)
        self.write(folder / f"{name}.inp", moves)
        with open(folder / f"{name}.log", "w") as log:
            done = subprocess.run([*command, name], cwd=folder, stdout=log, stderr=subprocess.STDOUT, check=False)
        if done.returncode:
            raise SystemExit(f"{folder / name}.log: CalculiX failed; no increment that it left is used")
        return self.read(folder / f"{name}.dat")

    def read(self, path):
        """Forces and stresses of each increment that converged, from the reactions of the bonded base."""
        reactions, time = {}, None
        for line in Path(path).read_text().splitlines():
            words = line.split()
            if "time" in words:
                time = float(words[-1])
            elif words:
                # Numbers may run into each other: by their form, not by blanks.
                values = [float(word) for word in re.findall(r"[-+]?\d\.\d+E[-+]\d+", line)]
                reactions.setdefault(time, {})[int(words[0])] = values
        found = []
        for time in sorted(reactions):
            # The ground holds the layer: what it exerts is the opposite of what the indenter does.
            force = [-sum(values[axis] for values in reactions[time].values()) for axis in range(3)]
            found.append((time, force, self.at_taxels({n: -values[2] for n, values in reactions[time].items()})))
        return found

    def at_taxels(self, load):
        """Mean of the normal stress over each taxel in Pa, from `load`, the traction's work with every base node in N.

        The reactions are integrals of the traction against the shape functions; solved for the traction, they are more
        exact than stresses at Gauss points, and add up to the whole force. At a point the traction still waves with the
        elements, by several percent of the peak; over a taxel, which is larger than an element, it does not.
        """
        nx, ny, _ = self.mesh
        faces = self.elements[: nx * ny]
        corners = [0, 1, 2, 3, 8, 9, 10, 11]
        index = {n: i for i, n in enumerate(sorted({face[c] for face in faces for c in corners}))}
        mass, right = np.zeros((len(index), len(index))), np.zeros(len(index))
        points, weights = np.polynomial.legendre.leggauss(3)
        for number, face in enumerate(faces):
            hx = self.lines[0][number % nx + 1] - self.lines[0][number % nx]
            hy = self.lines[1][number // nx + 1] - self.lines[1][number // nx]
            at = [index[face[c]] for c in corners]
            for x, wx in zip(points, weights):
                for y, wy in zip(points, weights):
                    shape = _serendipity(x, y)
                    mass[np.ix_(at, at)] += 0.25 * hx * hy * wx * wy * np.outer(shape, shape)
        for n, value in load.items():
            right[index[n]] = value
        traction = np.linalg.solve(mass, right)

        def value(x, y):
            ex, ey = (
                min(int(np.searchsorted(line, v, side="right")) - 1, len(line) - 2)
                for line, v in zip(self.lines, (x, y))
            )
            local = (
                2.0 * (v - line[e]) / (line[e + 1] - line[e]) - 1.0
                for v, line, e in zip((x, y), self.lines, (ex, ey))
            )
            at = [index[faces[ey * nx + ex][c]] for c in corners]
            return _serendipity(*local) @ traction[at]

        points, weights = np.polynomial.legendre.leggauss(8)
        half = [0.5 * TAXEL_SHARE * pitch for pitch in self.prism.pitch]
        return [
            1e6 * float(sum(
                0.25 * wx * wy * value(x + half[0] * dx, y + half[1] * dy)
                for dx, wx in zip(points, weights) for dy, wy in zip(points, weights)
            ))
            for x, y in self.prism.positions()
        ]


def _serendipity(x, y):
    """The eight shape functions of a face: corners counterclockwise from (-1, -1), then the middles of the sides."""
    corner = [0.25 * (1 + a * x) * (1 + b * y) * (a * x + b * y - 1) for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    return np.array(corner + [0.5 * (1 - x * x) * (1 - y), 0.5 * (1 + x) * (1 - y * y), 0.5 * (1 - x * x) * (1 + y), 0.5 * (1 - x) * (1 - y * y)])
