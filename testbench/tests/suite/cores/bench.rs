//! Plays stimulus into the emitted cores and reads back what they did.

use std::error::Error;
use std::fmt::Write as _;
use std::fs;
use std::process::Command;

use hdl_gen::cores::Multiplier;
use hdl_gen::emit::rtl::library;

use crate::support::player::verilator;

/// A port other than the clock: name and bits.
pub type Port = (&'static str, u32);

/// Stimulus and expectation of one core.
pub struct Run {
    pub module: &'static str,
    pub inputs: &'static [Port],
    pub outputs: &'static [Port],
    pub cycles: Vec<Cycle>,
    /// Results whose every bit is expected, as opposed to cycles that only show the core waiting.
    pub results: usize,
}

/// One clock cycle. Ports are packed, the first one at the top.
pub struct Cycle {
    stimulus: u128,
    expected: u128,
    mask: u128,
}

/// A run and the packed outputs of each of its cycles.
pub struct Played {
    pub run: Run,
    pub outputs: Vec<u128>,
}

impl Run {
    pub fn new(module: &'static str, inputs: &'static [Port], outputs: &'static [Port]) -> Self {
        Self { module, inputs, outputs, cycles: Vec::new(), results: 0 }
    }

    /// Appends a cycle: a value for every input, and for every output what it must be, if that matters.
    pub fn push(&mut self, inputs: &[u64], expected: &[Option<u64>]) {
        assert_eq!((inputs.len(), expected.len()), (self.inputs.len(), self.outputs.len()));
        let stimulus = pack(self.inputs, inputs.iter().copied());
        let values = pack(self.outputs, expected.iter().map(|value| value.unwrap_or(0)));
        let mask = pack(self.outputs, expected.iter().map(|value| value.map_or(0, |_| u64::MAX)));
        self.cycles.push(Cycle { stimulus, expected: values, mask });
    }
}

impl Played {
    /// Compares every cycle, and that the run had at least so many results.
    pub fn check(&self, at_least: usize) {
        let run = &self.run;
        assert!(run.results >= at_least, "{}: {} results only", run.module, run.results);
        assert_eq!(self.outputs.len(), run.cycles.len(), "{}: cycles", run.module);
        for (index, (cycle, &found)) in run.cycles.iter().zip(&self.outputs).enumerate() {
            assert!(
                (found ^ cycle.expected) & cycle.mask == 0,
                "{} in cycle {index}: inputs {}, outputs {}, expected {} where the mask {} has ones",
                run.module,
                words(run.inputs, cycle.stimulus),
                words(run.outputs, found),
                words(run.outputs, cycle.expected),
                words(run.outputs, cycle.mask),
            );
        }
    }

    /// The values of one input over the run.
    pub fn input(&self, name: &str) -> Vec<u64> {
        self.run.cycles.iter().map(|cycle| field(self.run.inputs, name, cycle.stimulus)).collect()
    }

    /// The values of one output over the run, as simulated.
    pub fn output(&self, name: &str) -> Vec<u64> {
        self.outputs.iter().map(|&packed| field(self.run.outputs, name, packed)).collect()
    }
}

fn pack(ports: &[Port], values: impl Iterator<Item = u64>) -> u128 {
    ports
        .iter()
        .zip(values)
        .fold(0, |packed, (&(_, bits), value)| (packed << bits) | (u128::from(value) & (u128::MAX >> (128 - bits))))
}

fn total(ports: &[Port]) -> u32 {
    ports.iter().map(|port| port.1).sum()
}

/// The highest and the lowest bit of a port in the packed word.
fn place(ports: &[Port], name: &str) -> (u32, u32) {
    let mut high = total(ports);
    for &(port, bits) in ports {
        if port == name {
            return (high - 1, high - bits);
        }
        high -= bits;
    }
    panic!("no port {name}")
}

fn field(ports: &[Port], name: &str, packed: u128) -> u64 {
    let (high, low) = place(ports, name);
    (packed >> low & (u128::MAX >> (127 + low - high))) as u64
}

fn words(ports: &[Port], packed: u128) -> String {
    let words: Vec<String> = ports.iter().map(|(name, _)| format!("{name}={:x}", field(ports, name, packed))).collect();
    words.join(" ")
}

/// The leaf cores: module and text. Wide ones and those of ECP5 stand under names of their own.
pub fn cores() -> Vec<(String, String)> {
    let of = |multiplier, modules: &[&str], suffix: &str| -> Vec<(String, String)> {
        let library = library(multiplier);
        let renamed = |module: &&str| {
            let (module, name) = (*module, format!("{module}{suffix}"));
            (name.clone(), library[module].replace(&format!("module {module} "), &format!("module {name} ")))
        };
        modules.iter().map(renamed).collect()
    };
    let common = [
        "sptfra_axis_skid",
        "sptfra_row_sequencer",
        "sptfra_ratio",
        "sptfra_cordic",
        "sptfra_float_to_fixed",
        "sptfra_fixed_to_float",
    ];
    let multipliers = ["sptfra_mac", "sptfra_multiply"];
    let mut all = of(Multiplier::Whole, &common, "");
    all.extend(of(Multiplier::Whole, &multipliers, ""));
    let wide = of(Multiplier::Whole, &multipliers, "_wide");
    all.extend(wide.into_iter().map(|(name, text)| (name, text.replace("parameter WIDE = 0", "parameter WIDE = 1"))));
    all.extend(of(Multiplier::Split, &multipliers, "_ecp5"));
    all
}

/// Builds one model of all cores, plays all runs, reads the outputs back.
pub fn play(runs: Vec<Run>) -> Result<Vec<Played>, Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    for (module, text) in cores() {
        fs::write(folder.path().join(format!("{module}.v")), text)?;
    }
    let mut bench = String::from("module bench(input clock);\n");
    for run in &runs {
        bench += &player(run);
        let mut lines = String::new();
        for cycle in &run.cycles {
            writeln!(lines, "{:x}", cycle.stimulus)?;
        }
        fs::write(folder.path().join(format!("{}.in", run.module)), lines)?;
    }
    let longest = runs.iter().map(|run| run.cycles.len()).max().unwrap_or(0);
    fs::write(folder.path().join("bench.v"), bench + "endmodule\n")?;
    verilator(folder.path(), longest + 1).expect("no check of a module fails");
    runs.into_iter()
        .map(|run| {
            let text = fs::read_to_string(folder.path().join(format!("{}.out", run.module)))?;
            let outputs = text.lines().map(|line| u128::from_str_radix(line, 16)).collect::<Result<_, _>>()?;
            Ok(Played { run, outputs })
        })
        .collect()
}

