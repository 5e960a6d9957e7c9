//! Usual mistakes with a sensor, each found and named, and frames without one, which are left alone.

use std::path::Path;

use crate::designs::design;
use golden::check::{Finding, Kind, check};
use golden::design::{Curve, Design, Input, Tension};
use golden::frames::read_recording;
use golden::matrices::Matrices;
use golden::scene::{Converter, Scene, SensorErrors};
use golden::solver::{Solver, Status};

fn repository(path: &str) -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path)
}

/// The standing frames of a design as its sensor delivers them, with noise.
fn frames(design: &Design) -> Vec<Vec<f64>> {
    let mut scene = Scene::standing(&design.sensor);
    scene.sensor_errors = SensorErrors { seed: 3, noise: 0.002, ..SensorErrors::default() };
    stress(design, &scene)
}

fn stress(design: &Design, scene: &Scene) -> Vec<Vec<f64>> {
    let frames = scene.frames().unwrap().into_iter().map(|frame| frame.stress);
    frames
        .map(|mut frame| {
            design.deliver(&mut frame);
            frame
        })
        .collect()
}

fn changed(frames: &[Vec<f64>], change: impl Fn(f64) -> f64) -> Vec<Vec<f64>> {
    frames.iter().map(|frame| frame.iter().map(|&value| change(value)).collect()).collect()
}

fn look(design: &Design, frames: &[Vec<f64>]) -> Vec<Finding> {
    check(design, frames, Some(&Matrices::of(design).unwrap()))
}

#[track_caller]
fn found(design: &Design, frames: &[Vec<f64>], kinds: &[Kind], words: &[&str]) {
    let findings = look(design, frames);
    assert_eq!(findings.iter().map(|finding| finding.kind).collect::<Vec<_>>(), kinds, "{findings:?}");
    let said = findings.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n");
    assert_eq!(said.lines().count(), kinds.len(), "a line each: {said}");
    for word in words {
        assert!(said.contains(word), "no {word:?} in: {said}");
    }
}

#[test]
fn good_frames_are_left_alone() {
    for name in ["sensor1-fast", "sensor2-fast", "odd", "small", "sensor1-none"] {
        let design = design(name);
        found(&design, &frames(&design), &[], &[]);
    }
    for (scene, name) in [
        ("sensor1-hertz", "sensor1-fast"),
        ("sensor2-disc", "sensor2-fast"),
        ("sensor2-punch", "sensor2-fast"),
        ("two-contacts", "sensor1-fast"),
    ] {
        let (design, scene) = (design(name), Scene::load(&repository(&format!("scenes/{scene}.toml"))).unwrap());
        found(&design, &stress(&design, &scene), &[], &[]);
    }
}

#[test]
fn a_real_mat_reads_no_tension_and_reaches_the_end_of_its_range() {
    let mut design = design("bed-mat");
    design.input.tension = Tension::Read;
    let frames = read_recording(&repository("data/bed_mat_64x27.csv"), &design, 2).unwrap().frames;
    let findings = check(&design, &frames, None);
    // 73 readings are 104, one is 103, three are 102.
    let kinds: Vec<Kind> = findings.iter().map(|finding| finding.kind).collect();
    assert_eq!(kinds, [Kind::NoTension, Kind::Stuck], "{findings:?}");
    assert!(findings[1].to_string().contains("73 readings of 22 frames are exactly 104"), "{findings:?}");
    // Of a sensor that is said to read none it is no finding.
    design.input.tension = Tension::Clipped;
    assert_eq!(check(&design, &frames, None), findings[1..]);
}

