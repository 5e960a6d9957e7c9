//! The `golden` command: frames with known forces, forces from frames, the choice of filters, and how fast it all is.

/// Prints a line, formatted like `println!`, but returns an error where that would panic.
macro_rules! say {
    ($($part:tt)*) => {
        golden::output::print_line(format_args!($($part)*))?
    };
}

mod commands;

use std::path::PathBuf;
use std::process::ExitCode;

use clap::{CommandFactory, Parser, Subcommand};
use commands::Recording;
use commands::calibrate_recorded::Recordings;
use commands::scene::RandomContacts;
use golden::arguments::{design_file, rows_file};
use golden::calibrate::Work;
use golden::design::Family;
use golden::manual::Manual;
use golden::output::print_text;
use golden::scene::Kind;
use golden::words::parser;

/// Reference solver and ground truth for three-axis tactile sensing from normal stress.
#[derive(Parser)]
#[command(version)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Make frames of stress from contacts with known forces.
    ///
    /// The frames go to FRAMES.csv, one frame a line, and the true forces beside it, to FRAMES.forces.csv, in the
    /// columns of `golden solve`. FRAMES.sensor.toml says what sensor they belong to: `golden solve`, `golden check`,
    /// `testbench run` and `testbench view` refuse them for a design of another one.
    ///
    /// With --design alone: a round contact in the middle of the design's sensor, friction 0.5, in 36 directions. With
    /// --kind, too: contacts that the calibration may not have seen, to judge an estimator by.
    #[command(after_long_help = SCENE_FILE)]
    Scene {
        /// Scene file (TOML).
        #[arg(required_unless_present = "design")]
        scene: Option<PathBuf>,
        /// Design file (TOML) whose sensor the frames are for; in counts, if it counts.
        #[arg(long, value_name = "DESIGN.toml", value_parser = design_file())]
        design: Option<PathBuf>,
        /// Contacts of a kind, anywhere on the design's sensor and pushed in any direction, in place of a scene.
        #[arg(long, value_parser = parser::<Kind>(), requires = "design", conflicts_with = "scene")]
        kind: Option<Kind>,
        #[command(flatten)]
        random: RandomContacts,
        /// Where to write the frames (CSV, or .npy by its ending), the forces and the sensor beside them. `-`: the frames
        /// alone, on standard output.
        #[arg(long, value_name = "FRAMES.csv", value_parser = rows_file())]
        out: PathBuf,
        /// Report as JSON.
        #[arg(long)]
        json: bool,
    },
    /// Solve frames in double precision.
    ///
    /// A line of FORCES.csv has, for one frame: status, `F_x`, `F_y`, `F_z`, mu, phi, `mu_x`, `mu_y`, and with --field then
    /// `f_x`, `f_y`, `f_z` of each taxel. Newtons and radians.
    ///
    /// With `--out -` the lines go to standard output, each as soon as its frame is there: with `--frames -`, from standard
    /// input, the command is a filter for frames as they come from a sensor. The first frames are checked.
    #[command(after_long_help = ALGORITHM)]
    Solve {
        /// Design file (TOML).
        #[arg(value_parser = design_file())]
        design: PathBuf,
        /// Frames (CSV or .npy): one frame a line, stresses in pascals, compression negative; counts for a design with
        /// `pa_per_count`. `-`: standard input.
        #[arg(long, value_name = "FRAMES.csv")]
        frames: PathBuf,
        /// Columns of labels before the values of a frame; the file may then have a header.
        #[arg(long, value_name = "N", default_value_t = 0)]
        labels: usize,
        /// Where to write the forces (CSV, or .npy by its ending). `-`: standard output.
        #[arg(long, value_name = "FORCES.csv", value_parser = rows_file())]
        out: PathBuf,
        /// Write the forces of each taxel too.
        #[arg(long)]
        field: bool,
        /// True forces of the same frames (CSV, as `golden scene` writes them), to report the errors.
        #[arg(long, value_name = "FORCES.csv")]
        reference: Option<PathBuf>,
        /// Report as JSON.
        #[arg(long)]
        json: bool,
    },
    /// Look for what is wrong with frames before their forces are trusted.
    ///
    /// Says in a line each, with the likely cause and the key to change: values in another unit than the design says,
    /// stress with the wrong sign, no tension anywhere, a missing tare, taxels in another order, readings at the end
    /// of the converter, broken taxels. Then, how much lies beyond what the design is calibrated for. The exit code is 0
    /// only if nothing is found.
    ///
    /// With `--rest`, what a recording without load tells; what makes it doubtful is a warning.
    Check {
        /// Design file (TOML).
        #[arg(value_parser = design_file())]
        design: PathBuf,
        /// Frames (CSV or .npy), as for `golden solve`.
        #[arg(long, value_name = "FRAMES.csv")]
        frames: PathBuf,
        /// Columns of labels before the values of a frame; the file may then have a header.
        #[arg(long, value_name = "N", default_value_t = 0)]
        labels: usize,
        /// Nothing presses in the frames: report each taxel's offset, noise and drift, which are dead, stuck and noisy, and
        /// the keys that suit the noise.
        #[arg(long)]
        rest: bool,
        /// Where to write the calibration that takes the offsets off (lines gain,offset), for `sensor.calibration`.
        #[arg(long, value_name = "CALIBRATION.csv", requires = "rest")]
        out: Option<PathBuf>,
        /// Report as JSON.
        #[arg(long)]
        json: bool,
    },
    /// Measure how many frames a second the solver in double precision takes.
    ///
    /// One frame after the other, as they come from a sensor, and in batches, as from a file; on one core. The frames are
    /// pushed contacts at random places, the same in every run. Each figure is the median of several repetitions.
    Bench {
        /// Design files (TOML).
        #[arg(required = true, value_parser = design_file())]
        designs: Vec<PathBuf>,
        /// Report as JSON.
        #[arg(long)]
        json: bool,
    },
    /// Choose the filter of each matrix for a design with filter f3.
    ///
    /// Tries, one matrix at a time, the bands f1 with l = 10 to 90 and the row thresholds f2 with p = 10 to 90 on the
    /// frames of the design's reference scenes, and chooses the one with the least product of friction error, by the design's
    /// estimator, and entries kept. The design with the choices goes to RESOLVED.toml, from which hardware is generated without a search.
    #[command(after_long_help = CHOOSE_FILES)]
    Choose {
        /// Design file (TOML).
        #[arg(value_parser = design_file())]
        design: PathBuf,
        /// Where to write the design with the choices (TOML).
        #[arg(long, value_name = "RESOLVED.toml")]
        out: PathBuf,
        /// Where to write what was measured of every candidate (CSV).
        #[arg(long, value_name = "CANDIDATES.csv")]
        csv: Option<PathBuf>,
        /// Report as JSON, with every candidate.
        #[arg(long)]
        json: bool,
    },
    /// Find a design's constants: from simulated contacts, or from recordings of the sensor with measured forces.
    ///
    /// Without --frames and --uniform: those of the estimator "joint". Makes contacts at random on a bonded layer, from the
    /// seed alone, and fits to their known forces a gain, two constants of the friction, and the weights of the correction. The
    /// design with the constants goes to RESOLVED.toml, the weights to RESOLVED.weights.csv beside it: both or none.
    ///
    /// With --frames and --forces: what a count is worth (a curve, a gain for all taxels, and the taxels' own), and the
    /// constants of friction where tangential forces are known. Says what the recording could determine, with errors at
    /// places that were left out, and what it could not, which stays as the design has it. With --uniform and --pressures:
    /// gains and curve from a bladder's pressure; both may be given.
    #[command(after_long_help = CALIBRATE_FILES)]
    Calibrate {
        /// Design file (TOML).
        #[arg(value_parser = design_file())]
        design: PathBuf,
        /// Where to write the design with the constants (TOML).
        #[arg(long, value_name = "RESOLVED.toml")]
        out: PathBuf,
        #[command(flatten)]
        recordings: Recordings,
        /// Seed of the contacts and of the training.
        #[arg(long, default_value_t = 1, conflicts_with = "recordings")]
        seed: u64,
        /// Contacts to fit to: "narrow", round and sliding, "wide", of any shape, tilted, held, over the grid's edge.
        /// Unless given, what the design says under [algorithm] family.
        #[arg(long, value_parser = parser::<Family>(), conflicts_with = "recordings")]
        family: Option<Family>,
        /// Hidden units of the correction, 0 to 256, with family "wide" 204; 0 for none. Unless given 128, on the narrow
        /// family with grid = 15 64, with --quick 24.
        #[arg(long, value_parser = clap::value_parser!(u16).range(0..=256), conflicts_with = "recordings")]
        hidden: Option<u16>,
        /// Take a tenth of the time, for constants that are half as good.
        #[arg(long, conflicts_with = "recordings")]
        quick: bool,
        /// Take about ten times the time, for a network that is as exact with half of the hidden units.
        #[arg(long, conflicts_with_all = ["recordings", "quick"])]
        thorough: bool,
        /// Report as JSON.
        #[arg(long)]
        json: bool,
    },
    /// Write what a board loads into a bank of its calibration.
    ///
    /// For a design with [hardware] calibration = "ram": each taxel's gain and offset and, with `room` for them, its weights in
    /// the stress of the dead taxels that the design names. `load_calibration` of the Python driver reads the file; nothing
    /// is synthesized.
    #[command(after_long_help = BANK_FILE)]
    Bank {
        /// Design file (TOML), with the calibration and the dead taxels of today.
        #[arg(value_parser = design_file())]
        design: PathBuf,
        /// Where to write the bank (CSV).
        #[arg(long, value_name = "BANK.csv")]
        out: PathBuf,
        /// Report as JSON.
        #[arg(long)]
        json: bool,
    },
    #[command(flatten)]
    Manual(Manual),
}

