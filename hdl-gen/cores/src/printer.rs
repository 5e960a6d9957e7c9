//! Prints a rust-hdl kernel as Verilog, checking every width and sign on the way.
//!
//! rust-hdl's own printer drops the parentheses of the Rust expression, widens literals to 32 bits and turns signed
//! comparisons unsigned without a word. This one keeps the grouping of the syntax tree, gives every literal the width
//! of its partner, leaves the operands of a product as narrow as they are, and refuses any expression whose meaning in
//! Verilog could differ from the Rust one: operands of different width or sign, casts and slices of anything but a bare
//! signal.

use std::collections::BTreeMap;

use rust_hdl_core::ast::{VerilogExpression as Expression, VerilogLiteral, VerilogOp as Op, VerilogOpUnary as UnaryOp};

/// Width and sign of a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Type {
    pub(super) width: usize,
    pub(super) signed: bool,
}

impl Type {
    const BIT: Self = Self { width: 1, signed: false };

    fn unsigned(width: usize) -> Self {
        Self { width, signed: false }
    }

    fn words(self) -> String {
        format!("{} {} bits", if self.signed { "signed" } else { "unsigned" }, self.width)
    }
}

/// A name of the kernel: what it is called in Verilog and what it holds.
#[derive(Debug, Clone)]
pub(super) struct Symbol {
    pub(super) name: String,
    pub(super) kind: Type,
}

/// The names a kernel may use, by their rust-hdl spelling.
pub(super) type Symbols = BTreeMap<String, Symbol>;

/// The range of a declaration, with the space behind it.
pub(super) fn range(kind: Type) -> String {
    let sign = if kind.signed { "signed " } else { "" };
    if kind.width == 1 { sign.to_owned() } else { format!("{sign}[{}:0] ", kind.width - 1) }
}

/// Looks up a rust-hdl name: `next` is rust-hdl's mark of a write, `a[3]` its spelling of `a$3`.
pub(super) fn symbol<'a>(symbols: &'a Symbols, name: &str) -> Result<&'a Symbol, String> {
    let plain = name.strip_suffix("$next").unwrap_or(name).replace('[', "$").replace(']', "");
    symbols.get(&plain).ok_or_else(|| format!("`{name}` is no port, signal, constant or register"))
}

/// The Verilog text of a constant.
pub(super) fn constant(literal: &VerilogLiteral, kind: Type) -> Result<String, String> {
    let value = literal_value(literal)?.1;
    if kind.width < 128 && value >> kind.width != 0 {
        return Err(format!("constant {value} does not fit {}", kind.words()));
    }
    let (sign, width) = (if kind.signed { "s" } else { "" }, kind.width);
    if kind == Type::BIT {
        return Ok(format!("1'b{value}"));
    }
    Ok(if value < 1024 { format!("{width}'{sign}d{value}") } else { format!("{width}'{sign}h{value:x}") })
}

/// Width and value of a literal, which rust-hdl only gives away as text such as `12'h3f` or `3'b101`.
fn literal_value(literal: &VerilogLiteral) -> Result<(usize, u128), String> {
    let text = literal.to_string();
    let parse = || {
        let (width, digits) = text.split_once('\'')?;
        let (radix, digits) = digits.split_at_checked(1)?;
        let radix = if radix == "b" { 2 } else { 16 };
        Some((width.parse().ok()?, u128::from_str_radix(digits, radix).ok()?))
    };
    parse().ok_or_else(|| format!("literal `{text}` is not a plain number"))
}

