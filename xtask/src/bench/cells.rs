//! Yosys' cell counts of a generated design, by block, beside the generator's prediction.

use std::collections::BTreeMap;
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::levels::{self, Longest, Record};
use super::{BenchError, read_json};
use golden::table::Table;
use testbench::figures::{decimals, grouped};

/// Name of what is in no predicted block: stream buffers, program scheduler, registers between the blocks.
const REST: &str = "rest";

/// Cells of a block or of a design.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize, Serialize)]
pub struct Count {
    /// DSP48E2.
    pub dsp: u64,
    /// RAMB36; a RAMB18 counts one half.
    pub bram36: f64,
    /// LUTs, those used as RAM and as shift register too.
    pub lut: u64,
    /// Flip-flops.
    pub ff: u64,
}

/// A prediction.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize, Serialize)]
pub struct Expected {
    /// DSP48E2.
    pub dsp: u64,
    /// RAMB36; a RAMB18 counts one half.
    pub bram36: f64,
}

/// One block.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct Block {
    /// As `metadata.json` calls it.
    pub name: String,
    /// Found by Yosys.
    pub yosys: Count,
    /// Predicted.
    pub predicted: Expected,
    /// The longest way of logic that ends in it, if a netlist was read and there is one.
    #[serde(default)]
    pub longest: Option<Longest>,
}

/// One design.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct Cells {
    /// The design file.
    pub file: String,
    /// The design's name.
    pub design: String,
    /// Its hash.
    pub hash: String,
    /// Block by block.
    pub blocks: Vec<Block>,
    /// All together.
    pub total: Block,
}

/// Reads what [`count`] found before.
///
/// # Errors
/// [`BenchError::Read`] and [`BenchError::Json`].
pub fn read(path: &Path) -> Result<Cells, BenchError> {
    read_json(path)
}

#[derive(Deserialize)]
struct Metadata {
    top: String,
    design_hash: String,
    predicted: MetadataPrediction,
}

#[derive(Deserialize)]
struct MetadataPrediction {
    dsp: u64,
    bram36: f64,
    blocks: Vec<MetadataBlock>,
}

#[derive(Deserialize)]
struct MetadataBlock {
    name: String,
    modules: Vec<String>,
    dsp: u64,
    bram36: f64,
}

#[derive(Deserialize)]
struct Statistics {
    modules: BTreeMap<String, Module>,
}

#[derive(Deserialize)]
struct Module {
    num_cells_by_type: BTreeMap<String, u64>,
}

/// Sums, for the design of `file`, Yosys' `stat -json` of a synthesis that was not flattened by the blocks of its
/// `metadata.json`, and counts levels of logic in its netlist.
///
/// # Errors
/// [`BenchError::Read`] and [`BenchError::Json`]; [`BenchError::NoModule`] if the files are of different designs; those of
/// [`levels::longest`].
pub fn count(file: &Path, metadata: &Path, statistics: &Path, netlist: Option<&Path>) -> Result<Cells, BenchError> {
    let Metadata { top, design_hash: hash, predicted } = read_json(metadata)?;
    let place =
        |module: &str| predicted.blocks.iter().position(|block| block.modules.iter().any(|name| name == module));
    let rest = predicted.blocks.len();
    let counts = by_module(&top, statistics, rest, place)?;
    let of_rest = MetadataBlock { name: REST.to_owned(), modules: Vec::new(), dsp: 0, bram36: 0.0 };
    let mut blocks: Vec<Block> = predicted
        .blocks
        .iter()
        .chain([&of_rest])
        .zip(counts)
        .map(|(block, yosys)| Block {
            name: block.name.clone(),
            yosys,
            predicted: Expected { dsp: block.dsp, bram36: block.bram36 },
            longest: None,
        })
        .collect();
    if let Some(netlist) = netlist {
        let ways = levels::longest(netlist, &top, rest, |module| place(base_name(module)))?;
        for (block, way) in blocks.iter_mut().zip(ways) {
            block.longest = way;
        }
    }
    let mut total = Count::default();
    for Block { yosys, .. } in &blocks {
        total.dsp += yosys.dsp;
        total.bram36 += yosys.bram36;
        total.lut += yosys.lut;
        total.ff += yosys.ff;
    }
    let predicted = Expected { dsp: predicted.dsp, bram36: predicted.bram36 };
    let file = file.display().to_string();
    let longest = blocks.iter().filter_map(|block| block.longest.clone()).max_by_key(|way| way.levels);
    Ok(Cells {
        file,
        design: top,
        hash,
        blocks,
        total: Block { name: "all".to_owned(), yosys: total, predicted, longest },
    })
}

