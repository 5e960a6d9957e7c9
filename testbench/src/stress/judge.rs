//! What came out of a batch against what went in.

use hdl_gen::model::Model;
use hdl_gen::plan::Plan;

use super::{Kind, Report};
use crate::stream::{Exchange, Outcome};

/// Between two resets the core is a new one, and answers the packets in turn; those that were on their way when a reset
/// came have no answer.
///
/// # Errors
/// The first packet that is wrong, and how.
pub fn judge(plan: &Plan, kinds: &[Kind], packets: &[Vec<u32>], outcome: &Outcome) -> Result<Report, String> {
    let mut report = Report { cycles: outcome.cycles, resets: outcome.resumed.len() as u64, ..Report::default() };
    for (mut sent, exchanges) in outcome.between_resets(packets.len()) {
        let mut model = Model::new(plan);
        for exchange in exchanges {
            let next = sent.start;
            if exchange.packet != next {
                return Err(format!("packet {} was answered where packet {next} should have been", exchange.packet));
            }
            check(exchange, kinds, packets, &mut model)?;
            report.answered.add(kinds[next]);
            sent.next();
        }
        if sent.end == packets.len() && !sent.is_empty() {
            return Err(format!("packet {} has no answer", sent.start));
        }
        sent.for_each(|lost| report.lost_to_resets.add(kinds[lost]));
    }
    for &kind in kinds {
        report.sent.add(kind);
    }
    Ok(report)
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
    fn right(plan: &Plan) -> (Vec<Kind>, Vec<Vec<u32>>, Outcome) {
        let mut random = ChaCha8Rng::seed_from_u64(3);
        let (kinds, packets): (Vec<Kind>, Vec<Vec<u32>>) = (0..40).map(|_| packet(plan, &mut random)).unzip();
        let mut exchanges = Vec::new();
        for range in [0..10, 12..40] {
            let mut model = Model::new(plan);
            for packet in range {
                let (first_in, last_out) = (packet as u64 * 100, packet as u64 * 100 + 99);
                exchanges.push(Exchange { packet, first_in, last_out, words: model.process(&packets[packet]) });
            }
        }
        (kinds, packets, Outcome { exchanges, resumed: vec![12], cycles: 5000 })
    }

    fn judged(change: impl Fn(&mut Vec<Exchange>)) -> Result<Report, String> {
        let plan = Plan::new(&Design::from_toml(DESIGN, "tiny.toml").unwrap()).unwrap();
        let (kinds, packets, mut outcome) = right(&plan);
        change(&mut outcome.exchanges);
        judge(&plan, &kinds, &packets, &outcome)
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
