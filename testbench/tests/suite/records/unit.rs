//! `sptfra_float_unit` by itself: each result and its cycles, against the model, and the model against f64.

use std::fmt::Write as _;
use std::fs;

use hdl_gen::cores::Multiplier;
use hdl_gen::model::contacts::float;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::records_of_faults;
use crate::support::effort::some_of;
use crate::support::player::{verilator, write_broken};
use crate::support::workspace;

/// Add, subtract, multiply, divide, root, angle, and what compares.
const CYCLES: [u64; 8] = [9, 9, 9, 33, 32, 73, 2, 2];

#[derive(Clone, Copy, Debug)]
struct Operation {
    what: usize,
    a: u32,
    b: u32,
}

impl Operation {
    /// The result, or whether `|a| < |b|`.
    fn expected(self) -> u32 {
        let Self { what, a, b } = self;
        match what {
            0 => float::add(a, b),
            1 => float::subtract(a, b),
            2 => float::multiply(a, b),
            3 => float::divide(a, b),
            4 => float::root(a),
            5 => float::angle(a, b),
            _ => u32::from(float::is_below(a, b)),
        }
    }

    /// The exact result but for the rounding of f64.
    fn exact(self) -> f64 {
        let [a, b] = [self.a, self.b].map(float::value);
        match self.what {
            0 => a + b,
            1 => a - b,
            2 => a * b,
            3 => a / b,
            4 => a.max(0.0).sqrt(),
            _ => b.atan2(a),
        }
    }
}

/// Numbers of any size; of like sizes; with few bits; zeros, denormals, the largest, what float32 has no number for.
fn operations(random: &mut ChaCha8Rng, count: usize) -> Vec<Operation> {
    let special =
        [0, 1, 0x7F_FFFF, 0x80_0000, 0x80_0001, 0x3F80_0000, 0x7F7F_FFFF, 0x7F80_0000, 0x7FFF_FFFF, 0x4000_0000];
    let mut number = |near: u32| {
        let sign = u32::from(random.random_bool(0.5)) << 31;
        let bits: u32 = random.random();
        let exponent = match bits % 4 {
            0 => bits >> 24,
            1 => (near >> 23 & 0xFF).saturating_add(bits >> 24 & 31).saturating_sub(15).min(255),
            2 => near >> 23 & 0xFF,
            _ => 120 + (bits >> 24 & 15),
        };
        let fraction: u32 = random.random::<u32>() & 0x7F_FFFF;
        let fraction = match random.random_range(0..5) {
            0 => 0,
            1 => 0x7F_FFFF,
            2 => fraction & 0x70_0000,
            3 => near & 0x7F_FFFF ^ 1 << random.random_range(0..23),
            _ => fraction,
        };
        if random.random_bool(0.03) {
            sign | special[random.random_range(0..10)]
        } else {
            sign | exponent << 23 | fraction
        }
    };
    let mut near = 0x3F80_0000;
    (0..count)
        .map(|place| {
            let a = number(near);
            let b = number(a);
            near = b;
            Operation { what: place % 8, a, b }
        })
        .collect()
}

