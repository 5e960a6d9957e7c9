//! Predicted cycles, exact: every count below is that of the emitted pipelines and is compared with simulation.

use serde::Serialize;

use super::counts::input_stages;
use super::product::{Product, Vector};
use super::schedule::{Schedule, Visit};
use crate::blocks::op::{OUTPUT_LATENCY, SUMMARY_BEATS, SUMMARY_LATENCY};
use crate::estimators::Slot;

/// From the last write of a frame to We's start pulse.
const WRITE_TO_START: u64 = 2;
/// From the sequencer's control to the lanes' and the collector's: the register on the way.
pub const SEQUENCER_TO_LANES: u64 = 1;
/// From We's start pulse to the first issue, in the lanes.
pub(super) const START_TO_ISSUE: u64 = 2 + SEQUENCER_TO_LANES;
/// From `CeAn` being idle and a bank being free, to the next frame's first beat entering the conversion.
const IDLE_TO_OPEN: u64 = 1;
/// From the collector's visit to the last g, to the end of the frame sums.
const VISIT_TO_SUMS: u64 = 7;
/// From the frame sums to the line's start, the direction being there.
const SUMS_TO_LINE: u64 = 1;
/// One more for the skid buffer at the output.
pub(super) const OUTPUT_SKID: u64 = 1;
/// Frames back to back that show the interval, between the two in the middle: every buffer is full by then, and there
/// is still a next frame.
pub const INTERVAL_FRAMES: usize = 14;

/// Distance between the ends of the two frames in the middle.
pub fn middle_interval(ends: &[u64]) -> u64 {
    match ends.len() / 2 {
        0 => 0,
        middle => ends[middle] - ends[middle - 1],
    }
}

/// Predicted times of one design, in clock cycles.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Timeline {
    /// First beat in to last beat out of a single frame, both included, with streams that never wait.
    pub latency_cycles: u64,
    /// Distance of consecutive frames' last beats, input always there, sink always ready.
    pub interval_cycles: u64,
    /// First to last issue of the lanes.
    pub spmv_cycles: u64,
    /// Start to end of the optimum search.
    pub search_cycles: u64,
    /// Whether a frame's products may begin while Op still works on the frame before.
    pub overlap: bool,
}

/// Fixed durations from which the timeline is computed.
struct Durations {
    taxels: u64,
    beats: u64,
    drained: u64,
    sums: u64,
    direction: u64,
    line: u64,
    search: u64,
    overlap: bool,
    beat_to_write: u64,
}

/// Cycles at which a frame passes the stations.
#[derive(Clone, Copy, Default)]
struct Frame {
    first_write: u64,
    last_write: u64,
    start: u64,
    drained: u64,
    output_start: u64,
}

impl Timeline {
    /// Predicts latency and interval.
    pub fn new(taxels: usize, counts: bool, products: &[Product], schedule: &Schedule, estimator: &dyn Slot) -> Self {
        let search = estimator.search_latency(taxels);
        let is_g = |visit: &&Visit| matches!(products[visit.product as usize].result, Vector::G(..));
        let sums = schedule.visits.iter().rfind(is_g).map_or(0, |visit| visit.cycle);
        let first_op_issue = products
            .iter()
            .position(|product| matches!(product.result, Vector::U(_)))
            .map_or(0, |index| schedule.windows[index].start);
        let mut durations = Durations {
            taxels: taxels as u64,
            beats: SUMMARY_BEATS + 3 * taxels as u64,
            drained: schedule.drained(),
            sums: sums + VISIT_TO_SUMS,
            direction: estimator.contact_latency(),
            line: estimator.line_latency().unwrap_or(0),
            search,
            overlap: false,
            // From a beat at the input to its stress at the operand memories' write port: skid buffer, conversion.
            beat_to_write: 1 + input_stages(counts),
        };
        // Op is busy from drained to the hand-over of its results; the next frame needs it from its first u on,
        // and, for the sums, from its last g on.
        let line_in_time = durations.sums.max(durations.direction) + SUMS_TO_LINE + durations.line <= durations.drained;
        let busy = 1 + search + SUMMARY_LATENCY + 2;
        durations.overlap = line_in_time && busy < first_op_issue.min(durations.sums);
        let mut frames: Vec<Frame> = Vec::with_capacity(INTERVAL_FRAMES);
        for _ in 0..INTERVAL_FRAMES {
            frames.push(durations.next(&frames));
        }
        let last_beat = |frame: &Frame| frame.output_start + OUTPUT_LATENCY + OUTPUT_SKID + durations.beats - 1;
        let first_beat = frames[0].first_write - durations.beat_to_write;
        Self {
            latency_cycles: last_beat(&frames[0]) - first_beat + 1,
            interval_cycles: middle_interval(&frames.iter().map(last_beat).collect::<Vec<_>>()),
            spmv_cycles: schedule.issue_cycles(),
            search_cycles: search,
            overlap: durations.overlap,
        }
    }
}

impl Durations {
    /// When the frame after `before` passes the stations, if its input waits at the door.
    fn next(&self, before: &[Frame]) -> Frame {
        let count = before.len();
        let back = |n: usize| count.checked_sub(n).map(|index| before[index]);
        let mut frame = Frame::default();
        let mut open = 1; // the beat leaves the skid buffer
        if let Some(previous) = back(1) {
            open = open.max(previous.last_write + self.direction + IDLE_TO_OPEN);
        }
        if let Some(older) = back(2) {
            open = open.max(older.drained + 1 + IDLE_TO_OPEN);
        }
        frame.first_write = open + self.beat_to_write - 1;
        frame.last_write = frame.first_write + self.taxels - 1;
        frame.start = frame.last_write + WRITE_TO_START;
        if let Some(previous) = back(1) {
            frame.start = frame.start.max(previous.drained + 2);
            if !self.overlap {
                frame.start = frame.start.max(previous.output_start + 2);
            }
        }
        if let Some(older) = back(2) {
            frame.start = frame.start.max(older.output_start + self.beats + 4);
        }
        let first_issue = frame.start + START_TO_ISSUE;
        frame.drained = first_issue + self.drained;
        let line_start = (first_issue + self.sums + SUMS_TO_LINE).max(frame.last_write + self.direction);
        let search_start = (frame.drained + 1).max(line_start + self.line);
        frame.output_start = search_start + self.search + SUMMARY_LATENCY + 1;
        if let Some(previous) = back(1) {
            frame.output_start = frame.output_start.max(previous.output_start + self.beats + 4);
        }
        frame
    }
}
