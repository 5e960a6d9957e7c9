//! What a design will be, before anything is written: its figures, and what to tell its user.

use golden::kernel;
use serde_json::{Value, json};

use crate::cores::{DspBlock, OLDER_LONG_BITS};
use crate::emit::boards::Board;
use crate::emit::{insert_options, nnz, predicted, products};
use crate::plan::Plan;
use crate::plan::product::Coefficients;
use crate::plan::savings::savings;
use crate::timing::latency;

/// Rounding of the coefficients, as a share of their size, from which on it is told.
const COARSE: f64 = 0.005;

/// How a design counts contacts in hardware, and what separates them.
pub fn contacts(plan: &Plan) -> Option<String> {
    let algorithm = &plan.design.algorithm;
    let cycles = latency::count_contacts(&plan.design.sensor);
    let counted = format!("counted in {cycles} cycles beside the search; status bit 7 marks a frame of more than one");
    let separated = format!("up to {} separated by software", algorithm.contacts);
    match (algorithm.count_contacts, algorithm.contacts > 1) {
        (true, true) => Some(format!("{counted}; {separated}")),
        (true, false) => Some(counted),
        (false, true) => Some(format!("{separated}; hardware does not count them")),
        (false, false) => None,
    }
}

/// All figures of a plan: what `sptfra inspect --json` prints.
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
    if plan.design.algorithm.contacts > 1 {
        value["contacts"] = plan.design.algorithm.contacts.into();
    }
    insert_options(plan, &mut value);
    value
}

/// What to tell of a plan: that its layer is too thin, that it does not fit its part or takes two multipliers there in
/// place of one, that its coefficients are coarse.
pub fn warnings(plan: &Plan) -> Vec<String> {
    [plan.design.thin_layer(), excess(plan), doubled(plan), narrow(plan)].into_iter().flatten().collect()
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
