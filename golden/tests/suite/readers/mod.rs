//! Kinds of files that people have: read as they are meant, or refused with what to do.

#![allow(clippy::float_cmp)] // the same bits are meant

mod blocks;
mod headers;

use std::fs;
use std::path::Path;

use golden::design::Design;
use golden::forces::read_outcomes;
use golden::frames::{FrameLines, Frames, Layout, read_recording};

/// A sensor of 3 columns and 2 rows, with more keys of its `[sensor]`.
fn pad(keys: &str) -> Design {
    let text = format!(
        "format = 3\nbase = \"../golden/tests/plain.toml\"\n\
         name = \"pad\"\n[sensor]\ncolumns = 3\nrows = 2\npitch_mm = [4.0, 2.0]\ndepth_mm = 2.0\n{keys}\n"
    );
    Design::from_toml(&text, "pad.toml").unwrap()
}

fn read_bytes(name: &str, bytes: &[u8], design: &Design, layout: impl Into<Layout>) -> Result<Frames, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    fs::write(&path, bytes).unwrap();
    read_recording(&path, design, layout).map_err(|error| error.to_string())
}

fn read(text: &str, layout: impl Into<Layout>) -> Result<Frames, String> {
    read_bytes("frames.csv", text.as_bytes(), &pad(""), layout)
}

#[track_caller]
fn refused(found: Result<Frames, String>, parts: &[&str]) {
    let said = found.expect_err("a refusal");
    assert!(parts.iter().all(|part| said.contains(part)) && !said.contains(char::is_control), "{said:?}");
}

const A: [f64; 6] = [-7.5, -1.0, 0.0, 2.0, -3.0, 5.0];
const B: [f64; 6] = [-8.0, -2.0, 1.0, 0.5, -4.0, 6.0];
const LINES: &str = "-7.5,-1,0,2,-3,5\n-8,-2,1,0.5,-4,6\n";

#[track_caller]
fn both(found: Result<Frames, String>) -> Frames {
    let found = found.unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(found.frames, [A, B]);
    found
}

#[test]
fn separators_of_thousands_are_asked_for() {
    for text in [
        "1,010\t2,020\t3\t4\t5\t6\n",
        "1;2;3;4;5;12,345\n1;2;3;4;5;6\n",
        "1\t2\t3\t4\t5\t1,234,567\n",
        "\"1,010\",2,3,4,5,6\n",
        "1\t2\t3\t4\t5\t1,234\n",
        "1,010 2,020 3 4 5 6\n",
    ] {
        refused(read(text, 0), &["line 1, column", "separators of thousands", "write decimal points"]);
    }
    // One comma that is a decimal point for certain says what all are.
    for text in ["1,010\t2,020\t0,500\t4\t5\t6\n", "1,010;2,5;3;4;5;6\n", "1,010 2,02 3 4 5 6\n"] {
        assert_eq!(read(text, 0).unwrap().frames[0][0], 1.01, "{text:?}");
    }
    let mut lines = FrameLines::new(Path::new("port"), &pad(""), 0);
    assert!(lines.frame(b"1,010;2;3;4;5;6\n").is_err());
    // In blocks of rows as well.
    refused(read("1,010;2;3\n4;5;6\n", 0), &["separators of thousands"]);
    // Points between semicolons and tabs, as in Germany.
    for text in [
        "-1.226;-2.310;3;4;5;6\n",
        "1.226\t2.310\t3\t4\t5\t6\n",
        "1;2;3\n4;5;12.345\n",
        "1.234;0,5;3;4;5;6\n",
        "1.234.567;2;3;4;5;6\n",
    ] {
        refused(read(text, 0), &["line", "separators of thousands", "every point", "separate the values by commas"]);
    }
    for text in [
        "1.226\t0.310\t3\t4\t5\t6\n",
        "1.226 2.310 3\n4 5 6\n",
        "1.226;0.310;3;4;5;6\n",
        "1.226;2.3;3;4;5;6\n",
        "1.226;2;3;4;5;1234.567\n",
    ] {
        assert_eq!(read(text, 0).unwrap().frames[0][0], 1.226, "{text:?}");
    }
    let decimal = "-7,5,-1,0,0,0,2,0,-3,0,5,0\n";
    refused(read(decimal, 0), &["line 1", "column 12 where 6", "decimal commas? Separate the values by semicolons"]);
}

