//! `hdl-gen new`: a commented design file.

use std::error::Error;
use std::io::{ErrorKind, Write};
use std::path::PathBuf;

use clap::Args;
use golden::calibrate::{Settings, calibrate};
use golden::design::{DEFAULT_FULL_SCALE_PA, Design, Estimator, Grid, JointConstants};
use golden::words;

use super::progress::Progress;

const TEMPLATE: &str = include_str!("../../templates/design.toml");
/// The line of the template where the joint estimator's constants go.
const CONSTANTS: &str = "@CONSTANTS@\n";
/// Depth in pitches beyond which a new design is regularised.
const DEEP: f64 = 1.5;
/// Where the comments of the template begin.
const COMMENTS: usize = 33;

/// What the command line says of the new design.
#[derive(Args)]
pub struct New {
    /// Name of the design: a Verilog identifier
    name: String,
    /// Folder for the file
    #[arg(long, default_value = ".")]
    dir: PathBuf,
    /// How friction is found: both components at once, by constants fitted to the sensor, or along the direction of push,
    /// as in the paper
    #[arg(long, value_parser = words::parser::<Estimator>(), default_value = "joint")]
    estimator: Estimator,
    /// Taxels in x
    #[arg(long, default_value_t = 10)]
    columns: usize,
    /// Taxels in y
    #[arg(long, default_value_t = 10)]
    rows: usize,
    /// Distance of neighbouring taxels in x and in y
    #[arg(long, num_args = 2, value_names = ["X", "Y"], default_values_t = [4.0, 2.0])]
    pitch_mm: Vec<f64>,
    /// Thickness of the layer above the taxels
    #[arg(long, default_value_t = 3.0)]
    depth_mm: f64,
    /// Frames hold counts of a converter of so many bits: 0 without load, the largest count at the full scale; for one
    /// whose counts fall under load, change the sign of `pa_per_count` in the file
    #[arg(long, value_name = "BITS", value_parser = clap::value_parser!(u32).range(4..=24))]
    counts: Option<u32>,
    /// Stress at the end of the sensor's range
    #[arg(long, value_name = "PA", default_value_t = DEFAULT_FULL_SCALE_PA)]
    full_scale_pa: f64,
}

/// Writes `NAME.toml` into the folder, the whole file or none, never over an existing one; returns what to do next.
pub fn write(new: &New, progress: &Progress) -> Result<String, Box<dyn Error>> {
    let New { name, dir: folder, .. } = new;
    let path = folder.join(format!("{name}.toml"));
    let failed = |error: std::io::Error| match error.kind() {
        ErrorKind::AlreadyExists => format!("{}: is there already; choose another name", path.display()),
        _ => format!("{}: cannot write the file: {error}; choose another folder with --dir", path.display()),
    };
    if !folder.is_dir() {
        return Err(format!("{}: is no folder; make it first or choose another with --dir", folder.display()).into());
    }
    // Before the work rather than after it.
    if path.exists() {
        return Err(failed(ErrorKind::AlreadyExists.into()).into());
    }
    let text = text(new, progress)?;
    let mut builder = tempfile::Builder::new();
    builder.prefix(".hdl-gen-");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // As for any new file, the umask decides.
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    let mut file = builder.tempfile_in(folder).map_err(failed)?;
    file.write_all(text.as_bytes()).map_err(failed)?;
    file.persist_noclobber(&path).map_err(|error| failed(error.error))?;
    let said = format!("{}: edit it, then run hdl-gen inspect {0} and hdl-gen generate {0}\n", path.display());
    if new.estimator == Estimator::Line {
        return Ok(said);
    }
    let calibrated = folder.join(format!("{name}-calibrated.toml"));
    Ok(format!(
        "{said}gain and friction are fitted to this sensor, which leaves errors of up to 10 % of the normal force where\n\
         the contact's edge lies between taxels; golden calibrate {} --out {} trains the correction, which halves them\n",
        path.display(),
        calibrated.display()
    ))
}

