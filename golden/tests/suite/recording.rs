//! Frames of a real mat: counts, calibration, labels.

#![allow(clippy::float_cmp)] // the same bits are meant

use std::fs;
use std::path::{Path, PathBuf};

use golden::design::{CALIBRATION_FILE, Design, Filter, Kernel};
use golden::frames::{FrameLines, read_recording};
use golden::metrics::field_error;
use golden::solver::{Solver, Status};

const PAD: &str = "format = 3\nname = \"pad\"\n[algorithm]\nestimator = \"line\"\n[sensor]\ncolumns = 3\nrows = 2\npitch_mm = [4.0, 2.0]\ndepth_mm = 2.0\n";
const LINES: &str = "1.5,0\n0.5,-2\n1,0.25\n\n1,1\n 2 , 3\n16,-1e6\n";

fn file(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path)
}

/// A folder with `pad.toml`, the small design with `keys` more of its sensor, and a calibration file.
fn folder(keys: &str, calibration: &str) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("pad.toml");
    fs::write(&path, format!("{PAD}{keys}\n")).unwrap();
    fs::write(folder.path().join("gains.csv"), calibration).unwrap();
    (folder, path)
}

const COUNTS: &str = "pa_per_count = -12.5\ncalibration = \"gains.csv\"";

#[test]
fn counts_become_pascals() {
    let (_folder, path) = folder(COUNTS, LINES);
    let design = Design::load(&path).unwrap();
    let pa = |taxel| design.input.to_pa(taxel, 8.0);
    assert_eq!([0, 1, 2, 3, 4].map(pa), [-150.0, -25.0, -103.125, -112.5, -237.5]);
    for taxel in 0..6 {
        assert!((design.input.from_pa(taxel, pa(taxel)) - 8.0).abs() < 1e-9);
    }
    let plain = Design::from_toml(&format!("{PAD}pa_per_count = 2\n"), "pad.toml").unwrap();
    assert_eq!((plain.input.to_pa(0, 3.0), plain.input.from_pa(0, 3.0)), (6.0, 1.5));
    let none = Design::from_toml(PAD, "pad.toml").unwrap();
    assert_eq!((none.input.to_pa(0, 3.0), none.input.from_pa(0, 3.0)), (3.0, 3.0));
    assert!(!none.to_toml().contains("pa_per_count") && none.files().is_empty());
}

#[test]
fn the_solver_takes_counts() {
    let (_folder, path) = folder(COUNTS, LINES);
    let mut design = Design::load(&path).unwrap();
    let counts = [800.0, 2000.0, 400.0, -3.0, 10.0, 62600.0];
    let stress: Vec<f64> = (0..6).map(|taxel| design.input.to_pa(taxel, counts[taxel])).collect();
    let found = Solver::new(&design).unwrap().solve(&counts).unwrap();
    design.input = golden::design::Input::default();
    let solver = Solver::new(&design).unwrap();
    assert_eq!(found, solver.solve(&stress).unwrap());
    assert_ne!(found.resultant, solver.solve(&counts).unwrap().resultant);
    // Full scale is that of the stress: 8000 counts are 100 kPa, which may be a clipped reading.
    design.input.pa_per_count = Some(-12.5);
    let solver = Solver::new(&design).unwrap();
    let status = |count: f64| solver.solve(&[count; 6]).unwrap().status;
    assert!(!status(7999.0).contains(Status::SATURATED) && status(8000.0).contains(Status::SATURATED));
    // A product that f64 rounds below the full scale is that full scale all the same.
    (design.input.pa_per_count, design.hardware.full_scale_pa) = (Some(0.1), 0.3);
    design.algorithm.noise_floor_pa = 1e-6;
    let solver = Solver::new(&design).unwrap();
    let status = |count: f64| solver.solve(&[count; 6]).unwrap().status;
    assert!(status(3.0).contains(Status::SATURATED) && status(-3.0).contains(Status::SATURATED));
    assert!(!status(2.999).contains(Status::SATURATED));
}

