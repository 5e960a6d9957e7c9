//! Frames as blocks of rows.

#![allow(clippy::float_cmp)] // the same bits are meant

use golden::frames::Layout;

use super::{A, B, LINES, both, pad, read, read_bytes, refused};

#[test]
fn frames_as_blocks_of_rows() {
    let both = |text: &str| {
        let found = both(read(text, 0));
        assert!(found.remark.unwrap().contains("blocks of 2 lines of 3 values"), "{text:?}");
    };
    both("-7.5 -1 0\n2 -3 5\n\n-8 -2 1\n0.5 -4 6\n");
    both("-7.5,-1,0\n2,-3,5\n-8,-2,1\n0.5,-4,6\n");
    both("Frame 1\n-7.5\t-1\t0\n2\t-3\t5\nFrame 2\n-8\t-2\t1\n0.5\t-4\t6\n@@\n");
    both("# one\n-7.50e+00 -1 0\n2 -3 5\n# two\n-8 -2 1\n0.5 -4 6\n");
    let export = "DATA_TYPE MOVIE\r\nROWS 2\r\nCOLS 3\r\nUNITS kPa\r\nSTART_FRAME 1\r\nASCII_DATA @@\r\n\r\nFrame 1\r\n\
                  1,2,0\r\n0,0.5,B\r\n\r\nFrame 2\r\n0,0,3\r\n0,0,0\r\n@@\r\n";
    let found = read_bytes("movie.asf", export.as_bytes(), &pad("dead = [5]"), 0).unwrap();
    assert_eq!(found.frames[0], [-1000.0, -2000.0, 0.0, 0.0, -500.0, 0.0]);
    assert!(found.remark.unwrap().contains("the unit kPa; pressure presses, so that 1 kPa is -1000 Pa"));
    let counting = read_bytes("movie.asf", export.as_bytes(), &pad("pa_per_count = -1000.0\ndead = [5]"), 0).unwrap();
    assert_eq!(counting.frames[0][..3], [1.0, 2.0, 0.0]);
    for (text, parts) in [
        ("1 2 3\n\n4 5 6\n", ["line 2", "a block of 1 row ends here where the sensor has 2"]),
        ("1 2 3\n4 5 6\n1 2 3", ["ends within a frame", "after 1 of 2 rows"]),
        ("1 2\n3 4\n5 6\n", ["blocks of 3 lines of 2 values are the transposed grid", "2 rows of 3 columns"]),
        ("1 2 3\n4 nan 6\n", ["line 2, column 2", "sensor.dead"]),
    ] {
        refused(read(text, 0), &parts);
    }
    // Numbers of the columns above each frame, and rows that happen to be such.
    let mut wide = pad("");
    wide.sensor.columns = 4;
    let found = read_bytes("f.csv", b"0,1,2,3\n5,6,7,8\n1,1,1,1\n0,1,2,3\n6,7,8,9\n2,2,2,2\n", &wide, 0).unwrap();
    assert_eq!((found.frames.len(), found.frames[1][0]), (2, 6.0));
    assert!(found.remark.unwrap().contains("below numbers of the columns"));
    assert_eq!(read_bytes("f.csv", b"0,1,2,3\n4,5,6,7\n", &wide, 0).unwrap().frames[0][1], 1.0);
    // Labels of the rows.
    let labels = "behind labels of the rows";
    let read_both = |text: &str, layout: usize| {
        let found = read(text, layout).unwrap();
        assert!(found.frames == [A, B] && found.remark.unwrap().contains(labels), "{text:?}, {layout}");
    };
    for text in [
        "\"\",a,b,c\n0,-7.5,-1,0\n1,2,-3,5\n\"\",a,b,c\n0,-8,-2,1\n1,0.5,-4,6\n",
        ",0,1,2\n1,-7.5,-1,0\n2,2,-3,5\n1,-8,-2,1\n2,0.5,-4,6\n",
        "top -7.5 -1 0\nend 2 -3 5\n\ntop -8 -2 1\nend 0.5 -4 6\n",
    ] {
        for layout in [0, 1] {
            read_both(text, layout);
        }
    }
    let rows = "y,0,1,2,3\n0,5,6,7,8\n1,1,1,1,1\n";
    let found = read_bytes("f.csv", format!("{rows}{rows}").as_bytes(), &wide, 0).unwrap();
    assert!(found.frames == [[5.0, 6.0, 7.0, 8.0, 1.0, 1.0, 1.0, 1.0]; 2] && found.remark.unwrap().contains(labels));
    // Numbers of another sensor's columns are none.
    refused(read("7.5,1,2,3\n8,4,5,6\n", 0), &["line 1"]);
    // Columns on either side of the rows.
    let beside = "-7.5 -1 0 -8.5\n2 -3 5 4\n\n-8 -2 1 -9\n0.5 -4 6 2.5\n";
    refused(read(beside, 0), &["line 1", "rows of the grid, with 1 column more?", "--columns 1-3 or --columns 2-4"]);
    let columns = |pair| Layout { columns: Some(pair), ..Layout::default() };
    for (text, pair) in [(beside, [1, 3]), ("0 -7.5 -1 0 x\n1 2 -3 5 y\n0 -8 -2 1 x\n1 0.5 -4 6 y\n", [2, 4])] {
        let found = read(text, columns(pair)).unwrap();
        assert!(found.frames == [A, B] && found.remark.unwrap().contains("blocks of 2 lines"), "{text:?}");
    }
    refused(read("9 1 2 3\n9 4 nan 6\n", columns([2, 4])), &["line 2, column 3", "sensor.dead"]);
    let skip = Layout { skip_lines: 2, ..Layout::default() };
    assert_eq!(read("1 2 3\n9 9 9\n1 2 3\n4 5 6\n", skip.clone()).unwrap().frames, [[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]]);
    assert_eq!(read(&format!("1,2,3\nanything: 5\n{LINES}"), skip).unwrap().frames, [A, B]);
}

