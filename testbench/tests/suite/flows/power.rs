//! Activity from simulation to an estimate of power, in the stub.

use std::fs;

use golden::progress::Progress;
use testbench::frame_set::FrameSet;
use testbench::run::{self, Options};

use super::folder::{Folder, NAME, Ran};
use crate::support::shipped;

const POWER: &str = "vivado/power.tcl";

/// What Verilator writes, of a core with one bit of its own: 1000 cycles of 8 ns.
const ACTIVITY: &str = "(SAIFILE
(SAIFVERSION \"2.0\")
(TIMESCALE 1ps)
(DURATION 8000000)
 (INSTANCE top
  (NET
   (aclk (T0 4000000) (T1 4000000) (TZ 0) (TX 0) (TB 0) (TC 2000))
  )
  (INSTANCE small_4x3
   (NET
    (reset (T0 7992000) (T1 8000) (TZ 0) (TX 0) (TB 0) (TC 1))
    (context_take (T0 7984000) (T1 16000) (TZ 0) (TX 0) (TB 0) (TC 4))
   )
  )
 )
)
";

/// The generated folder with a checkpoint of it in the working directory, and this activity.
fn routed(activity: &str) -> Folder {
    let folder = Folder::small();
    let reports = folder.work().join(format!("{NAME}_synth"));
    fs::create_dir(&reports).expect("can be made");
    fs::write(reports.join(format!("{NAME}.dcp")), "").expect("can be written");
    fs::write(folder.work().join(format!("{NAME}.saif")), activity).expect("can be written");
    folder
}

fn estimated(activity: &str) -> Ran {
    routed(activity).vivado(POWER, &[], &[])
}

#[test]
fn simulated_activity_becomes_watts_and_energy() {
    let design = shipped("small");
    let mut frames = FrameSet::standing(&design.sensor).expect("frames");
    frames.stress.truncate(3);
    frames.truth = None;
    let folder = routed("");
    let file = folder.work().join(format!("{NAME}.saif"));
    let options = Options { trace: Some(&file), ..Options::default() };
    let report = run::run(&design, &frames, &options, &Progress::hidden()).expect("runs");
    assert!(report.faults.is_empty() && report.traces == [file]);
    let ran = folder.vivado(POWER, &[], &[]).succeeded();
    let line = ran.last_line();
    let figures = "W, dynamic 0.084 W, static 0.597 W, ";
    let stated = line.strip_prefix("small_4x3 at 125.0 MHz, 3 frames, one in ").expect("three frames");
    assert!(
        stated.contains(&format!(" us: 0.681 {figures}")) && stated.contains(" uJ a frame; nets matched 56%"),
        "{line}"
    );
    // Three frames back to back take two intervals and a latency, and a little before and behind.
    let number = |text: &str| text.rsplit(' ').next().and_then(|word| word.parse::<f64>().ok()).expect("a number");
    let microseconds = number(stated.split(" us: ").next().expect("a time"));
    let microjoules = number(stated.split(" uJ").next().expect("an energy"));
    let cycles = (2 * report.interval_cycles + report.latency_cycles) as f64;
    let simulated = 3.0 * 125.0 * microseconds;
    assert!(simulated > cycles && simulated < cycles + 300.0, "{simulated} cycles, {cycles} of frames");
    assert!((microjoules - 0.084 * microseconds).abs() < 1e-3, "{line}");
    assert!(ran.call("read_saif").contains("-strip_path top/small_4x3"));
    // Thousands of nets below the core, not only its ports.
    let nets: u32 = line.split(['(', '/']).nth(1).and_then(|count| count.parse().ok()).expect("a count");
    assert!(nets > 5_000, "{line}");
}

#[test]
fn activity_of_another_design_or_clock_is_refused() {
    estimated(ACTIVITY).succeeded();
    estimated(&ACTIVITY.replace("small_4x3", "other")).refused("has no instance small_4x3: it is of another design");
    estimated(&ACTIVITY.replace("1ps", "1 fs")).refused("has 125000.00 MHz, the design's has 125.0");
    estimated(&ACTIVITY.replace("2000))", "1900))")).refused("has 118.75 MHz");
    estimated(&ACTIVITY.replace("aclk", "clk")).refused("no changes of aclk");
    estimated(&ACTIVITY.replace("(TC 4)", "(TC 0)")).refused("no frame that was answered");
    let outside = ACTIVITY.replace("  (INSTANCE small_4x3\n", "  (INSTANCE small_4x3\n  )\n  (INSTANCE other\n");
    estimated(&outside).refused("the power would be a guess");
}

#[test]
fn what_is_missing_is_named_with_what_makes_it() {
    let folder = routed(ACTIVITY);
    folder.vivado(POWER, &["other.saif"], &[]).refused("sptfra run DESIGN.toml --saif makes it");
    fs::remove_dir_all(folder.work().join(format!("{NAME}_synth"))).expect("can be removed");
    folder.vivado(POWER, &[], &[]).refused("run synth.tcl in this folder first");
}

#[test]
fn broken_copies_are_refused() {
    for (right, wrong, message) in [
        ("open_checkpoint $checkpoint", "", "open_checkpoint is to come first"),
        ("open_checkpoint $checkpoint", "open_checkpoint $activity", "expected a file that ends in .dcp"),
        ("-strip_path $outer/$design", "-strip_path $design", "nets matched: 0%"),
        ("-strip_path $outer/$design", "-strip $outer/$design", "unknown flag -strip"),
        ("read_saif -strip_path", "list", "nets matched: NA"),
        ("-hier all", "-hier everything", "hierarchy is everything"),
        ("Total On-Chip Power (W)", "Total Power (W)", "no row named Total Power (W)"),
    ] {
        let folder = routed(ACTIVITY);
        let text = folder.read(POWER);
        assert_eq!(text.matches(right).count(), 1, "{POWER} has {right:?} once");
        fs::write(folder.design().join(POWER), text.replace(right, wrong)).expect("can be written");
        folder.vivado(POWER, &[], &[]).refused(message);
    }
}
