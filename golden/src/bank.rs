//! What a board loads into a bank of its calibration: gains, offsets, and the weights that replace dead taxels.

use std::fmt::Write;

use crate::dead_taxels::DeadTaxels;
use crate::design::{CalibrationIn, Design};
use crate::numbers::push_row;

/// The file that the drivers load, for a design whose calibration is in RAM. A header line `gain,offset,taxel 37,…` names
/// the dead taxels, ascending; then follows a line for each taxel: its gain, 0 of a dead one, its offset in counts, and its
/// weight in the stress of each dead taxel. Where banks have no room for dead taxels, gain and offset alone. Of a design
/// with a curve, whose offsets are in pascals, a header `count,pascals` follows, and a line for each of its points.
///
/// # Errors
/// A calibration in ROM, in words.
pub fn to_csv(design: &Design) -> Result<String, String> {
    if design.hardware.calibration == CalibrationIn::Rom {
        return Err(format!(
            "{}: the design's calibration is in ROM, and no board can load another one; add [hardware] calibration = \"ram\" \
             and control = true, and synthesize it once",
            design.name
        ));
    }
    let (input, taxels) = (&design.input, design.sensor.taxels());
    let replaced = if design.input.room == 0 { &[][..] } else { &input.dead };
    let dead = DeadTaxels::new(&design.sensor, design.algorithm.kernel, replaced);
    let mut text = "gain,offset".to_owned();
    // Writing to a String cannot fail.
    for taxel in dead.taxels() {
        let _ = write!(text, ",taxel {taxel}");
    }
    text.push('\n');
    for taxel in 0..taxels {
        let (gain, offset) = input.of_taxel(taxel);
        let gain = if input.dead.contains(&taxel) { 0.0 } else { gain };
        let weights = dead.weights().iter().map(|weights| weights[taxel]);
        push_row(&mut text, [gain, offset].into_iter().chain(weights));
    }
    if let Some(curve) = &input.curve {
        text += "count,pascals\n";
        text += &curve.to_csv();
    }
    Ok(text)
}
