# SPDX-License-Identifier: MIT OR Apache-2.0
"""Moves registers of an ECP5 netlist into the block memories and multipliers beside them.

    pack_registers.py NETLIST.json TOP

A block memory has a register at its output, a multiplier one at each input and one at its output; tools of FPGA vendors
use them for the registers that a design has there anyway. Yosys leaves those outside, and nextpnr takes a netlist as it is.
The flat netlist is rewritten in place. Cycles stay as they are: a register moves, none is added.

A register moves only if all bits of a port go through registers of one clock and one enable, without a reset, and nothing
else reads what is in front of them (behind them, at the inputs of a multiplier). In front of a multiplier it stays where a
block memory answers into it, straight or through a LUT, and does not go into the memory either: the way between the two
columns is long, and a register that can stand anywhere parts it.
"""

import collections
import json
import pathlib
import sys

CONSTANTS = ("0", "1", "x", "z")


class Netlist:
    """Cells by what drives and what reads a bit."""

    def __init__(self, module):
        self.cells = module["cells"]
        self.readers = collections.defaultdict(set)
        self.drivers = {}
        for name, cell in self.cells.items():
            for port, bits in cell["connections"].items():
                self.connect(name, port, bits)
        # What leaves the module is read by somebody.
        for port, wire in module["ports"].items():
            for bit in wire["bits"]:
                self.readers[bit].add((None, port))

    def connect(self, name, port, bits):
        for bit in bits:
            if bit in CONSTANTS:
                continue
            if self.cells[name]["port_directions"].get(port) == "output":
                self.drivers[bit] = (name, port)
            else:
                self.readers[bit].add((name, port))

    def change(self, name, port, bit, direction="input"):
        """Connects a port of one bit to another one."""
        cell = self.cells[name]
        for old in cell["connections"].get(port, ()):
            self.readers[old].discard((name, port))
        cell["port_directions"][port] = direction
        cell["connections"][port] = [bit]
        self.connect(name, port, [bit])

    def remove(self, name):
        for port, bits in self.cells.pop(name)["connections"].items():
            for bit in bits:
                self.readers[bit].discard((name, port))

    def plain(self, name):
        """Clock and enable of a register without a reset; None of any other cell."""
        cell = self.cells.get(name)
        if cell is None or cell["type"] != "TRELLIS_FF":
            return None
        parameters, wires = cell["parameters"], cell["connections"]
        if parameters.get("CLKMUX", "CLK") != "CLK" or wires.get("LSR", ["0"]) != ["0"] or "M" in wires:
            return None
        enables = {"1 ": "1", "1": "1", "CE": wires.get("CE", ["1"])[0]}
        enable = enables.get(parameters.get("CEMUX", "CE"))
        return None if enable is None else (wires["CLK"][0], enable)

    def behind(self, bits):
        """The registers that are all that reads these bits, and their clock and enable; None if there are none such."""
        registers, kinds = [], set()
        for bit in bits:
            readers = list(self.readers[bit])
            if not readers:
                continue
            if len(readers) != 1 or readers[0][1] != "DI":
                return None
            registers.append(readers[0][0])
            kinds.add(self.plain(readers[0][0]))
        return (registers, kinds.pop()) if len(kinds) == 1 and None not in kinds else None

    def absorb_behind(self, name, ports, registers):
        """The ports drive what the registers drove."""
        for port in ports:
            bit = self.cells[name]["connections"].get(port, ["x"])[0]
            register = next((register for register in registers if self.of(register, "DI") == bit), None)
            if register is not None:
                after = self.of(register, "Q")
                self.remove(register)
                self.change(name, port, after, "output")

    def of(self, name, port):
        """The bit of a port; None of a cell that is gone."""
        return self.cells[name]["connections"][port][0] if name in self.cells else None


def number(value):
    return int(value, 2) if isinstance(value, str) else value