/// The type of an expression; `None` for what takes the type that its place asks for.
pub(super) fn type_of(symbols: &Symbols, expression: &Expression) -> Result<Option<Type>, String> {
    Ok(match expression {
        Expression::Signal(name) => Some(symbol(symbols, name)?.kind),
        // Rust's `true` and `false`; a number has rust-hdl's width of the Rust type, which says nothing.
        Expression::Literal(literal) => (literal_value(literal)?.0 == 1).then_some(Type::BIT),
        Expression::Cast(_, width) | Expression::Slice(_, width, _) => Some(Type::unsigned(*width)),
        Expression::Paren(inner) | Expression::Unary(UnaryOp::Not | UnaryOp::Neg, inner) => type_of(symbols, inner)?,
        Expression::Unary(..) | Expression::Index(..) => Some(Type::BIT),
        Expression::Unsigned(inner) => type_of(symbols, inner)?.map(|inner| Type::unsigned(inner.width)),
        // A signed value may be resized by this, an unsigned one only read as signed.
        Expression::Signed(inner) => type_of(symbols, inner)?
            .filter(|inner| !inner.signed)
            .map(|inner| Type { width: inner.width, signed: true }),
        Expression::Binary(left, op, right) => match op {
            Op::Eq | Op::Lt | Op::Ge => Some(Type::BIT),
            Op::Shl | Op::Shr => type_of(symbols, left)?,
            _ => type_of(symbols, left)?.map_or_else(|| type_of(symbols, right), |left| Ok(Some(left)))?,
        },
        Expression::IndexReplace(..) => return Err("bit replacement has no safe translation".to_owned()),
    })
}

/// Prints `expression`, which must have the given type, without parentheses around the whole.
pub(super) fn print(symbols: &Symbols, expression: &Expression, wanted: Type) -> Result<String, String> {
    if let Some(found) = type_of(symbols, expression)?
        && found != wanted
    {
        return Err(format!("{expression:?} has {}, its place {}", found.words(), wanted.words()));
    }
    match expression {
        Expression::Signal(name) => Ok(symbol(symbols, name)?.name.clone()),
        Expression::Literal(literal) => constant(literal, wanted),
        Expression::Paren(inner) => print(symbols, inner, wanted),
        Expression::Cast(inner, _) => resize(symbols, inner, wanted),
        Expression::Signed(inner) => match type_of(symbols, inner)? {
            Some(found) if found.signed => resize(symbols, inner, wanted),
            Some(found) => Ok(format!("$signed({})", bare(symbols, inner, found)?)),
            None => Err(format!("{inner:?} has no sign to keep")),
        },
        Expression::Unsigned(inner) => {
            Ok(format!("$unsigned({})", bare(symbols, inner, Type { width: wanted.width, signed: true })?))
        }
        Expression::Unary(op, inner) => {
            let (sign, kind) = match op {
                UnaryOp::Not if wanted == Type::BIT => ("!", wanted),
                UnaryOp::Not => ("~", wanted),
                UnaryOp::Neg => ("-", wanted),
                UnaryOp::Any => ("|", known(symbols, inner)?),
                UnaryOp::All | UnaryOp::Xor => return Err(format!("no core has {op:?} yet: give it a sign here")),
            };
            Ok(format!("{sign}{}", operand(symbols, inner, kind)?))
        }
        Expression::Index(inner, index) => {
            let kind = known(symbols, inner)?;
            Ok(format!("{}[{}]", bare(symbols, inner, kind)?, position(index, 1, kind)?))
        }
        Expression::Slice(inner, width, offset) => {
            let kind = known(symbols, inner)?;
            let low = position(offset, *width, kind)?;
            let name = bare(symbols, inner, kind)?;
            Ok(match *width {
                width if width == kind.width => name,
                1 => format!("{name}[{low}]"),
                width => format!("{name}[{}:{low}]", low + width - 1),
            })
        }
        Expression::Binary(left, op, right) => binary(symbols, left, op, right, wanted),
        Expression::IndexReplace(..) => Err("bit replacement has no safe translation".to_owned()),
    }
}

