//! Shell completions and manual pages.

use std::error::Error;
use std::io;
use std::path::PathBuf;

use clap::Subcommand;
use clap_complete::Shell;

/// The commands about the command itself.
#[derive(Debug, Subcommand)]
pub enum Manual {
    /// Prints completions for a shell.
    #[command(after_help = "Example: for the current bash\n  source <(sptfra completions bash)")]
    Completions {
        /// The shell.
        shell: Shell,
    },
    /// Writes manual pages, one for each command.
    #[command(after_help = "Example:\n  sptfra man --out man && man -l man/sptfra.1")]
    Man {
        /// Folder for the pages; it is made where it is missing.
        #[arg(long, value_name = "DIR")]
        out: PathBuf,
    },
}

impl Manual {
    /// What to print. `command` is the whole command line.
    ///
    /// # Errors
    ///
    /// When the folder of the pages cannot be written.
    pub fn run(&self, mut command: clap::Command) -> Result<String, Box<dyn Error>> {
        let name = command.get_name().to_owned();
        match self {
            Self::Completions { shell } => {
                let mut text = Vec::new();
                clap_complete::generate(*shell, &mut command, name, &mut text);
                Ok(String::from_utf8(text)?)
            }
            Self::Man { out } => {
                let failed = |error: io::Error| {
                    format!("{}: cannot write the pages: {error}; choose another folder with --out", out.display())
                };
                std::fs::create_dir_all(out).map_err(failed)?;
                clap_mangen::generate_to(command, out).map_err(failed)?;
                Ok(format!("{}: read with man -l {}\n", out.display(), out.join(format!("{name}.1")).display()))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use clap::{CommandFactory, Parser};

    use super::*;

    /// Says something.
    #[derive(Parser)]
    #[command(name = "tool", version)]
    struct Tool {
        #[command(subcommand)]
        manual: Manual,
    }

    #[test]
    fn every_shell_has_completions() {
        for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
            let tool = Tool::parse_from(["tool", "completions", shell]);
            let text = tool.manual.run(Tool::command()).expect("printed");
            assert!(text.contains("tool") && text.contains("completions") && text.contains("man"), "{shell}: {text}");
        }
    }

    #[test]
    fn every_command_has_a_page_and_pages_are_the_same_each_time() {
        let folder = tempfile::tempdir().expect("a folder");
        let pages = |name: &str| {
            let out = folder.path().join(name);
            let tool = Tool::parse_from(["tool", "man", "--out", &out.display().to_string()]);
            let said = tool.manual.run(Tool::command()).expect("written");
            assert!(said.contains("tool.1"), "{said}");
            ["tool.1", "tool-completions.1", "tool-man.1"]
                .map(|page| std::fs::read_to_string(out.join(page)).expect("a page"))
        };
        let first = pages("a/b");
        assert_eq!(first, pages("c"));
        assert!(first[0].contains("Says something") && first[2].contains("Folder for the pages"));
        std::fs::write(folder.path().join("file"), "").expect("written");
        let out = folder.path().join("file").display().to_string();
        let refused = Tool::parse_from(["tool", "man", "--out", &out]).manual.run(Tool::command());
        assert!(refused.expect_err("no folder").to_string().contains("choose another folder"));
    }
}