#[test]
fn a_row_with_an_error_of_a_spreadsheet_is_no_remark() {
    let text = "-7.5,-1,0,2,-3,5\n#N/A,1,2,3,4,5\n#1,1,2,3,4,5\n-8,-2,1,0.5,-4,6\n";
    refused(read(text, 0), &["line 2, column 1", "#N/A"]);
    assert_eq!(both(read(text, Layout { skip_bad: true, ..Layout::default() })).skipped, [1]);
    let dead = read_bytes("frames.csv", text.as_bytes(), &pad("dead = [0]"), 0).unwrap();
    assert_eq!(dead.frames[1], [0.0, 1.0, 2.0, 3.0, 4.0, 5.0]);
    // Also below a header, in several cells, and in all.
    let below = format!("p0,p1,p2,p3,p4,p5\n#N/A,1,2,3,4,5\n{LINES}#N/A,#N/A,2,3,4,5\n#N/A,#N/A,#N/A,#N/A,#N/A,#N/A\n");
    assert_eq!(both(read(&below, Layout { skip_bad: true, ..Layout::default() })).skipped, [0, 3, 4]);
}

#[test]
fn an_error_of_a_spreadsheet_in_the_first_row() {
    for text in ["#N/A,1,2,3,4,5\n", " #N/A , 1, 2,3,4,5\n", "#DIV/0! 1 2 3 4 5\n", "#N/A,#N/A,2,3,4,5\n"] {
        refused(read(&format!("{text}{LINES}"), 0), &["line 1, column 1"]);
        let lines = if text.contains(',') { LINES.to_owned() } else { LINES.replace(',', " ") };
        let skip = Layout { skip_bad: true, ..Layout::default() };
        assert_eq!(both(read(&format!("{text}{lines}"), skip)).skipped, [0], "{text:?}");
    }
}

/// Lines below the frames with a word where all others have a number.
#[test]
fn means_below_the_frames_are_none() {
    let frames = "0,-7.5,-1,0,2,-3,5\n1,-8,-2,1,0.5,-4,6\n";
    for text in [format!("{frames}mean,1,2,3,4,5,6\n"), format!("{frames}mean,1,2,3,4,5,6\nstd,1,2,3,4,5,6\n")] {
        let remark = both(read(&text, 1)).remark.unwrap();
        assert!(
            remark.contains("line 3: a word where other lines have a number") && remark.contains("left out"),
            "{remark}"
        );
    }
    // Of a stream, which has no end yet, a line to refuse or to leave out.
    for skip_bad in [false, true] {
        let mut stream =
            FrameLines::new(Path::new("port"), &pad(""), Layout { labels: 1, skip_bad, ..Layout::default() });
        let mut next = |line: &str| stream.frame(line.as_bytes()).map_err(|error| error.to_string());
        assert!(frames.lines().all(|line| next(line).unwrap().is_some()));
        // Whoever touches it may mark a line.
        assert!(next("touch,-7.5,-1,0,2,-3,5").unwrap().is_some());
    }
    for skip_bad in [false, true] {
        let mut stream =
            FrameLines::new(Path::new("port"), &pad(""), Layout { labels: 1, skip_bad, ..Layout::default() });
        let mut next = |line: &str| stream.frame(line.as_bytes()).map_err(|error| error.to_string());
        assert!(frames.lines().all(|line| next(line).unwrap().is_some()));
        let mean = next("Mean,1,2,3,4,5,6");
        let said = "port, line 3: a mean or the like, where the lines before have a number";
        assert!(mean.map_or_else(|error| !skip_bad && error.contains(said), |frame| skip_bad && frame.is_none()));
        assert!(next("2,-7.5,-1,0,2,-3,5").unwrap().is_some());
    }
    assert_eq!(read(&format!("{frames},1,2,3,4,5,6\n"), 1).unwrap().frames.len(), 3);
    // A mark on some lines only is no number.
    let marked = frames.replace("0,-7.5", ",-7.5").replace("1,-8", ",-8") + "release,1,2,3,4,5,6\n";
    assert_eq!(read(&marked, 1).unwrap().frames.len(), 3);
}

