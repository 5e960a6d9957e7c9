//! The stored matrices in MCSR form for a reader: one file a matrix, one line a row.

use std::io::Write;

use crate::format::pow2;
use crate::plan::Plan;
use crate::plan::matrix::QuantisedMatrix;

use super::FileMap;

/// Adds `mcsr/NN_NAME.txt` for every stored matrix, in order of first use.
pub fn insert(plan: &Plan, files: &mut FileMap) {
    for (index, matrix) in plan.matrices.iter().enumerate() {
        let short: String = matrix.name.chars().filter(char::is_ascii_alphanumeric).collect();
        // `I + D11` and `-(I + D30)` are kept under the matrix's own name.
        let short = short.strip_prefix('I').filter(|rest| rest.starts_with('D')).unwrap_or(&short);
        files.insert(format!("mcsr/{index:02}_{short}.txt"), text(plan, index, matrix));
    }
}

fn text(plan: &Plan, index: usize, matrix: &QuantisedMatrix) -> Vec<u8> {
    let mut text = Vec::with_capacity(matrix.nnz() * 12 + 1024);
    let uses: Vec<String> = plan
        .products
        .iter()
        .filter(|product| product.matrix == index || product.preload.is_some_and(|preload| preload.matrix == index))
        .map(|product| format!("{} -> {}", product.operand().name(), product.result.name()))
        .collect();
    // Writing to a vector cannot fail.
    let _ = writeln!(
        text,
        "# {} of design {}: {} rows, {} entries",
        matrix.name,
        plan.design.name,
        matrix.rows.len(),
        matrix.nnz()
    );
    let _ = writeln!(text, "# value = coefficient * 2^{} = coefficient * {:e}", matrix.lsb, pow2(matrix.lsb));
    let _ = writeln!(text, "# used for {}", uses.join(", "));
    let _ = writeln!(text, "# row: MACs | column:coefficient ...");
    for (row, entries) in matrix.rows.iter().enumerate() {
        let _ = write!(text, "{row}: {} |", entries.len());
        for (column, value) in entries {
            let channels: Vec<String> = value[..plan.channels()].iter().map(ToString::to_string).collect();
            let _ = write!(text, " {column}:{}", channels.join(","));
        }
        text.push(b'\n');
    }
    text
}
