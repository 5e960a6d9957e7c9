# SPDX-License-Identifier: MIT OR Apache-2.0
"""The Python driver against the simulated core: an overlay, a DMA and memory as PYNQ presents them, all made up.

    host.py MACHINE.so CORE.so FRAMES METADATA

FRAMES as in host.c. Prints what the core is, and PASS.
"""

import dataclasses
import json
import os
import pathlib
import struct
import sys

import numpy as np

# As in effort.rs.
ALL = os.environ.get("SPTFRA_TEST_ALL", "0") != "0"
# As in mod.rs.
SMOOTHING = 3

sys.path.insert(0, str(pathlib.Path(__file__).parents[4] / "drivers" / "python"))
from sptfra_board import LAYOUT, Event, Layout, Register, Sptfra, Status, separate  # noqa: E402
from sptfra_desk import CORE, Block, Machine, Overlay, allocate  # noqa: E402


def load(path, words_out):
    """Frames and answers of the file."""
    data, frames, answers, place = pathlib.Path(path).read_bytes(), [], [], 0
    while place < len(data):
        (words,) = struct.unpack_from("<I", data, place)
        frames.append(np.frombuffer(data, "<u4", words, place + 4))
        answers.append(np.frombuffer(data, "<u4", words_out, place + 4 + 4 * words))
        place += 4 * (1 + words + words_out)
    return frames, answers


def refused(kind, action):
    """The message of the exception that the action must raise."""
    try:
        action()
    except kind as error:
        return str(error)
    raise AssertionError(f"no {kind.__name__}")


def check_lengths(metadata):
    """A layout that no core has."""
    text = pathlib.Path(metadata).read_text()
    broken = pathlib.Path(metadata).with_name("broken.json")
    told = json.loads(text)
    for value in told["output"]:
        value["index"] += value["name"] == "field"
    broken.write_text(json.dumps(told))
    if "field" in [value["name"] for value in told["output"]]:
        assert "do not fit" in refused(ValueError, lambda: Layout.load(broken))


class Echo:
    """In place of a solver: returns its own name and the frames that it is given."""

    def __init__(self, name):
        self.name = name

    def solve(self, frames):
        return self.name, frames


def check_separation(forces, stress):
    """Marked frames, and no others, go to the solver of their version."""
    bit = np.uint16(Status.SEVERAL_CONTACTS)
    status, version = forces.status & ~bit, np.zeros_like(forces.version)
    status[[1, 4, 6]] |= bit
    version[4:] = 3
    marked = dataclasses.replace(forces, status=status, version=version)
    flat = stress.reshape(len(stress), -1)
    found = list(separate(marked, stress, {0: Echo("old"), 3: Echo("new")}))
    assert [(list(indices), name) for indices, (name, _) in found] == [([1], "old"), ([4, 6], "new")]
    assert all(np.array_equal(frames, flat[indices]) for indices, (_, frames) in found)
    (both,) = separate(dataclasses.replace(marked, version=0 * version), flat, Echo("one"))
    assert list(both[0]) == [1, 4, 6]
    assert list(separate(dataclasses.replace(forces, status=status & ~bit), stress, None)) == []
    refused(KeyError, lambda: list(separate(marked, stress, {0: Echo("old")})))
    refused(ValueError, lambda: list(separate(marked, stress[1:], Echo("old"))))


