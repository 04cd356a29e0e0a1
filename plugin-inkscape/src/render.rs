//! Drawings as pictures. A renderer may hang or fail on what an artist would never draw, so it works in a
//! process of its own that is ended when its time is over.

use crate::output;
use rinceau_format::{Error, generic_fonts};
use std::io::{Read, Write};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// What a drawing can be rendered to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Picture {
    Png,
    Pdf,
}

impl Picture {
    /// The name of the format.
    pub fn name(self) -> &'static str {
        match self {
            Picture::Png => "png",
            Picture::Pdf => "pdf",
        }
    }
}

/// Longest side of a picture in pixels.
pub const MOST_PIXELS: u32 = 16_384;
/// A drawing that takes longer is none that can be shown.
const LONGEST: Duration = Duration::from_secs(60);

/// Renders a drawing, of which a picture may be so many pixels wide; 0 for as many as it has.
///
/// Errors: the renderer does not manage.
pub fn render(svg: Vec<u8>, picture: Picture, width: u32) -> Result<Vec<u8>, Error> {
    let failed = |what: &str| {
        Error::new(
            "cannot-render",
            format!("The drawing cannot be made a picture: {what}"),
            "Open it in Inkscape and export it there",
        )
    };
    let program = std::env::current_exe().map_err(|error| failed(&error.to_string()))?;
    let mut child = Command::new(program)
        .args(["render", picture.name(), &width.to_string()])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .map_err(|error| failed(&error.to_string()))?;
    let (mut input, out, err) = (child.stdin.take(), child.stdout.take(), child.stderr.take());
    let writer = std::thread::spawn(move || input.as_mut().map(|input| input.write_all(&svg)));
    let read = |stream: Option<Box<dyn Read + Send>>| {
        std::thread::spawn(move || {
            let mut bytes = Vec::new();
            stream.map(|mut stream| stream.read_to_end(&mut bytes));
            bytes
        })
    };
    let out = read(out.map(|out| Box::new(out) as Box<dyn Read + Send>));
    let err = read(err.map(|err| Box::new(err) as Box<dyn Read + Send>));
    let end = Instant::now() + LONGEST;
    let status = loop {
        match child.try_wait() {
            Ok(Some(status)) => break status,
            Ok(None) if Instant::now() < end => std::thread::sleep(Duration::from_millis(2)),
            Ok(None) => {
                let _ = child.kill();
                let _ = child.wait();
                return Err(failed("it takes too long"));
            }
            Err(error) => return Err(failed(&error.to_string())),
        }
    };
    let _ = writer.join();
    let (bytes, message) = (out.join().unwrap_or_default(), err.join().unwrap_or_default());
    if status.success() {
        return Ok(bytes);
    }
    let message = String::from_utf8_lossy(&message);
    Err(failed(
        message.lines().next().filter(|_| status.code() == Some(1)).unwrap_or("it is beyond the renderer"),
    ))
}

/// The renderer itself: a drawing from standard input to standard output.
pub fn work(picture: &str, width: u32) -> Result<(), String> {
    // Deeply nested groups take a lot of stack.
    const STACK: usize = 256 << 20;
    let mut svg = Vec::new();
    std::io::stdin().lock().read_to_end(&mut svg).map_err(|error| error.to_string())?;
    let picture = picture.to_owned();
    let worker = std::thread::Builder::new().stack_size(STACK).spawn(move || match picture.as_str() {
        "png" => png(&svg, width),
        _ => pdf(&svg),
    });
    let done = worker.map_err(|error| error.to_string())?.join();
    let bytes = done.map_err(|_| "it is beyond the renderer".to_owned())??;
    output::write(None, &bytes).map_err(|error| error.to_string())
}

/// How a drawing is read, by either of the two versions of usvg that the renderers are built on.
macro_rules! options {
    ($usvg:ident) => {{
        let mut options = $usvg::Options::default();
        // Nothing is opened that the drawing points to.
        options.image_href_resolver.resolve_string = Box::new(|_, _| None);
        options.default_size = $usvg::Size::from_wh(300.0, 150.0).unwrap_or(options.default_size);
        options.fontdb_mut().load_system_fonts();
        let installed = options
            .fontdb
            .faces()
            .flat_map(|face| face.families.iter().map(|(name, _)| name.clone()))
            .collect();
        let [serif, sans, mono] = generic_fonts(&installed);
        options.font_family.clone_from(&serif);
        let fonts = options.fontdb_mut();
        fonts.set_serif_family(serif);
        fonts.set_sans_serif_family(sans);
        fonts.set_monospace_family(mono);
        options
    }};
}

fn png(svg: &[u8], width: u32) -> Result<Vec<u8>, String> {
    use resvg::{tiny_skia, usvg};
    let options = options!(usvg);
    let tree = usvg::Tree::from_data(svg, &options).map_err(|error| error.to_string())?;
    let size = tree.size();
    let wanted = if width > 0 { f64::from(width) } else { f64::from(size.width()) };
    let scale = wanted / f64::from(size.width());
    let most = f64::from(size.width().max(size.height())) * scale;
    if most > f64::from(MOST_PIXELS) {
        return Err(format!(
            "it would be {most:.0} pixels long, more than {MOST_PIXELS}; give a smaller --width"
        ));
    }
    let pixels = |side: f32| (f64::from(side) * scale).round().max(1.0) as u32;
    let (w, h) = (pixels(size.width()), pixels(size.height()));
    let mut pixmap = tiny_skia::Pixmap::new(w, h).ok_or("it has no size")?;
    let fit = tiny_skia::Transform::from_scale(w as f32 / size.width(), h as f32 / size.height());
    resvg::render(&tree, fit, &mut pixmap.as_mut());
    pixmap.encode_png().map_err(|error| error.to_string())
}

fn pdf(svg: &[u8]) -> Result<Vec<u8>, String> {
    use svg2pdf::usvg;
    let options = options!(usvg);
    let tree = usvg::Tree::from_data(svg, &options).map_err(|error| error.to_string())?;
    // CSS pixels are 1/96 of an inch, and so is the page.
    let page = svg2pdf::PageOptions { dpi: 96.0 };
    svg2pdf::to_pdf(&tree, svg2pdf::ConversionOptions::default(), page).map_err(|error| error.to_string())
}
