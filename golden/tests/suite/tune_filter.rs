//! Filter F3: the search against the solver, the stored choices, and what is refused.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

use crate::designs::design;
use golden::design::{Design, Estimator, Filter, MatrixFilter};
use golden::filter::FilteredMatrices;
use golden::matrices::{Matrices, MatrixName};
use golden::scene::{Scene, SceneFrame};
use golden::solver::Solver;
use golden::tune_filter::{self, Choice, candidate_count, mean_error, reference_frames};

/// The folder of the designs with filter F3.
fn designs() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/designs")
}

fn search(design: &Design, frames: &[SceneFrame]) -> Choice {
    let ticks = AtomicUsize::new(0);
    let tick = || {
        ticks.fetch_add(1, Ordering::Relaxed);
    };
    let choice = tune_filter::tune_filter(design, frames, &tick).unwrap();
    assert_eq!(ticks.into_inner(), choice.candidates.len());
    assert_eq!(candidate_count(design.sensor.taxels()), choice.candidates.len());
    choice
}

#[test]
fn the_search_gives_the_stored_choices() {
    // Nnz and mean error of friction, with the choices and without a filter, as measured here.
    for (name, nnz, chosen, unfiltered) in [("sensor1-f3", 50_618, 1.460, 0.923), ("sensor2-f3", 37_830, 3.138, 1.939)]
    {
        let design = design(name);
        let frames = reference_frames(&design, &designs()).unwrap();
        assert_eq!(frames.len(), 36);
        let choice = search(&design, &frames);
        assert_eq!(choice.candidates.len(), 13 * 18);
        let Filter::F3 { choices: Some(stored), .. } = &design.algorithm.filter else { panic!("{name} has choices") };
        assert_eq!(choice.choices(), **stored, "{name}");
        assert_eq!(choice.nnz_chosen, nnz);
        assert!((choice.e_mu_chosen - chosen).abs() < 5e-4, "{}", choice.e_mu_chosen);
        assert!((choice.e_mu_unfiltered - unfiltered).abs() < 5e-4, "{}", choice.e_mu_unfiltered);
        // The same with a solver made from the file.
        let solver = Solver::new(&design).unwrap();
        assert!((mean_error(&solver, &frames).unwrap() - choice.e_mu_chosen).abs() < 1e-12);
        assert_eq!(MatrixName::ALL.map(|matrix| solver.filtered().unwrap().nnz(matrix)).iter().sum::<usize>(), nnz);
    }
}

#[test]
fn the_designs_own_estimator_judges() {
    let mut design = design("small");
    let mut scene = Scene::standing(&design.sensor);
    scene.sweep_deg = vec![7.0, 100.0, 256.0];
    let frames = scene.frames().unwrap();
    let by_line = search(&design, &frames);
    // On 12 taxels the only band of the sweep is L = 10.
    assert_eq!(by_line.candidates.len(), 13 * 10);
    design.algorithm.estimator = Estimator::Joint;
    assert_ne!(search(&design, &frames), by_line);
}

/// The error of a candidate is that of a solver in which its matrix alone is filtered.
#[test]
fn the_cheapest_candidate_of_each_matrix_is_chosen() {
    let design = design("sensor1-f3");
    let frames: Vec<_> = reference_frames(&design, &designs()).unwrap().into_iter().step_by(7).collect();
    let choice = search(&design, &frames);
    let matrices = Matrices::new(&design.sensor, design.algorithm.kernel).unwrap();
    for of_matrix in choice.candidates.chunks(18) {
        let least = of_matrix.iter().map(|candidate| candidate.cost).fold(f64::INFINITY, f64::min);
        let chosen: Vec<_> = of_matrix.iter().filter(|candidate| candidate.chosen).collect();
        assert_eq!(chosen.len(), 1);
        assert_eq!(chosen[0].cost.to_bits(), least.to_bits());
        for candidate in of_matrix {
            assert_eq!(candidate.cost.to_bits(), (candidate.e_mu * candidate.nnz as f64).to_bits());
        }
        for one in [chosen[0], &of_matrix[0], &of_matrix[17]] {
            let mut filters = [MatrixFilter::None; 13];
            filters[one.matrix.index()] = one.filter;
            let alone = Filter::F3 { scenes: Vec::new(), choices: Some(Box::new(filters)) };
            let filtered = FilteredMatrices::new(&matrices, &alone).unwrap();
            assert_eq!(filtered.nnz(one.matrix), one.nnz);
            let e_mu = mean_error(&Solver::from_parts(&design, matrices.clone(), filtered), &frames).unwrap();
            assert_eq!(e_mu.to_bits(), one.e_mu.to_bits());
        }
    }
}

#[test]
fn the_first_of_equal_candidates_is_chosen() {
    // Without a contact every error is that of an estimate of 0, and only the entries decide: the narrowest band.
    let design = design("sensor1-f3");
    let mut frames = reference_frames(&design, &designs()).unwrap();
    frames.truncate(1);
    frames[0].stress.fill(0.0);
    let choice = search(&design, &frames);
    assert!((choice.e_mu_unfiltered - 50.0).abs() < 1e-12);
    for matrix in MatrixName::ALL {
        assert_eq!(choice.choices()[matrix.index()], MatrixFilter::F1 { l: 90 });
    }
    // With an error of 0 all cost the same: the first, a band, wins.
    frames[0].friction = 0.0;
    let choices = search(&design, &frames).choices();
    for matrix in MatrixName::ALL {
        assert_eq!(choices[matrix.index()], MatrixFilter::F1 { l: 10 });
    }
}

#[test]
fn a_design_without_choices_is_refused_with_the_way_on() {
    let mut design = design("sensor1-f3");
    design.algorithm.filter = Filter::F3 { scenes: vec!["../scenes/sensor1-hertz.toml".to_owned()], choices: None };
    let message = Solver::new(&design).unwrap_err().to_string();
    for part in ["sensor1_f3", "no choices", "sptfra tune-filter", "--out"] {
        assert!(message.contains(part), "no {part:?} in: {message}");
    }
}

#[test]
fn wrong_scenes_are_refused() {
    let with = |filter| {
        let mut design = design("sensor1-f3");
        design.algorithm.filter = filter;
        reference_frames(&design, &designs()).unwrap_err()
    };
    let scenes = |path: &str| Filter::F3 { scenes: vec![path.to_owned()], choices: None };
    for (filter, parts) in [
        (Filter::F1 { l: 40 }, vec!["sensor1_f3", "not f3", "scenes = ["]),
        (Filter::F3 { scenes: Vec::new(), choices: None }, vec!["sensor1_f3", "no scenes", "scenes = ["]),
        (scenes("../../../scenes/absent.toml"), vec!["absent.toml", "cannot read"]),
        (scenes("../../../scenes/sensor2-disc.toml"), vec!["sensor2-disc.toml", "[sensor]", "sensor1_f3", "pitch_mm"]),
        (scenes("odd.toml"), vec!["reference scene", "odd.toml", "line 11", "algorithm"]),
    ] {
        let message = with(filter);
        for part in parts {
            assert!(message.contains(part), "no {part:?} in: {message}");
        }
        assert!(!message.contains('\n'), "{message}");
    }
}
