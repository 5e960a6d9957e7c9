//! Sensors that are not linear: from counts to pascals along a curve.

#![allow(clippy::float_cmp)] // the same bits are meant

use golden::design::{Curve, Design, Input};
use golden::solver::{Solver, Status};

const PAD: &str = "format = 3\nname = \"pad\"\n[algorithm]\nestimator = \"line\"\n[sensor]\ncolumns = 3\nrows = 2\npitch_mm = [4.0, 2.0]\ndepth_mm = 2.0\n";
const POINTS: &str = "count,pascals\n0,0\n100,-2000\n\n1000,-30000\n4000,-60000\n";

fn pad(keys: &str, points: &str) -> Result<Design, String> {
    let files = [("points.csv", points.to_owned()), ("gains.csv", "1,0\n2,-500\n1,0\n1,0\n1,0\n0,0\n".to_owned())];
    Design::from_parts(&format!("{PAD}{keys}\n"), "pad.toml", &files).map_err(|error| error.to_string())
}

#[test]
fn counts_follow_the_points() {
    let design = pad("curve = \"points.csv\"", POINTS).unwrap();
    let pa = |count| design.input.to_pa(0, count);
    assert_eq!([0.0, 50.0, 100.0, 550.0, 4000.0].map(pa), [0.0, -1000.0, -2000.0, -16000.0, -60000.0]);
    // Beyond the ends it stays.
    assert_eq!([-10.0, 5000.0].map(pa), [0.0, -60000.0]);
    for count in [1.0, 99.0, 100.0, 700.0, 3999.0] {
        assert!((design.input.from_pa(0, pa(count)) - count).abs() < 1e-9, "{count}");
    }
    assert_eq!(design.input.from_pa(0, -1e6), 4000.0);
    // Each taxel's own gain and offset come after the curve, the offset in pascals.
    let design = pad("curve = \"points.csv\"\ncalibration = \"gains.csv\"", POINTS).unwrap();
    assert_eq!((design.input.to_pa(1, 100.0), design.input.from_pa(1, -4500.0)), (-4500.0, 100.0));
    assert_eq!(design.input.dead, [5]);
    let again = Design::from_parts(&design.to_toml(), "again", &design.files()).unwrap();
    assert_eq!((again.to_toml(), again), (design.to_toml(), design));
}

#[test]
fn a_power_law_is_followed_in_short_pieces() {
    for power in [0.8, 1.25, 2.0] {
        let design = pad(&format!("curve = {{ power = {power:?}, scale = -0.0066 }}"), "").unwrap();
        let Input { curve: Some(Curve { points, law }), .. } = &design.input else { panic!("a curve") };
        assert_eq!((points.len(), *law), (65, Some([power, -0.0066])));
        let top = points[64][0];
        assert!((-0.0066 * top.powf(power) / -4e5 - 1.0).abs() < 1e-12, "four times the full scale");
        for step in 0..400 {
            let count = top * (-f64::from(step) / 40.0).exp2();
            let [found, law] = [design.input.to_pa(0, count), -0.0066 * count.powf(power)];
            let allowed = 1.05 * (power * (power - 1.0)).abs() / 600.0;
            assert!((found / law - 1.0).abs() < allowed, "power {power}: {found} for {law}");
        }
        assert_eq!(design.input.to_pa(0, -5.0), 0.0);
        assert_eq!(Design::from_toml(&design.to_toml(), "again").unwrap(), design);
    }
}

#[test]
fn a_power_law_ends_where_samples_do() {
    // Four times the full scale is far beyond them; a full scale within them stays.
    let law = "curve = { power = 1.25, scale = -0.0066 }\n[hardware]\nstream_bits = 64\n";
    for (samples, end) in [("int16", 32768.0), ("uint16", 65536.0), ("float32", 1_682_723.8)] {
        let curve = pad(&format!("{law}samples = \"{samples}\""), "").unwrap().input.curve.unwrap();
        assert!((curve.largest_count() / end - 1.0).abs() < 1e-6, "{samples}: {}", curve.largest_count());
        let first = curve.exact_from().unwrap();
        assert!((first * 10.5_f64.exp2() / end - 1.0).abs() < 1e-6, "{samples}: {first}");
        let low = -0.0066 * (1.01 * first).powf(1.25);
        assert!((curve.at(1.01 * first) / low - 1.0).abs() < 6e-4, "{samples}");
    }
    let curve = pad(&format!("{law}samples = \"int16\"\nfull_scale_pa = 50.0"), "").unwrap().input.curve.unwrap();
    assert!((curve.at(curve.largest_count()) / -200.0 - 1.0).abs() < 1e-12);
}