fn binary(symbols: &Symbols, left: &Expression, op: &Op, right: &Expression, wanted: Type) -> Result<String, String> {
    // The operands' type: that of the result, or for a comparison their own, which both must share.
    let compared = || {
        let kind = type_of(symbols, left)?.map_or_else(|| type_of(symbols, right), |left| Ok(Some(left)))?;
        kind.ok_or_else(|| format!("nothing gives {left:?} a width"))
    };
    let (sign, kind) = match op {
        Op::Add => ("+", wanted),
        Op::Sub => ("-", wanted),
        Op::Mul => return Err("a product needs a module of its own: sptfra_mac or sptfra_multiply".to_owned()),
        Op::BitAnd if wanted == Type::BIT => ("&&", wanted),
        Op::BitOr if wanted == Type::BIT => ("||", wanted),
        Op::BitAnd => ("&", wanted),
        Op::BitOr => ("|", wanted),
        Op::Eq => ("==", compared()?),
        Op::Lt => ("<", compared()?),
        Op::Ge => (">=", compared()?),
        Op::Shl => ("<<", wanted),
        Op::Shr if wanted.signed => (">>>", wanted),
        Op::Shr => (">>", wanted),
        _ => return Err(format!("no core has {op:?} yet: give it a sign and a type here")),
    };
    let left = operand(symbols, left, kind)?;
    let right = match (op, right) {
        (Op::Shl | Op::Shr, Expression::Literal(distance)) => literal_value(distance)?.1.to_string(),
        (Op::Shl | Op::Shr, distance) => operand(symbols, distance, known(symbols, distance)?)?,
        _ => operand(symbols, right, kind)?,
    };
    Ok(format!("{left} {sign} {right}"))
}

/// As [`print`], in parentheses if it has an operator.
fn operand(symbols: &Symbols, expression: &Expression, wanted: Type) -> Result<String, String> {
    let text = print(symbols, expression, wanted)?;
    Ok(match strip(expression) {
        Expression::Unary(UnaryOp::Not, inner)
            if matches!(strip(inner), Expression::Signal(_) | Expression::Index(..)) =>
        {
            text
        }
        Expression::Binary(..) | Expression::Unary(..) => format!("({text})"),
        _ => text,
    })
}

/// As [`print`], for a place where Verilog allows, or Rust and Verilog agree on, nothing but a name.
fn bare(symbols: &Symbols, expression: &Expression, wanted: Type) -> Result<String, String> {
    match strip(expression) {
        signal @ Expression::Signal(_) => print(symbols, signal, wanted),
        other => Err(format!("{other:?} is cast or sliced: give it a signal of its own")),
    }
}

/// A value extended by its sign, or by zeros, or cut to the wanted width.
fn resize(symbols: &Symbols, inner: &Expression, wanted: Type) -> Result<String, String> {
    let inner = strip(inner);
    if let Expression::Literal(literal) = inner {
        return constant(literal, wanted);
    }
    let found = known(symbols, inner)?;
    if found.signed != wanted.signed {
        return Err(format!("{inner:?} changes width and sign at once"));
    }
    let text = match inner {
        Expression::Slice(..) if found.width <= wanted.width => print(symbols, inner, found)?,
        _ => bare(symbols, inner, found)?,
    };
    if found.width == wanted.width {
        return Ok(text);
    }
    if found.width > wanted.width {
        let cut = format!("{text}[{}:0]", wanted.width - 1);
        return Ok(if wanted.signed { format!("$signed({cut})") } else { cut });
    }
    let more = wanted.width - found.width;
    if found.signed {
        // A concatenation is unsigned.
        let sign = format!("{text}[{}]", found.width - 1);
        let signs = if more == 1 { sign } else { format!("{{{more}{{{sign}}}}}") };
        return Ok(format!("$signed({{{signs}, {text}}})"));
    }
    let zeros = if more == 1 { "1'b0".to_owned() } else { format!("{more}'d0") };
    Ok(format!("{{{zeros}, {text}}}"))
}

fn strip(expression: &Expression) -> &Expression {
    match expression {
        Expression::Paren(inner) => strip(inner),
        other => other,
    }
}

fn known(symbols: &Symbols, expression: &Expression) -> Result<Type, String> {
    type_of(symbols, expression)?.ok_or_else(|| format!("nothing gives {expression:?} a width"))
}

/// The constant place of `width` bits within a value.
fn position(offset: &Expression, width: usize, within: Type) -> Result<usize, String> {
    let Expression::Literal(literal) = strip(offset) else {
        return Err(format!("bit position {offset:?} is not a number"));
    };
    let low = literal_value(literal)?.1;
    usize::try_from(low)
        .ok()
        .filter(|low| low.checked_add(width).is_some_and(|end| end <= within.width))
        .ok_or_else(|| format!("{width} bits from bit {low} lie outside {} bits", within.width))
}
