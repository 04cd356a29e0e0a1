//! A step of an exploration: which forms it is made of, and a small picture (checklist R-053).

use super::expand::Expansion;
use super::lists::Reach;
use super::sheet::picture;
use super::{Run, fitted};
use crate::progress::Progress;
use kurbo::{Affine, Rect};
use rinceau_format::{Error, Form, FormItem, Step, path_data};
use std::fmt::Write;

/// Shapes of a picture at most.
const MOST: f64 = 600.0;
/// A picture is made in a square of this side.
const SIDE: f64 = 100.0;

/// What is kept of a run.
pub(super) fn step(run: &Run, expansion: &Expansion, progress: &mut dyn Progress) -> Result<Step, Error> {
    let used = run.lists.reached(run.root);
    let forms: Vec<&Form> = used.iter().map(|&form| &run.scene.forms[form]).collect();
    let reach = expansion.reach;
    let depth = run.lists.deepest(run.root, reach, MOST).max(1);
    let small = Expansion {
        reach: Reach { depth, ..reach },
        place: Affine::IDENTITY,
        decimals: 2,
        ..expansion.clone()
    };
    let bounds = run.survey(&small, progress)?.bounds;
    let place = bounds.and_then(|bounds| fitted(bounds, Rect::new(0.0, 0.0, SIDE, SIDE))).unwrap_or_default();
    Ok(Step {
        forms: forms.iter().map(|form| form.source.id.clone()).collect(),
        digest: digest(&used, &forms),
        picture: picture(&Expansion { place, ..small }),
    })
}

/// A number that is the same for the same forms, whatever their names and wherever
/// they stand in the file (FNV-1a, 64 bits).
fn digest(used: &[usize], forms: &[&Form]) -> String {
    let mut text = String::new();
    for form in forms {
        let _ = write!(text, "{:?}", form.overrides);
        for item in &form.items {
            match item {
                FormItem::Primitive(drawn) => {
                    let (path, style) = (&drawn.part.path, &drawn.part.style);
                    let data = path_data(&(drawn.part.transform * path.clone()), 3);
                    let _ = write!(text, "{:?}{}{data}", drawn.when, style.css());
                }
                FormItem::Clone(clone) => {
                    let form = used.iter().position(|&form| form == clone.form);
                    let _ = write!(text, "{form:?}");
                    for c in clone.transform.as_coeffs() {
                        let _ = write!(text, " {:.4}", c + 0.0);
                    }
                }
            }
        }
    }
    let hash = text
        .bytes()
        .fold(0xcbf2_9ce4_8422_2325_u64, |hash, b| (hash ^ u64::from(b)).wrapping_mul(0x100_0000_01b3));
    format!("{hash:016x}")
}
