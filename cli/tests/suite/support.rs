//! Shared by the commands' tests: the program, files of the workspace, designs.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use golden::design::Design;

/// A file of the workspace.
pub fn workspace(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("a workspace").join(path)
}

/// One of the shipped designs, by its file name without the ending.
pub fn shipped(file: &str) -> Design {
    Design::load(&workspace(&format!("designs/{file}.toml"))).expect("a good design")
}

/// The program.
pub fn program() -> Command {
    Command::new(env!("CARGO_BIN_EXE_sptfra"))
}

/// The program's answer.
pub fn sptfra(arguments: &[&str]) -> Output {
    program().args(arguments).output().expect("starts")
}

/// The program's answer in a folder.
pub fn sptfra_in(folder: &Path, arguments: &[&str]) -> Output {
    program().current_dir(folder).args(arguments).output().expect("starts")
}

/// A path as text.
pub fn text(path: &Path) -> &str {
    path.to_str().expect("UTF-8")
}

/// The beginning of a design file whose method and scaling need no constants.
pub const PLAIN: &str = concat!("format = 3\nbase = \"", env!("CARGO_MANIFEST_DIR"), "/../golden/tests/plain.toml\"\n");

/// A design file's text with every optional key left out but those of `more`, which may open tables.
pub fn design_text(name: &str, size: [usize; 2], pitch_mm: [f64; 2], depth_mm: f64, more: &str) -> String {
    format!(
        "{PLAIN}name = \"{name}\"\n[sensor]\ncolumns = {}\nrows = {}\npitch_mm = {pitch_mm:?}\ndepth_mm = {depth_mm:?}\n\
         {more}\n",
        size[0], size[1]
    )
}

/// What was said but for how far long work has come, which is logged every ten seconds.
pub fn without_progress(stderr: &[u8]) -> String {
    let is_progress =
        |line: &str| line.strip_suffix(" s").is_some_and(|line| line.ends_with(|last: char| last.is_ascii_digit()));
    let said = String::from_utf8_lossy(stderr);
    said.lines().filter(|line| !is_progress(line)).map(|line| format!("{line}\n")).collect()
}

/// Whether nothing else was said.
pub fn only_progress(stderr: &[u8]) -> bool {
    without_progress(stderr).is_empty()
}
