//! The emitter: what it prints, and what it refuses because Verilog would read it differently.

use std::collections::BTreeSet;

use hdl_gen::cores::{cordic, fixed_to_float, float_to_fixed};
use hdl_gen::plan::schedule::MACS_BITS;
use rust_hdl_core::ast::{VerilogExpression as Expression, VerilogOp, VerilogOpUnary};
use rust_hdl_core::prelude::*;

use crate::emit::{Description, emit};
use crate::printer::{Symbol, Symbols, Type, print};
use crate::register::{Register, comment, dff_setup};
use crate::sint::Sint;
use crate::{CoreError, print_all};

#[test]
fn prints_every_core_the_same_each_time() -> Result<(), CoreError> {
    let (once, again) = (print_all()?, print_all()?);
    assert_eq!(once, again);
    let paths: BTreeSet<&str> = once.iter().map(|core| core.path).collect();
    assert_eq!((paths.len(), once.len()), (4, 4));
    Ok(())
}

#[test]
fn prints_plain_verilog() -> Result<(), CoreError> {
    for core in print_all()? {
        let text = core.verilog;
        assert!(
            text.starts_with("// SPDX-License-Identifier: ") && text.ends_with("`default_nettype wire\n"),
            "{text}"
        );
        assert_eq!(text.matches("\nmodule ").count(), 1, "{text}");
        assert!(!text.contains("initial") && !text.contains("_next"), "{text}");
        let calls = text.matches("$signed(").count() + text.matches("$unsigned(").count();
        assert_eq!(text.matches('$').count(), calls, "{text}");
        assert!(text.lines().all(|line| line.len() <= 120 && line == line.trim_end()), "{text}");
    }
    Ok(())
}

/// The numbers in the files' comments are those that the plan and the model compute with.
#[test]
fn says_what_the_references_say() -> Result<(), CoreError> {
    let cores = print_all()?;
    for (path, said) in [
        ("sptfra_row_sequencer.v", format!("macs[{}:0]", MACS_BITS - 1)),
        ("sptfra_cordic.v", format!("in cycle {}.", cordic::LATENCY)),
        ("sptfra_cordic.v", format!("{} fraction bits", cordic::ANGLE_FRACTION_BITS)),
        ("sptfra_cordic.v", format!("{} micro-rotations", cordic::ITERATIONS)),
        ("sptfra_cordic.v", format!("times {}", cordic::CORDIC_GAIN)),
        ("sptfra_float_to_fixed.v", format!("Latency {} cycles", float_to_fixed::LATENCY)),
        ("sptfra_float_to_fixed.v", format!("to {}-bit fixed point", float_to_fixed::FIXED_BITS)),
        ("sptfra_fixed_to_float.v", format!("Latency {} enabled cycles", fixed_to_float::LATENCY)),
    ] {
        let core = cores.iter().find(|core| core.path.ends_with(path)).expect("printed");
        let comment = core.verilog.split("\n`default_nettype").next().unwrap_or_default();
        assert!(comment.contains(&said), "no `{said}` in {comment}");
    }
    Ok(())
}

#[derive(LogicBlock, Default)]
struct Idioms {
    clock: Signal<In, Clock>,
    a: Signal<In, Bits<4>>,
    b: Signal<In, Bits<4>>,
    s: Signal<In, Sint<8>>,
    masked: Signal<Out, Bit>,
    negative: Signal<Out, Bit>,
    count: Signal<Out, Bits<4>>,
    counter: Register<Bits<4>>,
}

impl Logic for Idioms {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, counter);
        comment!("grouping that Verilog's precedence would change, and signs that its literals would");
        self.masked.next = (self.a.val() & self.b.val()) == 9;
        self.negative.next = self.s.val() < 0.into();
        if self.masked.val() {
            self.counter.d.next = (self.counter.q.val() + 1) >> self.b.val();
        }
        self.count.next = self.counter.q.val();
    }
}

const IDIOMS: Description = Description {
    path: "idioms.v",
    banner: "Idioms.",
    ports: &[("clock", ""), ("a", ""), ("b", ""), ("s", ""), ("masked", ""), ("negative", ""), ("count", "")],
    unused: &[],
};

