#!/usr/bin/env python3
# SPDX-License-Identifier: MIT OR Apache-2.0
"""Checks of README, docs, headers of Verilog files and help: check_text.py [--root DIR]

Words of the README and of all pages, sentence length, table cells, old vocabulary, and numbers marked with a row of
results/. A mark stands behind a number, <!--FILE ROW COLUMN-->; ROW is the first cells of a row, joined by "/", in
quotes where it has spaces. A line <!-- table FILE: COLUMN, COLUMN --> above a table marks its columns behind the first,
which names the row in backticks. The exit code is 1 if anything is wrong.
"""

import argparse
import csv
import re
import sys
from pathlib import Path

README_WORDS, ALL_WORDS = 1000, 30_000
MEAN, LONGEST, LONGEST_IN_HEADERS, CELL = 18.0, 35, 25, 80
# Words that the project does not use any more, and what to write.
OLD = {
    "told apart": "separated", "tells apart": "separates", "parted": "separated", "parting": "separation",
    "doubtful": "low confidence", "as ever": "", "errs": "has an error of", "err by": "have errors of",
    "the door": "ingress FIFO", "census": "contact counters", "eighths": "", "twins": "tied weights",
    "hinges": "rectifiers", "walked over": "searched serially", "what is left of": "remaining", "half as good": "",
    "says so": "", "tells its error": "standard error", "body": "contact", "bodies": "contacts", "blob": "component",
    "blobs": "components", "narrow family": "training set sliding", "wide family": "training set general",
    "golden solve": "sptfra solve", "golden check": "sptfra check", "golden calibrate": "sptfra calibrate",
    "hdl-gen generate": "sptfra generate", "hdl-gen inspect": "sptfra inspect", "testbench run": "sptfra run",
    "stand-in": "stub", "joint estimator": "grid search", "line estimator": "line search",
}  # fmt: skip
# Pages that name old words on purpose.
NAMES_OLD_WORDS = {"CHANGELOG.md"}
MARK = re.compile(r"(-?[\d,]*\.?\d+)(?:\s*%)?\s*<!--([\w.-]+\.csv) (\"[^\"]+\"|\S+) (\w+)-->")
TABLE = re.compile(r"<!-- table ([\w.-]+\.csv): ([\w, ]+) -->\n((?:\|.*\n)+)")


def pages(root: Path) -> list[Path]:
    named = ["README.md", "CONTRIBUTING.md", "CHANGELOG.md", "data/README.md", "python/README.md", "rtl-out/README.md"]
    found = [root / name for name in [*named, "results/README.md"] if (root / name).exists()]
    return found + sorted((root / "docs").rglob("*.md"))


def headers(root: Path) -> list[tuple[str, list[str], int]]:
    """Verilog files and commands: name, blocks of the header or of the help, and the most words of a sentence."""
    found = []
    for path in sorted((root / "hdl-gen/rtl").rglob("*.v")):
        comment = re.match(r"(?:\s*//.*\n)*", path.read_text(encoding="utf-8"))[0]
        lines = [line.removeprefix("//").rstrip() for line in comment.splitlines()]
        running = [line.strip() for line in lines if not re.search(r"\S  +\S|SPDX|`[0-9]`", line)]
        found.append((str(path.relative_to(root)), "\n".join(running).split("\n\n"), LONGEST_IN_HEADERS))
    for path in sorted((root / "cli/src/commands").glob("*.rs")):
        lines = [line.strip().removeprefix("///").strip() for line in path.read_text(encoding="utf-8").splitlines()
                 if re.match(r"\s*///|\s*$|\s*#\[", line)]
        lines = ["" if line.startswith("#[") else line for line in lines]
        found.append((str(path.relative_to(root)), "\n".join(lines).split("\n\n"), LONGEST))
    return [(name, [" ".join(block.split()) for block in blocks], most) for name, blocks, most in found]


def parameters(root: Path) -> list[str]:
    """Parameters of modules without their meaning: a comment says it of up to three, or names the module that does."""
    wrong = []
    for path in sorted((root / "hdl-gen/rtl").rglob("*.v")):
        listed = re.search(r"\nmodule \w+ #\(\n(.*?)\n\) \(", path.read_text(encoding="utf-8"), re.DOTALL)
        for said, group in re.findall(r"((?: *//.*\n)*)((?:(?! *//).+\n?)+)", listed[1] if listed else ""):
            names = re.findall(r"^ *parameter [^=\n]*?(\w+)(?: =|$)", group, re.MULTILINE)
            if not said or (len(names) > 3 and not re.search("sptfra_|Derived", said)):
                wrong.append(f"{path.relative_to(root)}: say what {', '.join(names)} mean, up to three in a comment")
    return wrong


def prose(text: str) -> tuple[list[str], list[str]]:
    """Blocks of running text, and the cells of tables, without code, comments and headings."""
    text = re.sub(r"<!--.*?-->", "", text, flags=re.DOTALL)
    text = re.sub(r"^---\n.*?\n---\n|```.*?```", "\n", text, flags=re.DOTALL)
    blocks, cells = [], []
    for block in re.split(r"\n\s*\n", text):
        lines = block.splitlines()
        for row in (line for line in lines if line.lstrip().startswith("|")):
            parts = [cell.strip() for cell in re.split(r"(?<!\\)\|", row)[1:-1]]
            cells += [cell for cell in parts if not re.fullmatch(r"[:\s-]*", cell)]
        running = [line for line in lines if not line.lstrip().startswith(("|", "#", "![")) and line[:4] != "    "]
        points = [re.sub(r"^\s*([*+-]|\d+\.)\s+", "\n", line) for line in running]
        blocks.append(" ".join(points).replace(" \n", "\n"))
    return blocks, cells