#[test]
fn other_units() {
    let design = design("sensor1-fast");
    let pascals = frames(&design);
    found(&design, &changed(&pascals, |pa| pa / 1000.0), &[Kind::Range], &["kilopascals", "sensor.pa_per_count"]);
    // Though below the noise floor.
    let mut noisy = design.clone();
    noisy.algorithm.noise_floor_pa = 1000.0;
    found(&noisy, &changed(&pascals, |pa| pa / 1000.0), &[Kind::Range], &["kilopascals"]);
    found(&design, &changed(&pascals, |pa| pa * 100.0), &[Kind::Range], &["above hardware.full_scale_pa"]);
    let counting = Design::from_toml(
        &design.to_toml().replace("depth_mm", "pa_per_count = -24.4\ndepth_mm"),
        &repository("designs/counting.toml").display().to_string().replace("counting", "sensor1-fast"),
    );
    // The weights have another name there; what counts is the input.
    let mut counting = counting.unwrap_or(design.clone());
    counting.input.pa_per_count = Some(-24.4);
    // Counts of a converter that a design in pascals takes for pascals, and the other way round.
    let counts = changed(&pascals, |pa| (pa / -24.4).round());
    found(&counting, &counts, &[], &[]);
    found(
        &design,
        &counts,
        &[Kind::Range, Kind::Sign],
        &["counts of a converter", "what a count is worth, with a minus"],
    );
    let pressing = changed(&counts, |count| -count);
    found(&design, &pressing, &[Kind::Range], &["whole numbers, the largest 2", "sensor.pa_per_count"]);
    found(&design, &changed(&pascals, f64::round), &[], &[]);
    // One line, whatever a count is said to be worth: with the sign changed the forces would be those of another scale.
    for worth in [-24.4, -5.0, -1.5, -0.5] {
        counting.input.pa_per_count = Some(worth);
        found(&counting, &pascals, &[Kind::Range], &["in pascals already? Remove sensor.pa_per_count"]);
    }
    counting.input.pa_per_count = Some(-24.4);
    let whole = changed(&pascals, f64::round);
    found(
        &counting,
        &whole,
        &[Kind::Range],
        &["times above hardware.full_scale_pa: are the frames in pascals already?"],
    );
    found(&counting, &pressing, &[Kind::Sign], &["change the sign of sensor.pa_per_count"]);
    found(&design, &changed(&pascals, |_| 0.0), &[Kind::Empty], &["connected"]);
}

/// What is to be changed is the curve, where one says what a count is worth.
#[test]
fn a_curve_is_named_where_it_says_what_a_count_is_worth() {
    let plain = design("sensor1-fast");
    let counts = changed(&frames(&plain), |pa| (pa / -24.4).round());
    let along = |points: &[[f64; 2]], law: Option<[f64; 2]>| {
        let mut design = plain.clone();
        design.input.curve = Some(Curve { points: points.to_vec(), law });
        design
    };
    let points = along(&[[-9000.0, 219_600.0], [0.0, 0.0], [9000.0, -219_600.0]], None);
    found(&points, &counts, &[], &[]);
    let file = "the pascals in the file of sensor.curve";
    let pressing = changed(&counts, |count| -count);
    found(&points, &pressing, &[Kind::Sign], &[&format!("change the sign of {file}")]);
    found(&points, &frames(&plain), &[Kind::Range], &["Remove sensor.curve; if they are counts that fall", file]);
    let small = along(&[[-9000.0, 210.0], [0.0, 0.0], [9000.0, -210.0]], None);
    found(&small, &counts, &[Kind::Range], &[&format!("is a count worth more? Change {file} or hardware")]);
    let large = along(&[[-9000.0, 1e9], [0.0, 0.0], [9000.0, -1e9]], None);
    found(&large, &counts, &[Kind::Range], &[&format!("Remove sensor.curve; if not, change {file} or hardware")]);
    let offset = changed(&counts, |count| 4000.0 - count);
    let told = look(&points, &changed(&offset, |count| 2.0 * count));
    assert!(told.iter().any(|each| each.to_string().contains(&format!("Change the sign of {file}"))), "{told:?}");
    // A power law is worth nothing below 0.
    let law = along(&[[0.0, 0.0], [9000.0, 219_600.0]], Some([1.0, 24.4]));
    let said = look(&law, &counts);
    let sign = said.iter().find(|each| each.kind == Kind::Sign).expect("a pull");
    assert!(sign.to_string().ends_with("change the sign of sensor.curve.scale"), "{sign}");
    let below = changed(&counts, |count| -count.abs());
    found(&law, &below, &[Kind::Range], &["are 0 Pa by sensor.curve, whose counts begin at 0", "remove sensor.curve"]);
    found(&law, &changed(&counts, |_| 0.0), &[Kind::Empty], &["connected"]);
}

#[test]
fn a_wrong_sign_hides_nothing_else() {
    let mut design = design("sensor2-fast");
    // Nor does it make contacts out of one.
    design.algorithm.count_contacts = true;
    let frames = frames(&design);
    found(&design, &changed(&frames, |pa| -pa), &[Kind::Sign], &["36 of 36 frames", "sensor.pa_per_count = -1.0"]);
    found(&design, &changed(&frames, |pa| (-pa).max(0.0)), &[Kind::Sign, Kind::NoTension], &["cannot read tension"]);
}

#[test]
fn a_converter_without_a_sign_clips_tension() {
    let design = design("sensor1-fast");
    found(&design, &changed(&frames(&design), |pa| pa.min(0.0)), &[Kind::NoTension], &["below 0"]);
}

#[test]
fn a_pull_where_the_design_says_that_none_is_read() {
    let reads = design("sensor1-fast");
    let pulls = frames(&reads);
    found(&design("sensor1-clipped-wide"), &pulls, &[Kind::Tension], &["36 of 36 frames", "remove sensor.tension"]);
    // Noise about zero is no pull.
    let noisy = changed(&pulls, |pa| if pa > 0.0 { 0.004 * pa.min(5e4) } else { pa });
    found(&design("sensor1-clipped-wide"), &noisy, &[], &[]);
}