/// Sums Yosys' `stat -json` of a synthesis that was not flattened by the places of its modules. What has no place counts
/// for the module that instantiates it, at the top for the rest.
///
/// # Errors
/// [`BenchError::Read`] and [`BenchError::Json`]; [`BenchError::NoModule`] if the statistics are of another design.
pub fn by_module(
    top: &str,
    statistics: &Path,
    rest: usize,
    place: impl Fn(&str) -> Option<usize>,
) -> Result<Vec<Count>, BenchError> {
    let path = statistics;
    let statistics: Statistics = read_json(path)?;
    let mut counts = vec![Count::default(); rest + 1];
    // A module with the place of the one that instantiates it, and how often it is there.
    let mut waiting = vec![(top.to_owned(), rest, 1)];
    while let Some((key, parent, times)) = waiting.pop() {
        let Some(module) = statistics.module(&key) else {
            return Err(BenchError::NoModule { path: path.to_owned(), module: key });
        };
        let own = place(base_name(&key)).unwrap_or(parent);
        for (kind, &number) in &module.num_cells_by_type {
            if statistics.module(kind).is_some() {
                waiting.push((kind.clone(), own, times * number));
            } else {
                counts[own].add(kind, times * number);
            }
        }
    }
    Ok(counts)
}

impl Statistics {
    /// A module by the name that a cell has as its type, or by its own.
    fn module(&self, name: &str) -> Option<&Module> {
        self.modules.get(name).or_else(|| self.modules.get(&format!("\\{name}")))
    }
}

/// The module's name in the Verilog. With parameters that are not its own it is called `$paramod$HASH\NAME`, or
/// `$paramod\NAME\P=…` where that is short, once for each set of values.
fn base_name(name: &str) -> &str {
    name.split('\\').nth(1).unwrap_or(name)
}

impl Count {
    fn add(&mut self, kind: &str, number: u64) {
        match kind {
            "DSP48E2" => self.dsp += number,
            "RAMB36E2" => self.bram36 += number as f64,
            "RAMB18E2" => self.bram36 += number as f64 / 2.0,
            "RAM32M16" | "RAM64M8" | "RAM32X16DR8" | "RAM64X8SW" | "RAM512X1S" => self.lut += 8 * number,
            "RAM256X1S" | "RAM256X1D" => self.lut += 4 * number,
            _ if kind.starts_with("LUT") || kind.starts_with("SRL") || kind.starts_with("RAM") => self.lut += number,
            _ if kind.starts_with("FD") => self.ff += number,
            // Carry chains, wide multiplexers and inverters, which take no LUT of their own.
            _ => {}
        }
    }
}

impl Cells {
    /// Block by block, then all of it; `title` stands above the names.
    pub fn table(&self, title: &str) -> Table {
        let header = [title, "DSP", "predicted", "RAMB36", "predicted", "LUT", "FF", "levels"];
        Table::new(header).with(self.blocks.iter().chain([&self.total]).map(
            |Block { name, yosys, predicted, longest }| {
                [
                    name.clone(),
                    grouped(yosys.dsp),
                    grouped(predicted.dsp),
                    decimals(yosys.bram36, 1),
                    decimals(predicted.bram36, 1),
                    grouped(yosys.lut),
                    grouped(yosys.ff),
                    longest.as_ref().map_or_else(String::new, |way| way.levels.to_string()),
                ]
            },
        ))
    }

    fn ways(&self) -> impl Iterator<Item = (&str, &Longest)> {
        self.blocks.iter().filter_map(|block| Some((block.name.as_str(), block.longest.as_ref()?)))
    }

