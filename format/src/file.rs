//! Files to bytes.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// Files from this size on are read in two halves at once. Most of the time of reading goes to
/// the pages that the bytes come to, which two threads can have made in half of it.
#[cfg(unix)]
const LARGE: u64 = 16 << 20;

/// The bytes of a file, at most `most` and one: [`Document`](crate::Document) then refuses it.
///
/// Errors: a file that cannot be read, or that becomes shorter meanwhile.
///
/// ```no_run
/// use rinceau_format::{Document, Limits, read_file};
///
/// let bytes = read_file("drawing.svg".as_ref(), Limits::default().bytes)?;
/// let document = Document::from_bytes(bytes)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn read_file(path: &Path, most: usize) -> io::Result<Vec<u8>> {
    let file = File::open(path)?;
    let metadata = file.metadata()?;
    let most = most as u64 + 1;
    #[cfg(unix)]
    if metadata.is_file() && metadata.len() >= LARGE {
        return in_halves(&file, metadata.len().min(most) as usize);
    }
    // Room at once, and one byte more, at which the end is found.
    let mut bytes = Vec::with_capacity(metadata.len().min(most) as usize + 1);
    file.take(most).read_to_end(&mut bytes)?;
    Ok(bytes)
}

#[cfg(unix)]
fn in_halves(file: &File, size: usize) -> io::Result<Vec<u8>> {
    use std::os::unix::fs::FileExt;

    let mut bytes = vec![0; size];
    let (first, second) = bytes.split_at_mut(size / 2);
    std::thread::scope(|scope| {
        let other = scope.spawn(|| file.read_exact_at(second, (size / 2) as u64));
        let read = file.read_exact_at(first, 0);
        read.and(other.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
    })?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn halves_are_the_whole() {
        let path = std::env::temp_dir().join(format!("rinceau-halves-{}", std::process::id()));
        for size in [0_usize, 1, 4095, 4096, (16 << 20) - 1, 16 << 20, (16 << 20) + 1] {
            let bytes: Vec<u8> = (0..size).map(|i| (i % 251) as u8).collect();
            std::fs::write(&path, &bytes).unwrap();
            assert!(read_file(&path, 256 << 20).unwrap() == bytes, "{size}");
            assert_eq!(read_file(&path, 17 << 19).unwrap().len(), size.min((17 << 19) + 1));
        }
        std::fs::remove_file(&path).unwrap();
        assert!(read_file(&path, 1).is_err());
    }
}
