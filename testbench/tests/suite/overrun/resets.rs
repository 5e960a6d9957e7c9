//! Soft resets under a scanner that cannot be held: it never is, and whole frames come out before and after.

use hdl_gen::model::{DROPPED, Model};
use hdl_gen::plan::words::TIMESTAMP;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use testbench::co_simulation::timeout;
use testbench::dut::{Beat, Core, Inputs};
use testbench::registers::{Access, Controlled, address};
use testbench::stream::{Checker, Mode, Pattern};

use super::{Subject, packets, subjects};
use crate::support::in_parallel;

/// Cycles after which a beat is on offer in every one.
const BEGIN: u64 = 10;
/// Resets of a run.
const RESETS: usize = 5;

/// Sends every packet's beats one after the other, with the source's pauses; the answers without their timestamps.
/// The last packet is sent when all is quiet.
fn send(
    core: &mut Controlled,
    subject: &Subject,
    packets: &[Vec<u32>],
    source: Pattern,
    sink: Pattern,
) -> Vec<Vec<u32>> {
    let width = subject.plan.streams().words();
    let beats = packets.iter().enumerate().flat_map(|(number, packet)| {
        let beats =
            packet.chunks(width).map(|words| words.iter().rev().fold(0, |data, &word| data << 32 | u128::from(word)));
        let last = packet.len().div_ceil(width);
        (1..).zip(beats).map(move |(beat, data)| (number, data, beat == last))
    });
    let mut beats = beats.peekable();
    let (mut source, mut sink) = (source.start(), sink.start());
    let mut checker = Checker::default();
    let (mut answers, mut answer) = (Vec::new(), Vec::new());
    let mut quiet = 0;
    while quiet < timeout(&subject.plan) || beats.peek().is_some() {
        let cycle = core.cycle();
        let run = cycle >= BEGIN - 2;
        let may =
            |&&(number, ..): &&(usize, u128, bool)| number + 1 < packets.len() || quiet >= timeout(&subject.plan) / 2;
        let waits = beats.peek().is_some_and(|beat| may(&beat));
        let offer = (cycle >= BEGIN && waits && source.next_cycle()).then(|| beats.next()).flatten();
        let (_, data, last) = offer.unwrap_or_default();
        let ready = sink.next_cycle();
        let beat = Beat { valid: offer.is_some(), data, last, ..Beat::default() };
        let outputs = core.step(Inputs { run, source: beat, ready }).expect("runs");
        checker.watch(cycle, run, ready, &outputs).unwrap_or_else(|error| panic!("{error}"));
        assert!(outputs.ready || cycle < BEGIN, "cycle {cycle}: the scanner is held");
        quiet = if offer.is_some_and(|(number, ..)| number + 1 < packets.len()) { 0 } else { quiet + 1 };
        if run && outputs.sink.valid && ready {
            answer.extend((0..width).map(|place| (outputs.sink.data >> (32 * place)) as u32));
            quiet = quiet.min(timeout(&subject.plan) / 2);
            if outputs.sink.last {
                answer[TIMESTAMP] = 0;
                answers.push(std::mem::take(&mut answer));
            }
        }
    }
    assert!(answer.is_empty(), "a packet out was cut");
    answers
}

#[test]
fn a_soft_reset_never_holds_the_scanner_and_leaves_no_parts() {
    let controlled = subjects().iter().filter(|subject| subject.plan.design.hardware.control);
    let cases: Vec<_> = controlled.flat_map(|subject| (0..12).map(move |seed| (subject, seed))).collect();
    in_parallel(&cases, |&(subject, seed)| {
        let plan = &subject.plan;
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let mut core = Controlled::new(subject.built.load(2).expect("loads"), seed).expect("has a port");
        let [.., idle] = Mode::all(seed);
        let source = if seed % 3 == 0 { Pattern::Free } else { idle.source };
        let sink = if seed % 2 == 0 { Pattern::Free } else { Pattern::Random { seed, willing: 0.1 } };
        let mut packets = packets(plan, 400);
        // Told apart by their answers, so whole ones only.
        packets.retain(|packet| plan.streams().is_frame(packet.len()));
        for _ in 0..RESETS {
            let cycle = random.random_range(BEGIN..BEGIN + 6 * packets.len() as u64);
            core.plan(cycle, Access::Write { address: address::CONTROL, data: 1, strobes: 1 });
        }
        let answers = send(&mut core, subject, &packets, source, sink);
        let at = format!("{}, {seed}", plan.design.name);

        let mut model = Model::new(plan);
        let (mut next, mut since, mut before) = (0, 0, 0);
        for words in &answers {
            let mut words = words[..plan.words_out()].to_vec();
            words[0] &= !DROPPED;
            if words[0] >> 16 == 0 && since > 0 {
                (model, since, before) = (Model::new(plan), 0, next);
            }
            let found = (next..packets.len()).find(|&packet| model.clone().process(&packets[packet]) == words);
            let packet = found.unwrap_or_else(|| panic!("{at}: an answer is to no packet from {next} on"));
            model.process(&packets[packet]);
            (next, since) = (packet + 1, since + 1);
        }
        assert_eq!(next, packets.len(), "{at}: the last one, sent alone, has an answer");
        let counted = [address::FRAMES_IN, address::FRAMES_OUT, address::FRAMES_DROPPED, address::STATUS]
            .map(|address| core.read(address).expect("a reply") as usize);
        assert_eq!((counted[0], counted[1], counted[3]), (since, since, 0), "{at}");
        assert!(counted[2] + since <= packets.len() - before, "{at}: {} dropped", counted[2]);
    });
}