const SCENE_FILE: &str = r#"Scene file:
  [sensor]                          # as in the design file
  columns = 10
  rows = 10
  pitch_mm = [4.0, 2.0]
  depth_mm = 3.0
  taxel_mm = [3.0, 1.5]             # optional: sides of the part of its cell over which a taxel averages

  [medium]
  kind = "bonded_layer"             # on a rigid ground, with poisson; or "half_space" without
  poisson = 0.49

  [[contact]]                       # one table for each contact; their stresses add up
  shape = "hertz"                   # ellipse: semi_axes_mm; "rectangle", uniform: sides_mm;
  semi_axes_mm = [7.0, 7.0]         # "disc", uniform, and "punch", flat and rigid: radius_mm
  centre_mm = [18.0, 9.0]           # from the first taxel
  normal_force_n = 6.0              # positive when pressing
  friction = 0.5                    # tangential over normal force
  direction_deg = 30.0              # of the tangential force, from x towards y
  turn_deg = 25.0                   # optional, and so are all below: the shape's axes, from x towards y
  edge = 2.0                        # pressure (1 - rho^2)^edge: soft above 0.5, Hertz's; even at 0; hard below
  tilt = [0.6, 0.0]                 # of the pressure along and across the push: times 1 + 0.6 u/a + 0 v/b
  shear = "sliding"                 # friction times pressure; with spin = 1.0 it turns, too, at its edge as fast as it
                                    # slides. Or "even", the same everywhere; or "held" (shape "hertz"), Mindlin's
                                    # partial slip, with held = 0.5, the share of the largest tangential force

  [sweep]                           # optional: one frame for each direction, which is
  direction_deg = { from = 0, to = 350, step = 10 } # added to those of the contacts

  [sensor_errors]                   # optional, and so is every key; applied in this order
  depth = 0.05                      # share by which the layer is deeper than depth_mm says
  seed = 1                          # of gains and noise
  gain_spread = 0.01                # standard deviation of the taxels' gains around 1
  noise = 0.002                     # standard deviation, share of the frame's largest stress
  quantisation_bits = 12            # of a converter with the range full_scale_pa
  full_scale_pa = 100000.0
  dead = [37]                       # taxels that read 0
  saturated = [58]                  # taxels that read minus full_scale_pa"#;

