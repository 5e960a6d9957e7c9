# SPDX-License-Identifier: MIT OR Apache-2.0
"""The Python driver in batches and without registers, against the simulated core.

    batches.py DRIVER MACHINE.so CORE.so REGISTERS FRAMES METADATA

DRIVER is the folder of the driver, REGISTERS 0 or 1; the rest as in host.py. Prints what it has seen, and PASS.
"""

import ctypes
import json
import pathlib
import sys

import numpy as np

sys.argv, arguments = sys.argv[:1], sys.argv[1:]
sys.path.insert(0, arguments[0])
from sptfra_board import Sptfra  # noqa: E402
from sptfra_desk import Machine, Overlay, allocate  # noqa: E402

sys.path.insert(1, str(pathlib.Path(__file__).parent))
from host import load, refused  # noqa: E402

DMA_DECODE = 1 << 6


class Failing:
    """A DMA that stops with an error after so many reads of its registers."""

    def __init__(self, dma, machine):
        self.dma, self.machine, self.left = dma, machine, None
        self.sendchannel, self.recvchannel = dma.sendchannel, dma.recvchannel

    def read(self, offset):
        if self.left is not None:
            self.left -= 1
            if self.left == 0:
                self.left = None
                self.machine.calls.machine_fail(self.machine.handle, offset >= 0x30, DMA_DECODE)
        return self.dma.read(offset)

    def write(self, offset, value):
        self.dma.write(offset, value)


def main():
    _, library, core, registers, path, metadata = arguments
    registers = registers == "1"

    def system(queue):
        machine = Machine(library, core, registers, queue)
        machine.calls.machine_dma_cycles.argtypes = [ctypes.c_void_p, ctypes.c_uint32]
        machine.calls.machine_even.argtypes = [ctypes.c_void_p, ctypes.c_uint32, ctypes.c_uint32]
        machine.calls.machine_cycles.argtypes = [ctypes.c_void_p]
        machine.calls.machine_cycles.restype = ctypes.c_uint64
        overlay = Overlay(machine, registers, queue)
        dma = Failing(overlay.dma, machine)
        return machine, dma, lambda **more: Sptfra(getattr(overlay, "core", None), dma, allocate, metadata, **more)

    machine, dma, driver = system(queue=False)
    alone = driver()
    identity = alone.identity
    frames, answers = load(path, identity.words_out)
    whole = [index for index, frame in enumerate(frames) if len(frame) == identity.words_in]
    taxels = identity.rows * identity.columns
    stress = np.array([frames[index].view(identity.samples) for index in whole])[:, :taxels]
    expected = np.array([answers[index] for index in whole])[:, 2:13]
    assert "no descriptors" in refused(RuntimeError, lambda: driver(queue=4))
    alone.recover()

    def right(sensor, count=len(stress), number=None):
        forces = sensor.reconstruct(stress[:count])
        parts = [forces.resultant, forces.torque, forces.friction, forces.direction, forces.friction_xy]
        seen = np.column_stack([*parts, forces.standard_error])
        assert np.array_equal(seen.view(np.uint32), expected[:count])
        first = int(forces.number[0])
        assert number is None or first == number, first
        assert np.array_equal(forces.number, (first + np.arange(count)) & 0xFFFF)
        return first + count

    # One at a time; without registers the numbers go on after a recovery.
    number = right(alone)
    right(alone, number=number)
    assert "recover()" in refused(TimeoutError, lambda: alone.reconstruct(stress, timeout=0))
    assert "has failed" in refused(RuntimeError, lambda: alone.reconstruct(stress))
    alone.recover()
    right(alone)
    if not registers:
        assert right(alone) > number
        for action in (alone.counters, alone.soft_reset, alone.take_interrupts):
            assert "control = true" in refused(RuntimeError, action)
        assert 'calibration = "ram"' in refused(RuntimeError, lambda: alone.tare(stress[:1]))
        assert "give its path" in refused(ValueError, lambda: Sptfra(None, dma, allocate))
        drops = pathlib.Path(metadata).with_name("drops.json")
        drops.write_text(json.dumps(json.loads(pathlib.Path(metadata).read_text()) | {"overrun": "drop"}))
        dropping = refused(RuntimeError, lambda: Sptfra(None, dma, allocate, drops, queue=4))
        assert "drops frames" in dropping, dropping
    assert machine.calls.machine_faults(machine.handle) == 0

    # Batches of every size, whole and not, each going on where the last ended.
    machine, dma, driver = system(queue=True)
    machine.calls.machine_dma_cycles(machine.handle, 60)
    for batch in (1, 3, len(stress), 64):
        sensor = driver(queue=batch)
        number = right(sensor)
        for count in (1, 2, 4, 1):
            number = right(sensor, count, number)
    assert "at least 1" in refused(ValueError, lambda: driver(queue=-1))
    assert sensor.reconstruct(stress[:0]).number.tolist() == []

    # Errors of the DMA at every moment: no answer is taken for another frame's, and after a recovery all is as before.
    sensor = driver(queue=4)
    failed = 0
    for left in range(1, 60):
        dma.left = left
        try:
            right(sensor)
        except RuntimeError as error:
            assert "recover()" in str(error), error
            assert "has failed" in refused(RuntimeError, lambda: sensor.reconstruct(stress))
            failed += 1
        # One that came when all was done is seen by the recovery.
        dma.left = None
        sensor.recover(0.001)
        assert not registers or sensor.counters().frames_in <= 1
        right(sensor, 3)
    assert failed > 30, failed
    assert "recover()" in refused(TimeoutError, lambda: sensor.reconstruct(stress, timeout=0))
    sensor.recover(0.001)
    number = right(sensor)
    sensor._next = (number + 1) & 0xFFFF
    message = refused(RuntimeError, lambda: sensor.reconstruct(stress))
    assert f"to frame {number}, not {number + 1}" in message, message
    assert machine.calls.machine_faults(machine.handle) == 0

    # Once a batch is there the core works at its interval, whatever the software does.
    machine, _, driver = system(queue=True)
    machine.calls.machine_even(machine.handle, 25, 40)
    sensor = driver(queue=32)
    many = np.repeat(stress[:1], 128, axis=0)
    begin = machine.calls.machine_cycles(machine.handle)
    sensor.reconstruct(many)
    cycles = (machine.calls.machine_cycles(machine.handle) - begin) / len(many)
    assert cycles < 1.1 * identity.interval_cycles, cycles
    print(f"PASS: {failed} errors, {cycles:.0f} cycles a frame, interval {identity.interval_cycles}")


if __name__ == "__main__":
    main()
