//! The stub core `packet_sum` and what it must answer.

use std::collections::BTreeMap;

use testbench::verilate::{RtlSources, Trace, Verilate};

pub const ADDENDS: [u32; 4] = [0x100, 0x2000, 0x0003_0000, 0x4000_0000];

/// Cycles from the last word in to the first word out, the stub's default.
pub const DELAY: u64 = 5;

const SOURCE: &str = include_str!("packet_sum.v");

/// The stub with the numbered fault; 0 is none.
pub fn packet_sum(fault: u32) -> RtlSources {
    let text = SOURCE.replace("parameter FAULT = 0", &format!("parameter FAULT = {fault}"));
    let rom: Vec<String> = ADDENDS.iter().map(|word| format!("{word:08x}\n")).collect();
    let files = BTreeMap::from([
        ("rtl/packet_sum.v".to_owned(), text.into_bytes()),
        ("rom/addend.mem".to_owned(), rom.concat().into_bytes()),
    ]);
    RtlSources { top: "packet_sum".to_owned(), files }
}

/// What the stub answers to `packet` after `counter` others.
pub fn answer(counter: u32, packet: &[u32]) -> Vec<u32> {
    let length = packet.len() as u32;
    let sum = packet.iter().fold(0u32, |sum, word| sum.wrapping_add(*word));
    vec![counter, length, sum, ADDENDS[packet.len() % 4]]
}

/// The stub, loaded. Built in the shared cache: after the first run nothing is compiled.
pub fn load(fault: u32) -> testbench::dut::Dut {
    Verilate::default().build(&packet_sum(fault)).expect("builds").load(1).expect("loads")
}

/// Words that differ in every bit position, packets of different lengths.
pub fn packets(count: u32) -> Vec<Vec<u32>> {
    (0..count).map(|k| (0..=k % 7).map(|i| (k * 977 + i + 1).wrapping_mul(0x9E37_79B9)).collect()).collect()
}

/// A trace format that every machine can build.
pub const PLAIN_TRACE: Trace = Trace::Vcd;