#[test]
fn a_missing_tare_is_found_where_the_answer_still_looks_good() {
    let design = design("sensor1-fast");
    let frames = frames(&design);
    let solver = Solver::new(&design).unwrap();
    // 20 and 300 steps of a converter of 12 bits.
    for counts in [20.0, 300.0] {
        let loaded = changed(&frames, |pa| pa - 24.4 * counts);
        found(&design, &loaded, &[Kind::Tare], &["36 of 36 frames", "tare", "sensor.calibration"]);
        let solution = solver.solve(&loaded[0]).unwrap();
        // The large one loads the border.
        let other = solution.status.0 & !Status::LOW_CONFIDENCE.0;
        assert_eq!(other, 0, "{counts}: {}", solution.status);
        assert!(solution.resultant[2] < -6.3, "the load of the tare counts as force: {:?}", solution.resultant);
    }
    // With frames that read nothing before the touch, there is no tare to miss.
    let rest = vec![vec![0.0; design.sensor.taxels()]; 10];
    let large = [rest, changed(&frames, |pa| pa - 24.4 * 300.0)].concat();
    found(&design, &large, &[Kind::Tare], &["36 of 36 frames", "the contact covers the grid"]);
}

#[test]
fn transposed_grids_and_rows_that_run_back() {
    // Pitches of 4 and 2 mm tell a transposed grid from another contact, and so do unequal sides.
    let oblong = "format = 3\nbase = \"../golden/tests/plain.toml\"\n\
         name = \"oblong\"\n[sensor]\ncolumns = 12\nrows = 8\npitch_mm = [3.0, 3.0]\ndepth_mm = 3.0\n";
    for design in [design("sensor1-fast"), Design::from_toml(oblong, "oblong.toml").unwrap()] {
        let (columns, rows) = (design.sensor.columns, design.sensor.rows);
        let frames = frames(&design);
        let reordered = |place: &dyn Fn(usize, usize) -> usize| -> Vec<Vec<f64>> {
            let order = |frame: &Vec<f64>| {
                let mut other = vec![0.0; frame.len()];
                for (taxel, &value) in frame.iter().enumerate() {
                    other[place(taxel % columns, taxel / columns)] = value;
                }
                other
            };
            frames.iter().map(order).collect()
        };
        let mut counting = design.clone();
        counting.algorithm.count_contacts = true;
        found(&counting, &reordered(&|x, y| x * rows + y), &[Kind::Order], &["column after column"]);
        let back = |x, y| y * columns + if y % 2 == 1 { columns - 1 - x } else { x };
        // A contact in the middle of rows that run back is nearly its own mirror image; put it aside.
        let mut scene = Scene::standing(&design.sensor);
        scene.contacts[0].centre_m[0] *= 0.5;
        let aside = stress(&design, &scene);
        let turned: Vec<Vec<f64>> = aside
            .iter()
            .map(|frame| (0..frame.len()).map(|taxel| frame[back(taxel % columns, taxel / columns)]).collect())
            .collect();
        found(&design, &aside, &[], &[]);
        found(&design, &turned, &[Kind::Order], &["every second row backwards"]);
        let shuffled = reordered(&|x, y| (7 * (y * columns + x) + 3) % (columns * rows));
        found(&design, &shuffled, &[Kind::Order], &["checkerboard", "i = iy * columns + ix"]);
    }
}

#[test]
fn the_end_of_a_converter_below_full_scale() {
    let mut design = design("sensor1-fast");
    design.hardware.full_scale_pa = 200_000.0;
    let mut scene = Scene::standing(&design.sensor);
    scene.contacts[0].normal_force_n *= 2.5;
    let converter = Converter { bits: 13, full_scale_pa: 4096.0 * 24.4 };
    scene.sensor_errors = SensorErrors { seed: 3, noise: 0.002, converter: Some(converter), ..SensorErrors::default() };
    found(&design, &stress(&design, &scene), &[Kind::Stuck], &["99942", "hardware.full_scale_pa", "saturated"]);
    design.hardware.full_scale_pa = 4096.0 * 24.4;
    found(&design, &stress(&design, &scene), &[], &[]);
    // Coarse readings alone are not at an end.
    scene.contacts[0].normal_force_n /= 2.5;
    let frames = stress(&design, &scene);
    found(&design, &frames, &[], &[]);
    // A converter that ends sooner where taxels pull.
    let pulled = frames.iter().flatten().fold(0.0, |most: f64, &pa| most.max(pa));
    let clipped = changed(&frames, |pa| pa.min((0.4 * pulled).round()));
    found(&design, &clipped, &[Kind::Stuck], &["of their sign", "range reach farther"]);
}

