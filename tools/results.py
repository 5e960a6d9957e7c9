#!/usr/bin/env python3
# SPDX-License-Identifier: MIT OR Apache-2.0
"""Measured figures as CSV: results.py bench|corner-cases FIGURES.json [--out results]

FIGURES.json is what the measuring command prints. Each file keeps the lines above its header that say what
its rows are; a new file has none yet. The line of its designs, with their hashes, is made anew.
"""

import argparse
import csv
import json
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PLANS = {
    "reduced": "line, reduced, no filter",
    "filtered": "line, reduced, F2 p = 1",
    "paper": "line, paper, no filter",
    "joint": "grid search, reduced, no filter",
}
GROUPS = {
    "depth": "Depth over pitch", "size": "Size", "contact": "Contacts", "kind": "Contacts of other kinds",
    "direction": "Directions", "sensor": "The sensor's errors", "range": "Ends of the range",
    "frame": "Frames without an answer",
}  # fmt: skip
ESTIMATORS = {"line": "line", "joint": "grid"}
# What of the figures each file shows, of those that are of designs.
OF_DESIGNS = {
    "solver-speed.csv": "solver", "generation-time.csv": "generation", "simulation-speed.csv": "simulation",
    "filters.csv": "filters", "cells.csv": "cells",
}  # fmt: skip
DESIGNS = "# designs: "


def stem(path: str) -> str:
    return Path(path.strip("`")).stem if path.strip("`").endswith(".toml") else path


def designs(rows: list[dict]) -> list[str]:
    """The line that names designs and hashes, as other measured tables have it."""
    hashes = {stem(row.get("file", row["design"])): row["hash"] for row in rows if row["hash"]}
    return [DESIGNS + ", ".join(f"{name} {of}" for name, of in hashes.items())] if hashes else []


def shown(value: float | None, digits: int) -> str:
    return "" if value is None else f"{value:.{digits}f}"


def scientific(value: float | None) -> str:
    """One digit: 3e-5; larger numbers to a tenth."""
    if value is None:
        return ""
    if 0.1 <= value < 1e3:
        return f"{value:.1f}"
    digits, _, exponent = f"{value:.0e}".partition("e")
    return f"{digits}e{int(exponent)}"


def bench(figures: dict) -> dict[str, tuple[list[str], list[list]]]:
    """Files by name: header and rows."""
    files = {}
    files["solver-speed.csv"] = (
        ["design", "plan", "taxels", "set_up_s", "frame_by_frame", "in_batches", "all_cores"],
        [
            [
                row["design"], row["plan"], row["taxels"], shown(row["setup_s"], 2),
                *(round(row[key]["frames_per_second"]) for key in ("one_by_one", "in_batches", "on_all_cores")),
            ]
            for row in figures["solver"]
        ],
    )  # fmt: skip
    files["generation-time.csv"] = (
        ["design", "taxels", "plan_s", "files_s", "together_s", "files_mb", "memory_mb"],
        [
            [
                stem(row["design"]), row["taxels"], shown(row["plan_s"], 3), shown(row["emit_s"], 3),
                shown(row["plan_s"] + row["emit_s"], 3), shown(row["bytes"] / 1e6, 1),
                shown(row["memory"] and row["memory"] / 1e6, 0),
            ]
            for row in figures["generation"]
        ],
    )  # fmt: skip
    files["simulation-speed.csv"] = (
        ["design", "lanes", "cycles_per_second", "frames_per_second"],
        [
            [stem(row["design"]), row["lanes"], round(row["cycles_per_second"]), shown(row["frames_per_second"], 1)]
            for row in figures["simulation"]
        ],
    )
    points = []
    for row in figures["cycles"]:
        cycles, side = row["predicted"], row["side"]
        yes = "yes" if row["simulated"] == cycles else "" if row["simulated"] is None else "DIFFERS"
        points.append(
            [PLANS[row["kind"]], f"{side} x {side}", row["macs"], row["lanes"], cycles["latency"], cycles["interval"], yes]
        )
    files["cycles.csv"] = (["plan", "taxels", "macs", "lanes", "latency", "interval", "simulated"], points)
    files["filters.csv"] = (
        ["design", "filter", "macs", "latency", "interval", "ramb36", "force_percent", "friction"],
        [
            [
                stem(row["design"]), row["filter"], row["macs"], row["latency"], row["interval"], shown(row["bram36"], 1),
                shown(100 * row["field_error"], 2), shown(row["friction_error"], 4),
            ]
            for row in figures["filters"]
        ],
    )  # fmt: skip
    cells = []
    for design in figures["cells"]:
        for block in [*design["blocks"], design["total"]]:
            yosys, predicted, longest = block["yosys"], block["predicted"], block.get("longest")
            cells.append(
                [
                    design["design"].replace("_", "-"), block["name"], yosys["dsp"], predicted["dsp"],
                    shown(yosys["bram36"], 1), shown(predicted["bram36"], 1), yosys["lut"], yosys["ff"],
                    longest["levels"] if longest else "",
                ]
            )  # fmt: skip
    header = ["design", "block", "dsp", "dsp_predicted", "ramb36", "ramb36_predicted", "lut", "ff", "levels"]
    files["cells.csv"] = (header, cells)
    return {name: file for name, file in files.items() if file[1]}