#[test]
fn a_time_that_is_not_there() {
    let line = |time: String| format!("{time},-8,-2,1,0.5,-4,6\n");
    let text = |blank: usize, count: usize| -> String {
        let time = |at: usize| if at == blank { String::new() } else { at.to_string() };
        "t (s),p0,p1,p2,p3,p4,p5\n".to_owned() + &(0..count).map(|at| line(time(at))).collect::<String>()
    };
    let found = read(&text(4, 12), 0).unwrap();
    assert_eq!(found.times, Some((0..12).map(f64::from).collect()));
    assert!(found.remark.unwrap().contains("1 line without a time"));
    refused(read(&text(0, 12), 0), &["line 2", "the time is no number", "fill it in"]);
    refused(read(&text(1, 3), 0), &["line 3", "the time is no number"]);
}

/// A tab beside a blank cell separates as a comma does.
#[test]
fn blank_cells_at_either_end_of_a_line() {
    let skip = Layout { skip_bad: true, ..Layout::default() };
    let columns = Layout { columns: Some([2, 7]), ..Layout::default() };
    let good = Ok(vec![A.to_vec()]);
    let a = "-7.5,-1,0,2,-3,5";
    for (keys, text, layout, expected) in [
        // The index of pandas, and a time that is not there.
        ("", format!(",p0,p1,p2,p3,p4,p5\n0,{a}\n"), Layout::default(), good.clone()),
        ("", format!("time,p0,p1,p2,p3,p4,p5,t1\n,{a},900\n"), Layout::default(), good.clone()),
        ("", format!("x,{a},9,8\n,{a},9,8\n"), columns, Ok(vec![A.to_vec(); 2])),
        ("", format!(",{a}\n"), 1.into(), good.clone()),
        ("", format!("\u{feff}0,{a}\n"), 1.into(), good.clone()),
        // Values that are not there.
        ("", format!("{a}\n,-1,0,2,-3,5\n-7.5,-1,0,2,-3,\n"), skip.clone(), good.clone()),
        ("", format!("p0,p1,p2,p3,p4,p5,sum\n{a},9\n,-1,0,2,-3,5,9\n"), skip.clone(), good.clone()),
        ("", "-7.5,-1,0,2,-3,\n".to_owned(), Layout::default(), Err("line 1, column 6: \"\"")),
        ("", ",-1,0,2,-3,5,9\n".to_owned(), Layout::default(), Err("column 7 where 6")),
        ("dead = [0, 5]", ",-1,0,2,-3,\n".to_owned(), 0.into(), Ok(vec![vec![0.0, -1.0, 0.0, 2.0, -3.0, 0.0]])),
        ("dead = [0, 5]", "7,,-1,0,2,-3,\n".to_owned(), 1.into(), Ok(vec![vec![0.0, -1.0, 0.0, 2.0, -3.0, 0.0]])),
        ("dead = [0, 5]", ",-1,0\n2,-3,\n".to_owned(), 0.into(), Ok(vec![vec![0.0, -1.0, 0.0, 2.0, -3.0, 0.0]])),
        // Columns that are blank on each line are none; one that is so on some is the total.
        ("", format!("{a},,\n{a},,\n"), Layout::default(), Ok(vec![A.to_vec(); 2])),
        ("", format!("1,{a}\n2,-7.5,-1,0,2,-3,\n"), skip.clone(), Err("line 1: the line ends at column 7 where 6")),
        ("", format!("a,b,c,d,e,f,note\n{a},\n-7.5,-1,x,2,-3,5,\n"), skip, good),
    ] {
        for separator in [",", ";", "\t"] {
            let text = text.replace(',', separator);
            let found = read_bytes("frames.csv", text.as_bytes(), &pad(keys), layout.clone());
            match (found, &expected) {
                (Ok(found), Ok(frames)) => assert_eq!(found.frames, *frames, "{text:?}"),
                (Err(said), Err(part)) => assert!(said.contains(part), "{said}"),
                (found, _) => panic!("{text:?}: {found:?}"),
            }
        }
    }
    assert!(read("1\t2\t3\t4\t7\t5\t\t\n", 0).unwrap().remark.unwrap().contains("cells behind column 6 are blank"));
}

