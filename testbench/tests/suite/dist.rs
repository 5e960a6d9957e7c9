//! A release: what is in its archive, and that tag, version and changelog must agree.

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use crate::support::workspace;
use testbench::tools;

fn dist(arguments: &[&Path]) -> Output {
    tools::python().expect("installed").arg(workspace("tools/dist.py")).args(arguments).output().expect("starts")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// The archive of the three commands, which are stood in for by scripts that start them: they are large.
fn archive(folder: &Path) -> PathBuf {
    let commands = folder.join("commands");
    fs::create_dir_all(&commands).expect("a folder");
    for name in ["golden", "hdl-gen", "testbench"] {
        let program = Path::new(env!("CARGO_BIN_EXE_testbench")).with_file_name(name);
        let script = commands.join(name);
        fs::write(&script, format!("#!/bin/sh\nexec {} \"$@\"\n", program.display())).expect("writable");
        fs::set_permissions(&script, fs::Permissions::from_mode(0o755)).expect("writable");
    }
    let out = folder.join("out");
    let made = dist(&[&commands, &out]);
    assert!(made.status.success(), "{}", text(&made.stderr));
    let mut files = fs::read_dir(out).expect("a folder").map(|entry| entry.expect("an entry").path());
    let archive = files.next().expect("an archive");
    assert!(files.next().is_none(), "one archive");
    archive
}

#[test]
fn an_archive_has_all_that_the_commands_need_and_is_the_same_again() {
    crate::docs::commands();
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
        "share/man/man1/golden-calibrate.1",
        "share/bash-completion/completions/hdl-gen",
        "share/zsh/site-functions/_testbench",
        "share/sptfra/LICENSE-MIT",
        "share/sptfra/docs/formats.md",
    ] {
        assert!(unpacked.join(file).is_file(), "no {file}");
    }
    // What is unpacked works where it lies.
    let mut golden = Command::new(unpacked.join("bin/golden"));
    golden.args(["scene", "scenes/sensor1-hertz.toml", "--out", "frames.csv"]);
    assert!(golden.current_dir(unpacked.join("share/sptfra")).status().expect("starts").success());
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
    assert!(!made.status.success() && said.contains("golden is missing") && said.contains("make dist"), "{said}");
}