#[test]
fn blocks_have_one_unit() {
    let text = "SITE Community Hospital\nUNITS kPa\n1 2 3\n4 5 6\n\nUNITS psi\n1 2 3\n4 5 6\n";
    refused(read(text, 0), &["line 6", "unit psi", "line 2 says kPa", "all frames in one unit"]);
    assert_eq!(read(&text.replace("psi", "kPa"), 0).unwrap().frames[0][0], -1000.0);
    let later = "1 2 3\n4 5 6\n\nUNITS kPa\n1 2 3\n4 5 6\n";
    refused(read(later, 0), &["line 4", "unit kPa", "the frames above have none"]);
    assert_eq!(read("SITE Community Bar\n1 2 3\n4 5 6\n", 0).unwrap().frames[0][0], 1.0);
}

/// A row that is lost shifts no other into its place.
#[test]
fn labels_of_rows_keep_their_order() {
    let text = "a,1,2,3\nb,4,5,6\n\na,1,2,3\nb,4,5,6\n\na,1,2,3\nb,4,5,6\n".replace('\n', "\r\n");
    assert_eq!(read(&text, 0).unwrap().frames.len(), 3);
    let lost = "a,1,2,3\nb,4,5,6\nb,4,5,6\na,1,2,3\na,7,8,9\nb,4,5,6\n";
    refused(read(lost, 0), &["line 3", "the label of another row"]);
    let some = read(lost, Layout { skip_bad: true, ..Layout::default() }).unwrap();
    assert_eq!((some.frames.len(), some.skipped), (2, vec![1]));
}

