//! Frames as the words of the two streams.

use golden::solver::{Solution, Status};
use hdl_gen::plan::streams::Streams;
use hdl_gen::plan::words;

/// Summary beats in front of the field.
pub const SUMMARY_BEATS: usize = words::SUMMARY_WORDS;

const AXES: [char; 3] = ['x', 'y', 'z'];
/// The status bits of beat 0; the frame counter is above.
const STATUS_MASK: u32 = 0xFFFF;

/// The input packets of frames.
pub fn packets(streams: Streams, frames: &[Vec<f64>]) -> Vec<Vec<u32>> {
    frames.iter().map(|values| streams.packet(values)).collect()
}

/// The values of a frame as the core gets them. The f64 solver is given the same ones, so that its difference to the core
/// is the core's alone.
pub fn as_received(streams: Streams, packet: &[u32]) -> Vec<f64> {
    streams.received(packet)
}

/// What a beat of an output frame is on a sensor of `columns`, such as `F_z` or `f_x of taxel 12 (2, 1)` with column and row.
pub fn beat_name(beat: usize, columns: usize) -> String {
    let Some(place) = beat.checked_sub(SUMMARY_BEATS) else {
        let names: Vec<&str> = words::SUMMARY.iter().filter(|word| word.index == beat).map(|word| word.name).collect();
        return if names.is_empty() { "nothing".to_owned() } else { names.join(", ") };
    };
    let (taxel, axis) = (place / 3, place % 3);
    let columns = columns.max(1);
    format!("f_{} of taxel {taxel} ({}, {})", AXES[axis], taxel % columns, taxel / columns)
}

/// Reads an output frame of 16 summary beats and three beats per taxel; `None` if its length is another.
pub fn decode(words: &[u32]) -> Option<Solution> {
    let (summary, field) = words.split_first_chunk::<SUMMARY_BEATS>()?;
    let (triples, []) = field.as_chunks::<3>() else {
        return None;
    };
    let value = |word: u32| f64::from(f32::from_bits(word));
    let [head, _, fx, fy, fz, tx, ty, tz, mu, phi, mu_x, mu_y, standard_error, counters, ..] = *summary;
    Some(Solution {
        status: Status(head & STATUS_MASK),
        resultant: [fx, fy, fz].map(value),
        torque: [tx, ty, tz].map(value),
        standard_error: value(standard_error),
        contacts: (counters & 0xFF) as usize,
        records: Vec::new(),
        mu: value(mu),
        phi: value(phi),
        mu_x: value(mu_x),
        mu_y: value(mu_y),
        field: [0, 1, 2].map(|axis| triples.iter().map(|triple| value(triple[axis])).collect()),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_follow_the_stream_format() {
        let beats = [0, 1, 4, 11, 15, 16, 18, 16 + 3 * 12 + 1];
        let names: Vec<String> = beats.iter().map(|&beat| beat_name(beat, 10)).collect();
        let of_taxels = ["f_x of taxel 0 (0, 0)", "f_z of taxel 0 (0, 0)", "f_y of taxel 12 (2, 1)"];
        let expected = [&["status, frame", "timestamp", "F_z", "mu_y", "nothing"][..], &of_taxels].concat();
        assert_eq!(names, expected);
    }

    #[test]
    fn an_answer_is_taken_apart() {
        let mut words = vec![0x0005_0006, 77];
        words.extend([1.0, 2.0, -3.0, 0.01, 0.02, 0.03, 0.5, 0.25, -0.5, 0.125, 0.0625].map(f32::to_bits));
        words.extend([0x0003_0002, 0, 0]);
        words.extend([10.0, 20.0, 30.0, 11.0, 21.0, 31.0].map(f32::to_bits));
        let expected = Solution {
            resultant: [1.0, 2.0, -3.0],
            torque: [0.01_f32, 0.02, 0.03].map(f64::from),
            standard_error: 0.0625,
            contacts: 2,
            mu: 0.5,
            phi: 0.25,
            mu_x: -0.5,
            mu_y: 0.125,
            field: [vec![10.0, 11.0], vec![20.0, 21.0], vec![30.0, 31.0]],
            ..Solution::zeros(Status(6), 2)
        };
        assert_eq!(decode(&words), Some(expected));
    }

    #[test]
    fn other_lengths_are_no_answer() {
        assert_eq!(decode(&[0; 15]), None);
        assert_eq!(decode(&[0; 17]), None);
        assert!(decode(&[0; 16]).is_some());
    }
}
