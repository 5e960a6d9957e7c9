//! `sptfra new`: a commented design file.

use std::error::Error;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use golden::design::{DEFAULT_FULL_SCALE_PA, Design, Estimator, MAX_NOISE, Tension, design_schema};
use golden::kernel::Kernel;
use golden::output::write_new;
use hdl_gen::new_design::{COUNT_BITS, NewDesign};

use golden::progress::Progress;

use crate::arguments::word;

/// Writes a commented design file NAME.toml to start from.
#[derive(clap::Args)]
#[command(
    after_help = "Example:\n  sptfra new pad --columns 12 --rows 8 --pitch-mm 4 2 --depth-mm 3 --tension clipped --counts 12"
)]
pub struct Args {
    /// Name of the design, a Verilog identifier.
    name: String,
    /// Folder for the file.
    #[arg(long, default_value = ".")]
    dir: PathBuf,
    /// How friction is found.
    ///
    /// `joint`: by a grid search, with constants fitted to the sensor. `line`: by the paper's line search.
    #[arg(long, value_parser = word::<Estimator>(), default_value = "joint")]
    estimator: Estimator,
    /// Taxels in x.
    #[arg(long)]
    columns: Option<usize>,
    /// Taxels in y.
    #[arg(long)]
    rows: Option<usize>,
    /// Distance of neighbouring taxels in x and y, or one number for both.
    #[arg(long, num_args = 1..=2, value_delimiter = ',', value_names = ["X", "Y"], value_parser = length)]
    pitch_mm: Option<Vec<f64>>,
    /// Thickness of the layer above the taxels.
    #[arg(long, value_parser = length)]
    depth_mm: Option<f64>,
    /// Reading of a taxel under tension.
    ///
    /// `read`: its stress. `clipped`: nothing, as of most resistive and capacitive arrays.
    /// Drag a finger over the array: if taxels behind it read less than without load, write `read`, else `clipped`.
    #[arg(long, value_parser = word::<Tension>())]
    tension: Option<Tension>,
    /// The first or second sensor of the paper; the options above change it.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=2))]
    paper_sensor: Option<u8>,
    /// Frames hold counts of a converter of this many bits.
    ///
    /// A count is 0 without load, and the largest at full scale. If your counts fall under load, change the sign of `pa_per_count` in the file. Up to 16 bits the stream carries
    /// integers.
    #[arg(long, value_name = "BITS", value_parser = clap::value_parser!(u32).range(COUNT_BITS))]
    counts: Option<u32>,
    /// Stress at the end of the sensor's range [default: 100000]
    #[arg(long, value_name = "PA")]
    full_scale_pa: Option<f64>,
    /// Standard deviation of a reading, as 1% of the frame's largest [default: 0.5%]
    ///
    /// A share may be written too, as 0.01. `sptfra calibrate` trains at up to 1.5 times this noise.
    /// `sptfra check --unloaded --loaded` measures it.
    #[arg(long, value_name = "SHARE", value_parser = share)]
    noise: Option<f64>,
    /// Write design.schema.json too, for editors.
    ///
    /// It is the JSON schema by which they explain, complete and check the keys.
    #[arg(long)]
    schema: bool,
}

/// How a user finds out about `--tension`.
const FIND_OUT: &str = "\nDrag a finger over the array: if taxels behind it read less than without load, write --tension read, \
                        else --tension clipped.";

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

/// A share of the command line: 1% or 0.01.
fn share(text: &str) -> Result<f64, String> {
    let (number, unit) = text.strip_suffix('%').map_or((text, 1.0), |percent| (percent, 100.0));
    let share = number.trim().parse().ok().map(|number: f64| number / unit);
    share
        .filter(|share| (0.0..=MAX_NOISE).contains(share))
        .ok_or_else(|| format!("a share from 0 to {MAX_NOISE}, such as 1% or 0.01"))
}

