//! Predicted cycles: the hardware's control, register by register, without the data.
//!
//! When a program starts depends on the frames under way, so latency and interval come from playing frames through
//! what decides it. Tests compare them with simulation.

use std::collections::{BTreeSet, VecDeque};

use super::buffers::{FIELD_BUFFERS, INGRESS_FRAMES};
use super::durations::{Arrival, Durations};
use super::latency::{
    self, CONTROL_TO_LANES, OUTPUT_LATENCY, OUTPUT_SKID, OUTPUT_TO_IDLE, OUTPUT_TO_RELEASE, SEARCH_TO_FRICTION,
    SUMMARY_LATENCY, TAKE_TO_RESIDUAL, TAXELS_TO_CELLS, TAXELS_TO_FIELD,
};
use super::timeline::{INTERVAL_FRAMES, Timeline, mean_interval};

/// Frames whose stress, whose search, and whose field have a buffer.
const BUFFERS: u64 = FIELD_BUFFERS as u64;
/// Cycles after which a frame is taken for lost: a defect.
const FOREVER: u64 = 100_000_000;
/// Frames within which a core that keeps up with its source repeats itself.
const SPACED_FRAMES: u64 = 96;

/// Predicts latency and interval of a design whose lanes issue for so many cycles a frame.
pub fn timeline(durations: &Durations, spmv_cycles: u64) -> Timeline {
    let ends = |frames| Control::new(durations).play(frames);
    let interval = mean_interval(&ends(INTERVAL_FRAMES));
    Timeline {
        latency_cycles: ends(1)[0],
        interval_cycles: if durations.drops { smallest_spacing(durations, interval) } else { interval },
        spmv_cycles,
        search_cycles: durations.stages.iter().map(|stage| stage.cycles).sum(),
    }
}

/// What becomes of frames that begin at equal distances.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Pace {
    /// The core's state repeats: it keeps up with them for ever.
    Keeps,
    /// They wait longer and longer, as far as was played.
    PilesUp,
    /// The ingress FIFO has no room for one.
    Loses,
}

/// The smallest distance of frames' beginnings at which the ingress FIFO loses none. Frames that pile up go on in the
/// `interval` of a core whose source waits. Frames that wait for nothing meet the lanes in another order, and may need less.
fn smallest_spacing(durations: &Durations, interval: u64) -> u64 {
    let pace = |spacing: u64| Control::new(durations).keep_pace(spacing);
    let mut spacing = interval;
    while pace(spacing) == Pace::Loses {
        spacing += 1;
    }
    while spacing > 1 && pace(spacing - 1) == Pace::Keeps {
        spacing -= 1;
    }
    spacing
}

/// The registers, as they stand in the current cycle. Times are cycles in which something happens or is first seen.
#[derive(Default)]
struct Control {
    of: Durations,
    now: u64,
    // Bz and CeAn
    next_open: u64,
    /// When the next frame's first beat waits.
    beat_there: u64,
    idle_since: Option<u64>,
    stress_buffers: u64,
    /// Frames in the ingress FIFO that Bz has not let in: when their first beats came. Empty where the source waits.
    arrivals: VecDeque<u64>,
    /// Frames in the ingress FIFO, with the one that is leaving it.
    in_fifo: usize,
    /// Frames on their way through Bz.
    arriving: VecDeque<Arriving>,
    /// Cycles in which results are written, and its writes wait.
    writes: BTreeSet<u64>,
    cean_idle: u64,
    directions: VecDeque<u64>,
    frames_ready: VecDeque<u64>,
    // Program scheduler
    lanes_free: u64,
    u_held: u64,
    residual_due: bool,
    /// When the residuals are there whose fields are due.
    residuals_there: VecDeque<u64>,
    frames_held: u64,
    fields_held: u64,
    // Op
    sums_there: VecDeque<u64>,
    /// Where the line is, and since when.
    line: (Line, u64),
    u_there: VecDeque<u64>,
    stages: Vec<StageState>,
    summary_busy: bool,
    summary_there: Option<u64>,
    friction_known: Option<u64>,
    field_there: VecDeque<u64>,
    output_idle: u64,
    /// Changes that registers show later: `(first cycle seen, what)`.
    pending: Vec<(u64, Change)>,
    ends: Vec<u64>,
}

