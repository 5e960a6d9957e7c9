//! Kinds of files that people have: read as they are meant, or refused with what to do.

#![allow(clippy::float_cmp)] // the same bits are meant

mod blocks;

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
fn more_cells_than_names_shift_no_taxel() {
    let head = "t,p0,p1,p2,p3,p4,p5\n";
    let shifted = format!("{head}0,-7.5,-1,0,2,-3,5,\n0,01,-8,-2,1,0.5,-4,6\n");
    refused(read(&shifted, 0), &["line 3", "8 cells", "names: 7", "Separate the cells by semicolons"]);
    let rows = "0,-7.5,-1,0,2,-3,5,9\n0,01,-8,-2,1,0.5,-4,6,9\n1,-8,-2,1,0.5,-4,6,9\n";
    let columns = Layout { columns: Some([2, 7]), ..Layout::default() };
    refused(read(rows, columns.clone()), &["line 2", "9 cells", "first row has: 8"]);
    refused(read("0,-7.5,-1,0,2,-3,5,9\n-8,-2,1,0.5,-4,6,9\n", columns.clone()), &["line 2", "7 cells"]);
    let found = both(read(rows, Layout { skip_bad: true, ..columns }));
    assert_eq!(found.skipped, [1]);
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

/// Letters and digits side by side that stand for rows and columns.
#[test]
fn names_of_places_in_the_grid() {
    let by_columns = "-7.5,2,-1,-3,0,5\n-8,0.5,-2,-4,1,6\n";
    for (names, lines, is_said) in [
        ("A1,B1,A2,B2,A3,B3", by_columns, true),
        ("s11,s21,s12,s22,s13,s23", by_columns, true),
        ("A1,B1,C1,A2,B2,C2", LINES, false),
        ("s11,s12,s13,s21,s22,s23", LINES, false),
        // Of other lengths, and no letters of the alphabet.
        ("a1,leftside2,b3,c4,d5,e6", LINES, false),
        ("é1,ab2,b3,c4,d5,e6", LINES, false),
    ] {
        let remark = both(read(&format!("{names}\n{lines}"), 0)).remark.unwrap_or_default();
        assert_eq!(remark.contains("not in the order of the taxels"), is_said, "{names}: {remark}");
    }
    let square = Design { sensor: golden::sensor::Sensor { rows: 3, ..pad("").sensor }, ..pad("") };
    for names in ["s11,s21,s31,s12,s22,s32,s13,s23,s33", "A1,B1,C1,A2,B2,C2,A3,B3,C3"] {
        let text = format!("{names}\n80,70,60,50,40,30,20,10,90\n");
        refused(
            read_bytes("f.csv", text.as_bytes(), &square, 0),
            &["line 1", "either may be that of the row", "--skip-lines 1"],
        );
        let skip = Layout { skip_lines: 1, ..Layout::default() };
        assert_eq!(read_bytes("f.csv", text.as_bytes(), &square, skip).unwrap().frames[0][1], 70.0);
    }
}

#[test]
fn a_header_of_sensor_numbers_is_none_of_the_frames() {
    for (text, labels) in [
        // With gaps, and behind a word.
        (format!("3,5,7,11,12,20\n{LINES}"), 0),
        (format!("taxel,3,5,7,11,12,20\n{}", LINES.replace("-7.5", "0,-7.5").replace("-8", "1,-8")), 1),
        // In the order of the wiring.
        (format!("electrode,20,3,5,12,11,7\n{}", LINES.replace("-7.5", "0,-7.5").replace("-8", "1,-8")), 1),
    ] {
        let found = both(read(&text, labels));
        assert!(found.remark.is_some_and(|remark| remark.contains("line 1") && remark.contains("header")), "{text:?}");
    }
    // Frames whose values happen to rise are frames, and so are those with words as labels.
    let rising = "1,2,3,4,5,7\n1,2,3,4,6,9\n";
    assert_eq!(read(rising, 0).unwrap().frames.len(), 2);
    assert_eq!(read("left,1,5,3,4,5,7\nright,1,2,3,4,6,9\n", 1).unwrap().frames.len(), 2);
    let mut lines = FrameLines::new(Path::new("port"), &pad(""), 0);
    assert!(lines.frame(b"3,5,7,11,12,20\n").unwrap().is_none() && lines.remark().is_some());
    assert!(lines.frame(b"3,5,7,11,12,20\n").unwrap().is_some(), "a constant load");
    assert_eq!(read("3,5,7,11,12,20\n3,5,7,11,12,20\n3,5,7,9,8,20\n", 0).unwrap().frames.len(), 3);
    // Counts that all differ, behind a word, and such that rise in one frame alone, are much like those of the next frame.
    let rest = "start,512,530,498,505,521,517\n1,513,529,498,506,520,518\n2,900,2030,700,505,521,517\n";
    let by_chance = "1,2,3,4,5,6\n1,2,3,5,4,6\n9,8,2,5,4,6\n".replace(',', "00,");
    for (text, labels) in [(rest, 1), (&by_chance, 0)] {
        assert_eq!(read(text, labels).unwrap().frames.len(), 3, "{text:?}");
    }
    // Counts of a few taxels without load.
    let few = Design { sensor: golden::sensor::Sensor { columns: 2, ..pad("").sensor }, ..pad("") };
    let counts = b"0,0,1,1\n1,0,1,1\n0,0,1,1\n1,0,2,3\n";
    for from in [0, 8, 24] {
        let found = read_bytes("f.csv", &counts[from..], &few, 0).unwrap();
        assert_eq!(found.frames.len(), 4 - from / 8, "{:?}", found.remark);
    }
    // Readings that are not there are no names.
    let skip = Layout { skip_bad: true, ..Layout::default() };
    for (text, skipped) in [
        (format!("NA,NA,NA,NA,NA,NA\n{LINES}"), 0),
        (format!("p0,p1,p2,p3,p4,p5\n--,--,--,--,--,--\n{LINES}"), 0),
        ("-7.5 -1 0\n2 -3 5\n\n- -1 0\n2 -3 5\n\n-8 -2 1\n0.5 -4 6\n".to_owned(), 1),
    ] {
        assert_eq!(both(read(&text, skip.clone())).skipped, [skipped], "{text:?}");
    }
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

/// Numbers of all taxels, or of their columns and rows, are a header, and so is each line that is the same.
#[test]
fn numbers_above_the_frames_are_a_header() {
    let labelled = LINES.replace("-7.5", "0,-7.5").replace("-8", "1,-8");
    for (text, labels, again) in [
        (format!("0,1,2,3,4,5\n{LINES}0,1,2,3,4,5\n"), 0, true),
        (format!("3,5,7,11,12,20\n{LINES}3,5,7,11,12,20\n"), 0, false),
        (format!("frame,1,2,3,4,5,6\n{labelled}frame,1,2,3,4,5,6\n"), 1, true),
        (format!("frame,3,5,7,11,12,20\n{labelled}frame,3,5,7,11,12,20\n"), 1, false),
        (format!("S,S,S,S,S,S\n1,2,3,4,5,6\n{LINES}S,S,S,S,S,S\n1,2,3,4,5,6\n"), 0, true),
        (format!("0,1,2,0,1,2\n0,0,0,1,1,1\n{LINES}"), 0, false),
        (format!("1,2,3,1,2,3\n1,1,1,2,2,2\n{LINES}"), 0, false),
        // As pandas writes its index, and as others write times and totals.
        (format!(",0,1,2,3,4,5\n{labelled}"), 0, false),
        (format!("frame,1,2,3,4,5,6\n{labelled}"), 0, false),
        (
            format!("t (s),1,2,3,4,5,6,total\n{}", labelled.replace(",5\n", ",5,9\n").replace(",6\n", ",6,9\n")),
            0,
            false,
        ),
        (format!(",a,b,c,d,e,f\n{labelled}"), 0, false),
    ] {
        let remark = both(read(&text, labels)).remark.unwrap();
        assert_eq!(remark.contains("the header again"), again, "{text:?}: {remark}");
    }
    let mut lines = FrameLines::new(Path::new("port"), &pad(""), 0);
    for line in ["5,4,3,2,1,0\n", "5,6,2,-3,0,-7.5\n", "5,4,3,2,1,0\n"] {
        assert_eq!(lines.frame(line.as_bytes()).unwrap().is_some(), line.contains('6'));
    }
    // A frame has other numbers, or names above it.
    for text in ["0,0,0,0,0,0\n", "1,2,3,4,5,5\n", "a,b,c,d,e,f\n1,2,3,4,5,6\n"] {
        assert_eq!(read(text, 0).unwrap().frames.len(), 1, "{text:?}");
    }
}

#[test]
fn names_say_which_taxel_a_column_is() {
    let turned = "5,-3,2,0,-1,-7.5\n6,-4,0.5,1,-2,-8\n";
    let by_columns = "-7.5,2,-1,-3,0,5\n-8,0.5,-2,-4,1,6\n";
    let said = "the numbers of their names say which is which";
    for (text, is_said) in [
        (format!("p5,p4,p3,p2,p1,p0\n{turned}"), true),
        (format!("6,5,4,3,2,1\n{turned}"), true),
        (format!("mat2 p6,mat2 p5,mat2 p4,mat2 p3,mat2 p2,mat2 p1\n{turned}"), true),
        (format!("R1C1,R2C1,R1C2,R2C2,R1C3,R2C3\n{by_columns}"), true),
        (format!("x0y0,x0y1,x1y0,x1y1,x2y0,x2y1\n{by_columns}"), true),
        (format!("p[0][0],p[0][1],p[0][2],p[1][0],p[1][1],p[1][2]\n{LINES}"), false),
        (format!("x0y0,x1y0,x2y0,x0y1,x1y1,x2y1\n{LINES}"), false),
        // In the order of the wiring.
        (format!("e20,e3,e5,e12,e11,e7\n{LINES}"), false),
    ] {
        let remark = both(read(&text, 0)).remark.unwrap_or_default();
        assert_eq!(remark.contains(said), is_said, "{text:?}: {remark}");
    }
    // On a square, where words say which is the row, and where they do not.
    let square = Design { sensor: golden::sensor::Sensor { rows: 3, ..pad("").sensor }, ..pad("") };
    let by = |words: [&str; 2]| {
        let names: Vec<_> = (0..9).map(|at| format!("{}{}{}{}", words[0], at / 3, words[1], at % 3)).collect();
        let text = format!("{}\n8,7,6,5,4,3,2,1,9\n", names.join(","));
        read_bytes("f.csv", text.as_bytes(), &square, 0).unwrap().frames[0].clone()
    };
    let [in_order, transposed] = [[8, 7, 6, 5, 4, 3, 2, 1, 9], [8, 5, 2, 7, 4, 1, 6, 3, 9]].map(|of| of.map(f64::from));
    for (words, frame) in [
        (["c", "_"], in_order),
        (["R", "C"], in_order),
        (["row ", " column "], in_order),
        (["taxel_x", "_y"], transposed),
        (["c", "r"], transposed),
    ] {
        assert_eq!(by(words), frame, "{words:?}");
    }
    let nc = read_bytes("f.csv", format!("p0,p1,p2,nc,p4,p5\n{LINES}").as_bytes(), &pad("dead = [3]"), 0);
    assert_eq!(nc.unwrap().frames.len(), 2);
    // A header behind #, as of numpy.savetxt; words of a remark are none.
    for (text, is_said) in [
        (format!("# of June\n# p5,p4,p3,p2,p1,p0\n{turned}"), true),
        (format!("# time p0 p1 p2 p3 p4 p5\n{}", LINES.replace("-7.5", "0,-7.5").replace("-8", "1,-8")), false),
        (format!("# of the time of six taxels\n# taxels 5 4 3 2 1 0\n{LINES}"), false),
        (format!("# Time: 2024-05-03 12:30:01 UTC device 4\n{LINES}"), false),
        (format!("# Time: 2024-05-03 12:30:01 UTC device 4\n{}", LINES.replace(',', " ")), false),
    ] {
        let remark = both(read(&text, 0)).remark.unwrap_or_default();
        assert_eq!(remark.contains(said), is_said, "{text:?}: {remark}");
    }
    refused(read(&format!("# time,p0,p1,p2,p3,p4\n{LINES}"), 0), &["line 1: 5 taxels are named"]);
    refused(read(&format!("e1,e10,e12,e2,e3,e7\n{LINES}"), 0), &["text of their names, e12 before e2", "sort them"]);
    // The column of the file is named, and a dead taxel stands where its name is.
    refused(read("p5,p4,p3,p2,p1,p0\n1,2,3,4,x,6\n", 0), &["line 2, column 5"]);
    let found = read_bytes("f.csv", b"p5,p4,p3,p2,p1,p0\n1,2,3,4,x,6\n", &pad("dead = [1]"), 0).unwrap();
    assert_eq!(found.frames, [[6.0, 0.0, 4.0, 3.0, 2.0, 1.0]]);
    for names in ["time,p0,p1,p2,p3,p4", "Zeit;Sensor 1;Sensor 2;Sensor 3;Sensor 4;Sensor 5", ",p0,p1,p2,p3,p4"] {
        let text = format!("{names}\n{}", LINES.replace(',', if names.contains(';') { ";" } else { "," }));
        refused(read(&text, 0), &["line 1: 5 taxels are named, the design has 6", "column 1", "sensor.dead"]);
    }
    refused(read(&format!("p0,p1,p2,p3,p4,total\n{LINES}"), 0), &["5 taxels are named", "column 6, \"total\""]);
    refused(read(&format!("t (s),a,b,c,d,e\n{LINES}"), 0), &["5 taxels are named", "column 1, \"t (s)\""]);
}

#[test]
fn units_above_the_frames() {
    let names = "p0,p1,p2,p3,p4,p5\n";
    for (header, pascals) in [
        (format!("{names}mbar,mbar,mbar,mbar,mbar,mbar\n"), 100.0),
        (format!("{names}[N/cm²],[N/cm²],[N/cm²],[N/cm²],[N/cm²],[N/cm²]\n"), 1e4),
        ("p0 (kPa),p1 (kPa),p2 (kPa),p3 (kPa),p4 (kPa),p5 (kPa)\n".to_owned(), 1e3),
        ("p0_psi,p1_psi,p2_psi,p3_psi,p4_psi,p5_psi\n".to_owned(), 6_894.757_293),
        ("p0 N/cm2,p1 N/cm2,p2 N/cm2,p3 N/cm2,p4 N/cm2,p5 N/cm2\n".to_owned(), 1e4),
        (format!("{names}MPa,MPa,MPa,MPa,MPa,MPa\n"), 1e6),
        (format!("{names}MN/m2,MN/m2,MN/m2,MN/m2,MN/m2,MN/m2\n"), 1e6),
        ("a (g/cm2),b (g/cm2),c (g/cm2),d (g/cm2),e (g/cm2),f (g/cm2)\n".to_owned(), 98.066_5),
        ("p0 (Pa),p1 (Pa),p2 (Pa),p3 (Pa),p4 (Pa),p5 (Pa)\n".to_owned(), 1.0),
        (format!("{names}left,left,left,left,left,left\n"), 1.0),
    ] {
        let text = format!("{header}{LINES}");
        let found = read(&text, 0).unwrap();
        let near = |(found, value): (&f64, f64)| (found - value * pascals).abs() <= 1e-9 * found.abs();
        assert!(found.frames[1].iter().zip(B).all(near), "{text:?}: {:?}", found.frames);
        let remark = found.remark.unwrap_or_default();
        assert_eq!(remark.contains(&format!("is {pascals} Pa")), pascals > 1.0, "{remark}");
        assert_eq!(remark.contains("left, which is no known pressure"), text.contains("left"), "{remark}");
        // Counts are worth what the design says.
        let counts = read_bytes("f.csv", text.as_bytes(), &pad("pa_per_count = -10.0"), 0).unwrap();
        assert_eq!(counts.frames, [A, B]);
    }
    // Of times, too.
    let text =
        format!("t,{names}ms,kPa,kPa,kPa,kPa,kPa,kPa\n{}", LINES.replace("-7.5", "0,-7.5").replace("-8", "5,-8"));
    assert_eq!(read(&text, 0).unwrap().times, Some(vec![0.0, 0.005]));
    for (unit, pascals) in [("N/cm2", 1e4), ("N/mm²", 1e6), ("kg/cm^2", 98_066.5), ("g/cm2", 98.066_5)] {
        for words in ["UNITS ", "Unit of measure: ", "pressure_unit: ", "Pressure unit is "] {
            let found = read(&format!("{words}{unit}\n1,2,3\n4,5,6\n"), 0).unwrap();
            assert!((found.frames[0][0] / -pascals - 1.0).abs() < 1e-9, "{words}{unit}: {:?}", found.frames);
        }
    }
    for names in ["p0 (kPa),p1 (mbar),p2,p3,p4,p5", "p0 (kPa),p1,p2,p3,p4,p5", "p0,p1,p2,p3,p4,p5\nPa,kPa,Pa,Pa,Pa,Pa"]
    {
        refused(read(&format!("{names}\n{LINES}"), 0), &["the header names several units", "one unit"]);
    }
    let counts =
        read_bytes("f.csv", format!("p0 (kPa),p1,p2,p3,p4,p5\n{LINES}").as_bytes(), &pad("pa_per_count = -1.0"), 0);
    assert_eq!(both(counts).frames.len(), 2);
    let found = read("UNITS mine\n1,2,3\n4,5,6\n", 0).unwrap();
    assert!(found.frames[0][0] == 1.0 && found.remark.unwrap().contains("unit mine, which is no known pressure"));
    // What is certainly no pressure is refused, unless the design says what it is worth.
    for (unit, what) in [
        ("N", "a force, and the design reads pascals: set sensor.pa_per_count to -125000: pascals of 1 N"),
        ("mN", "to -125: pascals of 1 mN that presses on a taxel of 4 x 2 mm"),
        ("mV", "a voltage, and the design reads pascals: set sensor.pa_per_count or sensor.curve"),
        ("kΩ", "a resistance"),
        ("pF", "a capacitance"),
        ("raw", "a count"),
    ] {
        let in_line = format!("{}\n{LINES}", [0, 1, 2, 3, 4, 5].map(|taxel| format!("p{taxel} ({unit})")).join(","));
        for text in [in_line, format!("UNITS {unit}\n1,2,3\n4,5,6\n")] {
            refused(read(&text, 0), &["line 1", &format!("the unit {unit}"), what]);
            read_bytes("f.csv", text.as_bytes(), &pad("pa_per_count = -1.0"), 0).unwrap();
        }
    }
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
    refused(read(&body, 0), &["line 1", "3 columns more", "in front of the values?", "--labels 3", "--columns 1-6"]);
    both(read(&body, Layout { columns: Some([3, 8]), ..Layout::default() }));
    refused(read(&body, Layout { columns: Some([3, 7]), ..Layout::default() }), &["where 8"]);
    // Two arrays in a line.
    let two = "-7.5,-1,0,2,-3,5,1,1,1,1,1,1\n-8,-2,1,0.5,-4,6,1,1,1,1,1,1\n";
    refused(read(two, 0), &["two arrays in a line?", "--columns 1-6", "--columns 7-12"]);
    let names = "l0,l1,l2,l3,l4,l5,r0,r1,r2,r3,r4,r5\n";
    refused(read(&format!("{names}{two}"), 0), &["several arrays", "--columns 1-6 (l0 to l5)", "--columns 7-12 (r0"]);
    both(read(&format!("{names}{two}"), Layout { columns: Some([1, 6]), ..Layout::default() }));
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
fn headers_as_programs_write_them() {
    both(read(&format!("p0,p1,p2,p3,p4,p5\nPa,Pa,Pa,Pa,Pa,Pa\n{LINES}"), 0));
    both(read(&format!("sep=;\np0;p1;p2;p3;p4;p5\n{}", LINES.replace(',', ";")), 0));
    let names = b"Kan\xe4le 0,\xe4 1,\xe4 2,\xe4 3,\xe4 4,\xe4 5\n";
    both(read_bytes("frames.csv", &[names, LINES.as_bytes()].concat(), &pad(""), 0));
    both(read(&format!("p0,p1,p2,p3,p4,p5\n{LINES}").replace('\n', "\r"), 0));
    let quoted = "\"-7,5\",\"-1,0\",0,2,\"-3,0\",5\n-8,-2,1,\"0,5\",-4,6\n";
    both(read(quoted, 0));
    both(read("-7,5 -1 0 2 -3 5\n-8 -2 1 0,5 -4 6\n", 0));
    for bytes in [u16::to_le_bytes, u16::to_be_bytes] {
        let text: Vec<u8> = format!("\u{feff}{LINES}").encode_utf16().flat_map(bytes).collect();
        both(read_bytes("frames.csv", &text, &pad(""), 0));
    }
    // A stream of these is refused with what to do.
    let mut stream = FrameLines::new(Path::new("port"), &pad(""), 0);
    for (line, said) in [
        (
            &b"-\x007\x00,\x001\x00\r\x00\n"[..],
            "port: the file is UTF-16, two bytes a character; pipe it through iconv",
        ),
        (b"-7.5,-1,0\n", "port, line 1: the line ends at column 3 where 6 values are needed; is it a row of the grid?"),
    ] {
        let refusal = stream.frame(line).unwrap_err().to_string();
        assert!(refusal.contains(said) && refusal.contains("to a file"), "{refusal}");
    }
    let again = read(&format!("p0,p1,p2,p3,p4,p5\n{LINES}p0,p1,p2,p3,p4,p5\n{LINES}"), 0).unwrap();
    assert_eq!(again.frames, [A, B, A, B]);
    assert!(again.remark.unwrap().contains("line 4: the header again"));
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
