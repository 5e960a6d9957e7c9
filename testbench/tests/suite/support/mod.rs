//! Designs for tests of the emitted RTL: planned, built through the shared cache, simulated, judged.

pub mod banks;
pub mod calibrated;
#[allow(dead_code, reason = "shared with the tests of the other crates")]
#[path = "../../../../golden/tests/suite/designs.rs"]
pub mod designs;
#[path = "../../../../golden/tests/suite/effort.rs"]
pub mod effort;
pub mod faults;
pub mod frames;
pub mod player;
pub mod random;
pub mod resets;

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

pub use designs::design as shipped;
use golden::design::{Correction, Design, Estimator, Outputs, PlanKind, StandardError};
use hdl_gen::plan::Plan;
use testbench::co_simulation::{CoSimulation, rtl_sources};
use testbench::simulate::Simulation;
use testbench::verilate::{Built, Verilate};

/// A file of the workspace.
pub fn workspace(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("a workspace").join(path)
}

/// The rooms of the Verilog library, but for modules that other fabrics take in place of them.
pub fn library_folders() -> Vec<PathBuf> {
    let entries = std::fs::read_dir(workspace("hdl-gen/rtl")).expect("a folder");
    let rooms = entries.map(|entry| entry.expect("readable").path()).filter(|path| !path.ends_with("ecp5"));
    let mut rooms: Vec<PathBuf> = rooms.collect();
    rooms.sort();
    rooms
}

/// The file of a module of the library.
pub fn library_file(module: &str) -> PathBuf {
    let mut files = library_folders().into_iter().map(|folder| folder.join(format!("{module}.v")));
    files.find(|path| path.is_file()).unwrap_or_else(|| panic!("no {module}.v below hdl-gen/rtl"))
}

/// Options by which Verilator and Icarus Verilog look for modules in these folders.
pub fn look_in(folders: impl IntoIterator<Item = PathBuf>) -> Vec<PathBuf> {
    folders.into_iter().flat_map(|folder| ["-y".into(), folder]).collect()
}

/// Icarus Verilog's compiler, which comes from the system.
pub fn icarus() -> Command {
    Command::new("iverilog")
}

/// Its simulator, which runs what the compiler wrote.
pub fn icarus_runtime() -> Command {
    Command::new("vvp")
}

/// The `sptfra` command among the programs of this build; built if it is not there.
pub fn sptfra() -> PathBuf {
    static PROGRAM: OnceLock<PathBuf> = OnceLock::new();
    let build = || {
        let test = std::env::current_exe().expect("this test");
        let folder = test.ancestors().nth(2).expect("a target folder");
        let mut cargo = Command::new(env!("CARGO"));
        cargo.args(["build", "--quiet", "--bins", "--target-dir"]).arg(folder.parent().expect("a target folder"));
        if folder.ends_with("release") {
            cargo.arg("--release");
        }
        assert!(cargo.current_dir(workspace("")).status().expect("cargo starts").success());
        folder.join("sptfra")
    };
    PROGRAM.get_or_init(build).clone()
}

/// The design under another name and with another number of lanes.
pub fn with_lanes(mut design: Design, lanes: usize) -> Design {
    design.name = format!("{}_{lanes}_lanes", design.name);
    design.hardware.lanes = lanes;
    design
}

/// The design under another name and by another plan.
pub fn by_plan(mut design: Design, kind: PlanKind, outputs: Outputs) -> Design {
    let plan = if kind == PlanKind::Paper { "paper" } else { "reduced" };
    let of = if outputs == Outputs::Field { "field" } else { "resultants" };
    design.name = format!("{}_{plan}_{of}", design.name);
    (design.algorithm.plan, design.algorithm.outputs) = (kind, outputs);
    design
}

/// The design by the reduced plan with the grid search, and a correction of a few units that nobody trained.
pub fn with_joint(mut design: Design) -> Design {
    design.algorithm.plan = PlanKind::Reduced;
    design.algorithm.estimator = Estimator::Joint;
    let weights = |length: usize| (0..length as i32).map(|index| 700 * (index * index % 9) - 2000).collect();
    let inputs = Correction::inputs([1, 1]);
    design.algorithm.joint.correction = Some(Correction {
        half_window: [1, 1],
        hidden: vec![weights(inputs), weights(inputs), weights(inputs)],
        output: [weights(3), weights(3)],
    });
    design.algorithm.standard_error = Some(StandardError { model: 0.03, noise: 100.0, border: 1.0 });
    design
}

/// The plan of a design that has one.
pub fn planned(design: &Design) -> Plan {
    Plan::new(design).expect("a plan")
}

/// The plan's RTL, compiled.
pub fn built(plan: &Plan) -> Built {
    Verilate::default().build(&rtl_sources(plan).expect("emitted")).expect("Verilator accepts it")
}

/// Plans nothing and compiles nothing twice: sends `packets` through the RTL in all four stream modes, and judges
/// every word by the model and the cycles by the prediction.
///
/// # Errors
/// What is wrong, with the first words that differ.
pub fn simulate_exactly(plan: &Plan, built: &Built, packets: &[Vec<u32>], seed: u32) -> Result<Simulation, String> {
    let trial = CoSimulation::new(plan, packets.to_vec(), seed);
    let verdict = trial.simulate(built, None, &|| ()).map_err(|error| error.to_string())?;
    let words: u64 = trial.expected.iter().map(|words| words.len() as u64).sum();
    assert!(verdict.simulation.modes.iter().all(|mode| mode.words >= words), "every word is compared");
    verdict.right()
}

/// Runs `work` on every item, on as many threads as there are processors; the results in the items' order.
pub fn in_parallel<T: Sync, R: Send>(items: &[T], work: impl Fn(&T) -> R + Sync) -> Vec<R> {
    let next = AtomicUsize::new(0);
    let worker = || {
        let mut done = Vec::new();
        while let Some((index, item)) =
            Some(next.fetch_add(1, Ordering::Relaxed)).and_then(|index| Some((index, items.get(index)?)))
        {
            done.push((index, work(item)));
        }
        done
    };
    let mut results: Vec<(usize, R)> = thread::scope(|scope| {
        let threads = thread::available_parallelism().map_or(1, usize::from);
        let running: Vec<_> = (0..threads).map(|_| scope.spawn(worker)).collect();
        running
            .into_iter()
            .flat_map(|thread| thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
            .collect()
    });
    results.sort_by_key(|&(index, _)| index);
    results.into_iter().map(|(_, result)| result).collect()
}
