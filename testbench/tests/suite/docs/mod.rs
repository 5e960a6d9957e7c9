//! README and docs: commands, links, numbers and words.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::browser;
use crate::support::{sptfra, workspace};

mod keys;
mod results;
mod sessions;

/// A line of a block of commands, without its comment.
pub struct Line {
    pub file: PathBuf,
    pub number: usize,
    pub text: String,
}

impl Line {
    pub fn place(&self) -> String {
        format!("{}, line {}: {}", self.file.display(), self.number, self.text)
    }
}

/// The Markdown files of a folder and of the folders in it.
fn markdown_in(folder: &Path, found: &mut Vec<PathBuf>) {
    for path in fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path()) {
        if path.is_dir() {
            markdown_in(&path, found);
        } else if path.extension().is_some_and(|ending| ending == "md") {
            found.push(path);
        }
    }
}

/// The pages of `docs/`.
fn docs() -> Vec<PathBuf> {
    let mut found = Vec::new();
    markdown_in(&workspace("docs"), &mut found);
    found.sort();
    found
}

/// All pages: those of `docs/` and those beside what they are about.
fn pages() -> Vec<PathBuf> {
    let named = [
        "README.md",
        "CONTRIBUTING.md",
        "data/README.md",
        "python/README.md",
        "rtl-out/README.md",
        "results/README.md",
    ];
    named.map(workspace).into_iter().chain(docs()).collect()
}

/// All lines of `sh` blocks; one that ends with a backslash goes on in the next.
fn lines() -> Vec<Line> {
    pages().iter().flat_map(|file| lines_of(file)).collect()
}

/// How lines begin that are typed into a shell.
const TYPED: [&str; 18] = [
    "sptfra ",
    "make ",
    "cargo ",
    "python3 ",
    "pip ",
    "vivado ",
    "dtc ",
    "echo ",
    "modprobe ",
    "insmod ",
    "git ",
    "cd ",
    "export ",
    "tools/",
    ".venv/",
    "fusesoc ",
    "verilator ",
    "apt-get ",
];

/// A block of commands without its language is run by no test.
#[test]
fn every_block_of_commands_says_that_it_is_one() {
    for page in pages() {
        let text = fs::read_to_string(&page).expect("readable");
        let lines: Vec<&str> = text.lines().collect();
        let fences = lines.iter().enumerate().filter(|(_, line)| line.starts_with("```")).map(|(index, _)| index);
        for open in fences.step_by(2).filter(|&open| lines[open] == "```") {
            let first = lines.get(open + 1).copied().unwrap_or_default();
            let typed = TYPED.iter().any(|begin| first.starts_with(begin));
            assert!(!typed, "{}, line {}: write ```sh above {first:?}", page.display(), open + 1);
        }
    }
}

pub fn lines_of(file: &Path) -> Vec<Line> {
    let text = fs::read_to_string(file).expect("readable");
    let (mut found, mut inside, mut open): (Vec<Line>, bool, bool) = (Vec::new(), false, false);
    for (number, line) in (1..).zip(text.lines()) {
        if line.starts_with("```") {
            inside = line == "```sh";
            continue;
        }
        if !inside {
            continue;
        }
        let words = if line.starts_with('#') { "" } else { line.split(" #").next().unwrap_or("").trim() };
        let (words, goes_on) = match words.strip_suffix('\\') {
            Some(words) => (words, true),
            None => (words, false),
        };
        match found.last_mut().filter(|_| open) {
            Some(last) => last.text.extend([" ", words.trim()]),
            None => found.push(Line { file: file.to_owned(), number, text: words.to_owned() }),
        }
        open = goes_on;
    }
    found.retain(|line| !line.text.is_empty());
    found
}

/// The folder of the command, which is built if it is not there.
pub fn commands() -> PathBuf {
    sptfra().parent().expect("a folder").to_owned()
}

fn help(folder: &Path, subcommand: &str) -> String {
    let output = Command::new(folder.join("sptfra")).args([subcommand, "--help"]).output().expect("starts");
    assert!(output.status.success(), "sptfra has no {subcommand}");
    String::from_utf8(output.stdout).expect("UTF-8")
}

#[test]
fn every_command_of_the_docs_exists() {
    let folder = commands();
    let root = workspace("");
    let makefile = fs::read_to_string(root.join("Makefile")).expect("readable");
    let mut checked = 0;
    for line in lines() {
        let words: Vec<&str> = line.text.split_whitespace().collect();
        match (words[0], words.get(1)) {
            ("sptfra", Some(subcommand)) => {
                let help = help(&folder, subcommand);
                let options = words.iter().filter_map(|word| word.trim_matches(['[', ']']).strip_prefix("--"));
                for option in options {
                    assert!(help.contains(&format!("--{option}")), "{}: there is no --{option}", line.place());
                }
                let files = words
                    .iter()
                    .filter(|word| ["designs/", "scenes/", "data/"].iter().any(|folder| word.starts_with(folder)));
                for file in files {
                    assert!(root.join(file).exists(), "{}: there is no {file}", line.place());
                }
            }
            ("make", Some(&"-C")) => {
                let inner = fs::read_to_string(root.join(words[2]).join("Makefile")).expect("a Makefile");
                let mut targets = words[3..].iter().filter(|word| !word.contains('='));
                assert!(
                    targets.all(|target| inner.contains(&format!("\n{target}:"))),
                    "{}: no such target",
                    line.place()
                );
            }
            ("make", Some(target)) => {
                assert!(makefile.contains(&format!("\n{target}:")), "{}: no such target", line.place());
            }
            ("cargo", Some(&"test")) => {
                let topic = words.iter().find_map(|word| word.split_once("::")).map(|(topic, _)| topic);
                let package = words.iter().skip_while(|word| **word != "-p").nth(1);
                if let (Some(topic), Some(package)) = (topic, package) {
                    let suite = fs::read_to_string(root.join(package).join("tests/suite/main.rs")).expect("a suite");
                    assert!(suite.contains(&format!("mod {topic};")), "{}: no such topic", line.place());
                }
            }
            _ => continue,
        }
        checked += 1;
    }
    assert!(checked > 20, "only {checked} commands were found");
}

