# SPDX-License-Identifier: MIT OR Apache-2.0
"""A board on the desk: the simulated core as PYNQ would present it, for scripts that run on the board later.

    from sptfra_board import Sptfra
    from sptfra_desk import Overlay, allocate    # on the board: from pynq import Overlay, allocate

    overlay = Overlay("core.so")                 # on the board: Overlay("NAME_BOARD.bit"); `sptfra build DESIGN` names it
    sensor = Sptfra(overlay.core, overlay.dma, allocate)

Needs a C compiler, once for each start: registers, DMA and memory are drivers/simulated.
"""

import ctypes
import os
import pathlib
import shutil
import subprocess
import tempfile

import numpy as np

PAGE = 4096
# As in machine.h.
DMA, CORE, BUS_OFFSET = 0xA0000000, 0xA0010000, 0x100000000000
SIMULATED = pathlib.Path(__file__).resolve().parent.parent / "simulated"


def build(folder):
    """Compiles the machine above a simulated core into a folder; its path. Raises RuntimeError without a compiler."""
    compiler = os.environ.get("CC") or shutil.which("cc") or shutil.which("gcc")
    if compiler is None:
        raise RuntimeError("no C compiler: install gcc, or set CC")
    library = pathlib.Path(folder) / "machine.so"
    sources = [SIMULATED / name for name in ("machine.c", "dma.c")]
    subprocess.run([compiler, "-std=c11", "-O2", "-fPIC", "-shared", *sources, "-o", library, "-ldl"], check=True)
    return library


class Machine:
    """The shared object of machine.c, above that of a core with registers or without; with `queue` its DMA has
    descriptors. Raises RuntimeError if there is no core."""

    def __init__(self, library, core, registers=True, queue=False):
        self.calls = ctypes.CDLL(str(library))
        self.calls.machine_open.restype = ctypes.c_void_p
        self.calls.machine_open.argtypes = [ctypes.c_char_p, ctypes.c_uint32, ctypes.c_int]
        self.calls.machine_read.restype = ctypes.c_uint32
        self.calls.machine_read.argtypes = [ctypes.c_void_p, ctypes.c_size_t]
        self.calls.machine_write.argtypes = [ctypes.c_void_p, ctypes.c_size_t, ctypes.c_uint32]
        self.calls.machine_run.argtypes = [ctypes.c_void_p, ctypes.c_uint64]
        self.calls.machine_interrupt.argtypes = [ctypes.c_void_p]
        self.calls.machine_faults.restype = ctypes.c_uint32
        self.calls.machine_faults.argtypes = [ctypes.c_void_p]
        self.calls.machine_scatter_gather.argtypes = [ctypes.c_void_p]
        self.calls.machine_fail.argtypes = [ctypes.c_void_p, ctypes.c_int, ctypes.c_uint32]
        self.handle = self.calls.machine_open(str(core).encode(), 3, registers)
        if not self.handle:
            raise RuntimeError(f"{core}: no simulated core; `sptfra build DESIGN` names one")
        if queue:
            self.calls.machine_scatter_gather(self.handle)

    def read(self, address):
        return self.calls.machine_read(self.handle, address)

    def write(self, address, value):
        self.calls.machine_write(self.handle, address, value)


class Block:
    """Registers at a base address, as PYNQ's DefaultIP."""

    def __init__(self, machine, base):
        self.machine, self.base = machine, base

    def read(self, offset=0):
        return self.machine.read(self.base + offset)

    def write(self, offset, value):
        self.machine.write(self.base + offset, value)


class Buffer(np.ndarray):
    """Memory for the DMA, as PYNQ's PynqBuffer: what is not flushed or invalidated is not seen by the other side."""

    def flush(self):
        self.memory[:] = self

    def invalidate(self):
        self[:] = self.memory


def allocate(shape, dtype):
    """As pynq.allocate: whole pages."""
    buffer = np.zeros(shape, dtype).view(Buffer)
    pages = np.zeros(buffer.nbytes + PAGE, np.uint8)
    begin = -pages.ctypes.data % PAGE
    buffer.memory = pages[begin : begin + buffer.nbytes].view(dtype).reshape(shape)
    buffer.device_address = buffer.memory.ctypes.data + BUS_OFFSET
    return buffer


class Channel:
    """One channel of the DMA, as PYNQ's."""

    def __init__(self, machine, base):
        self.registers = Block(machine, base)
        self.start()

    def start(self):
        self.registers.write(0x00, 1)

    @property
    def idle(self):
        return bool(self.registers.read(0x04) & 2)

    @property
    def error(self):
        return bool(self.registers.read(0x04) & 0x70)

    def transfer(self, buffer):
        self.registers.write(0x18, buffer.device_address & 0xFFFFFFFF)
        self.registers.write(0x1C, buffer.device_address >> 32)
        self.registers.write(0x28, buffer.nbytes)


class Overlay:
    """A core and its DMA, as PYNQ's Overlay of a bitstream; `core` is the path of the simulated one, or a `Machine`.

    `registers` is False for a core without any (`control = false`), `queue` True for a DMA with descriptors.
    """

    def __init__(self, core, registers=True, queue=False):
        if isinstance(core, Machine):
            machine = core
        else:
            with tempfile.TemporaryDirectory() as folder:
                machine = Machine(build(folder), core, registers, queue)
        self.machine = machine
        if registers:
            self.core = Block(machine, CORE)
        self.dma = Block(machine, DMA)
        self.dma.sendchannel = Channel(machine, DMA)
        self.dma.recvchannel = Channel(machine, DMA + 0x30)
