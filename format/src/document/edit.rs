//! Byte-range splices.

use crate::write::Sink;
use std::ops::Range;

/// What takes the place of a range: text, and in one edit the content of a layer between two
/// texts.
pub(super) enum New {
    Text(String),
    Layer(String, String),
}

/// As [`splice`], into a sink; `content` writes what is between the texts of a layer.
pub(super) fn splice_to(
    text: &str,
    mut edits: Vec<(Range<usize>, New)>,
    sink: &mut Sink,
    mut content: impl FnMut(&mut Sink),
) {
    edits.sort_by_key(|(range, _)| range.start);
    let mut at = 0;
    for (range, new) in edits {
        debug_assert!(range.start >= at, "edits overlap");
        sink.put_text(&text[at..range.start]);
        match new {
            New::Text(new) => sink.text.push_str(&new),
            New::Layer(before, after) => {
                sink.text.push_str(&before);
                content(sink);
                sink.text.push_str(&after);
            }
        }
        at = range.end;
    }
    sink.put_text(&text[at..]);
}

/// Replaces ranges of `text`. Ranges must not overlap; they may touch, and are applied in
/// order of their start (stable for insertions at one place).
pub(super) fn splice(text: &str, mut edits: Vec<(Range<usize>, String)>) -> String {
    edits.sort_by_key(|(range, _)| range.start);
    let mut out = String::with_capacity(text.len() + edits.iter().map(|(_, new)| new.len()).sum::<usize>());
    let mut at = 0;
    for (range, new) in edits {
        debug_assert!(range.start >= at, "edits overlap");
        out.push_str(&text[at..range.start]);
        out.push_str(&new);
        at = range.end;
    }
    out.push_str(&text[at..]);
    out
}

/// End of the start tag of an element whose text is `element`: the offsets of its `>` (or
/// `/>`) and whether it closes itself. Quoted `>` are passed over.
pub(super) fn start_tag_end(element: &str) -> (usize, bool) {
    let bytes = element.as_bytes();
    let mut quote = None;
    for (i, &b) in bytes.iter().enumerate() {
        match (quote, b) {
            (Some(q), _) if q == b => quote = None,
            (Some(_), _) => {}
            (None, b'"' | b'\'') => quote = Some(b),
            (None, b'>') => {
                let closes = i > 0 && bytes[i - 1] == b'/';
                return (if closes { i - 1 } else { i }, closes);
            }
            (None, _) => {}
        }
    }
    (bytes.len(), false)
}

/// The name of an element with its prefix, from its text.
pub(super) fn tag_name(element: &str) -> &str {
    let name = element
        .get(1..)
        .and_then(|rest| rest.split(|c: char| c.is_whitespace() || c == '>' || c == '/').next());
    name.unwrap_or("")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn splices_apply_in_order() {
        let text = splice("abcdef", vec![(4..5, "X".into()), (0..0, "1".into()), (2..3, String::new())]);
        assert_eq!(text, "1abdXf");
    }

    #[test]
    fn start_tags_end_after_their_quotes() {
        assert_eq!(start_tag_end("<a b='>' c=\"/>\">x"), (15, false));
        assert_eq!(start_tag_end("<a/>"), (2, true));
    }
}
