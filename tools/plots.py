#!/usr/bin/env python3
# SPDX-License-Identifier: MIT OR Apache-2.0
"""Plots of the docs, drawn from results/*.csv into docs/figures: plots.py [--check]

With --check nothing is written; the exit code is 1 if a plot is not what its data give.
"""

import csv
import math
import sys
from pathlib import Path
from xml.sax.saxutils import escape

ROOT = Path(__file__).resolve().parent.parent
FIGURES = ROOT / "docs" / "figures"
COLOURS = ["#8a8f98", "#2b6cb0", "#c05621", "#2f855a"]
GRID, INK = "#e2e5ea", "#333333"


def rows(name):
    """The rows of a file of results, by the names of its columns."""
    with open(ROOT / "results" / name, encoding="utf-8") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def text(x, y, words, anchor="start", colour=INK, size=13, more=""):
    return (
        f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" fill="{colour}" font-size="{size}"{more}>'
        f"{escape(words)}</text>"
    )


def line(x1, y1, x2, y2, colour=GRID, width=1.0, more=""):
    return (
        f'<line x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}" stroke="{colour}" '
        f'stroke-width="{width}"{more}/>'
    )


def picture(width, height, title, parts):
    """An SVG on white, so that it reads on dark pages too."""
    head = (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" font-family="sans-serif">\n'
        f'<title>{escape(title)}</title>\n<rect width="{width}" height="{height}" fill="#ffffff"/>\n'
    )
    return head + "\n".join(parts) + "\n</svg>\n"


def dots(title, labels, series, limit, unit, panels):
    """Dot plots side by side: median as a dot, a bar to the 95 % quantile.

    series: names; panels: (heading, {(label, name): (median, p95)}).
    """
    left, panel, step, top = 250, 300, 22, 62
    height = top + step * len(labels) + 54
    width = left + len(panels) * (panel + 24) + 10
    parts = []
    for index, name in enumerate(series):
        x = left - 120 + index * 150
        parts.append(f'<circle cx="{x + 5}" cy="16" r="5" fill="{COLOURS[index + (len(series) < 3)]}"/>')
        parts.append(text(x + 16, 21, name))
    for place, label in enumerate(labels):
        parts.append(text(left - 12, top + step * (place + 0.5) + 4, label, "end"))
    for number, (heading, values) in enumerate(panels):
        x0 = left + number * (panel + 24)

        def at(value, x0=x0):
            return x0 + panel * min(value, limit) / limit

        parts.append(text(x0, 48, heading, more=' font-weight="bold"'))
        bottom = top + step * len(labels)
        for tick in range(0, limit + 1, 10 if limit > 20 else 5):
            parts.append(line(at(tick), top, at(tick), bottom))
            parts.append(text(at(tick), bottom + 18, str(tick), "middle", size=12))
        parts.append(text(x0 + panel / 2, bottom + 38, unit, "middle", size=12))
        for place, label in enumerate(labels):
            for index, name in enumerate(series):
                if (label, name) not in values:
                    continue
                median, most = values[(label, name)]
                y = top + step * (place + 0.5) + 6 * (index - (len(series) - 1) / 2)
                colour = COLOURS[index + (len(series) < 3)]
                parts.append(line(at(median), y, at(most), y, colour, 1.6))
                if most > limit:
                    parts.append(text(x0 + panel + 2, y + 4, "›", colour=colour, size=12))
                parts.append(f'<circle cx="{at(median):.1f}" cy="{y:.1f}" r="3.4" fill="{colour}"/>')
    return picture(width, height, title, parts)


KINDS = {
    "sliding": "round, sliding",
    "tilted-along": "pressure tilted along the push",
    "tilted-across": "pressure tilted across it",
    "held": "held (Mindlin)",
    "even-shear": "even shear",
    "turned": "ellipses, rectangles",
    "soft-edge": "soft edge",
    "hard-edge": "hard edge",
    "spinning": "turns while it slides",
    "border": "half beyond the edge",
    "large-taxels": "taxels of 0.8 pitches",
    "deeper": "layer 5 % deeper",
    "shallower": "layer 5 % thinner",
    "lower-poisson": "Poisson's ratio 0.4655",
    "gain-spread": "gains spread by 2 %",
    "mixed-inside": "all at random, inside",
}
ESTIMATORS = {"line": "line search", "sliding": "grid, sliding", "general": "grid, general"}
ERROR = "error, % of the normal force"


