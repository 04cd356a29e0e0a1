//! Rules that run: compiled once, applied to one element at a time, fenced in (checklist W-060,
//! W-076 to W-078; limits as in the method notes 7).

use super::file::{self, Field, Look, RuleFile};
use super::lexer::RuleText;
use super::translate::Script;
use super::values::{ElementRef, ProxyRef};
use super::{queries, values};
use crate::grow::space::Circle;
use crate::grow::world::{Candidate, ElementKind, World};
use crate::rng::Rng;
use rhai::packages::{
    ArithmeticPackage, BasicArrayPackage, BasicIteratorPackage, BasicMapPackage, BasicMathPackage,
    BasicStringPackage, LogicPackage, MoreStringPackage, Package,
};
use rhai::{AST, Array, Dynamic, Engine, EvalAltResult, FnPtr, Position, Scope};
use rinceau_format::Error;
use std::cell::RefCell;
use std::rc::Rc;

/// Steps of one application of a rule at most.
pub const MOST_OPERATIONS: u64 = 100_000;
/// Functions that call each other at most.
pub const DEEPEST_CALLS: usize = 40;
/// Elements that one application of a rule makes at most.
pub const MOST_CHILDREN: usize = 2000;
/// Length of texts, arrays and maps of a rule at most.
pub const LARGEST_VALUE: usize = 2000;

/// What rules and the framework share.
#[derive(Debug)]
pub struct State {
    pub(super) world: World,
    pub(super) rng: Rng,
    /// Places that the outline has, found once they are asked for.
    pub(super) places: queries::Places,
    /// Names of element types.
    pub(super) names: Vec<String>,
    /// The element that grows.
    pub(super) parent: u32,
    /// Drawn elements that stand where they are: places to grow to.
    pub(super) targets: Vec<(String, Circle)>,
}

impl State {
    pub(in crate::grow) fn new(world: World, rng: Rng, targets: Vec<(String, Circle)>) -> Self {
        let names = world.kinds.iter().map(|kind| kind.name.clone()).collect();
        State { world, rng, places: queries::Places::default(), names, parent: u32::MAX, targets }
    }

    /// The ornament.
    pub(in crate::grow) fn world(&mut self) -> &mut World {
        &mut self.world
    }
}

/// A handle of what rules and the framework share.
pub(in crate::grow) type Shared = Rc<RefCell<State>>;

/// What a function of the language gives.
pub(super) type Answer<T> = Result<T, Box<EvalAltResult>>;

/// A sentence about what went wrong in a rule.
pub(super) fn wrong(sentence: impl Into<String>) -> Box<EvalAltResult> {
    EvalAltResult::ErrorRuntime(sentence.into().into(), Position::NONE).into()
}

struct Rule {
    statics: Vec<usize>,
    names: Vec<Option<String>>,
    ast: AST,
    script: Script,
    /// Which of `proxy_of_parent`, `child_j` and `proxy_j` it uses.
    uses_proxy: bool,
    uses: Vec<(bool, bool)>,
    at: usize,
}

/// How an application of a rule ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Applied {
    /// Its children are placed.
    Placed,
    /// It failed, or its children have no room.
    Failed,
    /// The time is over.
    Late,
}

/// The rules of a file, ready to be applied.
pub struct Rules {
    engine: Engine,
    source: RuleText,
    file: RuleFile,
    globals: AST,
    rules: Vec<Rule>,
    /// Rules by the type that they grow.
    by_kind: Vec<Vec<usize>>,
    scope: Scope<'static>,
    /// Variables that stay from one application to the next.
    kept: usize,
    shared: Option<Shared>,
}