/// Verilog that plays one run: inputs change after a rising edge, outputs are read before the next.
fn player(run: &Run) -> String {
    let (module, count) = (run.module, run.cycles.len());
    let (in_high, out_high) = (total(run.inputs) - 1, total(run.outputs) - 1);
    let mut pins = vec![".clock(clock)".to_owned()];
    for (ports, bundle) in [(run.inputs, "in"), (run.outputs, "out")] {
        pins.extend(ports.iter().map(|(name, _)| {
            let (high, low) = place(ports, name);
            format!(".{name}({bundle}[{high}:{low}])")
        }));
    }
    let pins = pins.join(", ");
    format!(
        "    generate if (1) begin : {module}_player
        reg [{in_high}:0] stimulus [0:{count}];
        reg [{in_high}:0] in;
        wire [{out_high}:0] out;
        integer cycle, file;
        initial begin
            cycle = 0;
            in = 0;
            $readmemh(\"{module}.in\", stimulus, 0, {count} - 1);
            file = $fopen(\"{module}.out\", \"w\");
        end
        {module} core ({pins});
        always @(posedge clock) if (cycle <= {count}) begin
            if (cycle != 0) $fwrite(file, \"%h\\n\", out);
            if (cycle == {count}) $fclose(file);
            in <= stimulus[cycle];
            cycle <= cycle + 1;
        end
    end endgenerate\n"
    )
}

/// Runs a command and fails with what it printed.
pub fn succeed(command: &mut Command) -> Result<String, Box<dyn Error>> {
    let output = command.output()?;
    let printed = format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    if output.status.success() { Ok(printed) } else { Err(format!("{command:?} failed:\n{printed}").into()) }
}