def plain(text: str) -> str:
    text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", text)
    return re.sub(r"[*_]", "", re.sub(r"`[^`]*`", "x", text))


def sentences(blocks: list[str], ends: str = r"(?<=[.!?:])\s+(?=[A-Z`\"(0-9*\[])") -> list[str]:
    lines = [line for block in blocks for line in block.split("\n")]
    return [one for line in lines for one in re.split(ends, plain(line)) if len(one.split()) > 2]


def value(text: str) -> float:
    return float(text.replace(",", ""))


class Results:
    """Rows of results/, read once."""

    def __init__(self, root: Path) -> None:
        self.folder, self.files = root / "results", {}

    def find(self, name: str, row: str, column: str) -> str:
        """A cell, or an error that says what is missing."""
        if name not in self.files:
            with open(self.folder / name, encoding="utf-8") as file:
                self.files[name] = list(csv.reader(line for line in file if not line.startswith("#")))
        head, *rows = self.files[name]
        keys = row.strip('"').split("/")
        found = [cells for cells in rows if cells[: len(keys)] == keys]
        if column not in head or len(found) != 1:
            raise LookupError(f"results/{name}: {len(found)} rows {keys}, columns {head}")
        return found[0][head.index(column)]


def agree(stated: str, measured: str) -> bool:
    """Whether a stated number is the measured one, rounded to the digits that it has."""
    digits = len(stated.partition(".")[2])
    return abs(value(stated) - value(measured)) <= 0.5 * 10.0**-digits + 1e-9


def marked(text: str) -> list[tuple[str, str, str, str]]:
    """Numbers with a mark: as stated, file, row, column."""
    found = [match.groups() for match in MARK.finditer(text)]
    for name, columns, table in TABLE.findall(text):
        for line in table.splitlines()[2:]:
            cells = [re.sub(r"<!--.*?-->", "", cell).strip() for cell in line.split("|")[1:-1]]
            row = re.search(r"`([^`]+)`", cells[0])
            for cell, column in zip(cells[1:], columns.split(",")):
                if row:
                    found.append((cell, name, row[1], column.strip()))
    return found


def old_words(name: str, text: str) -> list[str]:
    old = {} if name in NAMES_OLD_WORDS else OLD
    found = [word for word in old if re.search(rf"\b{re.escape(word)}\b", text.lower())]
    return [f"{name}: {word!r}; write {old[word] or 'it otherwise'!r}" for word in found]


def check(root: Path) -> list[str]:
    wrong: list[str] = []
    results, lengths, total = Results(root), [], 0
    for page in pages(root):
        name, text = str(page.relative_to(root)), page.read_text(encoding="utf-8")
        blocks, cells = prose(text)
        words = len(plain(" ".join(blocks + cells)).split())
        total += words
        if name == "README.md" and words > README_WORDS:
            wrong.append(f"{name}: {words} words; at most {README_WORDS}")
        if name == "CHANGELOG.md":
            entries = text.count("\n- ", text.index("## ["), text.index("## [", text.index("## [") + 1))
            if entries > 60:
                wrong.append(f"{name}: {entries} unreleased entries; at most 60")
        for sentence in sentences(blocks):
            lengths.append(len(sentence.split()))
            if lengths[-1] > LONGEST:
                wrong.append(f"{name}: {lengths[-1]} words: {sentence[:90]}…")
        wrong += [f"{name}: a cell of {len(plain(cell))} characters: {cell}" for cell in cells if len(plain(cell)) > CELL]
        wrong += old_words(name, plain(" ".join(blocks + cells)))
        for stated, file, row, column in marked(text):
            try:
                measured = results.find(file, row, column)
                if not agree(stated, measured):
                    wrong.append(f"{name}: states {stated}, results/{file} {row} {column} is {measured}")
            except (LookupError, OSError, ValueError) as error:
                wrong.append(f"{name}: {stated}: {error}")
    for name, blocks, most in headers(root):
        long = [sentence for sentence in sentences(blocks, r"(?<=[.!?:])\s+") if len(sentence.split()) > most]
        wrong += [f"{name}: {len(sentence.split())} words: {sentence[:90]}…" for sentence in long]
        wrong += old_words(name, plain(" ".join(blocks)))
    wrong += parameters(root)
    if total > ALL_WORDS:
        wrong.append(f"{total} words in all; at most {ALL_WORDS}")
    mean = sum(lengths) / max(len(lengths), 1)
    if mean > MEAN:
        wrong.append(f"{mean:.1f} words a sentence; at most {MEAN:.0f}")
    if not wrong:
        print(f"{total} words, {len(lengths)} sentences of {mean:.1f} words")
    return wrong


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--root", type=Path, default=Path(__file__).resolve().parent.parent)
    wrong = check(parser.parse_args().root)
    print("\n".join(wrong), end="\n" if wrong else "")
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
