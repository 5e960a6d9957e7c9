//! Plays commands to `sptfra_records` on a bench of its own.

use std::fmt::Write as _;
use std::fs;

use golden::design::Design;
use hdl_gen::blocks::records::{parameters, words};
use hdl_gen::plan::contacts::records::{INSTRUCTION_BITS, Program};

use crate::support::player::{verilator, write_broken};

/// What is done to the module, in a cycle or until it is done.
#[derive(Clone, Debug)]
pub enum Command {
    /// A word of a header.
    Write { body: u8, before: bool, word: usize, data: u32 },
    /// A frame; with `twice` it starts again in the cycle in which it is done.
    Start { kept: usize, bodies: u8, taxels: Vec<u16>, saturated: bool, twice: bool },
    /// A frame that is given up by a reset after so many cycles.
    GiveUp { kept: usize, after: u32 },
}

impl Command {
    /// Kind, kept, bodies, body, before, word, data (of a start in its lowest bit whether it is saturated), taxels: 4, 4, 8,
    /// 4, 4, 4, 32 and 128 bits.
    fn line(&self) -> String {
        let taxels = |taxels: &[u16]| taxels.iter().rev().fold(0, |all, &of| all << 16 | u128::from(of));
        match self {
            Self::Write { body, before, word, data } => {
                format!("0000{body:x}{}{word:x}{data:08x}{:032x}\n", u8::from(*before), 0)
            }
            Self::Start { kept, bodies, taxels: of, saturated, twice } => {
                let [kind, saturated] = [1 + u8::from(*twice), u8::from(*saturated)];
                format!("{kind}{kept:x}{bodies:02x}0000000000{saturated}{:032x}\n", taxels(of))
            }
            Self::GiveUp { kept, after } => format!("3{kept:x}00000{after:08x}{:032x}\n", 0),
        }
    }

    fn cycles(&self, program: Program, words: usize) -> usize {
        match self {
            Self::Write { .. } => 1,
            Self::Start { kept, twice, .. } => {
                (1 + usize::from(*twice)) * program.cycles(*kept) as usize + 3 * words + 10
            }
            Self::GiveUp { after, .. } => *after as usize + 5,
        }
    }
}

/// A design's module and its commands.
pub struct Case {
    pub name: String,
    pub design: Design,
    pub commands: Vec<Command>,
}

/// What the module has answered to a start.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Played {
    pub cycles: u64,
    pub words: Vec<u32>,
}

/// Plays all cases at once. A fault is a module, a text in it and what takes its place.
///
/// # Errors
/// What a check in the modules or the bench says.
pub fn play(cases: &[Case], fault: Option<&(&str, &str, &str)>) -> Result<Vec<Vec<Played>>, String> {
    let folder = tempfile::tempdir().expect("a folder");
    let place = |name: String| folder.path().join(name);
    let digits = INSTRUCTION_BITS.div_ceil(4) as usize;
    if let Some((module, from, to)) = fault {
        write_broken(folder.path(), &format!("sptfra_{module}"), from, to);
    }
    let mut bench = "module bench(input clock);\n".to_owned();
    let mut longest = 0;
    for Case { name, design, commands } in cases {
        let (contacts, program) = (design.algorithm.contacts, Program::of(design));
        let words = words(contacts);
        longest = longest.max(commands.iter().map(|command| command.cycles(program, words)).sum());
        let lines: String = commands.iter().map(Command::line).collect();
        fs::write(place(format!("{name}.in")), lines).expect("writable");
        let rom: String = program.rom().iter().map(|word| format!("{word:0digits$x}\n")).collect();
        fs::write(place(format!("{name}.mem")), rom).expect("writable");
        let parameters = parameters(design).expression("FILE", format!("\"{name}.mem\""));
        let _ = write!(
            bench,
            "    generate if (1) begin : {name}\n{}    end endgenerate\n",
            BENCH
                .replace("NAME", name)
                .replace("COUNT", &commands.len().to_string())
                .replace("WORDS", &words.to_string())
                .replace("HIGH", &(words - 1).ilog2().to_string())
                .replace("TAXELS", &(16 * contacts).to_string())
                .replace("PARAMETERS", &parameters.verilog())
        );
    }
    fs::write(place("bench.v".to_owned()), bench + "endmodule\n").expect("writable");
    let said = verilator(folder.path(), longest + 20);
    if !said.is_empty() {
        return Err(said);
    }
    cases
        .iter()
        .map(|case| played(&fs::read_to_string(place(format!("{}.out", case.name))).expect("written")))
        .collect()
}

