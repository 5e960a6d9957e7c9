//! A design that was made from another one, and the files beside it: where they go, and what they must not overwrite.

use std::fs;
use std::path::{Path, PathBuf};

use toml_edit::{DocumentMut, Item, TableLike};

use crate::design::{CALIBRATION_FILE, CURVE_FILE, Design, DesignError, JointConstants, WEIGHTS_FILE};

/// Why a design is not written.
#[derive(Debug, thiserror::Error)]
pub enum ResolvedError {
    /// The design that it was made from.
    #[error(transparent)]
    Design(#[from] DesignError),
    /// An output is an input, or another design's calibration is where this one's would be, in words.
    #[error("{0}")]
    Taken(String),
}

/// Refuses an output that is one of the inputs.
///
/// # Errors
///
/// [`ResolvedError::Taken`].
pub fn keep_apart(out: &Path, inputs: &[impl AsRef<Path>]) -> Result<(), ResolvedError> {
    let same = |input: &&Path| match (out.canonicalize(), input.canonicalize()) {
        (Ok(out), Ok(input)) => out == input,
        _ => false,
    };
    match inputs.iter().map(AsRef::as_ref).find(same) {
        Some(input) => Err(ResolvedError::Taken(format!(
            "{}: the output would overwrite the input {}; choose another name",
            out.display(),
            input.display()
        ))),
        None => Ok(()),
    }
}

/// Where a resolved design goes, and the files that it names.
pub struct Resolved<'a> {
    design: &'a Path,
    /// Whether the calibration and its curve are new too, and have the design's own name, as weights always have.
    is_anew: bool,
    /// The file that it was made from, whose comments it keeps.
    source: Option<String>,
}

impl<'a> Resolved<'a> {
    /// The design at `out`, made from the one at `path` and what that names: none of it is overwritten, nor another
    /// calibration than that of the design.
    ///
    /// # Errors
    ///
    /// [`ResolvedError`].
    pub fn new(design: &Design, path: &Path, out: &'a Path) -> Result<Self, ResolvedError> {
        let inputs = Design::inputs_at(path)?;
        Ok(Self { source: fs::read_to_string(path).ok(), ..Self::beside(design, &inputs, out)? })
    }

    /// The same of a design that was made from these files, of none perhaps.
    ///
    /// # Errors
    ///
    /// [`ResolvedError::Taken`], also for a calibration that is not the design's.
    pub fn beside(design: &Design, inputs: &[PathBuf], out: &'a Path) -> Result<Self, ResolvedError> {
        let resolved = Self { design: out, is_anew: false, source: None };
        keep_apart(out, inputs)?;
        keep_apart(&resolved.path(WEIGHTS_FILE), inputs)?;
        if design.input.calibration.is_some() && resolved.path(CALIBRATION_FILE).exists() {
            resolved.same_calibration(design)?;
        }
        Ok(resolved)
    }

    /// As [`Resolved::new`], of a design whose calibration is new: all its files have its own name.
    ///
    /// # Errors
    ///
    /// [`ResolvedError`].
    pub fn anew(path: &Path, out: &'a Path) -> Result<Self, ResolvedError> {
        let inputs = Design::inputs_at(path)?;
        let source = fs::read_to_string(path).ok();
        let resolved = Self { design: out, is_anew: true, source };
        resolved.all().iter().try_for_each(|output| keep_apart(output, &inputs))?;
        Ok(resolved)
    }

    /// Every place at which something may be written, whatever the design turns out to name.
    pub fn all(&self) -> Vec<PathBuf> {
        let files = [CALIBRATION_FILE, CURVE_FILE, WEIGHTS_FILE].map(|name| self.path(name));
        files.into_iter().chain([self.design.to_path_buf()]).collect()
    }

