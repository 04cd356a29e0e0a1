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
    /// Label of the layer, where a new one is made.
    pub label: String,
}

impl Recipe {
    /// `rinceau:source`: ids separated by spaces, spaces inside an id as `%20`.
    pub fn source_attribute(&self) -> String {
        let escaped: Vec<String> =
            self.sources.iter().map(|id| id.replace('%', "%25").replace(' ', "%20")).collect();
        escaped.join(" ")
    }

    /// Reads `rinceau:source`.
    pub(crate) fn parse_sources(text: &str) -> Vec<String> {
        text.split_whitespace().map(|id| id.replace("%20", " ").replace("%25", "%")).collect()
    }
}
