//! `NumPy`'s `.npy` files: arrays of numbers, as `numpy.save` writes them (NEP 1, versions 1 to 3).
//!
//! Read here, since npyz brings a parser generator for a header of three keys and still reads one type at a time.

/// What every such file begins with.
pub(super) const MAGIC: &[u8] = b"\x93NUMPY";
/// Where the data begin is a multiple of this.
const ALIGNMENT: usize = 64;

/// An array, its values in C order: the last index runs fastest.
#[derive(Debug, PartialEq)]
pub(super) struct Array {
    pub(super) shape: Vec<usize>,
    pub(super) values: Vec<f64>,
}

/// Reads a file's bytes; else what is wrong with them.
pub(super) fn parse(bytes: &[u8]) -> Result<Array, String> {
    let damaged = || "the file is damaged: it ends too early".to_owned();
    let version = *bytes.get(MAGIC.len()).ok_or_else(damaged)?;
    // The header's length has two bytes, from version 2 on four.
    let size = if version == 1 { 2 } else { 4 };
    let start = MAGIC.len() + 2 + size;
    let length = bytes.get(MAGIC.len() + 2..start).ok_or_else(damaged)?;
    let length = length.iter().rev().fold(0, |length, &byte| length << 8 | usize::from(byte));
    let (header, data) = bytes[start..].split_at_checked(length).ok_or_else(damaged)?;
    let header = String::from_utf8_lossy(header);
    let entry = |key: &str| {
        let (_, rest) = header.split_once(&format!("'{key}':"))?;
        Some(rest.trim_start())
    };
    let incomplete = || "the header of the file is damaged".to_owned();
    let described = entry("descr").ok_or_else(incomplete)?;
    let number = described.strip_prefix('\'').and_then(|rest| rest.split_once('\'')).map(|(number, _)| number);
    let Some(kind) = number.and_then(Kind::new) else {
        let shown: String =
            number.unwrap_or(described).chars().filter(|letter| !letter.is_control()).take(20).collect();
        let objects = if shown == "|O" { " but pickled objects, as of rows of other lengths" } else { "" };
        return Err(format!("its values, {shown}, are no plain numbers{objects}; use an array of floats or integers"));
    };
    let fortran_order = entry("fortran_order").ok_or_else(incomplete)?.starts_with("True");
    let shape = entry("shape").and_then(|rest| rest.strip_prefix('(')?.split_once(')')).ok_or_else(incomplete)?.0;
    let sides = shape.split(',').map(str::trim).filter(|side| !side.is_empty());
    let shape: Vec<usize> = sides.map(str::parse).collect::<Result<_, _>>().map_err(|_| incomplete())?;
    let count = shape.iter().try_fold(1_usize, |count, &side| count.checked_mul(side)).ok_or_else(incomplete)?;
    if count.checked_mul(kind.bytes).is_none_or(|bytes| bytes != data.len()) {
        return Err(format!("the file is damaged: it has {} bytes of data for {shape:?} values", data.len()));
    }
    let mut values: Vec<f64> = data.chunks_exact(kind.bytes).map(|bytes| kind.value(bytes)).collect();
    if fortran_order {
        values = in_c_order(&shape, &values);
    }
    Ok(Array { shape, values })
}

/// The values of an array whose first index runs fastest.
fn in_c_order(shape: &[usize], values: &[f64]) -> Vec<f64> {
    let place = |mut index: usize| {
        // From the last index, which runs fastest here, to the first, which does there.
        let mut stride = values.len();
        shape.iter().rev().fold(0, |place, &side| {
            stride /= side;
            let along = index % side;
            index /= side;
            place + along * stride
        })
    };
    (0..values.len()).map(|index| values[place(index)]).collect()
}

/// How a number stands in the file.
struct Kind {
    big_endian: bool,
    letter: char,
    bytes: usize,
}

impl Kind {
    /// Of a description such as `<f8`.
    fn new(text: &str) -> Option<Self> {
        let mut letters = text.chars();
        let (order, letter) = (letters.next()?, letters.next()?);
        let bytes = letters.as_str().parse().ok()?;
        let known = matches!((letter, bytes), ('f', 2 | 4 | 8) | ('i' | 'u', 1 | 2 | 4 | 8) | ('b', 1));
        (known && "<>|=".contains(order)).then_some(Self { big_endian: order == '>', letter, bytes })
    }

    fn value(&self, bytes: &[u8]) -> f64 {
        let place = |index: usize| if self.big_endian { bytes.len() - 1 - index } else { index };
        let bits = (0..bytes.len()).rev().fold(0_u64, |bits, index| bits << 8 | u64::from(bytes[place(index)]));
        let unused = 64 - 8 * self.bytes;
        match (self.letter, self.bytes) {
            ('f', 2) => half(bits as u16),
            ('f', 4) => f64::from(f32::from_bits(bits as u32)),
            ('f', _) => f64::from_bits(bits),
            ('i', _) => ((bits << unused).cast_signed() >> unused) as f64,
            _ => bits as f64,
        }
    }
}