/// A stage of the search: when the frame in it is done, and from when on it may begin.
#[derive(Clone, Copy, Default)]
struct StageState {
    ends: Option<u64>,
    free: u64,
}

/// A frame on its way through Bz.
#[derive(Clone, Copy, Default)]
struct Arriving {
    /// Cycles since its first beat.
    since: u64,
    /// Elements that were read, then cycles in which the last one moved on.
    read: usize,
    moved: u64,
    /// It is open for another frame.
    over: bool,
}

#[derive(Clone, Copy, Default)]
enum Line {
    #[default]
    Idle,
    Waits,
    There,
}

#[derive(Clone, Copy)]
enum Change {
    StressReleased,
    Released,
    FrameReleased,
    SummaryFree,
}

/// Whether the first of what is due at these times is there.
fn is_there(times: &VecDeque<u64>, now: u64) -> bool {
    times.front().is_some_and(|&cycle| cycle <= now)
}

impl Control {
    fn new(of: &Durations) -> Self {
        // In cycle 1 the first beat has left the skid buffer.
        let first_beat = 1 + of.unpacking;
        Self {
            next_open: first_beat,
            beat_there: first_beat,
            idle_since: Some(0),
            stages: vec![StageState::default(); of.stages.len()],
            of: of.clone(),
            ..Self::default()
        }
    }

    /// Plays frames that wait at the input; returns the cycle after the last beat out of each, the first beat in being
    /// in cycle 0.
    fn play(mut self, frames: usize) -> Vec<u64> {
        let mut left = frames;
        while self.ends.len() < frames && self.now < FOREVER {
            if self.step(left > 0) {
                left -= 1;
            }
        }
        self.ends.resize(frames, FOREVER);
        self.ends
    }

    /// Plays frames that begin so many cycles one after the other: what becomes of them.
    fn keep_pace(mut self, spacing: u64) -> Pace {
        let mut states = BTreeSet::new();
        for _ in 0..SPACED_FRAMES {
            if self.in_fifo == INGRESS_FRAMES {
                return Pace::Loses;
            }
            self.in_fifo += 1;
            self.arrivals.push_back(self.now);
            if !states.insert(self.state()) {
                return Pace::Keeps;
            }
            for _ in 0..spacing {
                let is_there = |&came: &u64| came + 1 + self.of.unpacking <= self.now;
                if self.step(self.arrivals.front().is_some_and(is_there)) {
                    self.arrivals.pop_front();
                }
            }
        }
        Pace::PilesUp
    }

    /// All that decides what happens from this cycle on, its times counted from here.
    fn state(&self) -> Vec<u64> {
        // What was there a cycle ago is there for good.
        let past = self.now.saturating_sub(1);
        let since = |time: u64| if time >= FOREVER { FOREVER } else { time.saturating_sub(past) };
        let counts = [self.stress_buffers, self.u_held, self.frames_held, self.fields_held, self.in_fifo as u64];
        let flags = [self.idle_since.is_some(), self.residual_due, self.summary_busy].map(u64::from);
        let line = [self.line.0 as u64, since(self.line.1)];
        let times = [self.next_open, self.beat_there, self.cean_idle, self.lanes_free, self.output_idle];
        let known = [self.summary_there, self.friction_known].map(|time| time.map_or(FOREVER, since));
        let mut state = [&counts[..], &flags, &line, &times.map(since), &known].concat();
        let queues = [
            &self.arrivals,
            &self.directions,
            &self.frames_ready,
            &self.residuals_there,
            &self.sums_there,
            &self.u_there,
            &self.field_there,
        ];
        for queue in queues {
            state.push(queue.len() as u64);
            state.extend(queue.iter().map(|&time| since(time)));
        }
        state.push(self.arriving.len() as u64);
        for frame in &self.arriving {
            state.extend([frame.since, frame.read as u64, frame.moved, u64::from(frame.over)]);
        }
        for stage in &self.stages {
            state.extend([stage.ends.map_or(FOREVER, since), since(stage.free)]);
        }
        state.extend(self.pending.iter().flat_map(|&(time, change)| [since(time), change as u64]));
        state.extend(self.writes.iter().map(|&time| since(time)));
        state
    }

