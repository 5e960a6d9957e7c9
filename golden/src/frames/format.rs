//! Files that people give for frames, and that are none.

/// How the first bytes of a file begin, what it then is, and what to do.
const OTHERS: [(&[u8], &str, &str); 4] = [
    (
        b"PK\x03\x04",
        "an archive, as numpy.savez (.npz) and spreadsheets (.xlsx) make them",
        "save the array alone, numpy.save(\"frames.npy\", numpy.load(\"frames.npz\")[\"NAME\"]), or the sheet as CSV",
    ),
    (b"\x89HDF\r\n", "HDF5, or of MATLAB 7.3", "save the frames alone with numpy.save, or as CSV"),
    (b"MATLAB 5.0 MAT-file", "of MATLAB", "save the frames with writematrix(frames, \"frames.csv\")"),
    (b"\x1f\x8b", "compressed by gzip", "unpack it with gunzip"),
];

/// What a file is that holds no frames by its format, and what to do.
pub(super) fn other(bytes: &[u8]) -> Option<(&'static str, &'static str)> {
    // A mark, and a digit or a sign in two bytes.
    if let [0xff, 0xfe, _, 0, ..] | [0xfe, 0xff, 0, ..] = bytes {
        return Some(("text in UTF-16", "save it as CSV in UTF-8"));
    }
    OTHERS.iter().find(|(begin, ..)| bytes.starts_with(begin)).map(|&(_, what, remedy)| (what, remedy))
}
