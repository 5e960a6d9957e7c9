//! The processor beside a core with its calibration in RAM: it writes banks, right ones and wrong ones, commits and tares
//! while frames run, looks at what became of it, and keeps a log.

use std::collections::VecDeque;

use hdl_gen::plan::Plan;
use hdl_gen::plan::calibration::CalibrationPlan;
use rand::Rng;
use rand_chacha::ChaCha8Rng;

use super::banks;
use super::job::{Fault, Job, TARE_ERRORS};
use super::log::{Acting, Commits, Log, What};
use testbench::dut::{Core, Dut, DutError, Inputs, Outputs};
use testbench::registers::{Access, Controlled, address};

/// Of `CALIBRATION_STATUS`.
const STATUS_BUSY: u32 = 1 << 9;
const STATUS_TARING: u32 = 1 << 10;
/// Frames of a tare are 2 to the power of less than this.
const TARE_LOG2: u32 = 3;
/// Cycles in which a job ends once no frame comes any more.
const PATIENCE: u64 = 100_000;

/// A core with a processor at its register port.
pub struct Processor<'a> {
    plan: &'a Plan,
    of: &'a CalibrationPlan,
    core: Controlled,
    random: ChaCha8Rng,
    job: Option<Job>,
    /// Of the job, still to be made, one after the other.
    accesses: VecDeque<Access>,
    /// One is under way.
    asked: bool,
    /// Cycle from which on the next job may begin.
    next: u64,
    /// No frame comes any more, and no job begins.
    ending: bool,
    log: Log,
    /// What was wrong first.
    wrong: Option<String>,
}

impl<'a> Processor<'a> {
    /// Beside a core before its first clock edge; `random` decides what it does and when.
    ///
    /// # Errors
    /// [`DutError`] if the core has no register port.
    pub fn new(plan: &'a Plan, of: &'a CalibrationPlan, core: Dut, mut random: ChaCha8Rng) -> Result<Self, DutError> {
        let core = Controlled::new(core, random.random())?;
        let log = Log {
            acting: vec![Acting { what: What::Bank(of.power_up.clone()), since: 0 }],
            crc: of.power_up.crc(),
            commits: Commits::default(),
            dropped: None,
        };
        let next = random.random_range(0..2 * plan.timeline.interval_cycles);
        let (accesses, job) = (VecDeque::new(), None);
        Ok(Self { plan, of, core, random, job, accesses, asked: false, next, ending: false, log, wrong: None })
    }

    /// Ends what is under way, both streams at rest; a tare that waits for frames is given up.
    ///
    /// # Errors
    /// What the core did that it should not have.
    pub fn finish(mut self) -> Result<Log, String> {
        self.ending = true;
        let begun = self.core.cycle();
        while self.job.is_some() && self.wrong.is_none() {
            self.step(Inputs { run: true, ..Inputs::default() }).map_err(|error| error.to_string())?;
            if self.core.cycle() > begun + PATIENCE {
                return Err("the calibration stays busy though no frame comes any more".to_owned());
            }
        }
        if let Some(wrong) = self.wrong {
            return Err(wrong);
        }
        if self.plan.streams().drops {
            let dropped = self.core.read(address::FRAMES_DROPPED).map_err(|error| error.to_string())?;
            self.log.dropped = Some(dropped);
        }
        Ok(self.log)
    }

    /// What was wrong, if anything was.
    pub fn wrong(&self) -> Option<&str> {
        self.wrong.as_deref()
    }

    fn begin(&mut self) {
        let job = if self.random.random_bool(0.25) { self.tare() } else { self.load() };
        self.conclude_with(true);
        self.job = Some(job);
    }

    fn tare(&mut self) -> Job {
        let log2 = self.random.random_range(0..TARE_LOG2);
        self.accesses = VecDeque::from([write(address::TARE, log2)]);
        Job::new(What::Tare { log2, crc: 0 }, Fault::Nothing)
    }

    fn load(&mut self) -> Job {
        let mut bank = banks::any_bank(self.plan, self.of, &mut self.random);
        let fault = match self.random.random_range(0..12) {
            0 => Fault::Crc,
            1 => Fault::Half,
            2 => Fault::Word,
            3 => Fault::Early,
            4 | 5 => match banks::contradictory(self.of, &bank, &mut self.random) {
                Some(wrong) => {
                    bank = wrong;
                    Fault::Contradiction
                }
                None => Fault::Nothing,
            },
            _ => Fault::Nothing,
        };
        let mut words = bank.words();
        let crc = bank.crc() ^ if fault == Fault::Crc { 1 << self.random.random_range(0..32) } else { 0 };
        if fault == Fault::Half {
            // Of the offsets some are always left out: nothing else is as surely another one's.
            words.truncate(self.random.random_range(0..2 * self.of.taxels));
        }
        let mut accesses = VecDeque::from([write(address::CALIBRATION_INDEX, 0)]);
        accesses.extend(words.iter().map(|&word| write(address::CALIBRATION_DATA, word)));
        if fault == Fault::Word {
            let (place, word) = banks::out_of_bounds(self.of, &mut self.random);
            accesses.extend([write(address::CALIBRATION_INDEX, place), write(address::CALIBRATION_DATA, word)]);
        }
        accesses.push_back(write(address::CALIBRATION_COMMIT, crc));
        if fault == Fault::Early {
            let [word, other] = [words[0], self.random.random()];
            let early = [(address::CALIBRATION_DATA, word), (address::CALIBRATION_COMMIT, other), (address::TARE, 0)];
            let (place, data) = early[self.random.random_range(0..early.len())];
            accesses.push_back(write(place, data));
        }
        self.accesses = accesses;
        Job::new(What::Bank(bank), fault)
    }

