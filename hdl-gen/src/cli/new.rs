//! `hdl-gen new`: a commented design file.

use std::error::Error;
use std::io::{ErrorKind, Write};
use std::path::PathBuf;

use clap::Args;
use golden::design::{DEFAULT_FULL_SCALE_PA, Estimator, Tension};
use golden::words;
use hdl_gen::new_design::{COUNT_BITS, NewDesign};

use golden::progress::Progress;

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
    /// What taxels read of a pull: its stress, or nothing, as most resistive and capacitive arrays
    #[arg(long, value_parser = words::parser::<Tension>(), default_value = "read")]
    tension: Tension,
    /// Frames hold counts of a converter of so many bits: 0 without load, the largest count at the full scale; for one
    /// whose counts fall under load, change the sign of `pa_per_count` in the file. Up to 16 bits the stream carries
    /// integers
    #[arg(long, value_name = "BITS", value_parser = clap::value_parser!(u32).range(COUNT_BITS))]
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
    let wanted = NewDesign {
        name: name.clone(),
        estimator: new.estimator,
        columns: new.columns,
        rows: new.rows,
        pitch_mm: [new.pitch_mm[0], new.pitch_mm[1]],
        depth_mm: new.depth_mm,
        tension: new.tension,
        counts: new.counts,
        full_scale_pa: new.full_scale_pa,
    };
    let text = wanted.text(&mut |what| progress.stage(what.to_owned()))?;
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
