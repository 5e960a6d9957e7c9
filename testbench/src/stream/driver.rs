//! Both ends of the streams: synchronous logic. What it drives in a cycle depends on earlier cycles only, never on the
//! core's outputs in the same one.

use std::collections::VecDeque;

use super::check::show;
use super::{Checker, Exchange, Gate, INITIAL_RESET, Outcome, Pacing, StreamError, Traffic, Violation};
use crate::dut::{Beat, Core, Inputs};
use hdl_gen::plan::words::{SUMMARY_WORDS, TIMESTAMP};

/// Cycles watched after the last expected packet, for a beat too many.
const QUIET: u64 = 64;
/// The broken rule of a frame that no frame in accounts for.
const UNEXPECTED: &str = "the core sends a frame that nothing was sent in for";

/// Runs the traffic until every packet has its answer. `progress` is told the number of answers after each.
///
/// # Errors
/// [`StreamError`] at the first broken rule, when nothing moves for [`Traffic::timeout`] cycles, or when the
/// simulation stops.
pub fn exchange(
    core: &mut impl Core,
    traffic: &Traffic<'_>,
    mut progress: impl FnMut(usize),
) -> Result<Outcome, StreamError> {
    let mut driver = Driver::new(traffic, core.words());
    for _ in 0..INITIAL_RESET {
        driver.reset_cycle(core)?;
    }
    let start = driver.cycle;
    let mut resets = traffic.resets.iter().peekable();
    let mut answers = 0;
    let mut quiet = 0;
    while quiet < QUIET {
        if let Some(reset) = resets.next_if(|reset| driver.cycle - start >= reset.cycle) {
            driver.give_up();
            for _ in 0..reset.length.max(1) {
                driver.reset_cycle(core)?;
            }
            continue;
        }
        driver.run_cycle(core)?;
        if driver.outcome.exchanges.len() > answers {
            answers = driver.outcome.exchanges.len();
            progress(answers);
        }
        quiet = if driver.done() { quiet + 1 } else { 0 };
    }
    driver.outcome.dropped.extend(driver.inside);
    driver.outcome.cycles = driver.cycle;
    Ok(driver.outcome)
}

/// State between cycles.
struct Driver<'a> {
    traffic: &'a Traffic<'a>,
    source: Gate,
    sink: Gate,
    checker: Checker,
    cycle: u64,
    last_handshake: u64,
    /// 32-bit words of a beat.
    width: usize,
    /// Packet being sent and the next word of it.
    packet: usize,
    word: usize,
    /// True once the current word is on offer: it stays until taken.
    offering: bool,
    first_in: u64,
    /// Cycle in which the packet was first on offer.
    begun: Option<u64>,
    /// First cycle out of the last reset.
    released: u64,
    /// Packets sent whose answer is not complete: index and cycle of the first beat.
    inside: VecDeque<(usize, u64)>,
    /// Output beats of the packet coming out.
    words: Vec<u32>,
    outcome: Outcome,
}

impl<'a> Driver<'a> {
    fn new(traffic: &'a Traffic<'a>, width: usize) -> Self {
        let mut driver = Self {
            traffic,
            source: traffic.source.start(),
            sink: traffic.sink.start(),
            checker: Checker::default(),
            cycle: 0,
            last_handshake: 0,
            width,
            packet: 0,
            word: 0,
            offering: false,
            first_in: 0,
            begun: None,
            released: 0,
            inside: VecDeque::new(),
            words: Vec::new(),
            outcome: Outcome::default(),
        };
        driver.skip_empty();
        driver
    }

    fn done(&self) -> bool {
        let silent = self.traffic.drops && self.cycle - self.last_handshake >= self.traffic.timeout;
        self.packet >= self.traffic.packets.len() && (self.inside.is_empty() || silent)
    }

    fn skip_empty(&mut self) {
        while self.traffic.packets.get(self.packet).is_some_and(Vec::is_empty) {
            self.packet += 1;
        }
    }

    fn next_packet(&mut self) {
        self.packet += 1;
        self.word = 0;
        self.skip_empty();
    }

    fn give_up(&mut self) {
        // A packet of which no word was offered yet loses nothing and is sent after the reset.
        if self.word > 0 || self.offering {
            self.next_packet();
        }
        self.offering = false;
        self.inside.clear();
        self.words.clear();
        self.outcome.resumed.push(self.packet);
    }

    fn reset_cycle(&mut self, core: &mut impl Core) -> Result<(), StreamError> {
        let outputs = core.step(Inputs::default())?;
        self.checker.watch(self.cycle, false, false, &outputs)?;
        self.last_handshake = self.cycle;
        self.cycle += 1;
        self.released = self.cycle;
        Ok(())
    }