const ALGORITHM: &str = r#"In the design file, what changes the result:
  [sensor]                          # besides the geometry, for frames in counts:
  pa_per_count = -12.5              # pascals of one count, negative where larger counts press
  calibration = "calibration.csv"   # a line gain,offset for each taxel: Pa = (gain * count + offset) * pa_per_count
  curve = "curve.csv"               # in place of pa_per_count: lines count,pascals; or { power = 1.25, scale = -0.0066 }
  dead = [44, 45]                   # taxels that read nothing, up to 8: others replace them; so does gain 0

  [algorithm]
  plan = "reduced"                  # the paper's result from ten folded matrices, the default; or
                                    # "paper": thirteen matrices
  kernel = "point"                  # point forces, as in the paper, for layers of half a pitch and more. Or "cell":
                                    # forces spread over a cell of the grid, for thinner ones; F_z is right without a gain
  filter = { kind = "none" }        # or { kind = "f1", l = 40 }: l diagonals removed on either side;
                                    # { kind = "f2", p = 30 }: kept is |B_ij| >= row maximum / (1000 p);
                                    # { kind = "f3", ... }: a filter for each matrix, see `golden choose --help`
  estimator = "line"                # the paper's; or "joint", better, see `golden calibrate --help`
  outputs = "field"                 # or "resultants": no field; reduced plan only
  noise_floor_pa = 1.5              # stress below which a taxel tells nothing; full scale / 65536 if absent"#;

