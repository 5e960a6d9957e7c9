//! Turns a rust-hdl block into one plain Verilog-2005 module.
//!
//! The kernel becomes one combinational process, its registers one clocked process: `x` is a register, `x_next` what
//! it takes at the next edge.

use std::collections::BTreeSet;

use rust_hdl_core::ast::{
    Verilog, VerilogBlock, VerilogBlockOrConditional, VerilogLiteral, VerilogStatement as Statement,
};
use rust_hdl_core::prelude::{Atom, AtomKind, Block, Probe, TypeKind, check_all};

use super::printer::{Symbol, Symbols, Type, constant, print, symbol, type_of};
use super::register::REGISTER_BODY;
use super::{CoreError, CoreFile};

/// What the emitted text says in words.
pub(super) struct Description {
    /// The module's name.
    pub(super) module: &'static str,
    /// The banner: what it does, latency, initiation interval, number format.
    pub(super) banner: &'static str,
    /// Every port and what it is, in the order of the struct.
    pub(super) ports: &'static [(&'static str, &'static str)],
    /// Signals of which some bits are left unread on purpose.
    pub(super) unused: &'static [&'static str],
}

/// Emits `block` under the names of `description`.
pub(super) fn emit<B: Block>(mut block: B, description: &Description) -> Result<CoreFile, CoreError> {
    let module = description.module;
    block.connect_all();
    check_all(&block).map_err(|error| CoreError::Check { module, problem: format!("{error:?}") })?;
    let mut parts = Parts::default();
    block.accept("top", &mut parts);
    let verilog = parts.module(description).map_err(|problem| CoreError::Kernel { module, problem })?;
    Ok(CoreFile { module, verilog })
}

/// A block taken apart.
#[derive(Default)]
struct Parts {
    /// The register being visited within the block, if any.
    scopes: Vec<Option<String>>,
    atoms: Vec<Part>,
    kernel: Option<VerilogBlock>,
    registers: Vec<String>,
    foreign: Vec<String>,
}

struct Part {
    name: String,
    kind: AtomKind,
    value: Type,
    literal: VerilogLiteral,
}

impl Probe for Parts {
    fn visit_start_scope(&mut self, name: &str, node: &dyn Block) {
        match (node.hdl(), self.scopes.len()) {
            (Verilog::Combinatorial(kernel), 0) => self.kernel = Some(kernel),
            (Verilog::Custom(body), 1) if body == REGISTER_BODY => self.registers.push(name.to_owned()),
            _ => self.foreign.push(name.to_owned()),
        }
        self.scopes.push((!self.scopes.is_empty()).then(|| name.to_owned()));
    }

    fn visit_end_scope(&mut self, _name: &str, _node: &dyn Block) {
        self.scopes.pop();
    }

    fn visit_start_namespace(&mut self, name: &str, _node: &dyn Block) {
        self.foreign.push(name.to_owned());
    }

    fn visit_atom(&mut self, name: &str, atom: &dyn Atom) {
        let (signed, plain) = match atom.descriptor().kind {
            TypeKind::Bits(_) => (false, true),
            TypeKind::Signed(_) => (true, true),
            TypeKind::Enum(_) | TypeKind::Composite(_) => (false, false),
        };
        if !plain {
            self.foreign.push(name.to_owned());
        }
        let (name, kind) = match self.scopes.last() {
            Some(Some(register)) => (format!("{register}${name}"), AtomKind::StubInputSignal),
            _ => (name.to_owned(), atom.kind()),
        };
        let value = Type { width: atom.bits(), signed };
        self.atoms.push(Part { name, kind, value, literal: atom.verilog() });
    }
}

impl Parts {
    fn module(&self, description: &Description) -> Result<String, String> {
        if let Some(name) = self.foreign.first() {
            return Err(format!("`{name}` is neither a register nor a signal of plain bits"));
        }
        let kernel = self.kernel.as_ref().ok_or("the block has no kernel")?;
        let symbols = self.symbols()?;
        let mut lines: Vec<String> =
            description.banner.lines().map(|line| format!("// {line}").trim_end().to_owned()).collect();
        lines.extend(["", "`default_nettype none", ""].map(str::to_owned));
        lines.push(format!("module {} (", description.module));
        lines.extend(self.ports(description)?);
        lines.push(");".to_owned());
        lines.extend(self.declarations(&symbols)?);
        let mut body = Body { symbols: &symbols, lines: Vec::new() };
        body.block(kernel, 2)?;
        lines.extend(["", "    always @(*) begin"].map(str::to_owned));
        lines.append(&mut body.lines);
        lines.push("    end".to_owned());
        if !self.registers.is_empty() {
            lines.extend(["", "    always @(posedge clock) begin"].map(str::to_owned));
            lines.extend(self.registers.iter().map(|register| format!("        {register} <= {register}_next;")));
            lines.push("    end".to_owned());
        }
        if !description.unused.is_empty() {
            let names: Result<Vec<_>, _> = description.unused.iter().map(|name| symbol(&symbols, name)).collect();
            let names: Vec<&str> = names?.iter().map(|symbol| symbol.name.as_str()).collect();
            lines.extend(["", "    // Bits left unread on purpose."].map(str::to_owned));
            lines.push(format!("    wire unused = &{{1'b0, {}, 1'b0}};", names.join(", ")));
        }
        lines.extend(["", "endmodule", "", "`default_nettype wire", ""].map(str::to_owned));
        Ok(lines.join("\n"))
    }