def contact_kinds():
    panels = []
    for sensor in "12":
        values = {}
        for row in rows("contact-kinds.csv"):
            if row["sensor"] == sensor and row["friction"] in ("0.5", "0.1 to 1") and row["kind"] in KINDS:
                key = (KINDS[row["kind"]], ESTIMATORS[row["estimator"]])
                values[key] = (float(row["median"]), float(row["p95"]))
        panels.append((f"sensor {sensor}", values))
    return dots("Error by kind of contact", list(KINDS.values()), list(ESTIMATORS.values()), 30, ERROR, panels)


def finite_elements():
    errors, labels = {}, []
    for row in rows("finite-elements.csv"):
        if float(row["true_mu"]) < 0.05:
            continue
        label = f"{row['sensor']}: {row['case']}"
        errors.setdefault((label, ESTIMATORS[row["estimator"]]), []).append(float(row["tangential"]))
        if label not in labels:
            labels.append(label)
    middle = {key: (sorted(of)[len(of) // 2], max(of)) for key, of in errors.items()}
    panels = [("sensor and case: median and largest", middle)]
    return dots("Error on finite elements", labels, list(ESTIMATORS.values()), 30, ERROR, panels)


def several_contacts():
    sets = {"general": "reads tension", "general, clipped": "pressure only"}
    labels = ["one alone", "two, 8 mm apart", "two, 6 mm apart", "two, 4 mm apart", "two, anyhow", "three, anyhow"]
    panels = []
    for sensor in "12":
        values = {}
        for row in rows("several-contacts.csv"):
            if row["sensor"] == sensor and row["quantity"] == "each" and row["training_set"] in sets:
                if row["frames"] in labels and row["median"]:
                    values[(row["frames"], sets[row["training_set"]])] = (float(row["median"]), float(row["p95"]))
        panels.append((f"sensor {sensor}, each contact", values))
    return dots("Error of each contact", labels, list(sets.values()), 40, ERROR, panels)


def error_latency():
    """Error of one sliding contact in the middle against latency: ours and the published design."""
    latency = {row["design"]: float(row["latency_us"]) for row in rows("designs.csv")}
    worst = {
        row["design"]: float(row["worst"])
        for row in rows("contact-sets.csv")
        if row["contacts"] == "Hertz 7 mm" and row["noise"] == "0" and row["friction"] == "0.5"
    }
    published = {row["design"]: row for row in rows("published.csv")}
    width, height, left, right, top, bottom = 760, 380, 64, 740, 30, 320
    ends, limit = (4.0, 60_000.0), 10.0

    def x(us):
        return left + (right - left) * math.log(us / ends[0]) / math.log(ends[1] / ends[0])

    def y(error):
        return bottom - (bottom - top) * error / limit

    parts = []
    for us, words in ((10, "10 µs"), (100, "100 µs"), (1e3, "1 ms"), (1e4, "10 ms")):
        parts.append(line(x(us), top, x(us), bottom))
        parts.append(text(x(us), bottom + 18, words, "middle", size=12))
    for error in range(0, 11, 2):
        parts.append(line(left, y(error), right, y(error)))
        parts.append(text(left - 8, y(error) + 4, str(error), "end", size=12))
    parts.append(text((left + right) / 2, bottom + 42, "latency of a frame of 10 × 10 taxels (logarithmic)", "middle"))
    parts.append(text(left, top - 12, "largest tangential error, % of the normal force"))
    # Errors of the first design are those of the second: the forces, or their sums, are the same.
    shown = [
        ("sensor1-none", "sensor1-reduced", "line search, 16 lanes", 1, 10, 4),
        ("sensor1-none", "sensor1-resultants", "resultants only", 1, -14, -12),
        ("sensor1-fast", "sensor1-fast", "grid search, 16 lanes", 2, 10, 0),
        ("sensor1-fast", "sensor1-fast-64", "64 lanes", 2, -12, 20),
        ("sensor1-fast-100", "sensor1-fast-100", "100 lanes", 2, -12, -12),
        ("sensor1-wide", "sensor1-wide", "trained on any contacts", 3, 10, 14),
    ]
    for measured, design, words, colour, right_by, down in shown:
        place = (x(latency[design]), y(worst[measured]))
        parts.append(f'<circle cx="{place[0]:.1f}" cy="{place[1]:.1f}" r="6" fill="{COLOURS[colour]}"/>')
        parts.append(text(place[0] + right_by, place[1] + down, words, size=12))
    for name, words in (("HW1", "published HW 1, no filter"), ("HW1F3", "with filter F3")):
        row = published[name]
        place = (x(float(row["latency_us"])), y(float(row["tangential"])))
        parts.append(f'<rect x="{place[0] - 6:.1f}" y="{place[1] - 6:.1f}" width="12" height="12" fill="{COLOURS[0]}"/>')
        parts.append(text(place[0] + 6, place[1] - 14, words, "end", size=12))
    return picture(width, height, "Error against latency", parts)


def noise():
    """Error against noise, with the bound of any estimator."""
    sensors, designs = ("1", "2"), ("fast", "wide")
    left, top, bottom, limit = 64, 66, 300, 60
    parts = [text(left, 18, "solid: median, dotted: 95 %, grey: bound of the median", size=12)]
    for index, name in enumerate(("sliding", "general")):
        parts.append(text(left + 150 * index, 36, f"● trained on {name}", colour=COLOURS[index + 1], size=12))
    for number, sensor in enumerate(sensors):
        x0 = left + number * 360

        def x(sigma, x0=x0):
            return x0 + 300 * float(sigma) / 2

        def y(error):
            return bottom - (bottom - top) * float(error) / limit

        parts.append(text(x0, 56, f"sensor {sensor}", more=' font-weight="bold"'))
        for error in range(0, limit + 1, 10):
            parts.append(line(x0, y(error), x0 + 300, y(error)))
            parts.append(text(x0 - 8, y(error) + 4, str(error), "end", size=12))
        for sigma in (0, 0.5, 1, 1.5, 2):
            parts.append(text(x(sigma), bottom + 18, f"{sigma:g}", "middle", size=12))
        parts.append(text(x0 + 150, bottom + 40, "noise, % of the frame's largest reading", "middle", size=12))
        for index in range(2):
            design = f"sensor{sensor}-{designs[index]}"
            points = [row for row in rows("noise.csv") if row["design"] == design]
            if index == 0:
                parts.append(line(x(0), y(0), x(2), y(points[-1]["bound"]), COLOURS[0], 2))
            for kind, dash in (("median", ""), ("p95", ' stroke-dasharray="2 3"')):
                path = " ".join(f"{x(row['noise']):.1f},{y(row[kind]):.1f}" for row in points)
                colour = COLOURS[index + 1]
                parts.append(f'<polyline points="{path}" fill="none" stroke="{colour}" stroke-width="2"{dash}/>')
    return picture(left + 360 * len(sensors) + 20, bottom + 54, "Error against noise", parts)


def smoothing():
    """Error against frames averaged, with the bound of any estimator."""
    table = rows("smoothing.csv")
    left, top, bottom, limit = 64, 66, 300, 30
    parts = [text(left, 18, "solid: median, dotted: 95 %, dashed: bound of the median", size=12)]
    noises = ["0.5", "1", "2"]
    for index, noise in enumerate(noises):
        parts.append(text(left + 110 * index, 36, f"\u25cf noise {noise} %", colour=COLOURS[index + 1], size=12))
    for number, design in enumerate(("sensor1-wide", "sensor2-wide")):
        x0 = left + number * 360

        def x(k, x0=x0):
            return x0 + 300 * float(k) / 8

        def y(error):
            return bottom - (bottom - top) * float(error) / limit

        parts.append(text(x0, 56, f"sensor {number + 1}, general", more=' font-weight="bold"'))
        for error in range(0, limit + 1, 5):
            parts.append(line(x0, y(error), x0 + 300, y(error)))
            parts.append(text(x0 - 8, y(error) + 4, str(error), "end", size=12))
        for k in range(9):
            frames = next(row["frames"] for row in table if row["k"] == str(k))
            parts.append(text(x(k), bottom + 18, frames, "middle", size=12))
        parts.append(text(x0 + 150, bottom + 40, "frames averaged, for smoothing = 0 (none) to 8", "middle", size=12))
        for index, noise in enumerate(noises):
            points = [row for row in table if row["design"] == design and row["noise"] == noise]
            for kind, dash in (("median", ""), ("p95", "2 3"), ("bound", "7 4")):
                path = " ".join(f"{x(row['k']):.1f},{y(row[kind]):.1f}" for row in points)
                more = f' stroke-dasharray="{dash}"' if dash else ""
                colour = COLOURS[index + 1]
                parts.append(f'<polyline points="{path}" fill="none" stroke="{colour}" stroke-width="2"{more}/>')
    return picture(left + 360 * 2 + 20, bottom + 54, "Error against frames averaged", parts)


def drift():
    """Error over the seconds since the touch, by what corrects creep and drift."""
    table = [row for row in rows("drift.csv") if row["design"] == "sensor1-wide" and row["readings"] == "creep-20-drift"]
    corrections = {
        "none": "none",
        "tare": "tare",
        "baseline": "moving baseline",
        "constant-tare": "creep removed, tare",
    }
    seconds = list(dict.fromkeys(row["seconds"] for row in table))
    left, top, bottom, limit = 64, 66, 300, 70
    parts = [text(left, 18, "medians over contacts under constant load, % of the normal force; friction times 100", size=12)]
    for index, words in enumerate(corrections.values()):
        parts.append(text(left + 150 * index, 36, f"● {words}", colour=COLOURS[index], size=12))
    for number, (column, heading) in enumerate((("f_z", "F_z"), ("shear", "shear"), ("friction", "friction µ"))):
        x0 = left + number * 270

        def x(place, x0=x0):
            return x0 + 210 * place / (len(seconds) - 1)

        def y(error):
            return bottom - (bottom - top) * float(error) / limit

        parts.append(text(x0, 56, heading, more=' font-weight="bold"'))
        for error in range(0, limit + 1, 10):
            parts.append(line(x0, y(error), x0 + 210, y(error)))
            parts.append(text(x0 - 8, y(error) + 4, str(error), "end", size=12))
        for place, second in enumerate(seconds):
            parts.append(text(x(place), bottom + 18, second, "middle", size=12))
        parts.append(text(x0 + 105, bottom + 40, "seconds since the touch", "middle", size=12))
        for index, correction in enumerate(corrections):
            points = [row[column] for row in table if row["correction"] == correction]
            path = " ".join(f"{x(place):.1f},{y(value):.1f}" for place, value in enumerate(points))
            parts.append(f'<polyline points="{path}" fill="none" stroke="{COLOURS[index]}" stroke-width="2"/>')
    return picture(left + 270 * 3, bottom + 54, "Error under creep and drift", parts)


def depth():
    """Largest errors over depth by pitch, logarithmic both ways."""
    depths = ["0.3", "0.5", "0.75", "1", "1.5", "2", "3", "4"]
    lines = [
        ("line search", "line", "", 1, "7 4"),
        ("line search, regularised", "line", ", regularised", 1, ""),
        ("grid search, regularised", "grid", ", regularised", 3, ""),
    ]
    table = {(row["estimator"], row["case"]): row for row in rows("corner-cases.csv")}
    left, top, bottom, width = 64, 84, 330, 380
    ends = {"x": (0.25, 5.0), "y": (0.1, 100.0)}
    parts = []
    for number, (name, words) in enumerate((("tangential", "tangential force"), ("normal", "normal force"))):
        x0 = left + number * (width + 70)

        def x(value, x0=x0):
            return x0 + width * math.log(float(value) / ends["x"][0]) / math.log(ends["x"][1] / ends["x"][0])

        def y(error):
            error = min(max(error, ends["y"][0]), ends["y"][1])
            return bottom - (bottom - top) * math.log(error / ends["y"][0]) / math.log(ends["y"][1] / ends["y"][0])

        parts.append(text(x0 - 40, 18, f"largest error of the {words}, %"))
        for at in depths:
            parts.append(line(x(at), top, x(at), bottom))
            parts.append(text(x(at), bottom + 18, at, "middle", size=12))
        for error in (0.1, 1, 10, 100):
            parts.append(line(x0, y(error), x0 + width, y(error)))
            parts.append(text(x0 - 8, y(error) + 4, f"{error:g}", "end", size=12))
        parts.append(text(x0 + width / 2, bottom + 40, "depth / pitch", "middle", size=12))
        for index, (title, estimator, more, colour, dash) in enumerate(lines):
            found = [(at, table.get((estimator, f"h/s = {at}, noise 0.2 %{more}"), {}).get(f"{name}_f64")) for at in depths]
            path = " ".join(f"{x(at):.1f},{y(float(error)):.1f}" for at, error in found if error)
            dashes = f' stroke-dasharray="{dash}"' if dash else ""
            stroke = f'fill="none" stroke="{COLOURS[colour]}" stroke-width="2"{dashes}'
            parts.append(f'<polyline points="{path}" {stroke}/>')
            parts.append(f'<polyline points="{x0},{32 + 16 * index} {x0 + 28},{32 + 16 * index}" {stroke}/>')
            parts.append(text(x0 + 36, 36 + 16 * index, title, colour=COLOURS[colour], size=12))
    return picture(left + 2 * (width + 70), bottom + 54, "Errors over depth by pitch", parts)


def latency():
    """Cycles against taxels, logarithmic both ways, beside the published design."""
    lines = [
        ("line, reduced, no filter", "16", "no filter, 16 lanes", 1, ""),
        ("line, reduced, no filter", "64", "no filter, 64 lanes", 1, "7 4"),
        ("line, reduced, F2 p = 1", "16", "F2 p = 1, 16 lanes", 2, ""),
        ("line, reduced, F2 p = 1", "64", "F2 p = 1, 64 lanes", 2, "7 4"),
    ]
    published = next(float(row["latency_us"]) * 125 for row in rows("published.csv") if row["design"] == "sparse average")
    left, right, top, bottom = 74, 590, 40, 440
    ends = {"x": (14.0, 1100.0), "y": (500.0, 1e7)}

    def x(taxels):
        return left + (right - left) * math.log(taxels / ends["x"][0]) / math.log(ends["x"][1] / ends["x"][0])

    def y(cycles):
        return bottom - (bottom - top) * math.log(cycles / ends["y"][0]) / math.log(ends["y"][1] / ends["y"][0])

    parts = [text(12, 22, "cycles from the first word in to the last word out; dotted: multiply-accumulates / lanes")]
    for taxels in (16, 36, 64, 100, 144, 256, 576, 1024):
        parts.append(line(x(taxels), top, x(taxels), bottom))
        parts.append(text(x(taxels), bottom + 18, str(taxels), "middle", size=12))
    for cycles in (1_000, 10_000, 100_000, 1_000_000, 10_000_000):
        parts.append(line(left, y(cycles), right, y(cycles)))
        parts.append(text(left - 8, y(cycles) + 4, f"{cycles:,}", "end", size=12))
    parts.append(text((left + right) / 2, bottom + 42, "taxels", "middle"))
    labels = []
    for plan, lanes, title, colour, dash in lines:
        points = [row for row in rows("cycles.csv") if row["plan"] == plan and row["lanes"] == lanes]
        places = [(math.prod(int(side) for side in row["taxels"].split(" x ")), row) for row in points]
        measured = [(x(taxels), y(float(row["latency"]))) for taxels, row in places]
        # What the latency of a large sensor tends to, from where it is a large part of it.
        work = [(x(taxels), int(row["macs"]) / int(lanes), float(row["latency"])) for taxels, row in places]
        work = [(at, y(cycles)) for at, cycles, whole in work if cycles > 0.4 * whole]
        for path, dashes in ((measured, dash), (work, "1 4")):
            if len(path) > 1:
                words = " ".join(f"{at:.1f},{height:.1f}" for at, height in path)
                more = f' stroke-dasharray="{dashes}"' if dashes else ""
                parts.append(f'<polyline points="{words}" fill="none" stroke="{COLOURS[colour]}" stroke-width="2"{more}/>')
        for (at, height), (_, row) in zip(measured, places):
            size = 4.5 if row["simulated"] else 2.5
            parts.append(f'<circle cx="{at:.1f}" cy="{height:.1f}" r="{size}" fill="{COLOURS[colour]}"/>')
        labels.append((measured[-1][1], title, COLOURS[colour]))
    free = 0.0
    for height, title, colour in sorted(labels):
        free = max(height, free + 16)
        parts.append(text(right + 10, free + 4, title, colour=colour, size=12))
    parts.append(f'<rect x="{x(100) - 6:.1f}" y="{y(published) - 6:.1f}" width="12" height="12" fill="{COLOURS[0]}"/>')
    parts.append(text(x(100) + 12, y(published) + 4, "published sparse designs, at 125 MHz", size=12))
    return picture(760, bottom + 54, "Latency of a frame against the number of taxels", parts)


PLOTS = {
    "contact-kinds.svg": contact_kinds,
    "depth.svg": depth,
    "drift.svg": drift,
    "error-latency.svg": error_latency,
    "finite-elements.svg": finite_elements,
    "latency.svg": latency,
    "noise.svg": noise,
    "several-contacts.svg": several_contacts,
    "smoothing.svg": smoothing,
}


def main() -> None:
    check = "--check" in sys.argv[1:]
    for name, draw in PLOTS.items():
        drawn, place = draw(), FIGURES / name
        if check:
            if not place.exists() or place.read_text(encoding="utf-8") != drawn:
                sys.exit(f"docs/figures/{name} is not what results/ give: run tools/plots.py")
        else:
            place.write_text(drawn, encoding="utf-8")


if __name__ == "__main__":
    main()
