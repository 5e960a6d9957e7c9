//! Headers: names, numbers and units of columns.

#![allow(clippy::float_cmp)] // the same bits are meant

use std::path::Path;

use golden::design::Design;
use golden::frames::{FrameLines, Layout};
use golden::sensor::Sensor;

use super::{A, B, LINES, both, pad, read, read_bytes, refused};

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
    let square = Design { sensor: Sensor { rows: 3, ..pad("").sensor }, ..pad("") };
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
        // From the last one on, and in the order of the wiring.
        (format!("20,12,11,7,5,3\n{LINES}"), 0),
        (format!("20,3,5,12,11,7\n{LINES}"), 0),
        (format!("electrode,20,3,5,12,11,7\n{}", LINES.replace("-7.5", "0,-7.5").replace("-8", "1,-8")), 1),
    ] {
        let found = both(read(&text, labels));
        assert!(found.remark.is_some_and(|remark| remark.contains("line 1") && remark.contains("header")), "{text:?}");
    }
    // Places of the columns, and ranges.
    let labelled = LINES.replace("-7.5", "0,-7.5").replace("-8", "1,-8");
    for above in ["x (mm),0,4,8,0,4,8\ny (mm),0,0,0,4,4,4\n", "min,0,0,0,0,0,0\nmax,4095,4095,4095,4095,4095,4095\n"] {
        let found = both(read(&format!("{above}{labelled}"), 1));
        assert!(found.remark.unwrap().contains("2 lines read as a header"), "{above}");
    }
    // Frames whose values happen to rise or to fall are frames, and so are those with words as labels.
    for rising in ["1,2,3,4,5,7\n1,2,3,4,6,9\n", "7,5,4,3,2,1\n9,6,4,3,2,1\n", "20,3,5,12,11,7\n20,3.5,5,12,11,7\n"] {
        assert_eq!(read(rising, 0).unwrap().frames.len(), 2, "{rising:?}");
    }
    assert_eq!(read("left,1,5,3,4,5,7\nright,1,2,3,4,6,9\n", 1).unwrap().frames.len(), 2);
    let mut lines = FrameLines::new(Path::new("port"), &pad(""), 0);
    assert!(lines.frame(b"3,5,7,11,12,20\n").unwrap().is_none() && lines.remark().is_some());
    let said = FrameLines::new(Path::new("port"), &pad(""), 0).frame(b"0,\x01\n\x0e").unwrap_err().to_string();
    assert!(!said.contains(char::is_control), "{said:?}");
    assert!(lines.frame(b"3,5,7,11,12,20\n").unwrap().is_some(), "a constant load");
    assert_eq!(read("3,5,7,11,12,20\n3,5,7,11,12,20\n3,5,7,9,8,20\n", 0).unwrap().frames.len(), 3);
    // Counts that all differ, behind a word, and such that rise in one frame alone, are much like those of the next frame.
    let rest = "start,512,530,498,505,521,517\n1,513,529,498,506,520,518\n2,900,2030,700,505,521,517\n";
    let by_chance = "1,2,3,4,5,6\n1,2,3,5,4,6\n9,8,2,5,4,6\n".replace(',', "00,");
    for (text, labels) in [(rest, 1), (&by_chance, 0)] {
        assert_eq!(read(text, labels).unwrap().frames.len(), 3, "{text:?}");
    }
    // Counts of a few taxels without load.
    let few = Design { sensor: Sensor { columns: 2, ..pad("").sensor }, ..pad("") };
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
    let square = Design { sensor: Sensor { rows: 3, ..pad("").sensor }, ..pad("") };
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
    for (own, said) in
        [("-1000.0", "says what a value is worth"), ("-1.0", "sensor.pa_per_count says 1 Pa: are values in")]
    {
        let names = [0, 1, 2, 3, 4, 5].map(|taxel| format!("p{taxel} (kPa)")).join(",");
        let design = pad(&format!("pa_per_count = {own}"));
        let found = both(read_bytes("f.csv", format!("{names}\n{LINES}").as_bytes(), &design, 0));
        assert!(found.remark.unwrap().contains(said), "{own}");
    }
    let backwards = read(&format!("% p5,p4,p3,p2,p1,p0\n{LINES}"), 0).unwrap();
    assert!(backwards.frames[0].iter().rev().eq(&A));
    // In a line of its own above lines of frames, with names or not.
    for above in
        ["UNITS mbar\n", "# unit: mbar\n", "UNITS mbar\np0,p1,p2,p3,p4,p5\n", "# Unit mbar\np0,p1,p2,p3,p4,p5\n"]
    {
        let found = read(&format!("{above}{LINES}"), 0).unwrap();
        assert!(found.frames[0] == A.map(|value| 100.0 * value), "{above}");
        assert!(found.remark.unwrap().contains("line 1: the header gives the unit mbar"), "{above}");
    }
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
