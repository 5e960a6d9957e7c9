//! A testbench in plain Verilog, with frames and the model's answers to them: any simulator can check the design.

use std::io::Write;

use golden::scene::{Medium, Scene, SceneError};
use tera::context;

use crate::model::Model;
use crate::plan::Plan;
use crate::plan::words::TIMESTAMP;

use super::{EmitError, FileMap, template};

const TEMPLATE: &str = include_str!("../../templates/sim/tb.v.tera");
/// The same frames from Python.
const COCOTB: &str = include_str!("../../templates/sim/cocotb.py.tera");
/// A cycle of the clock there, in microseconds.
const COCOTB_CYCLE: f64 = 0.01;
/// Directions of the push, off the axes and in all four quadrants.
const DIRECTIONS_DEG: [f64; 4] = [20.0, 110.0, 200.0, 290.0];
/// Cycles that a core may take beyond its predicted ones, for the pauses of the streams.
const SLACK_CYCLES: u64 = 10_000;

/// Adds `sim/NAME_tb.v`, `sim/NAME_cocotb.py`, `sim/NAME_stimulus.mem` and `sim/NAME_expected.mem`.
///
/// # Errors
/// [`EmitError::Template`] if the template does not fit its data; [`EmitError::Scene`] if no frames can be made for
/// the sensor.
pub fn insert(plan: &Plan, files: &mut FileMap) -> Result<(), EmitError> {
    let name = plan.design.name.as_str();
    let packets = packets(plan)?;
    let mut model = Model::new(plan);
    let answers: Vec<Vec<u32>> = packets.iter().map(|packet| model.process(packet)).collect();
    let words = plan.streams().words();
    let beats = |packets: &[Vec<u32>]| packets.iter().map(|packet| packet.len().div_ceil(words)).sum::<usize>();
    let timeout = SLACK_CYCLES + 4 * plan.timeline.latency_cycles * packets.len() as u64;
    let context = context! {
        name => name,
        frames => &packets.len(),
        // Bits and bytes of a beat.
        stream_bits => &plan.streams().bits,
        stream_bytes => &(plan.streams().bits / 8),
        // Beats of all frames.
        beats_in => &beats(&packets),
        beats_out => &beats(&answers),
        // Beats of an output frame.
        beats => &plan.streams().beats_out(),
        // TKEEP of its last one.
        last_keep => &format!("{:x}", plan.streams().last_keep()),
        // Words of an output frame, and which has the timestamp.
        words_out => &plan.words_out(),
        timestamp => &TIMESTAMP,
        // Which of the beats has it, and in which of its words.
        timestamp_beat => &(TIMESTAMP / words),
        timestamp_word => &(TIMESTAMP % words),
        timeout,
        // The same as time, in microseconds.
        timeout_us => &(timeout as f64 * COCOTB_CYCLE),
        // Whether it drops frames for which it has no room.
        overrun => &plan.streams().drops,
        // Whether the core has a register bank.
        control => &plan.design.hardware.control,
    };
    let module = format!("{name}_tb");
    let text = template::design_module(&module, TEMPLATE, &context)?;
    files.insert(format!("sim/{module}.v"), text.into_bytes());
    let module = format!("{name}_cocotb");
    let text = template::one(&module, COCOTB, &context)?;
    files.insert(format!("sim/{module}.py"), text.into_bytes());
    files.insert(format!("sim/{name}_stimulus.mem"), beat_file(&packets, words));
    files.insert(format!("sim/{name}_expected.mem"), beat_file(&answers, words));
    Ok(())
}

/// A contact pushed in several directions; between them the frames that have no answer.
fn packets(plan: &Plan) -> Result<Vec<Vec<u32>>, SceneError> {
    let streams = plan.streams();
    let of_scene = |scene: Scene| {
        // On a half-space stress has a closed form, so no layer is too thin.
        let frames = scene.frames().or_else(|_| Scene { medium: Medium::HalfSpace, ..scene }.frames())?;
        let packet = |mut stress: Vec<f64>| {
            plan.design.read_stress(&mut stress);
            streams.packet(&stress)
        };
        Ok::<_, SceneError>(frames.into_iter().map(|frame| packet(frame.stress)).collect::<Vec<_>>())
    };
    let scene = Scene { sweep_deg: DIRECTIONS_DEG.to_vec(), ..Scene::standing(&plan.design.sensor) };
    let mut packets = of_scene(scene.clone())?;
    let length = streams.words_in();
    let mut not_a_number = packets[0].clone();
    not_a_number[length / 2] = f32::NAN.to_bits();
    packets.insert(1, vec![0; length]);
    // Of integers, which are always numbers, another frame.
    packets.insert(3, not_a_number);
    // A beat less than a frame.
    packets.insert(5, vec![0; length - streams.words().min(length - 1)]);
    Ok(packets)
}

/// Packets as beats of so many words, the first lowest, with one bit more: TLAST above them. Zeros fill the last beat.
fn beat_file(packets: &[Vec<u32>], words: usize) -> Vec<u8> {
    let mut text = Vec::new();
    for packet in packets {
        let last = packet.len().div_ceil(words);
        for (beat, filled) in (1..).zip(packet.chunks(words)) {
            let _ = write!(text, "{}", u32::from(beat == last));
            for place in (0..words).rev() {
                // Writing to a vector cannot fail.
                let _ = write!(text, "{:08x}", filled.get(place).copied().unwrap_or(0));
            }
            text.push(b'\n');
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::beat_file;

    #[test]
    fn the_last_word_of_each_packet_is_marked() {
        let text = beat_file(&[vec![1, 0xC47A_0000], vec![2]], 1);
        assert_eq!(String::from_utf8(text).unwrap(), "000000001\n1c47a0000\n100000002\n");
        let text = beat_file(&[vec![1, 2, 3]], 2);
        assert_eq!(String::from_utf8(text).unwrap(), "00000000200000001\n10000000000000003\n");
    }
}
