#!/usr/bin/env python3
# SPDX-License-Identifier: MIT OR Apache-2.0
"""The README and docs/ as a site with a search, in target/book: what `make book` runs.

The README becomes the first page. A link to a file that is no page leads to a copy of that file beside the pages; one
to a folder leads to its README, or becomes plain text.
"""

import re
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
STAGE = ROOT / "target" / "book-pages"
SITE = ROOT / "target" / "book"
LINK = re.compile(r"(!?)\[([^\]]*)\]\(([^)\s]+)\)")


def pages() -> dict[Path, str]:
    """Each page's file and its name on the site, which has the folders of docs/."""
    named = {"README.md": "index.md", "docs/README.md": "map.md", "docs/decisions/README.md": "decisions/index.md"}
    named |= {"CONTRIBUTING.md": "contributing.md", "CHANGELOG.md": "changelog.md", "results/README.md": "results.md"}
    named |= {"data/README.md": "data.md"}
    names = {ROOT / path: name for path, name in named.items()}
    docs = ROOT / "docs"
    return {path: path.relative_to(docs).as_posix() for path in sorted(docs.rglob("*.md"))} | names


def rewritten(text: str, page: Path, names: dict[Path, str]) -> str:
    """A page's text with the links that hold on the site."""
    depth = names[page].count("/")

    def link(match: re.Match[str]) -> str:
        mark, words, target = match.groups()
        if ":" in target or target.startswith("#"):
            return match[0]
        path, _, anchor = target.partition("#")
        file = (page.parent / path).resolve()
        if not file.exists():
            sys.exit(f"{page.relative_to(ROOT)}: there is no {target}")
        if file.is_dir():
            file = file / "README.md"
        if not file.exists():
            return words
        name = names.get(file)
        if name is None:
            name = f"files/{file.relative_to(ROOT)}"
            copy = STAGE / name
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(file, copy)
        return f"{mark}[{words}]({'../' * depth}{name}{'#' if anchor else ''}{anchor})"

    return LINK.sub(link, text)


def main() -> None:
    shutil.rmtree(STAGE, ignore_errors=True)
    STAGE.mkdir(parents=True)
    names = pages()
    for page, name in names.items():
        (STAGE / name).parent.mkdir(parents=True, exist_ok=True)
        (STAGE / name).write_text(rewritten(page.read_text(encoding="utf-8"), page, names), encoding="utf-8")
    command = [sys.executable, "-m", "mkdocs", "build", "--strict", "--quiet", "--config-file", ROOT / "tools" / "book.yml"]
    done = subprocess.run(command, cwd=ROOT, check=False)
    if done.returncode:
        sys.exit(done.returncode)
    site = SITE.relative_to(ROOT)
    print(f"{len(names)} pages in {site}: open index.html; the search wants a server: python3 -m http.server -d {site}")


if __name__ == "__main__":
    main()
