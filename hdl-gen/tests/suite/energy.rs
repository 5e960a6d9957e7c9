//! The estimate of a frame's energy: what it counts.

use hdl_gen::plan::Plan;
use hdl_gen::plan::energy::Energy;
use hdl_gen::plan::savings::savings;

use crate::support::designs::design;
use crate::support::plan;

fn shipped(name: &str) -> Plan {
    Plan::new(&design(name)).expect("a plan")
}

/// By hand: what a multiplier and a memory do in an interval, at what they take.
#[test]
fn products_and_accesses_are_counted() {
    let plan = shipped("sensor1-reduced");
    let energy = Energy::of(&plan);
    assert_eq!(energy.lane_products, savings(&plan).last().expect("steps").macs as u64);
    let lanes = plan.design.hardware.lanes;
    let cycles = plan.timeline.interval_cycles;
    assert_eq!(energy.other_products, (plan.resources.dsp - lanes) as u64 * cycles);
    let bits: u64 = plan.resources.memories.iter().map(|memory| memory.count as u64 * u64::from(memory.width)).sum();
    assert_eq!(energy.memory_bits, bits * cycles);
    // 18 x 27 bits of 32 x 32, and a sum of 48.
    let product = 3.1 * (18.0 * 27.0) / 1024.0 + 0.1 * 48.0 / 32.0;
    let picojoules =
        product * (energy.lane_products + energy.other_products) as f64 + 10.0 / 64.0 * energy.memory_bits as f64;
    assert!((energy.chip_nj - picojoules / 1e3).abs() < 0.06, "{energy:?}");
    assert!((energy.fabric_nj - 14.0 * picojoules / 1e3).abs() < 0.06, "{energy:?}");
    assert!((energy.watts(1e6) - energy.fabric_nj / 1e3).abs() < 1e-12);
}

/// Fewer bits, fewer products and no field take less.
#[test]
fn less_work_takes_less() {
    let of = |algorithm: &str, hardware: &str| {
        let text = format!(
            "format = 3\nbase = \"../golden/tests/plain.toml\"\n\
             name = \"d\"\n[sensor]\ncolumns = 4\nrows = 4\npitch_mm = [4.0, 4.0]\ndepth_mm = 3.0\n[algorithm]\n{algorithm}\n\
             [hardware]\nlanes = 4\n{hardware}\n"
        );
        Energy::of(&plan(&text)).chip_nj
    };
    let all = of("plan = \"reduced\"", "");
    assert!(of("plan = \"reduced\"", "coefficient_bits = 12") < all);
    assert!(of("plan = \"reduced\"\noutputs = \"resultants\"", "") < all);
    assert!(of("plan = \"paper\"", "") > all);
}
