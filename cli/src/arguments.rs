//! Arguments that several commands take.

use std::path::{Path, PathBuf};

use clap::builder::{PathBufValueParser, PossibleValuesParser, TypedValueParser};
use golden::design::is_name;
use golden::words;
use serde::de::DeserializeOwned;

/// Parses the place of a design file, whose ending may be left out: `pad` is `pad.toml` where there is no `pad`.
pub fn design_file() -> impl TypedValueParser<Value = PathBuf> {
    PathBufValueParser::new().map(with_ending)
}

/// Parses the place of a file of frames or forces to write: CSV, or `NumPy`'s by the ending `.npy`.
pub fn rows_file() -> impl TypedValueParser<Value = PathBuf> {
    PathBufValueParser::new().try_map(|path| match path.extension().and_then(|ending| ending.to_str()) {
        Some(ending) if ["npz", "xlsx", "mat", "h5"].contains(&ending.to_ascii_lowercase().as_str()) => {
            Err(format!("no .{ending} is written; the file is CSV, or NumPy's with the ending .npy"))
        }
        _ => Ok(path),
    })
}

/// The place of a design file: with the ending `.toml` where there is no file without.
pub fn with_ending(path: PathBuf) -> PathBuf {
    let mut longer = path.clone().into_os_string();
    longer.push(".toml");
    let longer = PathBuf::from(longer);
    if !path.exists() && longer.is_file() { longer } else { path }
}

/// The name of a design in a file: a design of its own, beside whose hardware that of the first one stays. Nothing if the
/// file is called what no module can be.
pub fn name_of(file: &Path) -> Option<String> {
    let name = file.file_stem()?.to_str()?.replace('-', "_");
    is_name(&name).then_some(name)
}

/// A latency to meet.
#[derive(clap::Args)]
pub struct Target {
    /// Take the fewest lanes whose latency is at most this many microseconds.
    #[arg(long, value_name = "US", value_parser = microseconds)]
    pub target_us: Option<f64>,
}

/// Parses a time.
fn microseconds(text: &str) -> Result<f64, String> {
    let time = text.parse().ok().filter(|time: &f64| *time > 0.0 && time.is_finite());
    time.ok_or_else(|| "give a time in microseconds, greater than 0, such as 15".to_owned())
}

/// Parses one of the words of an enum, those that serde knows its variants by.
pub fn word<T: DeserializeOwned + Clone + Send + Sync + 'static>() -> impl TypedValueParser<Value = T> {
    PossibleValuesParser::new(words_of::<T>()).try_map(|word| words::read::<T>(&word))
}

/// The words of an enum.
pub fn words_of<T: DeserializeOwned>() -> &'static [&'static str] {
    words::read::<T>("").err().map_or(&[], |unknown| unknown.allowed)
}

#[cfg(test)]
mod tests {
    use golden::design::PlanKind;

    use super::*;

    #[test]
    fn an_unknown_word_names_the_others() {
        let option = clap::Arg::new("plan").value_parser(word::<PlanKind>());
        let command = clap::Command::new("read").arg(option);
        let given = command.clone().get_matches_from(["read", "reduced"]);
        assert_eq!(given.get_one("plan"), Some(&PlanKind::Reduced));
        let refused = command.try_get_matches_from(["read", "Reduced"]).unwrap_err().to_string();
        assert!(refused.contains("[possible values: paper, reduced]"), "{refused}");
    }

    #[test]
    fn a_time_is_above_zero() {
        assert_eq!(microseconds("15"), Ok(15.0));
        for wrong in ["0", "-1", "inf", "nan", "soon"] {
            assert!(microseconds(wrong).is_err_and(|refused| refused.contains("greater than 0")), "{wrong}");
        }
    }

    #[test]
    fn the_ending_may_be_left_out() {
        let folder = tempfile::tempdir().expect("a folder");
        let [pad, file] = ["pad", "pad.toml"].map(|name| folder.path().join(name));
        assert_eq!(with_ending(pad.clone()), pad, "nothing is there: the message names what was given");
        std::fs::write(&file, "").expect("writable");
        assert_eq!(with_ending(pad.clone()), file);
        assert_eq!(with_ending(file.clone()), file);
        std::fs::write(&pad, "").expect("writable");
        assert_eq!(with_ending(pad.clone()), pad);
    }
}
