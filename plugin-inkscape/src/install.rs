//! `rinceau install`: the binary and its descriptions into Inkscape's user folder.

use crate::{inx, output};
use rinceau_format::Error;
use std::fs;
use std::path::{Path, PathBuf};

/// Copies this binary and writes its descriptions into `<extensions>/rinceau`.
///
/// Errors: no folder is known for this system; it cannot be written.
pub fn install(dir: Option<&Path>) -> Result<(), Error> {
    let extensions = match dir {
        Some(dir) => dir.to_owned(),
        None => user_extensions().ok_or_else(|| {
            Error::new(
                "no-folder",
                "Inkscape's user folder is not known here",
                "Name it with --dir; Inkscape shows it under Edit > Preferences > System > User extensions",
            )
        })?,
    };
    let folder = extensions.join("rinceau");
    let cannot = |what: &str, error: &std::io::Error| {
        Error::new(
            "cannot-install",
            format!("'{}' cannot be written: {error}", folder.join(what).display()),
            "Check the folder's permissions, or name another with --dir",
        )
    };
    fs::create_dir_all(folder.join("bin")).map_err(|error| cannot("bin", &error))?;
    let program = if cfg!(windows) { "bin/rinceau.exe" } else { "bin/rinceau" };
    let own = std::env::current_exe().and_then(fs::read).map_err(|error| cannot(program, &error))?;
    output::write(Some(&folder.join(program)), &own)?;
    make_executable(&folder.join(program)).map_err(|error| cannot(program, &error))?;
    // Descriptions of an older version, whose tools may be gone.
    for entry in fs::read_dir(&folder).map_err(|error| cannot("", &error))?.flatten() {
        if entry.path().extension().is_some_and(|extension| extension == "inx") {
            fs::remove_file(entry.path()).map_err(|error| cannot("", &error))?;
        }
    }
    for (name, content) in inx::all(program) {
        output::write(Some(&folder.join(name)), content.as_bytes())?;
    }
    output::write(Some(&folder.join(inx::PATTERNS.0)), inx::PATTERNS.1)?;
    println!("Installed in {}. Start Inkscape again and look under Extensions > Ornament.", folder.display());
    Ok(())
}

/// Inkscape's folder for extensions of this user. `INKSCAPE_PROFILE_DIR` wins, as it does for
/// Inkscape itself.
fn user_extensions() -> Option<PathBuf> {
    if let Some(profile) = std::env::var_os("INKSCAPE_PROFILE_DIR").filter(|profile| !profile.is_empty()) {
        return Some(PathBuf::from(profile).join("extensions"));
    }
    let home = |name: &str| std::env::var_os(name).filter(|home| !home.is_empty()).map(PathBuf::from);
    if cfg!(windows) {
        return Some(home("APPDATA")?.join("inkscape").join("extensions"));
    }
    if cfg!(target_os = "macos") {
        return Some(
            home("HOME")?
                .join("Library/Application Support/org.inkscape.Inkscape/config/inkscape/extensions"),
        );
    }
    let flatpak = home("HOME")?.join(".var/app/org.inkscape.Inkscape/config/inkscape");
    let native = home("XDG_CONFIG_HOME").unwrap_or(home("HOME")?.join(".config")).join("inkscape");
    // A Flatpak's folder only where there is no native one: the native program cannot see it.
    let base = if flatpak.is_dir() && !native.is_dir() { flatpak } else { native };
    Some(base.join("extensions"))
}

#[cfg(unix)]
fn make_executable(path: &Path) -> std::io::Result<()> {
    use std::os::unix::fs::PermissionsExt;
    fs::set_permissions(path, fs::Permissions::from_mode(0o755))
}

#[cfg(not(unix))]
fn make_executable(_: &Path) -> std::io::Result<()> {
    Ok(())
}
