//! The emitter: what it prints, and what it refuses because Verilog would read it differently.

use rust_hdl_core::ast::{VerilogExpression as Expression, VerilogOp, VerilogOpUnary};
use rust_hdl_core::prelude::*;

use crate::emit::{Description, emit};
use crate::printer::{Symbol, Symbols, Type, print};
use crate::register::{Register, comment, dff_setup};
use crate::sint::Sint;
use crate::{CoreError, emit_all};

const NAMES: [&str; 10] = [
    "sptfra_mac",
    "sptfra_mac_split",
    "sptfra_multiply",
    "sptfra_multiply_split",
    "sptfra_axis_skid",
    "sptfra_row_sequencer",
    "sptfra_divider",
    "sptfra_cordic",
    "sptfra_float_to_fixed",
    "sptfra_fixed_to_float",
];

#[test]
fn emits_every_core_the_same_each_time() -> Result<(), CoreError> {
    let (once, again) = (emit_all()?, emit_all()?);
    assert_eq!(once, again);
    assert_eq!(once.iter().map(|core| core.module).collect::<Vec<_>>(), NAMES);
    Ok(())
}

#[test]
fn emits_plain_verilog() -> Result<(), CoreError> {
    for core in emit_all()? {
        let text = core.verilog;
        assert!(text.starts_with("// ") && text.ends_with("`default_nettype wire\n"), "{text}");
        assert_eq!(text.matches("\nmodule ").count(), 1, "{text}");
        assert!(!text.contains("initial"), "{text}");
        let calls = text.matches("$signed(").count() + text.matches("$unsigned(").count();
        assert_eq!(text.matches('$').count(), calls, "{text}");
        assert!(text.lines().all(|line| line.len() <= 120 && line == line.trim_end()), "{text}");
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
    module: "idioms",
    banner: "Idioms.",
    ports: &[("clock", ""), ("a", ""), ("b", ""), ("s", ""), ("masked", ""), ("negative", ""), ("count", "")],
    unused: &[],
};

#[test]
fn keeps_grouping_width_and_sign() -> Result<(), CoreError> {
    let text = emit(Idioms::default(), &IDIOMS)?.verilog;
    for line in [
        "    reg [3:0] counter, counter_next;",
        "        counter_next = counter;",
        "        // grouping that Verilog's precedence would change, and signs that its literals would",
        "        masked = (a & b) == 4'd9;",
        "        negative = s < 8'sd0;",
        "            counter_next = (counter + 4'd1) >> b;",
        "        counter <= counter_next;",
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
    let refused = emit(Undriven::default(), &Description { module: "undriven", banner: "", ports, unused: &[] });
    assert!(matches!(&refused, Err(CoreError::Check { problem, .. }) if problem.contains("other")), "{refused:?}");
}
