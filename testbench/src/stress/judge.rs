//! What came out of a batch against what went in.

use hdl_gen::model::Model;
use hdl_gen::plan::Plan;

use super::{Kind, Report};
use crate::stream::{Exchange, INITIAL_RESET, Outcome, Reset};

/// Packets that a reset can cost at most: one being sent, one being put out, and those between. In the reduced plan
/// two in Bz' banks, two searches, one in the summary; frames so short that several fit into the output's stages.
const MOST_INSIDE: usize = 8;

/// Between two resets the core is a new one; only packets that were on their way when one came have no answer.
///
/// # Errors
/// The first packet that is wrong, and how.
pub fn judge(
    plan: &Plan,
    kinds: &[Kind],
    packets: &[Vec<u32>],
    resets: &[Reset],
    outcome: &Outcome,
) -> Result<Report, String> {
    let mut report = Report { cycles: outcome.cycles, ..Report::default() };
    let mut exchanges = outcome.exchanges.iter().peekable();
    let (mut next, mut may_be_lost) = (0, 0);
    for end in begins(resets).into_iter().take_while(|&begin| begin < outcome.cycles).chain([u64::MAX]) {
        let mut model = Model::new(plan);
        while let Some(exchange) = exchanges.next_if(|exchange| exchange.last_out < end) {
            if !(next..=next + may_be_lost).contains(&exchange.packet) {
                return Err(format!("packet {} was answered where packet {next} should have been", exchange.packet));
            }
            (next..exchange.packet).for_each(|lost| report.lost_to_resets.add(kinds[lost]));
            check(exchange, kinds, packets, &mut model)?;
            report.answered.add(kinds[exchange.packet]);
            (next, may_be_lost) = (exchange.packet + 1, 0);
        }
        if end != u64::MAX {
            may_be_lost += MOST_INSIDE;
            report.resets += 1;
        }
    }
    if next + may_be_lost < packets.len() {
        return Err(format!("packet {next} has no answer"));
    }
    (next..packets.len()).for_each(|lost| report.lost_to_resets.add(kinds[lost]));
    for &kind in kinds {
        report.sent.add(kind);
    }
    Ok(report)
}

/// The cycles in which the resets begin: one that is due while another lasts follows it.
fn begins(resets: &[Reset]) -> Vec<u64> {
    let mut free = 0;
    let begin = |reset: &Reset| {
        let begin = free.max(INITIAL_RESET + reset.cycle);
        free = begin + reset.length.max(1);
        begin
    };
    resets.iter().map(begin).collect()
}

fn check(exchange: &Exchange, kinds: &[Kind], packets: &[Vec<u32>], model: &mut Model<'_>) -> Result<(), String> {
    let (packet, kind) = (exchange.packet, kinds[exchange.packet]);
    let expected = model.process(&packets[packet]);
    // The flag is known from how the packet was made, whatever the model thinks of it.
    let bad = Kind::ALL.map(Kind::status).into_iter().fold(0, |bits, bit| bits | bit);
    let flags = expected[0] & bad;
    if (kind == Kind::Good && flags != 0) || flags & kind.status() != kind.status() {
        return Err(format!("packet {packet} ({kind:?}): the model's status is {:#x}", expected[0]));
    }
    match expected.iter().zip(&exchange.words).position(|(expected, got)| expected != got) {
        Some(beat) => Err(format!(
            "packet {packet} ({kind:?}), beat {beat}: expected {:#010x}, got {:#010x}",
            expected[beat], exchange.words[beat]
        )),
        None if expected.len() != exchange.words.len() => {
            Err(format!("packet {packet}: {} beats for {}", exchange.words.len(), expected.len()))
        }
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use golden::design::Design;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    use super::*;
    use crate::stress::packets::packet;

    const DESIGN: &str = "name = \"tiny\"\n[sensor]\ncolumns = 2\nrows = 2\npitch_mm = [4.0, 4.0]\ndepth_mm = 3.0\n";

    /// Packets, and the traffic of a core that is right, with a reset that costs two of them.
    fn right(plan: &Plan) -> (Vec<Kind>, Vec<Vec<u32>>, Vec<Reset>, Outcome) {
        let mut random = ChaCha8Rng::seed_from_u64(3);
        let (kinds, packets): (Vec<Kind>, Vec<Vec<u32>>) = (0..40).map(|_| packet(plan, &mut random)).unzip();
        let resets = vec![Reset { cycle: 1050, length: 2 }];
        let mut exchanges = Vec::new();
        for range in [0..10, 12..40] {
            let mut model = Model::new(plan);
            for packet in range {
                let (first_in, last_out) = (packet as u64 * 100, packet as u64 * 100 + 99);
                exchanges.push(Exchange { packet, first_in, last_out, words: model.process(&packets[packet]) });
            }
        }
        (kinds, packets, resets, Outcome { exchanges, cycles: 5000 })
    }

    fn judged(change: impl Fn(&mut Vec<Exchange>)) -> Result<Report, String> {
        let plan = Plan::new(&Design::from_toml(DESIGN, "tiny.toml").unwrap()).unwrap();
        let (kinds, packets, resets, mut outcome) = right(&plan);
        change(&mut outcome.exchanges);
        judge(&plan, &kinds, &packets, &resets, &outcome)
    }

    #[test]
    fn what_is_right_is_counted() {
        let report = judged(|_| ()).unwrap();
        assert_eq!((report.sent.total(), report.answered.total(), report.lost_to_resets.total()), (40, 38, 2));
        assert_eq!((report.resets, report.sent), (1, report.answered.plus(report.lost_to_resets)));
    }

    #[test]
    fn what_is_lost_doubled_out_of_order_or_wrong_is_found() {
        type Fault = fn(&mut Vec<Exchange>);
        let faults: [(&str, Fault); 7] = [
            ("should have been", |answers| drop(answers.remove(5))),
            ("should have been", |answers| answers.insert(5, answers[4].clone())),
            ("should have been", |answers| answers.swap(4, 5)),
            ("expected", |answers| answers[7].words[0] ^= 1 << 5),
            ("expected", |answers| answers[7].words[19] ^= 1),
            ("beats", |answers| answers[7].words.truncate(19)),
            ("no answer", |answers| answers.truncate(20)),
        ];
        for (reason, fault) in faults {
            let error = judged(fault).unwrap_err();
            assert!(error.contains(reason), "{error}");
        }
    }
}
