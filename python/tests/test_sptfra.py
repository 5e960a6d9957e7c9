# SPDX-License-Identifier: MIT OR Apache-2.0
"""The installed package as a user has it: python -m unittest test_sptfra, in a folder that is no project's."""

import dataclasses
import os
import pickle
import signal
import tempfile
import threading
import unittest
from pathlib import Path

import numpy as np
import sptfra

ROOT = Path(os.environ["SPTFRA_ROOT"])
PLAIN = f"format = 3\nbase = '{ROOT / 'golden/tests/plain.toml'}'\n"
SMALL = PLAIN + "name = 'pad'\n[sensor]\ncolumns = 4\nrows = 3\npitch_mm = [4.0, 2.0]\ndepth_mm = 3.0\n"


def design(more=""):
    return sptfra.Design.from_toml(SMALL + more, "pad.toml")


def made(**keys):
    sensor = dict(columns=10, rows=10, pitch_mm=(4, 2), depth_mm=3, tension="read")
    return sptfra.Design("pad", **{**sensor, **keys})


class Designs(unittest.TestCase):
    def test_properties_and_keywords(self):
        made = sptfra.Design("pad", columns=6, rows=5, pitch_mm=(4, 3.5), depth_mm=3, tension="read", counts=12)
        found = (made.name, made.columns, made.rows, made.taxels, made.pitch_mm, made.depth_mm, made.counts)
        self.assertEqual(found, ("pad", 6, 5, 30, (4.0, 3.5), 3.0, True))
        self.assertEqual((made.plan, made.estimator, made.outputs, made.tension), ("reduced", "joint", "field", "read"))
        self.assertEqual((made.samples, made.full_scale_pa, made.clock_mhz), ("int16", 100000.0, 125.0))
        self.assertIn("6 x 5 taxels", repr(made))

    def test_geometry_and_tension_have_to_be_given(self):
        with self.assertRaisesRegex(TypeError, "depth_mm.*tension"):
            sptfra.Design("pad", columns=6, rows=5, pitch_mm=4)

    def test_files_and_pickles_give_the_same_design(self):
        loaded = sptfra.Design.load(ROOT / "designs" / "sensor1-fast")
        self.assertEqual(pickle.loads(pickle.dumps(loaded)), loaded)
        self.assertNotEqual(loaded, design())
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "copy.toml"
            loaded.save(file)
            self.assertEqual(sorted(os.listdir(folder)), ["copy.toml", "copy.weights.csv"])
            again = sptfra.Design.load(file)
            self.assertEqual(again, loaded)
            with self.assertRaisesRegex(sptfra.Error, "would overwrite the input"):
                again.save(file)

    def test_a_saved_design_finds_its_scenes(self):
        with tempfile.TemporaryDirectory() as folder:
            file, saved = Path(folder) / "pad.toml", Path(folder) / "tried" / "pad.toml"
            saved.parent.mkdir()
            filtered = design('[algorithm]\nplan = "paper"\nfilter = { kind = "f3", scenes = ["a.toml"] }\n')
            file.write_text(filtered.to_toml(), encoding="utf-8")
            sptfra.Design.load(file).save(saved)
            self.assertIn('"../a.toml"', saved.read_text(encoding="utf-8"))

    def test_what_is_wrong_is_said_as_the_commands_say_it(self):
        for call, text in [
            (lambda: sptfra.Design.load("nothing.toml"), "nothing.toml: cannot read the file"),
            (lambda: sptfra.Design.from_toml("format = 3\nname = 1"), "line 2, column 8"),
            (lambda: design("lanes = 3\n"), "pad.toml, line 9"),
            (lambda: made(columns=1), "sensor.columns is 1; use a whole number from 2 to 64"),
            (lambda: made(tension="some"), 'tension is "some"; choose one of: read, clipped'),
            (lambda: made(estimator="both"), 'estimator is "both"; choose one of: line, joint'),
            (lambda: made(counts=3), "counts of 3 bits; use 4 to 24"),
            (lambda: sptfra.scene(path=ROOT / "scenes" / "sensor1-hertz.toml", design=design()), "the scene has"),
            (lambda: sptfra.scene(), "nothing to make frames of"),
            (lambda: sptfra.calibrate(design(), training_set="odd"), 'training_set is "odd"; choose one of: sliding, general'),
            (lambda: sptfra.load_frames(ROOT / "data" / "bed_mat_64x27.csv", design()), "line 2"),
            (lambda: sptfra.generate(design(), ROOT), "which `sptfra generate` did not write; move it away or choose another folder"),
        ]:
            with self.assertRaises(sptfra.Error) as raised:
                call()
            self.assertIn(text, str(raised.exception))
        # Python's own words for what is of another type.
        with self.assertRaises(TypeError):
            sptfra.Solver("pad.toml")
        with self.assertRaisesRegex(TypeError, "of type int"):
            sptfra.calibrate(3)


