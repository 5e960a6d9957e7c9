//! The ROM files hold the matrices of the MCSR listings: both are read back as text and compared.

use std::collections::{BTreeMap, VecDeque};
use std::ops::Range;

use hdl_gen::emit::{FileMap, emit};
use hdl_gen::plan::Plan;
use hdl_gen::plan::matrix::{Entry, QuantisedMatrix};
use hdl_gen::plan::product::{SUM_ROWS, SUMS_DESTINATION, destination, mirror};
use proptest::prelude::*;
use serde_json::Value;

use crate::support::{any_design, design_text, plan};

/// Bits of a result's destination in a slot; resultants alone have fewer.
fn destination_bits(plan: &Plan) -> u32 {
    if plan.field_words() > 0 { 4 } else { 3 }
}

/// Rows of a column and its coefficients, one a channel.
type Rows = Vec<Vec<(u32, Vec<i32>)>>;

fn text<'a>(files: &'a FileMap, name: &str) -> &'a str {
    std::str::from_utf8(files.get(name).unwrap_or_else(|| panic!("no {name}"))).unwrap()
}

/// The words of a ROM file, each of exactly the digits that its width needs.
fn words(files: &FileMap, name: &str, bits: u32) -> Vec<u128> {
    let digits = bits.div_ceil(4) as usize;
    let word = |line: &str| {
        assert_eq!(line.len(), digits, "{name}: {line}");
        let word = u128::from_str_radix(line, 16).unwrap();
        assert!(word < 1 << bits, "{name}: {line}");
        word
    };
    if files.contains_key(name) {
        return text(files, name).lines().map(word).collect();
    }
    // A deep one, bank by bank.
    let bank = |bank: usize| name.replacen("rom/", &format!("rom/bank{bank:02}_"), 1);
    let banks = (0..).map(bank).take_while(|name| files.contains_key(name));
    let words: Vec<u128> = banks.flat_map(|name| text(files, &name).lines().map(word).collect::<Vec<_>>()).collect();
    assert!(words.len() > 4096, "no {name}");
    words
}

/// The coefficients in a word, that of channel 0 lowest.
fn channels(word: u128, channels: usize, bits: u32) -> Vec<i32> {
    let field = |channel: usize| (word >> (channel as u32 * bits)) as u32 & ((1 << bits) - 1);
    (0..channels).map(|channel| ((field(channel) << (32 - bits)) as i32) >> (32 - bits)).collect()
}

fn bits_for(count: usize) -> u32 {
    count.next_power_of_two().trailing_zeros().max(1)
}

struct Reader {
    values: Vec<u128>,
    columns: Vec<u128>,
    segments: Vec<u128>,
    /// Where each word was read.
    read: Vec<bool>,
    word: usize,
    marked: usize,
    segment: usize,
    /// `(product, row)` of each of its results.
    slots: VecDeque<(usize, usize)>,
}

impl Reader {
    /// The ROMs of all PEs.
    fn all(files: &FileMap, plan: &Plan) -> Vec<Self> {
        let (name, pes, elements) = (&plan.design.name, plan.pes(), plan.elements());
        let coefficient_bits = plan.design.hardware.coefficient_bits;
        let most_vectors = plan.products.iter().map(|product| product.operands.len()).max().unwrap();
        let row_bits = bits_for(elements.max(SUM_ROWS));
        let pe = |pe: usize| {
            let file = |kind: &str, bits| words(files, &format!("rom/{name}_{kind}_pe{pe:02}.mem"), bits);
            let values = file("values", plan.channels() as u32 * coefficient_bits);
            Self {
                read: vec![false; values.len()],
                values,
                columns: file("columns", bits_for(most_vectors * elements)),
                segments: file("macs", 16),
                word: 0,
                marked: 0,
                segment: 0,
                slots: VecDeque::new(),
            }
        };
        let mut readers: Vec<Self> = (0..pes).map(pe).collect();
        let destination_bits = destination_bits(plan);
        let below = destination_bits + row_bits;
        let slots = words(files, &format!("rom/{name}_slots.mem"), 1 + bits_for(pes) + below);
        let program_ends: Vec<usize> =
            plan.schedule.programs.iter().skip(1).map(|next| next.slot - 1).chain([slots.len() - 1]).collect();
        for (index, slot) in slots.into_iter().enumerate() {
            let field = |from: u32, bits: u32| (slot >> from) as usize & ((1 << bits) - 1);
            assert_eq!(slot >> (below + bits_for(pes)) == 1, program_ends.contains(&index), "last of its program");
            readers[field(below, bits_for(pes))]
                .slots
                .push_back((field(row_bits, destination_bits), field(0, row_bits)));
        }
        let depth = |get: fn(&Self) -> usize| readers.iter().all(|reader| get(reader) == get(&readers[0]));
        assert!(depth(|reader| reader.values.len()) && depth(|reader| reader.columns.len()));
        assert!(depth(|reader| reader.segments.len()));
        readers
    }
}

