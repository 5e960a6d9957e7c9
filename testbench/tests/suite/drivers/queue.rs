//! The C driver's queue: no frame is lost or doubled that is not reported, whatever the DMA does.

use std::fs;
use std::path::Path;
use std::process::Command;

use golden::design::Outputs;

use super::{DRIVER, MACHINE, SANITIZED, Subject, arguments, compile, run};
use crate::support::faults::some_faults_of;
use crate::support::workspace;

/// The program of `queue.c` with another text of a driver's file, where one is given.
fn program(subject: &Subject, changed: Option<(&str, &Path)>) -> Command {
    let host = subject.file("queue");
    let own = ["drivers/c/sptfra_queue.c", "testbench/tests/suite/drivers/queue.c"];
    let place = |path: &&str| match changed {
        Some((name, copy)) if path.ends_with(name) => copy.to_owned(),
        _ => workspace(path),
    };
    let sources: Vec<_> = DRIVER.iter().chain(&MACHINE).chain(&own).map(place).collect();
    compile(&sources.iter().map(std::path::PathBuf::as_path).collect::<Vec<_>>(), &SANITIZED, &host);
    let mut command = Command::new(host);
    command.args(arguments(subject));
    command
}

#[test]
fn every_frame_of_the_queue_is_answered_or_reported() {
    for (control, stream_bits) in [(true, 32), (true, 64), (false, 32)] {
        let subject = Subject::wide(control, Outputs::Field, stream_bits);
        let said = run(program(&subject, None));
        assert!(said.contains("lost and reported in"), "{said}");
    }
}

/// The test notices a queue that is wrong.
#[test]
fn a_wrong_queue_is_noticed() {
    let subject = Subject::new(true, Outputs::Field);
    let text = fs::read_to_string(workspace("drivers/c/sptfra_queue.c")).expect("is there");
    let faults = [
        // A descriptor that is used again as it came back.
        ("    words[STATUS] = 0;\n", ""),
        // An answer before it was there, and one whose frame's descriptor is not yet free.
        ("sent & *received & COMPLETE", "sent & COMPLETE"),
        ("        offer_answer(queue, queue->next_out);\n", ""),
        ("queue->sent - queue->taken == queue->depth", "queue->sent - queue->taken == queue->depth + 1u"),
        ("code = drop_answers(queue, polls);", "code = drop_answers(queue, 0u * polls);"),
        ("    *lost = code == SPTFRA_OK ? without : 0u;", "    *lost = 0u * without;"),
        ("& (STATUS_FAULTS | STATUS_HALTED)", "& STATUS_FAULTS"),
        ("sptfra_in_step(queue->device, forces) &&", "(sptfra_in_step(queue->device, forces) || 1) &&"),
        (" && !(status & SPTFRA_DROPPED)", ""),
        // A place by a number that wraps.
        ("queue->next_in * queue->stride_in", "queue->sent % queue->depth * queue->stride_in"),
        ("DMA_STATUS, STATUS_INTERRUPTS);\n        dma_set", "DMA_STATUS, 0);\n        dma_set"),
        ("        return SPTFRA_DROPS;\n", ""),
        ("    queue->failed = 1;\n    if (depth", "    if (depth"),
        ("queue->forces + slot * queue->stride_out)\n", "queue->forces)\n"),
        // Another frame than the one that is answered.
        ("queue->stress + queue->next_out * queue->stride_in", "queue->stress"),
    ];
    for (right, wrong) in some_faults_of(&text, faults) {
        let copy = subject.file("sptfra_queue.c");
        fs::write(&copy, text.replace(right, wrong)).expect("written");
        let output = program(&subject, Some(("sptfra_queue.c", &copy))).output().expect("starts");
        assert!(!output.status.success(), "{right}: {}", String::from_utf8_lossy(&output.stdout));
    }
}