    /// Compares the levels of logic with those in the record, or writes them there.
    ///
    /// # Errors
    /// [`BenchError::Longer`] names the blocks that have got longer; those of reading and writing the record.
    pub fn hold_to(&self, path: &Path, write: bool) -> Result<(), BenchError> {
        let mut record = Record::read(path)?;
        if write {
            record.set(&self.design, self.ways());
            let failed = |source| BenchError::Write { path: path.to_owned(), source };
            return std::fs::write(path, record.text()).map_err(failed);
        }
        let blocks = record.exceeded(&self.design, self.ways());
        let longer =
            || BenchError::Longer { design: self.design.clone(), path: path.to_owned(), blocks: blocks.clone() };
        if blocks.is_empty() { Ok(()) } else { Err(longer()) }
    }

    /// Where the longest ways lead, block by block, the longest first.
    pub fn longest_ways(&self) -> Table {
        let mut ways: Vec<(&str, &Longest)> = self.ways().collect();
        ways.sort_by_key(|(_, way)| std::cmp::Reverse(way.levels));
        let row = |(block, way): (&str, &Longest)| {
            [block.to_owned(), way.levels.to_string(), way.from.clone(), way.to.clone()]
        };
        Table::new(["longest way into", "levels", "from", "to"]).with(ways.into_iter().map(row))
    }

    /// The blocks whose multipliers or memories Yosys counts otherwise.
    pub fn not_as_predicted(&self) -> Vec<&str> {
        let differ = |block: &&Block| {
            block.yosys.dsp != block.predicted.dsp || (block.yosys.bram36 - block.predicted.bram36).abs() > 1e-9
        };
        self.blocks.iter().filter(differ).map(|block| block.name.as_str()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const METADATA: &str = r#"{ "top": "t", "design_hash": "0", "predicted": { "dsp": 3, "bram36": 1.0, "blocks": [
        { "name": "lanes", "modules": ["sptfra_spmv_array"], "dsp": 2, "bram36": 1.0 },
        { "name": "field", "modules": ["sptfra_field"], "dsp": 1, "bram36": 0.0 } ] } }"#;
    const STATISTICS: &str = r#"{ "modules": {
        "\\t": { "num_cells_by_type": { "LUT2": 3, "$paramod$1\\sptfra_spmv_array": 1, "sptfra_field": 1 } },
        "$paramod$1\\sptfra_spmv_array": { "num_cells_by_type": { "sptfra_mac": 2, "RAMB18E2": 3, "$paramod\\ram\\W=s'1": 1 } },
        "$paramod\\ram\\W=s'1": { "num_cells_by_type": { "RAM64M8": 2 } },
        "\\sptfra_field": { "num_cells_by_type": { "sptfra_mac": 1 } },
        "\\sptfra_mac": { "num_cells_by_type": { "DSP48E2": 1, "FDRE": 5, "CARRY4": 2 } } } }"#;

    #[test]
    fn cells_go_to_the_block_that_holds_them() {
        let folder = tempfile::tempdir().expect("a folder");
        let [metadata, statistics] = ["m.json", "s.json"].map(|name| folder.path().join(name));
        std::fs::write(&metadata, METADATA).expect("written");
        std::fs::write(&statistics, STATISTICS).expect("written");
        let cells = count(Path::new("t.toml"), &metadata, &statistics, None).expect("counted");
        let lanes = Count { dsp: 2, bram36: 1.5, lut: 16, ff: 10 };
        let found: Vec<(&str, Count)> = cells.blocks.iter().map(|block| (block.name.as_str(), block.yosys)).collect();
        assert_eq!(found[0], ("lanes", lanes));
        assert_eq!(found[1], ("field", Count { dsp: 1, bram36: 0.0, lut: 0, ff: 5 }));
        assert_eq!(found[2], (REST, Count { lut: 3, ..Count::default() }));
        assert_eq!(cells.total.yosys, Count { dsp: 3, bram36: 1.5, lut: 19, ff: 15 });
        let table = cells.table("t").text(0, 0);
        assert!(table.contains("\n  lanes    2          2     1.5        1.0   16  10\n"), "{table}");
        std::fs::write(&statistics, STATISTICS.replace("\\\\t\"", "\\\\u\"")).expect("written");
        assert!(
            count(Path::new("t.toml"), &metadata, &statistics, None)
                .expect_err("another design")
                .to_string()
                .contains("`t`")
        );
    }
}
