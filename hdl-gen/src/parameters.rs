//! Parameters of an instance: names and numbers, which `emit` prints.

/// In which base a number's digits stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Base {
    /// 2.
    Binary,
    /// 10.
    Decimal,
    /// 16.
    Hexadecimal,
}

/// What a parameter is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Value {
    /// A number of at most 32 bits.
    Number(i64),
    /// A number of a stated width, with its sign.
    Signed {
        /// Its width.
        bits: u32,
        /// The number.
        value: i64,
    },
    /// Digits of an unsigned number of a stated width.
    Digits {
        /// Its width.
        bits: u32,
        /// Of the digits.
        base: Base,
        /// The highest one first.
        digits: String,
    },
    /// Unsigned numbers of as many bits each, the first in the lowest bits, each with what it is of.
    Table {
        /// Of each number.
        bits: u32,
        /// Numbers and comments.
        entries: Vec<(u64, String)>,
    },
    /// Numbers of as many bits each in two's complement, the first in the lowest bits.
    Numbers {
        /// Of each number.
        bits: u32,
        /// The numbers.
        numbers: Vec<i64>,
    },
    /// A text, such as the name of a file.
    Text(String),
    /// Texts of as many characters each, the first in the lowest bits.
    Texts(Vec<String>),
    /// The parameter of this name of the module around the instance.
    Outer,
}

/// Parameters of an instance, in the order of the module's declaration.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Parameters(Vec<(&'static str, Value)>);

impl Parameters {
    /// None yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Names and values.
    pub fn entries(&self) -> &[(&'static str, Value)] {
        &self.0
    }

    /// A number of at most 32 bits.
    #[must_use]
    pub fn number(self, name: &'static str, value: i64) -> Self {
        self.with(name, Value::Number(value))
    }

    /// A count or a width.
    #[must_use]
    pub fn count(self, name: &'static str, value: usize) -> Self {
        self.number(name, value as i64)
    }

    /// A latency.
    #[must_use]
    pub fn cycles(self, name: &'static str, value: u64) -> Self {
        self.number(name, value as i64)
    }

    /// 1 or 0.
    #[must_use]
    pub fn flag(self, name: &'static str, value: bool) -> Self {
        self.number(name, i64::from(value))
    }

    /// A number of a stated width, with its sign.
    #[must_use]
    pub fn signed(self, name: &'static str, bits: u32, value: i64) -> Self {
        self.with(name, Value::Signed { bits, value })
    }

    /// An unsigned number of a stated width.
    #[must_use]
    pub fn unsigned(self, name: &'static str, bits: u32, value: u64) -> Self {
        self.digits(name, bits, Base::Decimal, value.to_string())
    }

    /// A pattern of so many bits.
    #[must_use]
    pub fn pattern(self, name: &'static str, bits: u32, value: u64) -> Self {
        self.digits(name, bits, Base::Hexadecimal, format!("{value:0digits$x}", digits = bits as usize / 4))
    }

    /// One bit each, the first lowest.
    #[must_use]
    pub fn mask(self, name: &'static str, bits: &[bool]) -> Self {
        let digits = bits.iter().rev().map(|&bit| if bit { '1' } else { '0' }).collect();
        self.digits(name, bits.len() as u32, Base::Binary, digits)
    }

    /// An unsigned number of a stated width, by its digits.
    #[must_use]
    pub fn digits(self, name: &'static str, bits: u32, base: Base, digits: String) -> Self {
        self.with(name, Value::Digits { bits, base, digits })
    }

    /// Unsigned numbers of `bits` bits each, the first in the lowest bits, each with what it is of.
    #[must_use]
    pub fn table(self, name: &'static str, bits: u32, entries: Vec<(u64, String)>) -> Self {
        self.with(name, Value::Table { bits, entries })
    }

    /// A table of bare numbers.
    #[must_use]
    pub fn list(self, name: &'static str, bits: u32, numbers: impl IntoIterator<Item = u64>) -> Self {
        self.table(name, bits, numbers.into_iter().map(|number| (number, String::new())).collect())
    }

    /// Numbers of `bits` bits each in two's complement, the first in the lowest bits.
    #[must_use]
    pub fn numbers(self, name: &'static str, bits: u32, numbers: Vec<i64>) -> Self {
        self.with(name, Value::Numbers { bits, numbers })
    }

    /// A text.
    #[must_use]
    pub fn text(self, name: &'static str, text: impl Into<String>) -> Self {
        self.with(name, Value::Text(text.into()))
    }

    /// Texts of as many characters each, the first in the lowest bits.
    #[must_use]
    pub fn texts(self, name: &'static str, texts: Vec<String>) -> Self {
        self.with(name, Value::Texts(texts))
    }

    /// The parameter of the same name of the module around the instance.
    #[must_use]
    pub fn outer(self, name: &'static str) -> Self {
        self.with(name, Value::Outer)
    }

    /// Also those of `of`, if there is one.
    #[must_use]
    pub fn some<T>(self, of: Option<T>, parameters: impl FnOnce(Self, T) -> Self) -> Self {
        match of {
            Some(of) => parameters(self, of),
            None => self,
        }
    }

    /// Also others on a condition.
    #[must_use]
    pub fn when(self, condition: bool, parameters: impl FnOnce(Self) -> Self) -> Self {
        if condition { parameters(self) } else { self }
    }

    fn with(mut self, name: &'static str, value: Value) -> Self {
        self.0.push((name, value));
        self
    }
}
