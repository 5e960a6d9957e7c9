#!/usr/bin/env python3
# SPDX-License-Identifier: MIT OR Apache-2.0
"""A release of the version in Cargo.toml: dist.py COMMANDS OUT

COMMANDS is the folder with the built command; the archive goes to OUT. It holds
it with its manual pages, completions, licences, designs, scenes and boards, docs, drivers, and this version's part of
CHANGELOG.md. The same files give the same bytes.

    dist.py --notes             prints that part alone, as a release's description
    dist.py --check TAG         fails unless TAG is the version's and the changelog has it
    dist.py --cut VERSION [DAY] makes the changelog's unreleased part that of VERSION, of today or of DAY (2026-01-31), and
                                writes VERSION into Cargo.toml, Cargo.lock and CITATION.cff
"""

import datetime
import gzip
import io
import os
import platform
import re
import subprocess
import sys
import tarfile
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
COMMANDS = ["sptfra"]
# Where each shell looks for completions under a prefix.
SHELLS = {
    "bash": "share/bash-completion/completions/{}",
    "zsh": "share/zsh/site-functions/_{}",
    "fish": "share/fish/vendor_completions.d/{}.fish",
}
FILES = ["README.md", "CONTRIBUTING.md", "CHANGELOG.md", "CITATION.cff", "LICENSE-MIT", "LICENSE-APACHE"]
FOLDERS = ["designs", "scenes", "docs", "results", "drivers", "data", "hdl-gen/boards"]


def version() -> str:
    """The workspace's version, which every crate, generated folder and wheel has."""
    package = (ROOT / "Cargo.toml").read_text(encoding="utf-8").split("[workspace.package]")[1]
    found = re.search(r'^version = "(.+)"$', package, flags=re.MULTILINE)
    return found[1] if found else sys.exit("dist: Cargo.toml has no version under [workspace.package]")


def notes(of: str) -> str | None:
    """The changelog's part on a version, or on what is not released yet; nothing if it has none."""
    parts = re.split(r"^## \[(.+?)\].*\n", (ROOT / "CHANGELOG.md").read_text(encoding="utf-8"), flags=re.MULTILINE)
    sections = dict(zip(parts[1::2], parts[2::2]))
    text = sections.get(of)
    return text.strip() + "\n" if text is not None else None


def numbers(of: str) -> tuple[int, ...]:
    """A version's numbers, to compare by."""
    if not re.fullmatch(r"\d+\.\d+\.\d+", of):
        sys.exit(f"dist: {of} is no version; give three numbers, such as 1.2.0")
    return tuple(map(int, of.split(".")))


def with_version(text: str, before: str, pattern: str, of: str, place: str) -> str:
    """The text with another version where the pattern, whose groups stand around it, finds the one before."""
    pattern = pattern.replace("VERSION", re.escape(before))
    changed, found = re.subn(pattern, lambda match: match[1] + of + match[2], text, flags=re.MULTILINE)
    return changed if found else sys.exit(f"dist: {place} has no version {before}")


def cut(of: str, day: str) -> None:
    """Makes what is not released yet the release `of`: all four files, or none."""
    before = version()
    if numbers(of) < numbers(before):
        sys.exit(f"dist: {of} is older than {before}, the version in Cargo.toml")
    if notes(of) is not None:
        sys.exit(f"dist: CHANGELOG.md has a section [{of}] already; choose the next version")
    if not (notes("Unreleased") or "").strip():
        sys.exit("dist: CHANGELOG.md says nothing under [Unreleased]; write down what is new first")
    names = ["CHANGELOG.md", "Cargo.toml", "Cargo.lock", "CITATION.cff"]
    texts = {name: (ROOT / name).read_text(encoding="utf-8") for name in names}
    heading = "## [Unreleased]\n"
    texts["CHANGELOG.md"] = texts["CHANGELOG.md"].replace(heading, f"{heading}\n## [{of}] - {day}\n", 1)
    # A crate of the workspace is a package without a source.
    for name, pattern in [
        ("Cargo.toml", r'(^\[workspace\.package\](?:\n[^[].*)*?\nversion = ")VERSION(")'),
        ("Cargo.lock", r'(^name = ".+"\nversion = ")VERSION("\n(?!source))'),
        ("CITATION.cff", r"(^version: )VERSION($)"),
    ]:
        texts[name] = with_version(texts[name], before, pattern, of, name)
    for name, text in texts.items():
        unfinished = ROOT / f"{name}.unfinished"
        unfinished.write_text(text, encoding="utf-8")
    for name in names:
        (ROOT / f"{name}.unfinished").replace(ROOT / name)
    print(f"dist: {of}, {day}, in {', '.join(names)}; look at them, commit, and tag v{of}")


