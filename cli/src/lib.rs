//! The one command, `sptfra`: forces from frames, designs, the hardware and its simulation.
//!
//! The program and the Python wheel both call [`run`]. What computes lives in the crates `golden`, `hdl-gen` and
//! `testbench`; here are options, messages and reports.

pub mod arguments;
mod commands;
pub mod manual;
pub mod message;

use std::ffi::OsString;

use clap::{CommandFactory, Parser, Subcommand};

use commands::{
    build, calibrate, check, export_calibration, generate, inspect, new, run, scene, solve, sweep, tune_filter, view,
};
use manual::Manual;
use message::Message;

/// Reconstructs three-axis contact forces from the normal stress of a tactile array, in software and in hardware.
#[derive(Parser)]
#[command(name = "sptfra", version, after_help = START)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

const START: &str = "Example: from a sensor to its forces and its hardware
  sptfra new pad --columns 10 --rows 10 --pitch-mm 4 2 --depth-mm 3 --tension read
  sptfra solve pad --frames frames.csv --out forces.csv
  sptfra generate pad --out rtl-out/pad
  sptfra run pad --frames frames.csv";

#[derive(Subcommand)]
enum Command {
    New(new::Args),
    Check(check::Args),
    Scene(scene::Args),
    Calibrate(calibrate::Args),
    TuneFilter(tune_filter::Args),
    Solve(solve::Args),
    Inspect(inspect::Args),
    Generate(generate::Args),
    Run(run::Args),
    View(view::Args),
    Sweep(sweep::Args),
    ExportCalibration(export_calibration::Args),
    Build(build::Args),
    #[command(flatten)]
    Manual(Manual),
}

/// Runs the command of a command line, whose first word is the program's name. Prints what it has to say.
///
/// Returns the exit code: 0 if all is well, 1 for what is wrong, 2 for a command line that cannot be read.
pub fn run(words: impl IntoIterator<Item = impl Into<OsString> + Clone>) -> u8 {
    let command = match Arguments::try_parse_from(words) {
        Ok(arguments) => arguments.command,
        Err(error) => {
            // A reader that has gone away is no error.
            let _ = error.print();
            return u8::try_from(error.exit_code()).unwrap_or(2);
        }
    };
    message::show(execute(command))
}

fn execute(command: Command) -> message::Result {
    match command {
        Command::New(args) => new::run(&args).map(Message::from),
        Command::Check(args) => check::run(&args),
        Command::Scene(args) => scene::run(&args),
        Command::Calibrate(args) => calibrate::run(&args),
        Command::TuneFilter(args) => tune_filter::run(&args),
        Command::Solve(args) => solve::run(&args),
        Command::Inspect(args) => inspect::run(&args),
        Command::Generate(args) => generate::run(&args),
        Command::Run(args) => run::run(&args),
        Command::View(args) => view::run(&args),
        Command::Sweep(args) => sweep::run(&args),
        Command::ExportCalibration(args) => export_calibration::run(&args),
        Command::Build(args) => build::run(&args),
        Command::Manual(manual) => manual.run(Arguments::command()).map(Message::from),
    }
}

#[cfg(test)]
mod tests {
    use std::fmt::Write;

    use clap::ArgAction;

    use super::*;

    const MARK: &str = "<!-- printed from the commands -->\n";

    /// The printed part of the page: a table of commands, then the options of each.
    fn page() -> String {
        let command = Arguments::command();
        let about = |command: &clap::Command| command.get_about().map(ToString::to_string).unwrap_or_default();
        let subcommands: Vec<_> = command.get_subcommands().cloned().map(|sub| sub.bin_name("sptfra")).collect();
        let mut page = "| command | what it does |\n|---|---|\n".to_owned();
        for sub in &subcommands {
            let _ = writeln!(page, "| [`{0}`](#sptfra-{0}) | {1} |", sub.get_name(), about(sub));
        }
        for sub in subcommands {
            let _ = writeln!(page, "\n### sptfra {}\n\n{}.\n", sub.get_name(), about(&sub));
            for option in sub.get_arguments() {
                let values = option.get_value_names().into_iter().flatten().map(ToString::to_string);
                let name = option.get_long().map(|name| format!("--{name}"));
                let takes = !matches!(option.get_action(), ArgAction::SetTrue);
                let values: Vec<_> = if takes { values.collect() } else { Vec::new() };
                let shown = name.into_iter().chain(values).collect::<Vec<_>>().join(" ");
                let help = option.get_long_help().or(option.get_help()).map(ToString::to_string).unwrap_or_default();
                let paragraph = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
                let help: Vec<_> =
                    help.split("\n\n").map(|text| paragraph(text).trim_end_matches('.').to_owned()).collect();
                let help = help.join(". ");
                let words: Vec<_> =
                    option.get_possible_values().iter().map(|word| format!("`{}`", word.get_name())).collect();
                let words = if takes && !words.is_empty() && !option.is_hide_possible_values_set() {
                    format!(" One of {}.", words.join(", "))
                } else {
                    String::new()
                };
                let default =
                    option.get_default_values().iter().map(|value| value.to_string_lossy()).collect::<Vec<_>>();
                let default = if takes && !default.is_empty() && !option.is_hide_default_value_set() {
                    format!(" [default: {}]", default.join(" "))
                } else {
                    String::new()
                };
                let _ = writeln!(page, "- `{shown}`: {help}{default}.{words}");
            }
        }
        page
    }

    /// `UPDATE_EXPECTED=1` prints the commands of the page anew.
    #[test]
    fn commands_of_the_page_are_those_of_the_command() {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/reference/commands.md");
        let text = std::fs::read_to_string(file).expect("a page");
        let (by_hand, printed) = text.split_once(MARK).expect("a mark");
        let expected = page();
        if std::env::var_os("UPDATE_EXPECTED").is_some() {
            std::fs::write(file, format!("{by_hand}{MARK}{expected}")).expect("written");
        } else {
            assert!(printed == expected, "UPDATE_EXPECTED=1 prints the commands anew");
        }
    }

    #[test]
    fn every_command_has_an_example_and_short_lines() {
        let command = Arguments::command();
        for sub in command.get_subcommands().filter(|sub| !["man", "completions"].contains(&sub.get_name())) {
            let help = sub.clone().render_long_help().to_string();
            assert!(help.contains(&format!("sptfra {}", sub.get_name())), "{} has no example", sub.get_name());
            assert!(sub.get_about().is_some_and(|about| !about.to_string().contains('\n')), "{}", sub.get_name());
            for option in sub.get_arguments() {
                assert!(option.get_help().is_some(), "{} --{}", sub.get_name(), option.get_id());
            }
            let short = sub.clone().render_help().to_string();
            let (before, options) = short.split_once("Options:\n").expect("options");
            for line in before.lines().chain(options.lines().take_while(|line| !line.is_empty())) {
                assert!(line.len() <= 110, "{}: {} columns: {line}", sub.get_name(), line.len());
            }
        }
        command.debug_assert();
    }
}
