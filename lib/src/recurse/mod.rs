//! Recursive forms: a motif that repeats itself.
//!
//! Christopher Carlson, Robert Woodbury: *Hands-On Exploration of Recursive Forms*, 1990.
//!
//! 1. Make display lists of the drawn forms: `lists`.
//! 2. Count what they would draw before anything is drawn, and refuse too much.
//! 3. Walk through them in paint order: `expand`; the artwork is made while it is
//!    written.
//! 4. Or write a chain of clones that the editor expands: `clones`.
//! 5. On request join lines (`join`), colour generations (`colour`), show a sheet of neighbours
//!    (`sheet`), or keep the form on a map of the exploration (`history`).
//!
//! Beyond the paper: several forms that refer to each other (its first extension, R-051), any
//! shape as primitive, primitives of the last or the inner generations alone, a smallest size.
//!
//! Departures: the paper's limit is the machine of 1990; here a count that is known beforehand.
//! A form may be fitted into a container, so that a motif can be drawn beside its form. Into a container
//! without any form goes a built-in one (`builtin`).

mod builtin;
mod clones;
mod colour;
mod expand;
mod history;
mod join;
mod lists;
mod params;
mod sheet;

pub use params::Params;

use crate::progress::Progress;
use crate::rng::Rng;
use clones::{chain, fitted};
use colour::Ramp;
use expand::{Expansion, Looks, Step};
use join::{Join, Joiner};
use kurbo::{Affine, Point, Rect, Shape};
use lists::{Lists, Reach};
use rinceau_format::{Artwork, Error, Form, FormItem, Group, Item, Part, Scene, Source, Style, decimals_for};
use std::collections::BTreeMap;
use std::sync::Arc;

/// A copy this many times larger than the drawing is on no page.
const LARGEST: f64 = 1e4;
/// Lists entered for a first look at how large a form is.
const FIRST_LOOK: f64 = 50_000.0;
/// Paths of one form at most, whatever is allowed: they would be a file of many gigabytes.
const MOST_PATHS: f64 = 2e7;
/// Generations of a chain of clones at most. Viewers follow a chain by recursion: at a thousand some
/// run out of stack.
const LONGEST_CHAIN: usize = 300;

/// The forms of a scene that are drawn for their own sake.
pub fn sources(scene: &Scene) -> Vec<&Source> {
    if scene.forms.is_empty() {
        return scene.containers.iter().map(|container| &container.source).collect();
    }
    scene.forms.iter().filter(|form| form.is_root).map(|form| &form.source).collect()
}

/// Expands the forms of a scene.
///
/// Errors: no form, one that draws nothing or too much, a parameter that it cannot have.
pub fn generate(
    params: &Params,
    scene: &Scene,
    _rng: &mut Rng,
    progress: &mut dyn Progress,
) -> Result<Artwork, Error> {
    progress.step("prepare", 0.0);
    let built_in;
    let mut scene = scene;
    let is_built_in = scene.forms.is_empty();
    if is_built_in {
        built_in = builtin::with_form(params, scene)?;
        scene = &built_in;
    }
    let lists = Arc::new(Lists::new(&scene.forms));
    let mut artwork = Artwork {
        complete: true,
        warnings: scene.warnings.clone(),
        decimals: decimals_for(scene.view.size().max_side()),
        ..Artwork::default()
    };
    // A selected group is both a form and a shape.
    let is_form = |id: &String| scene.forms.iter().any(|form| form.source.id == *id);
    let frames: Vec<_> = scene.containers.iter().filter(|container| !is_form(&container.source.id)).collect();
    let roots: Vec<usize> = (0..scene.forms.len()).filter(|&i| scene.forms[i].is_root).collect();
    for (number, &root) in roots.iter().enumerate() {
        let form = &scene.forms[root];
        let overrides = form.overrides.iter().map(|(name, value)| (name.as_str(), value.as_str()));
        let own = params.overridden(overrides).map_err(|error| error.at(form.source.at))?;
        let name = match roots.len() {
            1 => "form".to_owned(),
            _ => format!("form-{}", number + 1),
        };
        let frame = frames.get(number).or(frames.last());
        let frame = frame.and_then(|container| {
            container.outlines.iter().map(|outline| outline.path.bounding_box()).reduce(|a, b| a.union(b))
        });
        let own_lists;
        let draws_paths = own.output != "clones" || own.sheet;
        let mut of_run = &lists;
        if draws_paths || own.colours != "drawn" {
            let lost = lists.lost_effects(root);
            for (of, effect) in &lost {
                artwork.warnings.push(match effect {
                    &"picture" => {
                        format!("'{of}' is an image and left out; choose clones as result to keep it")
                    }
                    effect => {
                        format!("'{of}' is drawn without its {effect}; choose clones as result to keep it")
                    }
                });
            }
            if lost.iter().any(|&(_, effect)| effect == "picture") {
                own_lists = Arc::new(lists.without_pictures());
                of_run = &own_lists;
            }
        }
        let run = Run { params: &own, scene, lists: of_run, root, form, frame, name };
        run.draw(&mut artwork, progress)?;
    }
    if is_built_in {
        // It is no object that could be taken up again.
        artwork.steps.clear();
    }
    Ok(artwork)
}