impl Rules {
    /// Reads a rule file.
    ///
    /// Errors: what is not understood, with line and column of the file.
    pub fn read(source: RuleText) -> Result<Self, Error> {
        let file = file::read(&source)?;
        let engine = fenced();
        let globals = compiled(&engine, &source, &file.globals, "the declarations")?;
        let functions = globals.clone_functions_only();
        let mut rules = Vec::new();
        let mut by_kind = vec![Vec::new(); file.kinds.len()];
        for rule in &file.rules {
            let body = compiled(&engine, &source, &rule.body, "the rule")?;
            let text = &rule.body.text;
            let uses = (0..rule.statics.len())
                .map(|j| (text.contains(&format!("child_{j}")), text.contains(&format!("proxy_{j}"))))
                .collect();
            by_kind[rule.parent].push(rules.len());
            rules.push(Rule {
                statics: rule.statics.iter().map(|&(kind, _)| kind).collect(),
                names: rule.statics.iter().map(|(_, name)| name.clone()).collect(),
                ast: functions.merge(&body),
                script: rule.body.clone(),
                uses_proxy: text.contains("proxy_of_parent"),
                uses,
                at: rule.at,
            });
        }
        let (scope, shared) = (Scope::new(), None);
        Ok(Rules { engine, source, file, globals, rules, by_kind, scope, kept: 0, shared })
    }

    /// The element types of the file.
    pub fn kinds(&self) -> Vec<ElementKind> {
        let value = |field: Field| match field {
            Field::Whole(n) => n.into(),
            Field::Number(n) => n.into(),
            Field::Switch(is) => is.into(),
        };
        let kind = |kind: &file::KindSource| ElementKind {
            name: kind.name.clone(),
            proxies: kind.proxies.clone(),
            fields: kind.fields.iter().map(|(name, field)| (name.clone(), value(*field))).collect(),
            overlaps: kind.overlaps,
        };
        self.file.kinds.iter().map(kind).collect()
    }

    /// An error at a byte of the file.
    pub fn error(&self, at: usize, sentence: impl AsRef<str>, remedy: impl AsRef<str>) -> Error {
        self.source.error(at, sentence, remedy)
    }

    /// How the file wants its elements drawn.
    pub fn looks(&self) -> &[Look] {
        &self.file.looks
    }

    /// Smaller circles are never worth trying, as the file says.
    pub fn smallest(&self) -> f64 {
        self.file.smallest
    }

    /// What the file multiplies the usual reach by.
    pub fn reach(&self) -> f64 {
        self.file.reach
    }

    /// For each type, whether something grows from it.
    pub fn grows(&self) -> Vec<bool> {
        self.by_kind.iter().map(|rules| !rules.is_empty()).collect()
    }

    /// Index of the type of seeds.
    pub fn seed(&self) -> usize {
        self.file.kinds.iter().position(|kind| kind.name == "seed").unwrap_or(0)
    }

    /// Starts a run in a world: its queries are answered there, its variables have their first
    /// values.
    ///
    /// Errors: what goes wrong in the declarations.
    pub fn start(&mut self, state: State) -> Result<Shared, Error> {
        let shared: Shared = Rc::new(RefCell::new(state));
        let mut engine = fenced();
        values::register(&mut engine, &shared);
        queries::register(&mut engine, &shared);
        self.engine = engine;
        let mut scope = Scope::new();
        scope.push_constant("SUCCESS", true);
        scope.push_constant("FAILURE", false);
        scope.push_constant("M_PI", std::f64::consts::PI);
        scope.push_constant("PI", std::f64::consts::PI);
        if let Err(error) = self.engine.run_ast_with_scope(&mut scope, &self.globals) {
            return Err(self.failed(&self.file.globals, 0, &error));
        }
        self.kept = scope.len();
        self.scope = scope;
        self.shared = Some(Rc::clone(&shared));
        Ok(shared)
    }

    /// Tries the rules for an element in the order of the file.
    ///
    /// Errors: what goes wrong in a body, with its line and column.
    pub fn grow(&mut self, candidate: &Candidate, mut go_on: impl FnMut() -> bool) -> Result<Applied, Error> {
        let Some(shared) = self.shared.clone() else { return Ok(Applied::Failed) };
        let kind = shared.borrow().world.elements[candidate.element as usize].kind;
        for i in 0..self.by_kind[kind].len() {
            let rule = self.by_kind[kind][i];
            if !go_on() {
                return Ok(Applied::Late);
            }
            match self.apply(rule, candidate, &shared)? {
                Applied::Failed => {}
                ended => return Ok(ended),
            }
            if shared.borrow().world.elements[candidate.element as usize].sterile {
                break;
            }
        }
        Ok(Applied::Failed)
    }

