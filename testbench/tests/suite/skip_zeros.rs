//! Designs that pass over the zeros of |w| and y+: the same words in fewer cycles, never in more than predicted.

use golden::design::Design;
use hdl_gen::plan::Plan;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use testbench::compare::Comparison;
use testbench::stream::{Exchange, Mode, Pacing, Traffic, exchange};
use testbench::trial::{model_answers, timeout};

use crate::support::effort::half_of;
use crate::support::{built, frames, in_parallel, planned};

/// Name, columns, rows, pitch in y, lanes, outputs, what is optimised.
type Shape = (&'static str, usize, usize, f64, usize, &'static str, &'static str);

/// A rectangle, a square whose matrices are mirrored, odd sides, few quads for many lanes, a single one.
const SHAPES: [Shape; 5] = [
    ("skip_rectangle", 10, 10, 2.0, 16, "field", "interval"),
    ("skip_odd", 7, 5, 3.0, 8, "resultants", "interval"),
    ("skip_square", 8, 8, 4.0, 12, "field", "latency"),
    ("skip_few_quads", 3, 4, 3.0, 64, "field", "latency"),
    ("skip_one_quad", 2, 2, 4.0, 4, "field", "interval"),
];

fn plan(&(name, columns, rows, pitch, lanes, outputs, optimise): &Shape, skips: bool) -> Plan {
    let text = format!(
        "name = \"{name}\"\n[sensor]\ncolumns = {columns}\nrows = {rows}\npitch_mm = [4.0, {pitch:?}]\ndepth_mm = 3.0\n\
         [algorithm]\nplan = \"reduced\"\noutputs = \"{outputs}\"\n\
         [hardware]\nlanes = {lanes}\nskip_zeros = {skips}\noptimise = \"{optimise}\"\n"
    );
    planned(&Design::from_toml(&text, name).unwrap_or_else(|error| panic!("{error}\n{text}")))
}

/// A frame in which every quad has taxels that press and taxels that pull, so that there is no zero to pass over.
fn checkered(plan: &Plan) -> Vec<u32> {
    let columns = plan.design.sensor.columns;
    let full_scale = plan.design.hardware.full_scale_pa;
    let sign = |taxel: usize| if (taxel % columns + taxel / columns).is_multiple_of(2) { -1.0 } else { 0.97 };
    (0..plan.taxels()).map(|taxel| ((sign(taxel) * full_scale) as f32).to_bits()).collect()
}

fn packets(plan: &Plan) -> Vec<Vec<u32>> {
    let mut random = ChaCha8Rng::seed_from_u64(11);
    let mut packets = frames::extremes(plan, &mut random);
    packets.extend((0..4).map(|_| frames::contact(plan, &mut random)));
    packets.extend((0..4).map(|_| frames::noise(plan, 1.0, &mut random)));
    packets.push(vec![0; plan.taxels()]);
    packets.push(checkered(plan));
    packets
}

#[test]
fn zeros_cost_time_only_where_there_are_none() {
    let failures: Vec<String> = in_parallel(&half_of(SHAPES), |shape| {
        let (name, columns, ..) = *shape;
        let plan = plan(shape, true);
        let (packets, built) = (packets(&plan), built(&plan));
        let expected = model_answers(&plan, &packets);
        let worst = (plan.timeline.latency_cycles, plan.timeline.interval_cycles);
        let mut wrong = Vec::new();
        for mode in Mode::all(5) {
            for pacing in [Pacing::OneAtATime, Pacing::BackToBack] {
                let traffic = Traffic::new(&packets, timeout(&plan)).with_mode(&mode).with_pacing(pacing);
                let outcome = exchange(&mut built.load(1).expect("loads"), &traffic, |_| ()).expect(mode.name);
                let words = outcome.exchanges.iter().map(|exchange| exchange.words.as_slice());
                let comparison = Comparison::new(&expected, words, columns);
                if let Some(first) = comparison.first.first() {
                    wrong.push(format!("{name}, {}: {first}", mode.name));
                }
                if mode.is_free() && pacing == Pacing::BackToBack {
                    let ends: Vec<u64> = outcome.exchanges.iter().map(|exchange| exchange.last_out).collect();
                    let longest = ends.windows(2).map(|pair| pair[1] - pair[0]).max();
                    if longest.is_none_or(|longest| longest > worst.1) {
                        wrong.push(format!("{name}: {longest:?} cycles between frames, predicted {worst:?}"));
                    }
                }
                if mode.is_free() && pacing == Pacing::OneAtATime {
                    let latencies: Vec<u64> = outcome.exchanges.iter().map(Exchange::latency).collect();
                    let (longest, shortest) = (latencies.iter().max(), latencies.iter().min());
                    // Zeros save cycles where a round is longer than the lanes are many.
                    let saves = plan.elements() > plan.walkers();
                    if longest > Some(&worst.0) || (saves && shortest >= Some(&worst.0)) {
                        wrong.push(format!("{name}: latencies {latencies:?}, predicted {worst:?}"));
                    }
                }
            }
        }
        wrong.join("\n")
    });
    let failures: Vec<String> = failures.into_iter().filter(|failure| !failure.is_empty()).collect();
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

#[test]
fn a_frame_without_zeros_takes_exactly_the_predicted_cycles() {
    let plan = plan(&SHAPES[0], true);
    let packets = vec![checkered(&plan); 3];
    let traffic = Traffic::new(&packets, timeout(&plan)).with_pacing(Pacing::OneAtATime);
    let outcome = exchange(&mut built(&plan).load(1).expect("loads"), &traffic, |_| ()).expect("answers");
    assert_eq!(outcome.latency(), Some(plan.timeline.latency_cycles));
}

/// The hardware that passes over nothing gives, frame by frame, the words that the other one's model gives.
#[test]
fn passing_over_zeros_changes_no_word() {
    for shape in half_of(SHAPES.into_iter().take(3)) {
        let (name, columns, ..) = shape;
        let [with, without] = [true, false].map(|skips| plan(&shape, skips));
        assert!(with.schedule.value_depth() > with.schedule.word_depth(), "{name}: dense rows are in the ROM");
        assert_eq!(without.schedule.value_depth(), without.schedule.word_depth(), "{name}: no dense rows");
        let packets = packets(&with);
        let traffic = Traffic::new(&packets, timeout(&without)).with_pacing(Pacing::BackToBack);
        let outcome = exchange(&mut built(&without).load(1).expect("loads"), &traffic, |_| ()).expect("answers");
        let words = outcome.exchanges.iter().map(|exchange| exchange.words.as_slice());
        let comparison = Comparison::new(&model_answers(&with, &packets), words, columns);
        assert!(comparison.first.is_empty(), "{name}: {}", comparison.first[0]);
    }
}