#[test]
fn a_dead_taxel_may_read_anything() {
    let design = pad("dead = [5]");
    let whole = Layout::default();
    for text in ["NaN", "--", "B", "", "inf"] {
        let lines = format!("-7.5,-1,0,2,-3,{text}\n");
        let found = read_bytes("frames.csv", lines.as_bytes(), &design, whole.clone());
        assert_eq!(found.unwrap().frames, [[-7.5, -1.0, 0.0, 2.0, -3.0, 0.0]], "{text:?}");
    }
    let middle = pad("dead = [1]");
    assert_eq!(read_bytes("f.csv", b"1,,3,4,5,6\n", &middle, 0).unwrap().frames[0][1], 0.0);
    let blocks = read_bytes("f.csv", b"1 nan 3\n4 5 6\n", &middle, 0).unwrap();
    assert_eq!(blocks.frames, [[1.0, 0.0, 3.0, 4.0, 5.0, 6.0]]);
    let mut array = b"\x93NUMPY\x01\x00".to_vec();
    let header = b"{'descr': '<f8', 'fortran_order': False, 'shape': (1, 6), }\n";
    array.extend((header.len() as u16).to_le_bytes());
    array.extend(header);
    array.extend([1.0, f64::NAN, 3.0, 4.0, 5.0, 6.0_f64].iter().flat_map(|value| value.to_le_bytes()));
    assert_eq!(read_bytes("f.npy", &array, &middle, 0).unwrap().frames, [[1.0, 0.0, 3.0, 4.0, 5.0, 6.0]]);
    refused(read_bytes("f.npy", &array, &pad(""), 0), &["[0, 1] is NaN", "sensor.dead", "--skip-bad"]);
    refused(read("1,nan,3,4,5,6\n", 0), &["line 1, column 2", "\"nan\"", "sensor.dead", "--skip-bad"]);
}

#[test]
fn bad_frames_are_left_out_where_that_is_asked_for() {
    let skip = Layout { skip_bad: true, ..Layout::default() };
    let text = format!("{LINES}1,2,nan,4,5,6\n1,2\n{LINES}");
    refused(read(&text, 0), &["line 3, column 3"]);
    let found = read(&text, skip.clone()).unwrap();
    assert_eq!(found.frames, [A, B, A, B]);
    let remark = found.remark.unwrap();
    assert!(remark.contains("2 frames left out; the first: ") && remark.contains("line 3, column 3"), "{remark}");
    // Of blocks one with a damaged row, or of more or fewer rows, is one frame that is left out.
    let good = "\n-7.5 -1 0\n2 -3 5\n";
    for bad in ["1 nan 3\n4 5 6", "1 2 3", "1 2 3\n4 5 6\n7 8 9", "1 2 3\n4 5", "4 5\n1 2 3", "1 2 3\n4 x 6"] {
        let found = read(&format!("{good}\n{bad}\n{good}"), skip.clone()).unwrap();
        assert_eq!((found.frames, found.skipped), (vec![A.to_vec(); 2], vec![1]), "{bad:?}");
        assert!(found.remark.unwrap().contains("1 frame left out; the first: "), "{bad:?}");
    }
    let found = read(&format!("{good}{good}1 2 3\n").replace("\n\n", "\n"), skip.clone()).unwrap();
    assert_eq!((found.frames.len(), &found.skipped[..]), (2, &[2][..]));
    refused(read("1,2,nan,4,5,6\n", skip), &["1 frame left out"]);
}

