//! What a design will be, before anything is written: its figures, and what to tell its user.

use golden::design::Design;
use golden::kernel;
use serde_json::{Value, json};

use crate::blocks::latency;
use crate::cores::{DspBlock, OLDER_LONG_BITS};
use crate::emit::boards::Board;
use crate::emit::{nnz, predicted, products};
use crate::plan::contacts;
use crate::plan::product::Coefficients;
use crate::plan::savings::savings;
use crate::plan::{Plan, PlanError};

/// Rounding of the coefficients, as a share of their size, from which on it is told.
const COARSE: f64 = 0.005;

/// The plan of a design to be looked at: for several bodies with what no hardware for them has, that for one, with the
/// design as it is.
///
/// # Errors
///
/// As [`Plan::new`].
pub fn plan_to_inspect(design: &Design) -> Result<Plan, PlanError> {
    let contacts = match Plan::new(design) {
        Err(PlanError::Contacts { contacts, .. }) => contacts,
        planned => return planned,
    };
    let mut of_one = design.clone();
    of_one.algorithm.contacts = 1;
    let mut plan = Plan::new(&of_one)?;
    plan.design.algorithm.contacts = contacts;
    Ok(plan)
}

/// What keeps a design for several bodies from having hardware.
fn without_hardware(plan: &Plan) -> Option<String> {
    let contacts = plan.design.algorithm.contacts;
    let needs = contacts::needs(&plan.design).filter(|_| contacts > 1)?;
    Some(format!(
        "contacts {contacts} in golden solve and in Python; hardware for them needs {needs}; all figures here with contacts = 1"
    ))
}

/// What to tell of a design for several bodies.
pub fn several_bodies(plan: &Plan) -> Option<String> {
    let Some(of) = &plan.contacts else { return without_hardware(plan) };
    Some(format!(
        "up to {} told apart, each solved as a frame of its own; all figures here of frames of one; places for {} frames",
        of.contacts, of.banks
    ))
}

/// What to tell of a design whose hardware counts bodies.
pub fn counted_bodies(plan: &Plan) -> Option<String> {
    let Plan { design, .. } = plan;
    (design.algorithm.contacts == 1 && design.algorithm.count_bodies).then(|| {
        let cycles = latency::bodies(&design.sensor);
        format!("solved as one, counted in {cycles} cycles beside the search: status bit 7 tells of more than one")
    })
}

/// All figures of a plan: what `hdl-gen inspect --json` prints.
pub fn figures(plan: &Plan) -> Value {
    let sensor = &plan.design.sensor;
    let mut value = json!({
        "name": plan.design.name,
        "geometry": {
            "columns": sensor.columns,
            "rows": sensor.rows,
            "taxels": plan.taxels(),
            "pitch_mm": sensor.pitch_mm,
            "depth_mm": sensor.depth_mm,
        },
        "nnz": nnz(plan),
        "condition": plan.condition,
        "rom_bits": plan.resources.rom_bits,
        "predicted": predicted(plan),
        "products": products(plan),
        "lanes": plan.design.hardware.lanes,
        "savings": savings(plan),
        "kernel_gain": kernel::gain(sensor, plan.design.algorithm.kernel),
    });
    if plan.scales_frames() {
        value["range"] = json!(plan.design.hardware.range);
    }
    if plan.design.algorithm.count_bodies {
        value["bodies"] = json!({ "cycles": latency::bodies(sensor) });
    }
    if plan.design.algorithm.contacts > 1 {
        value["contacts"] = plan.design.algorithm.contacts.into();
    }
    if let Some((key, own)) = plan.estimator.slot().metadata().own {
        value[key] = own;
    }
    value
}

/// What to tell of a plan: that its layer is too thin, that it does not fit its part or takes two multipliers there in
/// place of one, that its coefficients are coarse, that it has no hardware for several bodies.
pub fn warnings(plan: &Plan) -> Vec<String> {
    [plan.design.thin_layer(), excess(plan), doubled(plan), narrow(plan), without_hardware(plan)]
        .into_iter()
        .flatten()
        .collect()
}

/// Shares of its part's DSP blocks and RAMB36 that a design takes, in percent, if the size of that part is known.
pub fn shares(plan: &Plan) -> Option<[f64; 2]> {
    let Board { dsp, bram36, .. } = Board::of_device(&plan.design.hardware.part)?;
    let share = |used: f64, of: usize| 100.0 * used / of as f64;
    Some([share(plan.resources.dsp as f64, dsp), share(plan.resources.bram36, bram36)])
}

/// What to tell whose design does not fit its part, if that is one whose size is known.
pub fn excess(plan: &Plan) -> Option<String> {
    excess_on(plan, &Board::of_device(&plan.design.hardware.part)?)
}

/// The same for a board's part.
pub fn excess_on(plan: &Plan, board: &Board) -> Option<String> {
    let (resources, part) = (&plan.resources, &board.part);
    let &Board { dsp, bram36, .. } = board;
    let remedy = match (resources.dsp > dsp, resources.bram36 > bram36 as f64) {
        (false, false) => return None,
        (true, false) => "take fewer lanes",
        (false, true) => "filter more entries",
        (true, true) => "take fewer lanes and filter more entries",
    };
    Some(format!("too much for {part}, which has {dsp} {} and {bram36} RAMB36; {remedy}", resources.dsp_block.name()))
}

/// What to tell whose vectors are longer than the multipliers of a 7-series part.
pub fn doubled(plan: &Plan) -> Option<String> {
    let (resources, hardware) = (&plan.resources, &plan.design.hardware);
    (resources.dsp_block == DspBlock::Dsp48E1 && hardware.data_bits > OLDER_LONG_BITS).then(|| {
        format!(
            "{} multiplies 25 x 18 bits in a DSP48E1: {} multipliers take {} of them; with data_bits = {OLDER_LONG_BITS} \
             those of the lanes and of the field take one each, all others two as before",
            hardware.part, resources.multipliers, resources.dsp
        )
    })
}

/// What to tell whose coefficients are so narrow that the forces show it.
pub fn narrow(plan: &Plan) -> Option<String> {
    // Those of the friction are its components themselves, exact ones and others of more bits.
    let stored = plan.products.iter().filter(|product| product.coefficients != Coefficients::Friction);
    let matrices = stored.map(|product| &plan.matrices[product.matrix]);
    let (rounding, name) =
        matrices.map(|matrix| (matrix.rounding(), &matrix.name)).max_by(|a, b| a.0.total_cmp(&b.0))?;
    (rounding > COARSE).then(|| {
        format!(
            "coefficients of {} bits: rounding is {:.1} % of those of {name}, and the forces err by about as much; raise \
             [hardware] coefficient_bits",
            plan.design.hardware.coefficient_bits,
            100.0 * rounding
        )
    })
}
