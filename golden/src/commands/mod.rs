//! The commands, one file each.

pub mod bench;
pub mod calibrate;
pub mod calibrate_recorded;
pub mod check;
pub mod choose;
pub mod scene;
pub mod solve;

use std::error::Error;
use std::path::{Path, PathBuf};
use std::time::Duration;

use golden::check::Finding;
use golden::design::{CALIBRATION_FILE, CURVE_FILE, Design, FileNames, JointConstants, WEIGHTS_FILE};
use golden::frames::{self, FrameError};
use golden::geometry;
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

/// A file of frames.
pub struct Recording<'a> {
    pub file: &'a Path,
    /// Columns of labels before the values.
    pub labels: usize,
}

impl Recording<'_> {
    /// The frames, which may not be known to be those of another sensor than the design's.
    pub fn read(&self, design: &Design) -> Result<Vec<Vec<f64>>, FrameError> {
        geometry::compare(self.file, &design.name, &design.sensor)?;
        frames::read_frames_of(self.file, design, self.labels)
    }
}

/// Says on standard error what is suspicious.
pub fn warn(findings: &[Finding]) {
    for finding in findings {
        eprintln!("warning: {finding}");
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

/// Where a resolved design goes, and the files that it names.
pub struct Resolved<'a> {
    design: &'a Path,
    names: FileNames,
}

impl<'a> Resolved<'a> {
    /// The design at `out`, made from the one at `path` and what that names: none of it is overwritten, nor another
    /// calibration than that of the design.
    pub fn new(design: &Design, path: &Path, out: &'a Path) -> Result<Self, Box<dyn Error>> {
        let FileNames { weights, .. } = FileNames::of(&stem(out));
        let resolved = Self { design: out, names: FileNames { weights, ..FileNames::default() } };
        resolved.keep_apart(path, &[WEIGHTS_FILE])?;
        if design.input.calibration.is_some() && resolved.path(CALIBRATION_FILE).exists() {
            resolved.same_calibration(design)?;
        }
        Ok(resolved)
    }

    /// As [`Resolved::new`] of a design whose calibration is new: all its files have its own name.
    pub fn anew(path: &Path, out: &'a Path) -> Result<Self, Box<dyn Error>> {
        let resolved = Self { design: out, names: FileNames::of(&stem(out)) };
        resolved.keep_apart(path, &[WEIGHTS_FILE, CALIBRATION_FILE, CURVE_FILE])?;
        Ok(resolved)
    }

    /// Refuses to overwrite the design that this one is made from, or a file of it.
    fn keep_apart(&self, path: &Path, files: &[&str]) -> Result<(), Box<dyn Error>> {
        let named = Design::files_named_in(path)?;
        let inputs: Vec<&Path> = named.iter().map(AsRef::as_ref).chain([path]).collect();
        keep_apart(self.design, &inputs)?;
        files.iter().try_for_each(|file| keep_apart(&self.path(file), &inputs))?;
        Ok(())
    }

    /// All that is to be written for a design, the design last, which begins with a remark. A calibration of the common
    /// name that is there already stays as somebody wrote it.
    pub fn contents(&self, design: &Design, remark: &str) -> Vec<(PathBuf, String)> {
        let common = self.names.calibration == CALIBRATION_FILE;
        let files = design.files().into_iter().map(|(name, content)| (self.path(name), content));
        let files = files.filter(|(path, _)| !common || *path != self.path(CALIBRATION_FILE) || !path.exists());
        let text = format!("# {remark}\n{}", design.to_toml_with(&self.names));
        files.chain([(self.design.to_path_buf(), text)]).collect()
    }

    /// Every place at which something may be written for a design, whatever it turns out to name.
    pub fn all(&self) -> Vec<PathBuf> {
        let files = [CALIBRATION_FILE, CURVE_FILE, WEIGHTS_FILE].map(|name| self.path(name));
        files.into_iter().chain([self.design.to_path_buf()]).collect()
    }

    /// Whether a file is one of those that are written for a design.
    pub fn holds(&self, design: &Design, file: &Path) -> bool {
        file == self.design || design.files().iter().any(|(name, _)| file == self.path(name))
    }

    /// The place of a file that the design names.
    fn path(&self, name: &str) -> PathBuf {
        folder(self.design).join(self.names.of_file(name))
    }

    fn same_calibration(&self, design: &Design) -> Result<(), String> {
        let mut plain = design.clone();
        *plain.algorithm.joint = JointConstants::default();
        match Design::from_toml(&plain.to_toml(), &self.design.display().to_string()) {
            Ok(again) if again.input.calibration == design.input.calibration => Ok(()),
            _ => Err(format!(
                "{}: is another calibration than that of the design; write --out to another folder",
                self.path(CALIBRATION_FILE).display()
            )),
        }
    }
}

fn stem(file: &Path) -> String {
    file.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

/// The folder of a file.
pub fn folder(file: &Path) -> &Path {
    match file.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    }
}
