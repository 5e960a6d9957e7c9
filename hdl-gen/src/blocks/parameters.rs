//! Parameters of an instance as Verilog has them.

use std::fmt::Write;

use serde::{Serialize, Serializer};

/// Parameters of an instance: names and Verilog expressions, in the order of the module's declaration.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Parameters(Vec<(&'static str, String)>);

impl Parameters {
    /// None yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// A number, as a plain decimal one of at most 32 bits.
    #[must_use]
    pub fn number(self, name: &'static str, value: i64) -> Self {
        self.expression(name, value.to_string())
    }

    /// A count or a width.
    #[must_use]
    pub fn count(self, name: &'static str, value: usize) -> Self {
        self.expression(name, value.to_string())
    }

    /// A latency.
    #[must_use]
    pub fn cycles(self, name: &'static str, value: u64) -> Self {
        self.expression(name, value.to_string())
    }

    /// 1 or 0.
    #[must_use]
    pub fn flag(self, name: &'static str, value: bool) -> Self {
        self.number(name, i64::from(value))
    }

    /// A number of a stated width, for those of more than 32 bits, with its sign.
    #[must_use]
    pub fn wide(self, name: &'static str, bits: u32, value: i64) -> Self {
        let sign = if value < 0 { "-" } else { "" };
        self.expression(name, format!("{sign}{bits}'sd{}", value.unsigned_abs()))
    }

    /// A table: numbers of `bits` bits each, the first in the lowest bits; each on a line of its own if there are comments
    /// that say what it is of.
    #[must_use]
    pub fn table(self, name: &'static str, bits: u32, entries: &[(u64, String)]) -> Self {
        if entries.iter().all(|(_, comment)| comment.is_empty()) {
            let values: Vec<String> = entries.iter().rev().map(|(value, _)| format!("{bits}'d{value}")).collect();
            return self.expression(name, format!("{{{}}}", values.join(", ")));
        }
        // Of entries without a comment those that are alike stand in one line.
        let mut text = "{".to_owned();
        let mut left = entries;
        while let Some(((value, comment), before)) = left.split_last() {
            let is_alike = |entry: &&(u64, String)| comment.is_empty() && entry.1.is_empty() && entry.0 == *value;
            let alike = 1 + before.iter().rev().take_while(is_alike).count();
            left = &left[..left.len() - alike];
            let comma = if left.is_empty() { "" } else { "," };
            let number = if alike > 1 { format!("{{{alike}{{{bits}'d{value}}}}}") } else { format!("{bits}'d{value}") };
            let comment = if comment.is_empty() { String::new() } else { format!(" // {}: {comment}", left.len()) };
            // Writing to a string cannot fail.
            let _ = write!(text, "\n            {number}{comma}{comment}");
        }
        self.expression(name, text + "\n        }")
    }

    /// Numbers of `bits` bits in two's complement, the first in the lowest bits, some on each line.
    #[must_use]
    pub fn numbers(self, name: &'static str, bits: u32, numbers: &[i64]) -> Self {
        const ON_A_LINE: usize = 7;
        let unsigned = |number: &i64| number & ((1 << bits) - 1);
        let numbers: Vec<String> = numbers.iter().rev().map(|number| format!("{bits}'d{}", unsigned(number))).collect();
        let lines: Vec<String> = numbers.chunks(ON_A_LINE).map(|numbers| numbers.join(", ")).collect();
        self.expression(name, format!("{{\n            {}\n        }}", lines.join(",\n            ")))
    }

    /// One bit each, the first lowest.
    #[must_use]
    pub fn mask(self, name: &'static str, bits: &[bool]) -> Self {
        let digits: String = bits.iter().rev().map(|&bit| if bit { '1' } else { '0' }).collect();
        self.expression(name, format!("{}'b{digits}", bits.len()))
    }

    /// Any expression, for instance a parameter of the module around it.
    #[must_use]
    pub fn expression(mut self, name: &'static str, value: impl Into<String>) -> Self {
        self.0.push((name, value.into()));
        self
    }

    /// `#(` to `) ` as it stands between module and instance, for an instance that is indented once; nothing without
    /// parameters.
    pub fn verilog(&self) -> String {
        if self.0.is_empty() {
            return String::new();
        }
        let width = self.0.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
        let lines: Vec<String> =
            self.0.iter().map(|(name, value)| format!("        .{name:width$} ({value})")).collect();
        format!("#(\n{}\n    ) ", lines.join(",\n"))
    }
}

impl Serialize for Parameters {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(&self.verilog())
    }
}

#[cfg(test)]
mod tests {
    use super::Parameters;
    use crate::blocks::latency::{
        TAXEL_TO_CEAN, VISIT_TO_BUS, bus_to_sums, bus_to_taxels, bus_to_write, taxels_to_write, turn_to_write,
    };
    use golden::estimators::ERROR_RANGE;

    use crate::cores::{Multiplier, cordic};
    use crate::emit::rtl::library;
    use crate::estimators::{joint, line};
    use crate::model::{PULLING, inverse_gain};
    use crate::plan::format::FRICTION_FRACTION;
    use crate::plan::standard_error::SHARE_FRACTION;

    /// What a constant in a module of the library is.
    fn literal(module: &str, name: &str) -> String {
        let text = library(Multiplier::Whole)[module];
        let (_, rest) = text.split_once(&format!(" {name} = ")).unwrap_or_else(|| panic!("{module} has no {name}"));
        rest.split_once(';').unwrap().0.to_owned()
    }

