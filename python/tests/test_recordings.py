# SPDX-License-Identifier: MIT OR Apache-2.0
"""What the package says of frames, and what recordings tell of a sensor. As test_sptfra."""

import tempfile
import unittest
from pathlib import Path

import numpy as np
import sptfra
from test_sptfra import design


class Judging(unittest.TestCase):
    def test_what_is_wrong_with_frames_is_found(self):
        small = design()
        frames, _ = sptfra.scene(small)
        found = {finding.kind for finding in sptfra.check(small, -frames)}
        self.assertIn("sign", found)
        (only,) = sptfra.check(small, np.zeros((2, 12)))
        self.assertEqual((only.kind, str(only)), ("empty", only.message))
        frames[1, 2, 3] = np.inf
        with self.assertRaisesRegex(ValueError, "frame 1, taxel 11: inf"):
            sptfra.check(small, frames)

    def test_readings_beyond_the_calibration_are_counted(self):
        frames = np.zeros((4, 12))
        self.assertEqual(sptfra.beyond(design(), frames), (0, 0.0, 0))
        frames[1, 3] = frames[1, 4] = frames[3, 0] = -200_000.0
        found = sptfra.beyond(design(), frames)
        self.assertEqual(found, (3, 3 / 48, 2))
        self.assertEqual((found.readings, found.frames), (3, 2))
        with self.assertRaisesRegex(ValueError, "frame 0, taxel 0: NaN"):
            sptfra.beyond(design(), np.full(12, np.nan))

    def test_rest_tells_offsets_noise_and_dead_taxels(self):
        counting = sptfra.Design("pad", columns=6, rows=5, pitch_mm=(4, 2), depth_mm=3, tension="read", counts=12, full_scale_pa=100_000.0)
        random = np.random.default_rng(5)
        offset = random.uniform(20, 90, 30)
        frames = np.round(offset + random.normal(0, 2, (200, 30)))
        frames[:, 17] = 0
        found = sptfra.unloaded(counting, frames)
        self.assertEqual((found.dead, found.stuck, found.noisy, found.warnings), ((17,), (), (), ()))
        self.assertEqual([each.shape for each in (found.offset, found.noise, found.drift)], [(5, 6)] * 3)
        alive = np.arange(30) != 17
        self.assertLess(abs(found.offset.ravel() - offset)[alive].max(), 0.6)
        self.assertLess(abs(found.noise.ravel()[alive] - 2).max(), 0.5)
        self.assertAlmostEqual(found.noise_floor_pa, 3 * found.noise_pa)
        self.assertAlmostEqual(found.noise_pa, found.median_noise * 100_000 / 4095, delta=3)
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "pad.calibration.csv"
            found.save(file)
            gains = np.loadtxt(file, delimiter=",")
            pascals = sptfra.unloaded(design(), -frames[:, :12])
            with self.assertRaisesRegex(sptfra.Error, "pa_per_count"):
                pascals.save(file)
            with self.assertRaisesRegex(sptfra.Error, "pa_per_count"):
                pascals.tared  # noqa: B018
            found.tared.save(Path(folder) / "tared.toml")
            tared = sptfra.Design.load(Path(folder) / "tared.toml")
        self.assertEqual((tared, tared.name, tared.noise_floor_pa), (found.tared, "pad", found.noise_floor_pa))
        status = [sptfra.Solver(one).solve(frames).has(sptfra.Status.NO_CONTACT).all() for one in (counting, tared)]
        self.assertEqual(status, [False, True], "offsets are a contact, and none any more")
        self.assertEqual(gains[:, 0].tolist(), alive.astype(float).tolist())
        self.assertLess(abs(gains[alive, 1] + found.offset.ravel()[alive]).max(), 1e-9)
        with self.assertRaisesRegex(sptfra.Error, "3 frames without load: too few"):
            sptfra.unloaded(counting, frames[:3])

    def test_numbers_of_columns_are_a_header(self):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "frames.csv"
            numbers, line = ",".join(map(str, range(12))), ",".join(["-1000"] * 12)
            file.write_text(f"{numbers}\n{line}\n", encoding="utf-8")
            with self.assertWarnsRegex(UserWarning, "line 1: numbers up to 11"):
                self.assertEqual(sptfra.load_frames(file, design()).shape, (1, 3, 4))
            file.write_text(f"anything: 5\n{line},99\n{line},--\n{line.replace('-', 'x', 1)},99\n", encoding="utf-8")
            with self.assertWarnsRegex(UserWarning, "1 frame left out"):
                found, bad = sptfra.load_frames(file, design(), columns=(1, 12), skip_lines=1, skip_bad=True)
            self.assertEqual((found.shape, bad), ((2, 3, 4), [2]))
        lines = sptfra.FrameLines(design())
        with self.assertWarns(UserWarning):
            self.assertIsNone(lines.frame(numbers.encode()))
        self.assertEqual(lines.frame(line.encode()).shape, (3, 4))

    def test_a_calibration_is_the_design_with_constants(self):
        made, calls = sptfra.Design("pad", columns=4, rows=4, pitch_mm=(4, 2), depth_mm=3, tension="read"), []
        calibrated = sptfra.calibrate(made, hidden=0, quick=True, progress=lambda *parts: calls.append(parts))
        self.assertTrue(0 < calls[0][0] < calls[-1][0] <= calls[-1][1], calls)
        self.assertIn("gain = ", calibrated.to_toml())
        self.assertEqual(calibrated.name, "pad_calibrated")

        def stop(done, of):
            raise KeyboardInterrupt

        with self.assertRaises(KeyboardInterrupt):
            sptfra.calibrate(made, progress=stop)


