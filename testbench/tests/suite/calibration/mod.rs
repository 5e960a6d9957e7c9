//! A calibration in RAM: banks with any content, commits at any moment, what is refused, tare. Every frame is compared
//! bit for bit with the model of the bank whose version it states.

mod banks;
mod commits;
mod contents;
pub mod curve;
pub mod dead;
mod tare;

use std::sync::OnceLock;

use golden::design::Outputs;
use hdl_gen::model::Model;
use hdl_gen::plan::Plan;
use hdl_gen::plan::calibration::{Bank, CalibrationPlan};
use hdl_gen::plan::words::{COUNTERS, TIMESTAMP};
use rand_chacha::ChaCha8Rng;
use testbench::co_simulation::timeout;
use testbench::dut::{Beat, Core, Inputs};
use testbench::registers::{Access, Controlled, address};
use testbench::stream::{Traffic, exchange};
use testbench::verilate::Built;

pub use crate::support::calibrated::design;
use crate::support::{built, frames, planned};

/// Bits of `CALIBRATION_ERRORS`.
const OUT_OF_RANGE: u32 = 1;
const BUSY: u32 = 1 << 1;
const WRONG_CRC: u32 = 1 << 2;
const NOT_AT_REST: u32 = 1 << 3;
const BAD_FRAME: u32 = 1 << 4;
const CONTRADICTION: u32 = 1 << 5;
/// Of `CALIBRATION_STATUS`.
const STATUS_BUSY: u32 = 1 << 9;
/// `CALIBRATION_INDEX`: of the active bank.
const ACTIVE: u32 = 1 << 31;

struct Subject {
    plan: Plan,
    built: Built,
}

impl Subject {
    fn calibration(&self) -> &CalibrationPlan {
        self.plan.calibration.as_ref().expect("in RAM")
    }

    /// The core with its reset over and its streams at rest.
    fn core(&self, seed: u64) -> Controlled {
        let mut core = core(&self.built, seed);
        for _ in 0..8 {
            core.step(Inputs::default()).expect("runs");
        }
        assert_eq!(core.read(address::CALIBRATION_CRC).expect("a reply"), self.calibration().power_up.crc());
        core
    }
}

/// The one design and the one build of this topic.
fn subject() -> &'static Subject {
    static SUBJECT: OnceLock<Subject> = OnceLock::new();
    SUBJECT.get_or_init(|| {
        let plan = planned(&design(Outputs::Resultants));
        let built = built(&plan);
        Subject { plan, built }
    })
}

fn core(built: &Built, seed: u64) -> Controlled {
    Controlled::new(built.load(seed as u32).expect("loads"), seed).expect("has a port")
}

/// Frames of counts: contacts and the ends of the range.
fn counts(plan: &Plan, count: usize, random: &mut ChaCha8Rng) -> Vec<Vec<u32>> {
    let of_pascals = |packet: Vec<u32>| -> Vec<u32> {
        packet.into_iter().map(|word| (f32::from_bits(word) / -12.5).round().to_bits()).collect()
    };
    (0..count)
        .map(|index| {
            of_pascals(match index % 5 {
                4 => frames::noise(plan, 1.3, random),
                3 => frames::noise(plan, 2e-5, random),
                _ => frames::contact(plan, random),
            })
        })
        .collect()
}

/// Accesses that write a bank, and commit it with a CRC.
fn load(bank: &Bank, crc: u32) -> Vec<Access> {
    let write = |address, data| Access::Write { address, data, strobes: 0xF };
    let words = bank.words().into_iter().map(|word| write(address::CALIBRATION_DATA, word));
    std::iter::once(write(address::CALIBRATION_INDEX, 0))
        .chain(words)
        .chain([write(address::CALIBRATION_COMMIT, crc)])
        .collect()
}

/// Makes accesses with the streams at rest, and waits for what they began.
fn perform(core: &mut Controlled, accesses: &[Access]) {
    for &access in accesses {
        core.access(access).expect("a reply");
    }
    wait(core);
}

fn wait(core: &mut Controlled) {
    for _ in 0..1000 {
        if core.read(address::CALIBRATION_STATUS).expect("a reply") & STATUS_BUSY == 0 {
            return;
        }
    }
    panic!("busy for ever");
}

