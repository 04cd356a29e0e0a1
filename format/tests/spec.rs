//! The examples of SPEC.md are what it says they are.

use rinceau_format::{Document, Error, NAMESPACE, Role, Selection};

const SPEC: &str = include_str!("../SPEC.md");

/// Fenced blocks that start with `svg`: what follows that word, and the block.
fn examples() -> Vec<(&'static str, &'static str)> {
    let blocks = SPEC.split("\n```svg ").skip(1);
    blocks
        .map(|block| block.split_once("\n```").map_or(block, |(block, _)| block))
        .map(|block| block.split_once('\n').unwrap_or((block, "")))
        .collect()
}

fn read(text: &str) -> Result<Vec<String>, Error> {
    let document = Document::from_bytes(text.as_bytes().to_vec())?;
    document.layers()?;
    Ok(document.scene(&Selection::default())?.warnings)
}

#[test]
fn valid_examples_are_read_and_invalid_ones_refused() {
    for (kind, text) in examples() {
        match (kind.split_once(' '), read(text)) {
            (None, result) if kind == "valid" => assert_eq!(result, Ok(Vec::new()), "{text}"),
            (Some(("invalid", code)), Err(error)) => assert_eq!(error.code(), code, "{text}"),
            (_, result) => panic!("{kind}: {result:?}\n{text}"),
        }
    }
}

#[test]
fn every_role_has_its_examples() {
    let reserved = [Role::Rules];
    for role in Role::ALL {
        let name = role.name();
        if reserved.contains(&role) {
            assert!(SPEC.contains(&format!("`{name}`")), "{name}");
            continue;
        }
        let section = SPEC.split(&format!("\n### {name}\n")).nth(1).unwrap_or_default();
        let section = section.split("\n### ").next().unwrap_or_default();
        assert!(section.contains("```svg valid") && section.contains("```svg invalid"), "{name}");
    }
    assert!(SPEC.contains(NAMESPACE));
}

#[test]
fn every_code_of_this_crate_is_listed() {
    let mut codes = Vec::new();
    let mut folders = vec![std::path::PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("src")];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            let text = std::fs::read_to_string(&path).unwrap();
            let code_text = text.split("#[cfg(test)]").next().unwrap_or_default();
            for call in ["Error::new(", ".error("] {
                let after = code_text.split(call).skip(1).map(str::trim_start);
                let code = after.filter_map(|rest| rest.strip_prefix('"')?.split('"').next());
                codes.extend(code.map(str::to_owned));
            }
        }
    }
    assert!(codes.len() > 20);
    for code in codes {
        assert!(SPEC.contains(&format!("| `{code}` |")), "{code} is not in SPEC.md");
    }
}