/// An IEEE binary16.
fn half(bits: u16) -> f64 {
    let sign = if bits >> 15 == 1 { -1.0 } else { 1.0 };
    let (exponent, fraction) = (i32::from(bits >> 10 & 31), f64::from(bits & 1023) / 1024.0);
    sign * match exponent {
        0 => fraction * f64::from(-14).exp2(),
        31 if fraction == 0.0 => f64::INFINITY,
        31 => f64::NAN,
        _ => (1.0 + fraction) * f64::from(exponent - 15).exp2(),
    }
}

/// A file of `rows` of equal length, in float64.
pub(super) fn file(columns: usize, rows: &[Vec<f64>]) -> Vec<u8> {
    let described = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({}, {columns}), }}", rows.len());
    let before = MAGIC.len() + 4;
    // With a line's end after it.
    let length = (before + described.len() + 1).next_multiple_of(ALIGNMENT) - before;
    let mut bytes = [MAGIC, &[1, 0], &(length as u16).to_le_bytes()].concat();
    bytes.extend(format!("{described:<width$}\n", width = length - 1).bytes());
    bytes.extend(rows.iter().flatten().flat_map(|value| value.to_le_bytes()));
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A file as numpy writes it, of these bytes.
    fn of(header: &str, data: &[u8]) -> Vec<u8> {
        let length = (header.len() + 1) as u16;
        [MAGIC, &[1, 0], &length.to_le_bytes(), header.as_bytes(), b"\n", data].concat()
    }

    #[test]
    fn every_kind_of_number_is_read() {
        let read = |descr: &str, data: &[u8]| {
            let header = format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': (2,), }}");
            parse(&of(&header, data)).map(|array| array.values)
        };
        assert_eq!(read("|i1", &[0xff, 5]), Ok(vec![-1.0, 5.0]));
        assert_eq!(read("|u1", &[0xff, 5]), Ok(vec![255.0, 5.0]));
        assert_eq!(read("<i2", &[0x18, 0xfc, 1, 0]), Ok(vec![-1000.0, 1.0]));
        assert_eq!(read(">u2", &[1, 0, 0, 1]), Ok(vec![256.0, 1.0]));
        assert_eq!(read("<f2", &[0x00, 0xc0, 0x01, 0x00]), Ok(vec![-2.0, 2_f64.powi(-24)]));
        assert_eq!(read("<f4", &[1.5_f32, -8.25].map(f32::to_le_bytes).concat()), Ok(vec![1.5, -8.25]));
        assert_eq!(read(">f8", &[1e-300, 2.0].map(f64::to_be_bytes).concat()), Ok(vec![1e-300, 2.0]));
        assert_eq!(read("<i8", &[-3_i64, 9].map(i64::to_le_bytes).concat()), Ok(vec![-3.0, 9.0]));
        for (descr, part) in [
            ("<c16", "no plain numbers"),
            ("|O", "|O, are no plain numbers but pickled objects"),
            ("<i4", "4 bytes of data"),
        ] {
            let message = read(descr, &[0; 4]).unwrap_err();
            assert!(message.contains(part), "{message}");
        }
    }

    #[test]
    fn a_message_is_one_line_whatever_the_header_holds() {
        let header = "{'descr': '\n<f8\u{7}', 'fortran_order': False, 'shape': (2,), }";
        let said = parse(&of(header, &[0; 16])).map(|array| array.values).expect_err("no kind of number");
        assert!(said.contains("<f8,") && !said.contains(char::is_control), "{said:?}");
    }

    #[test]
    fn either_order_of_indices() {
        let array = |order: &str| {
            let header = format!("{{'descr': '|u1', 'fortran_order': {order}, 'shape': (2, 3), }}");
            parse(&of(&header, &[1, 2, 3, 4, 5, 6])).unwrap()
        };
        assert_eq!(array("False"), Array { shape: vec![2, 3], values: vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0] });
        assert_eq!(array("True"), Array { shape: vec![2, 3], values: vec![1.0, 3.0, 5.0, 2.0, 4.0, 6.0] });
    }

    #[test]
    fn what_is_written_is_read_and_what_is_cut_is_refused() {
        let rows = [vec![1.0, -2.5, 3e-9], vec![4.0, 5.0, 6.0]];
        let bytes = file(3, &rows);
        assert_eq!(parse(&bytes), Ok(Array { shape: vec![2, 3], values: rows.concat() }));
        assert_eq!((bytes.len() - 48) % ALIGNMENT, 0);
        for length in MAGIC.len()..bytes.len() {
            assert!(parse(&bytes[..length]).is_err(), "{length}");
        }
    }
}