    /// A cycle; whether a frame enters Bz, which `offered` says is there.
    fn step(&mut self, offered: bool) -> bool {
        self.show_changes();
        let stands_still = self.writes.remove(&self.now);
        self.arrive(stands_still);
        let opens = self.opens(offered);
        self.start_program();
        if let Some(latency) = self.of.line {
            self.find_line(latency);
        }
        self.search();
        self.send();
        self.now += 1;
        opens
    }

    fn show_changes(&mut self) {
        let now = self.now;
        for (_, change) in self.pending.extract_if(.., |&mut (cycle, _)| cycle <= now) {
            match change {
                Change::StressReleased => self.stress_buffers -= 1,
                Change::Released => self.u_held -= 1,
                Change::FrameReleased => {
                    self.frames_held -= 1;
                    if self.of.composed {
                        self.fields_held -= 1;
                    }
                }
                Change::SummaryFree => self.summary_busy = false,
            }
        }
    }

    /// Bz lets a frame in: a register says so, one cycle after the conditions hold.
    fn opens(&mut self, offered: bool) -> bool {
        let room = self.directions.iter().filter(|&&there| there <= self.now).count() < BUFFERS as usize;
        if self.now < self.next_open || self.now < self.cean_idle || self.stress_buffers == BUFFERS || !room {
            return false;
        }
        if *self.idle_since.get_or_insert(self.now) == self.now {
            return false;
        }
        if self.now < self.beat_there || !offered {
            return false;
        }
        // A frame of one beat has left the ingress FIFO.
        if self.of.arrival.taken == 0 {
            self.in_fifo = self.in_fifo.saturating_sub(1);
        }
        self.idle_since = None;
        self.stress_buffers += 1;
        (self.next_open, self.cean_idle) = (FOREVER, FOREVER);
        self.arriving.push_back(Arriving::default());
        true
    }

    /// Frames move on in Bz; what is on its way to the lanes' memories does not in this cycle if it `stands_still`.
    fn arrive(&mut self, stands_still: bool) {
        let Arrival { taken, elements, read_to_write, last_stress } = &self.of.arrival;
        for frame in &mut self.arriving {
            frame.since += 1;
            if frame.since == *taken {
                self.in_fifo = self.in_fifo.saturating_sub(1);
            }
            if frame.since == *last_stress {
                self.cean_idle = self.now + self.of.direction;
                self.directions.push_back(self.cean_idle);
            }
            // A register says that all were read, a cycle later.
            if frame.read == elements.len() && frame.since >= *last_stress && !frame.over {
                frame.over = true;
                self.next_open = self.now + 1;
            }
            if stands_still {
                continue;
            }
            if let Some(there) = elements.get(frame.read) {
                frame.read += usize::from(*there <= frame.since);
            } else {
                frame.moved += 1;
                if frame.moved == *read_to_write {
                    self.frames_ready.push_back(self.now + 1);
                }
            }
        }
        self.arriving.retain(|frame| !frame.over || frame.moved < *read_to_write);
    }

    /// The lanes' next program.
    fn start_program(&mut self) {
        if self.now < self.lanes_free {
            return;
        }
        let there = |times| is_there(times, self.now);
        let friction = self.friction_known.is_some_and(|cycle| cycle <= self.now);
        let may_field = there(&self.residuals_there) && friction && self.fields_held < BUFFERS;
        let may_residual = self.residual_due && self.residuals_there.len() < self.of.residuals;
        let may_frame = there(&self.frames_ready)
            && self.u_held < BUFFERS
            && self.of.buffers.is_none_or(|buffers| self.frames_held < buffers)
            && !self.residual_due
            && (self.of.interval || self.residuals_there.is_empty());
        if may_field {
            let last_slot = self.start(2);
            self.residuals_there.pop_front();
            self.friction_known = None;
            self.fields_held += 1;
            self.field_there.push_back(last_slot + self.of.take_to_taxels + TAXELS_TO_FIELD);
        } else if may_residual {
            let last_slot = self.start(1);
            self.residual_due = false;
            self.residuals_there.push_back(last_slot + TAKE_TO_RESIDUAL);
        } else if may_frame {
            let first_issue = self.first_issue(0);
            let last_slot = self.start(0);
            self.frames_ready.pop_front();
            self.u_held += 1;
            self.residual_due = self.of.composed;
            self.frames_held += u64::from(self.of.buffers.is_some());
            let sums_there = first_issue + self.of.last_sum + self.of.take_to_sums;
            self.sums_there.push_back(sums_there);
            if self.of.field && !self.of.composed {
                self.field_there.push_back(sums_there);
            }
            let complete = last_slot + self.of.take_to_taxels;
            self.u_there.push_back(complete + if self.of.line.is_some() { TAXELS_TO_CELLS } else { 0 });
            self.pending.push((complete + 1, Change::StressReleased));
        }
    }

