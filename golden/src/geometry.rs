//! The sensor that a file of frames belongs to, in a small file beside it.
//!
//! Frames are numbers and do not tell how far apart their taxels lie. `golden scene` writes `FRAMES.sensor.toml` beside
//! its frames, with the `[sensor]` table of the scene; who reads the frames compares it with the design. Where there is
//! no such file, there is nothing to compare.

use std::path::{Path, PathBuf};

use serde::Deserialize;

use crate::design::{DesignError, RawSensor, Sensor, syntax_position};

/// Frames of another sensor than the design's.
#[derive(Debug, thiserror::Error)]
pub enum GeometryError {
    /// The file beside the frames cannot be read, or holds no sensor.
    #[error(transparent)]
    File(#[from] DesignError),
    /// Another sensor.
    #[error(
        "{}: the frames belong to {}, as {beside} says, and the design {} to {}; make frames for the design with \
         `golden scene --design`, or remove {beside} if the frames are others",
        .0.path.display(), .0.frames, .0.design_name, .0.design, beside = .0.beside.display()
    )]
    Other(Box<OtherSensor>),
}

/// Frames and a design that do not belong together.
#[derive(Debug)]
pub struct OtherSensor {
    /// The frames.
    pub path: PathBuf,
    /// The file beside them.
    pub beside: PathBuf,
    /// Their sensor.
    pub frames: Sensor,
    /// Name of the design.
    pub design_name: String,
    /// The design's sensor.
    pub design: Sensor,
}

/// The place of the sensor of a frame file: `frames.csv` has it in `frames.sensor.toml`.
pub fn beside(frames: &Path) -> PathBuf {
    frames.with_extension("sensor.toml")
}

/// The content of that file.
pub fn to_toml(sensor: &Sensor) -> String {
    let Sensor { columns, rows, pitch_mm: [x, y], depth_mm } = sensor;
    format!(
        "# The sensor of the frames beside this file; who reads them compares it with the design.\n\
         [sensor]\ncolumns = {columns}\nrows = {rows}\npitch_mm = [{x:?}, {y:?}]\ndepth_mm = {depth_mm:?}\n"
    )
}

/// Compares the sensor of a frame file, if it is known, with a design's.
///
/// # Errors
///
/// [`GeometryError`], with both sensors and what to do.
pub fn compare(frames: &Path, design_name: &str, design: &Sensor) -> Result<(), GeometryError> {
    let beside = beside(frames);
    if !beside.is_file() {
        return Ok(());
    }
    let text = std::fs::read_to_string(&beside).map_err(|source| DesignError::Read { path: beside.clone(), source })?;
    let found = parse(&text, &beside.display().to_string())?;
    if found == *design {
        return Ok(());
    }
    let (path, design_name, design) = (frames.to_path_buf(), design_name.to_owned(), design.clone());
    Err(GeometryError::Other(Box::new(OtherSensor { path, beside, frames: found, design_name, design })))
}

fn parse(text: &str, origin: &str) -> Result<Sensor, DesignError> {
    #[derive(Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Raw {
        sensor: RawSensor,
    }
    let raw: Raw = toml::from_str(text).map_err(|error| syntax_position(&error, text, origin))?;
    raw.sensor.check(origin)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sensor() -> Sensor {
        Sensor { columns: 10, rows: 7, pitch_mm: [4.0, 2.1], depth_mm: 3.3 }
    }

    #[test]
    fn what_is_written_reads_back() {
        assert_eq!(parse(&to_toml(&sensor()), "x").expect("a sensor"), sensor());
    }

    #[test]
    fn another_sensor_is_refused_and_none_is_not() {
        let folder = tempfile::tempdir().expect("a folder");
        let frames = folder.path().join("push.csv");
        compare(&frames, "pad", &sensor()).expect("nothing to compare");
        std::fs::write(beside(&frames), to_toml(&sensor())).expect("writable");
        compare(&frames, "pad", &sensor()).expect("the same");
        for other in [
            Sensor { pitch_mm: [4.0, 4.0], ..sensor() },
            Sensor { columns: 7, rows: 10, ..sensor() },
            Sensor { depth_mm: 3.0, ..sensor() },
        ] {
            let said = compare(&frames, "pad", &other).expect_err("another sensor").to_string();
            for part in
                ["push.csv", "push.sensor.toml", "10 x 7 taxels of 4 x 2.1 mm, 3.3 mm deep", "golden scene --design"]
            {
                assert!(said.contains(part), "no {part:?} in: {said}");
            }
            assert!(said.contains(&other.to_string()), "{said}");
        }
        std::fs::write(beside(&frames), "[sensor]\ncolumns = 3\n").expect("writable");
        let said = compare(&frames, "pad", &sensor()).expect_err("no sensor").to_string();
        assert!(said.contains("push.sensor.toml"), "{said}");
    }
}