#[test]
fn keeps_grouping_width_and_sign() -> Result<(), CoreError> {
    let text = emit(Idioms::default(), &IDIOMS)?.verilog;
    for line in [
        "    reg [3:0] counter;",
        "    // grouping that Verilog's precedence would change, and signs that its literals would",
        "    assign masked = (a & b) == 4'd9;",
        "    assign negative = s < 8'sd0;",
        "            counter <= (counter + 4'd1) >> b;",
    ] {
        assert!(text.lines().any(|found| found == line), "no `{line}` in\n{text}");
    }
    Ok(())
}

#[test]
fn refuses_a_description_of_other_ports() {
    let description = Description { ports: &IDIOMS.ports[1..], ..IDIOMS };
    let refused = emit(Idioms::default(), &description);
    assert!(matches!(&refused, Err(CoreError::Kernel { problem, .. }) if problem.contains("ports")), "{refused:?}");
}

fn signal(name: &str) -> Expression {
    Expression::Signal(name.to_owned())
}

fn number(value: u32) -> Expression {
    Expression::Literal(value.into())
}

fn binary(left: Expression, op: VerilogOp, right: Expression) -> Expression {
    Expression::Binary(left.into(), op, right.into())
}

/// What the printer says of an expression over the 4-bit `a` and `b` and the signed 8-bit `s`.
fn printed(expression: &Expression, width: usize, signed: bool) -> Result<String, String> {
    let symbols: Symbols = [("a", 4, false), ("b", 4, false), ("s", 8, true)]
        .into_iter()
        .map(|(name, width, signed)| (name.to_owned(), Symbol { name: name.to_owned(), kind: Type { width, signed } }))
        .collect();
    print(&symbols, expression, Type { width, signed })
}

#[test]
fn refuses_what_verilog_evaluates_wider_than_rust() {
    let difference = || binary(signal("a"), VerilogOp::Sub, signal("b")).into();
    let inverted = Expression::Unary(VerilogOpUnary::Not, signal("a").into()).into();
    for (expression, width) in [
        (Expression::Cast(difference(), 8), 8),
        (Expression::Cast(inverted, 8), 8),
        (Expression::Index(difference(), number(3).into()), 1),
        (Expression::Slice(difference(), 2, number(0).into()), 2),
    ] {
        let refused = printed(&expression, width, false);
        assert!(matches!(&refused, Err(problem) if problem.contains("signal of its own")), "{refused:?}");
    }
}

#[test]
fn refuses_mixed_widths_and_signs() {
    let mixed = binary(signal("a"), VerilogOp::Add, signal("s"));
    assert!(printed(&mixed, 4, false).is_err());
    assert!(printed(&Expression::Cast(signal("s").into(), 12), 12, false).is_err());
    assert!(printed(&signal("a"), 8, false).is_err());
    assert!(printed(&signal("c"), 4, false).is_err());
}

#[test]
fn refuses_bits_and_constants_outside_their_signal() {
    assert_eq!(printed(&Expression::Index(signal("a").into(), number(3).into()), 1, false).as_deref(), Ok("a[3]"));
    assert!(printed(&Expression::Index(signal("a").into(), number(4).into()), 1, false).is_err());
    let masked = |mask| binary(signal("a"), VerilogOp::BitAnd, number(mask));
    assert_eq!(printed(&masked(15), 4, false).as_deref(), Ok("a & 4'd15"));
    assert!(printed(&masked(16), 4, false).is_err());
}

#[test]
fn resizes_by_sign_or_by_zeros() {
    assert_eq!(printed(&Expression::Cast(signal("a").into(), 6), 6, false).as_deref(), Ok("{2'd0, a}"));
    assert_eq!(printed(&Expression::Cast(signal("a").into(), 3), 3, false).as_deref(), Ok("a[2:0]"));
    let signed = Expression::Signed(signal("s").into());
    assert_eq!(printed(&signed, 10, true).as_deref(), Ok("$signed({{2{s[7]}}, s})"));
    assert_eq!(printed(&signed, 5, true).as_deref(), Ok("$signed(s[4:0])"));
}

#[derive(LogicBlock, Default)]
struct Undriven {
    a: Signal<In, Bit>,
    out: Signal<Out, Bit>,
    other: Signal<Out, Bit>,
}

impl Logic for Undriven {
    #[hdl_gen]
    fn update(&mut self) {
        self.out.next = self.a.val();
    }
}