def in_git(folder: str) -> list[Path]:
    """The files of a folder that belong to the project; of an unpacked source, all of them."""
    listed = subprocess.run(["git", "ls-files", "-z", folder], cwd=ROOT, capture_output=True, check=False)
    if listed.returncode == 0:
        return [ROOT / name for name in listed.stdout.decode().split("\0") if name]
    return [path for path in (ROOT / folder).rglob("*") if path.is_file()]


def contents(built: Path) -> dict[str, tuple[bytes, int]]:
    """Path in the archive, to bytes and mode."""
    found: dict[str, tuple[bytes, int]] = {}
    for command in COMMANDS:
        program = built / command
        if not program.is_file():
            sys.exit(f"dist: {program} is missing: run `make dist`")
        found[f"bin/{command}"] = (program.read_bytes(), 0o755)
        for shell, place in SHELLS.items():
            said = subprocess.run([program, "completions", shell], capture_output=True, check=True).stdout
            found[place.format(command)] = (said, 0o644)
        with tempfile.TemporaryDirectory() as pages:
            subprocess.run([program, "man", "--out", pages], check=True, capture_output=True)
            for page in Path(pages).glob("*.1"):
                found[f"share/man/man1/{page.name}"] = (page.read_bytes(), 0o644)
    for path in [ROOT / name for name in FILES] + [path for folder in FOLDERS for path in in_git(folder)]:
        mode = 0o755 if os.access(path, os.X_OK) else 0o644
        found[f"share/sptfra/{path.relative_to(ROOT)}"] = (path.read_bytes(), mode)
    return found


def archive(folder: Path, name: str, files: dict[str, tuple[bytes, int]]) -> Path:
    """Writes the archive, whole or not at all."""
    packed = io.BytesIO()
    with tarfile.open(fileobj=packed, mode="w", format=tarfile.PAX_FORMAT) as tar:
        for path, (data, mode) in sorted(files.items()):
            entry = tarfile.TarInfo(f"{name}/{path}")
            entry.size, entry.mode, entry.mtime = len(data), mode, 0
            tar.addfile(entry, io.BytesIO(data))
    place = folder / f"{name}.tar.gz"
    unfinished = place.with_suffix(".unfinished")
    unfinished.write_bytes(gzip.compress(packed.getvalue(), mtime=0))
    unfinished.replace(place)
    return place


def main(arguments: list[str]) -> None:
    now = version()
    if arguments == ["--notes"]:
        print(notes(now) or notes("Unreleased") or "", end="")
        return
    if len(arguments) == 2 and arguments[0] == "--check":
        if arguments[1] != f"v{now}":
            sys.exit(f"dist: the tag is {arguments[1]}, the version in Cargo.toml {now}: tag v{now}, or change Cargo.toml")
        if not notes(now):
            sys.exit(f"dist: CHANGELOG.md has no section [{now}]: rename [Unreleased]")
        return
    if len(arguments) in (2, 3) and arguments[0] == "--cut":
        day = arguments[2] if len(arguments) == 3 else datetime.date.today().isoformat()
        try:
            day = datetime.date.fromisoformat(day).isoformat()
        except ValueError:
            sys.exit(f"dist: {day} is no day; write it as 2026-01-31")
        cut(arguments[1], day)
        return
    if len(arguments) != 2 or arguments[0].startswith("--"):
        sys.exit(__doc__)
    folder = Path(arguments[1])
    folder.mkdir(parents=True, exist_ok=True)
    name = f"sptfra-{now}-{platform.machine()}-{platform.system().lower()}"
    files = contents(Path(arguments[0]))
    files["NOTES.md"] = ((notes(now) or notes("Unreleased") or "").encode(), 0o644)
    place = archive(folder, name, files)
    print(f"{place}: {len(files)} files, {place.stat().st_size / 1e6:.1f} MB")


if __name__ == "__main__":
    main(sys.argv[1:])
