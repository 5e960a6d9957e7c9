//! The ROM files hold the matrices of the MCSR listings: both are read back as text and compared.

use std::collections::{BTreeMap, VecDeque};

use hdl_gen::emit::{FileMap, emit};
use hdl_gen::plan::Plan;
use proptest::prelude::*;
use serde_json::Value;

use crate::support::{any_design, design_text, plan};

/// Rows of `(column, coefficient)`.
type Rows = Vec<Vec<(u32, i32)>>;

fn text<'a>(files: &'a FileMap, name: &str) -> &'a str {
    std::str::from_utf8(files.get(name).unwrap_or_else(|| panic!("no {name}"))).unwrap()
}

/// The words of a ROM file, each of exactly the digits that its width needs.
fn words(files: &FileMap, name: &str, bits: u32) -> Vec<u32> {
    let digits = bits.div_ceil(4) as usize;
    let word = |line: &str| {
        assert_eq!(line.len(), digits, "{name}: {line}");
        let word = u32::from_str_radix(line, 16).unwrap();
        assert!(word < 1 << bits, "{name}: {line}");
        word
    };
    text(files, name).lines().map(word).collect()
}

fn signed(word: u32, bits: u32) -> i32 {
    ((word << (32 - bits)) as i32) >> (32 - bits)
}

fn bits_for(count: usize) -> u32 {
    count.next_power_of_two().trailing_zeros().max(1)
}

struct Reader {
    values: Vec<u32>,
    columns: Vec<u32>,
    segments: Vec<u32>,
    word: usize,
    marked: usize,
    segment: usize,
}

/// Every product's matrix, from the ROM files, the visits and the cycle counts of the metadata alone.
fn matrices_in_roms(files: &FileMap, plan: &Plan) -> Vec<Rows> {
    let name = &plan.design.name;
    let metadata: Value = serde_json::from_str(text(files, "metadata.json")).unwrap();
    let products = metadata["products"].as_array().unwrap();
    let taxels = plan.design.sensor.columns * plan.design.sensor.rows;
    let lanes = plan.design.hardware.lanes;
    let coefficient_bits = plan.design.hardware.coefficient_bits;
    let (row_bits, product_bits) = (bits_for(taxels), bits_for(products.len()));

    let mut visits: Vec<VecDeque<(usize, usize)>> = vec![VecDeque::new(); lanes];
    for visit in words(files, &format!("rom/{name}_visits.mem"), bits_for(lanes) + product_bits + row_bits) {
        let lane = (visit >> (product_bits + row_bits)) as usize;
        let product = (visit >> row_bits) as usize & ((1 << product_bits) - 1);
        visits[lane].push_back((product, visit as usize & ((1 << row_bits) - 1)));
    }
    let mut readers: Vec<Reader> = (0..lanes)
        .map(|lane| Reader {
            values: words(files, &format!("rom/{name}_values_lane{lane:02}.mem"), coefficient_bits),
            columns: words(files, &format!("rom/{name}_columns_lane{lane:02}.mem"), row_bits),
            segments: words(files, &format!("rom/{name}_macs_lane{lane:02}.mem"), 16),
            word: 0,
            marked: 0,
            segment: 0,
        })
        .collect();
    let depth = |get: fn(&Reader) -> usize| readers.iter().all(|reader| get(reader) == get(&readers[0]));
    assert!(depth(|reader| reader.values.len()) && depth(|reader| reader.columns.len()));
    assert!(depth(|reader| reader.segments.len()));

    let mut matrices: Vec<Rows> = vec![vec![Vec::new(); taxels]; products.len()];
    let mut op_began = false;
    for (index, product) in products.iter().enumerate() {
        let cycles = product["issue_cycles"].as_u64().unwrap();
        let mut open_head = None;
        for lane in 0..lanes {
            let reader = &mut readers[lane];
            if product["block"] == "Op" {
                *(if op_began { &mut reader.word } else { &mut reader.marked }) =
                    if op_began { reader.marked } else { reader.word };
            }
            let mut issued = 0;
            while issued < cycles {
                let (kind, macs) = (reader.segments[reader.segment] >> 14, reader.segments[reader.segment] & 0x3fff);
                reader.segment += 1;
                issued += u64::from(macs);
                if kind == 3 {
                    continue;
                }
                let row = if kind == 1 {
                    open_head.take().expect("the lane before has begun this row")
                } else {
                    let (of_product, row) = visits[lane].pop_front().expect("a visit for every result");
                    assert_eq!(of_product, index);
                    row
                };
                if kind == 2 {
                    open_head = Some(row);
                }
                let range = reader.word..reader.word + macs as usize;
                reader.word = range.end;
                let entries = reader.columns[range.clone()].iter().zip(&reader.values[range]);
                matrices[index][row].extend(entries.map(|(&column, &value)| (column, signed(value, coefficient_bits))));
            }
            assert_eq!(issued, cycles, "product {index}, lane {lane}");
        }
        assert!(open_head.is_none());
        op_began |= product["block"] == "Op";
    }
    assert!(visits.iter().all(VecDeque::is_empty));
    for reader in readers {
        assert!(reader.values[reader.word..].iter().chain(&reader.columns[reader.word..]).all(|&word| word == 0));
    }
    matrices
}

/// The listings by the matrix's full name.
fn listings(files: &FileMap) -> BTreeMap<String, Rows> {
    let mut listings = BTreeMap::new();
    for name in files.keys().filter(|name| name.starts_with("mcsr/")) {
        let (comments, rows): (Vec<&str>, Vec<&str>) =
            text(files, name).lines().partition(|line| line.starts_with('#'));
        let matrix = comments[0].strip_prefix("# ").unwrap().split(" of design").next().unwrap();
        let parsed = rows.iter().enumerate().map(|(index, line)| {
            let (head, entries) = line.split_once(" |").unwrap();
            let (row, macs) = head.split_once(": ").unwrap();
            assert_eq!(row.parse(), Ok(index));
            let pair = |entry: &str| {
                let (column, value) = entry.split_once(':').unwrap();
                (column.parse().unwrap(), value.parse().unwrap())
            };
            let entries: Vec<(u32, i32)> = entries.split_whitespace().map(pair).collect();
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
    for (found, product) in matrices_in_roms(&files, plan).iter().zip(&plan.products) {
        let name = &plan.matrices[product.matrix].name;
        assert_eq!(found, &listings[name], "{name}");
        assert_eq!(found, &plan.matrices[product.matrix].rows, "{name}");
    }
    let roms = files.iter().filter(|(name, _)| name.starts_with("rom/"));
    let lines: usize = roms.map(|(name, _)| text(&files, name).lines().count()).sum();
    let memories = plan.resources.memories.iter().filter(|memory| memory.read_only);
    assert_eq!(lines, memories.map(|memory| memory.count * memory.depth).sum::<usize>(), "words in all ROM files");
}

#[test]
fn roms_and_listings_agree_on_the_papers_sensor() {
    for lanes in [1, 16, 64] {
        let hardware = format!("[algorithm]\nfilter = {{ kind = \"f1\", l = 40 }}\n[hardware]\nlanes = {lanes}");
        check(&plan(&design_text("sensor", [10, 10], [4.0, 2.0], 3.0, &hardware)));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]
    #[test]
    fn roms_and_listings_agree(text in any_design()) {
        check(&plan(&text));
    }
}