    fn apply(&mut self, rule: usize, candidate: &Candidate, shared: &Shared) -> Result<Applied, Error> {
        let rule = &self.rules[rule];
        {
            let mut state = shared.borrow_mut();
            state.parent = candidate.element;
            for &kind in &rule.statics {
                state.world.fresh(kind, candidate.element);
            }
        }
        let (parent, children): (u32, Vec<u32>) = {
            let world = &shared.borrow().world;
            let serials = world.elements[world.placed..].iter().map(|element| element.serial);
            (world.elements[candidate.element as usize].serial, serials.collect())
        };
        let scope = &mut self.scope;
        scope.push("parent", ElementRef(parent));
        if rule.uses_proxy {
            scope.push("proxy_of_parent", ProxyRef { element: parent, proxy: 0 });
        }
        scope.push("goal", candidate.goal);
        for (j, ((name, &(element, proxy)), child)) in
            rule.names.iter().zip(&rule.uses).zip(children).enumerate()
        {
            if let Some(name) = name {
                scope.push(name.as_str().to_owned(), ElementRef(child));
            }
            if element {
                scope.push(format!("child_{j}"), ElementRef(child));
            }
            if proxy {
                scope.push(format!("proxy_{j}"), ProxyRef { element: child, proxy: 0 });
            }
        }
        let ended = self.engine.eval_ast_with_scope::<Dynamic>(scope, &rule.ast);
        scope.rewind(self.kept);
        let is_success = match ended {
            Ok(value) if value.is_unit() => true,
            Ok(value) if value.is_bool() || value.is_int() => {
                value.as_bool().unwrap_or(false) || value.as_int().is_ok_and(|n| n != 0)
            }
            Ok(value) => {
                shared.borrow_mut().world.discard();
                return Err(self.source.error(
                    rule.at,
                    format!("the rule ends with a value that says neither yes nor no: {}", value.type_name()),
                    "End it with SUCCESS, with FAILURE, or with a statement and a semicolon",
                ));
            }
            Err(error) => {
                shared.borrow_mut().world.discard();
                return Err(self.failed(&rule.script, rule.at, &error));
            }
        };
        let mut state = shared.borrow_mut();
        if !is_success {
            state.world.discard();
            return Ok(Applied::Failed);
        }
        let statics = rule.statics.len();
        match state.world.commit(candidate.element, statics) {
            true => Ok(Applied::Placed),
            false => Ok(Applied::Failed),
        }
    }

    /// The error of a body, where the author wrote it.
    fn failed(&self, script: &Script, rule: usize, error: &EvalAltResult) -> Error {
        let (error, position) = innermost(error);
        let at = match (position.line(), position.position()) {
            (Some(line), Some(column)) => script.origin(line, column),
            _ => rule,
        };
        let (sentence, remedy) = explained(error);
        self.source.error(at, sentence, remedy)
    }
}

