//! One case in three arithmetics.

use golden::contacts::ContactForces;
use golden::dead_taxels::DeadTaxels;
use golden::design::{Design, Estimator, Scaling};
use golden::matrices::Matrices;
use golden::metrics::{ContactErrors, field_error};
use golden::parity::COMPONENTS;
use golden::products::{Engine, ProductList};
use golden::reduced::ReducedMatrices;
use golden::solver::{Solution, Solver, Status};
use hdl_gen::cores::{WIDE_COEFFICIENT_BITS, WIDE_DATA_BITS};
use hdl_gen::plan::streams::Streams;
use hdl_gen::plan::{Plan, PlanError};
use serde::Serialize;

use super::cases::Case;
use super::float32::Single;
use testbench::accuracy::{StatusCounts, against_truth};
use testbench::co_simulation::model_answers;
use testbench::stream_words::{as_received, decode, packets};

/// A resultant beyond this times what the stress would mean as a pressure, `sum |b|` times a taxel's area, is beyond
/// reason.
const REASON: f64 = 4.0;

/// What an arithmetic makes of a case.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Judged {
    /// Largest error of `F_x` and `F_y` against the truth in percent of the normal force; of several contacts see [`of_contacts`].
    pub tangential: Option<f64>,
    /// The same of `F_z`.
    pub normal: Option<f64>,
    /// Largest difference of a taxel's force to that of f64, relative to the frame's largest `|f_z|`; frames that f64
    /// answers.
    pub against_f64: Option<f64>,
    /// The same where f64 takes the friction that was found: what is left without the estimator's error.
    pub at_its_friction: Option<f64>,
    /// Largest backward error `|A f - b| / (|A| |f| + |b|)` in the maximum norm, frames with an answer.
    pub backward: Option<f64>,
    /// Frames with a NaN or an infinity, or with a force beyond reason, whose status is good.
    pub silent: usize,
    /// Status of the frames.
    pub status: Vec<(String, usize)>,
}

/// One case.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// What it is about.
    pub group: &'static str,
    /// The case.
    pub case: String,
    /// The estimator.
    pub estimator: Estimator,
    /// Frames.
    pub frames: usize,
    /// Condition number of C33.
    pub condition_c33: Option<f64>,
    /// Condition number of `A A^T`.
    pub condition_aat: Option<f64>,
    /// The f64 solver.
    pub f64: Option<Judged>,
    /// The same in float32; the line search only.
    pub f32: Option<Judged>,
    /// The integer model of the hardware.
    pub fixed: Option<Judged>,
    /// The same of the design in its most exact form: see [`wide`].
    pub wide: Option<Judged>,
    /// Whether the simulated RTL gave the integer model's words; nothing if it was not asked, or there is none.
    pub rtl_is_model: Option<bool>,
    /// Why there is no hardware, or no solver.
    pub refusal: Option<String>,
}

/// The design with words as wide as two multipliers a lane take, and frames scaled by their own largest stress.
pub fn wide(design: &Design) -> Design {
    let mut wide = design.clone();
    (wide.hardware.coefficient_bits, wide.hardware.data_bits) = (WIDE_COEFFICIENT_BITS, WIDE_DATA_BITS);
    wide.hardware.scaling = Scaling::PerFrame;
    wide
}

/// Solves a case in f64, in float32 and in the hardware's integers.
pub fn judge(case: &Case) -> Row {
    let mut row = Row {
        group: case.group,
        case: case.name.clone(),
        estimator: case.design.algorithm.estimator,
        frames: case.frames.len(),
        condition_c33: None,
        condition_aat: None,
        f64: None,
        f32: None,
        fixed: None,
        wide: None,
        rtl_is_model: None,
        refusal: None,
    };
    let solver = match Solver::new(&case.design) {
        Ok(solver) => solver,
        Err(refusal) => {
            row.refusal = Some(refusal.to_string());
            if let Ok(matrices) = Matrices::new(&case.design.sensor, case.design.algorithm.kernel) {
                row.condition_c33 = Some(matrices.condition_c33());
                row.condition_aat = Some(matrices.condition_aat());
            }
            return row;
        }
    };
    row.condition_c33 = Some(solver.matrices().condition_c33());
    row.condition_aat = Some(solver.matrices().condition_aat());
    let streams = Streams::of(&case.design);
    let packets = packets(streams, &case.frames);
    let mut frames: Vec<Vec<f64>> = packets.iter().map(|packet| as_received(streams, packet)).collect();
    // Frames have the sensor's length, the only thing that the solver refuses.
    let reference: Vec<Solution> = frames.iter().filter_map(|frame| solver.solve(frame).ok()).collect();
    // What float32 and the errors see in place of dead taxels' readings is what the solver and the hardware put there.
    let dead = DeadTaxels::new(&case.design.sensor, case.design.algorithm.kernel, &case.design.input.dead);
    for frame in &mut frames {
        dead.replace(frame);
    }
    let fields = Fields::new(&case.design, &solver);
    let judged = |answers: &[Solution]| judged(case, (&solver, fields.as_ref()), &frames, &reference, answers);
    row.f64 = Some(judged(&reference));
    let of_contacts = of_contacts(case, &frames);
    if let (Some(found), Some(errors)) = (&mut row.f64, of_contacts) {
        (found.tangential, found.normal) = (Some(errors.tangential.worst), Some(errors.normal.worst));
    }
    if let Some(single) = Single::new(&case.design, &solver) {
        row.f32 = Some(judged(&frames.iter().map(|frame| single.solve(frame)).collect::<Vec<_>>()));
    }
    let in_integers = |design: &Design| {
        let plan = Plan::new(design)?;
        let words = model_answers(&plan, &packets);
        let answers = words.iter().filter_map(|words| decode(words));
        Ok(judged(&answers.collect::<Vec<_>>()))
    };
    match in_integers(&case.design) {
        Ok(fixed) => row.fixed = Some(fixed),
        Err(refusal) => row.refusal = Some(PlanError::to_string(&refusal)),
    }
    row.wide = in_integers(&wide(&case.design)).ok();
    row
}

