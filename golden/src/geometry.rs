//! The sensor that a file of frames belongs to, in a small file beside it.
//!
//! Frames are numbers and do not tell how far apart their taxels lie. `sptfra scene` writes `FRAMES.sensor.toml` beside
//! its frames, with the `[sensor]` table of the scene; who reads the frames compares it with the design. Frames in a pipe
//! have no file beside them, so a remark above them says the same. Where there is neither, there is nothing to compare.

use std::path::{Path, PathBuf};

use serde::Deserialize;

use crate::design::{DesignError, Sensor, syntax_position, text_of};

/// Frames of another sensor than the design's.
#[derive(Debug, thiserror::Error)]
pub enum GeometryError {
    /// The file beside the frames cannot be read, or holds no sensor.
    #[error(transparent)]
    File(#[from] DesignError),
    /// Another sensor: the file, both sensors and what to do.
    #[error("{0}")]
    Other(String),
}

/// The place of the sensor of a frame file: `frames.csv` has it in `frames.sensor.toml`.
pub fn beside(frames: &Path) -> PathBuf {
    frames.with_extension("sensor.toml")
}

/// The content of that file.
pub fn to_toml(sensor: &Sensor) -> String {
    format!(
        "# The sensor of the frames beside this file; who reads them compares it with the design.\n[sensor]\n{}",
        toml::to_string(sensor).unwrap_or_default()
    )
}

/// What a remark above the frames begins with.
const REMARK: &str = "# sensor = ";

/// The sensor as a line above frames as text, for those that have no file beside them.
pub fn remark(sensor: &Sensor) -> String {
    let Sensor { columns, rows, pitch_mm: [x, y], depth_mm } = sensor;
    format!("{REMARK}{{ columns = {columns}, rows = {rows}, pitch_mm = [{x:?}, {y:?}], depth_mm = {depth_mm:?} }}\n")
}

/// Compares the sensor that a remark names, if it is a line of [`remark`], with the one that frames are read for. `path` and
/// `line` are where it stands.
///
/// # Errors
///
/// [`GeometryError`], for another sensor and for a remark of that kind that names none.
pub fn compare_remark(remark: &[u8], path: &Path, line: usize, design: &Sensor) -> Result<(), GeometryError> {
    let Some(text) = std::str::from_utf8(remark).ok().filter(|text| text.starts_with(REMARK)) else { return Ok(()) };
    let found = parse(text.trim_start_matches("# "), &format!("{}, line {line}", path.display()))?;
    if found == *design {
        return Ok(());
    }
    Err(GeometryError::Other(format!(
        "{}, line {line}: the frames belong to {found}, as this remark says, and the design to {design}; make frames for the \
         design with `sptfra scene --design`, or leave the remark out if the frames are others",
        path.display()
    )))
}

/// Compares the sensor of a frame file, if it is known, with a design's.
///
/// # Errors
///
/// [`GeometryError`], with both sensors and what to do.
pub fn compare(frames: &Path, design_name: &str, design: &Sensor) -> Result<(), GeometryError> {
    compare_beside(frames, &beside(frames), design_name, design)
}

/// The same of any file of these frames, which the message names, and the file of their sensor.
pub(crate) fn compare_beside(
    path: &Path,
    beside: &Path,
    design_name: &str,
    design: &Sensor,
) -> Result<(), GeometryError> {
    if !beside.is_file() {
        return Ok(());
    }
    let text = text_of(beside)?;
    let (path, beside) = (path.display(), beside.display());
    let found = parse(&text, &beside.to_string())?;
    if found == *design {
        return Ok(());
    }
    Err(GeometryError::Other(format!(
        "{path}: the frames belong to {found}, as {beside} says, and the design {design_name} to {design}; make frames for \
         the design with `sptfra scene --design`, or remove {beside} if the frames are others"
    )))
}

fn parse(text: &str, origin: &str) -> Result<Sensor, DesignError> {
    #[derive(Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Raw {
        sensor: Sensor,
    }
    let raw: Raw = toml::from_str(text).map_err(|error| syntax_position(&error, text, origin))?;
    raw.sensor.checked(origin)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sensor() -> Sensor {
        Sensor { columns: 10, rows: 7, pitch_mm: [4.0, 2.1], depth_mm: 3.3 }
    }

    #[test]
    fn what_is_written_reads_back() {
        let text = to_toml(&sensor());
        assert!(text.ends_with("[sensor]\ncolumns = 10\nrows = 7\npitch_mm = [4.0, 2.1]\ndepth_mm = 3.3\n"), "{text}");
        assert_eq!(parse(&text, "x").expect("a sensor"), sensor());
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
                ["push.csv", "push.sensor.toml", "10 x 7 taxels of 4 x 2.1 mm, 3.3 mm deep", "sptfra scene --design"]
            {
                assert!(said.contains(part), "no {part:?} in: {said}");
            }
            assert!(said.contains(&other.to_string()), "{said}");
        }
        let remark = remark(&sensor());
        let compared =
            |sensor: &Sensor| compare_remark(remark.trim_end().as_bytes(), Path::new("standard input"), 1, sensor);
        compared(&sensor()).expect("the same");
        let said = compared(&Sensor { pitch_mm: [2.1, 4.0], ..sensor() }).expect_err("another sensor").to_string();
        for part in
            ["standard input, line 1", "10 x 7 taxels of 4 x 2.1 mm", "10 x 7 taxels of 2.1 x 4 mm", "sptfra scene"]
        {
            assert!(said.contains(part), "no {part:?} in: {said}");
        }
        let said = compare_remark(b"# sensor = 3", &frames, 7, &sensor()).expect_err("no sensor").to_string();
        assert!(said.contains("line 7"), "{said}");
        compare_remark(b"# sensor: the old one", &frames, 7, &sensor()).expect("somebody's words");
        std::fs::write(beside(&frames), "[sensor]\ncolumns = 3\n").expect("writable");
        let said = compare(&frames, "pad", &sensor()).expect_err("no sensor").to_string();
        assert!(said.contains("push.sensor.toml"), "{said}");
    }
}
