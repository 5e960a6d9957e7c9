//! The commands, one file each.

pub mod bench;
pub mod calibrate;
pub mod choose;
pub mod scene;
pub mod solve;

use std::error::Error;
use std::path::{Path, PathBuf};
use std::time::Duration;

use golden::design::{CALIBRATION_FILE, Design};
use indicatif::ProgressBar;

/// Says what is being done, on a terminal only, until it is dropped.
pub struct Stage(ProgressBar);

impl Stage {
    /// Work of unknown length begins.
    pub fn new(what: &'static str) -> Self {
        let bar = ProgressBar::new_spinner().with_message(what);
        bar.enable_steady_tick(Duration::from_millis(100));
        Self(bar)
    }
}

impl Drop for Stage {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}

/// Refuses an output that is one of the inputs.
pub fn keep_apart(out: &Path, inputs: &[&Path]) -> Result<(), String> {
    let same = |input: &&&Path| match (out.canonicalize(), input.canonicalize()) {
        (Ok(out), Ok(input)) => out == input,
        _ => false,
    };
    match inputs.iter().find(same) {
        Some(input) => Err(format!(
            "{}: the output would overwrite the input {}; choose another name",
            out.display(),
            input.display()
        )),
        None => Ok(()),
    }
}

/// The calibration file to be written beside `out`, unless it is there already; another one is not overwritten.
pub fn calibration_beside(design: &Design, out: &Path) -> Result<Option<(PathBuf, String)>, Box<dyn Error>> {
    let Some(content) = design.calibration_csv() else { return Ok(None) };
    let file = folder(out).join(CALIBRATION_FILE);
    if !file.exists() {
        return Ok(Some((file, content)));
    }
    let same = Design::from_toml(&design.to_toml(), &out.display().to_string())
        .is_ok_and(|again| again.input.calibration == design.input.calibration);
    if same {
        return Ok(None);
    }
    let file = file.display();
    Err(format!("{file}: is another calibration than that of the design; write --out to another folder").into())
}

/// The folder of a file.
pub fn folder(file: &Path) -> &Path {
    match file.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    }
}