    /// Asks how it went, after what is to be done before.
    fn conclude_with(&mut self, errors: bool) {
        self.accesses.push_back(read(address::CALIBRATION_STATUS));
        if errors {
            self.accesses.push_back(read(address::CALIBRATION_ERRORS));
        }
        self.accesses.push_back(read(address::CALIBRATION_CRC));
    }

    fn interrupted(&mut self) {
        self.asked = false;
        if let Some(job) = &mut self.job {
            job.interrupted = true;
            self.accesses.clear();
            self.conclude_with(false);
        }
    }

    fn replied(&mut self, access: Access, data: u32, cycle: u64) {
        self.asked = false;
        let (Access::Read { address }, Some(job)) = (access, &mut self.job) else { return };
        match address {
            address::CALIBRATION_STATUS if self.ending && data & STATUS_TARING != 0 => self.job = None,
            address::CALIBRATION_STATUS if data & STATUS_BUSY != 0 => self.accesses.push_front(access),
            address::CALIBRATION_STATUS => (job.version, job.over) = (data as u8, cycle),
            address::CALIBRATION_ERRORS => {
                job.errors = data;
                self.accesses.push_front(write(address, data));
            }
            _ => {
                if let Some(job) = self.job.take() {
                    self.conclude(job, data);
                }
                let pause = if self.random.random_bool(0.3) { 0 } else { 3 * self.plan.timeline.interval_cycles };
                self.next = cycle + self.random.random_range(0..=pause);
            }
        }
    }

    /// What became of a job, by the version and the CRC of what acts.
    fn conclude(&mut self, mut job: Job, crc: u32) {
        let before = self.log.acting.len() - 1;
        let accepted = match job.version.wrapping_sub(before as u8) {
            0 => false,
            1 => true,
            _ => return self.fault(&job, &format!("version {} after {before}", job.version)),
        };
        let is_right = match &mut job.what {
            What::Bank(bank) => {
                let as_told = accepted != job.fault.refuses() && job.errors == job.fault.error();
                let may_be = job.interrupted && !(accepted && job.fault.refuses());
                (as_told || may_be) && (!accepted || crc == bank.crc())
            }
            What::Tare { crc: tared, .. } => {
                *tared = crc;
                let refused = job.errors & TARE_ERRORS;
                job.interrupted || job.errors == refused && accepted == (refused == 0)
            }
        };
        if !is_right || !accepted && crc != self.log.crc {
            let happened = if accepted { "was taken" } else { "was not taken" };
            return self.fault(&job, &format!("{happened}, errors {:#x}, CRC {crc:#010x}", job.errors));
        }
        let commits = &mut self.log.commits;
        let tares = matches!(job.what, What::Tare { .. });
        *match (tares, accepted, job.interrupted) {
            (_, false, true) => &mut commits.lost_to_resets,
            (false, true, _) => &mut commits.banks,
            (false, false, false) => &mut commits.banks_refused,
            (true, true, _) => &mut commits.tares,
            (true, false, false) => &mut commits.tares_refused,
        } += 1;
        if accepted {
            self.log.crc = crc;
            self.log.acting.push(Acting { what: job.what, since: job.over });
        }
    }

    fn fault(&mut self, job: &Job, what: &str) {
        let (cycle, Job { fault, interrupted, .. }) = (self.core.cycle(), job);
        let of = match &job.what {
            What::Bank(_) => format!("a bank ({fault:?})"),
            What::Tare { log2, .. } => format!("a tare of 2^{log2} frames"),
        };
        let reset = if *interrupted { ", interrupted by a reset" } else { "" };
        self.wrong = Some(format!("cycle {cycle}: {of}{reset}: {what}"));
    }
}

impl Core for Processor<'_> {
    fn words(&self) -> usize {
        self.core.words()
    }

    fn step(&mut self, inputs: Inputs) -> Result<Outputs, DutError> {
        if !inputs.run {
            self.interrupted();
        } else if !self.asked && self.wrong.is_none() {
            if self.job.is_none() && !self.ending && self.core.cycle() >= self.next {
                self.begin();
            }
            if let Some(access) = self.accesses.pop_front() {
                self.core.plan(0, access);
                self.asked = true;
            }
        }
        let outputs = self.core.step(inputs)?;
        for reply in self.core.replies() {
            self.replied(reply.access, reply.data, reply.cycle);
        }
        Ok(outputs)
    }
}

fn write(address: u32, data: u32) -> Access {
    Access::Write { address, data, strobes: 0xF }
}

fn read(address: u32) -> Access {
    Access::Read { address }
}