/// The design that separates as many contacts as a case has, and the true ones, where a case asks for them.
fn separating(case: &Case) -> Option<(Design, &[Vec<ContactForces>])> {
    let truth = case.contacts.as_ref()?;
    let mut design = case.design.clone();
    design.algorithm.contacts = truth.iter().map(Vec::len).max()?;
    Some((design, truth))
}

/// Errors of each contact, over its own normal force, by the solver that separates contacts, where a case asks for them.
/// Nothing if it finds another number of contacts in any frame.
fn of_contacts(case: &Case, frames: &[Vec<f64>]) -> Option<ContactErrors> {
    let (design, truth) = separating(case)?;
    let solver = Solver::new(&design).ok()?;
    let solutions: Vec<Solution> = frames.iter().filter_map(|frame| solver.solve(frame).ok()).collect();
    let errors = ContactErrors::new(truth.iter().zip(&solutions));
    (errors.right == frames.len()).then_some(errors)
}

/// The fields of the reduced plan in f64, with a friction that something else has found.
struct Fields {
    engine: Engine<f64, ReducedMatrices, COMPONENTS>,
    full_scale: f64,
    gain: f64,
}

impl Fields {
    /// From the matrices of a solver; `None` for another plan.
    fn new(design: &Design, solver: &Solver) -> Option<Self> {
        let orbits = solver.matrices().orbits();
        let list = ProductList::paper().fewer_products(true).folded();
        Some(Self {
            engine: Engine::new(list, solver.reduced()?.clone(), orbits.all(), orbits.taxels()),
            full_scale: design.hardware.full_scale_in_frames(),
            gain: design.algorithm.gain(),
        })
    }

    /// The field of a frame.
    fn at(&self, frame: &[f64], mu: [f64; 2]) -> [Vec<f64>; 3] {
        let mut of_frame = self.engine.frame();
        for (b, stress) in of_frame.stress.iter_mut().zip(frame) {
            *b = stress.clamp(-self.full_scale, self.full_scale);
        }
        self.engine.until_friction(&mut of_frame);
        let mut field = std::array::from_fn(|_| vec![0.0; frame.len()]);
        self.engine.field(mu, &mut of_frame, |p, taxel, force| field[p][taxel] = self.gain * force);
        field
    }
}

fn judged(
    case: &Case,
    (solver, fields): (&Solver, Option<&Fields>),
    frames: &[Vec<f64>],
    reference: &[Solution],
    answers: &[Solution],
) -> Judged {
    // One contact is no answer to what each of several does.
    let truth = case.truth.as_ref().filter(|_| case.contacts.is_none());
    let errors = truth.map(|truth| against_truth(answers, truth));
    let answered = || answers.iter().zip(frames).filter(|(answer, _)| has_field(answer));
    let largest = |values: &mut dyn Iterator<Item = f64>| values.reduce(f64::max);
    let same = std::ptr::eq(answers, reference);
    let mut differences = reference
        .iter()
        .zip(answers)
        .filter(|(one, _)| !same && has_field(one))
        .map(|(one, other)| field_error(&one.field, &other.field));
    let mut at_its_friction = fields.into_iter().flat_map(|fields| {
        let of_frame = move |(answer, frame): (&Solution, &Vec<f64>)| {
            field_error(&fields.at(frame, [answer.mu_x, answer.mu_y]), &answer.field)
        };
        answered().filter(move |_| !same).map(of_frame)
    });
    let full_scale = case.design.hardware.full_scale_pa;
    let mut backward = answered().map(|(answer, frame)| backward_error(solver.matrices(), answer, frame, full_scale));
    let silent = answers.iter().zip(frames).filter(|(answer, frame)| is_silent(case, answer, frame)).count();
    Judged {
        tangential: errors.map(|errors| errors.e_fx.max.max(errors.e_fy.max)),
        normal: errors.map(|errors| errors.e_fz.max),
        against_f64: largest(&mut differences),
        at_its_friction: largest(&mut at_its_friction),
        backward: largest(&mut backward),
        silent,
        status: StatusCounts::new(answers).present(),
    }
}

