//! The grid search's weights, in the design or in a file beside it.

#![allow(clippy::float_cmp)] // the same bits are meant

use golden::design::{Design, Estimator, StandardError, WEIGHTS_FILE};
use sha2::{Digest, Sha256};

use super::{BARE, refused};

/// Weights whose two hidden units see one taxel.
const WEIGHTS: &str =
    "x+0y+0,mu_x,mu_y,centre_x,centre_y,one,to_x,to_y\n1,2,3,4,5,6,13,-15\n-7,8,-9,10,-11,12,14,131071\n";

fn corrected(keys: &str) -> String {
    format!("{BARE}[algorithm]\ngain = 1\nfriction_correction = [1, 0]\n[algorithm.correction]\n{keys}")
}

/// The keys of a correction by `weights` in the file w.csv.
fn keys(weights: &str) -> String {
    let hash: String = Sha256::digest(weights).iter().map(|byte| format!("{byte:02x}")).collect();
    format!("half_window = [0, 0]\nfile = \"w.csv\"\nsha256 = \"{hash}\"\n")
}

fn design() -> Design {
    let files = [("w.csv", WEIGHTS.to_owned())];
    Design::from_parts(&corrected(&keys(WEIGHTS)), "pad.toml", &files).unwrap()
}

#[test]
fn weights_stand_in_a_file_of_their_own() {
    let design = design();
    let (resolved, files) = (design.to_toml(), design.files());
    assert_eq!(files, [(WEIGHTS_FILE, WEIGHTS.to_owned())]);
    assert!(resolved.contains("file = \"weights.csv\"\nsha256 = \""), "{resolved}");
    assert_eq!(Design::from_parts(&resolved, "resolved", &files).unwrap(), design);
    let renamed = design.to_toml_with(|_| "a \"b\".csv".to_owned());
    assert_eq!(Design::from_parts(&renamed, "resolved", &[("a \"b\".csv", WEIGHTS.to_owned())]).unwrap(), design);
    // The line search has no weights to write.
    let mut line = design.clone();
    line.algorithm.estimator = Estimator::Line;
    assert!(line.files().is_empty() && !line.to_toml().contains("correction"));
}

#[test]
fn weights_that_are_not_those_of_the_design() {
    let (resolved, weights) = (design().to_toml(), WEIGHTS);
    let said = |content: Option<String>| {
        let files: Vec<_> = content.into_iter().map(|content| (WEIGHTS_FILE, content)).collect();
        Design::from_parts(&resolved, "pad.toml", &files).unwrap_err().to_string()
    };
    for (message, parts) in [
        (said(None), ["pad.toml", "algorithm.correction.file", "weights.csv", "cannot be read", "sptfra calibrate"]),
        (
            said(Some(weights.replace("131071", "131070"))),
            ["pad.toml", "algorithm.correction.sha256", "weights.csv", "other weights", "sptfra calibrate"],
        ),
    ] {
        assert!(parts.iter().all(|part| message.contains(part)) && !message.contains('\n'), "{message}");
    }
    // With the right hash of a wrong table, as somebody who edits both could have it.
    let wrong = weights.replace("131071", "131072");
    let error = Design::from_parts(&corrected(&keys(&wrong)), "pad.toml", &[("w.csv", wrong)]).unwrap_err().to_string();
    assert!(
        ["w.csv", "line 3", "131072", "131071", "sptfra calibrate"].iter().all(|part| error.contains(part)),
        "{error}"
    );
}

#[test]
fn corrections_that_contradict_themselves() {
    let file = "file = \"w.csv\"\n";
    for (keys, parts) in [
        ("half_window = [0, 0]\nsha256 = \"0\"\n".to_owned(), ["missing key", "file", "algorithm.correction"]),
        (format!("half_window = [0, 0]\n{file}"), ["missing key", "sha256", "algorithm.correction"]),
        (format!("half_window = [0]\n{file}sha256 = \"0\"\n"), ["half_window", "has 1 values", "use two"]),
        (format!("half_window = [0, 9]\n{file}sha256 = \"0\"\n"), ["half_window[1]", "is 9", "0 to 7"]),
        (format!("half_window = [0, 0]\n{file}sha256 = \"0\"\nhash = 1\n"), ["hash", "unknown key", "sha256"]),
    ] {
        refused(&corrected(&keys), &parts);
    }
}

