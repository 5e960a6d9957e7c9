# SPDX-License-Identifier: MIT OR Apache-2.0
"""Runs the code of a notebook, cell after cell, without Jupyter: run_notebook.py NOTEBOOK PICTURE

The last picture that a cell draws goes to PICTURE. A cell that was saved with its output fails: outputs age.
"""

import json
import sys
from pathlib import Path

import matplotlib

matplotlib.use("svg")


def main(notebook: Path, picture: Path) -> None:
    cells = json.loads(notebook.read_text(encoding="utf-8"))["cells"]
    names: dict[str, object] = {}
    for number, cell in enumerate(cells):
        if cell["cell_type"] == "code":
            if cell["outputs"]:
                sys.exit(f"{notebook}: cell {number} has outputs; clear them before it is stored")
            exec(compile("".join(cell["source"]), f"{notebook}, cell {number}", "exec"), names)
    from matplotlib import pyplot

    pyplot.savefig(picture)


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
