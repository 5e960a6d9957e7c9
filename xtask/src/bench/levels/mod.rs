//! Levels of logic between registers, by block, from Yosys' netlist, and the record that no block may exceed.
//!
//! A level is a LUT with the net in front of it, as AMD's `report_failfast` counts (Vivado's Tcl store, `designutils`), which
//! gives it 0.300 ns on `UltraScale+` of speed grade 2; a carry chain is one more here, and a way that begins at a block
//! memory, a multiplier or a memory made of LUTs begins with one.

mod graph;
mod netlist;

use std::collections::BTreeMap;
use std::path::Path;

use serde::{Deserialize, Serialize};

use self::graph::{End, Graph};
use self::netlist::Netlist;
use super::{BenchError, read_json};

/// The longest way that ends in a block.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub struct Longest {
    /// Its levels.
    pub levels: u32,
    /// Where it begins.
    pub from: String,
    /// Where it ends.
    pub to: String,
}

/// Levels by design and block, as they were recorded.
#[derive(Clone, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[serde(transparent)]
pub struct Record(BTreeMap<String, BTreeMap<String, u32>>);

/// The longest way into each block: `block` says of a module's name which block it begins, what is within no block counts
/// for block `rest`.
///
/// # Errors
/// [`BenchError::Read`] and [`BenchError::Json`]; [`BenchError::UnknownCell`] if the netlist is of another device;
/// [`BenchError::Loop`] if a way of logic comes back to where it began.
pub fn longest(
    path: &Path,
    top: &str,
    rest: usize,
    block: impl Fn(&str) -> Option<usize>,
) -> Result<Vec<Option<Longest>>, BenchError> {
    let netlist: Netlist = read_json(path)?;
    let unknown = |graph::UnknownCell(cell)| BenchError::UnknownCell { path: path.to_owned(), cell };
    let graph = Graph::new(&netlist, top).map_err(unknown)?;
    let arrivals = arrivals(&graph).ok_or_else(|| BenchError::Loop { path: path.to_owned() })?;
    let mut blocks: Vec<usize> = Vec::with_capacity(graph.instances.len());
    for instance in &graph.instances {
        let parent = instance.parent.map_or(rest, |parent| blocks[parent]);
        blocks.push(block(&instance.module).unwrap_or(parent));
    }
    let mut found: Vec<Option<(Arrival, &End)>> = vec![None; rest + 1];
    for end in &graph.ends {
        let Some(arrival) = arrivals[end.net as usize] else { continue };
        let place = &mut found[blocks[end.instance]];
        if place.is_none_or(|(longest, _)| arrival.levels > longest.levels) {
            *place = Some((arrival, end));
        }
    }
    let called = |end: &End| match graph.instances[end.instance].path.as_str() {
        "" => end.name.clone(),
        path => format!("{path}.{}", end.name),
    };
    let longest = |(Arrival { levels, begin }, end): (Arrival, &End)| Longest {
        levels,
        from: called(&graph.begins[begin as usize]),
        to: called(end),
    };
    Ok(found.into_iter().map(|way| way.map(longest)).collect())
}

/// The longest way to a net, and where it began.
#[derive(Clone, Copy, Debug)]
struct Arrival {
    levels: u32,
    begin: u32,
}

/// Of each net that a way leads to; nothing if ways go in a circle.
fn arrivals(graph: &Graph) -> Option<Vec<Option<Arrival>>> {
    let nets = graph.nets();
    let mut arrivals: Vec<Option<Arrival>> = vec![None; nets];
    for (begin, end) in graph.begins.iter().enumerate() {
        arrivals[end.net as usize] = Some(Arrival { levels: end.levels, begin: begin as u32 });
    }
    let mut waits = vec![0_u32; nets];
    let mut first = vec![0_usize; nets + 1];
    for arc in &graph.arcs {
        waits[arc.to as usize] += 1;
        first[arc.from as usize + 1] += 1;
    }
    for net in 0..nets {
        first[net + 1] += first[net];
    }
    let mut next = first.clone();
    let mut order = vec![0_usize; graph.arcs.len()];
    for (index, arc) in graph.arcs.iter().enumerate() {
        order[next[arc.from as usize]] = index;
        next[arc.from as usize] += 1;
    }
    let mut known: Vec<u32> = (0..nets as u32).filter(|&net| waits[net as usize] == 0).collect();
    let mut passed = 0;
    while let Some(net) = known.pop() {
        for &index in &order[first[net as usize]..first[net as usize + 1]] {
            let arc = graph.arcs[index];
            let to = arc.to as usize;
            passed += 1;
            if let Some(Arrival { levels, begin }) = arrivals[net as usize] {
                let levels = levels + arc.levels;
                if arrivals[to].is_none_or(|other| levels > other.levels) {
                    arrivals[to] = Some(Arrival { levels, begin });
                }
            }
            waits[to] -= 1;
            if waits[to] == 0 {
                known.push(arc.to);
            }
        }
    }
    (passed == graph.arcs.len()).then_some(arrivals)
}

impl Record {
    /// Reads a record.
    ///
    /// # Errors
    /// [`BenchError::Read`] and [`BenchError::Record`].
    pub fn read(path: &Path) -> Result<Self, BenchError> {
        let text =
            std::fs::read_to_string(path).map_err(|source| BenchError::Read { path: path.to_owned(), source })?;
        toml::from_str(&text).map_err(|source| BenchError::Record { path: path.to_owned(), source: Box::new(source) })
    }