/// A pad as `sptfra new` makes it: taxels of 4 mm, so deep.
fn pad(columns: usize, rows: usize, depth_mm: f64) -> Design {
    let text = format!(
        "format = 3\nbase = \"../golden/tests/plain.toml\"\n\
         name = \"pad\"\n[sensor]\ncolumns = {columns}\nrows = {rows}\npitch_mm = [4.0, 4.0]\ndepth_mm = {depth_mm:?}\n"
    );
    Design::from_toml(&text, "pad.toml").unwrap()
}

/// Grids with a taxel in the middle, where a contact that stays there has its peak; and layers that are deep.
#[test]
fn good_frames_of_any_grid_and_depth_are_left_alone() {
    let sizes = [(5, 5), (9, 9), (7, 5), (4, 3), (6, 6), (10, 10), (15, 15)];
    let pads = sizes.map(|(columns, rows)| pad(columns, rows, 3.0)).into_iter();
    let depths = [2.0, 4.0, 5.0, 6.0].into_iter().flat_map(|depth| [pad(10, 10, depth), pad(6, 6, depth)]);
    for design in pads.chain(depths) {
        let mut scene = Scene::standing(&design.sensor);
        for noise in [0.0, 0.002, 0.01] {
            scene.sensor_errors = SensorErrors { seed: 3, noise, ..SensorErrors::default() };
            let findings = look(&design, &stress(&design, &scene));
            assert!(findings.is_empty(), "{}, noise {noise}: {findings:?}", design.sensor);
        }
        // One frame again and again.
        scene.sweep_deg.truncate(1);
        let same = vec![stress(&design, &scene).remove(0); 20];
        assert_eq!(look(&design, &same), [], "{}", design.sensor);
        // At rest, in counts of a converter.
        let rest: Vec<Vec<f64>> = (0..20)
            .map(|frame| (0..design.sensor.taxels()).map(|taxel| -24.4 * ((frame + taxel) % 3) as f64).collect())
            .collect();
        assert!(look(&design, &rest).iter().all(|finding| finding.kind != Kind::Stuck), "{}", design.sensor);
    }
}

#[test]
fn an_offset_of_either_sign_is_one() {
    for (name, share) in [("sensor1-fast", 0.05), ("sensor2-fast", 0.05), ("sensor2-fast", 0.1)] {
        let design = design(name);
        let frames = frames(&design);
        let peak = frames.iter().flatten().fold(0.0_f64, |peak, pa| peak.max(pa.abs()));
        let lifted = look(&design, &changed(&frames, |pa| pa + share * peak));
        let tare = lifted.iter().find(|finding| finding.kind == Kind::Tare);
        assert!(tare.is_some_and(|finding| finding.to_string().contains("drifted")), "{name}: {lifted:?}");
    }
    let design = design("sensor2-fast");
    let falling = changed(&frames(&design), |pa| -100_000.0 - pa);
    assert!(look(&design, &falling)[0].to_string().contains("do the readings fall"), "{:?}", look(&design, &falling));
}

