# SPDX-License-Identifier: MIT OR Apache-2.0
"""Prints the register map of a SystemRDL file as JSON: what the tests hold against the simulated hardware."""

import json
import sys

from systemrdl import RDLCompiler
from systemrdl.node import RegNode


def field(node):
    """One field: its bits, its reset value and what software may do with it."""
    effect = node.get_property("onwrite")
    return {
        "name": node.inst_name,
        "low": node.low,
        "high": node.high,
        "reset": node.get_property("reset") or 0,
        "readable": node.is_sw_readable,
        "writable": node.is_sw_writable,
        "on_write": effect.name if effect else None,
        "pulse": bool(node.get_property("singlepulse")),
    }


def main():
    """Reads the file named on the command line."""
    compiler = RDLCompiler()
    compiler.compile_file(sys.argv[1])
    top = compiler.elaborate().top
    registers = [
        {"name": node.inst_name, "address": node.absolute_address, "fields": [field(each) for each in node.fields()]}
        for node in top.descendants()
        if isinstance(node, RegNode)
    ]
    json.dump(registers, sys.stdout, indent=1)


main()