/// The standard error and its limit are keys of every estimator, and are read back.
#[test]
fn a_standard_error_goes_with_every_estimator() {
    for (estimator, constants) in [("line", ""), ("joint", "gain = 1.0\nfriction_correction = [1.0, 0.0]\n")] {
        let text = |keys: &str| format!("{BARE}[algorithm]\nestimator = \"{estimator}\"\n{constants}{keys}");
        let keys = "standard_error = { model = 0.03, noise = 120.0, border = 1.5 }\nmax_standard_error = 0.2\n";
        let design = Design::from_toml(&text(keys), "pad.toml").unwrap();
        let stated = StandardError { model: 0.03, noise: 120.0, border: 1.5 };
        assert_eq!((design.algorithm.standard_error, design.algorithm.max_standard_error), (Some(stated), 0.2));
        assert_eq!(Design::from_toml(&design.to_toml(), "resolved").unwrap(), design);
        refused(&text("standard_error = { model = 0.03, noise = 120.0 }\n"), &["standard_error", "border"]);
        refused(
            &text("standard_error = { model = 0.0, noise = 120.0, border = 1.5 }\n"),
            &["standard_error.model", "0.001"],
        );
    }
}

#[test]
fn an_expected_error_has_a_number_for_each_noise() {
    let text = |errors: &str| format!("{BARE}[algorithm]\nestimator = \"line\"\nexpected_error = {{ {errors} }}\n");
    let design =
        Design::from_toml(&text("noise = [0.0, 0.01], median = [1.0, 5.0], p95 = [2.0, 10.0]"), "pad.toml").unwrap();
    let expected = design.algorithm.expected_error.as_ref().unwrap();
    assert_eq!(
        [0.0, 0.005, 0.01, 0.1].map(|noise| expected.at(noise)),
        [[1.0, 2.0], [3.0, 6.0], [5.0, 10.0], [5.0, 10.0]]
    );
    assert_eq!(Design::from_toml(&design.to_toml(), "resolved").unwrap(), design);
    for (errors, key) in [
        ("noise = [], median = [], p95 = []", "expected_error.noise"),
        ("noise = [0.0, 0.0], median = [1.0, 5.0], p95 = [2.0, 10.0]", "expected_error.noise"),
        ("noise = [0.0, nan], median = [1.0, 5.0], p95 = [2.0, 10.0]", "expected_error.noise"),
        ("noise = [0.0], median = [1.0, 5.0], p95 = [2.0]", "expected_error.median"),
        ("noise = [0.0], median = [1.0], p95 = [-2.0]", "expected_error.p95"),
    ] {
        refused(&text(errors), &[key, "sptfra calibrate"]);
    }
}

/// Constants of one training set, noise or average are not those of another.
#[test]
fn training_set_noise_and_smoothing_are_part_of_what_constants_are_calibrated_for() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../designs/sensor2-wide.toml");
    let text = std::fs::read_to_string(&path).unwrap();
    assert!(Design::load(&path).is_ok());
    let other = text.replace("training_set = \"general\"\n", "");
    refused(&other, &["algorithm.calibrated_for", "general\"", "sptfra calibrate"]);
    let noisier = text.replace("noise = 0.01\n", "noise = 0.02\n");
    refused(&noisier, &["algorithm.calibrated_for", "noise 0.01", "noise 0.02", "sptfra calibrate"]);
    // Averages have less noise than single frames, for which these constants are good.
    let smoothed = |text: &str, k: u32| text.replace("noise = 0.01\n", &format!("noise = 0.01\nsmoothing = {k}\n"));
    let beside = path.with_file_name("smoothed.toml");
    assert!(Design::from_toml(&smoothed(&text, 4), beside.to_str().unwrap()).is_ok());
    let of_averages = text.replace("noise 0.01, general", "noise 0.01, smoothing 4, general");
    assert!(Design::from_toml(&smoothed(&of_averages, 4), beside.to_str().unwrap()).is_ok());
    for other in [of_averages.clone(), smoothed(&of_averages, 2)] {
        refused(&other, &["algorithm.calibrated_for", "noise 0.01, smoothing 4, general", "sptfra calibrate"]);
    }
}
