//! How like its example an arrangement is: numbers for a report.

use super::example::Analysis;
use super::ground::Ground;
use super::grow::Arrangement;
use super::{part, relax};
use std::collections::BTreeMap;

/// What one arrangement comes to.
#[derive(Clone, Debug)]
pub(super) struct Likeness {
    /// Root of the mean square by which rings differ from the example's, in mean edges.
    residual: f64,
    /// By how much the share of a symbol among all differs at most from the example's.
    symbols: f64,
    /// The same of pairs of symbols among neighbours.
    neighbours: f64,
    /// Share of neighbours that are copies of the same element of the example.
    repeats: f64,
    /// Standard deviation of edges over their mean, and that of the example's: all edges of both.
    spacing: f64,
    example_spacing: f64,
    /// Pairs that lie deeper in each other than the example's do.
    collisions: f64,
}

impl Likeness {
    pub fn new(arrangement: &Arrangement, example: &Analysis, ground: &Ground) -> Self {
        let symbol = |i: usize| example.elements[i].symbol;
        let copies = |i: u32| arrangement.objects[i as usize].copy.map(|copy| copy.0);
        let mut lengths = Vec::new();
        let (mut pairs, mut same) = (Vec::new(), 0.0);
        for &i in &arrangement.grown {
            let own = &arrangement.objects[i as usize];
            for &j in own.edges.iter().filter(|&&j| j > i) {
                let (Some(a), Some(b)) = (copies(i), copies(j)) else { continue };
                pairs.push(sorted(symbol(a), symbol(b)));
                same += f64::from(u8::from(a == b));
                lengths.push(ground.near(arrangement.objects[j as usize].at, own.at).distance(own.at));
            }
        }
        let edges = pairs.len().max(1) as f64;
        let grown = arrangement.grown.iter().filter_map(|&i| copies(i)).map(symbol);
        let at = |i: usize| example.elements[i].at;
        let drawn: Vec<f64> = example.edges.iter().map(|&(a, b)| at(a).distance(at(b))).collect();
        let drawn_pairs = example.edges.iter().map(|&(a, b)| sorted(symbol(a), symbol(b)));
        Likeness {
            residual: relax::residual(&arrangement.objects, ground) / example.mean,
            symbols: apart(&shares(grown), &shares(example.elements.iter().map(|one| one.symbol))),
            neighbours: apart(&shares(pairs.into_iter()), &shares(drawn_pairs)),
            repeats: same / edges,
            spacing: variation(&lengths),
            example_spacing: variation(&drawn),
            collisions: part::collisions(arrangement, example, ground) as f64,
        }
    }

    /// The worse of two, number by number.
    pub fn worse(self, other: Option<Likeness>) -> Likeness {
        let Some(other) = other else { return self };
        Likeness {
            residual: self.residual.max(other.residual),
            symbols: self.symbols.max(other.symbols),
            neighbours: self.neighbours.max(other.neighbours),
            repeats: self.repeats.max(other.repeats),
            spacing: self.spacing.max(other.spacing),
            example_spacing: self.example_spacing.max(other.example_spacing),
            collisions: self.collisions + other.collisions,
        }
    }

    /// As counts of an artwork.
    pub fn counts(&self) -> [(&'static str, f64); 7] {
        [
            ("residual", self.residual),
            ("symbols-apart", self.symbols),
            ("neighbours-apart", self.neighbours),
            ("repeats", self.repeats),
            ("spacing-variation", self.spacing),
            ("example-spacing-variation", self.example_spacing),
            ("collisions", self.collisions),
        ]
    }
}

fn sorted(a: usize, b: usize) -> (usize, usize) {
    (a.min(b), a.max(b))
}

fn shares<T: Ord>(items: impl Iterator<Item = T>) -> BTreeMap<T, f64> {
    let mut counts = BTreeMap::new();
    items.for_each(|item| *counts.entry(item).or_insert(0.0) += 1.0);
    let all: f64 = counts.values().sum();
    counts.values_mut().for_each(|count| *count /= all);
    counts
}

fn apart<T: Ord>(a: &BTreeMap<T, f64>, b: &BTreeMap<T, f64>) -> f64 {
    let share = |of: &BTreeMap<T, f64>, key: &T| of.get(key).copied().unwrap_or(0.0);
    a.keys().chain(b.keys()).map(|key| (share(a, key) - share(b, key)).abs()).fold(0.0, f64::max)
}

fn variation(lengths: &[f64]) -> f64 {
    let n = lengths.len().max(1) as f64;
    let mean = lengths.iter().sum::<f64>() / n;
    let squares = lengths.iter().map(|length| (length - mean).powi(2)).sum::<f64>() / n;
    if mean > 0.0 { squares.sqrt() / mean } else { 0.0 }
}
