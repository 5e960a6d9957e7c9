//! Copies of a design for several bodies that are wrong somewhere: the comparison notices each.

use hdl_gen::plan::Plan;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use testbench::stream::{Mode, Traffic, exchange};
use testbench::trial::{model_answers, rtl_sources, timeout};
use testbench::verilate::Verilate;

use super::{packets, saturating};
use crate::support::{in_parallel, planned, shipped, with_lanes};

/// A module, a text in it, and what takes its place.
type Fault = (&'static str, &'static str, &'static str);

/// What is kept, copied and told of a frame; then of its parts.
const FAULTS: [Fault; 20] = [
    ("contacts", ".part_bank      (is_second)", ".part_bank      (1'b0)"),
    ("contacts", ".header_before (with_bodies && !is_second)", ".header_before (1'b0)"),
    ("contacts", "is_contact && (kept == 4'd0)", "1'b0"),
    ("contacts_turns", "with_bodies && (answered != 4'd0)", "with_bodies"),
    ("contacts_turns", "TO_UNIT = 10'sd149", "TO_UNIT = 10'sd150"),
    ("contacts_intake", "last_place <= lasts[oldest];", "last_place <= MOST - 1'b1;"),
    ("contacts_answers", "word[31] && (word[30:0] > presses)", "(word[30:0] > presses)"),
    ("contacts_answers", "is_field && (word[30:23] > most)", "(word[30:23] > most)"),
    ("contacts_output", "{of_bank, advance ? word : word_1}", "{of_bank, word}"),
    ("contacts_output", "(component_1 == 2'd1) ? forces[53:27] :", "(component_1 == 2'd1) ? forces[26:0] :"),
    ("contacts_bodies", "negative ? magnitude : 26'd0", "magnitude"),
    ("parting", "from_below_2 ? row_2 - target_2 : target_2 - row_2", "target_2 - row_2"),
    ("parting", "(leaving_body + 4'd1 == kept) ? 4'd0 : leaving_body + 4'd1", "leaving_body + 4'd1"),
    ("parting_lane", "from_right_2 ? -$signed(coefficients_2[17:0]) :", "1'b0 ? 18'sd0 :"),
    ("parting_lane", "from_right ? apart[COLUMN_WIDTH-1:0] : HERE - from_column", "HERE - from_column"),
    ("parted_frames", "(are_own[5] != are_body[5])", "are_body[5]"),
    ("parted_frames", "are_own[5] ? ~wide_5 : wide_5", "wide_5"),
    ("parted_frames", "!firsts[5] ? sum_6", "1'b1 ? sum_6"),
    ("forces", "valid[3] ? {bank, taxel_3} : read_address", "valid[4] ? {bank, taxel_4} : read_address"),
    ("align", "fine_2 <= right_1[2:0];", "fine_2 <= 3'd0;"),
];

/// What of numbers that do not fit.
const FAULTS_OF_LARGE: [Fault; 4] = [
    ("forces", "clipped_5 || above_5 || below_5", "1'b0"),
    ("forces", "(sum_5 > LARGEST)", "1'b0"),
    ("align", "| {BITS{clipped_2}}", ""),
    ("contacts", "(several && saturated)", "1'b0"),
];

/// Whether all answers of a design, with a fault or without, are the model's, whether the streams wait or not.
fn is_right(plan: &Plan, packets: &[Vec<u32>], fault: Option<&Fault>) -> bool {
    let mut sources = rtl_sources(plan).expect("emitted");
    if let Some((module, from, to)) = fault {
        let file = format!("rtl/sptfra_{module}.v");
        let text = String::from_utf8(sources.files[&file].clone()).expect("UTF-8");
        assert_eq!(text.matches(from).count(), 1, "{file}: {from:?} stands there once");
        sources.files.insert(file, text.replace(from, to).into());
    }
    let built = Verilate::default().build(&sources).expect("Verilator accepts it");
    let expected = model_answers(plan, packets);
    let [free, .., both] = Mode::all(5);
    [free, both].iter().all(|mode| {
        let traffic = Traffic::new(packets, 8 * timeout(plan)).with_mode(mode);
        let outcome = exchange(&mut built.load(1).expect("loaded"), &traffic, |_| ());
        outcome.is_ok_and(|outcome| outcome.exchanges.iter().map(|exchange| &exchange.words).eq(&expected))
    })
}

#[test]
fn faults_are_noticed() {
    let plan = planned(&with_lanes(shipped("small-bodies"), 4));
    let packets = packets(&plan, &mut ChaCha8Rng::seed_from_u64(11));
    let (large, large_packets) = saturating();
    let large = planned(&large);
    let of_any = std::iter::once(None).chain(FAULTS.iter().map(Some)).map(|fault| (&plan, &packets, fault));
    let of_large = FAULTS_OF_LARGE.iter().map(|fault| (&large, &large_packets, Some(fault)));
    let copies: Vec<_> = of_any.chain(of_large).collect();
    let right = in_parallel(&copies, |&(plan, packets, fault)| is_right(plan, packets, fault));
    let wrong: Vec<_> =
        copies.iter().map(|(.., fault)| fault).zip(right).filter(|(fault, right)| fault.is_none() != *right).collect();
    assert!(wrong.is_empty(), "{wrong:?}");
}
