//! What is found of a scene's forces: the field of a frame beside the true one, and how well its contacts are separated.

use golden::contacts::MOST;
use golden::design::{Design, Estimator, Input, Outputs};
use golden::metrics::ContactErrors;
use golden::scene::SceneFrame;
use golden::solver::Solver;
use hdl_gen::plan::Plan;

use super::PageError;
use super::matrices::Figure;
use crate::field_plot;
use crate::sweep::SweepScene;
use crate::sweep::evaluate::answers;
use crate::sweep::grid::filter_text;
use crate::sweep::point::{Calibration, Point};

/// The frame whose field is drawn, if the scene has so many: 40° in a sweep of tens.
const DRAWN_FRAME: usize = 4;

/// The designs with those first that a page speaks of first: the recommended point's, then those by the estimator that new
/// designs have.
pub fn in_order<'a>(designs: &[&'a Design], recommended: Option<&Point>) -> Vec<&'a Design> {
    let rank = |design: &&Design| {
        let algorithm = &design.algorithm;
        let is_recommended = recommended.is_some_and(|point| {
            (point.plan, point.estimator, point.kernel) == (algorithm.plan, algorithm.estimator, algorithm.kernel)
                && point.calibration == Calibration::of(algorithm)
        });
        // Of a sweep over filters the point may have one that no design has.
        let filtered_alike = recommended.is_some_and(|point| point.filter == filter_text(&algorithm.filter));
        (!is_recommended, !filtered_alike, algorithm.estimator != Estimator::Joint)
    };
    let mut designs = designs.to_vec();
    designs.sort_by_key(rank);
    designs
}

/// The field of one frame, by the first design that has one.
///
/// # Errors
/// [`PageError::Sweep`] if the design has no answer.
pub fn field(designs: &[&Design], scene: Option<&SweepScene>) -> Result<(Vec<Figure>, String), PageError> {
    let shows = |design: &&&Design| design.algorithm.outputs == Outputs::Field && Plan::new(design).is_ok();
    let shown = designs.iter().find(shows);
    let (Some(design), Some(scene)) = (shown, scene) else {
        return Ok((Vec::new(), String::new()));
    };
    let frame = DRAWN_FRAME.min(scene.frames.stress.len() - 1);
    let mut frames = scene.frames.clone();
    frames.stress = vec![frames.stress.swap_remove(frame)];
    let found = answers(design, &frames)?;
    let (Some(answer), Some(truth)) = (found.first(), scene.frames.truth_of(frame)) else {
        return Ok((Vec::new(), String::new()));
    };
    let force = truth.force;
    let search = if design.algorithm.estimator == Estimator::Joint { "grid" } else { "line" };
    let caption = format!(
        "Frame {frame} of scene {}: pushed with ({:.2}, {:.2}, {:.2}) N; the hardware of {}, {search} search, finds \
         ({:.2}, {:.2}, {:.2}) N.",
        scene.name,
        force[0],
        force[1],
        force[2],
        design.name,
        answer.resultant[0],
        answer.resultant[1],
        answer.resultant[2]
    );
    let sensor = &design.sensor;
    let felt: Vec<f64> = design.stress_of(&frames.stress[0]);
    let found = field_plot::forces(sensor, answer, Some(&truth));
    let mut figures = vec![
        Figure { svg: field_plot::stress(sensor, &felt), caption: "what the taxels feel".to_owned() },
        Figure { svg: found, caption: "what the hardware finds, and in orange what is true".to_owned() },
    ];
    if let Some(field) = &truth.field {
        let caption = "what each taxel's force is off the true load of its cell of the surface".to_owned();
        figures.push(Figure { svg: field_plot::errors(sensor, answer, field), caption });
    }
    Ok((figures, caption))
}

/// How well the contacts of a scene are separated, in f64, by the first design with the grid search.
pub fn contacts(designs: &[&Design], scene: &SweepScene) -> Option<String> {
    let contacts = scene.contacts.len();
    if !(2..=MOST).contains(&contacts) {
        return None;
    }
    let of_joint = |design: &&&Design| design.algorithm.estimator == Estimator::Joint;
    let mut design = (*designs.iter().find(of_joint)?).clone();
    // Scenes are in pascals, whatever the sensor counts.
    design.input = Input::default();
    design.algorithm.contacts = contacts;
    let solver = Solver::new(&design).ok()?;
    let solve = |frame: &SceneFrame| solver.solve(&frame.stress);
    let solutions: Vec<_> = scene.made.iter().map(solve).collect::<Result<_, _>>().ok()?;
    let errors = ContactErrors::new(scene.made.iter().map(|frame| &frame.contacts).zip(&solutions));
    Some(format!(". Separated in f64, by {} with contacts = {contacts}: {}", design.name, figures(&errors)))
}

/// How many frames have the right number, and the errors of their contacts.
fn figures(errors: &ContactErrors) -> String {
    let number = format!("number right in {} of {} frames", errors.right, errors.frames);
    let own = match errors.right {
        0 => String::new(),
        _ => format!(
            "; the force along the surface of each of them errs by {:.1} % of its own F_z (median; worst: {:.1})",
            errors.tangential.median, errors.tangential.worst
        ),
    };
    number + &own
}

#[cfg(test)]
mod tests {
    use super::super::conclusion::tests::point;
    use super::*;

    /// A scene of one contact has nothing to separate.
    #[test]
    fn contacts_are_separated_in_f64() {
        let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        let design = Design::load(&root.join("designs/sensor1-fast.toml")).expect("a design");
        let scene = |name: &str| SweepScene::load(&root.join(format!("scenes/{name}.toml"))).expect("a scene");
        let said = contacts(&[&design], &scene("two-contacts")).expect("two contacts");
        assert!(said.contains("in f64, by sensor1_fast with contacts = 2: number right in 1 of 1 frames; "), "{said}");
        assert_eq!(contacts(&[&design], &scene("sensor1-tilted")), None);
    }

    #[test]
    fn the_recommended_design_comes_first() {
        let designs = ["sensor1-reduced", "sensor1-fast", "sensor1-wide"].map(|name| {
            let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../designs");
            Design::load(&folder.join(format!("{name}.toml"))).expect("a design")
        });
        let names = |point: Option<&Point>| {
            let ordered = in_order(&designs.each_ref(), point);
            ordered.iter().map(|design| design.name.clone()).collect::<Vec<_>>()
        };
        let mut recommended = point("a", 16, 2000, 2.0);
        recommended.estimator = Estimator::Joint;
        recommended.calibration = Calibration::of(&designs[2].algorithm);
        assert_eq!(names(Some(&recommended)), ["sensor1_wide", "sensor1_fast", "sensor1_reduced"]);
        assert_eq!(names(Some(&point("a", 16, 2000, 2.0)))[0], "sensor1_reduced");
        assert_eq!(names(None), ["sensor1_fast", "sensor1_wide", "sensor1_reduced"]);
    }
}