impl Args {
    /// The sensor that the options describe.
    fn design(&self) -> Result<NewDesign, String> {
        let paper = self.paper_sensor.map(NewDesign::paper);
        let pitch_mm = match self.pitch_mm.as_deref() {
            None => None,
            Some(&[pitch]) => Some([pitch; 2]),
            Some(&[x, y]) => Some([x, y]),
            Some(more) => return Err(format!("--pitch-mm: {} lengths; give one or two, for x and y", more.len())),
        };
        let missing: Vec<&str> = [
            (self.columns.is_none(), "--columns"),
            (self.rows.is_none(), "--rows"),
            (pitch_mm.is_none(), "--pitch-mm"),
            (self.depth_mm.is_none(), "--depth-mm"),
            (self.tension.is_none(), "--tension"),
        ]
        .into_iter()
        .filter_map(|(is_missing, option)| is_missing.then_some(option))
        .collect();
        let Some(paper) = paper.or_else(|| missing.is_empty().then(|| NewDesign::paper(1))) else {
            let find_out = if self.tension.is_none() { FIND_OUT } else { "" };
            return Err(format!(
                "{} missing: a design needs the sensor's geometry, and what a taxel reads under tension.{find_out}\n\
                 For a sensor of the paper: --paper-sensor 1 or --paper-sensor 2",
                missing.join(", ")
            ));
        };
        Ok(NewDesign {
            name: self.name.clone(),
            estimator: self.estimator,
            columns: self.columns.unwrap_or(paper.columns),
            rows: self.rows.unwrap_or(paper.rows),
            pitch_mm: pitch_mm.unwrap_or(paper.pitch_mm),
            depth_mm: self.depth_mm.unwrap_or(paper.depth_mm),
            tension: self.tension.unwrap_or(paper.tension),
            counts: self.counts,
            full_scale_pa: self.full_scale_pa.unwrap_or(DEFAULT_FULL_SCALE_PA),
            noise: self.noise.unwrap_or(paper.noise),
        })
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
    let wanted = new.design()?;
    let mut text = wanted.text(&mut |what| progress.stage(what.to_owned()))?;
    if new.schema {
        let beside = folder.join(SCHEMA_FILE);
        let failed = |error| format!("{}: cannot write the file: {error}", beside.display());
        std::fs::write(&beside, format!("{:#}\n", design_schema())).map_err(failed)?;
        text = format!("#:schema {SCHEMA_FILE}\n{text}");
    }
    write_new(&path, text.as_bytes()).map_err(failed)?;
    let design = Design::from_toml(&text, "sptfra new")?;
    Ok(lines(new, &design, &path).join("\n") + "\n")
}

/// What to tell of a new design at `path`.
fn lines(new: &Args, design: &Design, path: &Path) -> Vec<String> {
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
        next.push((
            format!("sptfra calibrate {shown} --out {}", calibrated.display()),
            "smaller errors, in one to two minutes",
        ));
    }
    let widest = next.iter().map(|(command, _)| command.len()).max().unwrap_or(0);
    let mut lines = vec![format!("{shown}: {}; edit it, then run", design.sensor)];
    lines.extend(next.iter().map(|(command, what)| format!("  {command:<widest$}  {what}")));
    lines.extend(design.expected_error().map(|expected| expected.to_string()));
    if is_joint {
        lines.push("Gain and friction are fitted to this sensor.".to_owned());
        let trains = "sptfra calibrate trains a network that corrects the remaining error";
        // General contacts were tried on points only.
        lines.push(if design.algorithm.kernel == Kernel::Point {
            // Sensors that read no tension were judged with all units.
            let units = if design.input.tension == Tension::Read { " --hidden 64" } else { "" };
            format!(
                "{trains}; with --training-set general{units}, in some\n\
                 minutes, on contacts of other shapes too, held or tilted."
            )
        } else {
            format!("{trains}.")
        });
    }
    if new.counts.is_some() {
        if new.full_scale_pa.is_none() {
            lines.push(format!(
                "The largest count stands for {DEFAULT_FULL_SCALE_PA} Pa; set another stress with --full-scale-pa."
            ));
        }
        lines.push(
            "Larger counts mean more pressure; if yours fall under load, change the sign of pa_per_count.".to_owned(),
        );
    }
    if design.algorithm.regularisation.factor() > 0.0 {
        lines.push(
            "Deeper than 1.5 pitches: `regularisation` is that of the design's `noise`, which is to be your sensor's."
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

#[cfg(test)]
mod tests {
    use clap::Parser;
    use golden::design::DEFAULT_NOISE;

    use super::*;

    #[derive(Parser)]
    struct Command {
        #[command(flatten)]
        new: Args,
    }

    /// What the options say of the first sensor of the paper, or why they are refused.
    fn design(options: &[&str]) -> Result<NewDesign, String> {
        let words = ["new", "pad", "--paper-sensor", "1"].iter().chain(options);
        Command::try_parse_from(words).map_err(|error| error.to_string())?.new.design()
    }

    #[test]
    fn a_pitch_is_one_number_or_two() {
        for pitch in [&["3.4"][..], &["3.4", "3.4"], &["3.4,3.4"]] {
            let design = design(&[&["--pitch-mm"], pitch].concat()).unwrap();
            assert_eq!(design.pitch_mm.map(f64::to_bits), [3.4_f64.to_bits(); 2]);
        }
        for (pitch, part) in
            [(&["4,4,4"][..], "3 lengths; give one or two"), (&["wide"], "as 4 2 or 4,2"), (&["nan"], "nan")]
        {
            let Err(said) = design(&[&["--pitch-mm"], pitch].concat()) else { panic!("{pitch:?} is refused") };
            assert!(said.contains(part), "{said}");
        }
    }

    #[test]
    fn noise_is_a_share_or_percent() {
        for (noise, expected) in [("1%", 0.01), ("0.01", 0.01), ("2.5 %", 0.025), ("0", 0.0)] {
            let design = design(&["--noise", noise]).unwrap();
            assert_eq!(design.noise.to_bits(), f64::to_bits(expected), "{noise}");
        }
        assert_eq!(design(&[]).unwrap().noise.to_bits(), DEFAULT_NOISE.to_bits());
        for wrong in ["1", "20%", "-1%", "nan", "%"] {
            let Err(said) = design(&[&format!("--noise={wrong}")]) else { panic!("{wrong} is refused") };
            assert!(said.contains("from 0 to 0.1, such as 1% or 0.01"), "{wrong}: {said}");
        }
    }
}
