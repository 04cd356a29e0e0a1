//! The published limits of the format, checked before anything is allocated for them.

/// How large a drawing may be. The defaults are the published limits of SPEC.md; tests
/// lower them to stand at the edge without building a 256 MiB file.
#[derive(Clone, Debug)]
pub struct Limits {
    /// Bytes of input, also after unzipping.
    pub bytes: usize,
    /// Elements, comments and runs of text.
    pub nodes: usize,
    /// Elements inside one another.
    pub depth: usize,
    /// Attributes of one element.
    pub attributes: usize,
    /// Namespace declarations of one element.
    pub namespaces: usize,
    /// Bytes that entity references may expand to, all together.
    pub expansion: usize,
    /// Copies that `<use>` makes inside annotated objects.
    pub instances: usize,
    /// Largest absolute coordinate, in user units.
    pub coordinate: f64,
    /// Bytes of style sheets.
    pub style_sheet: usize,
}

impl Default for Limits {
    fn default() -> Self {
        Limits {
            bytes: 256 << 20,
            nodes: 1_000_000,
            depth: 1_000,
            attributes: 4_096,
            namespaces: 256,
            expansion: 1 << 20,
            instances: 100_000,
            coordinate: 1e9,
            style_sheet: 1 << 20,
        }
    }
}