#[test]
fn passes_on_what_rust_hdl_finds() {
    let ports = &[("a", ""), ("out", ""), ("other", "")];
    let refused = emit(Undriven::default(), &Description { path: "undriven.v", banner: "", ports, unused: &[] });
    assert!(matches!(&refused, Err(CoreError::Check { problem, .. }) if problem.contains("other")), "{refused:?}");
}

#[derive(LogicBlock, Default)]
struct Stages {
    clock: Signal<In, Clock>,
    a: Signal<In, Bit>,
    b: Signal<In, Bit>,
    out: Signal<Out, Bit>,
    first: Register<Bit>,
    other: Register<Bit>,
    second: Register<Bit>,
    chosen: Signal<Local, Bit>,
    both: Signal<Local, Bit>,
}

impl Logic for Stages {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, first, second);
        clock!(self, clock, other);
        comment!("one");
        self.first.d.next = self.a.val();
        self.other.d.next = self.b.val();

        comment!("two");
        self.chosen.next = self.first.q.val();
        self.both.next = self.chosen.val() & self.other.q.val();
        if self.b.val() {
            self.second.d.next = self.both.val();
        }

        comment!("three");
        if self.a.val() {
            self.second.d.next = false;
        } else {
            self.first.d.next = true;
        }
        self.out.next = self.second.q.val();
    }
}

/// A register that two sections assign has one clocked process, the last assignment counts, and holding is no statement.
#[test]
fn takes_a_kernel_apart() -> Result<(), CoreError> {
    let ports = &[("clock", ""), ("a", ""), ("b", ""), ("out", "")];
    let text = emit(Stages::default(), &Description { path: "stages.v", banner: "", ports, unused: &[] })?.verilog;
    let body = text.split("    reg second;\n").nth(1).unwrap_or_default();
    let expected = "
    // two
    wire chosen = first;
    wire both = chosen && other;

    always @(posedge clock) begin
        // one
        first <= a;
        other <= b;
        if (b) begin
            second <= both;
        end

        // three
        if (a) begin
            second <= 1'b0;
        end else begin
            first <= 1'b1;
        end
    end

    assign out = second;

endmodule
";
    assert!(body.starts_with(expected), "{text}");
    Ok(())
}

#[derive(LogicBlock, Default)]
struct TooEarly {
    a: Signal<In, Bit>,
    out: Signal<Out, Bit>,
    seen: Signal<Local, Bit>,
}

impl Logic for TooEarly {
    #[hdl_gen]
    fn update(&mut self) {
        self.seen.next = self.a.val();
        self.out.next = self.seen.val();
        self.seen.next = !self.a.val();
    }
}

#[derive(LogicBlock, Default)]
struct Latch {
    a: Signal<In, Bit>,
    out: Signal<Out, Bit>,
    kept: Signal<Local, Bit>,
}

impl Logic for Latch {
    #[hdl_gen]
    fn update(&mut self) {
        if self.a.val() {
            self.kept.next = true;
        }
        self.out.next = self.kept.val();
    }
}

#[derive(LogicBlock, Default)]
struct Sometimes {
    clock: Signal<In, Clock>,
    a: Signal<In, Bit>,
    out: Signal<Out, Bit>,
    state: Register<Bit>,
}

impl Logic for Sometimes {
    #[hdl_gen]
    fn update(&mut self) {
        clock!(self, clock, state);
        if self.a.val() {
            self.state.d.next = true;
        }
        self.out.next = self.state.q.val();
    }
}

/// In Rust a kernel runs from top to bottom; in Verilog its parts run at once.
#[test]
fn refuses_what_depends_on_the_order_or_on_what_was_before() {
    let description = |ports| Description { path: "refused.v", banner: "", ports, unused: &[] };
    let plain = &[("a", ""), ("out", "")];
    let clocked = &[("clock", ""), ("a", ""), ("out", "")];
    for (refused, why) in [
        (emit(TooEarly::default(), &description(plain)), "changes after it has been read"),
        (emit(Latch::default(), &description(plain)), "before it has a value"),
        (emit(Sometimes::default(), &description(clocked)), "no value on some path"),
    ] {
        let said = refused.map(|core| core.verilog).map_err(|error| error.to_string());
        assert!(said.as_ref().is_err_and(|said| said.contains(why)), "{said:?}");
    }
}
