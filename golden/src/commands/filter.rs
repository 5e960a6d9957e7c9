//! `golden solve --out -`: forces line by line, each as soon as its frame is there.

use std::error::Error;
use std::io::{self, Write};
use std::path::Path;

use golden::design::Design;
use golden::forces;
use golden::frames::{FrameError, FrameLines, FrameStream};
use golden::solver::{Solution, Solver, Status};

use super::Recording;

/// The name of standard input and output.
pub const STANDARD: &str = "-";

/// Whether a file's name means standard input or output.
pub fn is_standard(path: &Path) -> bool {
    path == STANDARD
}

/// Solves frames, of a file or of standard input, and prints a header and a line for each.
///
/// Whether frames look wrong is not asked: that takes all of them.
pub fn run(design: &Path, frames: &Recording, with_field: bool) -> Result<(), Box<dyn Error>> {
    let design = Design::load(design)?;
    let solver = Solver::new(&design)?;
    let lines = FrameLines::new(Path::new("standard input"), &design, frames.labels);
    let mut stream = FrameStream::new(io::stdin().lock(), lines);
    let mut next: Box<dyn FnMut() -> Result<Option<Vec<f64>>, FrameError>> = if is_standard(frames.file) {
        Box::new(|| stream.next_frame())
    } else {
        let mut all = frames.read(&design)?.into_iter();
        Box::new(move || Ok(all.next()))
    };
    let mut workspace = solver.workspace();
    let mut solution = Solution::zeros(Status::default(), 0);
    let taxels = if with_field { solver.field_length() } else { 0 };
    let mut line = forces::columns(solver.records(), taxels).join(",") + "\n";
    // Who reads knows the columns before the first frame.
    let mut goes_on = put(&line)?;
    while goes_on && let Some(frame) = next()? {
        solver.solve_into(&mut workspace, &frame, &mut solution)?;
        line.clear();
        forces::push_line(&mut line, &forces::row(&solution, with_field));
        goes_on = put(&line)?;
    }
    Ok(())
}

/// Prints a line now. False if nobody reads any more, which is no error.
fn put(line: &str) -> io::Result<bool> {
    let mut out = io::stdout().lock();
    match out.write_all(line.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(false),
        result => result.map(|()| true),
    }
}
