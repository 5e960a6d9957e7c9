//! What acted on the frames of a core with its calibration in RAM, version by version, and which answers show it.

use std::collections::BTreeSet;

use hdl_gen::model::Model;
use hdl_gen::plan::Plan;
use hdl_gen::plan::calibration::Bank;
use hdl_gen::plan::words::COUNTERS;
use serde::Serialize;

use super::random_banks::tared;
use testbench::stream::{Exchange, Outcome};

/// Packets before the first one with its offsets among which the frames of a tare are looked for.
const TARE_REACH: usize = 400;

/// Where a version's bank comes from.
#[derive(Clone, Debug)]
pub enum What {
    /// It was written, and committed.
    Bank(Bank),
    /// A tare of so many frames, as a power of two, made it of the one before.
    Tare {
        /// The power of two.
        log2: u32,
        /// CRC of the bank that it made.
        crc: u32,
    },
}

/// A version.
#[derive(Clone, Debug)]
pub struct Acting {
    /// Its bank.
    pub what: What,
    /// Cycle in which the core was seen to have changed to it, all frames that began before with the other one being in.
    pub since: u64,
}

/// What came of what was asked of the banks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Commits {
    /// Banks that were committed and acted.
    pub banks: u64,
    /// Of wrong banks and commits: refused as they should be, with the error that says why.
    pub banks_refused: u64,
    /// Tares that found rest.
    pub tares: u64,
    /// Tares that found none.
    pub tares_refused: u64,
    /// What a reset came between.
    pub lost_to_resets: u64,
}

impl Commits {
    /// Kind by kind.
    #[must_use]
    pub fn plus(self, other: Self) -> Self {
        Self {
            banks: self.banks + other.banks,
            banks_refused: self.banks_refused + other.banks_refused,
            tares: self.tares + other.tares,
            tares_refused: self.tares_refused + other.tares_refused,
            lost_to_resets: self.lost_to_resets + other.lost_to_resets,
        }
    }
}

/// What a processor did.
#[derive(Clone, Debug)]
pub struct Log {
    /// By version from power-up on, not modulo 256.
    pub acting: Vec<Acting>,
    /// Of what acts in the end.
    pub crc: u32,
    /// How often.
    pub commits: Commits,
    /// What `FRAMES_DROPPED` said in the end, since the last reset, of a core that drops frames.
    pub dropped: Option<u32>,
}

/// Lets the banks of the versions that answers state act in the model.
pub struct Banks<'a> {
    plan: &'a Plan,
    log: &'a Log,
    packets: &'a [Vec<u32>],
    dropped: BTreeSet<usize>,
    answered: BTreeSet<usize>,
    acts: usize,
    bank: Option<Bank>,
}

impl<'a> Banks<'a> {
    /// At power-up.
    pub fn new(plan: &'a Plan, log: &'a Log, packets: &'a [Vec<u32>], outcome: &Outcome) -> Self {
        let dropped = outcome.dropped.iter().map(|&(packet, _)| packet).collect();
        let answered = outcome.exchanges.iter().map(|exchange| exchange.packet).collect();
        let bank = plan.calibration.as_ref().map(|of| of.power_up.clone());
        Self { plan, log, packets, dropped, answered, acts: 0, bank }
    }

    /// Goes on to the version that an answer states.
    ///
    /// # Errors
    /// It goes back or there is no such version, the frame began when another one acted already, or no frames are
    /// there that a tare can have made its bank of.
    pub fn follow(&mut self, exchange: &Exchange, model: &mut Model<'_>) -> Result<(), String> {
        let Some(counters) = exchange.words.get(COUNTERS) else { return Ok(()) };
        let (packet, stated) = (exchange.packet, (counters >> 8) as u8);
        let version = self.acts + usize::from(stated.wrapping_sub(self.acts as u8));
        let last = self.log.acting.len() - 1;
        if version > last {
            return Err(format!("packet {packet}: version {stated} (modulo 256) after {} of {last}", self.acts));
        }
        if let Some(next) = self.log.acting.get(version + 1).filter(|next| exchange.first_in >= next.since) {
            let since = next.since;
            return Err(format!("packet {packet}: version {version}, though the next one acts since cycle {since}"));
        }
        while self.acts < version {
            self.acts += 1;
            let bank = match &self.log.acting[self.acts].what {
                What::Bank(bank) => bank.clone(),
                What::Tare { log2, crc } => self.tared(1 << log2, *crc, packet).ok_or_else(|| {
                    format!("packet {packet}: no 2^{log2} frames before it make the offsets of version {}", self.acts)
                })?,
            };
            model.commit(bank.clone());
            self.bank = Some(bank);
        }
        Ok(())
    }

    /// What a tare of frames behind each other, before a packet, makes of the active bank: the one with this CRC.
    fn tared(&self, frames: usize, crc: u32, before: usize) -> Option<Bank> {
        let first = before.saturating_sub(TARE_REACH);
        (first..before).rev().find_map(|packet| self.tared_with(&mut vec![packet], frames, crc, before))
    }

