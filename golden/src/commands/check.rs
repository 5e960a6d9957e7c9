//! `golden check`: what is wrong with frames.

use std::error::Error;
use std::path::Path;

use golden::check::{Beyond, beyond, check};
use golden::design::Design;
use golden::matrices::Matrices;
use golden::progress::Progress;
use serde::Serialize;

use super::{Recording, is_standard};

#[derive(Serialize)]
struct Report<'a> {
    design: &'a str,
    frames: usize,
    findings: Vec<Line>,
    beyond: Beyond,
}

#[derive(Serialize)]
struct Line {
    kind: String,
    message: String,
}

/// What is asked besides.
pub struct Asked<'a> {
    /// Nothing presses in the frames.
    pub rest: bool,
    /// Where the calibration goes that frames at rest give.
    pub out: Option<&'a Path>,
    pub json: bool,
}

/// Checks the frames of a file; an error if anything is found.
pub fn run(path: &Path, recording: &Recording, asked: &Asked) -> Result<(), Box<dyn Error>> {
    if is_standard(recording.file) {
        return Err("--frames -: this looks at all frames of a recording; write them into a file first".into());
    }
    let design = Design::load(path)?;
    let frames = recording.read(&design)?;
    let &Asked { rest, out, json } = asked;
    if rest {
        return super::rest::run(path, &design, recording, &frames, out, json);
    }
    let beyond = beyond(&design, &frames);
    let matrices = {
        let _progress = Progress::of("matrices");
        Matrices::of(&design).map_err(|error| format!("{}: {error}", design.name))?
    };
    let findings = check(&design, &frames, Some(&matrices));
    let file = recording.file.display();
    if json {
        let line = |kind: String, message: String| Line { kind, message };
        let findings = findings.iter().map(|found| line(found.kind.to_string(), found.to_string())).collect();
        let report = Report { design: &design.name, frames: frames.len(), findings, beyond };
        say!("{}", serde_json::to_string_pretty(&report)?);
    } else {
        for finding in &findings {
            say!("{finding}");
        }
        if findings.is_empty() {
            say!("{}: {} frames of {file}, nothing suspicious", design.name, frames.len());
        }
        if findings.is_empty() || beyond.readings > 0 {
            say!("{beyond}");
        }
    }
    match findings.len() {
        0 => Ok(()),
        1 => Err(format!("{file}: one thing to look at before the forces are trusted").into()),
        count => Err(format!("{file}: {count} things to look at before the forces are trusted").into()),
    }
}