/// Pascals of a count, so that the largest one reaches the full scale, where it is flagged, and no count is beyond.
fn pa_per_count(new: &New, bits: u32) -> String {
    let largest = f64::from(bits).exp2() - 1.0;
    let step = new.full_scale_pa / largest;
    let step = if step * largest < new.full_scale_pa { step.next_up() } else { step };
    format!("{:?}", -step)
}

/// The design file, checked.
fn text(new: &New, progress: &Progress) -> Result<String, Box<dyn Error>> {
    // Quoted, so that whatever the name holds reaches the check of names; a JSON string is a TOML string.
    let mut text = with(TEMPLATE, "name", &serde_json::to_string(&new.name)?);
    for (key, value) in [
        ("columns", new.columns.to_string()),
        ("rows", new.rows.to_string()),
        ("pitch_mm", format!("{:?}", new.pitch_mm)),
        ("depth_mm", format!("{:?}", new.depth_mm)),
        ("full_scale_pa", format!("{:?}", new.full_scale_pa)),
    ] {
        text = with(&text, key, &value);
    }
    if let Some(bits) = new.counts {
        text = with(&text.replace("# pa_per_count = ", "pa_per_count = "), "pa_per_count", &pa_per_count(new, bits));
    }
    // Where noise would become force, and no plan might be possible without.
    let [x, y] = [new.pitch_mm[0], new.pitch_mm[1]];
    if new.depth_mm > DEEP * x.min(y) {
        text = text.replace("# regularisation = ", "regularisation = ");
    }
    let bare = text.replace(CONSTANTS, "");
    if new.estimator == Estimator::Line {
        let text = with(&bare, "estimator", "\"line\"");
        Design::from_toml(&text, "hdl-gen new")?;
        return Ok(text);
    }
    let design =
        Design::from_toml(&text.replace(CONSTANTS, &format!("grid = {}\n", Grid::COARSE.side())), "hdl-gen new")?;
    progress.stage("fitting gain and friction to contacts with known forces".to_owned());
    let found = calibrate(&design, &Settings::constants(), &mut |_| ())
        .map_err(|error| format!("{error}; or choose --estimator line, which needs no constants"))?;
    let text = text.replace(CONSTANTS, &constants(&found));
    Design::from_toml(&text, "hdl-gen new")?;
    Ok(text)
}

/// The lines of the joint estimator's constants; four digits, which no processor rounds otherwise and no contact shows.
fn constants(JointConstants { grid, gain, tangential: [c1, c3], fitted_to, .. }: &JointConstants) -> String {
    let remarks = [
        "points of the plane along each axis, a cell of hardware each; 21: finer, walked over",
        "factor on all forces, fitted to the sensor above",
        "friction c1 mu + c3 mu |mu|^2, likewise; the correction, which",
        "  halves the error, is trained by golden calibrate",
        "what they belong to: for another sensor, kernel or regularisation remove",
        "  these lines, and run golden calibrate",
    ];
    let keys = [
        format!("grid = {}", grid.side()),
        format!("gain = {gain:.4}"),
        format!("tangential = [{c1:.4}, {c3:.4}]"),
        String::new(),
        String::new(),
        String::new(),
    ];
    let fitted_to = format!("fitted_to = {:?}\n", fitted_to.as_deref().unwrap_or_default());
    let constants: String =
        keys.iter().zip(remarks).map(|(key, remark)| format!("{key:<COMMENTS$}# {remark}\n")).collect();
    constants + &fitted_to
}

/// The text with another value of a key, its comment where it was.
fn with(text: &str, key: &str, value: &str) -> String {
    let line = |line: &str| match (line.split_once(" = "), line.split_once(" # ")) {
        (Some((found, _)), Some((_, comment))) if found == key => {
            let pair = format!("{key} = {value} ");
            format!("{pair:<COMMENTS$}# {comment}\n")
        }
        _ => format!("{line}\n"),
    };
    text.lines().map(line).collect()
}
