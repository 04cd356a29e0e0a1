//! Bytes that are no text, not all of it, or text in another encoding.

use crate::support::{artwork, recipe, svg};
use crate::{code, read, read_within};
use rinceau_format::{Document, Limits};
use std::time::Duration;

#[test]
fn compressed_drawings() {
    let gzip = |bytes: &[u8]| {
        let mut gz = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
        std::io::Write::write_all(&mut gz, bytes).unwrap();
        gz.finish().unwrap()
    };
    let whole = gzip(svg("<g/>").as_bytes());
    assert_eq!(code(whole.clone()), "read");
    for end in 2..whole.len() {
        assert_eq!(code(&whole[..end]), "broken-gzip", "{end}");
    }
    let limits = Limits { bytes: 8 << 20, ..Limits::default() };
    let bomb = gzip(&vec![b' '; 64 << 20]);
    let error = read_within(bomb, limits, Duration::from_secs(1)).unwrap_err();
    assert_eq!(error.code(), "too-large");
    let twice = gzip(&whole);
    assert!(["not-text", "not-xml"].contains(&code(twice)));
}

#[test]
fn truncated_and_foreign_bytes() {
    let text = format!(
        "\u{feff}<?xml version='1.0'?><!DOCTYPE svg [<!ENTITY e 'x'>]><!-- c --><?p q?>{}",
        svg("<g class='rinceau-fixed' style=\"a:b\">&e;<![CDATA[<]]><path d='M0 0é'/></g>")
    );
    for end in 0..text.len() {
        assert!(read(&text.as_bytes()[..end]).is_err(), "{end}");
    }
    for bytes in [
        &b""[..],
        b" ",
        b"\0",
        b"\xff",
        b"\xff\xfe",
        b"\xfe\xff\xd8",
        b"\xef\xbb\xbf",
        b"{}",
        b"%PDF-1.4",
        b"\x89PNG\r\n\x1a\n",
        b"<",
        b"<svg",
        b"<svg/",
        b"\x1f\x8b",
        b"<svg>\0</svg>",
        b"<\0s\0v\0g\0/\0>\0",
    ] {
        assert!(read(bytes).is_err(), "{bytes:?}");
    }
    assert_eq!(code("<?xml version='1.1'?><svg/>"), "read");
    assert_eq!(code("<?xml version='1.1'?><svg>&#1;</svg>"), "broken-xml");
    assert_eq!(code("<html/>"), "not-svg");
}

#[test]
fn every_encoding_keeps_its_bytes() {
    let text = svg("<path class='rinceau-container' id='é' d='M0 0h9v9z'/>").replace('\n', "\r\n");
    let utf16: Vec<u8> =
        [0xff, 0xfe].into_iter().chain(text.encode_utf16().flat_map(u16::to_le_bytes)).collect();
    let latin = |name: &str| {
        let declared = format!("<?xml version='1.0' encoding='{name}'?>{text}");
        declared.chars().map(|c| u8::try_from(u32::from(c)).unwrap()).collect::<Vec<u8>>()
    };
    let files = [utf16, latin("ISO-8859-1"), latin("windows-1252"), format!("\u{feff}{text}").into_bytes()];
    for bytes in files {
        let document = Document::from_bytes(bytes.clone()).unwrap();
        assert_eq!(document.to_bytes(), bytes);
        let layered = document.with_layer(&artwork(3), &recipe(&["é", "α"])).unwrap();
        let again = Document::from_bytes(layered.to_bytes()).unwrap();
        assert_eq!(again.layers().unwrap()[0].recipe.sources, ["é", "α"]);
        assert_eq!(again.without_layers().unwrap().to_bytes(), bytes);
    }
}
