//! `sptfra solve --out -`: forces line by line, each as soon as its frame is there.

use std::error::Error;
use std::io::{self, BufRead, Write};
use std::path::Path;

use golden::check::check;
use golden::design::Design;
use golden::forces;
use golden::frames::{FrameError, FrameLines};
use golden::solver::{Solution, Solver, Status};

use super::recording::{Recording, is_standard, warn};

/// Of a stream so many frames are looked at, whether they are wrong.
const LOOKED_AT: usize = 32;

/// Solves frames, of a file or of standard input, and prints a header and a line for each. Says on standard error what is
/// suspicious: of a file at once, of a stream after its first frames.
pub fn run(design: &Path, frames: &Recording, with_field: bool) -> Result<(), Box<dyn Error>> {
    let design = Design::load(design)?;
    let solver = Solver::new(&design)?;
    let origin = Path::new("standard input");
    let mut lines = FrameLines::new(origin, &design, frames.layout.clone());
    let (mut input, mut line, mut said) = (io::stdin().lock(), Vec::new(), false);
    let mut next: Box<dyn FnMut() -> Result<Option<Vec<f64>>, FrameError>> = if is_standard(frames.file) {
        Box::new(move || {
            loop {
                line.clear();
                let read = input.read_until(b'\n', &mut line);
                let is_end = read.map_err(|source| FrameError::Read { path: origin.to_path_buf(), source })? == 0;
                let frame = if is_end { Ok(None) } else { lines.frame(&line) };
                if !is_end && matches!(frame, Ok(None)) {
                    continue;
                }
                if let Some(remark) = lines.remark().filter(|_| !std::mem::replace(&mut said, true)) {
                    eprintln!("note: {remark}");
                }
                return frame;
            }
        })
    } else {
        let all = frames.read(&design)?;
        warn(&check(&design, &all, Some(solver.matrices())));
        let mut all = all.into_iter();
        Box::new(move || Ok(all.next()))
    };
    let mut workspace = solver.workspace();
    let mut solution = Solution::zeros(Status::default(), 0);
    let taxels = if with_field { solver.field_length() } else { 0 };
    let mut line = forces::columns(solver.records(), taxels).join(",") + "\n";
    // Who reads knows the columns before the first frame.
    let mut goes_on = put(&line)?;
    let mut first = is_standard(frames.file).then(Vec::new);
    let (mut lines, mut cut): (u64, Option<FrameError>) = (0, None);
    while goes_on {
        let frame = match next() {
            Ok(Some(frame)) => frame,
            // A stream of that line alone has told nothing.
            Ok(None) => match cut.filter(|_| lines == 1) {
                Some(error) => return Err(error.into()),
                None => break,
            },
            // Who opens a port while a frame goes through it gets the end of one.
            Err(error) if lines == 0 && is_standard(frames.file) && error.is_of_a_cut_line() => {
                eprintln!("warning: {error}; the first line is passed over");
                lines += 1;
                cut = Some(error);
                continue;
            }
            Err(error) => return Err(error.into()),
        };
        lines += 1;
        solver.solve_into(&mut workspace, &frame, &mut solution)?;
        line.clear();
        forces::push_line(&mut line, &forces::row(&solution, with_field));
        goes_on = put(&line)?;
        if let Some(some) = &mut first {
            some.push(frame);
            if some.len() == LOOKED_AT {
                warn(&check(&design, some, Some(solver.matrices())));
                first = None;
            }
        }
    }
    if let Some(some) = first.filter(|some| !some.is_empty()) {
        warn(&check(&design, &some, Some(solver.matrices())));
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