#[test]
fn dead_taxels_within_a_contact_are_named() {
    let mut design = design("sensor2-fast");
    let frames = frames(&design);
    let without = |dead: &[usize], reads: f64| -> Vec<Vec<f64>> {
        let mut frames = frames.clone();
        for frame in &mut frames {
            for &taxel in dead {
                frame[taxel] = reads;
            }
        }
        frames
    };
    found(&design, &without(&[44], 0.0), &[Kind::Dead], &["taxel 44 (4, 4) reads", "sensor.dead"]);
    found(&design, &without(&[54], -300.0), &[Kind::Dead], &["taxel 54 (4, 5) reads"]);
    let row: Vec<usize> = (50..60).collect();
    found(&design, &without(&row, 0.0), &[Kind::Dead], &["row 5 of the matrix", "reads the same", "wire broken"]);
    let column: Vec<usize> = (0..10).map(|row| 10 * row + 4).collect();
    found(&design, &without(&column, 0.0), &[Kind::Dead], &["column 4 of the matrix", "leave out that part"]);
    let rows: Vec<usize> = (40..60).collect();
    found(&design, &without(&rows, 0.0), &[Kind::Dead], &["row 4, row 5 of the matrix", "read the same"]);
    // At the edge, beside what the contact loads.
    let edge: Vec<usize> = (0..40).collect();
    found(&design, &without(&edge[..30], 0.0), &[], &[]);
    let near: Vec<Vec<f64>> =
        frames.iter().map(|frame| frame[20..].iter().chain(&frame[..20]).copied().collect()).collect();
    let dead: Vec<Vec<f64>> = near
        .iter()
        .map(|frame| frame.iter().enumerate().map(|(taxel, &pa)| if taxel < 20 { 0.0 } else { pa }).collect())
        .collect();
    found(&design, &dead, &[Kind::Dead], &["row 0, row 1 of the matrix (from 0) read the same"]);
    let mut bridged = frames.clone();
    for frame in &mut bridged {
        frame.copy_within(60..70, 50);
    }
    found(&design, &bridged, &[Kind::Dead], &["row 5 and row 6 of the matrix", "wires connected"]);
    // It makes two contacts of one.
    let counting = Design {
        algorithm: golden::design::Algorithm { count_contacts: true, ..design.algorithm.clone() },
        ..design.clone()
    };
    found(&counting, &without(&rows, 0.0), &[Kind::Dead], &[]);
    // A row that reads noise of 1 % of the peak.
    let peak = frames.iter().flatten().fold(0.0_f64, |peak, pa| peak.max(pa.abs()));
    let noise = |frame: usize, taxel: usize| f64::from(((frame * 7919 + taxel * 104_729) % 1601) as u32) / 800.0 - 1.0;
    for rows in [50..60, 40..60] {
        let mut noisy = frames.clone();
        for (number, frame) in noisy.iter_mut().enumerate() {
            rows.clone().for_each(|taxel| frame[taxel] = 0.01 * peak * noise(number, taxel));
        }
        found(&design, &noisy, &[Kind::Dead], &["row 5 of the matrix (from 0) read", "nothing but noise"]);
    }
    // One far from the contact may well read nothing, and the design knows of this one.
    found(&design, &without(&[0], 0.0), &[], &[]);
    design.input.dead = vec![44];
    assert!(look(&design, &without(&[44], 0.0)).iter().all(|finding| finding.kind != Kind::Dead));
}

/// Whole counts of a coarse converter, while something slides over the taxels.
#[test]
fn coarse_counts_are_not_at_an_end() {
    let mut design = pad(10, 10, 3.0);
    design.input.pa_per_count = Some(-400.0);
    for peak in [32.4, 40.4, 50.4, 64.4, 100.4] {
        let frame = |place: f64| -> Vec<f64> {
            let bump = |taxel: usize| {
                let [x, y] = [(taxel % 10) as f64 - place, (taxel / 10) as f64 - 4.5];
                (peak * (-(x * x + y * y) / 3.0).exp()).round()
            };
            (0..100).map(bump).collect()
        };
        let frames: Vec<Vec<f64>> = (0..60).map(|step| frame(2.5 + 5.0 * f64::from(step) / 60.0)).collect();
        let findings = look(&design, &frames);
        assert!(findings.iter().all(|finding| finding.kind != Kind::Stuck), "{peak}: {findings:?}");
    }
}

/// Of contacts of every kind the order that they have is left alone, and a transposed grid is found: always where the layer
/// is deep enough for the pitch, mostly at half of the longer one.
#[test]
fn the_order_shows_on_contacts_of_every_kind() {
    for (depth_mm, least) in [(3.0, 18), (2.0, 12)] {
        let (mut design, mut found) = (design("sensor1-fast"), 0);
        (design.sensor.rows, design.sensor.depth_mm) = (6, depth_mm);
        let (columns, rows) = (design.sensor.columns, design.sensor.rows);
        for kind in golden::scene::Kind::all() {
            let frames = kind.frames(&design.sensor, 0.8, 500..508).unwrap();
            let good: Vec<Vec<f64>> = frames.into_iter().map(|frame| frame.stress).collect();
            let turn = |frame: &Vec<f64>| (0..frame.len()).map(|at| frame[(at % rows) * columns + at / rows]).collect();
            let turned: Vec<Vec<f64>> = good.iter().map(turn).collect();
            let [good, turned] = [good, turned]
                .map(|frames| look(&design, &frames).into_iter().find(|finding| finding.kind == Kind::Order));
            assert_eq!(good, None, "{depth_mm} mm deep, {}", kind.title());
            found += usize::from(turned.is_some_and(|finding| finding.to_string().contains("column after column")));
        }
        assert!(found >= least, "{depth_mm} mm deep: found in {found} of 18 kinds");
    }
}