    /// The value of such a constant, its width left out.
    fn constant(module: &str, name: &str) -> i64 {
        let literal = literal(module, name);
        let digits = literal.rsplit('d').next().unwrap();
        digits.parse().unwrap_or_else(|_| panic!("{module}: {name} = {literal}"))
    }

    /// The algorithm's constants stand in the modules and in the integer model.
    #[test]
    fn modules_and_model_have_the_same_constants() {
        let one = 1 << FRICTION_FRACTION;
        let expected: [(&str, &str, i64); 29] = [
            ("sptfra_frame_writer", "TURN_TO_STRESS", TAXEL_TO_CEAN as i64),
            ("sptfra_spmv_collector", "TAKE_TO_BUS", VISIT_TO_BUS as i64),
            ("sptfra_direction", "CENTROID_FRACTION", line::CENTROID_FRACTION.into()),
            ("sptfra_direction", "PITCH_FRACTION", line::PITCH_FRACTION.into()),
            ("sptfra_line", "LINE_FRACTION", line::LINE_FRACTION.into()),
            ("sptfra_line", "LINE_SUM_BITS", line::LINE_SUM_BITS.into()),
            ("sptfra_search", "SEARCH_STEPS", line::SEARCH_STEPS.into()),
            ("sptfra_search", "ONE", one),
            ("sptfra_search_cell", "FRICTION_FRACTION", FRICTION_FRACTION.into()),
            ("sptfra_search_cell", "LINE_FRACTION", line::LINE_FRACTION.into()),
            ("sptfra_search_cell", "HINGE_DROP", line::HINGE_DROP.into()),
            ("sptfra_summary", "LINE_FRACTION", line::LINE_FRACTION.into()),
            ("sptfra_summary", "INVERSE_GAIN", inverse_gain()),
            ("sptfra_summary", "ONE", one),
            ("sptfra_op", "FRICTION_FRACTION", FRICTION_FRACTION.into()),
            ("sptfra_op", "PULLING", PULLING),
            ("sptfra_output_word", "FRICTION_EXPONENT", FRICTION_FRACTION.into()), // a negative one
            ("sptfra_output_word", "ANGLE_EXPONENT", cordic::ANGLE_FRACTION_BITS.into()),
            ("sptfra_grid_level", "WEIGHT_BITS", joint::search::WEIGHT_BITS.into()),
            ("sptfra_friction", "LINEAR_FRACTION", joint::LINEAR_FRACTION.into()),
            ("sptfra_friction", "CUBIC_FRACTION", joint::CUBIC_FRACTION.into()),
            ("sptfra_friction", "FACTOR_FRACTION", joint::FACTOR_FRACTION.into()),
            ("sptfra_look_stress", "STRESS_BITS", joint::STRESS_BITS.into()),
            ("sptfra_look_window", "CENTRE_HALF", joint::CENTRE_HALF),
            ("sptfra_look_window", "INPUT_ONE", 1 << joint::INPUT_FRACTION),
            ("sptfra_network", "UNIT_BITS", joint::UNIT_BITS.into()),
            ("sptfra_network", "LIMIT", joint::CORRECTION_LIMIT),
            ("sptfra_standard_error", "LEAST", 1 << (i64::from(SHARE_FRACTION) + i64::from(ERROR_RANGE[0]))),
            ("sptfra_standard_error", "MOST", (1 << (i64::from(SHARE_FRACTION) + i64::from(ERROR_RANGE[1]))) - 1),
        ];
        for (module, name, value) in expected {
            assert_eq!(constant(module, name), value, "{module}: {name}");
        }
    }

    /// Latencies that depend on whether vectors are folded.
    #[test]
    fn modules_and_schedule_have_the_same_latencies() {
        let both = |latency: fn(bool) -> u64| [latency(true), latency(false)];
        let expected = [
            ("sptfra_unfold", "LATENCY", both(bus_to_taxels)),
            ("sptfra_we", "LATENCY", both(taxels_to_write)),
            ("sptfra_co", "WRITE_LATENCY", both(bus_to_write)),
            ("sptfra_co", "SUMS_LATENCY", both(bus_to_sums)),
        ];
        for (module, name, [folded, taxels]) in expected {
            let choice = format!("(WAYS == 4) ? {folded} : {taxels}");
            assert_eq!(literal(module, name), choice, "{module}: {name}");
        }
        let [scaled, unscaled] = [true, false].map(turn_to_write);
        let choice = format!("(SCALED != 0) ? {scaled} : {unscaled}");
        assert_eq!(literal("sptfra_fold", "TURN_TO_WRITTEN"), choice);
    }

    #[test]
    fn parameters_read_as_verilog() {
        let entries = [(3, "first".to_owned()), (5, String::new())];
        let parameters = Parameters::new().count("ROWS", 10).wide("BOUND", 40, -7).table("LENGTHS", 8, &entries);
        let expected = "#(\n        .ROWS    (10),\n        .BOUND   (-40'sd7),\n        .LENGTHS ({\n            8'd5,\n            \
                        8'd3 // 0: first\n        })\n    ) ";
        assert_eq!(parameters.verilog(), expected);
        assert_eq!(Parameters::new().verilog(), "");
        let bare = Parameters::new().table("WAITS", 4, &[(1, String::new()), (2, String::new())]);
        assert_eq!(bare.verilog(), "#(\n        .WAITS ({4'd2, 4'd1})\n    ) ");
    }
}
