//! A soft reset in any cycle: no rule of the streams is broken, no packet out is cut, and frames after it are right.

use std::collections::VecDeque;

use hdl_gen::model::Model;
use hdl_gen::plan::words::TIMESTAMP;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use testbench::co_simulation::timeout;
use testbench::dut::{Beat, Core, Inputs};
use testbench::registers::{Access, Controlled, address};
use testbench::stream::{Checker, Mode};
use testbench::verilate::Built;

use super::{Subject, mixed, subjects};
use crate::support::effort::{self, some_of};
use crate::support::faults::{broken, some_faults};
use crate::support::{frames, in_parallel};

/// Frames that may be lost: those inside the core, see the test of resets, and the one that is being sent.
const MOST_LOST: usize = 9;

/// What came out, in order, and what the bank said at the end.
struct Story {
    answers: Vec<Vec<u32>>,
    frames_in: u32,
    frames_out: u32,
}

/// Sends packets without regard to what comes back, while the planned accesses go on.
fn send(subject: &Subject, built: &Built, packets: &[Vec<u32>], mode: &Mode, resets: &[u64]) -> Result<Story, String> {
    let mut core = Controlled::new(built.load(7).expect("loads"), 7).map_err(|error| error.to_string())?;
    for &cycle in resets {
        core.plan(cycle, Access::Write { address: address::CONTROL, data: 1, strobes: 1 });
    }
    let (mut source, mut sink) = (mode.source.start(), mode.sink.start());
    let mut checker = Checker::default();
    let mut words: VecDeque<(u32, bool)> = packets
        .iter()
        .flat_map(|packet| packet.iter().enumerate().map(|(index, &word)| (word, index + 1 == packet.len())))
        .collect();
    let (mut answers, mut answer) = (Vec::new(), Vec::new());
    let (mut offering, mut quiet) = (false, 0);
    while quiet < timeout(&subject.plan) {
        let run = core.cycle() > 8;
        offering = run && (offering || !words.is_empty() && source.next_cycle());
        let (data, last) = words.front().copied().unwrap_or_default();
        let ready = sink.next_cycle();
        let beat = Beat { valid: offering, data: u128::from(data), last, ..Beat::default() };
        let cycle = core.cycle();
        let outputs = core.step(Inputs { run, source: beat, ready }).map_err(|error| error.to_string())?;
        checker.watch(cycle, run, ready, &outputs).map_err(|error| error.to_string())?;
        quiet += 1;
        if run && offering && outputs.ready {
            words.pop_front();
            (offering, quiet) = (false, 0);
        }
        if run && outputs.sink.valid && ready {
            answer.push(outputs.sink.data as u32);
            quiet = 0;
            if outputs.sink.last {
                // The model does not know when the frame came in.
                answer[TIMESTAMP] = 0;
                answers.push(std::mem::take(&mut answer));
            }
        }
    }
    if !words.is_empty() || !answer.is_empty() {
        return Err(format!("{} words were not taken, {} wait for their TLAST", words.len(), answer.len()));
    }
    let mut read = |at| core.read(at).map_err(|error| error.to_string());
    let (frames_in, frames_out) = (read(address::FRAMES_IN)?, read(address::FRAMES_OUT)?);
    let status = read(address::STATUS)?;
    if status != 0 {
        return Err(format!("STATUS is {status:#x} at rest"));
    }
    Ok(Story { answers, frames_in, frames_out })
}

/// Judges the answers to distinct packets: in order, each right, their numbers from 0 again after a reset.
fn judge(subject: &Subject, packets: &[Vec<u32>], resets: usize, story: &Story) -> Result<(), String> {
    let mut models = vec![Model::new(&subject.plan)];
    let (mut next, mut since) = (0, 0);
    for (index, words) in story.answers.iter().enumerate() {
        if words[0] >> 16 == 0 && index > 0 {
            models.push(Model::new(&subject.plan));
            since = 0;
        }
        let model = models.last_mut().expect("at least one");
        let right = |packet: usize| packets.get(packet).is_some_and(|packet| model.clone().process(packet) == *words);
        // Only behind a reset is anything missing; the first may come before any answer.
        let most = if since == 0 { resets * MOST_LOST } else { 0 };
        let Some(packet) = (next..=next + most).find(|&packet| right(packet)) else {
            return Err(format!("answer {index} is not that to packet {next} or the {most} after it"));
        };
        model.process(&packets[packet]);
        (next, since) = (packet + 1, since + 1);
    }
    if next != packets.len() || models.len() > 1 + resets {
        return Err(format!("{next} of {} packets, {} resets seen", packets.len(), models.len() - 1));
    }
    let counted = (story.frames_in, story.frames_out);
    if counted != (since, since) {
        return Err(format!("counted {counted:?}, {since} since the reset"));
    }
    Ok(())
}