/// Frames at rest are no contact in another unit, in another order, or of several contacts; beside contacts they are nothing.
#[test]
fn rest_is_told_and_no_contact_is_made_of_it() {
    let mut design = design("sensor1-fast");
    design.algorithm.count_contacts = true;
    // As even as a generator of a line makes it: from -8 to 8 Pa.
    let noise = |frame: usize, taxel: usize| f64::from(((frame * 7919 + taxel * 104_729) % 1601) as u32) / 100.0 - 8.0;
    let rest: Vec<Vec<f64>> =
        (0..30).map(|frame| (0..design.sensor.taxels()).map(|taxel| noise(frame, taxel)).collect()).collect();
    found(&design, &rest, &[Kind::Unloaded], &["nothing presses in 30 of 30 frames", "algorithm.noise_floor_pa = 6."]);
    let solver = |design: &Design| Solver::new(design).unwrap();
    let status = |design: &Design| solver(design).solve(&rest[0]).unwrap().status;
    assert!(!status(&design).contains(golden::solver::Status::NO_CONTACT));
    design.algorithm.noise_floor_pa = 6.5;
    assert!(status(&design).contains(golden::solver::Status::NO_CONTACT), "as the message says");
    let contacts = frames(&design);
    found(&design, &[rest, contacts].concat(), &[], &[]);
}

#[test]
fn frames_that_are_each_scaled_by_their_own_peak() {
    let design = design("sensor1-fast");
    let frames = frames(&design);
    let scaled = |of: &dyn Fn(&[f64]) -> [f64; 2]| -> Vec<Vec<f64>> {
        let each = |frame: &Vec<f64>| {
            let [zero, one] = of(frame);
            frame.iter().map(|pa| (pa - zero) / (one - zero)).collect()
        };
        frames.iter().map(each).collect()
    };
    let peak = |frame: &[f64]| frame.iter().fold(0.0_f64, |peak, pa| peak.max(pa.abs()));
    let ends =
        |frame: &[f64]| [f64::min, f64::max].map(|pick: fn(f64, f64) -> f64| frame.iter().copied().fold(0.0, pick));
    let clipped = |frame: &[f64]| [ends(frame)[0], ends(frame)[0].mul_add(0.2, 0.0)];
    let sum = |frame: &[f64]| frame.iter().sum::<f64>();
    let root = |frame: &[f64]| frame.iter().map(|pa| pa * pa).sum::<f64>().sqrt();
    // Of every other frame another shape.
    let sharpened: Vec<Vec<f64>> = (0..)
        .zip(&frames)
        .map(|(number, frame)| {
            let peak = peak(frame);
            let frame: Vec<f64> = frame.iter().map(|pa| pa * (pa / peak).abs().powi(number % 2 * 4)).collect();
            frame.iter().map(|pa| 77.7 * pa / root(&frame)).collect()
        })
        .collect();
    let of_sum = |whole: f64, decimals: f64| -> Vec<Vec<f64>> {
        let each = |frame: &Vec<f64>| {
            let sum = sum(frame);
            frame.iter().map(|pa| (decimals * whole * pa / sum).round() / decimals).collect()
        };
        sharpened.iter().map(each).collect()
    };
    for (frames, same) in [
        (of_sum(4000.0, 1.0), "sum, "),
        (of_sum(1.0, 1000.0), "sum, "),
        (scaled(&|frame| [0.0, peak(frame)]), "largest reading, 1"),
        (scaled(&|frame| [0.0, peak(frame) / 255.0]), "largest reading, 255"),
        (scaled(&ends), "largest reading, 1"),
        (changed(&scaled(&clipped), |share| share.min(1.0)), "largest reading, 1"),
        (changed(&scaled(&|frame| [0.0, sum(frame)]), |share| (1e6 * share).round() / 1e6), "sum, "),
        (scaled(&|frame| [0.0, -0.01 * sum(frame)]), "sum, "),
        (scaled(&|frame| [0.0, root(frame)]), "root of the sum of squares, 1"),
        (sharpened.clone(), "root of the sum of squares, 77.7"),
        (scaled(&|frame| [0.0, root(frame) / (frame.len() as f64).sqrt()]), "root mean square, 1"),
    ] {
        let words = [&format!("all 36 frames have the same {same}"), "Its force is lost", "scale all frames alike"];
        found(&design, &frames, &[Kind::Scaled], &words);
    }
    // One load at other places, without noise.
    let at = |column: usize| {
        let mut frame = vec![0.0; 100];
        (frame[40 + column], frame[41 + column]) = (-4321.5, -1234.5);
        frame
    };
    let moved = look(&design, &(1..8).map(at).collect::<Vec<_>>());
    assert!(moved.iter().all(|finding| finding.kind != Kind::Scaled), "{moved:?}");
}

#[test]
fn noise_about_the_tare_is_no_tension() {
    let reads = design("sensor1-clipped-wide");
    let noise = |frame: usize, taxel: usize| f64::from(((frame * 7919 + taxel * 104_729) % 1601) as u32) / 800.0 - 1.0;
    let frames = frames(&reads);
    let peak = frames.iter().flatten().fold(0.0_f64, |peak, pa| peak.max(pa.abs()));
    let noisy: Vec<Vec<f64>> = frames
        .iter()
        .enumerate()
        .map(|(k, frame)| frame.iter().enumerate().map(|(i, pa)| pa.min(0.0) + 0.03 * peak * noise(k, i)).collect())
        .collect();
    let findings = look(&reads, &noisy);
    assert!(findings.iter().all(|finding| finding.kind != Kind::Tension), "{findings:?}");
}