#[test]
fn columns_in_front_and_behind() {
    let body = LINES
        .replace("-7.5", "0,1,-7.5")
        .replace("-8", "10,2,-8")
        .replace(",5\n", ",5,99\n")
        .replace(",6\n", ",6,98\n");
    let names = "t (ms),frame,p0,p1,p2,p3,p4,p5,total\n";
    let found = both(read(&format!("{names}{body}"), 0));
    assert_eq!(found.times, Some(vec![0.0, 0.01]));
    assert!(found.remark.unwrap().contains("columns 3 to 8, p0 to p5, are the taxels"));
    both(read(&format!("{names}{body}"), 2));
    refused(read(&format!("{names}{body}"), 3), &["line 1", "columns 3 to 8, p0 to p5", "leave --labels away"]);
    let taken = |pair| Layout { columns: Some(pair), ..Layout::default() };
    both(read(&format!("{names}{body}"), taken([3, 8])));
    for text in [format!("{names}{body}"), format!("{}{body}", names.replace("t (ms)", "temp"))] {
        let with = ["line 1", "columns 3 to 8, p0 to p5", "--columns 2-7 takes others", "--skip-lines 1"];
        refused(read(&text, taken([2, 7])), &with);
    }
    let gap = names.replace("p3", "gap");
    refused(read(&format!("{gap}{body}"), taken([2, 7])), &["column 2, \"frame\", is none"]);
    refused(read(&format!("{gap}{body}"), taken([3, 8])), &["column 6, \"gap\", is none"]);
    let sides = ["in front of the values?", "--labels 3", "--columns 1-6", "on either side? With --columns 2-7"];
    refused(read(&body, 0), &["line 1", "3 columns more"]);
    refused(read(&body, 0), &sides);
    both(read(&body, taken([3, 8])));
    refused(read(&body, taken([3, 7])), &["where 8"]);
    // Two arrays in a line.
    let two = "-7.5,-1,0,2,-3,5,1,1,1,1,1,1\n-8,-2,1,0.5,-4,6,1,1,1,1,1,1\n";
    refused(read(two, 0), &["two arrays in a line?", "--columns 1-6", "--columns 7-12"]);
    let names = "l0,r0,l1,r1,l2,r2,l3,r3,l4,r4,l5,r5\n";
    for layout in [Layout::default(), taken([1, 6])] {
        refused(
            read(&format!("{names}{two}"), layout),
            &["line 1", "two arrays alternate, l0, r0, l1", "side by side"],
        );
    }
    let names = "l0,l1,l2,l3,l4,l5,r0,r1,r2,r3,r4,r5\n";
    refused(read(&format!("{names}{two}"), 0), &["several arrays", "--columns 1-6 (l0 to l5)", "--columns 7-12 (r0"]);
    both(read(&format!("{names}{two}"), taken([1, 6])));
    refused(read(&format!("{names}{two}"), taken([4, 9])), &["columns 1 to 6, l0 to l5", "--columns 4-9 takes others"]);
    // Names of rows and columns.
    both(read(
        &format!("time,r0c0,r0c1,r0c2,r1c0,r1c1,r1c2\n{}", LINES.replace("-7.5", "0,-7.5").replace("-8", "1,-8")),
        0,
    ));
}

