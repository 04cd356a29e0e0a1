//! What is wrong with a scene before any generator runs: what each would refuse, all at once.

use crate::generate::GENERATORS;
use crate::grow::{self, RuleText};
use crate::shapes;
use rinceau_format::{Error, Scene, Source};
use std::collections::BTreeMap;

/// Containers that cannot be filled, parameters that no generator has or takes, and growth rules that
/// cannot be read.
pub fn faults(scene: &Scene) -> Vec<Error> {
    let mut found = shapes::faults(scene);
    let containers = scene.containers.iter().map(|one| (&one.source, &one.overrides));
    let sprays = scene.sprays.iter().map(|one| (&one.source, &one.overrides));
    let forms = scene.forms.iter().map(|one| (&one.source, &one.overrides));
    for (source, overrides) in containers.chain(sprays).chain(forms) {
        found.extend(parameters(source, overrides));
    }
    for rules in &scene.rules {
        let text = RuleText { name: rules.name.clone(), text: rules.text.clone() };
        found.extend(grow::check_rules(text).err());
    }
    found
}

/// Parameters of an object that no generator would take.
fn parameters(source: &Source, overrides: &BTreeMap<String, String>) -> Vec<Error> {
    let wrong = |(name, value): (&String, &String)| {
        let specs: Vec<_> =
            GENERATORS.iter().flat_map(|one| one.table).filter(|spec| spec.name == name).collect();
        if specs.is_empty() {
            return Some(source.error(
                "unknown-parameter",
                format!("'{}' sets '{name}', which no generator has", source.id),
                "Correct its spelling, or take it out",
            ));
        }
        let refused = specs.iter().map(|spec| spec.check(value.trim()).err());
        let refused: Option<Vec<Error>> = refused.collect();
        refused.and_then(|errors| errors.into_iter().next()).map(|error| error.at(source.at))
    };
    overrides.iter().filter_map(wrong).collect()
}