#[test]
fn the_resolved_design_has_its_calibration_beside_it() {
    let (folder, path) = folder(COUNTS, LINES);
    let design = Design::load(&path).unwrap();
    let resolved = folder.path().join("resolved.toml");
    fs::write(&resolved, design.to_toml()).unwrap();
    for (name, content) in design.files() {
        assert_eq!(name, CALIBRATION_FILE);
        fs::write(folder.path().join(name), content).unwrap();
    }
    let again = Design::load(&resolved).unwrap();
    assert_eq!(again, design);
    assert_eq!(again.to_toml(), design.to_toml());
    let origin = resolved.display().to_string();
    assert_eq!(Design::from_toml(&design.to_toml(), &origin).unwrap(), design);
}

#[test]
fn wrong_inputs_are_refused() {
    for (keys, parts) in [
        ("calibration = \"gains.csv\"", ["sensor.calibration", "pa_per_count is not", "add pa_per_count"]),
        ("pa_per_count = 0", ["sensor.pa_per_count", "is 0", "1e-9"]),
        ("pa_per_count = nan", ["sensor.pa_per_count", "NaN", "1e9"]),
        ("pa_per_count = 1\ncalibration = \"none.csv\"", ["none.csv", "cannot read", "path"]),
        ("pa_per_counts = 1", ["pa_per_counts", "line 10", "pa_per_count"]),
    ] {
        let (_folder, path) = folder(keys, LINES);
        let message = Design::load(&path).unwrap_err().to_string();
        assert!(parts.iter().all(|part| message.contains(part)), "{message}");
    }
    for (lines, parts) in [
        (LINES.replace("16,", "16.5,"), ["gains.csv, line 7", "gain is 16.5", "1e-9 to 16"]),
        (LINES.replace("0.5,", "1e-10,"), ["gains.csv, line 2", "gain is 0.0000000001", "1e-9 to 16"]),
        (LINES.replace("0.5,", "-1,"), ["gains.csv, line 2", "gain is -1", "0 for a dead taxel"]),
        (LINES.replace("0.5,", "nan,"), ["gains.csv, line 2", "gain is NaN", "1e-9 to 16"]),
        (format!("offset,gain\n{LINES}"), ["gains.csv, line 1", "\"offset,gain\" is no header", "write gain,offset"]),
        (format!("gain,offset,taxel 6\n{LINES}"), ["gains.csv, line 1", "no header", "dead taxels of this sensor"]),
        (format!("{LINES}gain,offset\n"), ["gains.csv, line 8", "\"gain,offset\" is no pair", "gain,offset"]),
        (LINES.replace("1,1", "1,1\n0;5"), ["gains.csv, line 6", "0;5", "gain,offset"]),
        (LINES.replace("1e6", "1e7"), ["gains.csv, line 7", "offset is -10000000", "1000000"]),
        (LINES.replace("1,1", "1;1"), ["gains.csv, line 5", "1;1", "gain,offset"]),
        (LINES.replace("1,1", "1,1,1"), ["gains.csv, line 5", "1,1,1", "gain,offset"]),
        (LINES.replace("1,1\n", ""), ["gains.csv, line 6", "after 5 taxels", "sensor has 6"]),
        (format!("{LINES}1,0"), ["gains.csv, line 8", "after 7 taxels", "sensor has 6"]),
    ] {
        let (_folder, path) = folder(COUNTS, &lines);
        let message = Design::load(&path).unwrap_err().to_string();
        assert!(parts.iter().all(|part| message.contains(part)), "{message}");
    }
}

