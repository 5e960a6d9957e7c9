# SPDX-License-Identifier: MIT OR Apache-2.0
"""The Python driver's calibration against the simulated core.

    calibration.py MACHINE.so CORE.so FOLDER

FOLDER has pairs `K.csv`, a calibration, and `K.words`, the words of its bank (uint32) behind a noise floor in Pa
(float64, 0: none).
"""

import pathlib
import sys

import numpy as np

sys.argv, arguments = sys.argv[:1], sys.argv[1:]
from host import Machine, Overlay, allocate, refused  # noqa: E402

from sptfra_board import Sptfra, Status  # noqa: E402


def main():
    library, core, folder = arguments
    machine = Machine(library, core)
    overlay = Overlay(machine)
    sensor = Sptfra(overlay.core, overlay.dma, allocate)
    rows, columns = sensor.identity.rows, sensor.identity.columns
    assert sensor.identity.calibration_in_ram and sensor.identity.replaceable == 2 and sensor.identity.curve_in_ram
    files = sorted(path for path in pathlib.Path(folder).glob("*.csv") if not path.stem.endswith(".curve"))
    assert len(files) > 3
    for version, path in enumerate(files, 1):
        data = path.with_suffix(".words").read_bytes()
        (noise,), words = np.frombuffer(data, "<f8", 1), np.frombuffer(data, "<u4", offset=8)
        curve = path.with_suffix(".curve.csv")
        sensor.load_calibration(path, noise or None, curve=curve if curve.exists() else None)
        assert [sensor.read_calibration(index) for index in range(len(words))] == words.tolist(), path
        assert sensor.reconstruct(np.full((rows, columns), 5.0)).version.tolist() == [version]
    wrong = pathlib.Path(folder, "wrong.txt")
    for text, message in [
        ("1.0,0.0\n1.0\n", "line 2: '1.0' is no gain"),
        ("1.0;0.0\n1.0,0\n", "line 2: '1.0,0' is no gain"),
        ("offset,gain\n" + "0,1\n" * 12, "line 1: a header is gain,offset"),
        ("17,0\n", "line 1: use a gain from"),
        ("1,0\n" * 3, "3 lines, and the core has 12 taxels"),
        ("1,0\n" * 11 + "1,1000000\n", "taxel 11: an offset of 1000000.0 counts is beyond"),
    ]:
        wrong.write_text(text)
        assert message in refused(ValueError, lambda: sensor.load_calibration(wrong))
    header = "gain,offset,taxel 3,taxel 4\n"
    for text, message in [
        ("gain,offset,3\n" + "1,0,0\n" * 12, "line 1: 'gain,offset,3' is no gain,offset"),
        ("gain,offset,no 3\n" + "1,0,0\n" * 12, "line 1: a header is gain,offset,taxel 37"),
        ("gain,offset,taxel 4,taxel 3\n" + "1,0,0,0\n" * 12, "line 1: dead taxels ascend"),
        ("gain,offset,taxel 12\n" + "1,0,0\n" * 12, "line 1: dead taxels ascend"),
        (header + "1,0,0\n" * 12, "line 2: '1,0,0' is no gain,offset such as 1.02,-0.5 and a weight"),
        (header + "1,0,0.5,0\n" * 12, "a dead taxel has no weight"),
        (header + "1,0,0,0\n" * 3 + "0,0,0,0\n" * 2 + "1,0,2e5,0\n" * 7, "so large that no bank takes them"),
        ("gain,offset,taxel 1,taxel 3,taxel 4\n" + "1,0,0,0,0\n" * 12, "3 dead taxels, and the core has room for 2"),
        ("gain,offset\n" + "1,0\n" * 11 + "0,0\n", "nothing replaces the taxels [11] of gain 0"),
    ]:
        wrong.write_text(text)
        assert message in refused(ValueError, lambda: sensor.load_calibration(wrong))
    lines = "1,0\n" * 12 + "count,pascals\n"
    for text, message in [
        (lines + "0\n", "line 14: '0' is no count,pascals"),
        (lines + "0,0\n", "a curve of 1 points: use 2 to 17"),
        (lines + "".join(f"{place},{-place}\n" for place in range(18)), "a curve of 18 points"),
        (lines + "0,0\n5,-10\n5,-20\n", "ascend by counts"),
        (lines + "0,0\n5,-10\n6,-9\n", "only rise or only fall"),
        (lines + "0,0\n5,-10\n60,-1e7\n", "for which a bank has room"),
        (lines + "0,0\n1e7,-10\n", "for which a bank has room"),
        (lines + "0,0\n1e-3,-9000\n9,-20000\n", "rises too steeply"),
    ]:
        wrong.write_text(text)
        assert message in refused(ValueError, lambda: sensor.load_calibration(wrong)), message
    apart = pathlib.Path(folder, "apart.txt")
    wrong.write_text(lines + "0,0\n9000,-112500\n")
    for text, message in [
        ("0,0\n8000,-112500\n", "the curve is another than that of"),
        ("gain,offset\n1,0\n", "no curve"),
        ("pascals,count\n0,0\n", "line 1: the pascals stand before the counts"),
        ("0,0\n5,x\n", "line 2: '5,x' is no count,pascals"),
    ]:
        apart.write_text(text)
        assert message in refused(ValueError, lambda: sensor.load_calibration(wrong, curve=apart)), message
    wrong.write_text("gain,offset\n" + "1,0\n" * rows * columns + "count,pascals\n0,0\n9000,-112500\n")
    for noise in (-1.0, 0.0, 1e12):
        assert "noise floor" in refused(ValueError, lambda: sensor.load_calibration(wrong, noise))
    # The noise floor is that of the frames: 12 taxels that read 62.5 Pa each are none of 20 Pa, and one of 100 Pa.
    for noise, none in [(20.0, 0), (100.0, 1), (None, 1), (20.0, 0)]:
        sensor.load_calibration(wrong, noise)
        status = sensor.reconstruct(np.full((rows, columns), 5.0)).status[0]
        assert bool(status & Status.NO_CONTACT) == bool(none), (noise, status)
    rest = np.full((8, rows, columns), 300.0)
    assert not np.any(sensor.tare(rest).status & Status.NO_CONTACT)
    assert np.all(sensor.reconstruct(rest).status & Status.NO_CONTACT)
    rest[5, 1, 1] += 10
    assert "NOT_AT_REST" in refused(RuntimeError, lambda: sensor.tare(rest))
    rest[5, 1, 1] = np.nan
    assert "BAD_FRAME" in refused(RuntimeError, lambda: sensor.tare(rest))
    assert "a tare takes" in refused(ValueError, lambda: sensor.tare(rest[:3]))
    # Frames of another shape are refused before the core tares: those that follow, at rest, are no tare.
    rest = np.full((8, rows, columns), 450.0)
    before = sensor.reconstruct(rest).version[-1]
    assert "the core has" in refused(ValueError, lambda: sensor.tare(np.full((8, columns, rows), 300.0)))
    after = [sensor.reconstruct(rest) for _ in range(2)][-1].version[-1]
    assert after == before, (before, after)
    assert machine.calls.machine_faults(machine.handle) == 0
    print(f"PASS: {len(files)} banks")


main()