/// Every product's matrix, from the ROM files, the addresses of the programs and the cycle counts of the metadata; rows
/// of sums follow the product's own. Of a product that mirrors its matrix, row by row as they are stored.
fn matrices_in_roms(files: &FileMap, plan: &Plan) -> Vec<Rows> {
    let metadata: Value = serde_json::from_str(text(files, "metadata.json")).unwrap();
    let products = metadata["products"].as_array().unwrap();
    assert_eq!(products.len(), plan.products.len());
    let mut readers = Reader::all(files, plan);
    let mut matrices = Vec::new();
    for program in &plan.schedule.programs {
        for reader in &mut readers {
            (reader.word, reader.segment) = (program.word, program.segment);
        }
        for (index, product) in products.iter().enumerate().take(program.end).skip(program.first) {
            let uses = |range: Range<usize>| {
                plan.products[range].iter().any(|other| other.matrix == plan.products[index].matrix)
            };
            let (again, later) = (uses(program.first..index), uses(index + 1..program.end));
            for reader in &mut readers {
                if again {
                    reader.word = reader.marked;
                } else if later {
                    reader.marked = reader.word;
                }
            }
            let cycles = product["issue_cycles"].as_u64().unwrap();
            matrices.push(product_in_roms(&mut readers, plan, index, cycles));
        }
    }
    for reader in readers {
        assert!(reader.slots.is_empty());
        let unread = reader.read.iter().zip(reader.values.iter().zip(&reader.columns)).filter(|(read, _)| !**read);
        assert!(unread.into_iter().all(|(_, words)| words == (&0, &0)));
    }
    matrices
}

fn product_in_roms(readers: &mut [Reader], plan: &Plan, index: usize, cycles: u64) -> Rows {
    let product = &plan.products[index];
    let elements = plan.elements();
    let mut rows: Rows = vec![Vec::new(); elements + product.preload.map_or(0, |_| SUM_ROWS)];
    let mut open_head = None;
    for (pe, reader) in readers.iter_mut().enumerate() {
        let mut issued = 0;
        while issued < cycles {
            let segment = reader.segments[reader.segment];
            let (kind, macs) = (segment >> 14, (segment & 0x3fff) as usize);
            reader.segment += 1;
            issued += macs as u64;
            if kind == 3 {
                continue;
            }
            let row = if kind == 1 {
                open_head.take().expect("the PE before has begun this row")
            } else {
                let (to, row) = reader.slots.pop_front().expect("a slot for every result");
                let sums = to == SUMS_DESTINATION && product.preload.is_some();
                assert!(sums || to == destination(product.result), "{to} of {}", product.result.name());
                if sums { elements + row } else { product.mirrored.map_or(row, |side| mirror(row, side)) }
            };
            if kind == 2 {
                open_head = Some(row);
            }
            for word in reader.word..reader.word + macs {
                reader.read[word] = true;
                let coefficients =
                    channels(reader.values[word], plan.channels(), plan.design.hardware.coefficient_bits);
                rows[row].push((reader.columns[word] as u32, coefficients));
            }
            reader.word += macs;
        }
        assert_eq!(issued, cycles, "product {index}, PE {pe}");
    }
    assert!(open_head.is_none());
    // In the ROMs they stand in the order in which the PEs find their operands.
    for row in &mut rows {
        row.sort_by_key(|&(column, _)| column);
    }
    rows
}