/// Gains and offsets are read as frames are: any usual separator, a header or none, remarks, quotes.
#[test]
fn gains_and_offsets_come_with_any_usual_separator() {
    let (_folder, path) = folder(COUNTS, LINES);
    let plain = Design::load(&path).unwrap();
    for lines in [
        LINES.replace(',', ";"),
        LINES.replace('.', "d").replace(',', ";").replace('d', ","),
        LINES.replace(" 2 , 3", "2,3").replace(',', "\t"),
        LINES.replace(" 2 , 3", "2,3").replace(',', "  "),
        format!("\u{feff}gain,offset\n{LINES}"),
        format!("# of June\r\n\"gain\";\"offset (counts)\";\r\n{}", LINES.replace(',', ";").replace('\n', ";\r\n"))
            .replace("\n;", "\n"),
    ] {
        let (_folder, path) = folder(COUNTS, &lines);
        let design = Design::load(&path).unwrap_or_else(|error| panic!("{error}: {lines:?}"));
        assert_eq!(design.input, plain.input, "{lines:?}");
    }
}

fn grid(columns: usize, rows: usize) -> Design {
    let mut design = Design::from_toml(PAD, "pad.toml").unwrap();
    (design.sensor.columns, design.sensor.rows) = (columns, rows);
    design
}

#[test]
fn any_usual_separator_with_a_header_or_without() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("frames.csv");
    let read = |text: &str| {
        fs::write(&path, text).unwrap();
        read_recording(&path, &grid(2, 1), 0).map(|read| read.frames).map_err(|error| error.to_string())
    };
    let two = Ok(vec![vec![-1.5, 2.0], vec![3e3, 4.0]]);
    for text in [
        "-1.5,2\n3e3,4\n",
        "-1.5;2\r\n3e3;4\r\n",
        "-1,5;2\n3e3;4,0",
        "-1.5\t2\n3e3\t4\n",
        "  -1.5   2\n3e3 4\n",
        "\u{feff}r0,r1\n-1.5,2\n3e3,4\n",
        "left side;right\n-1.5;2\n3e3;4\n",
        "# of a pad, 2 x 1\n-1.5 2.0\n# a remark\n3e3 4\n",
        "-1.5,2,\n3e3,4,\n",
        "-1.5;2;\n3e3;4\n",
    ] {
        assert_eq!(read(text), two, "{text:?}");
    }
    for (text, parts) in [
        ("1|2\n3|4\n5|6\n", ["line 1: \"|\" separates the values", "commas, semicolons, tabs or spaces"]),
        ("r0|r1\n1 | 2\n", ["line 2: \"|\" separates the values", "commas"]),
        ("1,2\n3:4\n", ["line 2: \":\" separates", "commas"]),
        ("-1\u{a0}2\n", ["line 1: a no-break space separates", "commas"]),
        ("1,2\n3;4\n", ["line 2, column 1: \"3;4\"", "commas, semicolons"]),
        ("1;2\n3;4;5\n", ["line 2", "column 3 where 2"]),
    ] {
        let message = read(text).unwrap_err();
        assert!(parts.iter().all(|part| message.contains(part)), "{message}");
    }
}

