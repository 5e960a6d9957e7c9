//! Tables: made once, shown in a terminal or by a template of HTML.
//!
//! Made here, since libraries of tables draw for a terminal and keep their cells from a template.

use serde::Serialize;

/// Between two columns of a terminal.
const GAP: usize = 2;
/// Rows of a terminal stand in from their header.
const INDENT: &str = "  ";

/// A table: the first column to the left, the others to the right.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Table {
    /// Above the columns.
    pub header: Vec<String>,
    /// Row by row; what a row lacks is empty.
    pub rows: Vec<Vec<String>>,
    /// Whether the last column holds words, which go to the left too.
    pub ends_in_words: bool,
}

impl Table {
    /// Without rows.
    pub fn new(header: impl IntoIterator<Item = impl Into<String>>) -> Self {
        Self { header: header.into_iter().map(Into::into).collect(), rows: Vec::new(), ends_in_words: false }
    }

    /// With words in the last column.
    #[must_use]
    pub fn ending_in_words(self) -> Self {
        Self { ends_in_words: true, ..self }
    }

    /// One row more.
    pub fn row(&mut self, cells: impl IntoIterator<Item = impl Into<String>>) {
        self.rows.push(cells.into_iter().map(Into::into).collect());
    }

    /// With rows.
    #[must_use]
    pub fn with(mut self, rows: impl IntoIterator<Item = impl IntoIterator<Item = impl Into<String>>>) -> Self {
        rows.into_iter().for_each(|row| self.row(row));
        self
    }

    fn is_left(&self, column: usize) -> bool {
        column == 0 || self.ends_in_words && column + 1 == self.header.len()
    }

    /// For a terminal: a rule below the header, columns as wide as they need and at least `first` and `others` wide.
    pub fn text(&self, first: usize, others: usize) -> String {
        let cells = |column: usize| self.rows.iter().filter_map(move |row| row.get(column));
        let widths: Vec<usize> = (0..self.header.len())
            .map(|column| {
                let (before, least) = if column == 0 { (INDENT.len(), first) } else { (GAP, others) };
                let head = if column == 0 { 0 } else { GAP } + self.header[column].chars().count();
                cells(column).map(|text| before + text.chars().count()).fold(head.max(least), usize::max)
            })
            .collect();
        let cell = |column: usize, text: &str| {
            let width = widths[column];
            match (column, self.is_left(column)) {
                (0, _) => format!("{text:<width$}"),
                (_, true) => format!("{:GAP$}{text:<1$}", "", width - GAP),
                (_, false) => format!("{text:>width$}"),
            }
        };
        let line = |indent: &str, row: &[&str]| {
            let first = row.first().map(|name| format!("{indent}{name}")).unwrap_or_default();
            let others = row.iter().enumerate().skip(1).map(|(column, text)| cell(column, text));
            let line: String = [cell(0, &first)].into_iter().chain(others).collect();
            format!("{}\n", line.trim_end())
        };
        let header: Vec<&str> = self.header.iter().map(String::as_str).collect();
        let mut text = line("", &header) + &rule(widths.iter().sum());
        for row in &self.rows {
            text += &line(INDENT, &row.iter().map(String::as_str).collect::<Vec<_>>());
        }
        text
    }
}

/// A line across a terminal.
pub fn rule(width: usize) -> String {
    "─".repeat(width) + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table() -> Table {
        Table::new(["what", "µs", "why"]).ending_in_words().with([["one", "1.5", "so"], ["two", "10.0", "because"]])
    }

    #[test]
    fn columns_of_a_terminal_are_aligned() {
        let text = "what     µs  why\n────────────────────\n  one   1.5  so\n  two  10.0  because\n";
        assert_eq!(table().text(0, 0), text);
        let wide = table().text(8, 9);
        let ends: Vec<usize> = wide.lines().map(|line| line.find("why").or(line.find("so")).unwrap_or(0)).collect();
        assert_eq!(wide.lines().nth(1).map(|rule| rule.chars().count()), Some(8 + 9 + 9), "{wide}");
        // `µ` has two bytes.
        assert_eq!(ends[0], ends[2] + 1, "{wide}");
    }
}
