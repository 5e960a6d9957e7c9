//! A release: what is in its archive, and that tag, version and changelog must agree.

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use crate::support::{sptfra, workspace};
use testbench::tools;

fn dist(arguments: &[&Path]) -> Output {
    let mut python = tools::program("python").expect("installed");
    python.arg(workspace("tools/dist.py")).args(arguments).output().expect("starts")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// The archive of the command, for which a script that starts it stands in: the program is large.
fn archive(folder: &Path) -> PathBuf {
    let commands = folder.join("commands");
    fs::create_dir_all(&commands).expect("a folder");
    let script = commands.join("sptfra");
    fs::write(&script, format!("#!/bin/sh\nexec {} \"$@\"\n", sptfra().display())).expect("writable");
    fs::set_permissions(&script, fs::Permissions::from_mode(0o755)).expect("writable");
    let out = folder.join("out");
    let made = dist(&[&commands, &out]);
    assert!(made.status.success(), "{}", text(&made.stderr));
    let mut files = fs::read_dir(out).expect("a folder").map(|entry| entry.expect("an entry").path());
    let archive = files.next().expect("an archive");
    assert!(files.next().is_none(), "one archive");
    archive
}

#[test]
fn an_archive_has_all_that_the_command_needs_and_is_the_same_again() {
    let folder = tempfile::tempdir().expect("a folder");
    let first = archive(folder.path());
    let bytes = fs::read(&first).expect("readable");
    assert!(archive(folder.path()) == first && fs::read(&first).expect("readable") == bytes, "other bytes");

    let unpacked = folder.path().join("unpacked");
    fs::create_dir(&unpacked).expect("a folder");
    let mut tar = Command::new("tar");
    let done = tar.arg("xzf").arg(&first).args(["--strip-components", "1", "-C"]).arg(&unpacked).status();
    assert!(done.expect("tar starts").success());
    let notes = fs::read_to_string(unpacked.join("NOTES.md")).expect("there");
    assert!(notes.starts_with("### ") && !notes.contains("\n## "), "{notes}");
    for file in [
        "share/man/man1/sptfra-calibrate.1",
        "share/bash-completion/completions/sptfra",
        "share/zsh/site-functions/_sptfra",
        "share/sptfra/LICENSE-MIT",
        "share/sptfra/docs/reference/files.md",
        "share/sptfra/hdl-gen/boards/zcu102.toml",
    ] {
        assert!(unpacked.join(file).is_file(), "no {file}");
    }
    // What is unpacked works where it lies.
    let mut sptfra = Command::new(unpacked.join("bin/sptfra"));
    sptfra.args(["scene", "scenes/sensor1-hertz.toml", "--out", "frames.csv"]);
    assert!(sptfra.current_dir(unpacked.join("share/sptfra")).status().expect("starts").success());
}

#[test]
fn a_tag_of_another_version_is_refused() {
    let version = hdl_gen::emit::VERSION;
    let check = |tag: &str| dist(&[Path::new("--check"), Path::new(tag)]);
    let other = check("v99.0.0");
    let said = text(&other.stderr);
    assert!(!other.status.success() && said.contains("v99.0.0") && said.contains(version), "{said}");
    // Until a section has the version's name there is nothing to say of it.
    let own = check(&format!("v{version}"));
    let released = fs::read_to_string(workspace("CHANGELOG.md")).expect("there").contains(&format!("\n## [{version}]"));
    assert_eq!(own.status.success(), released, "{}", text(&own.stderr));
}

/// In a copy: the unreleased part becomes the version's, and all that knows the version has it.
#[test]
fn a_release_is_cut_by_the_script() {
    const FILES: [&str; 4] = ["CHANGELOG.md", "Cargo.toml", "Cargo.lock", "CITATION.cff"];
    let folder = tempfile::tempdir().expect("a folder");
    let here = folder.path();
    fs::create_dir(here.join("tools")).expect("a folder");
    for name in FILES.iter().chain(&["tools/dist.py"]) {
        fs::copy(workspace(name), here.join(name)).expect("copied");
    }
    let run = |arguments: &[&str]| {
        let mut python = tools::program("python").expect("installed");
        python.arg(here.join("tools/dist.py")).args(arguments).output().expect("starts")
    };
    let read = |name: &str| fs::read_to_string(here.join(name)).expect("readable");
    // Just behind a release nothing is unreleased yet.
    let changelog = read("CHANGELOG.md").replacen("## [Unreleased]\n", "## [Unreleased]\n\n### Added\n\n- More.\n", 1);
    fs::write(here.join("CHANGELOG.md"), changelog).expect("writable");
    let before = FILES.map(read);
    for (arguments, part) in [
        (["--cut", "0.0.1", "2031-04-05"], "0.0.1 is older"),
        (["--cut", "9.1", "2031-04-05"], "9.1 is no version"),
        (["--cut", "9.1.0", "yesterday"], "yesterday is no day"),
    ] {
        let refused = run(&arguments);
        let said = text(&refused.stderr);
        assert!(!refused.status.success() && said.contains(part) && FILES.map(read) == before, "{said}");
    }
    let unreleased = |text: &str| {
        let part = text.split("\n## [Unreleased]\n").nth(1).and_then(|rest| rest.split("\n## [").next());
        part.expect("a part").trim().to_owned()
    };
    let done = run(&["--cut", "9.1.0", "2031-04-05"]);
    assert!(done.status.success(), "{}", text(&done.stderr));
    let [changelog, manifest, lock, citation] = FILES.map(read);
    assert_eq!(unreleased(&changelog), "");
    assert_eq!(changelog.replacen("\n## [9.1.0] - 2031-04-05\n", "", 1), before[0]);
    assert!(run(&["--check", "v9.1.0"]).status.success());
    assert_eq!(text(&run(&["--notes"]).stdout).trim(), unreleased(&before[0]));
    let version = hdl_gen::emit::VERSION;
    assert_eq!(manifest, before[1].replacen(&format!("\nversion = \"{version}\""), "\nversion = \"9.1.0\"", 1));
    assert_eq!(citation, before[3].replace(&format!("version: {version}"), "version: 9.1.0"));
    let crates = ["golden", "hdl-cores", "hdl-gen", "testbench"].map(|folder| format!("sptfra-{folder}"));
    let others = ["sptfra", "sptfra-python", "sptfra-solver", "xtask"].map(str::to_owned);
    for name in [crates, others].concat() {
        assert!(lock.contains(&format!("name = \"{name}\"\nversion = \"9.1.0\"\n")), "{name}");
    }
    assert_eq!(lock.matches("version = \"9.1.0\"").count(), 8);
    let again = run(&["--cut", "9.1.0", "2031-04-05"]);
    let said = text(&again.stderr);
    assert!(!again.status.success() && said.contains("[9.1.0] already"), "{said}");
    let empty = run(&["--cut", "9.2.0"]);
    assert!(!empty.status.success() && text(&empty.stderr).contains("nothing under [Unreleased]"));
}

#[test]
fn the_citation_has_the_version() {
    let citation = fs::read_to_string(workspace("CITATION.cff")).expect("there");
    assert!(citation.contains(&format!("\nversion: {}\n", hdl_gen::emit::VERSION)), "{citation}");
}

#[test]
fn a_missing_command_is_named() {
    let folder = tempfile::tempdir().expect("a folder");
    let made = dist(&[folder.path(), &folder.path().join("out")]);
    let said = text(&made.stderr);
    assert!(!made.status.success() && said.contains("sptfra is missing") && said.contains("make dist"), "{said}");
}