fn has_field(answer: &Solution) -> bool {
    answer.field.iter().flatten().any(|&force| force != 0.0)
}

/// Whether an answer is no number or beyond reason, and says nothing of it.
fn is_silent(case: &Case, answer: &Solution, frame: &[f64]) -> bool {
    let summary = [answer.mu, answer.phi, answer.mu_x, answer.mu_y].into_iter().chain(answer.resultant);
    let finite = summary.chain(answer.field.iter().flatten().copied()).all(f64::is_finite);
    let [x, y] = case.design.sensor.pitch_mm;
    let full_scale = case.design.hardware.full_scale_pa;
    let stress: f64 = frame.iter().map(|b| b.abs().min(full_scale)).sum();
    let reason = REASON * stress * x * y * 1e-6;
    let wild = answer.resultant.iter().any(|force| force.abs() > reason);
    // A NaN has no excuse.
    !finite || (wild && answer.status == Status(0))
}

/// `|A f - b| / (|A| |f| + |b|)` in the maximum norm; b as it is after clipping.
fn backward_error(matrices: &Matrices, answer: &Solution, frame: &[f64], full_scale: f64) -> f64 {
    let orbits = matrices.orbits();
    let folded = answer.field.each_ref().map(|force| orbits.fold(force));
    let parts = [&matrices.c31, &matrices.c32, &matrices.c33];
    let products: Vec<Vec<f64>> =
        parts.iter().zip(&folded).map(|(matrix, force)| orbits.unfold(&matrix.apply(force))).collect();
    let largest = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0_f64, |max, value| max.max(value.abs()));
    let b: Vec<f64> = frame.iter().map(|stress| stress.clamp(-full_scale, full_scale)).collect();
    let residual =
        largest(&mut b.iter().enumerate().map(|(i, b)| products.iter().map(|part| part[i]).sum::<f64>() - b));
    // The maximum norm of A is at most the sum of those of its parts.
    let norm: f64 = parts.iter().map(|matrix| row_sum(matrix)).sum();
    let force = largest(&mut answer.field.iter().flatten().copied());
    residual / (norm * force + largest(&mut b.iter().copied()))
}

/// Largest sum of magnitudes of a row, from the blocks: at most that of any of them.
fn row_sum(matrix: &golden::parity::FoldedMatrix) -> f64 {
    let rows =
        |block: usize| matrix.blocks[block].row_iter().map(|row| row.iter().map(|entry| entry.abs()).sum::<f64>());
    (0..matrix.blocks.len()).flat_map(rows).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::corner_cases::cases;

    #[test]
    fn of_opposed_contacts_each_is_judged() {
        let cases = cases::all(false).expect("cases");
        let case = cases.iter().find(|case| case.contacts.is_some()).expect("a case");
        let row = judge(case);
        let [f64, fixed] = [&row.f64, &row.fixed].map(|judged| judged.as_ref().expect("answers"));
        // The sum of the two is next to nothing, their own forces are not.
        assert!(f64.tangential.is_some_and(|error| (0.5..30.0).contains(&error)), "{f64:?}");
        assert!(
            fixed
                .status
                .iter()
                .any(|(name, count)| name.contains("more than one contact") && *count == case.frames.len())
        );
    }

    #[test]
    fn wild_and_infinite_answers_are_seen() {
        let cases = cases::all(false).expect("cases");
        let case = cases.iter().find(|case| case.name == "on the axes").expect("a case");
        let solver = Solver::new(&case.design).expect("a solver");
        let good = solver.solve(&case.frames[0]).expect("solved");
        let silent = |change: fn(&mut Solution)| {
            let mut answer = good.clone();
            change(&mut answer);
            is_silent(case, &answer, &case.frames[0])
        };
        assert!(!silent(|_| ()));
        assert!(silent(|answer| answer.resultant[0] = 1000.0));
        assert!(!silent(|answer| (answer.resultant[0], answer.status) = (1000.0, Status(4))));
        assert!(silent(|answer| (answer.field[1][3], answer.status) = (f64::NAN, Status(4))));
        assert!(silent(|answer| answer.mu = f64::INFINITY));
        let error = |answer: &Solution| backward_error(solver.matrices(), answer, &case.frames[0], 1e5);
        let mut wrong = good.clone();
        wrong.field[2].iter_mut().for_each(|force| *force *= 1.01);
        assert!(error(&good) < 1e-14 && error(&wrong) > 1e-4);
    }
}