class Solving(unittest.TestCase):
    def setUp(self):
        self.design = design()
        self.solver = sptfra.Solver(self.design)
        self.frames, self.truth = sptfra.scene(self.design)

    def test_forces_have_shapes_units_and_names(self):
        forces = self.solver.solve(self.frames)
        self.assertEqual(self.frames.shape, (36, 3, 4))
        shapes = [forces.field.shape, forces.resultant.shape, forces.torque.shape, forces.friction_xy.shape]
        self.assertEqual(shapes, [(36, 3, 4, 3), (36, 3), (36, 3), (36, 2)])
        np.testing.assert_allclose(forces.field.sum(axis=(1, 2)), forces.resultant, atol=1e-12)
        tangential = np.hypot(forces.resultant[:, 0], forces.resultant[:, 1])
        np.testing.assert_allclose(forces.mu, tangential / -forces.resultant[:, 2], atol=1e-12)
        np.testing.assert_allclose(forces.phi, np.arctan2(forces.resultant[:, 1], forces.resultant[:, 0]), atol=1e-12)
        self.assertTrue((forces.resultant[:, 2] < 0).all(), "what presses is negative")
        # The torque is that of the field about the middle of the grid.
        x, y = np.meshgrid(0.004 * (np.arange(4) - 1.5), 0.002 * (np.arange(3) - 1.0))
        f = np.moveaxis(forces.field, 3, 0)
        torque = [(y * f[2]).sum(axis=(1, 2)), (-x * f[2]).sum(axis=(1, 2)), (x * f[1] - y * f[0]).sum(axis=(1, 2))]
        np.testing.assert_allclose(forces.torque, np.transpose(torque), atol=1e-12)
        table = forces.table()
        self.assertEqual(table.dtype.names[:6], ("status", "F_x", "F_y", "F_z", "mu", "phi"))
        np.testing.assert_array_equal(table["F_z"], forces.resultant[:, 2])
        self.assertIsNone(self.truth.field)
        self.assertEqual(set(sptfra.errors(forces, self.truth)), {"e_Fx", "e_Fy", "e_Fz", "e_mu", "e_phi"})
        self.assertEqual(sptfra.errors(self.truth, self.truth)["e_Fx"].max, 0.0)
        of_arrays = sptfra.errors(forces.resultant, self.truth.resultant.tolist())
        for name, spread in sptfra.errors(forces, self.truth).items():
            self.assertAlmostEqual(of_arrays[name].max, spread.max, places=6)
        for wrong in (forces.resultant[:, :2], forces.resultant[0], None, "forces"):
            with self.assertRaisesRegex(ValueError, r"give what Solver.solve returns, or numbers of shape \(n, 3\)"):
                sptfra.errors(wrong, self.truth)
        with self.assertRaisesRegex(ValueError, "36 frames and true forces of 35"):
            short = self.solver.solve(self.frames[:35])
            sptfra.errors(forces, short)

    def test_frames_follow_those_of_another_call(self):
        follows = design("smoothing = 2\ncreep = { strength = 0.3, seconds = 0.1, frames_per_second = 100.0 }\n")
        solver, frames = sptfra.Solver(follows), np.repeat(sptfra.scene(follows).frames[:2], 10, axis=0)
        at_once = solver.solve(frames).resultant
        past = sptfra.Past()
        parts = [solver.solve(part, past=past).resultant for part in (frames[:7], frames[7:8], frames[8:])]
        np.testing.assert_allclose(np.concatenate(parts), at_once, atol=1e-12)
        alone = solver.solve(frames[8:]).resultant
        self.assertGreater(np.abs(alone - at_once[8:]).max(), 0.01)

    def test_each_name_has_a_unit(self):
        forces = sptfra.Solver(design()).solve(sptfra.scene(design()).frames)
        arrays = {field.name for field in dataclasses.fields(forces)} - {"records"} | {"mu", "phi"}
        records = {"taxels", "status", "x", "y", "F_x", "F_y", "F_z", "mu", "standard_error"}
        self.assertEqual((arrays | set(forces.table().dtype.names) | records) - set(sptfra.Forces.UNITS), set())
        units = [sptfra.Forces.UNITS[name] for name in ("resultant", "T_z", "phi", "x", "status")]
        self.assertEqual(units, ["N", "N m", "rad", "m", ""])
        with self.assertRaises(TypeError):
            sptfra.Forces.UNITS["resultant"] = "kN"

    def test_every_layout_gives_the_same_forces(self):
        forces = self.solver.solve(self.frames)
        many = np.tile(self.frames, (20, 1, 1))
        # Five pieces and a bit, on all cores.
        np.testing.assert_array_equal(self.solver.solve(many).field, np.tile(forces.field, (20, 1, 1, 1)))
        double = self.frames.astype(np.float32).astype(np.float64)
        expected = self.solver.solve(double).resultant
        layouts = [
            double.astype(np.float32),
            double.reshape(36, 12),
            np.asfortranarray(double),
            np.repeat(double, 2, axis=0)[::2],
            double.astype(">f8"),
            double.tolist(),
        ]
        for layout in layouts:
            np.testing.assert_array_equal(self.solver.solve(layout).resultant, expected)
        one = self.solver.solve(double[3])
        np.testing.assert_allclose(one.resultant, expected[3:4], rtol=1e-12, atol=1e-12)
        np.testing.assert_array_equal(self.solver.solve(double[3].ravel()).resultant, one.resultant)
        self.assertEqual(self.solver.solve(np.zeros((0, 12))).field.shape, (0, 3, 4, 3))
        resultants = sptfra.Solver(design("[algorithm]\noutputs = 'resultants'\n")).solve(double)
        self.assertIsNone(resultants.field)
        np.testing.assert_allclose(resultants.resultant, expected, atol=1e-12)

    def test_other_shapes_are_refused_with_those_wanted(self):
        for shape, text in [
            ((5, 11), r"\(5, 11\); pad takes \(n, 3, 4\) or \(n, 12\), and one frame as \(3, 4\) or \(12,\)"),
            ((5, 4, 3), "the transposed grid"),
            ((11,), r"\(11,\); pad takes"),
            ((2, 5, 3, 4), r"\(2, 5, 3, 4\)"),
            ((), r"\(\)"),
        ]:
            with self.assertRaisesRegex(ValueError, text):
                self.solver.solve(np.zeros(shape))
        for wrong in ("frames", np.zeros((1, 12), dtype=complex), np.zeros((1, 12), dtype=bool), None):
            with self.assertRaisesRegex(TypeError, "give numbers"):
                self.solver.solve(wrong)

    def test_statuses_have_names(self):
        frames = np.zeros((3, 12))
        frames[1, 4] = np.nan
        frames[2] = self.frames[0].ravel()
        forces = self.solver.solve(frames)
        self.assertEqual([forces.names(index) for index in range(2)], [["NO_CONTACT"], ["NOT_FINITE"]])
        np.testing.assert_array_equal(forces.has(sptfra.Status.NO_CONTACT | sptfra.Status.NOT_FINITE), [True, True, False])
        self.assertFalse(forces.field[:2].any())
        # What a mask hides is not sent.
        hidden = np.ma.array(np.zeros((3, 12)) + self.frames[0].ravel(), mask=np.isnan(frames))
        np.testing.assert_array_equal(self.solver.solve(hidden).has(sptfra.Status.NOT_FINITE), [False, True, False])
        # The driver of a board has the same bits.
        driver = (ROOT / "drivers" / "python" / "sptfra_forces.py").read_text(encoding="utf-8")
        for bit in sptfra.Status:
            self.assertIn(f"    {bit.name} = {bit.value}\n", driver)
        # But for what hardware does not know.
        known = [field.name for field in dataclasses.fields(sptfra.Forces) if field.name != "records"]
        fields = [f"    {name}: np.ndarray" for name in known]
        self.assertEqual([field for field in fields if field not in driver], [])

    def test_contacts_have_records(self):
        self.assertIsNone(self.solver.solve(self.frames).records)
        scene = sptfra.scene(path=ROOT / "scenes" / "two-contacts.toml")
        self.assertEqual(scene.truth.records.shape, (1, 2))
        np.testing.assert_allclose(scene.truth.records["F_z"], [[-3.0, -2.0]])
        np.testing.assert_allclose(scene.truth.records["x"], [[0.010, 0.027]])
        text = (ROOT / "designs" / "paper.toml").read_text(encoding="utf-8")
        several = sptfra.Design.from_toml(text.replace("[algorithm]\n", "[algorithm]\ncontacts = 3\n"))
        self.assertEqual((self.design.contacts, several.contacts), (1, 3))
        forces = sptfra.Solver(several).solve(np.tile(scene.frames, (70, 1, 1)))
        self.assertEqual(forces.records.shape, (70, 3))
        np.testing.assert_array_equal(forces.contacts, 2)
        for name in ("F_x", "F_y", "F_z"):
            np.testing.assert_allclose(forces.records[name].sum(axis=1), forces.resultant[:, "xyz".index(name[-1])])
        for name in "T_x", "T_y", "T_z":
            np.testing.assert_allclose(
                forces.records[name].sum(axis=1), forces.torque[:, "xyz".index(name[-1])], atol=1e-12)
        # The truth's, of (0, 1.2, -3) N at (-8, -3) mm from the middle, and of (0, -1.2, -2) N at (9, 3) mm.
        truth = [[scene.truth.records[name][0, contact] for name in ("T_x", "T_y", "T_z")] for contact in (0, 1)]
        np.testing.assert_allclose(truth, [[0.009, -0.024, -0.0096], [-0.006, 0.018, -0.0108]], atol=1e-9)
        self.assertFalse(forces.records["taxels"][:, 2].any())
        self.assertTrue((forces.records["taxels"][:, :2] > 0).all())
        table = forces.table()
        self.assertEqual(table.dtype.names[13:15], ("contact1_taxels", "contact1_status"))
        self.assertEqual(table.dtype.names[13 + 27:], tuple(f"contact{k}_T_{axis}" for k in (1, 2, 3) for axis in "xyz"))
        self.assertEqual(len(table.dtype), 13 + 3 * 12)
        np.testing.assert_array_equal(table["contact2_F_z"], forces.records["F_z"][:, 1])
        text = text.replace("[algorithm]\n", "[algorithm]\ncontacts = 3\nslip = { limit = 0.3, hysteresis = 0.25 }\n")
        solver = sptfra.Solver(sptfra.Design.from_toml(text))
        first = solver.solve(scene.frames)
        after = [solver.solve(scene.frames, slips=slips).records["status"] & sptfra.Status.SLIP for slips in (True, first)]
        self.assertTrue(after[0][0, :2].all())
        np.testing.assert_array_equal(after[1], first.records["status"] & sptfra.Status.SLIP)
        self.assertEqual(sptfra.plan(several).details["contacts"], 3)

    def test_slip_follows_the_frames_across_the_cores(self):
        held = design("[algorithm]\nslip = { limit = 0.4, hysteresis = 0.2 }\n")
        frames = np.concatenate([self.frames] * 12)
        forces = sptfra.Solver(held).solve(frames)
        expected, slips = [], False
        for mu in forces.mu:
            slips = bool(mu >= (0.2 if slips else 0.4))
            expected.append(slips)
        np.testing.assert_array_equal(forces.has(sptfra.Status.SLIP), expected)
        # A frame that is not finite is forgotten: in the band the one before it decides.
        solver = sptfra.Solver(held)
        band = frames[np.flatnonzero((forces.mu > 0.2) & (forces.mu < 0.4))[:1]]
        lost = solver.solve(np.concatenate([frames[forces.mu >= 0.4][:1], np.full_like(band, np.nan)]))
        self.assertEqual(lost.has(sptfra.Status.SLIP).tolist(), [True, False])
        for before, slips in [(lost, True), (lost.__class__(**{**vars(lost), "status": lost.status[1:]}), False)]:
            self.assertEqual(bool(solver.solve(band, slips=before).has(sptfra.Status.SLIP)[0]), slips)
        low = sptfra.Solver(held).solve(np.zeros(12), slips=True)
        self.assertFalse(low.has(sptfra.Status.SLIP)[0], "without contact nothing slips")

    def test_counts_are_those_of_the_samples(self):
        counting = sptfra.Design.from_toml(
            SMALL.replace("depth_mm", "pa_per_count = -10.0\ndepth_mm") + "[hardware]\nsamples = 'uint16'\n", "counts"
        )
        frames, _ = sptfra.scene(counting)
        np.testing.assert_array_equal(frames, np.round(frames))
        sptfra.Solver(counting).solve(frames.astype(np.uint16))
        with self.assertRaisesRegex(ValueError, "frame 1, taxel 2: 0.5 is no uint16"):
            frames[1, 0, 2] = 0.5
            sptfra.Solver(counting).solve(frames)
        lines = sptfra.FrameLines(counting, labels=1, origin="the port")
        self.assertIsNone(lines.frame(b"when;" + b";".join(b"taxel" for _ in range(12)) + b"\n"))
        frame = lines.frame(b"now;" + b";".join(b"%d" % (n * n) for n in range(12)))
        np.testing.assert_array_equal(frame, np.arange(12).reshape(3, 4) ** 2)
        with self.assertRaisesRegex(sptfra.Error, "the port, line 3, column 4: -2 is no uint16"):
            lines.frame(b"now;0;1;-2;3;4;5;6;7;8;9;10;11\r\n")

    def test_other_threads_run_meanwhile(self):
        frames, ticks, done = np.tile(self.frames, (600, 1, 1)), [], threading.Event()
        solving = threading.Thread(target=lambda: (self.solver.solve(frames), done.set()))
        solving.start()
        while not done.wait(0.001):
            ticks.append(1)
        solving.join()
        self.assertGreater(len(ticks), 0, "the lock is free")


    def test_an_interrupt_ends_it(self):
        frames, heard = np.tile(self.frames, (3600, 1, 1)), []

        def hear(*_):
            heard.append(True)
            # Once a signal is heard without a look at it: when the call is over.
            if len(heard) == 3:
                raise KeyboardInterrupt

        before = signal.signal(signal.SIGALRM, hear)
        try:
            with self.assertRaises(KeyboardInterrupt):
                signal.setitimer(signal.ITIMER_REAL, 0.001, 0.001)
                self.solver.solve(frames)
        finally:
            signal.setitimer(signal.ITIMER_REAL, 0)
            signal.signal(signal.SIGALRM, before)


if __name__ == "__main__":
    unittest.main()