    /// All that is to be written for a design, the design last, which begins with a remark. A calibration of the common
    /// name that is there already stays as somebody wrote it.
    pub fn contents(&self, design: &Design, remark: &str) -> Vec<(PathBuf, String)> {
        let files = design.files().into_iter().map(|(name, content)| (self.path(name), content));
        let files = files.filter(|(path, _)| self.is_anew || *path != self.path(CALIBRATION_FILE) || !path.exists());
        let keys = design.to_toml_with(|name| self.named(name));
        let commented = self.source.as_ref().and_then(|source| with_comments(source, &keys));
        let text = format!("# {remark}\n{}", commented.unwrap_or(keys));
        files.chain([(self.design.to_path_buf(), text)]).collect()
    }

    /// Whether a file is one of those that are written for a design.
    pub fn holds(&self, design: &Design, file: &Path) -> bool {
        file == self.design || design.files().iter().any(|(name, _)| file == self.path(name))
    }

    /// The place of a file that the design names.
    fn path(&self, name: &str) -> PathBuf {
        folder(self.design).join(self.named(name))
    }

    /// What the design calls it.
    fn named(&self, name: &str) -> String {
        let stem = self.design.file_stem().unwrap_or_default().display();
        if self.is_anew || name == WEIGHTS_FILE { format!("{stem}.{name}") } else { name.to_owned() }
    }

    fn same_calibration(&self, design: &Design) -> Result<(), ResolvedError> {
        let mut plain = design.clone();
        *plain.algorithm.joint = JointConstants::default();
        match Design::from_toml(&plain.to_toml(), &self.design.display().to_string()) {
            Ok(again) if again.input.calibration == design.input.calibration => Ok(()),
            _ => Err(ResolvedError::Taken(format!(
                "{}: is another calibration than that of the design; write --out to another folder",
                self.path(CALIBRATION_FILE).display()
            ))),
        }
    }
}

/// What begins the first line of a resolved design.
const RESOLVED: &str = "# Resolved by";

/// The text of a design file with other keys, and its comments. `None` of a file with a base, whose keys stand elsewhere.
fn with_comments(source: &str, keys: &str) -> Option<String> {
    let own = if source.starts_with(RESOLVED) { source.split_once('\n')?.1 } else { source };
    let mut document: DocumentMut = own.parse().ok()?;
    if document.contains_key("base") {
        return None;
    }
    update(document.as_table_mut(), keys.parse::<DocumentMut>().ok()?.as_table());
    Some(document.to_string())
}

/// Makes the keys of a table those of another one; what stays keeps its comments.
fn update(table: &mut dyn TableLike, keys: &dyn TableLike) {
    let gone: Vec<String> = table.iter().map(|(key, _)| key.to_owned()).filter(|key| !keys.contains_key(key)).collect();
    for key in gone {
        table.remove(&key);
    }
    for (key, item) in keys.iter() {
        match (table.get_mut(key), item) {
            (Some(Item::Table(old)), Item::Table(new)) => update(old, new),
            // A table of the printed keys may stand in a line here, if it fits.
            (Some(Item::Value(old)), new)
                if new.as_table().is_none_or(|new| !new.iter().any(|(_, item)| item.is_table())) =>
            {
                let decor = old.decor().clone();
                *old = new.clone().into_value().unwrap_or_else(|_| old.clone());
                *old.decor_mut() = decor;
            }
            _ => {
                table.remove(key);
                let mut item = item.clone();
                if let Item::Table(new) = &mut item {
                    new.set_position(None);
                }
                table.insert(key, item);
            }
        }
    }
}

/// The folder of a file.
pub fn folder(file: &Path) -> &Path {
    match file.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_the_new_ones_and_comments_stay() {
        let gone = "[algorithm.correction]\nhidden = 4\nfile = \"a.csv\"\n";
        let old = format!("# mine\n[algorithm]\nseed = 1 # gone\ngain = 1.0 # stays\n{gone}");
        let new = "[algorithm]\ngain = 2.0\n";
        let kept = "# mine\n[algorithm]\ngain = 2.0 # stays\n";
        assert_eq!(with_comments(&old, new).as_deref(), Some(kept));
        let correction = "[algorithm.correction]\nfile = \"b.csv\"\n";
        let found = with_comments(&old, &format!("{new}{correction}"));
        assert_eq!(found, Some(format!("{kept}{correction}")));
    }
}
