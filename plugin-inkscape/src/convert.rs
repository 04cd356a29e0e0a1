//! `rinceau convert`: from one file format to another.

use crate::output;
use crate::render::{self, Picture};
use clap::ArgMatches;
use rinceau_format::{Document, Error, Scene, Selection};
use std::path::Path;

/// What is read: names of `--from`.
pub const FROM: [&str; 4] = ["svg", "json", "cfdg", "colours"];
/// What is written: names of `--to`.
pub const TO: [&str; 7] = ["svg", "svgz", "json", "png", "pdf", "cfdg", "colours"];

/// What was read.
enum Content {
    Drawing(Document),
    Scene(Box<Scene>),
}

/// Converts as a command line asks.
pub fn run(matches: &ArgMatches, input: Option<&Path>, out: Option<&Path>) -> Result<(), Error> {
    let text = |name: &str| matches.get_one::<String>(name).map(String::as_str);
    let to = text("to").map_or_else(|| format_of(out), |to| Ok(to.to_owned()))?;
    let width = matches.get_one::<u32>("width").copied().unwrap_or(0);
    let bytes = output::read(input)?;
    let (bytes, notes) = converted(
        bytes,
        text("from").or_else(|| from_of(input)),
        &to,
        Finish { artwork_only: matches.get_flag("artwork-only"), flat: matches.get_flag("flat"), width },
    )?;
    let is_zipped = to == "svgz" && !out.is_some_and(output::is_zipped);
    output::write(out, &if is_zipped { output::zipped(&bytes) } else { bytes })?;
    notes.iter().for_each(|note| output::note(note));
    Ok(())
}

/// What is done to a drawing before it is written.
#[derive(Clone, Copy, Debug, Default)]
pub struct Finish {
    pub artwork_only: bool,
    pub flat: bool,
    /// Of a picture in pixels; 0 for the drawing's.
    pub width: u32,
}

/// The bytes of a file in another format, svgz not yet compressed, and what was lost, in words.
pub fn converted(
    bytes: Vec<u8>,
    from: Option<&str>,
    to: &str,
    finish: Finish,
) -> Result<(Vec<u8>, Vec<String>), Error> {
    let is_scene = matches!(to, "json" | "cfdg" | "colours");
    if is_scene && (finish.artwork_only || finish.flat) || finish.width > 0 && to != "png" {
        return Err(Error::new(
            "unfit-option",
            format!("What is asked for does not go with the format {to}"),
            "--artwork-only and --flat make drawings and pictures, and --width is of a png",
        ));
    }
    let mut notes = Vec::new();
    let mut content = read(bytes, from, &mut notes)?;
    if finish.artwork_only || finish.flat {
        let document = drawing(content)?;
        content = Content::Drawing(match finish.flat {
            true => {
                let (flat, lost) = document.flat()?;
                notes.extend(lost);
                flat
            }
            false => document.artwork_only()?,
        });
    }
    let bytes = match to {
        "json" => scene(content, &mut notes)?.to_json().into_bytes(),
        "cfdg" => {
            let scene = scene(content, &mut notes)?;
            if scene.forms.is_empty() {
                return Err(Error::new(
                    "no-form",
                    "There is no recursive form in the drawing",
                    "Group a motif with clones of it, and mark the group as form",
                ));
            }
            let (text, lost) = scene.to_cfdg();
            notes.extend(lost);
            text.into_bytes()
        }
        "colours" => {
            let (document, lost) = Document::diagram(&scene(content, &mut notes)?)?;
            notes.extend(lost);
            document.to_bytes()
        }
        "png" => render::render(drawing(content)?.to_utf8(), Picture::Png, finish.width)?,
        "pdf" => render::render(drawing(content)?.to_utf8(), Picture::Pdf, finish.width)?,
        _ => drawing(content)?.to_bytes(),
    };
    Ok((bytes, notes))
}

fn read(bytes: Vec<u8>, from: Option<&str>, notes: &mut Vec<String>) -> Result<Content, Error> {
    let text = |bytes: Vec<u8>| {
        String::from_utf8(bytes).map_err(|_| {
            Error::new("not-text", "The file is no text in UTF-8", "Save it again as text in UTF-8")
        })
    };
    let looks_like_json = || bytes.iter().find(|b| !b.is_ascii_whitespace()) == Some(&b'{');
    match from {
        Some("json") => Ok(Content::Scene(Box::new(Scene::from_json(&text(bytes)?)?))),
        None if looks_like_json() => Ok(Content::Scene(Box::new(Scene::from_json(&text(bytes)?)?))),
        Some("cfdg") => {
            let (scene, lost) = Scene::from_cfdg(&text(bytes)?)?;
            notes.extend(lost);
            Ok(Content::Scene(Box::new(scene)))
        }
        Some("colours") => {
            let (document, doubts) = Document::from_bytes(bytes)?.with_roles_by_colour()?;
            notes.extend(doubts);
            Ok(Content::Drawing(document))
        }
        _ => Ok(Content::Drawing(Document::from_bytes(bytes)?)),
    }
}

fn drawing(content: Content) -> Result<Document, Error> {
    match content {
        Content::Drawing(document) => Ok(document),
        Content::Scene(scene) => Document::from_scene(&scene),
    }
}

fn scene(content: Content, notes: &mut Vec<String>) -> Result<Scene, Error> {
    match content {
        Content::Drawing(document) => {
            let scene = document.scene(&Selection::default())?;
            notes.extend(scene.warnings.clone());
            Ok(scene)
        }
        Content::Scene(scene) => Ok(*scene),
    }
}

fn extension(path: Option<&Path>) -> Option<String> {
    Some(path?.extension()?.to_str()?.to_ascii_lowercase())
}

/// The format of a file by its name; that of its content if its name says nothing.
fn from_of(path: Option<&Path>) -> Option<&'static str> {
    let extension = extension(path)?;
    FROM.into_iter().find(|&known| known == extension)
}

fn format_of(path: Option<&Path>) -> Result<String, Error> {
    let Some(path) = path else { return Ok("svg".to_owned()) };
    let extension = extension(Some(path)).unwrap_or_default();
    if TO.contains(&extension.as_str()) && extension != "colours" {
        return Ok(extension);
    }
    Err(Error::new(
        "unknown-format",
        format!("The name '{}' does not say in which format to write", path.display()),
        format!("End it in .{}, or say --to", TO[..6].join(" .")),
    ))
}
