//! What the tests of the binary share: building it, running programs under a time limit, and
//! looking into drawings.

// Each test file compiles this module for itself and uses a part of it.
#![allow(dead_code)]

pub mod geometry;
pub mod packing;

use std::io::{Read, Write};
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::OnceLock;
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

/// The namespace of roles and result layers.
pub const RINCEAU: &str = "urn:rinceau:1";
/// Inkscape's namespace.
pub const INKSCAPE: &str = "http://www.inkscape.org/namespaces/inkscape";
/// Sodipodi's namespace, for locks.
pub const SODIPODI: &str = "http://sodipodi.sourceforge.net/DTD/sodipodi-0.dtd";

/// More than any command on a small drawing takes, also on a busy machine.
pub const SHORT: Duration = Duration::from_secs(30);

/// The repository's root.
pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the tests are a folder of the repository")
}

/// The drawings of `samples/pack`, in order of name.
pub fn samples() -> Vec<PathBuf> {
    geometry::samples_of("pack")
}

/// The binary, built once in the profile and target folder of the tests.
pub fn binary() -> &'static Path {
    static BINARY: OnceLock<PathBuf> = OnceLock::new();
    BINARY.get_or_init(|| {
        // A test is <target>/<profile>/deps/<name>, wherever the target folder was moved to.
        let test = std::env::current_exe().expect("a test knows its own path");
        let profile = test.ancestors().nth(2).expect("a test lies in <target>/<profile>/deps");
        let target = profile.parent().expect("a profile lies in the target folder");
        let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| env!("CARGO").into()));
        cargo.current_dir(root()).args(["build", "--quiet", "--locked", "-p", "rinceau-inkscape"]);
        cargo.arg("--target-dir").arg(target);
        if profile.ends_with("release") {
            cargo.arg("--release");
        }
        let done = Run::of(cargo).limit(Duration::from_secs(1200)).done();
        assert_eq!(done.code, Some(0), "the binary does not build:\n{}", done.stderr);
        profile.join(format!("rinceau{}", std::env::consts::EXE_SUFFIX))
    })
}

/// `rinceau` with these arguments.
pub fn rinceau<A: AsRef<std::ffi::OsStr>>(arguments: impl IntoIterator<Item = A>) -> Run {
    let mut command = Command::new(binary());
    command.args(arguments);
    Run::of(command)
}

/// A program about to run.
pub struct Run {
    pub command: Command,
    input: Vec<u8>,
    limit: Duration,
}

/// What a program did.
#[derive(Debug)]
pub struct Done {
    /// `None` if a signal ended it.
    pub code: Option<i32>,
    pub stdout: Vec<u8>,
    pub stderr: String,
    pub time: Duration,
}

impl Run {
    pub fn of(command: Command) -> Self {
        Run { command, input: Vec::new(), limit: SHORT }
    }

    /// Standard input; empty otherwise.
    pub fn input(mut self, input: impl Into<Vec<u8>>) -> Self {
        self.input = input.into();
        self
    }

    pub fn limit(mut self, limit: Duration) -> Self {
        self.limit = limit;
        self
    }

    pub fn arg(mut self, argument: impl AsRef<std::ffi::OsStr>) -> Self {
        self.command.arg(argument);
        self
    }

    pub fn args(mut self, arguments: &[&str]) -> Self {
        self.command.args(arguments);
        self
    }

    /// Runs it to its end. Panics if it is still running after the limit; it and whatever it
    /// started are then killed.
    pub fn done(mut self) -> Done {
        let name = format!("{:?}", self.command);
        let start = Instant::now();
        // A group of its own, so that the end of the time ends its children too.
        self.command.process_group(0);
        self.command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = self.command.spawn().unwrap_or_else(|error| panic!("{name}: {error}"));
        let mut stdin = child.stdin.take().expect("piped");
        let input = std::mem::take(&mut self.input);
        // A program may end without reading its input; that is for the caller to judge.
        let writer = thread::spawn(move || drop(stdin.write_all(&input)));
        let stdout = collect(child.stdout.take().expect("piped"));
        let stderr = collect(child.stderr.take().expect("piped"));
        let code = wait(&mut child, start + self.limit);
        if code.is_none() {
            let _ = Command::new("kill").args(["-KILL", "--", &format!("-{}", child.id())]).status();
            let _ = child.wait();
        }
        writer.join().expect("no panic while writing");
        let stdout = stdout.join().expect("no panic while reading");
        let stderr = stderr.join().expect("no panic while reading");
        let stderr = String::from_utf8_lossy(&stderr).into_owned();
        let code = code.unwrap_or_else(|| panic!("{name} ran longer than {:?}: {stderr}", self.limit));
        Done { code, stdout, stderr, time: start.elapsed() }
    }

