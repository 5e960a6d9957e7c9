//! Recordings that commands read, and the warnings about them.

use std::path::Path;

use golden::check::Finding;
use golden::design::Design;
use golden::frames::{self, FrameError, Frames, Layout};
use golden::geometry;

/// The name of standard input and output.
const STANDARD: &str = "-";

/// Whether a file's name means standard input or output.
pub fn is_standard(path: &Path) -> bool {
    path == STANDARD
}

/// Where the values of a frame stand in its file.
#[derive(clap::Args, Clone, Debug)]
pub struct LayoutArguments {
    /// Columns of labels before the values of a frame.
    ///
    /// The file may then have a header.
    #[arg(long, value_name = "N", default_value_t = 0)]
    labels: usize,
    /// First and last column of the values, from 1.
    ///
    /// For files where other columns follow them.
    #[arg(long, value_name = "FIRST-LAST", value_parser = columns, conflicts_with = "labels")]
    columns: Option<[usize; 2]>,
    /// Lines to skip at the beginning of the file.
    #[arg(long, value_name = "N", default_value_t = 0)]
    skip_lines: usize,
    /// Leave out and count frames with a value that is no number.
    #[arg(long)]
    skip_bad: bool,
}

impl LayoutArguments {
    /// Whether any of them is there.
    pub fn given(&self) -> bool {
        self.layout() != Layout::default()
    }

    /// The options as they were given, each after a blank.
    pub fn options(&self) -> String {
        let Self { labels, columns, skip_lines, skip_bad } = *self;
        let labels = (labels > 0).then(|| format!(" --labels {labels}"));
        let columns = columns.map(|[first, last]| format!(" --columns {first}-{last}"));
        let skip_lines = (skip_lines > 0).then(|| format!(" --skip-lines {skip_lines}"));
        let skip_bad = skip_bad.then(|| " --skip-bad".to_owned());
        [labels, columns, skip_lines, skip_bad].into_iter().flatten().collect()
    }

    /// The same for the library.
    pub fn layout(&self) -> Layout {
        let Self { labels, columns, skip_lines, skip_bad } = *self;
        Layout { labels, columns, skip_lines, skip_bad }
    }
}

/// A first and a last column.
fn columns(text: &str) -> Result<[usize; 2], String> {
    let pair = text.split_once('-').and_then(|(first, last)| Some([first.parse().ok()?, last.parse().ok()?]));
    pair.filter(|[first, last]| (1..=*last).contains(first))
        .ok_or_else(|| "give the first and the last column of the values, from 1, such as 3-102".to_owned())
}

/// A file of frames.
pub struct Recording<'a> {
    pub file: &'a Path,
    pub layout: Layout,
}

impl Recording<'_> {
    /// The frames, which may not be known to be those of another sensor than the design's. Says on standard error what is
    /// to be known of their header.
    pub fn read(&self, design: &Design) -> Result<Vec<Vec<f64>>, FrameError> {
        Ok(self.read_all(design)?.frames)
    }

    /// The same with their times.
    pub fn read_all(&self, design: &Design) -> Result<Frames, FrameError> {
        geometry::compare(self.file, &design.name, &design.sensor)?;
        let frames = frames::read_recording(self.file, design, self.layout.clone())?;
        if let Some(remark) = &frames.remark {
            eprintln!("note: {remark}");
        }
        Ok(frames)
    }
}

/// Says on standard error what is suspicious.
pub fn warn(findings: &[Finding]) {
    for finding in findings {
        eprintln!("warning: {finding}");
    }
}
