//! The built-in elements: `samples/elements/builtin.svg`, read like any drawing.

use super::template::Template;
use rinceau_format::{Document, Error, Selection};

const DRAWING: &str = include_str!("../../../samples/elements/builtin.svg");

/// Every built-in element. Never errs on the drawing as it is; a test reads it.
pub(super) fn templates() -> Result<Vec<Template>, Error> {
    let scene = Document::from_bytes(DRAWING.as_bytes().to_vec())?.scene(&Selection::default())?;
    scene.elements.iter().map(|element| Template::new(element, true)).collect()
}

#[cfg(test)]
mod tests {
    use super::super::params::FAMILIES;
    use super::super::template::Side;
    use super::*;

    #[test]
    fn every_family_can_fill_a_shape_on_its_own() {
        let templates = templates().unwrap();
        assert!(templates.len() >= 12);
        for (family, _) in FAMILIES.iter().skip(2) {
            let of = |full: bool| {
                templates
                    .iter()
                    .filter(|t| t.names.iter().any(|n| n == family) && (t.side == Side::Full) == full)
                    .count()
            };
            assert!(of(true) >= 2 && of(false) >= 1, "{family}: {} full, {} half", of(true), of(false));
        }
    }
}
