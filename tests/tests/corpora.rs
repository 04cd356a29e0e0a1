//! Thousands of real drawings are read: no panic, at most a second each, hardly one refused.
//! Runs where `RINCEAU_CORPORA` is set, which `tests/run --corpora` does.

use rinceau_format::{Document, Selection};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

/// Folders of Debian's openclipart-svg, librsvg2-tests, breeze-icon-theme and inkscape.
const CORPORA: [&str; 5] = [
    "/usr/share/openclipart",
    "/usr/libexec/installed-tests/RSVG",
    "/usr/share/icons/breeze",
    "/usr/share/icons/breeze-dark",
    "/usr/share/inkscape",
];
/// Where librsvg keeps files that are no drawings, on purpose: they only must not panic.
const HOSTILE: [&str; 3] = ["fixtures/crash", "fixtures/errors", "fixtures/loading"];
/// At least this share of the others is read.
const READ: f64 = 0.9997;
/// A file beyond this size may take longer than [`LONGEST`].
const LARGE: usize = 20 << 20;
const LONGEST: Duration = Duration::from_secs(1);

/// What became of one file.
struct Outcome {
    path: PathBuf,
    bytes: usize,
    time: Duration,
    /// The reason code and the sentence of a refusal.
    refusal: Option<(String, String)>,
}

#[test]
fn real_drawings_are_read() {
    if std::env::var_os("RINCEAU_CORPORA").is_none() {
        println!("skipped: set RINCEAU_CORPORA to read the corpora (tests/run --corpora)");
        return;
    }
    let mut files = Vec::new();
    for corpus in CORPORA {
        gather(Path::new(corpus), &mut files);
    }
    files.sort();
    files.dedup();
    assert!(files.len() > 5_000, "only {} drawings: are the packages installed?", files.len());

    let outcomes = read_all(&files);
    let (mut real, mut refused) = (0u32, 0u32);
    let mut codes: BTreeMap<&str, usize> = BTreeMap::new();
    for outcome in &outcomes {
        let is_real = !HOSTILE.iter().any(|folder| outcome.path.to_string_lossy().contains(folder));
        real += u32::from(is_real);
        if let Some((code, sentence)) = &outcome.refusal {
            refused += u32::from(is_real);
            *codes.entry(code).or_default() += 1;
            println!("{}: {sentence}", outcome.path.display());
        }
    }
    for (code, count) in codes {
        println!("{count:6}  {code}");
    }
    let share = 1.0 - f64::from(refused) / f64::from(real);
    println!(
        "{} files; of {real} real drawings {refused} refused, {:.3} % read",
        outcomes.len(),
        100.0 * share
    );
    let slowest = outcomes.iter().max_by_key(|outcome| outcome.time).expect("a file");
    println!("slowest: {} in {:?}", slowest.path.display(), slowest.time);

    let slow = outcomes.iter().filter(|outcome| outcome.time > LONGEST && outcome.bytes < LARGE);
    let slow: Vec<String> =
        slow.map(|outcome| format!("{} {:?}", outcome.path.display(), outcome.time)).collect();
    assert!(slow.is_empty(), "over a second: {slow:#?}");
    assert!(share >= READ, "{:.3} % read", 100.0 * share);
}

/// Every SVG below a folder, links not followed.
fn gather(folder: &Path, files: &mut Vec<PathBuf>) {
    let Ok(entries) = folder.read_dir() else { return };
    for entry in entries.flatten() {
        let path = entry.path();
        match entry.file_type() {
            Ok(kind) if kind.is_dir() => gather(&path, files),
            Ok(kind) if kind.is_file() => {
                let is_drawing =
                    path.extension().is_some_and(|extension| extension == "svg" || extension == "svgz");
                if is_drawing {
                    files.push(path);
                }
            }
            _ => {}
        }
    }
}

fn read_all(files: &[PathBuf]) -> Vec<Outcome> {
    let next = AtomicUsize::new(0);
    let outcomes = Mutex::new(Vec::with_capacity(files.len()));
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                while let Some(path) = files.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let outcome = read(path);
                    outcomes.lock().expect("no panic while pushing").push(outcome);
                }
            });
        }
    });
    let mut outcomes = outcomes.into_inner().expect("no panic while pushing");
    outcomes.sort_by(|a, b| a.path.cmp(&b.path));
    outcomes
}

/// All that is read of a drawing before a generator runs.
fn read(path: &Path) -> Outcome {
    let bytes = std::fs::read(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let size = bytes.len();
    let start = Instant::now();
    let result = std::panic::catch_unwind(|| {
        let document = Document::from_bytes(bytes)?;
        document.scene(&Selection::default())?;
        document.layers()?;
        Ok::<(), rinceau_format::Error>(())
    });
    let time = start.elapsed();
    let result = result.unwrap_or_else(|_| panic!("{} panics", path.display()));
    let refusal = result.err().map(|error| (error.code().to_owned(), error.to_string()));
    Outcome { path: path.to_owned(), bytes: size, time, refusal }
}
