//! Files that people give for frames, and that are none.

/// How the first bytes of a file begin, what it then is, and what to do.
const OTHERS: [(&[u8], &str, &str); 13] = [
    (
        b"PK\x03\x04",
        "an archive, as numpy.savez (.npz) and spreadsheets (.xlsx) make them",
        "save the array alone, numpy.save(\"frames.npy\", numpy.load(\"frames.npz\")[\"NAME\"]), or the sheet as CSV",
    ),
    (b"\x89HDF\r\n", "HDF5, or of MATLAB 7.3", "save the frames alone with numpy.save, or as CSV"),
    (b"MATLAB 5.0 MAT-file", "of MATLAB", "save the frames with writematrix(frames, \"frames.csv\")"),
    (b"\x1f\x8b", "compressed by gzip", "unpack it with gunzip"),
    (b"BZh", "compressed by bzip2", "unpack it with bunzip2"),
    (b"\xfd7zXZ\0", "compressed by xz", "unpack it with unxz"),
    (b"\x28\xb5\x2f\xfd", "compressed by Zstandard", "unpack it with unzstd"),
    (b"PAR1", "Parquet", "save the columns of the taxels as CSV: pandas.read_parquet(\"FILE\").to_csv(\"frames.csv\")"),
    (b"#ROSBAG", "a bag of ROS 1", "save the messages of its topic as CSV: rostopic echo -b FILE -p TOPIC"),
    (b"\x89MCAP0\r\n", "MCAP, as ROS 2 records it", "save the messages of its topic as CSV, a line for each frame"),
    (
        b"SQLite format 3\0",
        "a database of SQLite",
        "save the table as CSV: sqlite3 -header -csv FILE \"select * from TABLE\"",
    ),
    (b"\x80", "a pickle of Python", "load it and save the array with numpy.save"),
    (b"\xd0\xcf\x11\xe0", "a spreadsheet (.xls)", "save the sheet as CSV"),
];

/// What a file is that holds no frames by its format, and what to do.
pub(super) fn other(bytes: &[u8]) -> Option<(&'static str, &'static str)> {
    let begin = bytes.trim_ascii_start();
    if begin.starts_with(b"[[") && !begin.iter().take(200).any(|&byte| byte == b',') {
        return Some(("an array as Python prints it", "save it with numpy.save, or numpy.savetxt"));
    }
    if begin.starts_with(b"{") || begin.starts_with(b"[{") || begin.starts_with(b"[[") {
        return Some(("JSON", "write the values of each frame on a line, separated by commas: jq -r '.values | @csv'"));
    }
    let first = begin.split(|byte| matches!(byte, b'\n' | b'\r')).next().unwrap_or(begin);
    if first.windows(4).any(|four| four == b" -> ") {
        return Some((
            "a serial monitor's, which writes a time and an arrow before each line",
            "switch its timestamps off, or cut them: sed 's/.* -> //'",
        ));
    }
    OTHERS.iter().find(|(begin, ..)| bytes.starts_with(begin)).map(|&(_, what, remedy)| (what, remedy))
}
