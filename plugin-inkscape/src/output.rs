//! Reading the input and writing the output, whole or not at all.

use rinceau_format::{Error, Limits, printable, read_file};
use std::fs::{self, File};
use std::io::{self, IsTerminal, Read, Write};
use std::path::{Path, PathBuf};

/// Reads a file, or standard input, up to one byte more than the limit (which the document
/// then refuses).
pub fn read(path: Option<&Path>) -> Result<Vec<u8>, Error> {
    let most = Limits::default().bytes;
    let result = match path {
        Some(path) => read_file(path, most),
        None if io::stdin().is_terminal() => {
            return Err(Error::new(
                "no-input",
                "No drawing was given",
                "Name an SVG file, or pipe one to standard input",
            ));
        }
        None => {
            let mut bytes = Vec::new();
            io::stdin().take(most as u64 + 1).read_to_end(&mut bytes).map(|_| bytes)
        }
    };
    result.map_err(|error| {
        Error::new(
            "cannot-read",
            format!("The drawing '{}' cannot be read: {}", name(path), reason(&error)),
            "Check its name and that you may open it",
        )
    })
}

/// Writes a file, or standard output, at once. A file appears whole under its name or stays
/// as it was: a temporary file beside it is written, synced and renamed. A link stays a link,
/// and permissions stay as they were. A name that ends in `.svgz` is compressed.
pub fn write(path: Option<&Path>, bytes: &[u8]) -> Result<(), Error> {
    write_by(path, |out| Ok(out.write_all(bytes)))
}

/// The same by a function that writes piece after piece. Its own error leaves everything as it
/// was.
pub fn write_by(
    path: Option<&Path>,
    fill: impl FnOnce(&mut dyn Write) -> Result<io::Result<()>, Error>,
) -> Result<(), Error> {
    let mut refused = None;
    // The two kinds of errors go different ways.
    let fill = |out: &mut dyn Write| match fill(out) {
        Ok(written) => written,
        Err(error) => {
            refused = Some(error);
            Err(io::Error::other("refused"))
        }
    };
    let result = match path {
        Some(path) if is_zipped(path) => replace(path, |out| {
            let mut encoder = encoder(out);
            fill(&mut encoder)?;
            encoder.finish().map(drop)
        }),
        Some(path) => replace(path, fill),
        None => {
            let mut out = io::stdout().lock();
            fill(&mut out).and_then(|()| out.flush())
        }
    };
    if let Some(error) = refused {
        return Err(error);
    }
    result.map_err(|error| {
        Error::new(
            "cannot-write",
            format!("'{}' cannot be written: {}", name(path), reason(&error)),
            "Check the folder, its permissions and the free space; nothing was changed",
        )
    })
}

/// How much was written.
#[derive(Clone, Copy, Default)]
pub struct Size {
    bytes: usize,
    tags: usize,
    /// The last byte opened a tag.
    opened: bool,
}

impl Size {
    /// A sentence if it is more than a drawing may have to be opened again.
    pub fn warning(self) -> Option<String> {
        let Limits { bytes, nodes, .. } = Limits::default();
        let is_large = self.bytes > bytes || self.tags > nodes;
        is_large.then(|| {
            format!(
                "the drawing has {} MB and {} objects now, more than the {} MB and {nodes} objects that can be opened again here; for one that can, take fewer generations or larger elements, or flat paths",
                self.bytes / 1_000_000, self.tags, bytes / 1_000_000,
            )
        })
    }
}

/// Counts what it passes on.
pub struct Counted<'a> {
    pub out: &'a mut dyn Write,
    pub size: &'a mut Size,
}

impl Write for Counted<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.out.write(bytes)?;
        self.size.bytes += written;
        for &byte in &bytes[..written] {
            self.size.tags += usize::from(self.size.opened && byte != b'/');
            self.size.opened = byte == b'<';
        }
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}

/// Tells a person at the terminal something, whatever names are in it.
pub fn note(text: &str) {
    eprintln!("rinceau: note: {}", printable(text));
}

/// True for a name whose file is compressed.
pub fn is_zipped(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("svgz"))
}

/// What a compressed file holds.
pub fn zipped(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = encoder(Vec::new());
    // Memory takes everything.
    let _ = encoder.write_all(bytes);
    encoder.finish().unwrap_or_default()
}

/// No name and no time in the header: the same drawing is the same bytes.
fn encoder<W: Write>(out: W) -> flate2::write::GzEncoder<W> {
    flate2::GzBuilder::new().mtime(0).write(out, flate2::Compression::default())
}

/// Copies a file of any size to standard output as it is.
pub fn copy(path: &Path) -> io::Result<()> {
    let mut out = io::stdout().lock();
    io::copy(&mut File::open(path)?, &mut out)?;
    out.flush()
}

fn replace(path: &Path, fill: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    let target = followed(path);
    let existing = fs::metadata(&target).ok();
    if existing.as_ref().is_some_and(|metadata| !metadata.is_file()) {
        // A device or pipe such as /dev/stdout: there is nothing to replace.
        return fill(&mut File::options().write(true).open(&target)?);
    }
    let folder = target
        .parent()
        .filter(|folder| !folder.as_os_str().is_empty())
        .map_or_else(|| PathBuf::from("."), Path::to_owned);
    let mut builder = tempfile::Builder::new();
    builder.prefix(".rinceau-");
    #[cfg(unix)]
    builder.permissions({
        use std::os::unix::fs::PermissionsExt;
        // Narrowed by the umask, as for any new file.
        fs::Permissions::from_mode(0o666)
    });
    let mut file = builder.tempfile_in(folder)?;
    fill(file.as_file_mut())?;
    if let Some(metadata) = existing {
        file.as_file().set_permissions(metadata.permissions())?;
    }
    file.as_file().sync_all()?;
    file.persist(&target).map_err(|error| error.error)?;
    Ok(())
}

/// The file at the end of a chain of links. It need not exist yet; an open stream such as
/// `/dev/stdout` exists under no other name.
fn followed(path: &Path) -> PathBuf {
    // What Linux follows before it calls the chain a loop.
    const MOST_LINKS: usize = 40;
    if let Ok(target) = fs::canonicalize(path) {
        return target;
    }
    let mut path = path.to_owned();
    for _ in 0..MOST_LINKS {
        match fs::read_link(&path) {
            Ok(link) if !path.exists() => path = path.parent().unwrap_or(Path::new("")).join(link),
            _ => break,
        }
    }
    path
}

fn name(path: Option<&Path>) -> String {
    path.map_or_else(|| "standard stream".to_owned(), |path| path.display().to_string())
}

fn reason(error: &io::Error) -> String {
    error.to_string().split(" (os error").next().unwrap_or_default().to_lowercase()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tags are counted however the pieces fall, and what is too much for opening again is said.
    #[test]
    fn sizes_are_counted() {
        let (mut all, mut size) = (Vec::new(), Size::default());
        let mut counted = Counted { out: &mut all, size: &mut size };
        for piece in ["<svg><", "g/", "><g></g", "><", "/svg>"] {
            counted.write_all(piece.as_bytes()).unwrap();
        }
        assert_eq!((all.len(), size.bytes, size.tags), (22, 22, 3));
        assert_eq!(size.warning(), None);
        let large = Size { tags: 1_000_001, ..size };
        assert!(large.warning().is_some_and(|warning| warning.contains("1000001 objects")));
    }
}
