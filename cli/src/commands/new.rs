//! `sptfra new`: a commented design file.

use std::error::Error;
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

use golden::design::{DEFAULT_FULL_SCALE_PA, Design, Estimator, Tension, design_schema};
use golden::kernel::Kernel;
use golden::metrics::Quantiles;
use hdl_gen::new_design::{self, COUNT_BITS, NewDesign};

use golden::progress::Progress;

use crate::arguments::word;

/// Writes a commented design file NAME.toml to start from.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  sptfra new pad --columns 12 --rows 8 --pitch-mm 4 2 --depth-mm 3 --counts 12")]
pub struct Args {
    /// Name of the design, a Verilog identifier.
    name: String,
    /// Folder for the file.
    #[arg(long, default_value = ".")]
    dir: PathBuf,
    /// Friction by a grid search with constants fitted to the sensor, or by the paper's line search.
    #[arg(long, value_parser = word::<Estimator>(), default_value = "joint")]
    estimator: Estimator,
    /// Taxels in x; default: 10, the paper's first sensor, as for the next three.
    #[arg(long)]
    columns: Option<usize>,
    /// Taxels in y; default: 10.
    #[arg(long)]
    rows: Option<usize>,
    /// Distance of neighbouring taxels in x and y, or one number for both; default: 4 2.
    #[arg(long, num_args = 1..=2, value_delimiter = ',', value_names = ["X", "Y"], value_parser = length)]
    pitch_mm: Option<Vec<f64>>,
    /// Thickness of the layer above the taxels; default: 3.
    #[arg(long, value_parser = length)]
    depth_mm: Option<f64>,
    /// Reading of a taxel under tension: its stress, or nothing, as of most resistive and capacitive arrays.
    #[arg(long, value_parser = word::<Tension>(), default_value = "read")]
    tension: Tension,
    /// Frames hold counts of a converter of this many bits: 0 without load, the largest at full scale.
    ///
    /// If your counts fall under load, change the sign of `pa_per_count` in the file. Up to 16 bits the stream carries
    /// integers.
    #[arg(long, value_name = "BITS", value_parser = clap::value_parser!(u32).range(COUNT_BITS))]
    counts: Option<u32>,
    /// Stress at the end of the sensor's range; default: 100000.
    #[arg(long, value_name = "PA")]
    full_scale_pa: Option<f64>,
    /// Write design.schema.json too, the JSON schema by which editors explain, complete and check the keys.
    #[arg(long)]
    schema: bool,
}

/// Name of the schema beside a design.
const SCHEMA_FILE: &str = "design.schema.json";

/// A length of the command line.
fn length(text: &str) -> Result<f64, String> {
    let length = text.parse().ok().filter(|length: &f64| length.is_finite());
    length.ok_or_else(|| {
        let is_name = text.starts_with(|first: char| first.is_ascii_alphabetic() || first == '_');
        let remedy = if is_name { "; the design's name goes before --pitch-mm" } else { "" };
        format!("a length in mm, such as 4; a pitch may have two, for x and y, as 4 2 or 4,2{remedy}")
    })
}

impl Args {
    /// The sensor, and the options that were left out.
    fn design(&self) -> Result<(NewDesign, Vec<String>), String> {
        let paper = NewDesign::default();
        let pitch_mm = match self.pitch_mm.as_deref() {
            None => paper.pitch_mm,
            Some(&[pitch]) => [pitch; 2],
            Some(&[x, y]) => [x, y],
            Some(more) => return Err(format!("--pitch-mm: {} lengths; give one or two, for x and y", more.len())),
        };
        let [x, y] = paper.pitch_mm;
        let assumed = [
            (self.columns.is_none(), format!("--columns {}", paper.columns)),
            (self.rows.is_none(), format!("--rows {}", paper.rows)),
            (self.pitch_mm.is_none(), format!("--pitch-mm {x} {y}")),
            (self.depth_mm.is_none(), format!("--depth-mm {}", paper.depth_mm)),
            // What a count is worth follows from it.
            (
                self.counts.is_some() && self.full_scale_pa.is_none(),
                format!("--full-scale-pa {DEFAULT_FULL_SCALE_PA}, a guess at the largest count"),
            ),
        ];
        let wanted = NewDesign {
            name: self.name.clone(),
            estimator: self.estimator,
            columns: self.columns.unwrap_or(paper.columns),
            rows: self.rows.unwrap_or(paper.rows),
            pitch_mm,
            depth_mm: self.depth_mm.unwrap_or(paper.depth_mm),
            tension: self.tension,
            counts: self.counts,
            full_scale_pa: self.full_scale_pa.unwrap_or(DEFAULT_FULL_SCALE_PA),
        };
        Ok((wanted, assumed.into_iter().filter(|(left_out, _)| *left_out).map(|(_, option)| option).collect()))
    }
}