fn packets(subject: &Subject, count: usize) -> Vec<Vec<u32>> {
    let mut random = ChaCha8Rng::seed_from_u64(4);
    (0..count).map(|_| frames::contact(&subject.plan, &mut random)).collect()
}

#[test]
fn a_soft_reset_in_any_cycle_cuts_no_packet() {
    let cases: Vec<_> = subjects()
        .iter()
        .flat_map(|subject| {
            let timeline = &subject.plan.timeline;
            let cycles = 0..timeline.latency_cycles + 2 * timeline.interval_cycles;
            some_of(cycles.step_by(13)).into_iter().enumerate().map(move |(index, cycle)| (subject, index, cycle))
        })
        .collect();
    in_parallel(&cases, |&(subject, index, cycle)| {
        let packets = packets(subject, 16);
        let mode = Mode::all(cycle)[index % Mode::COUNT];
        let told = send(subject, &subject.built, &packets, &mode, &[cycle + 9])
            .and_then(|story| judge(subject, &packets, 1, &story));
        told.unwrap_or_else(|error| panic!("{}, cycle {cycle}, {}: {error}", subject.plan.design.name, mode.name));
    });
}

/// Short, long and broken packets too. What comes before the reset answers the first packets, what comes after it the
/// last ones.
#[test]
fn a_soft_reset_among_bad_frames_costs_the_frames_inside() {
    // By an odd step every mode is among them.
    let step = if effort::all() { 1 } else { 9 };
    let cases: Vec<_> =
        subjects().iter().flat_map(|subject| (0..40).step_by(step).map(move |case| (subject, case))).collect();
    in_parallel(&cases, |&(subject, case)| {
        let packets = mixed(&subject.plan, 30, &mut ChaCha8Rng::seed_from_u64(case));
        let cycle = 9 + case * subject.plan.timeline.interval_cycles / 4;
        let mode = Mode::all(case)[case as usize % 4];
        let at = format!("{}, cycle {cycle}, {}", subject.plan.design.name, mode.name);
        let story =
            send(subject, &subject.built, &packets, &mode, &[cycle]).unwrap_or_else(|error| panic!("{at}: {error}"));
        let after = story.frames_out as usize;
        let before = story.answers.len() - after;
        let lost = packets.len() - story.answers.len();
        assert!(lost <= MOST_LOST && after > 0, "{at}: {before} answers, {lost} lost, {after} answers");
        for (sent, seen) in
            [(&packets[..before], &story.answers[..before]), (&packets[before + lost..], &story.answers[before..])]
        {
            let mut model = Model::new(&subject.plan);
            for (packet, words) in sent.iter().zip(seen) {
                assert_eq!(*words, model.process(packet), "{at}");
            }
        }
    });
}

#[test]
fn soft_resets_on_each_others_heels_cut_no_packet() {
    for subject in subjects() {
        let interval = subject.plan.timeline.interval_cycles;
        let packets = packets(subject, 80);
        let resets: Vec<u64> = (0..12).map(|k| 3 * interval + k * (1 + k * k * interval / 80)).collect();
        for mode in Mode::all(6) {
            let story = send(subject, &subject.built, &packets, &mode, &resets).expect(mode.name);
            judge(subject, &packets, resets.len(), &story)
                .unwrap_or_else(|error| panic!("{}, {}: {error}", subject.plan.design.name, mode.name));
        }
    }
}

#[test]
fn a_gate_that_cuts_packets_is_noticed() {
    let subject = &subjects()[0];
    let faults = [
        ("wire out_open = !resetting || sending;", "wire out_open = !resetting;"),
        ("resetting && !sending && !core_reset", "resetting && !core_reset"),
        ("discarding <= in_packet_next;", "discarding <= 1'b0;"),
        ("core_s_tvalid = s_tvalid && in_open", "core_s_tvalid = s_tvalid"),
    ];
    for (from, to) in some_faults(faults, |&(from, _)| ("sptfra_stream_gate", from)) {
        let built = broken(&subject.plan, "sptfra_stream_gate", from, to);
        let packets = packets(subject, 16);
        let noticed = (0..1500).step_by(37).any(|cycle| {
            let mode = Mode::all(cycle)[3];
            send(subject, &built, &packets, &mode, &[cycle + 9])
                .and_then(|story| judge(subject, &packets, 1, &story))
                .is_err()
        });
        assert!(noticed, "{to}");
    }
}
