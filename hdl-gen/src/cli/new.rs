//! `hdl-gen new`: a commented design file.

use std::error::Error;
use std::fs::OpenOptions;
use std::io::Write;
use std::path::Path;

use golden::design::Design;

const TEMPLATE: &str = include_str!("../../templates/design.toml");

/// Writes `NAME.toml` into `folder`, never over an existing file.
pub fn write(name: &str, folder: &Path) -> Result<(), Box<dyn Error>> {
    let text = TEMPLATE.replace("@NAME@", name);
    // The checks of a design file are those of the name, too.
    Design::from_toml(&text, &format!("{name}.toml"))?;
    let path = folder.join(format!("{name}.toml"));
    let failed = |error: std::io::Error| match error.kind() {
        std::io::ErrorKind::AlreadyExists => format!("{}: is there already; choose another name", path.display()),
        _ => format!("{}: cannot write: {error}; choose another folder with --dir", path.display()),
    };
    let mut file = OpenOptions::new().write(true).create_new(true).open(&path).map_err(failed)?;
    file.write_all(text.as_bytes()).map_err(failed)?;
    println!("{}: edit it, then run hdl-gen inspect {0} and hdl-gen generate {0}", path.display());
    Ok(())
}
