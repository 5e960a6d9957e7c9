//! Prints a kernel as wires, combinational processes, and clocked processes that hold the registers themselves.
//!
//! A kernel says what every register takes at the next edge, after a default of holding; a clocked process says the
//! same of the register. The wires and the clocked process of a section stand together under its comment.

use std::collections::BTreeSet;
use std::slice;

use rust_hdl_core::ast::{
    VerilogBlockOrConditional as Otherwise, VerilogExpression as Expression, VerilogStatement as Statement,
};

use crate::flow::driven;
use crate::printer::{Symbols, Type, print, range, symbol, type_of};
use crate::section::{Section, clocked, is_register, kept, sections, wires};

/// A kernel as Verilog.
pub(super) struct Processes {
    /// The body of the module below its declarations.
    pub(super) lines: Vec<String>,
    /// Signals that are wires; locals among them are declared where they are assigned.
    pub(super) wires: BTreeSet<String>,
}

/// Prints a flattened and checked kernel; `outputs` are the module's.
pub(super) fn processes(
    kernel: Vec<Statement>,
    symbols: &Symbols,
    outputs: &BTreeSet<String>,
) -> Result<Processes, String> {
    let mut sections = sections(kernel)?;
    let wires = wires(&sections)?;
    let mut lines = Vec::new();
    let mut assigns = Vec::new();
    let clocked = clocked(&sections);
    for index in 0..sections.len() {
        let section = &sections[index];
        let mut part = Body { symbols, sign: "=", lines: Vec::new() };
        // A process stands where the kernel has the last of its statements: behind what it reads, before what reads it.
        let of_process = |name: &str| !is_register(name) && !wires.contains(name);
        let last = section.body.iter().rposition(|statement| !kept(slice::from_ref(statement), &of_process).is_empty());
        for (place, statement) in section.body.iter().enumerate() {
            if let Some(name) = driven(statement).filter(|name| wires.contains(*name)) {
                let assignment = part.assignment(statement)?;
                if outputs.contains(name) {
                    assigns.push(format!("    assign {assignment}"));
                } else {
                    part.line(1, &format!("wire {}{assignment}", range(symbol(symbols, name)?.kind)));
                }
            }
            if last == Some(place) {
                part.process("@(*)", [(&[][..], kept(&section.body, &of_process))])?;
                part.lines.push(String::new());
            }
        }
        if part.lines.last().is_some_and(String::is_empty) {
            part.lines.pop();
        }
        if !part.lines.is_empty() {
            let section = &mut sections[index];
            section.open(&mut lines)?;
            lines.append(&mut part.lines);
        }
        let Some(members) = clocked.get(&index) else { continue };
        let mut part = Body { symbols, sign: "<=", lines: Vec::new() };
        let mut inside = Vec::new();
        let alone = members.len() == 1;
        for &member in members {
            let section = &sections[member];
            let comment = if alone || section.told { &[][..] } else { &section.comment };
            inside.push((comment, kept(&section.body, &is_register)));
        }
        part.process("@(posedge clock)", inside)?;
        if alone && !sections[index].told {
            sections[index].open(&mut lines)?;
        } else {
            lines.push(String::new());
        }
        lines.append(&mut part.lines);
    }
    if !assigns.is_empty() {
        lines.push(String::new());
        lines.append(&mut assigns);
    }
    Ok(Processes { lines, wires })
}

impl Section {
    /// A blank line and the comment, if there is one.
    fn open(&mut self, lines: &mut Vec<String>) -> Result<(), String> {
        lines.push(String::new());
        for comment in &self.comment {
            lines.push(format!("    // {}", comment_words(comment)?));
        }
        self.told = true;
        Ok(())
    }
}

/// What a kernel's `comment!` says. `hdl_gen` leaves the macro's own text around a long comment, with a line break in
/// it.
fn comment_words(text: &str) -> Result<String, String> {
    let words = text.split_whitespace().collect::<Vec<_>>().join(" ");
    let inner = words.split_once("(\"").filter(|(before, _)| before.starts_with("comment"));
    let words = inner.map_or(words.as_str(), |(_, inner)| inner);
    let words = words.strip_suffix("\")").unwrap_or(words);
    if words.contains(['"', '\\']) { Err(format!("comment `{words}` has a quote in it")) } else { Ok(words.to_owned()) }
}

