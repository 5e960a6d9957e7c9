//! Two lengths of a file, of which people write one.

use std::fmt;

use serde::de::{SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};

use super::DesignError;
use super::checks::Check;

/// What stands where two numbers should.
pub(crate) enum Lengths {
    /// A number alone.
    One(f64),
    /// An array, of any length.
    Several(Vec<f64>),
}

impl Lengths {
    /// The two numbers.
    pub(crate) fn pair(&self, check: &Check, key: &str) -> Result<[f64; 2], DesignError> {
        match self {
            Self::Several(values) => check.pair(key, values),
            Self::One(value) => Err(check.value(
                key,
                format!("is one number, {value:?}"),
                format!("write two, for x and y: [{value:?}, {value:?}]"),
            )),
        }
    }
}

impl<'de> Deserialize<'de> for Lengths {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        // Not an untagged enum, whose message for anything else would tell nothing.
        struct Numbers;

        impl<'de> Visitor<'de> for Numbers {
            type Value = Lengths;

            fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
                formatter.write_str("two numbers, such as [4.0, 2.0]")
            }

            fn visit_i64<E>(self, value: i64) -> Result<Lengths, E> {
                Ok(Lengths::One(value as f64))
            }

            fn visit_f64<E>(self, value: f64) -> Result<Lengths, E> {
                Ok(Lengths::One(value))
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut array: A) -> Result<Lengths, A::Error> {
                let mut values = Vec::new();
                while let Some(value) = array.next_element()? {
                    values.push(value);
                }
                Ok(Lengths::Several(values))
            }
        }

        deserializer.deserialize_any(Numbers)
    }
}
