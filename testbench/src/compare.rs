//! Exact comparison of output frames with what the integer model says.

use std::fmt;

use hdl_gen::plan::words;
use serde::Serialize;

use crate::stream_words::beat_name;

/// Mismatches kept for the report; all are counted.
const KEPT: usize = 8;

/// One word that is not what it should be.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Mismatch {
    /// Position of the frame among those sent.
    pub frame: usize,
    /// Position of the word in the output frame.
    pub beat: usize,
    /// What the word is.
    pub name: String,
    /// The model's word; none if the frame should have ended.
    pub expected: Option<u32>,
    /// The core's word; none if the frame ended too early.
    pub got: Option<u32>,
}

impl fmt::Display for Mismatch {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let show = |word: Option<u32>| match word {
            None => "nothing".to_owned(),
            Some(word) if is_bits(self.beat) => format!("{word:#010x}"),
            Some(word) => format!("{word:#010x} ({:e})", f32::from_bits(word)),
        };
        let (expected, got) = (show(self.expected), show(self.got));
        write!(out, "frame {}, beat {} ({}): expected {expected}, got {got}", self.frame, self.beat, self.name)
    }
}

/// Whether a word is something else than a float32.
fn is_bits(beat: usize) -> bool {
    words::SUMMARY.iter().any(|word| word.index == beat && word.kind != words::Kind::Float32)
}

/// Result of comparing many frames.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Comparison {
    /// Words compared.
    pub words: u64,
    /// Words that differ.
    pub mismatches: u64,
    /// The first few of them.
    pub first: Vec<Mismatch>,
}

impl Comparison {
    /// True if no word differs.
    pub fn is_exact(&self) -> bool {
        self.mismatches == 0
    }

    /// Compares frame by frame; the sensor's `columns` serve to name the words. A missing or surplus frame counts
    /// as one whose words all differ.
    pub fn new<'a>(expected: &'a [Vec<u32>], got: impl IntoIterator<Item = &'a [u32]>, columns: usize) -> Self {
        let mut comparison = Self::default();
        let mut got = got.into_iter();
        for (frame, expected) in expected.iter().enumerate() {
            comparison.add(frame, expected, got.next().unwrap_or(&[]), columns);
        }
        for (surplus, words) in got.enumerate() {
            comparison.add(expected.len() + surplus, &[], words, columns);
        }
        comparison
    }

    fn add(&mut self, frame: usize, expected: &[u32], got: &[u32], columns: usize) {
        let length = expected.len().max(got.len());
        self.words += length as u64;
        for beat in 0..length {
            let (expected, got) = (expected.get(beat).copied(), got.get(beat).copied());
            if expected == got {
                continue;
            }
            self.mismatches += 1;
            if self.first.len() < KEPT {
                self.first.push(Mismatch { frame, beat, name: beat_name(beat, columns), expected, got });
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn compare(expected: &[Vec<u32>], got: &[Vec<u32>]) -> Comparison {
        Comparison::new(expected, got.iter().map(Vec::as_slice), 4)
    }

    #[test]
    fn equal_frames_are_exact() {
        let frames = vec![vec![1, 2, 3]; 4];
        let comparison = compare(&frames, &frames);
        assert!(comparison.is_exact());
        assert_eq!(comparison.words, 12);
    }

    #[test]
    fn a_wrong_word_is_named() {
        let comparison = compare(&[vec![0, 1, 2, 0x3F80_0000]], &[vec![0, 1, 2, 0x4000_0000]]);
        assert_eq!(comparison.mismatches, 1);
        let text = comparison.first[0].to_string();
        assert_eq!(text, "frame 0, beat 3 (F_y): expected 0x3f800000 (1e0), got 0x40000000 (2e0)");
    }

    #[test]
    fn missing_and_surplus_words_and_frames_count() {
        assert_eq!(compare(&[vec![1, 2]], &[vec![1]]).mismatches, 1);
        assert_eq!(compare(&[vec![1]], &[vec![1, 2]]).mismatches, 1);
        assert_eq!(compare(&[vec![1], vec![2]], &[vec![1]]).mismatches, 1);
        let surplus = compare(&[vec![1]], &[vec![1], vec![7, 8]]);
        assert_eq!((surplus.mismatches, surplus.first[0].frame), (2, 1));
    }

    #[test]
    fn many_mismatches_are_counted_but_not_all_kept() {
        let comparison = compare(&[vec![0; 100]], &[vec![1; 100]]);
        assert_eq!((comparison.mismatches, comparison.first.len()), (100, KEPT));
    }
}