/// A converter whose range ends far below the full scale flattens most contacts.
#[test]
fn many_readings_at_the_end_of_a_small_range() {
    let design = design("sensor1-fast");
    let frames = frames(&design);
    let peak = frames.iter().flatten().fold(0.0_f64, |peak, pa| peak.max(pa.abs()));
    let end = design.hardware.full_scale_pa / 20.0;
    let clipped = changed(&frames, |pa| (end * 4.0 / peak * pa).max(-end));
    assert!(look(&design, &clipped).iter().any(|finding| finding.kind == Kind::Stuck), "{:?}", look(&design, &clipped));
}

/// A dead taxel's reading is none that frames have in common.
#[test]
fn a_dead_taxel_scales_no_frame() {
    let mut design = design("sensor1-fast");
    design.input.dead = vec![0];
    let dead: Vec<Vec<f64>> = frames(&design).into_iter().map(|frame| [&[-9e9], &frame[1..]].concat()).collect();
    assert!(look(&design, &dead).iter().all(|finding| finding.kind != Kind::Scaled));
}

/// Noise as it is stated, or a contact that moves, is no reason to speak of the noise.
#[test]
fn noise_that_restarts_the_average() {
    let mut design = design("sensor1-fast");
    (design.input.smoothing, design.input.noise) = (4, 0.005);
    let frames = |noise: f64, turn: f64| {
        let mut scene = Scene::standing(&design.sensor);
        scene.sweep_deg = (0..40).map(|frame| turn * f64::from(frame)).collect();
        scene.sensor_errors = SensorErrors { seed: 3, noise, ..SensorErrors::default() };
        stress(&design, &scene)
    };
    let words =
        ["noise restarts the average in 3", "of 40 frames", "6 times sensor.noise = 0.005", "--unloaded --loaded"];
    found(&design, &frames(0.02, 0.0), &[Kind::Noise], &words);
    for (noise, turn) in [(0.005, 0.0), (0.005, 30.0)] {
        found(&design, &frames(noise, turn), &[], &[]);
    }
    let still = Design { input: Input { smoothing: 0, ..design.input.clone() }, ..design.clone() };
    found(&still, &frames(0.02, 0.0), &[], &[]);
}

/// An array of as many frames as rows and columns says which axis the frames are along, if that shows.
#[test]
fn an_array_with_its_frames_last() {
    let (design, mut found) = (pad(10, 10, 3.0), 0);
    for kind in golden::scene::Kind::all() {
        let frames: Vec<Vec<f64>> =
            kind.frames(&design.sensor, 0.8, 500..510).unwrap().into_iter().map(|frame| frame.stress).collect();
        let last: Vec<Vec<f64>> =
            (0..10).map(|y| (0..100).map(|at| frames[at % 10][10 * y + at / 10]).collect()).collect();
        let axis = |frames: &[Vec<f64>]| {
            let findings = check(&design, frames, None);
            findings.into_iter().find(|finding| finding.to_string().contains("moveaxis(frames, 2, 0)"))
        };
        assert_eq!(axis(&frames), None, "{}", kind.title());
        found += usize::from(axis(&last).is_some());
    }
    assert!(found >= 9, "found in {found} of 18 kinds");
}

/// A file of as many frames as taxels says which are its lines, if the grid shows.
#[test]
fn a_file_with_a_line_for_each_taxel() {
    for design in [pad(10, 10, 3.0), pad(7, 5, 3.0), pad(5, 8, 3.0)] {
        let (taxels, mut found) = (design.sensor.taxels(), 0);
        let swapped = |frames: &[Vec<f64>]| {
            let findings = check(&design, frames, None);
            findings.into_iter().find(|finding| finding.to_string().contains("numpy.transpose"))
        };
        for kind in golden::scene::Kind::all() {
            let contacts = kind.frames(&design.sensor, 0.8, 500..500 + taxels.div_ceil(20) as u64).unwrap();
            // Each is pressed and released within 20 frames, with noise.
            let frame = |at: usize| -> Vec<f64> {
                let (contact, share) =
                    (&contacts[at / 20].stress, (std::f64::consts::PI * (at % 20) as f64 / 20.0).sin());
                let noise = |taxel: usize| f64::from(((at * 7919 + taxel * 104_729) % 1601) as u32) / 8.0;
                contact.iter().enumerate().map(|(taxel, pa)| share * pa + noise(taxel)).collect()
            };
            let frames: Vec<Vec<f64>> = (0..taxels).map(frame).collect();
            let turned: Vec<Vec<f64>> =
                (0..taxels).map(|taxel| frames.iter().map(|frame| frame[taxel]).collect()).collect();
            assert_eq!(swapped(&frames), None, "{}, {}", design.sensor, kind.title());
            found += usize::from(swapped(&turned).is_some());
        }
        println!("{}: found in {found} of 18", design.sensor);
        assert!(found >= 15, "{}: found in {found} of 18 kinds", design.sensor);
    }
}