    /// Runs it and panics unless it succeeds.
    pub fn succeed(self) -> Done {
        let name = format!("{:?}", self.command);
        let done = self.done();
        assert_eq!(done.code, Some(0), "{name}: {}", done.stderr);
        done
    }
}

impl Done {
    /// Standard output as text.
    pub fn text(&self) -> &str {
        std::str::from_utf8(&self.stdout).expect("text on standard output")
    }
}

/// The exit code (`None` inside: a signal), or `None` if the end of the time came first.
fn wait(child: &mut Child, end: Instant) -> Option<Option<i32>> {
    loop {
        if let Some(status) = child.try_wait().expect("the child is ours") {
            return Some(status.code());
        }
        if Instant::now() >= end {
            return None;
        }
        thread::sleep(Duration::from_millis(2));
    }
}

fn collect(mut from: impl Read + Send + 'static) -> JoinHandle<Vec<u8>> {
    thread::spawn(move || {
        let mut bytes = Vec::new();
        let _ = from.read_to_end(&mut bytes);
        bytes
    })
}

/// A temporary folder; everybody may enter it, as tests under another user need.
pub fn folder() -> tempfile::TempDir {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().expect("a temporary folder");
    std::fs::set_permissions(folder.path(), std::fs::Permissions::from_mode(0o755)).expect("our folder");
    folder
}

/// Writes a file into a folder and returns its path.
pub fn file(folder: &tempfile::TempDir, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
    let path = folder.path().join(name);
    std::fs::write(&path, content).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    path
}

/// A drawing of 200 by 200 px around some objects.
pub fn svg(body: &str) -> String {
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:rinceau=\"{RINCEAU}\" width=\"200\" height=\"200\" viewBox=\"0 0 200 200\">\n{body}\n</svg>\n"
    )
}

/// A shape to fill, marked.
pub const CIRCLE: &str = "<circle id=\"sun\" class=\"rinceau-container\" cx=\"100\" cy=\"100\" r=\"90\"/>";

/// Parses a drawing, DTD and all.
pub fn parse(text: &str) -> roxmltree::Document<'_> {
    let options = roxmltree::ParsingOptions { allow_dtd: true, ..Default::default() };
    roxmltree::Document::parse_with_options(text, options)
        .unwrap_or_else(|error| panic!("{error}:\n{text:.2000}"))
}

/// The result layers of a drawing.
pub fn layers<'a, 'i>(xml: &'a roxmltree::Document<'i>) -> Vec<roxmltree::Node<'a, 'i>> {
    xml.descendants().filter(|node| node.attribute((RINCEAU, "result")).is_some()).collect()
}

/// Copies of templates in a layer: every object of its `elements` sublayer that bears
/// `rinceau:of`.
pub fn elements<'a, 'i>(layer: roxmltree::Node<'a, 'i>) -> Vec<roxmltree::Node<'a, 'i>> {
    let sublayer = layer.children().find(|node| node.attribute((INKSCAPE, "label")) == Some("elements"));
    let sublayer = sublayer.expect("a sublayer of elements");
    sublayer.descendants().filter(|node| node.attribute((RINCEAU, "of")).is_some()).collect()
}

/// The object with this id.
pub fn by_id<'a, 'i>(xml: &'a roxmltree::Document<'i>, id: &str) -> roxmltree::Node<'a, 'i> {
    let found = xml.descendants().find(|node| node.attribute("id") == Some(id));
    found.unwrap_or_else(|| panic!("no object has the id '{id}'"))
}

/// Zips bytes.
pub fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::default());
    encoder.write_all(bytes).expect("memory");
    encoder.finish().expect("memory")
}

/// Unzips bytes.
pub fn gunzip(bytes: &[u8]) -> Vec<u8> {
    let mut out = Vec::new();
    flate2::read::MultiGzDecoder::new(bytes).read_to_end(&mut out).expect("a whole zip");
    out
}

/// The drawing without its one result layer and the line break before it, cut by hand: not
/// with the code under test.
pub fn without_layer(text: &str) -> String {
    let xml = parse(text);
    let [layer] = layers(&xml)[..] else { panic!("{} result layers", layers(&xml).len()) };
    let range = layer.range();
    let before = &text[..range.start];
    let before = before.strip_suffix("\r\n").or_else(|| before.strip_suffix('\n')).unwrap_or(before);
    format!("{before}{}", &text[range.end..])
}