/// Reads a bank word by word: the active one, or the other.
fn read_back(core: &mut Controlled, active: bool) -> Vec<u32> {
    let words = core.read(address::CALIBRATION).expect("a reply") & 0xFFFF;
    (0..words)
        .map(|index| {
            core.write(address::CALIBRATION_INDEX, index | if active { ACTIVE } else { 0 }).expect("a reply");
            core.read(address::CALIBRATION_DATA).expect("a reply")
        })
        .collect()
}

/// Errors since they were asked for last; clears them.
fn errors(core: &mut Controlled) -> u32 {
    let errors = core.read(address::CALIBRATION_ERRORS).expect("a reply");
    core.write(address::CALIBRATION_ERRORS, errors).expect("a reply");
    assert_eq!(core.read(address::CALIBRATION_ERRORS).expect("a reply"), 0);
    errors
}

fn version(core: &mut Controlled) -> u32 {
    core.read(address::CALIBRATION_STATUS).expect("a reply") & 0xFF
}

/// Sends packets back to back while the planned accesses go on; each answer against the model of the bank of the
/// version that it states, which never goes back. `banks` are those of the versions from 0 on. The versions.
fn judged(plan: &Plan, core: &mut Controlled, packets: &[Vec<u32>], banks: &[Bank]) -> Result<Vec<usize>, String> {
    let traffic = Traffic::new(packets, timeout(plan));
    judged_in(plan, core, &traffic, banks)
}

fn judged_in(plan: &Plan, core: &mut Controlled, traffic: &Traffic<'_>, banks: &[Bank]) -> Result<Vec<usize>, String> {
    let outcome = exchange(core, traffic, |_| ()).map_err(|error| error.to_string())?;
    let answers: Vec<_> = outcome.exchanges.into_iter().map(|exchange| exchange.words).collect();
    judge(plan, traffic.packets, &answers, banks)
}

/// The answers of a core just out of reset, by the model.
fn judge(plan: &Plan, packets: &[Vec<u32>], answers: &[Vec<u32>], banks: &[Bank]) -> Result<Vec<usize>, String> {
    let mut model = Model::new(plan);
    let mut acts = 0;
    let mut versions = Vec::new();
    for (frame, (words, packet)) in answers.iter().zip(packets).enumerate() {
        let stated = (words[COUNTERS] >> 8 & 0xFF) as usize;
        if stated < acts || stated >= banks.len() {
            return Err(format!("frame {frame}: version {stated} after {acts}"));
        }
        while acts < stated {
            acts += 1;
            model.commit(banks[acts].clone());
        }
        let expected = model.process(packet);
        if *words != expected {
            let at = words.iter().zip(&expected).position(|(seen, expected)| seen != expected);
            return Err(format!("frame {frame}, version {stated}: word {at:?} differs"));
        }
        versions.push(stated);
    }
    if answers.len() != packets.len() {
        return Err(format!("{} answers to {} frames", answers.len(), packets.len()));
    }
    Ok(versions)
}

/// Sends packets into a core that is not reset before, the sink always willing; the answers without their timestamps.
fn send(core: &mut Controlled, packets: &[Vec<u32>]) -> Vec<Vec<u32>> {
    let beats = packets.iter().flat_map(|packet| {
        let last = packet.len() - 1;
        packet.iter().enumerate().map(move |(index, &word)| (u128::from(word), index == last))
    });
    let mut beats = beats.peekable();
    let (mut answers, mut answer) = (Vec::new(), Vec::new());
    for _ in 0..200_000 {
        let offer = beats.peek().copied();
        let (data, last) = offer.unwrap_or_default();
        let source = Beat { valid: offer.is_some(), data, last, ..Beat::default() };
        let outputs = core.step(Inputs { run: true, source, ready: true }).expect("runs");
        if outputs.ready && offer.is_some() {
            beats.next();
        }
        if outputs.sink.valid {
            answer.push(outputs.sink.data as u32);
            if outputs.sink.last {
                answer[TIMESTAMP] = 0;
                answers.push(std::mem::take(&mut answer));
            }
        }
        if answers.len() == packets.len() {
            return answers;
        }
    }
    panic!("{} answers to {} frames", answers.len(), packets.len());
}
