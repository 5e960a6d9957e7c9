//! A core that tells bodies apart: its records through the drivers and the programs around them.

use std::fs;

use crate::support::effort::some_of;
use golden::design::Outputs;
use golden::forces;
use hdl_gen::plan::Plan;
use testbench::trial::model_answers;

use super::examples::{MAKE, bash, desk, said};
use super::{Subject, noticed};

const CONTACTS: usize = 2;
/// Words before the records, and of each.
const FIRST: usize = 16;
const EACH: usize = 8;

/// Two bodies told apart, on 4 x 3 taxels; one of more has no record.
pub fn subject(control: bool) -> Subject {
    Subject::changed(Outputs::Field, |design| {
        design.hardware.control = control;
        design.algorithm.contacts = CONTACTS;
    })
}

/// Frames of one, of two and of more bodies.
pub fn press(plan: &Plan, packets: &mut [Vec<u32>]) {
    let marks: [fn(usize, usize) -> bool; 3] =
        [|x, y| x < 2 && y < 2, |x, _| x % 3 == 0, |x, y| x % 2 == 0 && y % 2 == 0];
    for (packet, mark) in packets.iter_mut().zip(marks.into_iter().cycle()) {
        *packet = plan.streams().packet(&pressed(plan, mark));
    }
}

/// A frame that presses where there is a mark.
fn pressed(plan: &Plan, mark: fn(usize, usize) -> bool) -> Vec<f64> {
    let columns = plan.design.sensor.columns;
    let stress = |taxel: usize| {
        let presses = mark(taxel % columns, taxel / columns);
        if presses { -3e4 * (1.0 + 0.4 * (taxel % 3) as f64) } else { 200.0 * (taxel % 7) as f64 }
    };
    (0..plan.taxels()).map(stress).collect()
}

/// A driver that reads the records of bodies wrongly.
#[test]
fn a_wrong_reader_of_bodies_is_noticed() {
    let subject = subject(true);
    for (right, wrong) in some_of([
        ("SPTFRA_SUMMARY_WORDS + SPTFRA_RECORD_WORDS * records : NULL", "SPTFRA_SUMMARY_WORDS : NULL"),
        ("SPTFRA_RECORD_WORDS * index, &result", "SPTFRA_RECORD_WORDS, &result"),
        ("raw + SPTFRA_RECORD_CENTRE, sizeof", "raw + SPTFRA_RECORD_FORCE, sizeof"),
        ("(uint16_t)(raw[SPTFRA_RECORD_STATUS] >> 16)", "(uint16_t)raw[SPTFRA_RECORD_STATUS]"),
        ("result->bodies < records ? result->bodies : records", "records"),
        ("    memset(result->body, 0, sizeof result->body);\n", ""),
        (" || more == SPTFRA_RECORD_WORDS\n", "\n"),
        ("more % SPTFRA_RECORD_WORDS != 0 || ", ""),
    ]) {
        noticed(&subject, right, wrong);
    }
}

/// The programs print a record for each body, by the names of force files.
#[test]
fn records_stand_behind_the_status() {
    let (subject, desk) = (subject(true), desk());
    let plan = &subject.plan;
    let mut packets = vec![vec![0; plan.taxels()]; 4];
    press(plan, &mut packets[..3]);
    let line = |packet: &Vec<u32>| {
        let values: Vec<String> = packet.iter().map(|&word| f32::from_bits(word).to_string()).collect();
        values.join(",")
    };
    let text: Vec<String> = packets.iter().map(line).collect();
    fs::write(desk.path().join("frames.csv"), text.join("\n")).expect("written");
    let made = bash(desk.path(), MAKE);
    assert!(made.status.success(), "{}", said(&made));
    let answers = model_answers(plan, &packets);
    let known = forces::columns(CONTACTS, 0);
    let names: Vec<&str> = known.iter().map(|name| name.split(' ').next().expect("a name")).collect();
    let names = names[12..=12 + 9 * CONTACTS].join(",");
    for program in ["drivers/c/examples/build/forces_simulated", "python3 -B drivers/python/forces.py"] {
        let ran = bash(desk.path(), &format!("{program} {} frames.csv", subject.built.library.display()));
        let printed = said(&ran);
        let mut lines = printed.lines();
        assert_eq!(lines.next(), Some(&*format!("frame,F_x,F_y,F_z,mu,phi,status,{names}")), "{program}");
        let mut bodies = Vec::new();
        for (line, words) in lines.zip(&answers) {
            let values: Vec<&str> = line.split(',').skip(7).collect();
            assert_eq!(values.len(), 1 + 9 * CONTACTS, "{program}: {line}");
            bodies.push(values[0].to_owned());
            for (values, record) in values[1..].chunks(9).zip(words[FIRST..].chunks(EACH)) {
                let number = |index: usize| values[index].parse::<f32>().expect("a number");
                assert_eq!(values[..2], [record[0] & 0xFFFF, record[0] >> 16].map(|part| part.to_string()));
                let found: Vec<u32> = (2..9).map(|index| number(index).to_bits()).collect();
                assert_eq!(found, record[1..], "{program}: {line}");
            }
        }
        assert_eq!(bodies, ["1", "2", "4", "0"], "{program}: {printed}");
    }
}