const BENCH: &str = "module bench(input clock);
    reg [66:0] commands [0:COUNT-1];
    reg [66:0] now;
    reg reset, start, busy;
    wire done, below;
    wire [31:0] result;
    integer place, file, count;
    initial begin
        $readmemh(\"unit.in\", commands);
        file = $fopen(\"unit.out\", \"w\");
        place = 0; reset = 1; start = 0; busy = 0; count = -3; now = 0;
    end
    sptfra_float_unit subject (.clock(clock), .reset(reset), .start(start), .operation(now[66:64]),
        .a(start ? now[63:32] : 32'hffffffff), .b(start ? now[31:0] : 32'hffffffff), .done(done), .result(result), .below(below));
    always @(posedge clock) begin
        start <= 0;
        count <= count + 1;
        reset <= (count < -1);
        if (count >= 0 && !busy && place < COUNT) begin
            now <= commands[place];
            place <= place + 1;
            start <= 1;
            busy <= 1;
            count <= 0;
        end
        if (busy && done) begin
            $fwrite(file, \"%0d %h\\n\", count, (now[66:64] > 5) ? {31'd0, below} : result);
            if (place == COUNT) begin
                $fclose(file);
                place <= COUNT + 1;
            end
            busy <= 0;
        end
    end
endmodule
";

/// Cycles and result of each.
fn play(
    operations: &[Operation],
    fault: Option<&(&str, &str, &str)>,
    multiplier: Multiplier,
) -> Result<Vec<(u64, u32)>, String> {
    let folder = tempfile::tempdir().expect("a folder");
    let place = |name: &str| folder.path().join(name);
    let mut lines = String::new();
    for Operation { what, a, b } in operations {
        let _ = writeln!(lines, "{what:x}{a:08x}{b:08x}");
    }
    fs::write(place("unit.in"), lines).expect("writable");
    fs::write(place("bench.v"), BENCH.replace("COUNT", &operations.len().to_string())).expect("writable");
    if let Some((module, from, to)) = fault {
        write_broken(folder.path(), &format!("sptfra_{module}"), from, to);
    }
    if multiplier == Multiplier::Split {
        let split = "sptfra_multiply.v";
        fs::copy(workspace("hdl-gen/rtl/ecp5").join(split), place(split)).expect("is there");
    }
    let cycles: u64 = operations.iter().map(|operation| CYCLES[operation.what] + 2).sum();
    let said = verilator(folder.path(), cycles as usize + 20);
    if !said.is_empty() {
        return Err(said);
    }
    let text = fs::read_to_string(place("unit.out")).expect("written");
    let line = |line: &str| {
        let (cycles, bits) = line.split_once(' ')?;
        Some((cycles.parse().ok()?, u32::from_str_radix(bits, 16).ok()?))
    };
    text.lines().map(|text| line(text).ok_or_else(|| text.to_owned())).collect()
}

fn expected(operations: &[Operation]) -> Vec<(u64, u32)> {
    operations.iter().map(|operation| (CYCLES[operation.what], operation.expected())).collect()
}

#[test]
fn the_unit_is_the_model() {
    let operations = operations(&mut ChaCha8Rng::seed_from_u64(5), 200_000);
    for (multiplier, count) in [(Multiplier::Whole, 200_000), (Multiplier::Split, 20_000)] {
        let operations = &operations[..count];
        let found = play(operations, None, multiplier).expect("no check fails");
        assert_eq!(found.len(), operations.len());
        for ((operation, found), expected) in operations.iter().zip(found).zip(expected(operations)) {
            assert_eq!(found, expected, "{operation:x?}");
        }
    }
}

/// Half a step of 24 bits, and for angles what the rotation leaves.
#[test]
fn the_model_is_as_near_as_it_says() {
    let mut worst = [0.0_f64; 6];
    for operation in operations(&mut ChaCha8Rng::seed_from_u64(6), 400_000) {
        let (exact, found) = (operation.exact(), float::value(operation.expected()));
        let size = exact.abs();
        if operation.what > 5 || (operation.what == 3 && float::value(operation.b) == 0.0) {
            continue;
        }
        // A zero has no sign.
        let sizes = [operation.a, operation.b].map(float::value);
        if operation.what == 5 && sizes[1] == 0.0 {
            continue;
        }
        if operation.what != 5 && (size < f64::from(f32::MIN_POSITIVE) || size > f64::from(f32::MAX)) {
            let limit = if size > 1.0 { f64::from(f32::MAX).copysign(exact) } else { 0.0 };
            assert!(
                found.to_bits() == limit.to_bits() || (size < 1.0 && (found - exact).abs() <= size * 2.0_f64.powi(-24)),
                "{operation:x?}"
            );
            continue;
        }
        let error = if operation.what == 5 { (found - exact).abs() } else { (found - exact).abs() / size };
        worst[operation.what] = worst[operation.what].max(error);
    }
    let half = 2.0_f64.powi(-24);
    println!("worst errors, of half a step, and of 2^-24 rad: {:?}", worst.map(|worst| worst / half));
    assert!(worst[..5].iter().all(|&worst| worst <= half && worst > 0.99 * half), "{worst:?}");
    assert!(worst[5] < 4.0 * half, "{worst:?}");
}

#[test]
fn faults_of_the_unit_are_noticed() {
    let faults = some_of([
        ("float_round", "value_2[3] && (value_2[4]", "value_2[3] && (1'b1"),
        ("float_round", "value[0] || (rest != 10'd0)", "value[0]"),
        ("float_round", "exponent_3 > 10'sd254", "exponent_3 > 10'sd255"),
        ("float_digits", "assign rest = (remainder != 29'd0)", "assign rest = 1'b0"),
        ("float_digits", "{1'b0, a[22], !a[22], a[21:0], 4'd0}", "{1'b0, a[22], a[22], a[21:0], 4'd0}"),
        ("float_product", "sum + {12'd0, sum_before[35:12]}", "sum + {13'd0, sum_before[35:13]}"),
        ("float_unit", "(distance_2[7:5] != 3'd0)", "(distance_2[7:6] != 2'd0)"),
        ("float_unit", "bits_3[7] || lost_3", "bits_3[7]"),
        ("float_unit", "below ? b_1[31] : a_1[31]", "a_1[31]"),
        ("float_unit", "a_1[31] ? -x_wide : x_wide", "x_wide"),
        ("float_unit", "a_zero <= (a[30:23] == 8'd0)", "a_zero <= 1'b0"),
        ("float_unit", "b_1[30:0]) && !b_zero", "b_1[30:0])"),
    ]);
    let operations = operations(&mut ChaCha8Rng::seed_from_u64(7), 2_500);
    let expected = expected(&operations);
    records_of_faults(&faults, |fault| {
        play(&operations, fault, Multiplier::Whole).is_ok_and(|found| found == expected)
    });
}