    /// Of a program that is started now, one cycle after the decision.
    fn first_issue(&self, index: usize) -> u64 {
        self.now + 1 + latency::start_to_issue(self.of.programs[index].gap)
    }

    /// Starts a program, one cycle after the decision; returns the cycle of its last write-back slot.
    fn start(&mut self, index: usize) -> u64 {
        let program = &self.of.programs[index];
        let first_issue = self.first_issue(index);
        self.writes.extend(program.writes.iter().map(|cycle| first_issue + cycle));
        self.lanes_free = first_issue + program.length - 1 - CONTROL_TO_LANES;
        first_issue + program.last_slot
    }

    fn find_line(&mut self, latency: u64) {
        let (line, from) = self.line;
        if from > self.now {
            return;
        }
        match line {
            Line::Idle if is_there(&self.sums_there, self.now) => {
                self.sums_there.pop_front();
                self.line = (Line::Waits, self.now + 1);
            }
            Line::Waits if is_there(&self.directions, self.now) => {
                self.directions.pop_front();
                self.line = (Line::There, self.now + latency);
            }
            _ => {}
        }
    }

    fn search(&mut self) {
        let now = self.now;
        let done = |stage: &StageState| stage.ends.is_some_and(|end| end <= now);
        let may_begin = |stage: &StageState| stage.ends.is_none() && stage.free <= now;
        let last = self.stages.len() - 1;
        if done(&self.stages[last]) && !self.summary_busy {
            self.leave(last);
            self.summary_busy = true;
            self.summary_there = Some(now + SUMMARY_LATENCY + 1);
            self.friction_known = self.of.composed.then_some(now + SEARCH_TO_FRICTION);
        }
        for stage in (0..last).rev() {
            if done(&self.stages[stage]) && may_begin(&self.stages[stage + 1]) {
                self.leave(stage);
                self.stages[stage + 1].ends = Some(now + self.of.stages[stage + 1].cycles);
            }
        }
        // Without a line a register starts the search, a cycle after all is there.
        let seen = if self.of.line.is_some() { now } else { now.saturating_sub(1) };
        let line = match self.line {
            _ if self.of.line.is_none() => is_there(&self.sums_there, seen) && is_there(&self.directions, seen),
            (Line::There, from) => from <= now,
            _ => false,
        };
        if line && is_there(&self.u_there, seen) && may_begin(&self.stages[0]) {
            self.u_there.pop_front();
            self.line = (Line::Idle, now + 1);
            if self.of.line.is_none() {
                self.sums_there.pop_front();
                self.directions.pop_front();
            }
            self.stages[0].ends = Some(now + self.of.stages[0].cycles);
        }
    }

    /// A frame leaves a stage of the search.
    fn leave(&mut self, stage: usize) {
        self.stages[stage] = StageState { ends: None, free: self.now + self.of.stages[stage].shows + 1 };
        if stage == 0 {
            self.pending.push((self.now + 1, Change::Released));
        }
    }

    fn send(&mut self) {
        let summary = self.summary_there.is_some_and(|cycle| cycle <= self.now);
        let field = !self.of.field || is_there(&self.field_there, self.now);
        if !summary || !field || self.output_idle > self.now {
            return;
        }
        self.summary_there = None;
        self.field_there.pop_front();
        self.pending.push((self.now + 1, Change::SummaryFree));
        self.output_idle = self.now + self.of.beats + OUTPUT_TO_IDLE;
        if self.of.field {
            self.pending.push((self.now + self.of.beats + OUTPUT_TO_RELEASE, Change::FrameReleased));
        }
        self.ends.push(self.now + OUTPUT_LATENCY + OUTPUT_SKID + self.of.beats);
    }
}