#[test]
fn time_stamps_are_times() {
    let [a, b] = ["-7.5,-1,0,2,-3,5", "-8,-2,1,0.5,-4,6"];
    let names = "p0,p1,p2,p3,p4,p5";
    let second = "2026-03-01T12:00:00.250";
    for (text, labels) in [
        (format!("time,{names}\n2026-03-01T12:00:00.125,{a}\n{second},{b}\n"), 0),
        (format!("when,{names}\n2026-03-01 13:00:00.125+01:00,{a}\n{second}Z,{b}\n"), 0),
        (format!("2026-03-01T12:00:00.125,{a}\n{second},{b}\n"), 1),
        (format!("7 2026-03-01 12:00:00.125 {a}\n8 {} {b}\n", second.replace('T', " ")).replace(',', " "), 3),
    ] {
        let times = both(read(&text, labels)).times.expect("times");
        assert_eq!(times, [1_772_366_400.125, 1_772_366_400.25], "{text}");
    }
    refused(read(&format!("2026-03-01T12:00:00.125,{a}\n"), 0), &["line 1, column 1", "need --labels"]);
    // Not of a line alone that has none.
    assert_eq!(both(read(&format!("2026-03-01T12:00:00.125,{a}\nlater,{b}\n"), 1)).times, None);
}

#[test]
fn other_formats_are_named() {
    for (bytes, parts) in [
        (&b"PAR1\x15\x04"[..], ["Parquet", "CSV"]),
        (b"#ROSBAG V2.0\n", ["ROS 1", "rostopic echo"]),
        (b"\x89MCAP0\r\n", ["MCAP", "CSV"]),
        (b"SQLite format 3\0", ["SQLite", "sqlite3"]),
        (b"\x80\x04\x95\x10", ["pickle", "numpy.save"]),
        (b"\xd0\xcf\x11\xe0\xa1", ["spreadsheet", "CSV"]),
        (b"BZh91AY", ["bzip2", "bunzip2"]),
        (b"\xfd7zXZ\0\0", ["xz", "unxz"]),
        (b"\x28\xb5\x2f\xfd\x04", ["Zstandard", "unzstd"]),
        (b"{\"t\": 0, \"p\": [1, 2]}\n", ["JSON", "jq"]),
        (b"[[0 1 2]\n [3 4 5]]\n", ["as Python prints it", "numpy.save"]),
        (b"P:1,2,3,4,5,6\n", ["line 1, column 1", "sed 's/[^,]*://g'"]),
        (b"12:00:01.123 -> 1,2,3,4,5,6\n", ["serial monitor", "timestamps off"]),
    ] {
        refused(read_bytes("file", bytes, &pad(""), 0), &parts);
    }
}

#[test]
fn a_message_names_the_unit_of_the_design() {
    let text = b"1,2,3,4,five,6\n";
    let counts = read_bytes("f.csv", text, &pad("pa_per_count = -10.0"), 0);
    refused(counts, &["column 5", "give the sensor's count, such as 1012"]);
    refused(read_bytes("f.csv", text, &pad(""), 0), &["give the stress in pascals"]);
}

/// What `calibrate --forces` takes, `solve --reference` takes.
#[test]
fn true_forces_are_read_in_each_form() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("forces.csv");
    let read = |text: &str, frames| {
        fs::write(&path, text).unwrap();
        read_outcomes(&path, frames).map_err(|error| error.to_string())
    };
    let own = read("status,F_x (N),F_y (N),F_z (N),mu,phi (rad),mu_x,mu_y\n0,3,0,-6,0.5,0,0.5,0\n", 1).unwrap();
    for text in [
        "F_x,F_y,F_z\n3,0,-6\n",
        "Fx;Fy;Fz\n3;0;6\n",
        "t (s),F_x (mN),F_y (mN),F_z (mN),M_x,M_y,M_z,x,y\n0,3000,0,-6000,1,1,1,1,1\n",
        "3 0 -6\n",
        "0,3,0,-6,0.5,0,0.5,0\n",
    ] {
        assert_eq!(read(text, 1).as_ref(), Ok(&own), "{text:?}");
    }
    for (text, frames, part) in [
        ("F_z\n-6\n", 1, "F_x, F_y or F_z is not known"),
        ("F_x,F_y,F_z\n3,0,-6\n", 2, "forces of 1 frame where there are 2"),
        ("1,2\n", 1, "column 2 where 8"),
    ] {
        let said = read(text, frames).unwrap_err();
        assert!(said.contains(part), "no {part:?} in {said}");
    }
}
