# SPDX-License-Identifier: MIT OR Apache-2.0
"""The package around the solver: hardware, pictures, live streams, stubs and the page of the docs. As test_sptfra."""

import ast
import inspect
import os
import re
import socket
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np
import sptfra
from sptfra import live
from test_sptfra import ROOT, design


class Hardware(unittest.TestCase):
    def test_the_plan_is_what_inspect_prints(self):
        plan = sptfra.plan(sptfra.Design.load(ROOT / "golden" / "tests" / "designs" / "small.toml"))
        self.assertEqual(plan.details["predicted"]["latency_cycles"], plan.latency_cycles)
        self.assertEqual(plan.latency_us, plan.latency_cycles / 125.0)
        self.assertAlmostEqual(plan.frames_per_second, 125e6 / plan.interval_cycles)
        self.assertGreater(plan.dsp, 0)

    def test_the_core_is_bit_exact_and_as_fast_as_planned(self):
        small = sptfra.Design.load(ROOT / "golden" / "tests" / "designs" / "small.toml")
        frames, _ = sptfra.scene(small)
        core, plan = sptfra.simulate(small, frames), sptfra.plan(small)
        self.assertTrue(core.bit_exact)
        self.assertEqual(core.faults, ())
        self.assertEqual((core.latency_cycles, core.interval_cycles), (plan.latency_cycles, plan.interval_cycles))
        solved = sptfra.Solver(small).solve(frames)
        np.testing.assert_array_equal(core.forces.status, solved.status)
        np.testing.assert_allclose(core.forces.field, solved.field, atol=3e-4 * np.abs(solved.field).max())

    def test_the_core_counts_contacts(self):
        text = (ROOT / "golden" / "tests" / "designs" / "small.toml").read_text()
        small = sptfra.Design.from_toml(text.replace("count_contacts = false", "contacts = 2\ncount_contacts = true"))
        frames = np.zeros((2, 3, 4))
        frames[0, :, 0], frames[0, :, 3], frames[1, :2, :2] = -4e4, -2e4, -3e4
        core, solved = sptfra.simulate(small, frames), sptfra.Solver(small).solve(frames)
        self.assertEqual((core.faults, core.forces.contacts.tolist()), ((), [2, 1]))
        self.assertEqual(core.forces.has(sptfra.Status.SEVERAL_CONTACTS).tolist(), [True, False])
        self.assertIsNone(core.forces.records, "software separates them")
        self.assertEqual(solved.records["taxels"].astype(bool).tolist(), [[True, True], [True, False]])

    def test_a_folder_is_generated(self):
        with tempfile.TemporaryDirectory() as folder:
            made = sptfra.generate(design(), Path(folder) / "core")
            self.assertTrue((made / "rtl" / "pad.v").is_file())


