//! Turns a rust-hdl block into one plain Verilog-2005 module.
//!
//! Header, ports and declarations; `process` prints what stands below them.

use std::collections::BTreeSet;

use rust_hdl_core::ast::{Verilog, VerilogBlock, VerilogLiteral};
use rust_hdl_core::prelude::{Atom, AtomKind, Block, Probe, TypeKind, check_all};

use crate::flow::{check, flatten};
use crate::printer::{Symbol, Symbols, Type, constant, range, symbol};
use crate::process::processes;
use crate::register::REGISTER_BODY;
use crate::{CoreError, CoreFile};

/// The first lines of every file.
const ORIGIN: [&str; 3] =
    ["// SPDX-License-Identifier: MIT OR Apache-2.0", "// Part of the SpTFRA hardware generator.", "//"];

/// What the emitted text says in words.
pub(super) struct Description {
    /// The file below `hdl-gen/rtl`, named after its module.
    pub(super) path: &'static str,
    /// The banner: what it does, latency, initiation interval, widths and number formats.
    pub(super) banner: &'static str,
    /// Every port and what it is, in the order of the struct.
    pub(super) ports: &'static [(&'static str, &'static str)],
    /// Signals of which some bits are left unread on purpose.
    pub(super) unused: &'static [&'static str],
}

/// Emits `block` under the names of `description`.
pub(super) fn emit<B: Block>(mut block: B, description: &Description) -> Result<CoreFile, CoreError> {
    let path = description.path;
    block.connect_all();
    check_all(&block).map_err(|error| CoreError::Check { path, problem: format!("{error:?}") })?;
    let mut parts = Parts::default();
    block.accept("top", &mut parts);
    let verilog = parts.module(description).map_err(|problem| CoreError::Kernel { path, problem })?;
    Ok(CoreFile { path, verilog })
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
        let kernel = flatten(self.kernel.as_ref().ok_or("the block has no kernel")?)?;
        let symbols = self.symbols()?;
        check(&kernel, &self.driven())?;
        let outputs = self.named(|part| part.kind == AtomKind::OutputParameter);
        let mut body = processes(kernel, &symbols, &outputs)?;
        let file = description.path.rsplit('/').next().unwrap_or_default();
        let mut lines: Vec<String> = ORIGIN.map(str::to_owned).into();
        lines.extend(description.banner.lines().map(|line| format!("// {line}").trim_end().to_owned()));
        lines.extend(["", "`default_nettype none", ""].map(str::to_owned));
        lines.push(format!("module {} (", file.strip_suffix(".v").unwrap_or(file)));
        lines.extend(self.ports(description, &body.wires)?);
        lines.push(");".to_owned());
        lines.extend(self.declarations(&symbols, &body.wires)?);
        lines.append(&mut body.lines);
        if !description.unused.is_empty() {
            let names: Result<Vec<_>, _> = description.unused.iter().map(|name| symbol(&symbols, name)).collect();
            let names: Vec<&str> = names?.iter().map(|symbol| symbol.name.as_str()).collect();
            lines.extend(["", "    // Bits left unread on purpose."].map(str::to_owned));
            lines.push(format!("    wire _unused = &{{1'b0, {}}};", names.join(", ")));
        }
        lines.extend(["", "endmodule", "", "`default_nettype wire", ""].map(str::to_owned));
        Ok(lines.join("\n"))
    }

    fn named(&self, wanted: impl Fn(&Part) -> bool) -> BTreeSet<String> {
        self.atoms.iter().filter(|part| wanted(part)).map(|part| part.name.clone()).collect()
    }

    /// What the kernel has to give a value.
    fn driven(&self) -> BTreeSet<String> {
        self.named(|part| match part.kind {
            AtomKind::OutputParameter | AtomKind::LocalSignal => true,
            _ => part.name.ends_with("$d"),
        })
    }

    /// The Verilog name of every atom, a register's for both its ends; an error if two would share one.
    fn symbols(&self) -> Result<Symbols, String> {
        let mut symbols = Symbols::new();
        let mut taken = BTreeSet::new();
        for atom in &self.atoms {
            let name = match atom.name.split_once('$') {
                // An element of an array stands as its value where it is used.
                Some(_) if atom.kind == AtomKind::Constant => {
                    let name = constant(&atom.literal, atom.value)?;
                    symbols.insert(atom.name.clone(), Symbol { name, kind: atom.value });
                    continue;
                }
                None if atom.kind == AtomKind::Constant => atom.name.to_uppercase(),
                Some((register, "d" | "q")) => register.to_owned(),
                Some((_, "clock")) => continue,
                Some(_) => return Err(format!("`{}` is a signal array", atom.name)),
                None => atom.name.clone(),
            };
            if !taken.insert(name.clone()) && !atom.name.ends_with("$q") {
                return Err(format!("two signals would be called `{name}`"));
            }
            symbols.insert(atom.name.clone(), Symbol { name, kind: atom.value });
        }
        Ok(symbols)
    }

    fn ports(&self, description: &Description, wires: &BTreeSet<String>) -> Result<Vec<String>, String> {
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
                AtomKind::OutputParameter if wires.contains(&port.name) => {
                    format!("output wire {}{}", range(port.value), port.name)
                }
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

    fn declarations(&self, symbols: &Symbols, wires: &BTreeSet<String>) -> Result<Vec<String>, String> {
        let (mut constants, mut registers, mut signals) = (Vec::new(), Vec::new(), Vec::new());
        for atom in &self.atoms {
            let Some(Symbol { name, kind }) = symbols.get(&atom.name) else { continue };
            let range = range(*kind);
            match atom.kind {
                AtomKind::Constant if atom.name.contains('$') => {}
                AtomKind::Constant => {
                    let value = constant(&atom.literal, *kind)?;
                    constants.push(format!("    localparam {range}{name} = {value};"));
                }
                AtomKind::LocalSignal if wires.contains(&atom.name) => {}
                AtomKind::LocalSignal => signals.push(format!("    reg {range}{name};")),
                AtomKind::StubInputSignal if atom.name.ends_with("$q") => {
                    registers.push(format!("    reg {range}{name};"));
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
