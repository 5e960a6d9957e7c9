//! What came out of a batch against what went in.

use std::ops::Range;

use hdl_gen::model::{DROPPED, Model};
use hdl_gen::plan::Plan;

use super::log::{Banks, Log};
use super::{Kind, Report};
use testbench::stream::{Exchange, Outcome};

/// Between two resets the core is a new one, and answers the packets in turn; those that were on their way when a reset
/// came have no answer. A core that drops frames may leave out those that it had no room for, and says so in the next
/// answer. With a calibration in RAM each answer states the version of a bank of the log, and is that bank's.
///
/// # Errors
/// The first packet that is wrong, and how.
pub fn judge(
    plan: &Plan,
    kinds: &[Kind],
    packets: &[Vec<u32>],
    outcome: &Outcome,
    log: Option<&Log>,
) -> Result<Report, String> {
    let mut report = Report { cycles: outcome.cycles, resets: outcome.resumed.len() as u64, ..Report::default() };
    report.calibration = log.map(|log| log.commits);
    let mut model = Model::new(plan);
    let mut banks = log.map(|log| Banks::new(plan, log, packets, outcome));
    for (resets, (mut sent, exchanges)) in (0..).zip(outcome.between_resets(packets.len())) {
        model.reset();
        for exchange in exchanges {
            let dropped = drop_before(exchange.packet, &mut sent, exchanges, outcome)?;
            for &packet in &dropped {
                report.dropped.add(kinds[packet]);
            }
            let next = sent.start;
            if exchange.packet != next {
                return Err(format!("packet {} was answered where packet {next} should have been", exchange.packet));
            }
            banks.as_mut().map_or(Ok(()), |banks| banks.follow(exchange, &mut model))?;
            check(plan, exchange, kinds, packets, &mut model, !dropped.is_empty())?;
            report.answered.add(kinds[next]);
            sent.next();
        }
        let to_the_end = resets == outcome.resumed.len();
        if to_the_end {
            for packet in drop_before(packets.len(), &mut sent, exchanges, outcome)? {
                report.dropped.add(kinds[packet]);
            }
        }
        if to_the_end && !sent.is_empty() {
            return Err(format!("packet {} has no answer", sent.start));
        }
        sent.for_each(|lost| report.lost_to_resets.add(kinds[lost]));
    }
    if let Some(counted) = log.and_then(|log| log.dropped) {
        let resumed = outcome.resumed.last().copied().unwrap_or(0);
        let dropped = outcome.dropped.iter().filter(|&&(packet, _)| packet >= resumed).count();
        if counted as usize != dropped {
            return Err(format!("FRAMES_DROPPED says {counted} since the last reset, where {dropped} have no answer"));
        }
    }
    for &kind in kinds {
        report.sent.add(kind);
    }
    Ok(report)
}

/// Takes the packets before this one that were dropped from those that were sent, up to one that was not.
///
/// # Errors
/// One was dropped though the ingress FIFO, two frames deep, had room: fewer than two that began before it had no answer
/// yet.
fn drop_before(
    packet: usize,
    sent: &mut Range<usize>,
    exchanges: &[Exchange],
    outcome: &Outcome,
) -> Result<Vec<usize>, String> {
    let mut dropped = Vec::new();
    while sent.start < packet {
        let Some(&(lost, first_in)) = outcome.dropped.iter().find(|&&(lost, _)| lost == sent.start) else { break };
        let inside = exchanges.iter().filter(|other| other.first_in < first_in && other.last_out >= first_in).count();
        if inside < 2 {
            return Err(format!("packet {lost} was dropped with {inside} inside"));
        }
        dropped.push(lost);
        sent.next();
    }
    Ok(dropped)
}

fn check(
    plan: &Plan,
    exchange: &Exchange,
    kinds: &[Kind],
    packets: &[Vec<u32>],
    model: &mut Model<'_>,
    after_dropped: bool,
) -> Result<(), String> {
    let (packet, kind) = (exchange.packet, kinds[exchange.packet]);
    let mut expected = model.process(&packets[packet]);
    if after_dropped {
        expected[0] |= DROPPED;
    }
    // The flag is known from how the packet was made, whatever the model thinks of it.
    let bad = Kind::ALL.map(Kind::status).into_iter().fold(0, |bits, bit| bits | bit);
    let flags = expected[0] & bad;
    // A bank may replace the very taxel that is no number.
    let may_be_replaced = kind == Kind::NotFinite && plan.design.input.room > 0;
    if (kind == Kind::Good && flags != 0) || flags & kind.status() != kind.status() && !may_be_replaced {
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

    const DESIGN: &str = "format = 3\nbase = \"../golden/tests/plain.toml\"\n\
         name = \"tiny\"\n[sensor]\ncolumns = 2\nrows = 2\npitch_mm = [4.0, 4.0]\ndepth_mm = 3.0\n";

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
        (kinds, packets, Outcome { exchanges, resumed: vec![12], cycles: 5000, ..Outcome::default() })
    }

    fn judged(change: impl Fn(&mut Vec<Exchange>)) -> Result<Report, String> {
        let plan = Plan::new(&Design::from_toml(DESIGN, "tiny.toml").unwrap()).unwrap();
        let (kinds, packets, mut outcome) = right(&plan);
        change(&mut outcome.exchanges);
        judge(&plan, &kinds, &packets, &outcome, None)
    }

    #[test]
    fn what_is_right_is_counted() {
        let report = judged(|_| ()).unwrap();
        assert_eq!((report.sent.total(), report.answered.total(), report.lost_to_resets.total()), (40, 38, 2));
        assert_eq!((report.resets, report.sent), (1, report.answered.plus(report.lost_to_resets)));
    }

    /// A packet without an answer in the middle of the traffic, while so many others have none yet.
    fn with_one_dropped(inside: u64) -> Result<Report, String> {
        let plan = Plan::new(&Design::from_toml(DESIGN, "tiny.toml").unwrap()).unwrap();
        let (kinds, packets, mut outcome) = right(&plan);
        outcome.exchanges.remove(20);
        let mut model = Model::new(&plan);
        for exchange in &mut outcome.exchanges[10..] {
            exchange.words = model.process(&packets[exchange.packet]);
            exchange.last_out += inside * 100;
        }
        outcome.exchanges[20].words[0] |= DROPPED;
        outcome.dropped = vec![(22, 2200)];
        judge(&plan, &kinds, &packets, &outcome, None)
    }

    #[test]
    fn a_packet_is_dropped_for_want_of_room_only() {
        let report = with_one_dropped(2).unwrap();
        assert_eq!((report.answered.total(), report.dropped.total(), report.lost_to_resets.total()), (37, 1, 2));
        assert!(with_one_dropped(1).unwrap_err().contains("dropped with 1 inside"));
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