#[test]
fn a_tare_under_load_is_named() {
    let design = design("sensor1-fast");
    let mut scene = Scene::standing(&design.sensor);
    scene.contacts[0].centre_m[0] *= 0.5;
    let (aside, frames) = (stress(&design, &scene), frames(&design));
    let less = |frames: &[Vec<f64>], print: &[f64]| -> Vec<Vec<f64>> {
        frames.iter().map(|frame| frame.iter().zip(print).map(|(pa, print)| pa - print).collect()).collect()
    };
    // Tared while the contact lay aside: it leaves its print, and presses again.
    let nothing = vec![0.0; design.sensor.taxels()];
    let tared = [less(&[nothing], &aside[0]), less(&frames, &aside[0])].concat();
    let again: Vec<Vec<f64>> = less(&aside, &aside[0]).into_iter().chain(tared).collect();
    let doubled: Vec<f64> = aside[0].iter().map(|pa| 2.0 * pa).collect();
    let pressed = [again, less(&[doubled], &aside[0])].concat();
    found(&design, &pressed, &[Kind::Tare], &["negative print of frame", "tared under a load", "Tare without load"]);
    // Tared at the largest load of one place: the sign is right, and the least loaded frames pull.
    let at = |load: f64| frames[0].iter().map(|pa| load * pa).collect::<Vec<f64>>();
    let touch: Vec<Vec<f64>> = [0.0, 0.0, 0.3, 0.7, 1.0, 0.6, 0.2, 0.0].into_iter().map(at).collect();
    let words = &["more loaded than others: 3 frames, the first and the last,", "frame 5 has the least", "tared under"];
    found(&design, &less(&touch, &at(1.0)), &[Kind::Tare], words);
    // Recorded until it is loaded, and then with more contacts elsewhere.
    let held: Vec<Vec<f64>> = [0.0, 0.0, 0.0, 0.5, 1.0].into_iter().map(at).collect();
    found(&design, &less(&held, &at(1.0)), &[Kind::Tare], &["more loaded than others: 3 frames have"]);
    let elsewhere = [&held[..3], &aside[..3], &held[..1]].concat();
    found(&design, &less(&elsewhere, &at(1.0)), &[Kind::Tare], &["more loaded than others"]);
    // The same touch with the other sign begins and ends at 0.
    found(&design, &changed(&touch, |pa| -pa), &[Kind::Sign], &["compression must be negative"]);
}

/// A zero that creeps toward the load, with a time constant in frames: contacts one after the other, at several places.
#[test]
fn a_baseline_that_follows_is_named() {
    let design = design("sensor1-fast");
    let mut scene = Scene::standing(&design.sensor);
    scene.sensor_errors = SensorErrors { seed: 3, noise: 0.002, ..SensorErrors::default() };
    let right = scene.contacts[0].centre_m[0];
    let places: Vec<Vec<f64>> = [1.0, 0.4, 0.7]
        .map(|share| {
            scene.contacts[0].centre_m[0] = share * right;
            stress(&design, &scene).remove(0)
        })
        .to_vec();
    let rest = vec![0.0; design.sensor.taxels()];
    for (constant, hold, pause) in [(20.0, 40, 40), (30.0, 60, 10), (40.0, 20, 30), (60.0, 60, 40)] {
        let touches = (0..6).flat_map(|touch| [vec![&rest; pause], vec![&places[touch % places.len()]; hold]].concat());
        let true_load: Vec<&Vec<f64>> = touches.chain(vec![&rest; pause]).collect();
        found(&design, &true_load.iter().map(|&frame| frame.clone()).collect::<Vec<_>>(), &[], &[]);
        let mut baseline = rest.clone();
        let follow = |frame: &&Vec<f64>| -> Vec<f64> {
            let read = frame.iter().zip(&baseline).map(|(load, baseline)| load - baseline).collect::<Vec<f64>>();
            baseline.iter_mut().zip(&read).for_each(|(baseline, read)| *baseline += read / constant);
            read
        };
        let frames: Vec<Vec<f64>> = true_load.iter().map(follow).collect();
        let words = ["the baseline follows the load", "auto-zero", "without load"];
        found(&design, &frames, &[Kind::Tare], &words);
    }
}
