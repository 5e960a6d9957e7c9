//! Recordings of a sensor on which nothing presses, and taxels that are broken.

use golden::check::{Kind, beyond, check};
use golden::design::{Curve, Design};
use golden::matrices::Matrices;
use golden::scene::{Kind as Contacts, Scene, SceneFrame, SensorErrors};
use golden::unloaded::Unloaded;

const TAXELS: usize = 78;
const PA_PER_COUNT: f64 = -24.4;

fn text(more: &str) -> String {
    format!(
        "format = 3\nbase = \"../golden/tests/plain.toml\"\n\
         name = \"mat\"\n[sensor]\ncolumns = 6\nrows = 13\npitch_mm = [3.4, 3.4]\ndepth_mm = 3.0\n\
         pa_per_count = {PA_PER_COUNT}\n{more}"
    )
}

fn mat(more: &str) -> Design {
    Design::from_toml(&text(more), "mat.toml").unwrap()
}

/// A number from 0 to 1 of two numbers.
fn uniform(a: usize, b: usize) -> f64 {
    let mut bits = (a as u64) << 32 ^ b as u64 ^ 0x9e37_79b9_7f4a_7c15;
    for _ in 0..2 {
        bits = (bits ^ bits >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ bits >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        bits ^= bits >> 31;
    }
    (bits >> 11) as f64 / (1_u64 << 53) as f64
}

/// Nearly Gaussian, of deviation 1.
fn noise(frame: usize, taxel: usize) -> f64 {
    (0..12).map(|part| uniform(frame * TAXELS + taxel, part)).sum::<f64>() - 6.0
}

/// Offsets from 20 to 100 counts.
fn offset(taxel: usize) -> f64 {
    20.0 + 80.0 * uniform(taxel, 99)
}

fn frames(count: usize, reads: impl Fn(usize, usize) -> f64) -> Vec<Vec<f64>> {
    (0..count).map(|frame| (0..TAXELS).map(|taxel| reads(frame, taxel).round() + 0.0).collect()).collect()
}

fn untared() -> Vec<Vec<f64>> {
    frames(200, |frame, taxel| offset(taxel) + 2.0 * noise(frame, taxel))
}

fn kinds(design: &Design, frames: &[Vec<f64>]) -> (Vec<Kind>, String) {
    let findings = check(design, frames, Some(&Matrices::of(design).unwrap()));
    (findings.iter().map(|found| found.kind).collect(), findings.iter().map(|found| format!("{found}\n")).collect())
}

/// With the keys that a recording gives, `check` finds nothing in it, however loud its noise is.
#[test]
fn noise_as_it_is_stated_is_nothing() {
    for counts in [0.25, 1.0, 2.0, 5.0, 10.0, 20.0, 40.0] {
        for part in 0..4 {
            let recording = frames(100, |frame, taxel| offset(taxel) + counts * noise(100 * part + frame, taxel));
            let mut design = mat("");
            let rest = Unloaded::of(&design, &recording).unwrap();
            design.algorithm.noise_floor_pa = rest.noise_floor_pa;
            design.input.calibration = Some(rest.calibration(&design, &recording).unwrap());
            assert_eq!(kinds(&design, &recording), (vec![], String::new()), "{counts} counts");
        }
    }
}

/// Neither a stuck taxel nor contacts that are scaled to 1 pass for noise, whether the floor is the design's own or stated.
#[test]
fn faults_below_the_floor_are_no_noise() {
    let mut design = mat("");
    design.algorithm.noise_floor_pa = 150.0;
    let stuck = frames(100, |frame, taxel| if taxel == 40 { 18.0 } else { 2.0 * noise(frame, taxel) });
    let (found, said) = kinds(&design, &stuck);
    assert!(!found.is_empty(), "{said}");
    let contacts = Contacts::MixedInside.frames(&design.sensor, 0.5, 1..41).unwrap();
    let scaled = |frame: &SceneFrame| {
        let mean = frame.stress.iter().sum::<f64>() / TAXELS as f64;
        let peak = frame.stress.iter().fold(0.0_f64, |peak, stress| peak.max((stress - mean).abs()));
        frame.stress.iter().map(|stress| (stress - mean) / peak).collect()
    };
    let scaled: Vec<Vec<f64>> = contacts.iter().map(scaled).collect();
    for design in [design, mat("")] {
        assert_eq!(kinds(&design, &scaled).0, [Kind::Scaled], "{}", design.algorithm.noise_floor_pa);
    }
}

#[test]
fn rest_is_told_with_offsets_tared_and_clipped() {
    let tared = frames(100, |frame, taxel| 2.0 * noise(frame, taxel));
    let clipped: Vec<Vec<f64>> = tared.iter().map(|frame| frame.iter().map(|count| count.max(0.0)).collect()).collect();
    for (what, recording) in [("untared", &untared()), ("tared", &tared), ("clipped", &clipped)] {
        for more in ["", "tension = \"clipped\"\n"] {
            let (kinds, said) = kinds(&mat(more), recording);
            assert_eq!(kinds, [Kind::Unloaded], "{what}: {said}");
            assert!(said.contains("--unloaded"), "{what}: {said}");
        }
    }
}

/// However faint, or held, a contact is none.
#[test]
fn a_faint_contact_is_not_at_rest() {
    let design = mat("");
    let pressed = |share: f64, held: bool| {
        frames(100, |frame, taxel| {
            let x = if held { 2.5 } else { 1.0 + 0.03 * frame as f64 };
            let [x, y] = [(taxel % 6) as f64 - x, (taxel / 6) as f64 - 6.0];
            share * 4095.0 * (-(x * x + y * y) / 4.0).exp() + 0.5 * noise(frame, taxel)
        })
    };
    for (share, held) in [(0.004, false), (0.008, false), (0.008, true), (0.03, true), (0.03, false)] {
        let (kinds, said) = kinds(&design, &pressed(share, held));
        assert!(!kinds.contains(&Kind::Unloaded), "{share}, held {held}: {said}");
    }
}

#[test]
fn each_taxel_at_rest_is_measured() {
    let design = mat("");
    let recording = frames(300, |frame, taxel| match taxel {
        5 => 0.0,
        40 => 4095.0,
        41 => 70.0,
        62 => 4095.0 * uniform(frame, 7),
        _ => offset(taxel) + 2.0 * noise(frame, taxel) + if taxel == 10 { frame as f64 / 10.0 } else { 0.0 },
    });
    let rest = Unloaded::of(&design, &recording).unwrap();
    assert_eq!((&rest.dead[..], &rest.stuck[..], &rest.noisy[..]), (&[5, 41][..], &[40][..], &[62][..]));
    for taxel in [0, 33, 77] {
        let found = rest.taxels[taxel];
        assert!((found.offset - offset(taxel)).abs() < 0.5, "{found:?}");
        assert!((found.noise - 2.0).abs() < 0.4 && found.drift.abs() < 0.8, "{found:?}");
    }
    // Drift is no noise: 30 counts in all, 20 from the first third to the last.
    assert!((rest.taxels[10].drift - 20.0).abs() < 0.8 && rest.taxels[10].noise < 2.5, "{:?}", rest.taxels[10]);
    assert!((rest.noise - 2.0).abs() < 0.1 && (rest.noise_pa - 48.8).abs() < 3.0, "{rest:?}");
    assert!((rest.noise_floor_pa - 3.0 * rest.noise_pa).abs() < 1e-9);
    assert!((rest.noise_of_full_scale - rest.noise_pa / 1e5).abs() < 1e-12);
    assert_eq!(rest.warnings, [] as [String; 0]);
}

/// Half of the noise is beyond the converter's end, which hides as much of its deviation.
#[test]
fn noise_that_is_clipped_or_goes_on_is_named() {
    let clipped = |least: f64, most: f64| frames(200, |frame, taxel| (4.0 * noise(frame, taxel)).clamp(least, most));
    for (least, most, which) in [(0.0, 100.0, "are 0, the least"), (-100.0, 0.0, "are 0, the largest")] {
        let rest = Unloaded::of(&mat(""), &clipped(least, most)).unwrap();
        assert!(rest.noise < 3.0 && !rest.touched, "{rest:?}");
        assert!(rest.warnings.iter().any(|warning| warning.contains(which)), "{:?}", rest.warnings);
    }
    assert_eq!(Unloaded::of(&mat(""), &clipped(-100.0, 100.0)).unwrap().warnings, [""; 0]);
    // Noise that goes on is averaged less.
    let slow = frames(200, |frame, taxel| (0..8).map(|back| 2.0 * noise(frame + back, taxel)).sum());
    let rest = Unloaded::of(&mat(""), &slow).unwrap();
    assert!((rest.correlation - 7.0 / 8.0).abs() < 0.1 && rest.goes_on(), "{}", rest.correlation);
    assert!(rest.warnings.iter().any(|warning| warning.contains("goes on from frame to frame")), "{:?}", rest.warnings);
    // Noise of half a step has few values.
    let coarse = frames(200, |frame, taxel| 0.5 * noise(frame, taxel));
    assert_eq!(Unloaded::of(&mat(""), &coarse).unwrap().warnings, [""; 0]);
}

#[test]
fn a_load_in_an_unloaded_recording_is_warned_of() {
    let design = mat("");
    let warnings = |recording: &[Vec<f64>]| Unloaded::of(&design, recording).unwrap().warnings.join("\n");
    let bump = |taxel: usize| {
        let [x, y] = [(taxel % 6) as f64 - 2.5, (taxel / 6) as f64 - 6.0];
        1000.0 * (-(x * x + y * y) / 4.0).exp()
    };
    assert_eq!(warnings(&untared()), "");
    let touched = |from: usize| {
        frames(100, |frame, taxel| 2.0 * noise(frame, taxel) + if frame >= from { bump(taxel) } else { 0.0 })
    };
    assert!(warnings(&touched(60)).contains("did something touch"), "{}", warnings(&touched(60)));
    assert!(warnings(&touched(0)).contains("does something lie"), "{}", warnings(&touched(0)));
    let begins = frames(100, |frame, taxel| if frame == 0 { 0.0 } else { offset(taxel) + 2.0 * noise(frame, taxel) });
    assert!(warnings(&begins).contains("1 of 100 frames read otherwise than all others, the first is frame 1"));
    assert!(Unloaded::of(&design, &begins).unwrap().touched);
    let warm = frames(100, |frame, taxel| offset(taxel) + 2.0 * noise(frame, taxel) + 0.2 * frame as f64);
    assert!(warnings(&warm).contains("drifts by 13"), "{}", warnings(&warm));
    // A converter that clips at 0, or with steps larger than the noise: constant taxels need not be dead.
    let clipped = frames(100, |frame, taxel| if taxel == 7 { 0.0 } else { (2.0 * noise(frame, taxel)).max(0.0) });
    let coarse =
        frames(100, |frame, taxel| offset(taxel).round() + if taxel == 7 { 0.0 } else { 0.3 * noise(frame, taxel) });
    for recording in [clipped, coarse] {
        let rest = Unloaded::of(&design, &recording).unwrap();
        assert!(rest.dead.is_empty() && rest.stuck.is_empty(), "{:?} {:?}", rest.dead, rest.stuck);
        assert!(rest.warnings.join("").contains("[7] never change"), "{:?}", rest.warnings);
    }
    assert!(warnings(&frames(20, |_, _| 0.0)).contains("never changes"));
    assert!(Unloaded::of(&design, &untared()[..3]).unwrap_err().starts_with("3 frames without load: too few"));
}

#[test]
fn one_broken_taxel_under_load_is_named() {
    let plain = mat("");
    let mut scene = Scene::standing(&plain.sensor);
    scene.sensor_errors = SensorErrors { seed: 3, noise: 0.002, ..SensorErrors::default() };
    let standing: Vec<Vec<f64>> = scene.frames().unwrap().into_iter().map(|frame| frame.stress).collect();
    let counts = |frames: &[Vec<f64>]| -> Vec<Vec<f64>> {
        frames.iter().map(|frame| frame.iter().map(|pa| (pa / PA_PER_COUNT).round() + 0.0).collect()).collect()
    };
    let good = counts(&standing);
    assert_eq!(kinds(&plain, &good).0, []);
    let broken = |taxel: usize, reads: &dyn Fn(usize) -> f64| {
        let mut frames = good.clone();
        for (index, frame) in frames.iter_mut().enumerate() {
            frame[taxel] = reads(index);
        }
        kinds(&plain, &frames)
    };
    for (taxel, reads, words) in [
        (62, &(|frame| (4095.0 * uniform(frame, 7)).round()) as &dyn Fn(usize) -> f64, "62 (2, 10) jumps"),
        (62, &|_| 4095.0, "62 (2, 10) is stuck at 4095"),
        (8, &|_| 4095.0, "8 (2, 1) is stuck at 4095"),
        (38, &|_| 0.0, "38 (2, 6) reads the same"),
    ] {
        let (kinds, said) = broken(taxel, reads);
        assert_eq!(kinds, [Kind::Dead], "{taxel}: {said}");
        assert!(said.contains(words) && said.contains("sensor.dead"), "{said}");
    }
    // With what is known of it nothing is found.
    let mut known = good.clone();
    for frame in &mut known {
        frame[62] = 4095.0;
    }
    assert!(!kinds(&mat("dead = [62]\n"), &known).0.contains(&Kind::Dead));
}

#[test]
fn readings_beyond_the_calibration_are_counted() {
    let design = mat("dead = [3]\n");
    let mut recording = frames(10, |_, _| 100.0);
    assert_eq!(beyond(&design, &recording).readings, 0);
    // A hundred thousand pascals are 4098.4 counts; a dead taxel's reading means nothing.
    (recording[0][0], recording[4][1], recording[4][2], recording[5][3], recording[6][0]) =
        (4099.0, 5000.0, -5000.0, 9000.0, 4098.0);
    let found = beyond(&design, &recording);
    assert_eq!((found.readings, found.frames), (3, 2));
    assert!((found.share - 3.0 / 770.0).abs() < 1e-12, "{found:?}");
    // Along a curve: at its lower end it is still good, at the end of larger magnitude nobody knows what more would read.
    let mut curved = design.clone();
    curved.input.pa_per_count = None;
    curved.input.curve = Some(Curve { points: vec![[10.0, 0.0], [4000.0, -9e4]], law: None });
    let mut recording = frames(10, |_, _| 100.0);
    (recording[0][0], recording[0][1], recording[1][0], recording[2][0]) = (10.0, 3999.0, 9.0, 4000.0);
    (recording[2][1], recording[2][3], recording[7][2]) = (5000.0, 1.0, -20.0);
    let found = beyond(&curved, &recording);
    assert_eq!((found.readings, found.frames), (4, 3));
}
