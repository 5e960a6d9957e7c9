//! The Python package: its wheel is built, installed into an empty virtual environment, and used there.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::support::workspace;
use testbench::tools;

/// Runs a command to its end; what it said, if it succeeded.
fn run(command: &mut Command) -> String {
    let output = command.output().expect("starts");
    let said = String::from_utf8_lossy(&output.stdout) + String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{command:?}\n{said}");
    said.into_owned()
}

/// The Python of `make tools`, with maturin beside it.
fn python() -> PathBuf {
    PathBuf::from(tools::program("python").expect("make tools was run").get_program())
}

/// The wheel in the development profile, on the crates that the other tests have compiled.
fn wheel(folder: &Path) -> PathBuf {
    let maturin = python().with_file_name("maturin");
    assert!(maturin.is_file(), "{} is missing: run `make wheel-tools`", maturin.display());
    let mut build = Command::new(maturin);
    build.args(["build", "--quiet", "--profile", "dev", "--strip", "--compatibility", "linux", "--interpreter"]);
    build.arg(python()).arg("--out").arg(folder).current_dir(workspace("python"));
    run(&mut build);
    let built = fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path());
    let wheels: Vec<PathBuf> = built.filter(|path| path.extension().is_some_and(|ending| ending == "whl")).collect();
    let [wheel] = wheels.as_slice() else { panic!("one wheel, not {wheels:?}") };
    let name = wheel.file_name().and_then(|name| name.to_str()).expect("a name");
    assert!(name.starts_with(&format!("sptfra-{}-cp310-abi3-", hdl_gen::emit::VERSION)), "{name}");
    wheel.clone()
}

/// An empty virtual environment with the wheel and what that asks for; its Python.
fn installed(wheel: &Path, folder: &Path) -> PathBuf {
    run(Command::new(python()).args(["-m", "venv", "--without-pip"]).arg(folder));
    let own = folder.join("bin/python");
    let mut pip = Command::new(python());
    pip.args(["-m", "pip", "--python"]).arg(&own);
    pip.args(["install", "--quiet", "--disable-pip-version-check", "--no-compile"]);
    // The version of numpy that is pinned.
    pip.arg("--constraint").arg(workspace("tools/requirements.txt")).arg(wheel);
    run(&mut pip);
    own
}

/// The session of docs/how-to/python.md, as it is written.
fn session() -> String {
    let page = fs::read_to_string(workspace("docs/how-to/python.md")).expect("a page");
    let block = page.split("```python\n").nth(1).and_then(|rest| rest.split("```").next());
    block.expect("a session").to_owned()
}

#[test]
fn the_wheel_works_in_an_empty_environment() {
    let folder = tempfile::tempdir().expect("a folder");
    let environment = folder.path().join("environment");
    let own = installed(&wheel(folder.path()), &environment);
    let elsewhere = folder.path().join("elsewhere");
    fs::create_dir(&elsewhere).expect("a folder");
    let tests = ["test_sptfra.py", "test_recordings.py", "test_package.py"];
    let [test, recordings, package] = tests.map(|name| workspace("python/tests").join(name));
    let ready = |program: &Path| {
        let mut command = Command::new(program);
        command.current_dir(&elsewhere).env("SPTFRA_ROOT", workspace("")).env_remove("PYTHONPATH");
        command
    };
    for test in [&test, &recordings, &package] {
        let said = run(ready(&own).arg(test));
        assert!(said.contains("\nOK"), "{said}");
    }
    let said = run(ready(&own).args(["-c", &session()]));
    for stated in ["Spread(max=", "Plan(latency_cycles="] {
        assert!(said.contains(stated), "no {stated:?} in:\n{said}");
    }

    // Matplotlib is where the tools are: the same package, found beside it, draws.
    let site = run(Command::new(&own).args(["-c", "import sptfra; print(sptfra.__path__[0])"]));
    let site = Path::new(site.trim()).parent().expect("a folder");
    let mut drawing = ready(&python());
    drawing.env("PYTHONPATH", site).arg(&package).arg("Package.test_plots_say_what_they_need");
    run(&mut drawing);
    let picture = elsewhere.join("mat.svg");
    let notebook = workspace("python/examples/recording.ipynb");
    let mut running = ready(&python());
    running.env("PYTHONPATH", site).arg(workspace("python/tests/run_notebook.py")).arg(&notebook).arg(&picture);
    // A notebook is opened where it lies.
    let said = run(running.current_dir(workspace("python/examples")));
    for stated in [
        "bed_mat: 24 frames of 64 x 27 taxels",
        "stuck: 73 readings of 22 frames are exactly 104",
        "22 frames with a person: ",
        "22 frames have no direction",
        "9335 frames a second on 97 DSP and 651.5 RAMB36",
        "e_Fx: 2.21 %",
        "frames simulated",
    ] {
        assert!(said.contains(stated), "no {stated:?} in:\n{said}");
    }
    assert!(fs::read_to_string(&picture).expect("a picture").contains("<svg"));
}