def main():
    library, core, path, metadata = sys.argv[1:]
    machine = Machine(library, core)
    overlay = Overlay(machine)
    wrong = Block(machine, CORE + 4)
    assert "IDENTITY" in refused(RuntimeError, lambda: Sptfra(wrong, overlay.dma, allocate))
    # The layout that the driver knows is the design's.
    design = Layout.load(metadata)
    sensor = Sptfra(overlay.core, overlay.dma, allocate, metadata)
    identity = sensor.identity
    print(identity)
    assert design.values == LAYOUT.values and design.field in (LAYOUT.field, None)
    assert design.units == {name: LAYOUT.units[name] for name in design.units}
    assert LAYOUT.units.keys() - design.units.keys() == (set() if design.field else {"field"})
    check_lengths(metadata)
    rows, columns = identity.rows, identity.columns
    frames, answers = load(path, identity.words_out)
    whole = [index for index, frame in enumerate(frames) if len(frame) == identity.words_in]
    # Behind a frame's last sample a beat may have room.
    samples = np.array([frames[index].view(identity.samples) for index in whole])[:, : rows * columns]
    stress = samples.reshape(-1, rows, columns)
    expected = np.array([answers[index] for index in whole])
    assert len(whole) > 8

    if identity.averages_frames:
        assert "0 to 8" in refused(ValueError, lambda: sensor.set_smoothing(9))
        sensor.set_smoothing(SMOOTHING)
        assert overlay.core.read(Register.SMOOTHING) == SMOOTHING
    else:
        assert "smoothing" in refused(RuntimeError, lambda: sensor.set_smoothing(1))
    sensor.enable_interrupts(Event.FRAME_DONE)
    forces = sensor.reconstruct(stress)
    assert sensor.take_interrupts() & Event.FRAME_DONE
    count = len(whole)
    assert list(forces.number) == list(range(count))
    assert np.array_equal(forces.status, expected[:, 0] & 0xFFFF)
    assert np.all(np.diff(forces.timestamp.astype(np.int64)) >= identity.words_in)
    parts = [forces.resultant, forces.torque, forces.friction, forces.direction, forces.friction_xy]
    seen = np.column_stack([*parts, forces.standard_error])
    assert np.array_equal(seen.view(np.uint32), expected[:, 2:13])
    assert seen.dtype == np.float32
    counters = forces.contacts.astype(np.uint32) | forces.version.astype(np.uint32) << 8
    assert np.array_equal(counters | forces.replaced.astype(np.uint32) << 16, expected[:, 13])
    if identity.has_field:
        assert forces.field.shape == (count, rows, columns, 3)
        assert np.array_equal(forces.field.reshape(count, -1).view(np.uint32), expected[:, 16:])
    else:
        assert forces.field is None
    bad = [index for index in range(count) if forces.status[index] & Status.NOT_FINITE]
    assert bool(bad) == (identity.samples == np.float32)  # no integer is NaN
    assert all("NOT_FINITE" in forces.names(index) for index in bad)
    assert "NOT_FINITE" not in forces.names(0)
    check_separation(forces, stress)
    assert forces.units["resultant"] == "N" and forces.units["torque"] == "N m" and forces.units["friction"] == ""
    arrays = {name for name, value in vars(forces).items() if isinstance(value, np.ndarray)}
    assert forces.units.keys() == arrays, forces.units
    counters = sensor.counters()
    assert (counters.frames_in, counters.frames_out, counters.frames_bad) == (count, count, len(bad))
    assert counters.last_status == Status(int(forces.status[-1]))
    assert counters.last_latency >= identity.latency_cycles

    # One frame in each of the other shapes; a reset starts the numbers anew.
    sensor.soft_reset()
    assert sensor.counters().frames_out == 0
    for number, frame in enumerate([stress[0], stress[0].ravel(), stress[:1].reshape(1, -1)]):
        forces = sensor.reconstruct(frame)
        assert forces.number.tolist() == [number]
        assert np.array_equal(forces.resultant.view(np.uint32), expected[:1, 2:5])
    # An answer that does not come in time, and one that comes late, are no answers; after a recovery all is as before.
    assert "recover()" in refused(TimeoutError, lambda: sensor.reconstruct(stress[0], timeout=0))
    assert "has failed" in refused(RuntimeError, lambda: sensor.reconstruct(stress[0]))
    machine.calls.machine_run(machine.handle, 100)
    sensor._transfers.reset(1.0)
    sensor._failed, sensor._next = False, sensor._next + 1
    assert "to frame 3, not 4" in refused(RuntimeError, lambda: sensor.reconstruct(stress[0]))
    for cycles in range(0, 1200, 60 if ALL else 170):
        sensor.recover()
        assert np.array_equal(sensor.reconstruct(stress[0]).resultant.view(np.uint32), expected[:1, 2:5])
        refused(TimeoutError, lambda: sensor.reconstruct(stress[0], timeout=0))
        machine.calls.machine_run(machine.handle, cycles)
    sensor.recover()
    if identity.samples != np.float32:
        for count_of in (0.5, 1e6):
            far = np.full((rows, columns), count_of)
            assert "whole numbers within its range" in refused(ValueError, lambda: sensor.reconstruct(far))
    assert "rows" in refused(ValueError, lambda: sensor.reconstruct(np.zeros((3, rows + 1, columns))))
    assert machine.calls.machine_faults(machine.handle) == 0
    print(f"PASS: {count} frames, {len(bad)} bad")


if __name__ == "__main__":
    main()
