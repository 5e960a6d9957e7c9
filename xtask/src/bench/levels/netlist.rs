//! Yosys' netlist of a synthesis that was not flattened, and what its cells do to a signal.

use std::collections::{BTreeMap, HashMap};
use std::fmt;

use serde::de::{self, Deserializer, Visitor};
use serde::{Deserialize, Serialize};

/// A net's number within its module; of a constant [`CONSTANT`].
pub type Bit = u32;
/// What a bit that is 0, 1 or undefined has in place of a number.
pub const CONSTANT: Bit = 0;

/// `write_json`'s modules by their names.
#[derive(Debug, Deserialize)]
pub struct Netlist {
    /// Also Yosys' own models of cells, without contents.
    pub modules: HashMap<String, Module>,
}

/// One module.
#[derive(Debug, Deserialize)]
pub struct Module {
    /// By name.
    pub ports: BTreeMap<String, Port>,
    /// By name.
    #[serde(default)]
    pub cells: BTreeMap<String, Cell>,
    /// By name: what registers are called by.
    #[serde(default)]
    pub netnames: BTreeMap<String, Name>,
}

/// Nets of a port.
#[derive(Debug, Deserialize)]
pub struct Port {
    /// The lowest bit first.
    #[serde(deserialize_with = "bits")]
    pub bits: Vec<Bit>,
}

/// Nets that have a name.
#[derive(Debug, Deserialize)]
pub struct Name {
    /// Not 0 if Yosys has made it up.
    pub hide_name: u8,
    /// The lowest bit first.
    #[serde(deserialize_with = "bits")]
    pub bits: Vec<Bit>,
}

/// A cell, or an instance of a module.
#[derive(Debug, Deserialize)]
pub struct Cell {
    /// What it is.
    #[serde(rename = "type")]
    pub kind: String,
    /// `input` or `output`.
    #[serde(default)]
    pub port_directions: BTreeMap<String, String>,
    /// Nets by port.
    pub connections: BTreeMap<String, Nets>,
}

/// Nets of a cell's port, the lowest bit first.
#[derive(Debug, Deserialize)]
pub struct Nets(#[serde(deserialize_with = "bits")] pub Vec<Bit>);

fn bits<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<Bit>, D::Error> {
    let bits = Vec::<AnyBit>::deserialize(deserializer)?;
    Ok(bits.into_iter().map(|AnyBit(bit)| bit).collect())
}

struct AnyBit(Bit);

impl<'de> Deserialize<'de> for AnyBit {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Either;
        impl Visitor<'_> for Either {
            type Value = AnyBit;
            fn expecting(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
                out.write_str("a net's number or a constant")
            }
            fn visit_u64<E: de::Error>(self, bit: u64) -> Result<AnyBit, E> {
                u32::try_from(bit).map(AnyBit).map_err(E::custom)
            }
            fn visit_str<E: de::Error>(self, _: &str) -> Result<AnyBit, E> {
                Ok(AnyBit(CONSTANT))
            }
        }
        deserializer.deserialize_any(Either)
    }
}

/// What a cell of UltraScale+ does to the ways through it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Role {
    /// From each input to each output in so many levels.
    Logic(u32),
    /// Eight or four bits of a carry: a level from beside the chain, none along it.
    Carry,
    /// Ways end at its inputs and begin at its outputs.
    Register,
    /// The same, but its output comes so late that a way begins with a level: block memories and multipliers.
    Slow,
    /// Memory made of LUTs: ways end at its inputs and begin at its outputs with a level, and lead from its address through.
    LutMemory,
    /// A constant.
    Source,
}

/// What a cell does, if it is known.
pub fn role(kind: &str) -> Option<Role> {
    Some(match kind {
        // An inverter goes into a neighbour's function, a wide multiplexer stands beside its LUTs.
        "INV" | "BUFG" | "BUFGCE" | "MUXF7" | "MUXF8" | "MUXF9" => Role::Logic(0),
        "CARRY4" | "CARRY8" => Role::Carry,
        "GND" | "VCC" => Role::Source,
        _ if kind.starts_with("LUT") => Role::Logic(1),
        _ if kind.starts_with("FD") || kind.starts_with("LD") => Role::Register,
        _ if kind.starts_with("DSP") || kind.starts_with("RAMB") => Role::Slow,
        _ if kind.starts_with("SRL") || kind.starts_with("RAM") => Role::LutMemory,
        _ => return None,
    })
}

/// Whether a port of a memory made of LUTs is its address.
pub fn is_address(port: &str) -> bool {
    port.starts_with('A') || port.starts_with("DPRA")
}

impl Module {
    /// Names of its nets, of those that have one of the design's.
    pub fn names(&self) -> HashMap<Bit, String> {
        let mut names = HashMap::new();
        for (name, nets) in self.netnames.iter().filter(|(_, nets)| nets.hide_name == 0) {
            for (index, &bit) in nets.bits.iter().enumerate().filter(|&(_, &bit)| bit != CONSTANT) {
                let of_bit = || if nets.bits.len() == 1 { name.clone() } else { format!("{name}[{index}]") };
                names.entry(bit).or_insert_with(of_bit);
            }
        }
        names
    }

    /// The largest number of a net, plus one.
    pub fn size(&self) -> u32 {
        let connected = self.cells.values().flat_map(|cell| cell.connections.values()).flat_map(|nets| &nets.0);
        let all = self.ports.values().flat_map(|port| &port.bits).chain(connected);
        all.max().map_or(1, |largest| largest + 1)
    }
}
