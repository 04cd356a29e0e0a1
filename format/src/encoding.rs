//! Bytes to text and back, without losing one: gzip, byte-order marks, UTF-8, UTF-16,
//! and the single-byte encodings that old drawings declare.

use crate::error::Error;
use crate::limits::Limits;
use std::io::Read;

/// How the text of a drawing is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Encoding {
    Utf8,
    Utf8Bom,
    Utf16Le,
    Utf16Be,
    /// Whatever else the XML declaration names (ISO 8859, Windows code pages, KOI8, Shift JIS):
    /// every byte is read as one character and written back as that byte. Names may read
    /// strangely in messages, but tags, numbers and bytes are right in all of them.
    Bytes,
}

/// Decodes a file. Gzip is recognized by its magic bytes, whatever the file is called.
///
/// Errors: larger than `limits.bytes` (while unzipping, before it is all in memory),
/// broken gzip, bytes that are no text in the declared encoding.
pub(crate) fn decode(bytes: Vec<u8>, limits: &Limits) -> Result<(String, Encoding), Error> {
    let bytes = if bytes.starts_with(&[0x1f, 0x8b]) { gunzip(&bytes, limits)? } else { bytes };
    if bytes.len() > limits.bytes {
        return Err(too_large(limits));
    }
    match bytes.as_slice() {
        [0xEF, 0xBB, 0xBF, rest @ ..] => Ok((utf8(rest.to_vec())?, Encoding::Utf8Bom)),
        [0xFF, 0xFE, rest @ ..] => Ok((utf16(rest, u16::from_le_bytes)?, Encoding::Utf16Le)),
        [0xFE, 0xFF, rest @ ..] => Ok((utf16(rest, u16::from_be_bytes)?, Encoding::Utf16Be)),
        _ if declares_other(&bytes) => Ok((bytes.iter().map(|&b| char::from(b)).collect(), Encoding::Bytes)),
        _ => Ok((utf8(bytes)?, Encoding::Utf8)),
    }
}

/// Encodes edited text as the file was. Characters that the encoding lacks become numeric
/// references; they can only come from our own additions, which are attribute values.
pub(crate) fn encode(text: &str, encoding: Encoding) -> Vec<u8> {
    match encoding {
        Encoding::Utf8 => text.as_bytes().to_vec(),
        Encoding::Utf8Bom => [&[0xEF, 0xBB, 0xBF], text.as_bytes()].concat(),
        Encoding::Utf16Le => {
            [0xFF, 0xFE].into_iter().chain(text.encode_utf16().flat_map(u16::to_le_bytes)).collect()
        }
        Encoding::Utf16Be => {
            [0xFE, 0xFF].into_iter().chain(text.encode_utf16().flat_map(u16::to_be_bytes)).collect()
        }
        Encoding::Bytes => {
            let mut out = Vec::with_capacity(text.len());
            for c in text.chars() {
                match u8::try_from(u32::from(c)) {
                    Ok(byte) => out.push(byte),
                    Err(_) => out.extend(format!("&#{};", u32::from(c)).bytes()),
                }
            }
            out
        }
    }
}

fn gunzip(bytes: &[u8], limits: &Limits) -> Result<Vec<u8>, Error> {
    let mut out = Vec::new();
    let mut reader = flate2::read::MultiGzDecoder::new(bytes).take(limits.bytes as u64 + 1);
    reader.read_to_end(&mut out).map_err(|_| {
        Error::new(
            "broken-gzip",
            "The compressed drawing (svgz) is damaged or cut short",
            "Save it again, or use the uncompressed SVG",
        )
    })?;
    if out.len() > limits.bytes { Err(too_large(limits)) } else { Ok(out) }
}

fn too_large(limits: &Limits) -> Error {
    Error::new(
        "too-large",
        format!("The drawing is larger than {} MiB", limits.bytes >> 20),
        "Move what is to be filled into a smaller drawing; embedded pictures are the usual cause",
    )
}

fn utf8(bytes: Vec<u8>) -> Result<String, Error> {
    String::from_utf8(bytes).map_err(|error| {
        let valid = error.utf8_error().valid_up_to();
        let bytes = error.into_bytes();
        let before = String::from_utf8_lossy(&bytes[..valid]);
        not_text("The file is not text in UTF-8").at(crate::error::Position::of(&before, before.len()))
    })
}

fn utf16(bytes: &[u8], unit: fn([u8; 2]) -> u16) -> Result<String, Error> {
    let broken = || not_text("The file is not whole text in UTF-16");
    if !bytes.len().is_multiple_of(2) {
        return Err(broken());
    }
    let units = bytes.chunks_exact(2).map(|pair| unit([pair[0], pair[1]]));
    char::decode_utf16(units).collect::<Result<String, _>>().map_err(|_| broken())
}

fn not_text(sentence: &str) -> Error {
    Error::new("not-text", sentence, "Check that it is an SVG drawing, and save it again as plain SVG")
}

/// True if the XML declaration names an encoding that is none of Unicode's.
fn declares_other(bytes: &[u8]) -> bool {
    let head = String::from_utf8_lossy(&bytes[..bytes.len().min(200)]).to_ascii_lowercase();
    let Some((declaration, _)) = head.strip_prefix("<?xml").and_then(|rest| rest.split_once("?>")) else {
        return false;
    };
    let Some((_, value)) = declaration.split_once("encoding") else { return false };
    let name = value.trim_start_matches(|c: char| c.is_whitespace() || matches!(c, '=' | '"' | '\''));
    !["utf", "ucs", "iso-10646", "unicode"].iter().any(|unicode| name.starts_with(unicode))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;

    fn round_trip(bytes: &[u8]) {
        let (text, encoding) = decode(bytes.to_vec(), &Limits::default()).unwrap();
        assert_eq!(encode(&text, encoding), bytes);
    }

    #[test]
    fn every_encoding_round_trips() {
        round_trip("<svg>é</svg>".as_bytes());
        round_trip("\u{feff}<svg>é</svg>".as_bytes());
        round_trip(b"<?xml version='1.0' encoding='ISO-8859-1'?>\r\n<svg>\xe9</svg>");
        round_trip(b"<?xml version=\"1.0\" encoding=\"windows-1251\"?><svg>\xcf\x98</svg>");
        for encoding in [Encoding::Utf16Le, Encoding::Utf16Be] {
            round_trip(&encode("<svg>é𝄞</svg>", encoding));
        }
    }

    #[test]
    fn what_an_encoding_lacks_becomes_a_reference() {
        let ascii = b"<?xml version='1.0' encoding='ISO-8859-1'?><svg></svg>".to_vec();
        let (text, encoding) = decode(ascii, &Limits::default()).unwrap();
        assert!(encode(&text.replace("></", ">\u{e9}\u{3b1}</"), encoding).ends_with(b">\xe9&#945;</svg>"));
    }

    #[test]
    fn a_gzip_bomb_stops_at_the_limit() {
        let mut gz = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::best());
        gz.write_all(&vec![b' '; 1 << 20]).unwrap();
        let limits = Limits { bytes: 1 << 16, ..Limits::default() };
        assert_eq!(decode(gz.finish().unwrap(), &limits).unwrap_err().code(), "too-large");
    }

    #[test]
    fn broken_bytes_are_refused_with_a_position() {
        let error = decode(b"<svg>\n \xff</svg>".to_vec(), &Limits::default()).unwrap_err();
        assert_eq!(error.position().unwrap().to_string(), "2:2");
    }
}
