//! What must hold before a kernel is taken apart into wires and processes.
//!
//! rust-hdl runs a kernel from top to bottom. Wires and clocked processes have no order, so a signal must have its
//! last value before anything reads it; and one that is not assigned on every path would become a latch.

use std::collections::BTreeSet;

use rust_hdl_core::ast::{
    VerilogBlockOrConditional as Otherwise, VerilogExpression as Expression, VerilogStatement as Statement,
};

/// A kernel's statements without macros, without the registers' clocks, each known to have a translation.
pub(super) fn flatten(block: &[Statement]) -> Result<Vec<Statement>, String> {
    let mut flat = Vec::new();
    for statement in block {
        match statement {
            Statement::Macro(inner) => flat.extend(flatten(inner)?),
            Statement::Assignment(Expression::Signal(name), value) if name.ends_with("$clock$next") => {
                if !matches!(value, Expression::Signal(clock) if clock == "clock") {
                    return Err(format!("`{name}` is not the port `clock`"));
                }
            }
            Statement::Assignment(Expression::Signal(_), _)
            | Statement::If(_)
            | Statement::Match(_)
            | Statement::Comment(_) => flat.push(statement.clone()),
            Statement::Assignment(..) | Statement::SliceAssignment { .. } | Statement::Loop(_) | Statement::Link(_) => {
                return Err(format!("{statement:?} has no safe translation"));
            }
        }
    }
    Ok(flat)
}

/// The signal that an assignment drives: `x$d` for the register `x`.
pub(super) fn driven(statement: &Statement) -> Option<&str> {
    let Statement::Assignment(Expression::Signal(name), _) = statement else { return None };
    Some(name.strip_suffix("$next").unwrap_or(name))
}

/// Checks a flattened kernel: every one of `targets` has a value on every path, and none changes once it has been read.
pub(super) fn check(kernel: &[Statement], targets: &BTreeSet<String>) -> Result<(), String> {
    let mut flow = Flow { targets, assigned: BTreeSet::new(), read: BTreeSet::new() };
    flow.block(kernel)?;
    match targets.difference(&flow.assigned).next() {
        Some(name) => Err(format!("`{name}` has no value on some path")),
        None => Ok(()),
    }
}

struct Flow<'a> {
    /// What the kernel drives.
    targets: &'a BTreeSet<String>,
    /// Of that, what has a value on every path so far.
    assigned: BTreeSet<String>,
    /// Of that, what has been read.
    read: BTreeSet<String>,
}

impl Flow<'_> {
    fn block(&mut self, block: &[Statement]) -> Result<(), String> {
        block.iter().try_for_each(|statement| self.statement(statement))
    }

    fn statement(&mut self, statement: &Statement) -> Result<(), String> {
        match statement {
            Statement::Assignment(_, value) => {
                self.reads(value)?;
                let name = driven(statement).ok_or_else(|| format!("{statement:?} drives no signal"))?;
                if self.read.contains(name) {
                    return Err(format!("`{name}` changes after it has been read"));
                }
                self.assigned.insert(name.to_owned());
            }
            Statement::If(choice) => {
                self.reads(&choice.test)?;
                let before = self.assigned.clone();
                self.block(&choice.then)?;
                let then = std::mem::replace(&mut self.assigned, before);
                match &choice.otherwise {
                    Otherwise::Block(block) => self.block(block)?,
                    Otherwise::Conditional(next) => self.statement(next)?,
                    Otherwise::None => {}
                }
                self.assigned.retain(|name| then.contains(name));
            }
            Statement::Match(choice) => {
                self.reads(&choice.test)?;
                if choice.cases.last().is_none_or(|case| case.condition != "default") {
                    return Err("a match ends without a case for the rest".to_owned());
                }
                let before = self.assigned.clone();
                let mut every: Option<BTreeSet<String>> = None;
                for case in &choice.cases {
                    self.assigned.clone_from(&before);
                    self.block(&case.block)?;
                    every = Some(every.map_or_else(|| self.assigned.clone(), |every| &every & &self.assigned));
                }
                self.assigned = every.unwrap_or(before);
            }
            Statement::Comment(_) => {}
            _ => return Err(format!("{statement:?} has no safe translation")),
        }
        Ok(())
    }

    fn reads(&mut self, expression: &Expression) -> Result<(), String> {
        match expression {
            Expression::Signal(name) => {
                if name.ends_with("$d") {
                    return Err(format!("`{name}` is read before the clock's edge"));
                }
                if self.targets.contains(name) {
                    if !self.assigned.contains(name) {
                        return Err(format!("`{name}` is read before it has a value on every path"));
                    }
                    self.read.insert(name.clone());
                }
                Ok(())
            }
            Expression::Literal(_) => Ok(()),
            Expression::Cast(inner, _)
            | Expression::Paren(inner)
            | Expression::Unary(_, inner)
            | Expression::Signed(inner)
            | Expression::Unsigned(inner) => self.reads(inner),
            Expression::Binary(left, _, right) => {
                self.reads(left)?;
                self.reads(right)
            }
            Expression::Index(inner, index) | Expression::Slice(inner, _, index) => {
                self.reads(inner)?;
                self.reads(index)
            }
            Expression::IndexReplace(..) => Err("bit replacement has no safe translation".to_owned()),
        }
    }
}