fn played(text: &str) -> Result<Vec<Played>, String> {
    let mut all: Vec<Played> = Vec::new();
    for line in text.lines() {
        let unknown = || format!("{line}, after {} frames", all.len());
        if let Some(cycles) = line.strip_prefix("cycles ") {
            all.push(Played { cycles: cycles.parse().map_err(|_| unknown())?, words: Vec::new() });
        } else {
            let word = u32::from_str_radix(line, 16).map_err(|_| unknown())?;
            all.last_mut().ok_or_else(|| line.to_owned())?.words.push(word);
        }
    }
    Ok(all)
}

/// While a frame is made the words of the one before are read again and again: they must not change.
const BENCH: &str = "
        reg [187:0] commands [0:COUNT-1];
        reg [187:0] now;
        reg reset, in_write, in_before, start_now, again, resets, saturated;
        reg [3:0] in_body, in_word, kept;
        reg [7:0] bodies;
        reg [31:0] in_data;
        reg [127:0] taxels;
        wire done, out_bank;
        reg [HIGH+1:0] out_address, asked;
        wire [31:0] out_word;
        reg [31:0] held [0:WORDS-1];
        integer place, file, phase, count, index, step, has_held, last;
        initial begin
            $readmemh(\"NAME.in\", commands);
            file = $fopen(\"NAME.out\", \"w\");
            place = 0; phase = -3; count = 0; has_held = 0; again = 0; start_now = 0; in_write = 0; reset = 1; out_address = 0;
            asked = 0; resets = 0; index = 0;
        end
        wire start = start_now || (again && done);
        sptfra_records PARAMETERSsubject (
            .clock(clock), .reset(reset), .in_write(in_write), .in_body(in_body), .in_before(in_before), .in_word(in_word),
            .in_data(in_data), .start(start), .kept(kept), .bodies(bodies), .taxels(start ? taxels[TAXELS-1:0] : {TAXELS{1'b1}}),
            .saturated(start ? saturated : !saturated),
            .done(done), .out_bank(out_bank), .out_address(out_address), .out_word(out_word));
        always @(posedge clock) begin
            in_write <= 0;
            start_now <= 0;
            reset <= (phase < -1);
            asked <= out_address;
            if (phase < 0) phase <= phase + 1;
            if (phase == 0 && place <= COUNT) begin
                place <= place + 1;
                if (place == COUNT) $fclose(file);
                else begin
                    now = commands[place];
                    in_write <= (now[187:184] == 0);
                    in_body <= now[171:168];
                    in_before <= now[164];
                    in_word <= now[163:160];
                    in_data <= now[159:128];
                    if (now[187:184] != 0) begin
                        start_now <= 1;
                        kept <= now[183:180];
                        bodies <= now[179:172];
                        taxels <= now[127:0];
                        saturated <= now[128];
                        again <= (now[187:184] == 2);
                        resets <= (now[187:184] == 3);
                        last = now[159:128];
                        if (now[187:184] != 1) has_held <= 0;
                        count <= 0;
                        index <= 0;
                        phase <= 1;
                        out_address <= {out_bank, {(HIGH+1){1'b0}}};
                    end
                end
            end
            if (phase == 1) begin
                count <= count + 1;
                index <= (index == WORDS - 1) ? 0 : index + 1;
                out_address[HIGH:0] <= index;
                if (has_held != 0 && count > 3 && out_word !== held[asked[HIGH:0]]) $fwrite(file, \"a word changed\\n\");
                if (done && again) again <= 0;
                else if (done) begin
                    $fwrite(file, \"cycles %0d\\n\", count);
                    phase <= 2;
                    index <= 0;
                    step <= 0;
                end
                if (resets && count == last) begin
                    reset <= 1;
                    phase <= -1;
                end
            end
            if (phase == 2) begin
                step <= (step == 2) ? 0 : step + 1;
                out_address <= {out_bank, index[HIGH:0]};
                if (step == 2) begin
                    $fwrite(file, \"%h\\n\", out_word);
                    held[index] <= out_word;
                    index <= index + 1;
                    if (index == WORDS - 1) begin
                        phase <= 0;
                        has_held <= 1;
                    end
                end
            end
        end
";