/// pandas writes the numbers of columns above them: that is no frame, and is said.
#[test]
fn numbers_of_columns_are_a_header() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("frames.csv");
    let design = Design::from_toml(PAD, "pad.toml").unwrap();
    let read = |text: &str, labels| {
        fs::write(&path, text).unwrap();
        read_recording(&path, &design, labels).map(|read| (read.frames, read.remark)).map_err(|error| error.to_string())
    };
    let frame = vec![-7.0, -1.0, 0.0, 2.0, -3.0, 5.0];
    let line = "-7,-1,0,2,-3,5\n";
    for (text, labels, place, last) in [
        (format!("0,1,2,3,4,5\n{line}"), 0, 1, 5),
        (format!("# a remark\n\n1;2;3;4;5;6\n{}", line.replace(',', ";")), 0, 3, 6),
        (format!("\u{feff}\"0\",\"1\",\"2\",\"3\",\"4\",\"5\"\r\n{line}"), 0, 1, 5),
        // With the index, and with a time beside it.
        (format!(",0,1,2,3,4,5\n0,{line}"), 1, 1, 5),
        (format!("0,1,2,3,4,5,6,7\n0,0.5,{line}"), 2, 1, 7),
        // In another order, behind a word.
        (format!("taxel,8,12,3,4,5,9\n0,{line}"), 1, 1, 12),
    ] {
        let (frames, remark) = read(&text, labels).unwrap_or_else(|error| panic!("{error}: {text:?}"));
        assert_eq!(frames, std::slice::from_ref(&frame), "{text:?}");
        let remark = remark.expect("a remark");
        let said = format!("frames.csv, line {place}: numbers up to {last} are those of the columns");
        assert!(remark.contains(&said) && remark.contains("read as a header"), "{remark}");
    }
    // Any other frame is one, and so is a later one.
    for text in [
        "0,1,2,3,4,6\n",
        "2,3,4,5,6,7\n",
        "0,-1,-2,-3,-4,-5\n",
        "a,b,c,d,e,f\n0,1,2,3,4,5\n",
        "1,0,2,3,4,6\n0,1,2,3,4,5\n",
        // Counts that are alike, behind a word.
        "start,0,0,1,7,2026,3\n1,0,0,1,7,2026,3\n2,4,4,4,4,4,4\n",
    ] {
        let (frames, remark) = read(text, usize::from(text.starts_with("start"))).unwrap();
        assert_eq!(
            (frames.len(), remark),
            (text.lines().filter(|line| !line.starts_with('a')).count(), None),
            "{text:?}"
        );
    }
    let message = read("0,1,2,3,4,5\n", 0).unwrap_err();
    assert!(
        message.contains("line 1: numbers up to 5") && message.contains("write a line of names above it"),
        "{message}"
    );
    // As the lines come, too.
    let mut lines = FrameLines::new(Path::new("port"), &design, 0);
    assert_eq!((lines.frame(b"0,1,2,3,4,5\n").unwrap(), lines.frame(line.as_bytes()).unwrap()), (None, Some(frame)));
    assert!(lines.remark().is_some_and(|remark| remark.starts_with("port, line 1: ")));
}

/// A `.npy` file of whole numbers, counted from 0.
fn array(shape: &[usize]) -> Vec<u8> {
    let count: usize = shape.iter().product();
    let sides: String = shape.iter().map(|side| format!("{side}, ")).collect();
    let header = format!("{{'descr': '<i2', 'fortran_order': False, 'shape': ({sides}), }}\n");
    let values: Vec<u8> = (0..count as i16).flat_map(i16::to_le_bytes).collect();
    [b"\x93NUMPY\x01\x00".as_slice(), &(header.len() as u16).to_le_bytes(), header.as_bytes(), &values].concat()
}

#[test]
fn arrays_of_frames() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("frames.npy");
    let read = |bytes: &[u8], labels| {
        fs::write(&path, bytes).unwrap();
        read_recording(&path, &grid(3, 2), labels).map(|read| read.frames).map_err(|error| error.to_string())
    };
    let counted = |from: usize| (from..from + 6).map(|value| value as f64).collect::<Vec<_>>();
    let two = Ok(vec![counted(0), counted(6)]);
    assert_eq!(read(&array(&[2, 6]), 0), two);
    assert_eq!(read(&array(&[2, 2, 3]), 0), two);
    assert_eq!(read(&array(&[2, 7]), 1), Ok(vec![counted(1), counted(8)]));
    for (bytes, part) in [
        (array(&[2, 3, 2]), "the transposed grid: the sensor has 2 rows of 3 columns; transpose them"),
        (array(&[2, 4, 2]), "frames are [4, 2] where"),
        (array(&[2, 5]), "5 values a row where 6"),
        (array(&[6]), "numpy.atleast_2d"),
        (array(&[]), "a single number"),
        (array(&[0, 6]), "the array is empty"),
        (array(&[2, 6])[..70].to_vec(), "damaged"),
    ] {
        let message = read(&bytes, 0).unwrap_err();
        assert!(message.contains("frames.npy") && message.contains(part), "{message}");
    }
}