class Recordings(unittest.TestCase):
    def pressed(self, reads=0.8):
        """Frames of a sensor that reads too little, touched five times, and the true normal forces."""
        made = sptfra.Design("pad", columns=6, rows=6, pitch_mm=4, depth_mm=3, tension="read")
        self.assertEqual(made.pitch_mm, (4, 4))
        for wrong, said in (([1, 2, 3], "pitch_mm: 3 lengths; write two, for x and y"), ("wide", "pitch_mm is no length")):
            with self.assertRaises(sptfra.Error) as raised:
                sptfra.Design("pad", columns=6, rows=6, pitch_mm=wrong, depth_mm=3, tension="read")
            self.assertIn(said, str(raised.exception))
        scene = sptfra.scene(made)
        touch, force = reads * scene.frames[0], scene.truth.resultant[0, 2]
        loads = np.repeat([0, 1, 0, 2, 0, 3, 0, 1.5, 0, 2.5, 0], 8)
        return made, loads[:, None, None] * touch, loads * force

    def test_forces_tell_what_a_reading_is_worth(self):
        made, frames, forces = self.pressed()
        found = sptfra.calibrate_forces(made, frames, forces, name="pad_as_recorded")
        self.assertEqual(found.design.name, "pad_as_recorded")
        before, after = (sptfra.Solver(one).solve(frames).resultant[:, 2] for one in (made, found.design))
        largest = abs(forces).max()
        self.assertGreater(abs(before - forces).max(), 0.15 * largest)
        self.assertLess(abs(after - forces).max(), 0.01 * largest)
        self.assertTrue(found.determined and found.undetermined, found)
        self.assertIn("one place", " ".join(found.undetermined))
        self.assertTrue(found.page.startswith("<!DOCTYPE html>") and "<svg" in found.page)
        self.assertEqual(len(found.details["gains"]), 36)
        # The same from a file, and with what is not known.
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "forces.csv"
            file.write_text("F_z (N)\n" + "\n".join(map(repr, map(float, forces))) + "\n", encoding="utf-8")
            self.assertEqual(sptfra.calibrate_forces(made, frames, file, name="pad_as_recorded").design, found.design)
        three = np.full((len(forces), 3), np.nan)
        three[:, 2] = forces
        again = sptfra.calibrate_forces(made, frames, three, name="pad_as_recorded")
        self.assertEqual(again.design, found.design)

    def test_a_bladder_tells_each_taxels_gain(self):
        made = sptfra.Design("pad", columns=4, rows=3, pitch_mm=(4, 4), depth_mm=3, tension="read")
        gains = np.linspace(0.8, 1.2, 12).reshape(3, 4)
        pressures = np.repeat([0, 5e3, 0, 10e3, 0, 20e3, 0, 40e3, 0], 8)
        found = sptfra.calibrate_uniform(made, -pressures[:, None, None] / gains, pressures)
        self.assertEqual(found.design.name, "pad_calibrated")
        told = np.array([taxel["gain"] for taxel in found.details["gains"]]).reshape(3, 4)
        np.testing.assert_allclose(told / told.mean(), gains / gains.mean(), rtol=0.01)

    def test_what_does_not_belong_together_is_refused(self):
        made, frames, forces = self.pressed()
        for given, text in [
            (forces[:40], "88 frames and 40 lines"),
            (np.zeros((len(forces), 2)), r"\(n, 3\)"),
            ("nowhere.csv", "nowhere.csv"),
            (np.repeat([0, 3, 0, 1.5, 0, 1, 0, 2.5, 0, 2, 0], 8), "do not begin together"),
        ]:
            with self.assertRaisesRegex(ValueError, text):
                sptfra.calibrate_forces(made, frames, given)
        with self.assertRaisesRegex(ValueError, "NaN where it is not known"):
            sptfra.calibrate_uniform(made, frames, np.zeros((3, 3)))


if __name__ == "__main__":
    unittest.main()