const CHOOSE_FILES: &str = r#"In the design file:
  [algorithm]
  filter = { kind = "f3", scenes = ["../scenes/sensor1-hertz.toml"] } # relative to the design file

In RESOLVED.toml, besides:
  [algorithm.filter.choices]        # "none", "f1 l=40" or "f2 p=30" for each of the 13 matrices
  C33inv = "f2 p=30"

Columns of CANDIDATES.csv: matrix, filter, entries kept (Nnz), error of the friction coefficient in
percent (e_mu, mean over the frames), e_mu * Nnz, and 1 for the candidate chosen, else 0."#;

const CALIBRATE_FILES: &str = r#"FORCES.csv: one line a frame; a header with units, such as F_x (N),F_y (N),F_z (N); any of them may be missing, blanks are
unknown. F_z or weights alone will do: weight (g). A column contact or place names what belongs together. Frames without
load, with the force 0, give the offsets. PRESSURES.csv: pressure (kPa), one line a frame.

For the joint estimator's constants from simulated contacts, in the design file:
  [algorithm]
  estimator = "joint"

In RESOLVED.toml, besides:
  gain = 1.1                        # factor on all forces
  friction_correction = [1.0, 0.0]  # friction vector c1 mu + c3 mu |mu|^2
  training_set = "general"          # contacts that all of it was fitted to, unless "sliding"
  max_standard_error = 0.06         # with "general": a standard error above this share of F_z is doubtful
  [algorithm.correction]            # of the friction vector, by a small network
  half_window = [3, 7]              # taxels either side of the contact's centre, along x and y
  file = "RESOLVED.weights.csv"     # its weights in steps of 2^-12, written beside RESOLVED.toml: a line for each
                                    # hidden unit, under a header
  sha256 = "..."                    # of that file
  error_base = -17123               # with "general": what is added to the logarithm of the error that is left"#;

const BANK_FILE: &str = r#"BANK.csv: a header line, gain,offset,taxel 37,taxel 38, that names the dead taxels; then a line for each taxel: its gain
(0 of a dead one), its offset in counts, and its weight in the stress of each dead taxel. Of a design with a curve offsets
are in pascals, and a header count,pascals and its points follow. A design can name the file, as sensor.calibration and as
sensor.curve.

In the design file:
  [sensor]
  calibration = "calibration.csv"   # a line gain,offset for each taxel, such as golden calibrate writes; gain 0: dead
  dead = { taxels = [37, 38], room = 8 } # others that read nothing; room for 1, 2, 4 or 8 in a bank

  [hardware]
  control = true
  calibration = "ram""#;

fn main() -> ExitCode {
    let result = match Arguments::parse().command {
        Command::Scene { scene, design, kind, random, out, json } => {
            let kind = kind.map(|kind| (kind, random));
            commands::scene::run(scene.as_deref(), design.as_deref(), kind, &out, json)
        }
        Command::Solve { design, frames, labels, out, field, reference, json } => {
            commands::solve::run(&design, &Recording { file: &frames, labels }, &out, field, reference.as_deref(), json)
        }
        Command::Check { design, frames, labels, rest, out, json } => {
            let asked = commands::check::Asked { rest, out: out.as_deref(), json };
            commands::check::run(&design, &Recording { file: &frames, labels }, &asked)
        }
        Command::Calibrate { design, out, recordings, json, .. } if recordings.given() => {
            commands::calibrate_recorded::run(&design, &out, &recordings, json)
        }
        Command::Calibrate { design, out, seed, family, hidden, quick, thorough, json, .. } => {
            let work = Work { seed, hidden: hidden.map(usize::from), quick, thorough };
            commands::calibrate::run(&design, &out, family, work, json)
        }
        Command::Bank { design, out, json } => commands::bank::run(&design, &out, json),
        Command::Manual(manual) => manual.run(Arguments::command()).and_then(|text| Ok(print_text(&text)?)),
        Command::Bench { designs, json } => commands::bench::run(&designs, json),
        Command::Choose { design, out, csv, json } => commands::choose::run(&design, &out, csv.as_deref(), json),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}