#[test]
fn label_columns_are_skipped() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("frames.csv");
    let read = |text: &str, labels| {
        fs::write(&path, text).unwrap();
        read_recording(&path, &grid(2, 1), labels).map(|read| read.frames).map_err(|error| error.to_string())
    };
    let two = Ok(vec![vec![1.0, 2.0], vec![3.0, 4.0]]);
    assert_eq!(read("a,0,1,2\nb,é 1,3,4\n", 2), two);
    assert_eq!(read("\nname,n,r0,r1\na,0,1,2\n\nb,1,3,4\n", 2), two);
    assert_eq!(read("1,2\n3,4\n", 0), two);
    // A title separates nothing.
    assert_eq!(read("Pressure map\n1,2\n3,4\n", 0), two);
    // A header is the first line only, and has no number in it; what looks like one later is a mistake.
    for (text, labels, part) in [
        ("n,r0,r1\nm,r0,r1\n", 1, "line 2, column 2"),
        ("n,1,r1\na,1,2\n", 1, "line 1, column 3"),
        ("n,nan,inf\na,1,2\n", 1, "line 1, column 2"),
        ("r0,r1\nr0,r2\n", 0, "line 2, column 1"),
        ("r0,r1\nr0,r1\n", 0, "the header again"),
        ("r0,1\n1,2\n", 0, "line 1, column 1"),
        ("a,1\n", 1, "ends at column 2 where 3"),
        ("a,1,2,3\n", 1, "ends at column 4 where 3"),
        ("name,r0,r1\n", 1, "no frame"),
        // A header of fewer fields than there are labels.
        ("name\nm,r0,r1\n", 2, "line 2, column 3"),
    ] {
        let message = read(text, labels).unwrap_err();
        assert!(message.contains(part), "{message}");
    }
    // Names that differ by their numbers alone are those of the taxels.
    let mat = file("data/bed_mat_64x27.csv");
    let [found, labelled] = [0, 2].map(|labels| read_recording(&mat, &grid(27, 64), labels).unwrap().frames);
    assert_eq!(found, labelled);
}

#[test]
fn the_mat_carries_the_person() {
    let mut design = Design::load(&file("designs/bed-mat.toml")).unwrap();
    let frames = read_recording(&file("data/bed_mat_64x27.csv"), &design, 2).unwrap().frames;
    assert_eq!(frames.len(), 24);
    let filtered = Solver::new(&design).unwrap();
    design.algorithm.filter = Filter::None;
    let cell = Solver::new(&design).unwrap();
    let [condition_c33, condition_aat] = [cell.matrices().condition_c33(), cell.matrices().condition_aat()];
    assert!((condition_c33 - 1.194).abs() < 1e-3 && (condition_aat - 1.426).abs() < 1e-3);
    design.algorithm.kernel = Kernel::Point;
    let point = Solver::new(&design).unwrap();

    let mut lying = 0;
    for frame in frames {
        let solution = cell.solve(&frame).unwrap();
        let total: f64 = frame.iter().map(|count| -50.0 * count * 0.028 * 0.028).sum();
        if solution.status == Status::NO_CONTACT {
            assert!(total > -4.0, "{total}");
            continue;
        }
        lying += 1;
        // Without tension there is no direction of push.
        // A layer of 8 mm over taxels of 28 mm.
        assert_eq!(solution.status.0, Status::DIRECTION_UNKNOWN.0 | Status::LOW_CONFIDENCE.0);
        assert!((-780.0..-620.0).contains(&total), "{total}");
        assert!((solution.resultant[2] / total - 1.0).abs() < 0.002, "{:?} for {total}", solution.resultant);
        // The point kernel's gain at this depth, 5.9.
        let short = point.solve(&frame).unwrap().resultant[2] / total;
        assert!((short - 0.1696).abs() < 1e-4, "{short}");
        let error = field_error(&solution.field, &filtered.solve(&frame).unwrap().field);
        assert!(error > 1e-5 && error < 1.3e-3, "{error:e}");
    }
    assert_eq!(lying, 22);
}