/// An engine without doors to the outside, and with limits.
fn fenced() -> Engine {
    let mut engine = Engine::new_raw();
    // All but the packages that wait, end a rule unseen, or handle bytes.
    ArithmeticPackage::new().register_into_engine(&mut engine);
    LogicPackage::new().register_into_engine(&mut engine);
    BasicStringPackage::new().register_into_engine(&mut engine);
    BasicIteratorPackage::new().register_into_engine(&mut engine);
    BasicMathPackage::new().register_into_engine(&mut engine);
    BasicArrayPackage::new().register_into_engine(&mut engine);
    BasicMapPackage::new().register_into_engine(&mut engine);
    MoreStringPackage::new().register_into_engine(&mut engine);
    // An order that is none makes the library panic.
    for name in ["sort", "sort_by", "order", "order_by"] {
        engine.register_fn(name, |_: &mut Array, _: FnPtr| -> Answer<()> {
            Err(wrong("arrays are sorted by their values alone, not by a function"))
        });
    }
    engine.on_print(|_| {}).on_debug(|_, _, _| {});
    // What compiles anew, and what grows without a limit.
    for name in ["eval", "Fn", "curry"] {
        engine.disable_symbol(name);
    }
    engine.set_max_operations(MOST_OPERATIONS);
    engine.set_max_call_levels(DEEPEST_CALLS);
    engine.set_max_expr_depths(160, 80);
    engine.set_max_string_size(LARGEST_VALUE);
    engine.set_max_array_size(LARGEST_VALUE);
    engine.set_max_map_size(LARGEST_VALUE);
    engine.set_max_functions(1000);
    engine.set_max_variables(2000);
    engine.set_strict_variables(false);
    engine
}

/// The error itself, and the outermost place that is known of it.
fn innermost(error: &EvalAltResult) -> (&EvalAltResult, Position) {
    let (mut error, mut position) = (error, error.position());
    loop {
        let inner = match error {
            EvalAltResult::ErrorInFunctionCall(_, _, inner, _) => inner,
            EvalAltResult::ErrorInModule(_, inner, _) => inner,
            _ => return (error, position),
        };
        error = inner;
        if position.is_none() {
            position = error.position();
        }
    }
}

/// What an error means to the author of a rule, and what helps.
fn explained(error: &EvalAltResult) -> (String, String) {
    let remedy = "Change the rule there";
    match error {
        EvalAltResult::ErrorRuntime(what, _) => (what.to_string(), remedy.to_owned()),
        EvalAltResult::ErrorTooManyOperations(_) => (
            format!("the rule takes more than {MOST_OPERATIONS} steps"),
            "Let its loops end sooner".to_owned(),
        ),
        EvalAltResult::ErrorStackOverflow(_) => (
            format!("functions call each other more than {DEEPEST_CALLS} deep"),
            "Use a loop instead".to_owned(),
        ),
        EvalAltResult::ErrorVariableNotFound(name, _) => (
            format!("there is no '{name}' here"),
            "Declare it, or see docs/rules.md for what rules know; functions know their parameters alone"
                .to_owned(),
        ),
        EvalAltResult::ErrorFunctionNotFound(name, _) => (
            format!("there is no function {}", name.replace(" ()", "()")),
            "See docs/rules.md for what rules can call, and with which values".to_owned(),
        ),
        EvalAltResult::ErrorDotExpr(text, _) if text.starts_with("Unknown property") => {
            let mut names = text.split('\'').skip(1).step_by(2);
            let (field, kind) = (names.next().unwrap_or(""), names.next().unwrap_or(""));
            (
                format!("a {kind} has no '{field}'"),
                "See docs/rules.md for the fields that there are".to_owned(),
            )
        }
        EvalAltResult::ErrorDataTooLarge(..) => (
            format!("a text, array or map has more than {LARGEST_VALUE} entries"),
            "Keep less in it".to_owned(),
        ),
        other => {
            let text = other.to_string();
            let sentence = text.split(" (line ").next().unwrap_or(&text);
            (first_small(sentence), remedy.to_owned())
        }
    }
}

fn first_small(sentence: &str) -> String {
    let mut letters = sentence.chars();
    letters.next().map_or(String::new(), |first| first.to_lowercase().chain(letters).collect())
}

fn compiled(engine: &Engine, source: &RuleText, script: &Script, what: &str) -> Result<AST, Error> {
    engine.compile(&script.text).map_err(|error| {
        let position = error.position();
        let at = script.origin(position.line().unwrap_or(1), position.position().unwrap_or(1));
        let text = error.err_type().to_string();
        source.error(at, format!("{what} cannot be read: {}", first_small(&text)), "Correct it there")
    })
}
