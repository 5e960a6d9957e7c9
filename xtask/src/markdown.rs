//! Pages of Markdown, with lines that are not too long.

use std::fmt::Write;

use golden::table::Table;

/// Characters of a line of running text.
const PAGE_WIDTH: usize = 120;

/// Text of a page. Writing to a String cannot fail.
#[derive(Debug)]
pub struct Page(pub String);

impl Page {
    /// A heading of the second level.
    pub fn heading(&mut self, title: &str) {
        let _ = write!(self.0, "\n## {title}\n");
    }

    /// A paragraph, or a list of points.
    pub fn line(&mut self, text: &str) {
        self.0.push('\n');
        for line in text.lines() {
            self.wrapped(line);
        }
    }

    /// A paragraph or a point of a list, broken between words.
    fn wrapped(&mut self, text: &str) {
        let indent = if text.starts_with("* ") { "  " } else { "" };
        let mut width = 0;
        for word in text.split(' ') {
            let length = word.chars().count();
            if width > 0 && width + 1 + length > PAGE_WIDTH {
                let _ = write!(self.0, "\n{indent}");
                width = indent.len();
            } else if width > 0 {
                self.0.push(' ');
                width += 1;
            }
            self.0.push_str(word);
            width += length;
        }
        self.0.push('\n');
    }

    /// A command to type.
    pub fn command(&mut self, command: &str) {
        let _ = write!(self.0, "\n```sh\n{command}\n```\n");
    }

    /// A table.
    pub fn table(&mut self, table: &Table) {
        let _ = write!(self.0, "\n{}", table.markdown());
    }
}