    /// The Verilog name of every atom; an error if two would share one.
    fn symbols(&self) -> Result<Symbols, String> {
        let mut symbols = Symbols::new();
        let mut taken = BTreeSet::new();
        for atom in &self.atoms {
            let name = match atom.name.split_once('$') {
                _ if atom.kind == AtomKind::Constant => atom.name.replace('$', "_").to_uppercase(),
                Some((register, "q")) => register.to_owned(),
                Some((register, "d")) => format!("{register}_next"),
                Some((_, "clock")) => continue,
                Some(_) => return Err(format!("`{}` is a signal array", atom.name)),
                None => atom.name.clone(),
            };
            if !taken.insert(name.clone()) {
                return Err(format!("two signals would be called `{name}`"));
            }
            symbols.insert(atom.name.clone(), Symbol { name, kind: atom.value });
        }
        Ok(symbols)
    }

    fn ports(&self, description: &Description) -> Result<Vec<String>, String> {
        let ports: Vec<&Part> = self.atoms.iter().filter(|atom| atom.kind.is_parameter()).collect();
        let names: Vec<&str> = ports.iter().map(|port| port.name.as_str()).collect();
        let described: Vec<&str> = description.ports.iter().map(|port| port.0).collect();
        if names != described {
            return Err(format!("the ports are {names:?}, the description has {described:?}"));
        }
        let mut declarations = Vec::new();
        for port in &ports {
            declarations.push(match port.kind {
                AtomKind::InputParameter => format!("input  wire {}{}", range(port.value), port.name),
                AtomKind::OutputParameter => format!("output reg  {}{}", range(port.value), port.name),
                _ => return Err(format!("port `{}` is neither input nor output", port.name)),
            });
        }
        let width = declarations.iter().map(String::len).max().unwrap_or(0) + 1;
        let last = declarations.len().saturating_sub(1);
        let lines = declarations.iter().zip(description.ports).enumerate().map(|(index, (declaration, port))| {
            let cell = format!("{declaration}{}", if index == last { "" } else { "," });
            format!("    {cell:width$}  // {}", port.1).trim_end().to_owned()
        });
        Ok(lines.collect())
    }

    fn declarations(&self, symbols: &Symbols) -> Result<Vec<String>, String> {
        let (mut constants, mut registers, mut signals) = (Vec::new(), Vec::new(), Vec::new());
        for atom in &self.atoms {
            let Some(Symbol { name, kind }) = symbols.get(&atom.name) else { continue };
            let range = range(*kind);
            match atom.kind {
                AtomKind::Constant => {
                    let value = constant(&atom.literal, *kind)?;
                    constants.push(format!("    localparam {range}{name} = {value};"));
                }
                AtomKind::LocalSignal => signals.push(format!("    reg {range}{name};")),
                AtomKind::StubInputSignal if atom.name.ends_with("$q") => {
                    registers.push(format!("    reg {range}{name}, {name}_next;"));
                }
                _ => {}
            }
        }
        let mut lines = Vec::new();
        for group in [constants, registers, signals].into_iter().filter(|group| !group.is_empty()) {
            lines.push(String::new());
            lines.extend(group);
        }
        Ok(lines)
    }
}

fn range(kind: Type) -> String {
    let sign = if kind.signed { "signed " } else { "" };
    if kind.width == 1 { sign.to_owned() } else { format!("{sign}[{}:0] ", kind.width - 1) }
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

/// The statements of the combinational process.
struct Body<'a> {
    symbols: &'a Symbols,
    lines: Vec<String>,
}

impl Body<'_> {
    fn line(&mut self, depth: usize, line: &str) {
        self.lines.push(format!("{}{line}", "    ".repeat(depth)));
    }

    fn block(&mut self, block: &[Statement], depth: usize) -> Result<(), String> {
        block.iter().try_for_each(|statement| self.statement(statement, depth))
    }

    fn statement(&mut self, statement: &Statement, depth: usize) -> Result<(), String> {
        match statement {
            Statement::Assignment(target, value) => {
                use rust_hdl_core::ast::VerilogExpression::Signal;
                let Signal(name) = target else { return Err(format!("{target:?} is no assignable signal")) };
                if name.ends_with("$clock$next") {
                    return match value {
                        Signal(clock) if clock == "clock" => Ok(()),
                        _ => Err(format!("`{name}` is not the port `clock`")),
                    };
                }
                let target = symbol(self.symbols, name)?;
                let value =
                    print(self.symbols, value, target.kind).map_err(|problem| format!("`{name}`: {problem}"))?;
                self.line(depth, &format!("{} = {value};", target.name));
            }
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
            Statement::Comment(words) => {
                if self.lines.last().is_some_and(|line| !line.ends_with("begin")) {
                    self.lines.push(String::new());
                }
                self.line(depth, &format!("// {}", comment_words(words)?));
            }
            Statement::Macro(block) => self.block(block, depth)?,
            Statement::SliceAssignment { .. } | Statement::Loop(_) | Statement::Link(_) => {
                return Err(format!("{statement:?} has no safe translation"));
            }
        }
        Ok(())
    }

    fn case(&mut self, label: &str, block: &[Statement], depth: usize) -> Result<(), String> {
        if let [statement @ Statement::Assignment(..)] = block {
            self.statement(statement, 0)?;
            let only = self.lines.pop().unwrap_or_default();
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
            VerilogBlockOrConditional::None => self.line(depth, "end"),
            VerilogBlockOrConditional::Conditional(next) => self.conditional(next, depth, "end else ")?,
            VerilogBlockOrConditional::Block(block) => {
                self.line(depth, "end else begin");
                self.block(block, depth + 1)?;
                self.line(depth, "end");
            }
        }
        Ok(())
    }
}