/// The listings by the matrix's full name.
fn listings(files: &FileMap) -> BTreeMap<String, Rows> {
    let mut listings = BTreeMap::new();
    for name in files.keys().filter(|name| name.starts_with("mcsr/")) {
        let (comments, rows): (Vec<&str>, Vec<&str>) =
            text(files, name).lines().partition(|line| line.starts_with('#'));
        let named = comments.iter().find_map(|line| line.strip_prefix("# ")?.split_once(" of design "));
        let matrix = named.unwrap().0;
        let parsed = rows.iter().enumerate().map(|(index, line)| {
            let (head, entries) = line.split_once(" |").unwrap();
            let (row, macs) = head.split_once(": ").unwrap();
            assert_eq!(row.parse(), Ok(index));
            let pair = |entry: &str| {
                let (column, value) = entry.split_once(':').unwrap();
                (column.parse().unwrap(), value.split(',').map(|channel| channel.parse().unwrap()).collect())
            };
            let entries: Vec<(u32, Vec<i32>)> = entries.split_whitespace().map(pair).collect();
            assert_eq!(macs.parse(), Ok(entries.len()), "{name} row {index}");
            entries
        });
        listings.insert(matrix.to_owned(), parsed.collect());
    }
    listings
}

fn check(plan: &Plan) {
    let files = emit(plan).unwrap();
    let listings = listings(&files);
    assert_eq!(listings.len(), plan.matrices.len());
    let planned = |matrix: &QuantisedMatrix| -> Rows {
        let entry = |&(column, channels): &Entry| (column, channels[..plan.channels()].to_vec());
        matrix.rows.iter().map(|row| row.iter().map(entry).collect()).collect()
    };
    for (mut found, product) in matrices_in_roms(&files, plan).into_iter().zip(&plan.products) {
        let preload = product.preload.map(|preload| (preload.matrix, found.split_off(plan.elements())));
        for (matrix, found) in preload.into_iter().chain([(product.matrix, found)]) {
            let matrix = &plan.matrices[matrix];
            assert_eq!(found, listings[&matrix.name], "{}", matrix.name);
            assert_eq!(found, planned(matrix), "{}", matrix.name);
        }
    }
    let roms = files.iter().filter(|(name, _)| name.starts_with("rom/"));
    let lines: usize = roms.map(|(name, _)| text(&files, name).lines().count()).sum();
    let memories = plan.resources.memories.iter().filter(|memory| memory.read_only);
    assert_eq!(lines, memories.map(|memory| memory.count * memory.depth).sum::<usize>(), "words in all ROM files");
}

#[test]
fn roms_and_listings_agree_on_the_papers_sensor() {
    let filter = "filter = { kind = \"f1\", l = 40 }";
    for (kind, lanes) in [("paper", &[1, 16, 64][..]), ("reduced", &[4, 16, 64])] {
        for lanes in lanes {
            let more = format!("[algorithm]\nplan = \"{kind}\"\n{filter}\n[hardware]\nlanes = {lanes}");
            check(&plan(&design_text("sensor", [10, 10], [4.0, 2.0], 3.0, &more)));
        }
    }
}

/// One matrix for both directions, in a field and without one.
#[test]
fn roms_and_listings_agree_where_matrices_are_mirrored() {
    for outputs in ["field", "resultants"] {
        let more = format!("[algorithm]\nplan = \"reduced\"\noutputs = \"{outputs}\"\n[hardware]\nlanes = 8");
        let plan = plan(&design_text("square", [7, 7], [3.0, 3.0], 2.0, &more));
        assert!(plan.products.iter().any(|product| product.mirrored.is_some()));
        check(&plan);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]
    #[test]
    fn roms_and_listings_agree(text in any_design()) {
        check(&plan(&text));
    }
}