/// One form of a run.
struct Run<'a> {
    params: &'a Params,
    scene: &'a Scene,
    lists: &'a Arc<Lists>,
    root: usize,
    form: &'a Form,
    /// What it is fitted into.
    frame: Option<Rect>,
    name: String,
}

/// What a walk through a form finds.
struct Survey {
    bounds: Option<Rect>,
    drawn: f64,
    entered: f64,
    too_large: usize,
    /// Generations that could be looked at in the time there was.
    reach: Reach,
    complete: bool,
}

impl Run<'_> {
    fn draw(&self, artwork: &mut Artwork, progress: &mut dyn Progress) -> Result<(), Error> {
        let (params, root) = (self.params, self.root);
        self.lists.check(root, self.form)?;
        let ramp = Ramp::new(&params.colours).map_err(|error| error.at(self.form.source.at))?;
        let reach = Reach { depth: params.depth, last: params.generations == "last" };
        let min_size = params.min_size.to_user(self.scene.px_per_unit);
        progress.step("count", 0.0);
        if params.output == "clones" && reach.depth > LONGEST_CHAIN {
            return Err(self.form.source.error(
                "too-many-copies",
                format!("A chain of clones has at most {LONGEST_CHAIN} generations"),
                "Draw fewer generations, or choose paths as result",
            ));
        }
        if min_size == 0.0 {
            self.check_count(reach)?;
        } else if params.output == "clones" {
            return Err(self.form.source.error(
                "clones-of-one-size",
                "A chain of clones repeats every copy to the last generation, however small",
                "Choose paths as result, or set the smallest copy to 0",
            ));
        }
        self.warn_of_growth(&mut artwork.warnings);
        let view = self.scene.view.size().max_side();
        let mut expansion = Expansion {
            lists: Arc::clone(self.lists),
            root,
            reach,
            place: Affine::IDENTITY,
            min_size: 0.0,
            max_size: LARGEST * view.max(self.lists.lists[root].size),
            ramp,
            fixed_strokes: params.strokes == "fixed",
            merge: params.merge,
            decimals: artwork.decimals,
        };
        // A first look, at as many generations as are quickly seen, tells where it goes.
        let first = Reach { depth: self.lists.deepest(root, reach, FIRST_LOOK).max(1), ..reach };
        let look = self.survey(&Expansion { reach: first, ..expansion.clone() }, progress)?;
        expansion.place = self.place(look.bounds);
        if params.sheet {
            return sheet::draw(self, &expansion, artwork, progress);
        }
        if params.history {
            artwork.steps.push(history::step(self, &expansion, progress)?);
        }
        if params.output == "clones" {
            return self.clones(&expansion, artwork);
        }
        expansion.min_size = min_size;
        let survey = self.whole(&mut expansion, look, progress)?;
        artwork.complete &= survey.complete;
        if survey.too_large > 0 {
            artwork.warnings.push(format!(
                "{}: the form '{}' grows: copies larger than any page are left out ({})",
                self.form.source.at, self.form.source.id, survey.too_large
            ));
        }
        *artwork.counts.entry("elements".into()).or_insert(0.0) += survey.drawn;
        *artwork.counts.entry("copies".into()).or_insert(0.0) += survey.entered;
        let mut group = Group { name: self.name.clone(), ..Group::default() };
        match params.join.as_str() {
            "none" => group.stream = Some(Arc::new(expansion)),
            join => {
                let join = if join == "all" { Join::All } else { Join::Touching };
                group.items = self.joined(&expansion, join);
                artwork.counts.insert("lines".into(), group.items.len() as f64);
            }
        }
        artwork.groups.push(group);
        Ok(())
    }

    /// What the whole form comes to, and where it goes; a first look may know already.
    fn whole(
        &self,
        expansion: &mut Expansion,
        first: Survey,
        progress: &mut dyn Progress,
    ) -> Result<Survey, Error> {
        let (is_full, is_sized) = (first.reach.depth == expansion.reach.depth, expansion.min_size > 0.0);
        if is_full && first.complete && !is_sized {
            return Ok(first);
        }
        // So many are written before anyone would have stopped them.
        const QUICK: f64 = 2e6;
        let (drawn, entered) = self.lists.count(self.root, expansion.reach, self.most());
        let is_quick = drawn.max(entered) <= QUICK && progress.step("count", 0.5);
        if is_quick && !is_sized && self.frame.is_none() && !self.lists.grows(self.root) {
            return Ok(Survey { drawn, entered, reach: expansion.reach, complete: true, ..first });
        }
        let survey = self.survey(expansion, progress)?;
        expansion.reach = survey.reach;
        if survey.reach.depth > first.reach.depth && self.frame.is_some() {
            let back = expansion.place.inverse();
            let all = survey.bounds.map(|bounds| back.transform_rect_bbox(bounds));
            expansion.place = self.place(all);
        }
        Ok(survey)
    }

    /// Copies that are allowed.
    fn most(&self) -> f64 {
        match self.params.output.as_str() {
            "clones" => self.params.most,
            _ => self.params.most.min(MOST_PATHS),
        }
    }

    /// Errors if the form would draw more than is allowed.
    fn check_count(&self, reach: Reach) -> Result<(), Error> {
        let most = self.most();
        let (drawn, entered) = self.lists.count(self.root, reach, most);
        if drawn.max(entered) <= most {
            if drawn == 0.0 {
                return Err(self.form.source.error(
                    "empty-generation",
                    format!(
                        "The form '{}' draws nothing in its generation {}",
                        self.form.source.id, reach.depth
                    ),
                    "Draw all generations, or fewer of them",
                ));
            }
            return Ok(());
        }
        let fits = self.lists.deepest(self.root, reach, most);
        let remedy = match fits {
            0 => "Draw fewer shapes or clones into it".to_owned(),
            1 => "One generation fits".to_owned(),
            fits => format!("At most {fits} generations fit"),
        };
        Err(self.form.source.error(
            "too-many-copies",
            format!(
                "{} generations of the form '{}' are more than {most} copies",
                reach.depth, self.form.source.id
            ),
            if most < self.params.most { remedy } else { format!("{remedy}; or allow more copies") },
        ))
    }

    fn warn_of_growth(&self, warnings: &mut Vec<String>) {
        const LARGER: f64 = 1.000_001;
        for item in &self.form.items {
            if let FormItem::Clone(clone) = item
                && clone.form == self.root
                && clone.transform.determinant().abs() > LARGER
            {
                warnings.push(format!(
                    "{}: the clone '{}' is larger than its source, so that every generation is",
                    clone.source.at, clone.source.id
                ));
            }
        }
    }

    /// Walks through a form without drawing it.
    ///
    /// Errors: it draws more than is allowed.
    fn survey(&self, expansion: &Expansion, progress: &mut dyn Progress) -> Result<Survey, Error> {
        const ASK_EVERY: u64 = 1 << 14;
        let most = self.most();
        let mut bounds: Option<Rect> = None;
        let (mut drawn, mut entered, mut too_large) = (0_u64, 0_u64, 0);
        let (mut is_late, mut is_too_much) = (false, false);
        expansion.walk(|step| {
            match step {
                Step::Enter => entered += 1,
                Step::TooLarge => too_large += 1,
                Step::Draw(shape) => {
                    drawn += 1;
                    for &p in &expansion.lists.primitives[shape.primitive].hull {
                        let p: Point = shape.pose * p;
                        bounds = Some(bounds.map_or(Rect::from_points(p, p), |bounds| bounds.union_pt(p)));
                    }
                }
            }
            let seen = drawn + entered;
            is_late = seen % ASK_EVERY == 0 && !progress.step("count", 0.5);
            is_too_much = drawn.max(entered) as f64 > most;
            !is_late && !is_too_much
        });
        if is_too_much {
            return Err(self.form.source.error(
                "too-many-copies",
                format!("The form '{}' has more than {most} copies", self.form.source.id),
                "Make its smallest copy larger, or draw fewer generations",
            ));
        }
        let mut reach = expansion.reach;
        if is_late {
            // Writing takes longer than looking.
            const DEARER: f64 = 8.0;
            let seen = (drawn.max(entered) as f64 / DEARER).max(1.0);
            reach.depth = expansion.lists.deepest(expansion.root, reach, seen).max(1);
        }
        let (drawn, entered) = (drawn as f64, entered as f64);
        Ok(Survey { bounds, drawn, entered, too_large, reach, complete: !is_late })
    }

    /// Where the form goes: into its frame, if there is one.
    fn place(&self, bounds: Option<Rect>) -> Affine {
        match (self.frame, bounds) {
            (Some(frame), Some(bounds)) => fitted(bounds, frame).unwrap_or(Affine::IDENTITY),
            _ => Affine::IDENTITY,
        }
    }

    fn clones(&self, expansion: &Expansion, artwork: &mut Artwork) -> Result<(), Error> {
        if expansion.fixed_strokes || self.params.join != "none" {
            return Err(self.form.source.error(
                "paths-only",
                "Clones keep neither strokes of one width nor joined lines",
                "Choose paths as result, or let strokes scale and lines be",
            ));
        }
        let (mut symbols, top) = chain(self.lists, self.root, expansion.reach, expansion.ramp.as_ref());
        // Symbols of other forms of this run come before.
        let before = artwork.symbols.len();
        for symbol in &mut symbols {
            for item in &mut symbol.items {
                if let rinceau_format::SymbolItem::Symbol(index, _) = item {
                    *index += before;
                }
            }
            if before > 0 {
                symbol.name = format!("{}-{}", self.name, symbol.name);
            }
        }
        let (drawn, entered) = self.lists.count(self.root, expansion.reach, self.most());
        *artwork.counts.entry("elements".into()).or_insert(0.0) += drawn;
        *artwork.counts.entry("copies".into()).or_insert(0.0) += entered;
        *artwork.counts.entry("symbols".into()).or_insert(0.0) += symbols.len() as f64;
        artwork.symbols.append(&mut symbols);
        let item = Item::cloned(self.form.source.id.clone(), before + top, expansion.place);
        artwork.groups.push(Group { name: self.name.clone(), items: vec![item], ..Group::default() });
        Ok(())
    }

    /// The form's lines, joined; each has the look of its first piece.
    fn joined(&self, expansion: &Expansion, join: Join) -> Vec<Item> {
        let mut looks = Looks::default();
        let near = 1e-4 * expansion.lists.lists[self.root].size * expansion.place.determinant().abs().sqrt();
        // Lines of different looks stay apart.
        let mut lines: BTreeMap<usize, (Joiner, Style, usize)> = BTreeMap::new();
        // What is filled is no line, and stays as it is.
        let mut shapes: Vec<Item> = Vec::new();
        expansion.walk(|step| {
            if let Step::Draw(drawn) = step {
                let mut look = expansion.look(&drawn, &mut looks);
                if !look.is_flat {
                    // No width is right all around; a mean one is nearest.
                    look.width = look.transform.determinant().abs().sqrt();
                }
                let primitive = &expansion.lists.primitives[drawn.primitive];
                let path = look.transform * primitive.path.clone();
                if primitive.style.is_filled() {
                    let style = expansion.own_style(&drawn, &look);
                    let part = Part { path, transform: Affine::IDENTITY, style };
                    shapes.push(Item::new(primitive.of.clone(), vec![part]));
                    return true;
                }
                let apart = join == Join::Touching;
                let line = lines.entry(if apart { look.style } else { 0 }).or_insert_with(|| {
                    (Joiner::new(join, near), expansion.own_style(&drawn, &look), drawn.primitive)
                });
                line.0.add(&path);
            }
            true
        });
        let mut items = shapes;
        for (joiner, style, primitive) in lines.into_values() {
            for path in joiner.finish() {
                let part = Part { path, transform: Affine::IDENTITY, style: style.clone() };
                items.push(Item::new(expansion.lists.primitives[primitive].of.clone(), vec![part]));
            }
        }
        items
    }
}
