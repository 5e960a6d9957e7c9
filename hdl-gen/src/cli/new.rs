//! `hdl-gen new`: a commented design file.

use std::error::Error;
use std::io::{ErrorKind, Write};
use std::path::Path;

use golden::design::Design;

const TEMPLATE: &str = include_str!("../../templates/design.toml");

/// Writes `NAME.toml` into `folder`, the whole file or none, never over an existing one; returns what to do next.
pub fn write(name: &str, folder: &Path) -> Result<String, Box<dyn Error>> {
    // Quoted, so that whatever the name holds reaches the check of names; a JSON string is a TOML string.
    let text = TEMPLATE.replace("\"@NAME@\"", &serde_json::to_string(name)?);
    Design::from_toml(&text, "hdl-gen new")?;
    let path = folder.join(format!("{name}.toml"));
    let failed = |error: std::io::Error| match error.kind() {
        ErrorKind::AlreadyExists => format!("{}: is there already; choose another name", path.display()),
        _ => format!("{}: cannot write the file: {error}; choose another folder with --dir", path.display()),
    };
    if !folder.is_dir() {
        return Err(format!("{}: is no folder; make it first or choose another with --dir", folder.display()).into());
    }
    let mut builder = tempfile::Builder::new();
    builder.prefix(".hdl-gen-");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // As for any new file, the umask decides.
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    let mut file = builder.tempfile_in(folder).map_err(failed)?;
    file.write_all(text.as_bytes()).map_err(failed)?;
    file.persist_noclobber(&path).map_err(|error| failed(error.error))?;
    Ok(format!("{}: edit it, then run hdl-gen inspect {0} and hdl-gen generate {0}\n", path.display()))
}