    /// What is wrong with these blocks of a design: those that are longer than recorded, or not in the record. Nothing if
    /// the design is not in it.
    pub fn exceeded<'a>(&self, design: &str, blocks: impl Iterator<Item = (&'a str, &'a Longest)>) -> Vec<String> {
        let Some(recorded) = self.0.get(design) else { return Vec::new() };
        blocks
            .filter_map(|(block, way)| {
                let was = match recorded.get(block) {
                    Some(&bound) if way.levels <= bound => return None,
                    Some(bound) => format!("{bound} recorded"),
                    None => "none recorded".to_owned(),
                };
                Some(format!("{block}: {} levels, {was}, from {} to {}", way.levels, way.from, way.to))
            })
            .collect()
    }

    /// Puts these blocks in the place of what the record has of a design.
    pub fn set<'a>(&mut self, design: &str, blocks: impl Iterator<Item = (&'a str, &'a Longest)>) {
        let blocks = blocks.map(|(block, way)| (block.to_owned(), way.levels)).collect();
        self.0.insert(design.to_owned(), blocks);
    }

    /// As a file.
    pub fn text(&self) -> String {
        let header = "# Levels of logic of the longest way into each block, by Yosys: tools/synth.py compares, and with RECORD=1 writes.\n";
        header.to_owned() + &toml::to_string(&self.0).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A register, a LUT, an instance with a LUT in front of a carry chain of two cells, a register; and back by a block memory.
    const NETLIST: &str = r#"{ "modules": {
        "top": { "ports": { "clock": { "bits": [2] } }, "cells": {
            "a": { "type": "FDRE", "port_directions": { "C": "input", "D": "input", "Q": "output" },
                "connections": { "C": [2], "D": [9], "Q": [3] } },
            "l": { "type": "LUT2", "port_directions": { "I0": "input", "I1": "input", "O": "output" },
                "connections": { "I0": [3], "I1": ["1"], "O": [4] } },
            "sum": { "type": "$paramod\\sptfra_sum\\W=1", "connections": { "x": [4], "y": [5] } },
            "b": { "type": "FDRE", "port_directions": { "C": "input", "D": "input", "Q": "output" },
                "connections": { "C": [2], "D": [5], "Q": [6] } },
            "m": { "type": "RAMB18E2", "port_directions": { "ADDR": "input", "DOUT": "output" },
                "connections": { "ADDR": [6], "DOUT": [7] } },
            "n": { "type": "INV", "port_directions": { "I": "input", "O": "output" },
                "connections": { "I": [7], "O": [9] } } },
          "netnames": { "state": { "hide_name": 0, "bits": [3, 6] }, "made": { "hide_name": 1, "bits": [4] } } },
        "$paramod\\sptfra_sum\\W=1": { "ports": { "x": { "bits": [2] }, "y": { "bits": [9] } }, "cells": {
            "s": { "type": "LUT1", "port_directions": { "I0": "input", "O": "output" },
                "connections": { "I0": [2], "O": [3] } },
            "c0": { "type": "CARRY4", "port_directions": { "CI": "input", "S": "input", "O": "output", "CO": "output" },
                "connections": { "CI": ["0"], "S": [3], "O": [4], "CO": [5, 6, 7, 8] } },
            "c1": { "type": "CARRY4", "port_directions": { "CI": "input", "S": "input", "O": "output", "CO": "output" },
                "connections": { "CI": [8], "S": ["x"], "O": [9], "CO": [10, 11, 12, 13] } } } },
        "LUT2": { "ports": {} } } }"#;

    fn ways(netlist: &str) -> Result<Vec<Option<Longest>>, BenchError> {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("netlist.json");
        std::fs::write(&path, netlist).expect("written");
        longest(&path, "top", 1, |module| module.contains("sptfra_sum").then_some(0))
    }

    #[test]
    fn luts_and_carry_chains_are_levels_and_ways_pass_instances() {
        let way = Longest { levels: 3, from: "state[0]".to_owned(), to: "state[1]".to_owned() };
        assert_eq!(ways(NETLIST).expect("read"), [None, Some(way)]);
        // From the block memory to the first register: its late output, and an inverter that is none.
        let late = NETLIST.replace(r#""I0": [3], "I1""#, r#""I0": ["0"], "I1""#);
        let way = Longest { levels: 1, from: "m".to_owned(), to: "state[0]".to_owned() };
        assert_eq!(ways(&late).expect("read")[1], Some(way));
    }

    #[test]
    fn circles_and_cells_of_another_device_are_refused() {
        let circle = NETLIST.replace(r#""I1": ["1"]"#, r#""I1": [5]"#);
        assert!(ways(&circle).expect_err("a circle").to_string().contains("comes back to where it began"));
        let other = NETLIST.replace("CARRY4", "CCU2C");
        assert!(ways(&other).expect_err("ECP5").to_string().contains("`CCU2C`"));
    }

    #[test]
    fn a_block_that_is_longer_than_recorded_is_named_with_its_way() {
        let mut record = Record::default();
        let way = |levels| Longest { levels, from: "a".to_owned(), to: "b".to_owned() };
        record.set("t", [("We", &way(3))].into_iter());
        let read: Record = toml::from_str(&record.text()).expect("its own text");
        assert_eq!(read, record);
        assert!(record.exceeded("t", [("We", &way(3))].into_iter()).is_empty());
        assert!(record.exceeded("another", [("We", &way(9))].into_iter()).is_empty());
        let said = record.exceeded("t", [("We", &way(4)), ("Bz", &way(1))].into_iter());
        assert_eq!(said, ["We: 4 levels, 3 recorded, from a to b", "Bz: 1 levels, none recorded, from a to b"]);
    }
}
