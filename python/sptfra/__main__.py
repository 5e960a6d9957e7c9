# SPDX-License-Identifier: MIT OR Apache-2.0
"""The command `sptfra`, which the wheel installs: the same as the one that `cargo build` makes."""

import sys

from ._native import command


def main() -> int:
    """Runs the command line of this process and returns the exit code."""
    return command(["sptfra", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
