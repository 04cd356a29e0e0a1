//! Thousands of real drawings are read: no panic, at most a second each, hardly one refused.
//! Runs where `RINCEAU_CORPORA` is set, which `tests/run --corpora` does.

use kurbo::{Rect, Shape};
use resvg::{tiny_skia, usvg};
use rinceau::{Deadline, GENERATORS, Values};
use rinceau_format::{Document, Recipe, Selection};
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

/// Every drawing of the corpora, if they are asked for.
fn corpora() -> Option<Vec<PathBuf>> {
    if std::env::var_os("RINCEAU_CORPORA").is_none() {
        println!("skipped: set RINCEAU_CORPORA to read the corpora (tests/run --corpora)");
        return None;
    }
    let mut files = Vec::new();
    for corpus in CORPORA {
        gather(Path::new(corpus), &mut files);
    }
    files.sort();
    files.dedup();
    assert!(files.len() > 5_000, "only {} drawings: are the packages installed?", files.len());
    Some(files)
}

#[test]
fn real_drawings_are_read() {
    let Some(files) = corpora() else { return };
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

/// A shape of a real drawing is packed: every byte outside the layer is what it was, the picture outside the
/// shape too, and without the layer the file is back.
#[test]
fn real_drawings_lose_nothing() {
    /// One of so many files: each is rendered twice.
    const EVERY: usize = 12;
    /// Larger ones take long to render.
    const LARGEST: u64 = 300_000;
    let Some(files) = corpora() else { return };
    let is_tried = |path: &&PathBuf| {
        !HOSTILE.iter().any(|folder| path.to_string_lossy().contains(folder))
            && path.metadata().is_ok_and(|metadata| metadata.len() < LARGEST)
    };
    let files: Vec<&PathBuf> = files.iter().filter(is_tried).step_by(EVERY).collect();
    let next = AtomicUsize::new(0);
    let filled = AtomicUsize::new(0);
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                while let Some(path) = files.get(next.fetch_add(1, Ordering::Relaxed)) {
                    filled.fetch_add(usize::from(loses_nothing(path)), Ordering::Relaxed);
                }
            });
        }
    });
    let filled = filled.into_inner();
    println!("{} drawings, of which {filled} have a shape that was packed", files.len());
    assert!(filled * 3 > files.len(), "only {filled} of {}", files.len());
}

/// False if the drawing has no shape that can be filled.
fn loses_nothing(path: &Path) -> bool {
    let name = path.display();
    let bytes = std::fs::read(path).unwrap_or_else(|error| panic!("{name}: {error}"));
    let Ok(document) = Document::from_bytes(bytes.clone()) else { return false };
    let Some((filled, area)) = packed(&document) else { return false };
    let unzipped = document.to_bytes();
    let after = filled.to_bytes();
    let same = |pair: &(&u8, &u8)| pair.0 == pair.1;
    let before = unzipped.iter().zip(&after).take_while(same).count();
    let behind = unzipped.iter().rev().zip(after.iter().rev()).take_while(same).count();
    assert!(before + behind >= unzipped.len(), "{name}: a byte outside the layer changed");
    let without = filled.without_layers().unwrap_or_else(|error| panic!("{name}: {error}"));
    assert_eq!(without.to_bytes(), unzipped, "{name}: the file does not come back");
    let (Some(first), Some(second)) = (picture(&document.to_utf8()), picture(&filled.to_utf8())) else {
        return true;
    };
    assert_eq!((first.width(), first.height()), (second.width(), second.height()), "{name}");
    // From units of the page to pixels, about; a ragged edge of a pixel more may be drawn.
    let view = document.scene(&Selection::default()).expect("read before").view;
    let scale = f64::from(first.width()).min(f64::from(first.height())) / view.size().min_side();
    let aspect = view.width() / view.height() - f64::from(first.width()) / f64::from(first.height());
    if aspect.abs() > 0.02 * view.width() / view.height() {
        return true;
    }
    let area = Rect::new(area.x0 - view.x0, area.y0 - view.y0, area.x1 - view.x0, area.y1 - view.y0);
    let area = area.scale_from_origin(scale).inflate(3.0, 3.0);
    let width = first.width() as usize;
    for (i, (a, b)) in first.pixels().iter().zip(second.pixels()).enumerate() {
        let at = kurbo::Point::new((i % width) as f64 + 0.5, (i / width) as f64 + 0.5);
        assert!(a == b || area.contains(at), "{name}: the picture changed at {at:?}, outside {area:?}");
    }
    true
}

/// The drawing with a few elements packed into one of its shapes, and the box around that.
fn packed(document: &Document) -> Option<(Document, Rect)> {
    const MOST_TRIED: usize = 12;
    let generator = GENERATORS.iter().find(|generator| generator.name == "pack")?;
    let xml = roxmltree::Document::parse_with_options(
        document.text(),
        roxmltree::ParsingOptions { allow_dtd: true, ..roxmltree::ParsingOptions::default() },
    )
    .ok()?;
    let is_shape = |node: &roxmltree::Node| {
        matches!(node.tag_name().name(), "path" | "rect" | "circle" | "ellipse" | "polygon")
    };
    let ids = xml.descendants().filter(is_shape).filter_map(|node| node.attribute("id")).take(MOST_TRIED);
    for id in ids {
        let selection = Selection { ids: vec![id.to_owned()] };
        let Ok(scene) = document.scene(&selection) else { continue };
        let [container] = &scene.containers[..] else { continue };
        let bounds = container.outlines.iter().map(|outline| outline.path.bounding_box());
        let area = bounds.reduce(|a, b| a.union(b))?;
        let spacing = 0.3 * area.size().min_side();
        if spacing.is_nan() || spacing <= 1e-3 * scene.view.size().max_side() {
            continue;
        }
        let mut values = Values::default();
        values.set(generator.table, "spacing", &format!("{spacing:.6}")).ok()?;
        values.set(generator.table, "iterations", "1").ok()?;
        let mut limit = Deadline::new(Some(Duration::from_secs(2)));
        let Ok(artwork) = rinceau::generate(generator, &values, &scene, 1, &mut limit) else { continue };
        let recipe = Recipe {
            generator: "pack".into(),
            params: values.recipe(generator.table),
            seed: 1,
            sources: vec![container.source.id.clone()],
            with: Vec::new(),
            label: "Ornament".into(),
        };
        // A shape in an entity, or a prefix that is taken, is refused with a sentence.
        if let Ok(filled) = document.with_layer(&artwork, &recipe) {
            return Some((filled, area));
        }
    }
    None
}

/// A small picture of a drawing.
fn picture(svg: &[u8]) -> Option<tiny_skia::Pixmap> {
    const SIDE: f32 = 240.0;
    let mut options = usvg::Options::default();
    options.image_href_resolver.resolve_string = Box::new(|_, _| None);
    let tree = usvg::Tree::from_data(svg, &options).ok()?;
    let scale = SIDE / tree.size().width().max(tree.size().height());
    let side = |length: f32| ((length * scale).round() as u32).max(1);
    let mut pixmap = tiny_skia::Pixmap::new(side(tree.size().width()), side(tree.size().height()))?;
    resvg::render(&tree, tiny_skia::Transform::from_scale(scale, scale), &mut pixmap.as_mut());
    Some(pixmap)
}
