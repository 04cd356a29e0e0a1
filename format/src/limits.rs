//! The published limits of the format, checked before anything is allocated for them.

/// How large a drawing may be. The defaults are the published limits of SPEC.md; tests
/// lower them to stand at the edge without building a 256 MiB file.
#[derive(Clone, Debug)]
pub struct Limits {
    /// Bytes of input, also after unzipping.
    pub bytes: usize,
    /// Elements (each tag counts), comments and processing instructions.
    pub nodes: usize,
    /// Elements inside one another.
    pub depth: usize,
    /// Attributes of one element.
    pub attributes: usize,
    /// Namespace declarations of one element.
    pub namespaces: usize,
    /// Entity declarations.
    pub entities: usize,
    /// Bytes that entity references may expand to, all together.
    pub expansion: usize,
    /// Copies that `<use>` makes inside annotated objects.
    pub instances: usize,
    /// Elements inside those copies, all together.
    pub instance_nodes: usize,
    /// Bytes of the tags of those elements.
    pub instance_bytes: usize,
    /// Text objects inside annotated objects; each is laid out anew.
    pub texts: usize,
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
            entities: 1_024,
            expansion: 1 << 20,
            instances: 100_000,
            instance_nodes: 500_000,
            instance_bytes: 32 << 20,
            texts: 1_000,
            coordinate: 1e9,
            style_sheet: 1 << 20,
        }
    }
}