    /// The same of frames of which the first ones are given. Behind each comes the next one that was taken; those of which
    /// that is not known may have been, or not.
    fn tared_with(&self, given: &mut Vec<usize>, frames: usize, crc: u32, before: usize) -> Option<Bank> {
        let last = *given.last()?;
        if self.dropped.contains(&last) || !self.plan.streams().is_frame(self.packets[last].len()) {
            return None;
        }
        if given.len() == frames {
            let (of, streams) = (self.plan.calibration.as_ref()?, self.plan.streams());
            let samples = |&packet: &usize| {
                streams.samples_of(self.packets[packet].iter().copied()).take(of.taxels).collect::<Vec<u32>>()
            };
            let bank = tared(self.bank.as_ref()?, of, &given.iter().map(samples).collect::<Vec<_>>())?;
            return (bank.crc() == crc).then_some(bank);
        }
        let drops = self.plan.streams().drops;
        for next in last + 1..before {
            given.push(next);
            let found = self.tared_with(given, frames, crc, before);
            given.pop();
            let surely_taken = self.answered.contains(&next) || !drops;
            if found.is_some() || surely_taken {
                return found;
            }
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use golden::design::Design;

    use super::*;

    const DESIGN: &str = "format = 3\nbase = \"../golden/tests/plain.toml\"\n\
        name = \"tiny\"\n[sensor]\ncolumns = 2\nrows = 2\npitch_mm = [4.0, 4.0]\ndepth_mm = 3.0\n\
        pa_per_count = -12.5\n[hardware]\ncontrol = true\ncalibration = \"ram\"\n";

    /// Six packets, two by power-up's bank, two by another one, two by what a tare made of that, of the packets before; the
    /// answers changed.
    fn followed(change: fn(&mut Vec<Exchange>, &mut Log)) -> Result<(), String> {
        let plan = Plan::new(&Design::from_toml(DESIGN, "tiny.toml").unwrap()).unwrap();
        let of = plan.calibration.as_ref().unwrap();
        let packets: Vec<Vec<u32>> =
            [3.0_f32, 900.0, 40.0, 41.0, 2.0, 80.0].map(|count| vec![count.to_bits(); 4]).to_vec();
        // By its noise floor a count more or less is rest.
        let other = Bank { contact: 99, noise: 1 << 20, ..of.power_up.clone() };
        let tared = tared(&other, of, &packets[2..4]).unwrap();
        let mut model = Model::new(&plan);
        let mut exchanges = Vec::new();
        for (packet, words) in packets.iter().enumerate() {
            match packet {
                2 => model.commit(other.clone()),
                4 => model.commit(tared.clone()),
                _ => {}
            }
            let words = model.process(words);
            exchanges.push(Exchange { packet, first_in: packet as u64 * 100, last_out: 0, words });
        }
        let tare = What::Tare { log2: 1, crc: tared.crc() };
        let acting = [(What::Bank(of.power_up.clone()), 0), (What::Bank(other), 150), (tare, 350)];
        let acting = acting.into_iter().map(|(what, since)| Acting { what, since }).collect();
        let mut log = Log { acting, crc: tared.crc(), commits: Commits::default(), dropped: None };
        change(&mut exchanges, &mut log);
        let mut banks = Banks::new(&plan, &log, &packets, &Outcome::default());
        let mut model = Model::new(&plan);
        for exchange in &exchanges {
            banks.follow(exchange, &mut model)?;
            if model.process(&packets[exchange.packet]) != exchange.words {
                return Err(format!("packet {} differs", exchange.packet));
            }
        }
        Ok(())
    }

    #[test]
    fn answers_by_the_banks_that_they_state_are_right() {
        assert_eq!(followed(|_, _| ()), Ok(()));
    }

    #[test]
    fn versions_that_cannot_be_are_found() {
        type Fault = fn(&mut Vec<Exchange>, &mut Log);
        let faults: [(&str, Fault); 6] = [
            ("version 3 (modulo 256) after 2 of 2", |answers, _| answers[5].words[COUNTERS] += 1 << 8),
            ("version 0 (modulo 256) after 1 of 2", |answers, _| answers[3].words[COUNTERS] -= 1 << 8),
            ("packet 3: version 1, though the next one acts", |answers, _| answers[3].first_in = 350),
            ("packet 3 differs", |answers, _| answers[3].words[0] ^= 1),
            ("packet 4: no 2^1 frames", |_, log| log.acting[2].what = What::Tare { log2: 1, crc: 5 }),
            ("packet 4: no 2^0 frames", |_, log| {
                let What::Tare { crc, .. } = log.acting[2].what else { return };
                log.acting[2].what = What::Tare { log2: 0, crc };
            }),
        ];
        for (reason, fault) in faults {
            let error = followed(fault).unwrap_err();
            assert!(error.contains(reason), "{error}");
        }
    }
}
