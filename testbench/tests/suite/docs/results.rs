//! Words and numbers of README and docs: `tools/check_text.py`, `tools/plots.py`, and `results/designs.csv` of the plans.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use golden::design::Design;
use golden::output::renew_table;
use hdl_gen::inspection::figures;
use hdl_gen::plan::Plan;

use crate::support::{in_parallel, shipped, workspace};

const COLUMNS: &str =
    "design,latency_cycles,latency_us,interval_cycles,frames_per_second,dsp,ramb36,lut_estimate,energy_uj";

fn run(script: &str, arguments: &[&str]) -> Output {
    let python = workspace(".venv/bin/python");
    Command::new(python).arg(workspace(script)).args(arguments).output().expect("python starts")
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr)
}

fn designs_in(folder: &Path, found: &mut Vec<PathBuf>) {
    for path in fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path()) {
        if path.is_dir() {
            designs_in(&path, found);
        } else if path.extension().is_some_and(|ending| ending == "toml") {
            found.push(path);
        }
    }
}

/// A row of `results/designs.csv`.
fn row(name: &str, design: &Design) -> String {
    let plan = Plan::new(design).unwrap_or_else(|error| panic!("{name}: {error}"));
    let predicted = &figures(&plan)["predicted"];
    let [latency, interval, dsp, lut] = ["/latency_cycles", "/interval_cycles", "/dsp", "/logic_estimate/lut"]
        .map(|key| predicted.pointer(key).and_then(serde_json::Value::as_u64).expect("a number"));
    let [ramb36, energy_nj] = [&predicted["bram36"], &predicted["energy_estimate"]["fabric_nj"]]
        .map(|value| value.as_f64().expect("a number"));
    let mhz = design.hardware.clock_mhz;
    let [microseconds, rate] = [latency as f64 / mhz, mhz * 1e6 / interval as f64];
    format!("{name},{latency},{microseconds:.2},{interval},{rate:.0},{dsp},{ramb36:.1},{lut},{:.1}\n", energy_nj / 1e3)
}

#[test]
fn figures_of_designs_are_those_of_their_plans() {
    let mut paths = Vec::new();
    designs_in(&workspace("designs"), &mut paths);
    paths.sort();
    let named = |path: PathBuf| {
        let design = Design::load(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        (path.file_stem().expect("a name").to_string_lossy().into_owned(), design)
    };
    let designs: Vec<(String, Design)> = paths.into_iter().map(named).collect();
    let rows = in_parallel(&designs, |(name, design)| row(name, design)).concat();
    let file = workspace("results/designs.csv");
    if std::env::var_os("UPDATE_EXPECTED").is_some() {
        renew_table(&file, &designs, COLUMNS, &rows).expect("written");
    }
    let stated = fs::read_to_string(&file).expect("readable");
    assert!(
        stated.ends_with(&format!("{COLUMNS}\n{rows}")),
        "UPDATE_EXPECTED=1 writes results/designs.csv anew:\n{rows}"
    );
}

/// Tables are measured anew when one of their designs changes.
#[test]
fn tables_are_of_the_designs_of_today() {
    let files = fs::read_dir(workspace("results")).expect("a folder").map(|entry| entry.expect("an entry").path());
    let mut files: Vec<PathBuf> = files.filter(|path| path.extension().is_some_and(|ending| ending == "csv")).collect();
    files.sort();
    let (mut count, mut stale) = (0, Vec::new());
    for file in files {
        let text = fs::read_to_string(&file).expect("readable");
        let designs = text.lines().find_map(|line| line.strip_prefix("# designs: ")).unwrap_or_default();
        let named = designs.split(", ").filter_map(|design| design.split_once(' '));
        // What `make designs-at-noise` makes is in no folder.
        let made = |name: &str| name.contains("-at-") || name.contains("-smoothed-");
        for (name, hash) in named.filter(|(name, _)| !made(name)) {
            let own = workspace(&format!("xtask/designs/{name}.toml"));
            let design = if own.is_file() { Design::load(&own).expect("a good design") } else { shipped(name) };
            count += 1;
            if hash != design.hash() {
                stale.push(format!("{}: {name} is {}", file.display(), design.hash()));
            }
        }
    }
    assert!(stale.is_empty(), "measure these by the commands in their headers:\n{}", stale.join("\n"));
    assert!(count > 60, "{count} designs in all tables");
}

#[test]
fn words_and_numbers_of_the_pages_keep_to_the_rules() {
    let checked = run("tools/check_text.py", &[]);
    assert!(checked.status.success(), "{}", said(&checked));
}

#[test]
fn plots_are_those_of_the_results() {
    let checked = run("tools/plots.py", &["--check"]);
    assert!(checked.status.success(), "{}", said(&checked));
}

/// Each rule refuses a page that breaks it.
#[test]
fn a_page_that_breaks_a_rule_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let root = folder.path();
    for name in ["docs", "results"] {
        fs::create_dir(root.join(name)).expect("a folder");
    }
    fs::write(root.join("results/a.csv"), "# about\nkey,other,x\na b,c,2.25\n").expect("written");
    let readme = root.join("README.md");
    let check = |text: &str| {
        fs::write(&readme, text).expect("written");
        let checked = run("tools/check_text.py", &["--root", &root.display().to_string()]);
        (checked.status.success(), said(&checked))
    };
    let right = "It takes 2.3<!--a.csv \"a b/c\" x--> cycles.\n\n<!-- table a.csv: other, x -->\n| d | o | x |\n|---|---|---|\n";
    assert!(check(right).0, "{}", check(right).1);
    let long = "word ".repeat(36) + "ends here.";
    let thousand = "Four words a sentence. ".repeat(251);
    for (text, message) in [
        ("It takes 2.4<!--a.csv \"a b/c\" x--> cycles.", "states 2.4, results/a.csv \"a b/c\" x is 2.25"),
        ("It takes 2.3<!--a.csv d x--> cycles.", "0 rows ['d']"),
        ("It takes 2.3<!--b.csv d x--> cycles.", "No such file"),
        ("<!-- table a.csv: x -->\n| d | x |\n|---|---|\n| `a b` | 3 |\n", "states 3"),
        (&long, "38 words"),
        (&thousand, "1004 words; at most 1000"),
        ("It is doubtful here.", "write 'low confidence'"),
        (&format!("| a | {} |\n|---|---|\n", "x".repeat(81)), "a cell of 81 characters"),
        (&"One two three four five six seven eight nine ten eleven twelve thirteen, fourteen, fifteen, sixteen, seventeen, \
           eighteen, nineteen. "
            .repeat(3), "19.0 words a sentence"),
    ] {
        let (passed, said) = check(text);
        assert!(!passed && said.contains(message), "{message}:\n{said}");
    }
    fs::create_dir_all(root.join("hdl-gen/rtl")).expect("a folder");
    let module = "// A module.\n\nmodule a #(\n    // Taxels\n    parameter B = 1\n) (\n    input wire c\n);\n";
    for (text, message) in [(module.replace("    // Taxels\n", ""), "say what B mean"), (module.to_owned(), "")] {
        fs::write(root.join("hdl-gen/rtl/a.v"), text).expect("written");
        assert!(check(right).1.contains(message) && check(right).0 == message.is_empty(), "{}", check(right).1);
    }
}