/// Numbers of rows say which is which; a file that begins within a frame is none of these.
#[test]
fn rows_stand_by_their_numbers() {
    let mut tall = pad("");
    [tall.sensor.columns, tall.sensor.rows] = [2, 3];
    let read = |text: &str, labels: usize| read_bytes("f.csv", text.as_bytes(), &tall, labels);
    let rows = |numbers: [u8; 3]| numbers.map(|row| format!("{row},{row},{row}5\n")).concat();
    let expected = [0.0, 5.0, 1.0, 15.0, 2.0, 25.0];
    for (numbers, between) in [([2, 1, 0], ""), ([2, 1, 0], "\n"), ([1, 2, 0], "\n"), ([0, 2, 1], "\n")] {
        for labels in [0, 1] {
            let found = read(&[rows(numbers), rows(numbers)].join(between), labels).unwrap();
            assert!(found.frames == [expected; 2], "{numbers:?} {between:?}");
            assert!(found.remark.unwrap().contains("numbers of the rows, which say which is which"));
        }
    }
    // In any column before the values, behind a word, and as letters.
    for (labels, of) in [
        (2, (|frame, row| format!("{frame},{row}")) as fn(u8, u8) -> String),
        (2, |frame, row| format!("{row},0.{frame}")),
        (1, |_, row| format!("R{row}")),
        (0, |_, row| format!("R{row}")),
        (1, |_, row| char::from(b'A' + row).to_string()),
    ] {
        let text: String =
            (0..3).flat_map(|frame| [2, 1, 0].map(|row| format!("{},{row},{row}5\n", of(frame, row)))).collect();
        assert_eq!(read(&text, labels).unwrap().frames, [expected; 3], "{text}");
    }
    let sides = read("R,1,2\nL,3,4\nM,5,6\n", 1).unwrap();
    assert_eq!(sides.frames, [[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]], "no letters in turn");
    refused(
        read(&[rows([1, 2, 0]), rows([1, 2, 0])].concat(), 1),
        &["line 1", "began within a frame", "--skip-lines N"],
    );
}

/// Names of columns that stand the other way round would mirror the grid.
#[test]
fn columns_of_blocks_stand_in_their_order() {
    let rows = "1,2,3\n4,5,6\n";
    for names in ["C3,C2,C1\n", "frame 0,C3,C2,C1\n"] {
        let with = ["line 1", "3", "1, are not in the order of the taxels"];
        refused(read(&format!("{names}{rows}{names}{rows}"), 0), &with);
    }
    refused(read(",2,1,0\n0,1,2,3\n1,4,5,6\n", 0), &["line 1", "2 to 0, are not in the order"]);
    assert_eq!(read(&format!("C1,C2,C3\n{rows}{rows}"), 0).unwrap().frames.len(), 2);
}

/// With columns behind the values, a decimal comma would shift them.
#[test]
fn blocks_with_columns_have_rows_of_one_width() {
    let layout = |skip_bad: bool| Layout { columns: Some([2, 4]), skip_bad, ..Layout::default() };
    let text = "0,1,2,3,9\n1,4,5,6,9\n\n0,01,10,20,30,9\n1,4,5,6,9\n";
    refused(read(text, layout(false)), &["line 4", "6 cells where the first row of the blocks has 5"]);
    assert_eq!(read(text, layout(true)).unwrap().skipped, [1]);
}

/// The number of its frame and a time before each row.
#[test]
fn rows_behind_the_number_of_their_frame() {
    let text = "frame,t,a,b,c\n7,0.00,-7.5,-1,0\n7,0.01,2,-3,5\n8,0.02,-8,-2,1\n8,0.03,0.5,-4,6\n";
    both(read(text, 2));
    both(read(&text.replace(",0.01", ",0.00"), 2));
    both(read(&text.replace("8,0.02", "\n8,0.02"), 2));
    // Rows of two frames are lost.
    let more = format!("{text}9,0.04,1,2,3\n10,0.05,4,5,6\n");
    refused(read(&more, 2), &["line 7", "a block of 1 row ends here where the sensor has 2"]);
    let some = read(&more, Layout { labels: 2, skip_bad: true, ..Layout::default() });
    assert_eq!(both(some).skipped, [2, 3]);
    let columns = Layout { columns: Some([3, 5]), ..Layout::default() };
    refused(read(&more, columns), &["line 7", "a block of 1 row ends here where the sensor has 2"]);
    // A clock that ticks within a frame is no number of it.
    let ticks = "0,-7.5,-1,0\n1,2,-3,5\n1,-8,-2,1\n2,0.5,-4,6\n2,-7.5,-1,0\n3,2,-3,5\n";
    assert_eq!(read(ticks, 1).unwrap().frames, [A, B, A]);
}