def corner_cases(rows: list[dict]) -> dict[str, tuple[list[str], list[list]]]:
    """The one file of corner cases."""
    header = ["group", "estimator", "case", "cond_c33", "cond_a"]
    figures = [
        ("backward", "backward", ("f64", "f32", "fixed", "wide"), scientific),
        ("tangential", "tangential", ("f64", "f32", "fixed"), lambda value: shown(value, 1)),
        ("normal", "normal", ("f64", "f32", "fixed"), lambda value: shown(value, 1)),
        ("field", "against_f64", ("f32", "fixed", "wide"), scientific),
        ("field_at_own_friction", "at_its_friction", ("f32", "fixed", "wide"), scientific),
    ]
    header += [f"{name}_{arithmetic}" for name, _, arithmetics, _ in figures for arithmetic in arithmetics]
    found = []
    for row in rows:
        cells = [GROUPS.get(row["group"], GROUPS["depth"]), ESTIMATORS[row["estimator"]], row["case"]]
        # The estimators share the matrices, and the gain of the grid search is no error of theirs.
        grid = row["estimator"] == "joint"
        cells += ["", ""] if grid else [scientific(row["condition_c33"]), scientific(row["condition_aat"])]
        for name, key, arithmetics, show in figures:
            skip = grid and name == "backward"
            cells += ["" if skip else show((row[arithmetic] or {}).get(key)) for arithmetic in arithmetics]
        same = {True: "yes", False: "DIFFERS", None: ""}[row["rtl_is_model"]]
        status = [f"{count} {name}" for name, count in (row["fixed"] or {}).get("status", [])]
        found.append([*cells, same, ", ".join(status) or ("refused" if row["refusal"] else "")])
    return {"corner-cases.csv": ([*header, "rtl_is_model", "status"], found)}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("what", choices=["bench", "corner-cases"])
    parser.add_argument("figures", type=Path)
    parser.add_argument("--out", type=Path, default=ROOT / "results")
    given = parser.parse_args()
    figures = json.loads(given.figures.read_text(encoding="utf-8"))
    for name, (header, rows) in (bench if given.what == "bench" else corner_cases)(figures).items():
        place = given.out / name
        old = place.read_text(encoding="utf-8").splitlines() if place.exists() else []
        about = [line for line in old if line.startswith("#") and not line.startswith(DESIGNS)]
        about += designs(figures[OF_DESIGNS[name]]) if name in OF_DESIGNS else []
        with open(place, "w", encoding="utf-8", newline="") as file:
            file.writelines(f"{line}\n" for line in about)
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(header)
            writer.writerows(rows)
        print(f"{len(rows)} rows in {place}")


if __name__ == "__main__":
    main()