class Package(unittest.TestCase):
    def test_the_version_is_that_of_the_workspace(self):
        self.assertIn(f'\nversion = "{sptfra.__version__}"\n', (ROOT / "Cargo.toml").read_text())

    def test_the_page_of_the_registry_runs(self):
        page = (ROOT / "python" / "README.md").read_text()
        blocks = re.findall(r"```python\n(.*?)```", page, re.DOTALL)
        self.assertEqual(len(blocks), 1)
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([sys.executable, "-c", blocks[0]], cwd=folder, capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertGreater(len(done.stdout.splitlines()), 2)

    def test_the_stubs_say_what_there_is(self):
        package = Path(sptfra.__file__).parent
        self.assertTrue((package / "py.typed").is_file())
        stubs = {node.name: node for node in ast.parse((package / "_native.pyi").read_text()).body if hasattr(node, "name")}
        native = {name for name in dir(sptfra._native) if not name.startswith("_")}
        self.assertEqual(native, set(stubs))
        signatures = 0
        for name, stub in stubs.items():
            found, members = getattr(sptfra._native, name), [stub]
            if isinstance(stub, ast.ClassDef):
                own = [node for node in stub.body if isinstance(node, ast.FunctionDef)]
                public = {member for member in vars(found) if not member.startswith("_")}
                self.assertEqual(public, {node.name for node in own if not node.name.startswith("_")}, name)
                members = [node for node in own if "property" not in map(ast.unparse, node.decorator_list)]
            for member in members:
                owner = found if member is stub or member.name == "__new__" else getattr(found, member.name)
                names = [argument.arg for argument in member.args.args + member.args.kwonlyargs]
                names = [argument for argument in names if argument not in ("self", "cls")]
                real = [argument for argument in inspect.signature(owner).parameters if argument != "self"]
                self.assertEqual(real, names, f"{name}.{member.name}")
                signatures += 1
        self.assertGreater(signatures, 10)

    def test_plots_say_what_they_need(self):
        forces = sptfra.Solver(design()).solve(sptfra.scene(design()).frames)
        try:
            import matplotlib
        except ImportError:
            with self.assertRaisesRegex(ImportError, r"pip install 'sptfra\[plot\]'"):
                sptfra.plot_field(design(), forces)
            return
        matplotlib.use("agg")
        axes = sptfra.plot_field(design(), forces, 9)
        self.assertEqual(axes.get_xlabel(), "x in mm")
        self.assertRegex(axes.get_title(loc="left"), r"^F = \(.*\) N, good\nlongest arrow: 0\.\d+ N$")
        self.assertEqual(len(axes.artists), 0, "nothing beside the title that it may run into")
        self.assertEqual(axes.images[0].get_extent(), [-2.0, 14.0, -1.0, 5.0])
        with self.assertRaisesRegex(ValueError, "there is no frame 36 of 36"):
            sptfra.plot_field(design(), forces, 36)
        with self.assertRaisesRegex(ValueError, "contacts = 2"):
            sptfra.plot_contacts(design(), forces)
        pad = sptfra.Design.load(ROOT / "designs" / "sensor1-fast.toml")
        truth = sptfra.scene(path=ROOT / "scenes" / "two-contacts.toml").truth
        axes = sptfra.plot_contacts(pad, truth)
        centres = [tuple(map(float, dots.get_offsets()[0])) for dots in axes.collections]
        np.testing.assert_allclose(centres, [(10.0, 6.0), (27.0, 12.0)])
        self.assertIn("3.00 N, µ 0.40", [text.get_text() for text in axes.texts])
        with self.assertRaisesRegex(ValueError, "there is no frame 1 of 1"):
            sptfra.plot_contacts(pad, truth, 1)
        # The window of a stream, on a display that draws into memory.
        lines = [",".join(map(repr, frame.ravel().tolist())).encode() for frame in sptfra.scene(design()).frames[:3]]
        window = live.Window(design())
        live.run(design(), lines, "here", 0, window)
        (axes, _) = window._figure.axes
        self.assertIn("F = (", axes.get_title(loc="left"))

    def test_live_answers_each_line_at_once(self):
        frames, _ = sptfra.scene(path=ROOT / "scenes" / "sensor1-hertz.toml")
        command = [sys.executable, "-m", "sptfra.live", str(ROOT / "designs" / "sensor1-reduced.toml")]
        with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as running:
            for number, frame in enumerate(frames[:3]):
                running.stdin.write((",".join(map(repr, map(float, frame.ravel()))) + "\n").encode())
                running.stdin.flush()
                said = running.stdout.readline().decode()
                self.assertRegex(said, rf"^ +{number}  F = \(.*\) N  mu = 0\.\d+  phi = .* low confidence$")
            running.stdin.write(b"1,2\n")
            running.stdin.close()
            self.assertEqual(running.wait(), 1)
            self.assertIn("standard input, line 4", running.stderr.read().decode())

    def test_live_says_that_there_is_no_display(self):
        command = [sys.executable, "-m", "sptfra.live", str(ROOT / "golden" / "tests" / "designs" / "small.toml"), "--plot"]
        without = {name: value for name, value in os.environ.items() if name not in ("DISPLAY", "WAYLAND_DISPLAY")}
        done = subprocess.run(command, input=b"", capture_output=True, env={**without, "MPLBACKEND": "agg"}, check=False)
        self.assertEqual(done.returncode, 1)
        self.assertRegex(done.stderr.decode(), r"^error: (--plot: there is no display|pictures need matplotlib)")

    def test_live_passes_over_a_first_line_that_is_cut_off(self):
        frames, _ = sptfra.scene(path=ROOT / "scenes" / "sensor1-hertz.toml")
        command = [sys.executable, "-m", "sptfra.live", str(ROOT / "designs" / "sensor1-reduced.toml")]
        line = ",".join(map(repr, map(float, frames[0].ravel()))) + "\n"
        done = subprocess.run(command, input=("5,-1.5\n" + line).encode(), capture_output=True, check=True)
        self.assertIn("line 1", done.stderr.decode())
        self.assertEqual(len(done.stdout.splitlines()), 1)

    def test_live_says_what_is_wrong_with_the_first_frames(self):
        frames, _ = sptfra.scene(path=ROOT / "scenes" / "sensor1-hertz.toml")
        command = [sys.executable, "-m", "sptfra.live", str(ROOT / "designs" / "sensor1-reduced.toml")]
        # In kilopascals: after so many frames, or at the end of fewer.
        for count in (live.LOOKED_AT + 2, 3):
            lines = "".join(",".join(map(repr, map(float, frames[0].ravel() / 1000))) + "\n" for _ in range(count))
            done = subprocess.run(command, input=lines.encode(), capture_output=True, check=True)
            said = done.stderr.decode()
            # The same frame again and again has a largest pull that looks like a converter's end, too.
            self.assertTrue(said.startswith("warning: ") and said.count("kilopascals") == 1, said)
            self.assertEqual(len(done.stdout.splitlines()), count)

    def test_live_reads_from_a_socket(self):
        frames, _ = sptfra.scene(path=ROOT / "scenes" / "sensor1-hertz.toml")
        lines = b"".join((",".join(map(repr, map(float, frame.ravel()))) + "\n").encode() for frame in frames[:2])
        command = [sys.executable, "-m", "sptfra.live", str(ROOT / "designs" / "sensor1-reduced.toml")]
        pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE}

        with subprocess.Popen([*command, "--listen", "0"], **pipes) as running:
            said = running.stderr.readline().decode()
            host, port = re.fullmatch(r"waiting for frames at (.*):(\d+)\n", said).groups()
            with socket.create_connection((host, int(port))) as connection:
                connection.sendall(lines + b"1,2\n")
            out, wrong = running.communicate()
            self.assertEqual((len(out.splitlines()), running.returncode), (2, 1), wrong)
            self.assertRegex(wrong.decode(), rf"error: {re.escape(host)}:\d+, line 3")

        with socket.create_server(("localhost", 0)) as server:
            port = server.getsockname()[1]
            with subprocess.Popen([*command, "--connect", f"localhost:{port}"], **pipes) as running:
                connection, _ = server.accept()
                with connection:
                    connection.sendall(lines)
                again, wrong = running.communicate()
            self.assertEqual((again, running.returncode), (out, 0), wrong)
        # Nobody is there any more.
        refused = subprocess.run([*command, "--connect", str(port)], capture_output=True, check=False)
        self.assertEqual(refused.returncode, 1)
        self.assertRegex(refused.stderr.decode(), "error: .*somebody at the other end")
        for wrong in ["nowhere", "localhost:", "localhost:70000"]:
            refused = subprocess.run([*command, "--connect", wrong], capture_output=True, check=False)
            self.assertIn("write HOST:PORT", refused.stderr.decode())

    def test_the_page_of_the_docs_runs(self):
        pages = ["how-to/python.md", "reference/python.md"]
        page = "".join((ROOT / "docs" / name).read_text(encoding="utf-8") for name in pages)
        blocks = re.findall(r"```python\n(.*?)```", page, flags=re.DOTALL)
        self.assertTrue(blocks)
        names = {}
        for block in blocks:
            exec(block, names)  # noqa: S102
        for name in sptfra.__all__:
            self.assertIn(name, page, "every name has its place on the page")


if __name__ == "__main__":
    unittest.main()
