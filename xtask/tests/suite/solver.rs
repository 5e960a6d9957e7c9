//! Frames a second of the f64 solver: the report. No time is judged.

use std::path::Path;
use std::process::Command;

use crate::support::workspace;

#[test]
fn bench_measures_each_design() {
    let xtask =
        |arguments: &[&Path]| Command::new(env!("CARGO_BIN_EXE_xtask")).arg("solver").args(arguments).output().unwrap();
    let designs = ["golden/tests/designs/small.toml", "golden/tests/designs/odd.toml"].map(workspace);
    let output = xtask(&[&designs[0], &designs[1], "--json".as_ref()]);
    assert!(output.status.success(), "{output:?}");
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    for (report, (name, plan, taxels)) in
        report.as_array().unwrap().iter().zip([("small_4x3", "reduced", 12), ("odd", "paper", 35)])
    {
        assert_eq!(
            (&report["design"], &report["plan"], &report["taxels"]),
            (&name.into(), &plan.into(), &taxels.into())
        );
        for way in ["one_by_one", "in_batches", "on_all_cores"] {
            let figure = |key: &str| report[way][key].as_f64().unwrap();
            let [rate, time] = ["frames_per_second", "us_per_frame"].map(figure);
            assert!((rate * time / 1e6 - 1.0).abs() < 1e-9 && time > 0.1 && time < 1e5, "{report}");
            let range = [0, 1].map(|end| report[way]["us_per_frame_range"][end].as_f64().unwrap());
            assert!(range[0] <= time && time <= range[1], "{report}");
        }
    }
    let refused = xtask(&["no/such.toml".as_ref()]);
    assert!(!refused.status.success() && String::from_utf8(refused.stderr).unwrap().contains("no/such.toml"));
}