#[test]
fn the_solver_takes_counts_along_a_curve() {
    let design = pad("curve = \"points.csv\"", POINTS).unwrap();
    let counts = [800.0, 2000.0, 400.0, 0.0, 10.0, 3000.0];
    let stress: Vec<f64> = (0..6).map(|taxel| design.input.to_pa(taxel, counts[taxel])).collect();
    let mut linear = design.clone();
    linear.input = Input::default();
    let solver = Solver::new(&design).unwrap();
    assert_eq!(solver.solve(&counts).unwrap(), Solver::new(&linear).unwrap().solve(&stress).unwrap());
    // At the curve's end nobody knows what more would have read.
    let status = |count: f64| solver.solve(&[count; 6]).unwrap().status;
    assert!(!status(3999.0).contains(Status::SATURATED) && status(4000.0).contains(Status::SATURATED));
}

/// Points are read as frames are.
#[test]
fn points_come_with_any_usual_separator() {
    let plain = pad("curve = \"points.csv\"", POINTS).unwrap();
    for points in [
        POINTS.replace(',', ";"),
        POINTS.replace("0\n", "0,0;\r\n").replace(',', ";").replace(";0;", ",0;"),
        POINTS.replace(',', "\t"),
        POINTS.replace(',', "   "),
        format!("# measured\n{}", POINTS.replace("count,pascals", "\"raw\" , \"Pa\"")),
        POINTS.replace("count,pascals\n", ""),
    ] {
        let design = pad("curve = \"points.csv\"", &points).unwrap_or_else(|error| panic!("{error}: {points:?}"));
        assert_eq!(design.input, plain.input, "{points:?}");
    }
}

#[test]
fn what_is_no_curve_is_refused() {
    for (keys, points, parts) in [
        ("curve = \"points.csv\"\npa_per_count = 2.0", POINTS, ["sensor.curve", "so is pa_per_count", "remove"]),
        ("curve = \"none.csv\"", POINTS, ["none.csv", "cannot read", "path"]),
        ("curve = \"points.csv\"", "0,0\n", ["points.csv, line 1", "1 points", "2 to 65"]),
        ("curve = \"points.csv\"", "0,0\n5,3\n4,9\n", ["line 3", "4,9 after 5,3", "sort"]),
        ("curve = \"points.csv\"", "0,0\n5,3\n6,2\n", ["line 3", "6,2 after 5,3", "only rise, or only fall"]),
        ("curve = \"points.csv\"", "0,0\n5,0\n", ["line 2", "5,0 after 0,0", "only rise"]),
        ("curve = \"points.csv\"", "0,0\n5,x\n", ["line 2", "5,x", "count,pascals"]),
        ("curve = \"points.csv\"", "0,0\n5,nan\n", ["line 2", "NaN", "beyond any sensor"]),
        ("curve = \"points.csv\"", "0,0\n1,1\n1.0000000001,2\n1e6,9\n", ["line 4", "all but equal", "leave one out"]),
        ("curve = \"points.csv\"", "0;0\n5,3\n", ["line 2", "5,3", "count,pascals"]),
        ("curve = \"points.csv\"", "pascals,count\n0,0\n-5,3\n", ["line 1", "before counts", "count,pascals"]),
        ("curve = \"points.csv\"", "gain,offset\n1,0\n", ["line 2", "no curve", "sensor.calibration"]),
        ("curve = { power = 9.0, scale = 1.0 }", "", ["sensor.curve.power", "is 9", "0.25 to 4"]),
        ("curve = { power = 1.25 }", "", ["pad.toml", "name of a file", "power = 1.25, scale = -0.0066"]),
        ("curve = 3", "", ["line 10", "name of a file", "power = 1.25, scale = -0.0066"]),
        ("curve = { power = 1.0, scale = 0.0 }", "", ["sensor.curve.scale", "is 0", "larger counts press"]),
    ] {
        let message = pad(keys, points).unwrap_err();
        assert!(parts.iter().all(|part| message.contains(part)), "{message}");
    }
}
