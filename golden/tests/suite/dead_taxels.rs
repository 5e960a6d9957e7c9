//! Dead taxels whose place is known, and what replaces them.

use golden::dead_taxels::DeadTaxels;
use golden::design::Design;
use golden::kernel::Kernel;
use golden::sensor::Sensor;
use golden::solver::{Solver, Status};

#[test]
fn a_smooth_stress_is_continued() {
    let sensor = Sensor { columns: 9, rows: 8, pitch_mm: [4.0, 3.0], depth_mm: 3.0 };
    // A corner, two side by side in the middle, one at an edge.
    let dead = [0, 30, 31, 53];
    let taxels = DeadTaxels::new(&sensor, Kernel::Point, &dead);
    assert_eq!(taxels.taxels(), dead);
    let smooth = |taxel: usize| {
        let [x, y] = sensor.position_m(taxel).map(|metres| metres * 1e3);
        -1000.0 * (-((x - 15.0).powi(2) + (y - 9.0).powi(2)) / 150.0).exp()
    };
    for (&taxel, weights) in dead.iter().zip(taxels.weights()) {
        let found: f64 = weights.iter().enumerate().map(|(other, weight)| weight * smooth(other)).sum();
        assert!((found - smooth(taxel)).abs() < 100.0, "{taxel}: {found} for {}", smooth(taxel));
        assert!(dead.iter().all(|&other| weights[other].abs() < 1e-300), "no dead taxel says anything");
        // The nearest say most.
        let far = |other: usize| {
            let [a, b] = [taxel, other].map(|taxel| sensor.position_m(taxel));
            (a[0] - b[0]).hypot(a[1] - b[1]) > 16e-3
        };
        let total: f64 = weights.iter().map(|weight| weight.abs()).sum();
        let distant: f64 = (0..72).filter(|&other| far(other)).map(|other| weights[other].abs()).sum();
        assert!(distant < 0.1 * total, "{taxel}: {distant} of {total} from afar");
    }
}

/// The small pad with `keys` in its `[sensor]`, and its calibration's lines.
fn pad(keys: &str, lines: &str) -> Result<Design, String> {
    let text = format!(
        "format = 3\nname = \"pad\"\n[algorithm]\nestimator = \"line\"\n[sensor]\ncolumns = 4\nrows = 3\npitch_mm = [4.0, 2.0]\ndepth_mm = 2.0\n{keys}\n"
    );
    Design::from_parts(&text, "pad.toml", &[("gains.csv", lines.to_owned())]).map_err(|error| error.to_string())
}

#[test]
fn the_map_is_read_and_printed() {
    let design = pad("dead = [7, 2]", "").unwrap();
    assert_eq!(design.input.dead, [2, 7]);
    assert!(design.to_toml().contains("\ndead = [2, 7]\n"));
    assert_eq!(Design::from_toml(&design.to_toml(), "again").unwrap(), design);
    // A gain of 0 is a dead taxel, too.
    let gains = "1,0\n0,5\n".to_owned() + &"1,0\n".repeat(10);
    let keys = "pa_per_count = -2\ncalibration = \"gains.csv\"\ndead = [4, 1]";
    let design = pad(keys, &gains).unwrap();
    assert_eq!(design.input.dead, [1, 4]);
    assert!(design.input.from_pa(1, -500.0).abs() < 1e-300, "it reads nothing");
    assert_eq!(Design::from_parts(&design.to_toml(), "again", &design.files()).unwrap(), design);
    for (keys, parts) in [
        ("dead = [3, 12]", ["sensor.dead[1]", "is 12", "from 0 to 11"]),
        ("dead = [-1]", ["sensor.dead[0]", "is -1", "from 0 to 11"]),
        ("dead = [0, 1, 2, 3, 4, 5, 6]", ["sensor.dead", "has 7 taxels", "at most 6"]),
    ] {
        let message = pad(keys, "").unwrap_err();
        assert!(parts.iter().all(|part| message.contains(part)), "{message}");
    }
}

#[test]
fn what_a_dead_taxel_reads_is_nothing() {
    let solver = |keys: &str| Solver::new(&pad(keys, "").unwrap()).unwrap();
    let dead = solver("dead = [5]");
    let frame = |reading: f64| -> Vec<f64> {
        (0..12).map(|taxel| if taxel == 5 { reading } else { [-4e3, -9e3, 2e3][taxel % 3] }).collect()
    };
    let solved = dead.solve(&frame(0.0)).unwrap();
    assert!(solved.status.contains(Status::REPLACED));
    for reading in [f64::NAN, f64::INFINITY, -1e5, 1e9] {
        assert_eq!(dead.solve(&frame(reading)).unwrap(), solved);
    }
    assert_eq!(dead.solve(&[0.0; 12]).unwrap().status, Status::NO_CONTACT);
    assert!(solver("").solve(&frame(-1e5)).unwrap().status.contains(Status::SATURATED));
    // All that presses stands beside the dead taxel.
    let beside: Vec<f64> = (0..12).map(|taxel| if [1, 4, 6, 9].contains(&taxel) { -1e4 } else { 0.0 }).collect();
    assert!(dead.solve(&beside).unwrap().status.contains(Status::TOO_MANY_REPLACED));
    let away: Vec<f64> = (0..12).map(|taxel| if taxel == 3 { -1e4 } else { 0.0 }).collect();
    assert!(!dead.solve(&away).unwrap().status.contains(Status::TOO_MANY_REPLACED));
}
