//! `rinceau install` and `uninstall`: the binary and its descriptions in Inkscape's user folder.

use crate::{diagnostics, inx, output};
use rinceau_format::Error;
use std::fs;
use std::path::{Path, PathBuf};

/// The program in our folder.
const PROGRAM: &str = if cfg!(windows) { "bin/rinceau.exe" } else { "bin/rinceau" };

/// Copies this binary and writes its descriptions into `<extensions>/rinceau`.
///
/// Errors: no folder is known for this system; it cannot be written.
pub fn install(dir: Option<&Path>) -> Result<(), Error> {
    let folder = folder(dir)?;
    let cannot = |what: &str, error: &std::io::Error| {
        Error::new(
            "cannot-install",
            format!("'{}' cannot be written: {error}", folder.join(what).display()),
            "Check the folder's permissions, or name another with --dir",
        )
    };
    fs::create_dir_all(folder.join("bin")).map_err(|error| cannot("bin", &error))?;
    let own = std::env::current_exe().and_then(fs::read).map_err(|error| cannot(PROGRAM, &error))?;
    output::write(Some(&program(&folder)), &own)?;
    make_executable(&program(&folder)).map_err(|error| cannot(PROGRAM, &error))?;
    // Descriptions of an older version, whose tools may be gone.
    for entry in fs::read_dir(&folder).map_err(|error| cannot("", &error))?.flatten() {
        if entry.path().extension().is_some_and(|extension| extension == "inx") {
            fs::remove_file(entry.path()).map_err(|error| cannot("", &error))?;
        }
    }
    for (name, content) in inx::all(PROGRAM) {
        output::write(Some(&folder.join(name)), content.as_bytes())?;
    }
    for picture in &inx::PICTURES {
        output::write(Some(&folder.join(picture.name)), picture.content)?;
    }
    println!("Installed in {}. Start Inkscape again and look under Extensions > Ornament.", folder.display());
    Ok(())
}

/// Takes out what [`install`] has put in, and the folder if nothing else is in it.
///
/// Errors: no folder is known for this system; it is not installed there; something cannot be removed.
pub fn uninstall(dir: Option<&Path>) -> Result<(), Error> {
    let folder = folder(dir)?;
    if !folder.is_dir() {
        return Err(Error::new(
            "not-installed",
            format!("There is no extension in '{}'", folder.display()),
            "Name the folder of Inkscape's extensions with --dir",
        ));
    }
    let cannot = |path: &Path, error: &std::io::Error| {
        Error::new(
            "cannot-install",
            format!("'{}' cannot be removed: {error}", path.display()),
            "Close Inkscape and check the folder's permissions",
        )
    };
    let pictures = inx::PICTURES.iter().map(|picture| picture.name);
    let ours = ["bin/rinceau", "bin/rinceau.exe"].into_iter().chain(pictures).map(|name| folder.join(name));
    let memory = folder.join("bin").join(diagnostics::FILE);
    let entries = fs::read_dir(&folder).map_err(|error| cannot(&folder, &error))?;
    let descriptions = entries.flatten().map(|entry| entry.path());
    let descriptions =
        descriptions.filter(|path| path.extension().is_some_and(|extension| extension == "inx"));
    for path in descriptions.chain(ours).chain([memory]).filter(|path| path.is_file()) {
        fs::remove_file(&path).map_err(|error| cannot(&path, &error))?;
    }
    // Whatever else somebody has put there stays.
    let _ = fs::remove_dir(folder.join("bin"));
    let _ = fs::remove_dir(&folder);
    println!("Removed from {}.", folder.display());
    Ok(())
}

/// The program that is installed in a folder.
pub fn program(folder: &Path) -> PathBuf {
    folder.join(PROGRAM)
}

/// The folder of this extension.
pub fn folder(dir: Option<&Path>) -> Result<PathBuf, Error> {
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
    Ok(extensions.join("rinceau"))
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
    let snap = home("HOME")?.join("snap/inkscape/current/.config/inkscape");
    let native = home("XDG_CONFIG_HOME").unwrap_or(home("HOME")?.join(".config")).join("inkscape");
    // That of a Flatpak or a Snap only where there is no native one: the native program cannot see it.
    let boxed = [flatpak, snap].into_iter().find(|folder| folder.is_dir() && !native.is_dir());
    let base = boxed.unwrap_or(native);
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
