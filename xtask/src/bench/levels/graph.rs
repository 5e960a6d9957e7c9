//! A netlist's nets as a graph: what ways lead through, where they begin and end.

use std::collections::HashMap;

use super::netlist::{Bit, CONSTANT, Cell, Module, Netlist, Role, is_address, role};

/// A net of the whole design.
pub type Net = u32;

/// From a net to another, in so many levels.
#[derive(Clone, Copy, Debug)]
pub struct Arc {
    pub from: Net,
    pub to: Net,
    pub levels: u32,
}

/// Where ways begin or end: a net at a cell.
#[derive(Clone, Debug)]
pub struct End {
    pub net: Net,
    /// Levels that a way begins with.
    pub levels: u32,
    /// Of the instance that holds the cell, in [`Graph::instances`].
    pub instance: usize,
    /// What the cell is called.
    pub name: String,
}

/// An instance of a module.
#[derive(Clone, Debug)]
pub struct Instance {
    /// From the top on, with dots.
    pub path: String,
    /// The module's name as Yosys has it.
    pub module: String,
    /// The instance that it stands in.
    pub parent: Option<usize>,
}

/// A design without hierarchy.
#[derive(Debug, Default)]
pub struct Graph {
    pub instances: Vec<Instance>,
    pub arcs: Vec<Arc>,
    pub begins: Vec<End>,
    pub ends: Vec<End>,
    /// Of each net as numbered while it was put together, the one that it is joined to.
    joined: Vec<Net>,
}

/// A cell of a kind that nothing is known of.
#[derive(Debug)]
pub struct UnknownCell(pub String);

impl Graph {
    /// The design below `top`.
    ///
    /// # Errors
    /// [`UnknownCell`] if a cell is neither one of UltraScale+ nor a module of the netlist.
    pub fn new(netlist: &Netlist, top: &str) -> Result<Self, UnknownCell> {
        let mut graph = Self::default();
        let module = netlist.modules.get(top).ok_or_else(|| UnknownCell(top.to_owned()))?;
        let mut names = HashMap::new();
        graph.add(netlist, top, module, "", None, &mut names)?;
        for index in 0..graph.joined.len() {
            graph.joined[index] = graph.root(index as Net);
        }
        let Self { arcs, begins, ends, joined, .. } = &mut graph;
        for arc in arcs {
            (arc.from, arc.to) = (joined[arc.from as usize], joined[arc.to as usize]);
        }
        for end in begins.iter_mut().chain(ends) {
            end.net = joined[end.net as usize];
        }
        Ok(graph)
    }

    /// So many nets.
    pub fn nets(&self) -> usize {
        self.joined.len()
    }

    fn root(&mut self, mut net: Net) -> Net {
        while self.joined[net as usize] != net {
            let next = self.joined[net as usize];
            self.joined[net as usize] = self.joined[next as usize];
            net = next;
        }
        net
    }

    /// Adds an instance with all that is in it; returns the number of its first net.
    fn add<'a>(
        &mut self,
        netlist: &'a Netlist,
        kind: &'a str,
        module: &'a Module,
        path: &str,
        parent: Option<usize>,
        names: &mut HashMap<&'a str, HashMap<Bit, String>>,
    ) -> Result<Net, UnknownCell> {
        let first = self.joined.len() as Net;
        self.joined.extend(first..first + module.size());
        let instance = self.instances.len();
        self.instances.push(Instance { path: path.to_owned(), module: kind.to_owned(), parent });
        names.entry(kind).or_insert_with(|| module.names());
        for (name, cell) in &module.cells {
            if let Some(role) = role(&cell.kind) {
                let named = cell.output().and_then(|bit| names.get(kind)?.get(&bit));
                let called = if role == Role::Register { named.unwrap_or(name) } else { name };
                self.leaf(cell, role, first, instance, called);
                continue;
            }
            let inner = netlist.modules.get(&cell.kind).ok_or_else(|| UnknownCell(cell.kind.clone()))?;
            let below = if path.is_empty() { name.clone() } else { format!("{path}.{name}") };
            let inner_first = self.add(netlist, &cell.kind, inner, &below, Some(instance), names)?;
            for (port, nets) in &cell.connections {
                let inside = inner.ports.get(port).map(|port| port.bits.as_slice()).unwrap_or_default();
                for (&outer, &inner) in nets.0.iter().zip(inside) {
                    if outer != CONSTANT && inner != CONSTANT {
                        let [outer, inner] = [self.root(first + outer), self.root(inner_first + inner)];
                        self.joined[inner as usize] = outer;
                    }
                }
            }
        }
        Ok(first)
    }

    fn leaf(&mut self, cell: &Cell, role: Role, first: Net, instance: usize, name: &str) {
        let of = |output: bool| {
            let ports = cell.connections.iter();
            let ports = ports.filter(move |(port, _)| {
                (cell.port_directions.get(*port).is_some_and(|way| way == "output")) == output
            });
            ports
                .flat_map(|(port, nets)| {
                    nets.0.iter().enumerate().map(move |(index, &bit)| (port.as_str(), index, bit))
                })
                .filter(|&(.., bit)| bit != CONSTANT)
                .map(move |(port, index, bit)| (port, index, first + bit))
        };
        let end = |net: Net, levels: u32| End { net, levels, instance, name: name.to_owned() };
        match role {
            Role::Source => {}
            Role::Logic(levels) => {
                self.arcs
                    .extend(of(false).flat_map(|(.., from)| of(true).map(move |(.., to)| Arc { from, to, levels })));
            }
            Role::Carry => {
                for (input, low, from) in of(false) {
                    // A sum has its own bit's propagation and what is carried from those below.
                    let reaches = |output: &str, high: usize| match input {
                        "DI" => {
                            if output == "O" {
                                high > low
                            } else {
                                high >= low
                            }
                        }
                        "S" => high >= low,
                        _ => true,
                    };
                    let levels = u32::from(input != "CI");
                    let arcs = of(true).filter(|&(output, high, _)| reaches(output, high));
                    self.arcs.extend(arcs.map(|(.., to)| Arc { from, to, levels }));
                }
            }
            Role::Register | Role::Slow | Role::LutMemory => {
                let late = u32::from(role != Role::Register);
                self.begins.extend(of(true).map(|(.., net)| end(net, late)));
                self.ends.extend(of(false).map(|(.., net)| end(net, 0)));
                if role == Role::LutMemory {
                    let addresses = of(false).filter(|&(port, ..)| is_address(port));
                    let arcs =
                        addresses.flat_map(|(.., from)| of(true).map(move |(.., to)| Arc { from, to, levels: 1 }));
                    self.arcs.extend(arcs);
                }
            }
        }
    }
}

impl Cell {
    /// The first net that it drives.
    fn output(&self) -> Option<Bit> {
        let (port, _) = self.port_directions.iter().find(|(_, way)| *way == "output")?;
        self.connections.get(port)?.0.first().copied()
    }
}
