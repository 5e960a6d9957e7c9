//! The library from a C program: every figure is that of `golden`, to the last bit.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use golden::design::{Calibration, Design, Samples};
use golden::scene::{Scene, Shape};
use golden::solver::{Solution, Solver};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// The static library of this build: it lies beside the test's own program, or a folder above.
fn library() -> PathBuf {
    let own = std::env::current_exe().expect("a path");
    let deps = own.parent().expect("a folder");
    let places = [deps, deps.parent().expect("a folder")];
    let found = places.iter().map(|place| place.join("libsptfra_solver.a")).find(|path| path.exists());
    found.unwrap_or_else(|| panic!("no libsptfra_solver.a in {}", deps.display()))
}

/// The C program, compiled with all warnings.
fn host(folder: &Path) -> PathBuf {
    let program = folder.join("host");
    let compiler = std::env::var_os("CC").filter(|name| !name.is_empty()).unwrap_or_else(|| "cc".into());
    let own = Path::new(env!("CARGO_MANIFEST_DIR"));
    let output = Command::new(compiler)
        .args(["-std=c11", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Werror", "-I"])
        .arg(own)
        .arg(own.join("tests/host.c"))
        .arg(library())
        .args(["-lpthread", "-ldl", "-lm", "-o"])
        .arg(&program)
        .output()
        .expect("a C compiler");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    program
}

/// Frames of one contact and of two, as the design's sensor delivers them.
fn frames(design: &Design) -> Vec<Vec<f64>> {
    let standing = Scene::standing(&design.sensor);
    let of = |places: &[(f64, f64, f64)]| {
        let mut scene = Scene { sweep_deg: Vec::new(), ..standing.clone() };
        let first = scene.contacts[0].clone();
        scene.contacts = places
            .iter()
            .map(|&(place, share, direction_deg)| {
                let mut contact = first.clone();
                contact.centre_m = contact.centre_m.map(|middle| place * middle);
                contact.normal_force_n *= share;
                contact.direction_deg = direction_deg;
                contact.shape = Shape::Hertz { semi_axes_m: first.shape.half_extent_m().map(|extent| 0.5 * extent) };
                contact
            })
            .collect();
        let mut stress = scene.frames().expect("a scene").remove(0).stress;
        design.deliver(&mut stress);
        stress
    };
    vec![
        of(&[(1.0, 1.0, 30.0)]),
        of(&[(0.4, 0.25, 180.0), (1.6, 0.2, 30.0)]),
        of(&[(0.35, 0.2, 90.0), (1.6, 0.3, 200.0)]),
        vec![0.0; design.sensor.taxels()],
    ]
}

fn bytes(samples: Samples, frame: &[f64]) -> Vec<u8> {
    let of = |&value: &f64| match samples {
        Samples::Float32 => (value as f32).to_ne_bytes().to_vec(),
        Samples::Int16 => (value as i16).to_ne_bytes().to_vec(),
        Samples::Uint16 => (value as u16).to_ne_bytes().to_vec(),
    };
    frame.iter().flat_map(of).collect()
}

/// All figures of a solution, in the order in which the C program prints them.
fn figures(solution: &Solution) -> Vec<f64> {
    let Solution { status, resultant, torque, mu, phi, mu_x, mu_y, standard_error, contacts, records, .. } = solution;
    let mut all = vec![f64::from(status.0), *contacts as f64, (*contacts).min(records.len()) as f64];
    all.extend(resultant.iter().chain(torque).chain([mu, phi, mu_x, mu_y, standard_error]));
    for contact in records {
        all.extend([contact.taxels as f64, f64::from(contact.status.0)]);
        all.extend(contact.centre_m.iter().chain(&contact.force).chain(&contact.torque));
        all.extend([contact.mu, contact.standard_error]);
    }
    // Of eight contacts, twelve figures each.
    all.resize(14 + 8 * 12, 0.0);
    all
}

fn run(program: &Path, design: &Path, frames: &Path, bytes: usize, version: u8) -> Output {
    let numbers = [bytes.to_string(), version.to_string()];
    Command::new(program).arg(design).arg(frames).args(numbers).output().expect("starts")
}

/// Float32 in pascals with a network; and counts of 16 bits of a sensor with a dead taxel that reads no tension, also by
/// a later version of its calibration.
#[test]
fn c_gets_every_figure_of_golden() {
    let folder = tempfile::tempdir().expect("a folder");
    let program = host(folder.path());
    let text = |name: &str| fs::read_to_string(root().join("designs").join(name)).expect("a design");
    let weights = "sensor1-wide.weights.csv";
    fs::copy(root().join("designs").join(weights), folder.path().join(weights)).expect("copied");
    let network = text("sensor1-wide.toml").replace("outputs =", "contacts = 4\noutputs =");
    let counts = text("sensor1-reduced.toml")
        .replace("outputs =", "contacts = 2\noutputs =")
        .replace("depth_mm =", "pa_per_count = -12.5\ndead = [12]\ntension = \"clipped\"\ndepth_mm =")
        .replace("[hardware]\n", "[hardware]\nsamples = \"int16\"\n");
    for (text, version) in [(network, 0), (counts.clone(), 0), (counts, 3)] {
        let path = folder.path().join("design.toml");
        fs::write(&path, text).expect("written");
        let design = Design::load(&path).expect("a design");
        let frames = frames(&design);
        let samples = design.hardware.samples;
        let packed: Vec<u8> = frames.iter().flat_map(|frame| bytes(samples, frame)).collect();
        fs::write(folder.path().join("frames"), &packed).expect("written");
        let each = packed.len() / frames.len();
        let ran = run(&program, &path, &folder.path().join("frames"), each, version);
        let printed = String::from_utf8(ran.stdout).expect("text");
        assert!(ran.status.success(), "{:?}: {printed}", ran.status);
        let mut expected = design.clone();
        if version > 0 {
            let taxels = design.sensor.taxels();
            expected.input.calibration = Some(Calibration { gain: vec![2.0; taxels], offset: vec![3.0; taxels] });
            expected.input.dead = vec![7];
        }
        let solver = Solver::new(&expected).expect("a solver");
        let mut separated = Vec::new();
        assert_eq!(printed.lines().count(), frames.len(), "{printed}");
        for (line, frame) in printed.lines().zip(&frames) {
            let sent: Vec<f64> = match samples {
                Samples::Float32 => frame.iter().map(|&value| f64::from(value as f32)).collect(),
                _ => frame.clone(),
            };
            let found: Vec<f64> = line.split(' ').map(|value| value.parse().expect("a number")).collect();
            assert_eq!(found, figures(&solver.solve(&sent).expect("a frame")), "{}", design.name);
            separated.push(found[2] as u32);
        }
        assert!(version > 0 || separated == [1, 2, 2, 0], "{}: {separated:?}", design.name);
    }
}

#[test]
fn a_wrong_design_is_refused_with_its_reason() {
    let folder = tempfile::tempdir().expect("a folder");
    let program = host(folder.path());
    let ran = run(&program, Path::new("none.toml"), Path::new("none"), 4, 0);
    let said = String::from_utf8_lossy(&ran.stdout).into_owned();
    assert!(ran.status.code() == Some(1) && said.contains("none.toml"), "{said}");
}
