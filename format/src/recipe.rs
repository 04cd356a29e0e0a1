//! What made a result layer, so that it can be made again.

use serde_json::{Map, Value};

/// Generator, parameters, seed and inputs of a result layer.
#[derive(Clone, Debug, PartialEq)]
pub struct Recipe {
    /// Name of the generator: `pack` and so on.
    pub generator: String,
    /// Parameters that differ from their defaults, by name.
    pub params: Map<String, Value>,
    /// The run's seed.
    pub seed: u64,
    /// Ids of the containers (or other main inputs), in drawing order.
    pub sources: Vec<String>,
    /// Other objects that were named for the run, such as lines that guide the flow.
    pub with: Vec<String>,
    /// Label of the layer, where a new one is made.
    pub label: String,
}

impl Recipe {
    /// `rinceau:source`: ids separated by spaces, white space inside an id as `%20` and so on.
    pub fn source_attribute(&self) -> String {
        list(&self.sources)
    }

    /// `rinceau:with`: the same for the other objects.
    pub fn with_attribute(&self) -> String {
        list(&self.with)
    }

    /// Reads such a list.
    pub(crate) fn parse_sources(text: &str) -> Vec<String> {
        let unescaped = |id: &str| {
            let spaces =
                SPACES.iter().fold(id.to_owned(), |id, &(c, escape)| id.replace(escape, &c.to_string()));
            spaces.replace("%25", "%")
        };
        text.split_ascii_whitespace().map(unescaped).collect()
    }
}

/// What separates ids in a list, and how it is written inside one.
const SPACES: [(char, &str); 5] =
    [(' ', "%20"), ('\t', "%09"), ('\n', "%0A"), ('\r', "%0D"), ('\u{c}', "%0C")];

fn list(ids: &[String]) -> String {
    ids.iter().map(|id| escaped(id)).collect::<Vec<_>>().join(" ")
}

fn escaped(id: &str) -> String {
    SPACES.iter().fold(id.replace('%', "%25"), |id, &(c, escape)| id.replace(c, escape))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ids_survive_their_list() {
        let sources: Vec<String> =
            ["a", "a b", "%20", "%2520", "a\t\n%", "\u{a0}\u{3000}"].map(str::to_owned).to_vec();
        let recipe = Recipe {
            generator: String::new(),
            params: Map::new(),
            seed: 0,
            sources: sources.clone(),
            with: Vec::new(),
            label: String::new(),
        };
        assert_eq!(Recipe::parse_sources(&recipe.source_attribute()), sources);
    }
}