    /// The beat on offer in this cycle; draws from the source's pattern only while there is something to send.
    fn offer(&mut self) -> Beat {
        let Some(words) = self.traffic.packets.get(self.packet) else {
            return Beat::default();
        };
        let may_begin = match self.traffic.pacing {
            Pacing::BackToBack => true,
            Pacing::OneAtATime => self.inside.is_empty(),
            Pacing::Spaced { cycles, inside } => {
                self.begun.is_none_or(|begun| self.cycle >= begun + cycles) && self.inside.len() < inside
            }
        };
        if !self.offering && (may_begin || self.word > 0) {
            self.offering = self.source.next_cycle();
            if self.offering && self.word == 0 {
                self.begun = Some(self.cycle);
            }
        }
        // Zeros fill the last beat.
        let rest = words.get(self.word..).unwrap_or_default();
        let data = rest.iter().take(self.width).rev().fold(0, |data, &word| data << 32 | u128::from(word));
        Beat { valid: self.offering, data, last: self.offering && rest.len() <= self.width, ..Beat::default() }
    }

    fn run_cycle(&mut self, core: &mut impl Core) -> Result<(), StreamError> {
        let offer = self.offer();
        let ready = self.sink.next_cycle();
        let outputs = core.step(Inputs { run: true, source: offer, ready })?;
        self.checker.watch(self.cycle, true, ready, &outputs)?;
        let output = outputs.sink;
        // An answer may start while its packet is still coming in, but not before.
        let sending = offer.valid || self.word > 0;
        if output.valid && self.inside.is_empty() && !sending {
            return Err(self.violation(UNEXPECTED));
        }
        // It rises one cycle after the reset.
        if self.traffic.drops && !outputs.ready && self.cycle > self.released {
            return Err(self.violation("s_axis_tready is low, though the source cannot be held"));
        }
        if offer.valid && outputs.ready {
            self.taken(offer);
        }
        if output.valid && ready {
            self.received(output)?;
        }
        if self.cycle - self.last_handshake >= self.traffic.timeout && !self.done() {
            return Err(self.timeout(offer));
        }
        self.cycle += 1;
        Ok(())
    }

    fn taken(&mut self, beat: Beat) {
        self.last_handshake = self.cycle;
        self.offering = false;
        if self.word == 0 {
            self.first_in = self.cycle;
        }
        self.word += self.width;
        if beat.last {
            self.inside.push_back((self.packet, self.first_in));
            self.next_packet();
        }
    }

    fn received(&mut self, beat: Beat) -> Result<(), StreamError> {
        self.last_handshake = self.cycle;
        let kept = beat.keep.trailing_ones() as usize / 4;
        let right = u32::from(beat.keep) == (1_u32 << (4 * kept)) - 1
            && if beat.last { (1..=self.width).contains(&kept) } else { kept == self.width }
            && beat.data.checked_shr(32 * kept as u32).unwrap_or(0) == 0;
        if !right {
            return Err(self.violation(format!(
                "m_axis_tkeep is {:#x} in {}: whole words from the lowest on, all of them but in a frame's last beat, and \
                 zeros behind",
                beat.keep,
                show(beat)
            )));
        }
        self.words.extend((0..kept).map(|place| (beat.data >> (32 * place)) as u32));
        let longest = self.traffic.longest_answer;
        if self.words.len() > longest {
            // An answer may begin while its packet is still coming in.
            let frame = self.inside.front().map_or(self.packet, |&(packet, _)| packet);
            let excess = self.words.len() - longest;
            return Err(self.violation(format!(
                "the answer to frame {frame} has {excess} words too many: no m_axis_tlast after {longest} words"
            )));
        }
        if beat.last {
            let mut words = std::mem::take(&mut self.words);
            if self.traffic.drops {
                self.skip_dropped(&words);
            }
            let (packet, first_in) = self.inside.pop_front().ok_or_else(|| self.violation(UNEXPECTED))?;
            // Cores made up for tests of this driver have shorter answers, without a summary.
            let summary = words.get_mut(..SUMMARY_WORDS);
            if let Some(timestamp) = summary.and_then(|summary| summary.get_mut(TIMESTAMP)) {
                *timestamp = timestamp.wrapping_sub((first_in - self.released) as u32);
            }
            self.outcome.exchanges.push(Exchange { packet, first_in, last_out: self.cycle, words });
        }
        Ok(())
    }

    /// Leaves out the packets that were dropped: those that began before what the answer's timestamp says.
    fn skip_dropped(&mut self, words: &[u32]) {
        let began = self.released + u64::from(words.get(TIMESTAMP).copied().unwrap_or(0));
        while let Some(packet) = self.inside.pop_front_if(|&mut (_, first_in)| first_in < began) {
            self.outcome.dropped.push(packet);
        }
    }

    fn violation(&self, rule: impl Into<String>) -> StreamError {
        Violation::new(self.cycle, rule).into()
    }

    fn timeout(&self, offer: Beat) -> StreamError {
        let input = if offer.valid {
            format!("s_axis_tready stays low at word {} of frame {}", self.word, self.packet)
        } else {
            format!("m_axis_tvalid stays low with {} frames inside", self.inside.len())
        };
        StreamError::Timeout {
            waited: self.cycle - self.last_handshake,
            cycle: self.cycle,
            received: self.outcome.exchanges.len(),
            expected: self.traffic.packets.len(),
            inside: format!("{input}, {} words of the next answer seen", self.words.len()),
        }
    }
}
