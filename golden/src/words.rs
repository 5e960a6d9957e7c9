//! Words of design and scene files, and of options that name the same: those that serde knows the variants of an enum by.
//!
//! An enum says its words once, by deriving `Serialize` and `Deserialize`; what is read, what is printed and what an error
//! offers in place of an unknown word all come from there.

use std::fmt;

use serde::de::{DeserializeOwned, Error, value::StrDeserializer};

/// A word that no variant has; prints the words there are.
#[derive(Debug)]
pub struct Unknown {
    /// The words there are.
    pub allowed: &'static [&'static str],
}

/// The variant that a word means.
///
/// # Errors
///
/// [`Unknown`], with the words there are.
pub fn read<T: DeserializeOwned>(word: &str) -> Result<T, Unknown> {
    T::deserialize(StrDeserializer::new(word))
}

impl Error for Unknown {
    fn custom<T: fmt::Display>(_: T) -> Self {
        Self { allowed: &[] }
    }

    fn unknown_variant(_: &str, allowed: &'static [&'static str]) -> Self {
        Self { allowed }
    }
}

impl std::error::Error for Unknown {}

impl fmt::Display for Unknown {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.allowed.join(", "))
    }
}

/// Prints variants as the words that serde knows them by, padded as asked for.
macro_rules! print_as_words {
    ($($of:ty),+) => {$(
        impl std::fmt::Display for $of {
            fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                serde::Serialize::serialize(self, formatter)
            }
        }
    )+};
}
pub(crate) use print_as_words;

#[cfg(test)]
mod tests {
    use serde::{Deserialize, Serialize};

    use super::*;

    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(rename_all = "snake_case")]
    enum Layer {
        HalfSpace,
        Bonded,
    }
    print_as_words!(Layer);

    #[test]
    fn a_word_reads_back_and_an_unknown_one_names_the_others() {
        assert_eq!(read::<Layer>("half_space").unwrap(), Layer::HalfSpace);
        assert_eq!(format!("{:<8}|{}", Layer::Bonded, Layer::HalfSpace), "bonded  |half_space");
        assert_eq!(read::<Layer>("HalfSpace").unwrap_err().to_string(), "half_space, bonded");
    }
}