/// The statements of one process.
struct Body<'a> {
    symbols: &'a Symbols,
    /// What assigns: `=` in a combinational process, `<=` in a clocked one.
    sign: &'static str,
    lines: Vec<String>,
}

impl Body<'_> {
    fn line(&mut self, depth: usize, line: &str) {
        self.lines.push(format!("{}{line}", "    ".repeat(depth)));
    }

    /// A process whose statements are those of sections, each with its comment.
    fn process<'s>(
        &mut self,
        event: &str,
        sections: impl IntoIterator<Item = (&'s [String], Vec<Statement>)>,
    ) -> Result<(), String> {
        if !self.lines.is_empty() {
            self.lines.push(String::new());
        }
        self.line(1, &format!("always {event} begin"));
        for (comments, body) in sections {
            if !comments.is_empty() && self.lines.last().is_some_and(|line| !line.ends_with("begin")) {
                self.lines.push(String::new());
            }
            for comment in comments {
                self.line(2, &format!("// {}", comment_words(comment)?));
            }
            self.block(&body, 2)?;
        }
        self.line(1, "end");
        Ok(())
    }

    fn block(&mut self, block: &[Statement], depth: usize) -> Result<(), String> {
        block.iter().try_for_each(|statement| self.statement(statement, depth))
    }

    fn assignment(&self, statement: &Statement) -> Result<String, String> {
        let Statement::Assignment(Expression::Signal(name), value) = statement else {
            return Err(format!("{statement:?} is no assignment"));
        };
        let target = symbol(self.symbols, name)?;
        let value = print(self.symbols, value, target.kind).map_err(|problem| format!("`{name}`: {problem}"))?;
        Ok(format!("{} {} {value};", target.name, self.sign))
    }

    fn statement(&mut self, statement: &Statement, depth: usize) -> Result<(), String> {
        match statement {
            Statement::If(_) => self.conditional(statement, depth, "")?,
            Statement::Match(choice) => {
                let kind = type_of(self.symbols, &choice.test)?.ok_or("a match needs a signal")?;
                let test = print(self.symbols, &choice.test, kind)?;
                self.line(depth, &format!("case ({test})"));
                for case in &choice.cases {
                    let label = match case.condition.parse::<u64>() {
                        Ok(value) if kind.width < 64 && value >> kind.width == 0 => format!("{}'d{value}", kind.width),
                        _ if case.condition == "default" => "default".to_owned(),
                        _ => return Err(format!("`{}` is no value of {test}", case.condition)),
                    };
                    self.case(&label, &case.block, depth + 1)?;
                }
                self.line(depth, "endcase");
            }
            _ => {
                let assignment = self.assignment(statement)?;
                self.line(depth, &assignment);
            }
        }
        Ok(())
    }

    fn case(&mut self, label: &str, block: &[Statement], depth: usize) -> Result<(), String> {
        if let [statement @ Statement::Assignment(..)] = block {
            let only = self.assignment(statement)?;
            self.line(depth, &format!("{label}: {only}"));
        } else {
            self.line(depth, &format!("{label}: begin"));
            self.block(block, depth + 1)?;
            self.line(depth, "end");
        }
        Ok(())
    }

    fn conditional(&mut self, statement: &Statement, depth: usize, before: &str) -> Result<(), String> {
        let Statement::If(choice) = statement else { return Err(format!("{statement:?} follows an else")) };
        let test = print(self.symbols, &choice.test, Type { width: 1, signed: false })?;
        self.line(depth, &format!("{before}if ({test}) begin"));
        self.block(&choice.then, depth + 1)?;
        match &choice.otherwise {
            Otherwise::None => self.line(depth, "end"),
            Otherwise::Conditional(next) => self.conditional(next, depth, "end else ")?,
            Otherwise::Block(block) => {
                self.line(depth, "end else begin");
                self.block(block, depth + 1)?;
                self.line(depth, "end");
            }
        }
        Ok(())
    }
}