def pack_memory(netlist, name):
    """Registers behind a block memory: so many."""
    cell = netlist.cells[name]
    both = number(cell["parameters"].get("DATA_WIDTH_A", 18)) == 36
    packed = 0
    for sides, reads in [("AB", "B")] if both else [("A", "A"), ("B", "B")]:
        ports = [f"DO{side}{index}" for side in sides for index in range(18)]
        wires = cell["connections"]
        found = netlist.behind([wires[port][0] for port in ports if port in wires])
        clock, reading = wires.get(f"CLK{reads}", ["0"])[0], wires.get(f"CE{reads}", ["1"])[0]
        # The port's own enable may hold its register, too.
        if found is None or found[1][0] != clock or reading not in ("1", found[1][1]):
            continue
        if any(multiplies(netlist, netlist.of(register, "Q")) for register in found[0]):
            continue
        netlist.absorb_behind(name, ports, found[0])
        for side in sides:
            cell["parameters"][f"REGMODE_{side}"] = "OUTREG"
            netlist.change(name, f"OCE{side}", found[1][1])
        packed += len(found[0])
    return packed


def pack_output(netlist, name):
    """Registers behind a multiplier: so many."""
    wires = netlist.cells[name]["connections"]
    ports = [f"P{index}" for index in range(36)]
    found = netlist.behind([wires[port][0] for port in ports if port in wires])
    if found is None:
        return 0
    netlist.absorb_behind(name, ports, found[0])
    clocked(netlist, name, "OUTPUT", 1, found[1])
    return len(found[0])


def answers(netlist, bit, through=True):
    """Whether a bit comes from a block memory, straight or through a LUT."""
    cell = netlist.cells.get(netlist.drivers.get(bit, (None, None))[0])
    if cell is None or cell["type"] == "DP16KD":
        return cell is not None
    reads = [bits[0] for port, bits in cell["connections"].items() if cell["port_directions"][port] == "input"]
    return through and cell["type"] == "LUT4" and any(answers(netlist, bit, False) for bit in reads)


def multiplies(netlist, bit):
    """Whether a bit goes into a multiplier."""
    return any(name is not None and netlist.cells[name]["type"] == "MULT18X18D" for name, _ in netlist.readers[bit])


def pack_inputs(netlist, name):
    """Registers in front of both inputs of a multiplier: so many."""
    wires = netlist.cells[name]["connections"]
    ports = [side + str(index) for side in "AB" for index in range(18)]
    sources, kinds = {}, set()
    for port in ports:
        bit = wires.get(port, ["0"])[0]
        if bit in CONSTANTS:
            continue
        register, output = netlist.drivers.get(bit, (None, None))
        sources[port] = register
        kinds.add(netlist.plain(register) if output == "Q" else None)
    if len(kinds) != 1 or None in kinds or any(answers(netlist, netlist.of(name, "DI")) for name in sources.values()):
        return 0
    for port, register in sources.items():
        netlist.change(name, port, netlist.of(register, "DI"))
    kind = kinds.pop()
    for side in "AB":
        clocked(netlist, name, f"INPUT{side}", 0, kind)
    registers = set(sources.values())
    for register in registers:
        if not netlist.readers[netlist.of(register, "Q")]:
            netlist.remove(register)
    return len(registers)


def clocked(netlist, name, which, enable, kind):
    """A register of a multiplier works; the clock is the first of four, each kind has an enable of its own."""
    parameters = netlist.cells[name]["parameters"]
    parameters |= {f"REG_{which}_CLK": "CLK0", f"REG_{which}_CE": f"CE{enable}", f"REG_{which}_RST": "RST0"}
    netlist.change(name, "CLK0", kind[0])
    netlist.change(name, f"CE{enable}", kind[1])
    netlist.change(name, "RST0", "0")


def main():
    path, top = pathlib.Path(sys.argv[1]), sys.argv[2]
    design = json.loads(path.read_text())
    netlist = Netlist(design["modules"][top])
    counts = collections.Counter()
    for kind, what, pack in [
        ("MULT18X18D", "in front of multipliers", pack_inputs),
        ("MULT18X18D", "behind multipliers", pack_output),
        ("DP16KD", "behind block memories", pack_memory),
    ]:
        for name in [name for name, cell in netlist.cells.items() if cell["type"] == kind]:
            counts[what] += pack(netlist, name)
    path.write_text(json.dumps(design))
    print("registers packed:", ", ".join(f"{count} {what}" for what, count in counts.items()))


if __name__ == "__main__":
    main()