/// Writes `NAME.toml` into the folder, the whole file or none, never over an existing one; returns what to do next.
pub fn run(new: &Args) -> Result<String, Box<dyn Error>> {
    let progress = &Progress::new();
    let Args { name, dir: folder, .. } = new;
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
    let (wanted, assumed) = new.design()?;
    let mut text = wanted.text(&mut |what| progress.stage(what.to_owned()))?;
    if new.schema {
        let beside = folder.join(SCHEMA_FILE);
        let failed = |error| format!("{}: cannot write the file: {error}", beside.display());
        std::fs::write(&beside, format!("{:#}\n", design_schema())).map_err(failed)?;
        text = format!("#:schema {SCHEMA_FILE}\n{text}");
    }
    let mut builder = tempfile::Builder::new();
    builder.prefix(".sptfra-");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // As for any new file, the umask decides.
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    let mut file = builder.tempfile_in(folder).map_err(failed)?;
    file.write_all(text.as_bytes()).map_err(failed)?;
    file.persist_noclobber(&path).map_err(|error| failed(error.error))?;
    let design = Design::from_toml(&text, "sptfra new")?;
    Ok(lines(new, &design, &path, &assumed, progress).join("\n") + "\n")
}

/// What to tell of a new design at `path`, with the options that were `assumed`.
fn lines(new: &Args, design: &Design, path: &Path, assumed: &[String], progress: &Progress) -> Vec<String> {
    let shown = path.display();
    let mut next = vec![
        (format!("sptfra check {shown} --frames FRAMES"), "is anything wrong with a recording?"),
        (format!("sptfra solve {shown} --frames FRAMES --out FORCES.csv"), "its forces, no hardware needed"),
        (format!("sptfra inspect {shown}"), "cycles and resources"),
        (format!("sptfra generate {shown}"), "the hardware"),
    ];
    let is_joint = design.algorithm.estimator == Estimator::Joint;
    if is_joint {
        let calibrated = new.dir.join(format!("{}-calibrated.toml", new.name));
        next.push((format!("sptfra calibrate {shown} --out {}", calibrated.display()), "smaller errors, in a minute"));
    }
    let widest = next.iter().map(|(command, _)| command.len()).max().unwrap_or(0);
    let mut lines = vec![format!("{shown}: {}; edit it, then run", design.sensor)];
    lines.extend(next.iter().map(|(command, what)| format!("  {command:<widest$}  {what}")));
    if is_joint {
        progress.stage("trying it on other contacts");
        let errors = new_design::errors(design).map(|Quantiles { median, most, .. }| {
            format!(
                " On {} round sliding contacts the\n\
                 tangential force has a median error of {median:.1} % of the normal force (95 %: {most:.1}).",
                new_design::TRIED
            )
        });
        lines.push(format!("Gain and friction are fitted to this sensor.{}", errors.unwrap_or_default()));
        let trains = "sptfra calibrate trains a network that corrects the remaining error";
        // General contacts were tried on points only.
        lines.push(if design.algorithm.kernel == Kernel::Point {
            // Sensors that read no tension were judged with all units.
            let units = if design.input.tension == Tension::Read { " --hidden 64" } else { "" };
            format!(
                "{trains}; with --training-set general{units}, in some\n\
                 minutes, on contacts of other shapes too, held or tilted, and the network estimates its standard error."
            )
        } else {
            format!("{trains}.")
        });
    }
    if !assumed.is_empty() {
        lines.push(format!("Not given, so as the paper's first sensor: {}", assumed.join(", ")));
    }
    if new.counts.is_some() {
        lines.push(
            "Larger counts are taken to press; if yours fall under load, change the sign of pa_per_count.".to_owned(),
        );
    }
    if design.algorithm.regularisation.factor() > 0.0 {
        lines.push(
            "Deeper than 1.5 pitches: `regularisation` keeps noise down; its `noise` is to be your sensor's."
                .to_owned(),
        );
    }
    if design.algorithm.kernel == Kernel::Cell {
        lines.push(
            "Less than half a pitch thin: kernel = \"cell\" finds direction and friction where points do not."
                .to_owned(),
        );
    }
    lines.extend(design.thin_layer().map(|thin| format!("warning: {thin}")));
    lines
}