/// The name that a heading can be linked by: small letters, digits and hyphens for spaces.
fn anchor(heading: &str) -> String {
    let kept = heading.chars().filter(|&letter| letter.is_alphanumeric() || matches!(letter, ' ' | '-' | '_'));
    kept.map(|letter| if letter == ' ' { '-' } else { letter.to_ascii_lowercase() }).collect()
}

/// What links of a page lead to.
fn targets(text: &str) -> Vec<&str> {
    let ends = text.match_indices("](").filter_map(|(at, open)| text[at + open.len()..].split_once(')'));
    ends.map(|(target, _)| target).collect()
}

#[test]
fn every_link_leads_somewhere() {
    let mut checked = 0;
    for page in pages().into_iter().chain([workspace("CHANGELOG.md")]) {
        let text = fs::read_to_string(&page).expect("readable");
        for target in targets(&text).into_iter().filter(|target| !target.contains("://")) {
            let (path, heading) = target.split_once('#').unwrap_or((target, ""));
            let file = if path.is_empty() { page.clone() } else { page.parent().expect("a folder").join(path) };
            assert!(file.exists(), "{}: there is no {target}", page.display());
            if !heading.is_empty() {
                let linked = fs::read_to_string(&file).expect("readable");
                let headings = linked.lines().filter_map(|line| line.strip_prefix('#'));
                let known =
                    headings.map(|line| anchor(line.trim_start_matches('#').trim())).any(|name| name == heading);
                assert!(known, "{}: {target} has no such heading", page.display());
            }
            checked += 1;
        }
    }
    assert!(checked > 100, "only {checked} links were found");
    // Every page has its place on the map and on the site.
    let site = fs::read_to_string(workspace("tools/book.yml")).expect("readable");
    let maps = ["README.md", "decisions/README.md"].map(|map| workspace("docs").join(map));
    let linked: Vec<PathBuf> = maps
        .iter()
        .flat_map(|map| {
            let text = fs::read_to_string(map).expect("readable");
            targets(&text).into_iter().map(|target| map.parent().expect("a folder").join(target)).collect::<Vec<_>>()
        })
        .collect();
    for page in docs().into_iter().filter(|page| !page.ends_with("README.md")) {
        let path = page.strip_prefix(workspace("docs")).expect("of the docs");
        assert!(site.contains(&format!(": {}\n", path.display())), "tools/book.yml has no {}", path.display());
        assert!(linked.contains(&page), "docs/README.md and docs/decisions/README.md have no {}", path.display());
    }
}

/// `make book`: every page has its place, and the search knows what is on it.
#[test]
fn the_site_has_every_page_and_finds_its_words() {
    let root = workspace("");
    let mkdocs = root.join(".venv/bin/mkdocs");
    assert!(mkdocs.exists(), "{} is missing: run `make book-tools`", mkdocs.display());
    let python = root.join(".venv/bin/python");
    let made = Command::new(python).arg(root.join("tools/book.py")).output().expect("runs");
    assert!(
        made.status.success(),
        "{}{}",
        String::from_utf8_lossy(&made.stdout),
        String::from_utf8_lossy(&made.stderr)
    );
    let site = root.join("target/book");
    for page in docs().into_iter().filter(|page| !page.ends_with("README.md")) {
        let path = page.strip_prefix(root.join("docs")).expect("of the docs");
        let made = site.join(path).with_extension("html");
        assert!(made.is_file(), "{} is missing", made.display());
    }
    let index = fs::read_to_string(site.join("search/search_index.json")).expect("readable");
    for word in ["taxel", "skid buffer", "ridge regression", "device-tree"] {
        assert!(index.contains(word), "the search does not know {word}");
    }
    // Pages with wide tables and long commands fit a telephone too.
    for (name, width) in [("index", 1280), ("index", 400), ("reference/registers", 400)] {
        let file = site.join(name).with_extension("html");
        let page = fs::read_to_string(&file).expect("readable");
        let mut wrong = browser::wrong(&page, file.parent().expect("a folder"), width);
        // A page that no server gave has no search.
        wrong.retain(|line| !line.contains("Worker"));
        assert!(wrong.is_empty(), "{name}, {width} wide:\n{}", wrong.join("\n"));
    }
}
