//! The one table of parameters: flags, dialogs and reference are made from it.

use rinceau_format::{Error, Length};
use serde_json::{Map, Value};
use std::collections::BTreeMap;

/// What values a parameter takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// A length; 0 means: derived from the size of what is filled.
    Length,
    /// A number within a range.
    Number {
        /// Smallest value.
        min: f64,
        /// Largest value.
        max: f64,
    },
    /// A whole number within a range.
    Whole {
        /// Smallest value.
        min: i64,
        /// Largest value.
        max: i64,
    },
    /// Numbers within a range, separated by commas: a value per level.
    Numbers {
        /// Smallest value.
        min: f64,
        /// Largest value.
        max: f64,
    },
    /// Lengths separated by commas: a value per level.
    Lengths,
    /// One of some values; each with what a dialog calls it.
    Choice(&'static [(&'static str, &'static str)]),
    /// Names separated by spaces; a dialog offers some, each with what it calls it.
    Names(&'static [(&'static str, &'static str)]),
    /// A rule file, or the name of rules; a dialog offers some, each with what it calls it.
    Rules(&'static [(&'static str, &'static str)]),
    /// Yes or no.
    Switch,
}

/// Where a dialog shows a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Page {
    /// The few that matter most.
    Basic,
    /// The rest.
    More,
    /// How curves run, for generators that draw them.
    Curves,
}

/// One parameter: everything that is ever said about it.
#[derive(Clone, Copy, Debug)]
pub struct ParamSpec {
    /// Name of the flag and of the recipe's key.
    pub name: &'static str,
    /// What a dialog calls it.
    pub label: &'static str,
    /// What it does to the picture, in an artist's words.
    pub help: &'static str,
    /// Its values.
    pub kind: Kind,
    /// Default, as it would be written.
    pub default: &'static str,
    /// Where a dialog shows it.
    pub page: Page,
}

/// Values as given by a person, a dialog or a recipe, checked against a table.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Values(BTreeMap<&'static str, String>);

impl Values {
    /// Sets a value.
    ///
    /// Errors: no such parameter, or a value it does not take.
    pub fn set(&mut self, table: &'static [ParamSpec], name: &str, value: &str) -> Result<(), Error> {
        let Some(spec) = table.iter().find(|spec| spec.name == name) else {
            let known: Vec<&str> = table.iter().map(|spec| spec.name).collect();
            return Err(Error::new(
                "unknown-parameter",
                format!("There is no parameter '{name}'"),
                format!("Use one of {}", known.join(", ")),
            ));
        };
        let value = value.trim();
        spec.check(value)?;
        self.0.insert(spec.name, value.to_owned());
        Ok(())
    }

    /// The value as text: given, or the default.
    pub fn text(&self, spec: &ParamSpec) -> String {
        self.0.get(spec.name).cloned().unwrap_or_else(|| spec.default.to_owned())
    }

    /// What differs from the defaults, for a recipe.
    pub fn recipe(&self, table: &[ParamSpec]) -> Map<String, Value> {
        let changed = table.iter().filter_map(|spec| {
            let value = self.0.get(spec.name).filter(|value| *value != spec.default)?;
            Some((spec.name.to_owned(), Value::String(value.clone())))
        });
        changed.collect()
    }

    /// Values back from a recipe.
    ///
    /// Errors: a parameter this version does not have, or a value it does not take.
    pub fn from_recipe(table: &'static [ParamSpec], recipe: &Map<String, Value>) -> Result<Self, Error> {
        let mut values = Values::default();
        for (name, value) in recipe {
            let text = value.as_str().map_or_else(|| value.to_string(), str::to_owned);
            values.set(table, name, &text)?;
        }
        Ok(values)
    }
}

impl ParamSpec {
    /// Errors if the parameter does not take this value; the sentence names its range.
    pub fn check(&self, value: &str) -> Result<(), Error> {
        let wrong = |takes: String| {
            Err(Error::new(
                "bad-parameter",
                format!("{} cannot be '{value}'", self.name),
                format!("Give {takes}"),
            ))
        };
        match self.kind {
            Kind::Length if is_length(value) => Ok(()),
            Kind::Length => wrong("a length of 0 or more, such as 12 or 4mm; 0 chooses by itself".into()),
            Kind::Lengths if value.split(',').all(is_length) => Ok(()),
            Kind::Lengths => {
                wrong("lengths of 0 or more with commas between, such as 120,60; 0 chooses by itself".into())
            }
            Kind::Numbers { min, max } => {
                let in_range =
                    |item: &str| item.trim().parse::<f64>().is_ok_and(|number| (min..=max).contains(&number));
                match value.split(',').all(in_range) {
                    true => Ok(()),
                    false => wrong(format!("numbers from {min} to {max} with commas between")),
                }
            }
            Kind::Number { min, max } => match value.parse::<f64>() {
                Ok(number) if (min..=max).contains(&number) => Ok(()),
                _ => wrong(format!("a number from {min} to {max}")),
            },
            Kind::Whole { min, max } => match value.parse::<i64>() {
                Ok(number) if (min..=max).contains(&number) => Ok(()),
                _ => wrong(format!("a whole number from {min} to {max}")),
            },
            Kind::Choice(choices) if choices.iter().any(|(choice, _)| *choice == value) => Ok(()),
            Kind::Choice(choices) => {
                let names: Vec<&str> = choices.iter().map(|(choice, _)| *choice).collect();
                wrong(format!("one of {}", names.join(", ")))
            }
            Kind::Switch if matches!(value, "true" | "false") => Ok(()),
            Kind::Switch => wrong("true or false".into()),
            Kind::Names(_) if value.is_empty() => wrong("at least one name".into()),
            Kind::Rules(_) if value.is_empty() => wrong("a name or a file of rules".into()),
            Kind::Names(_) | Kind::Rules(_) => Ok(()),
        }
    }
}

fn is_length(text: &str) -> bool {
    text.trim().parse::<Length>().is_ok_and(|length| (0.0..=1e9).contains(&length.to_user(1.0)))
}

/// A parameter's value in the type of its field.
pub trait FromValue: Sized {
    /// `text` has passed [`ParamSpec::check`]; anything else gives the type's zero.
    fn from_value(text: &str) -> Self;
}

impl FromValue for f64 {
    fn from_value(text: &str) -> Self {
        text.parse().unwrap_or_default()
    }
}

impl FromValue for usize {
    fn from_value(text: &str) -> Self {
        text.parse().unwrap_or_default()
    }
}

impl FromValue for bool {
    fn from_value(text: &str) -> Self {
        text == "true"
    }
}

impl FromValue for String {
    fn from_value(text: &str) -> Self {
        text.to_owned()
    }
}

impl FromValue for Length {
    fn from_value(text: &str) -> Self {
        text.parse().unwrap_or(Length::user(0.0))
    }
}

/// A list: a value per level.
impl<T: FromValue> FromValue for Vec<T> {
    fn from_value(text: &str) -> Self {
        text.split(',').map(|item| T::from_value(item.trim())).collect()
    }
}

/// Declares a generator's parameters once: the struct, its defaults and its table. The doc
/// comment of a field is its help text.
#[macro_export]
macro_rules! params {
    (
        $(#[$struct_doc:meta])*
        pub struct $name:ident {
            $( #[doc = $help:literal] $field:ident : $type:ty = $flag:literal, $label:literal, $page:ident, $kind:expr, $default:literal; )*
        }
    ) => {
        $(#[$struct_doc])*
        #[derive(Clone, Debug)]
        pub struct $name {
            $( #[doc = $help] pub $field: $type, )*
        }

        impl $name {
            /// The table that flags, dialogs and reference are made from.
            pub const TABLE: &'static [$crate::params::ParamSpec] = &[
                $( $crate::params::ParamSpec {
                    name: $flag,
                    label: $label,
                    help: $help,
                    kind: $kind,
                    default: $default,
                    page: $crate::params::Page::$page,
                }, )*
            ];

            /// These parameters with some set anew, as a container's own attributes do.
            ///
            /// Errors: no such parameter, or a value it does not take.
            pub fn overridden<'a>(
                &self,
                overrides: impl IntoIterator<Item = (&'a str, &'a str)>,
            ) -> Result<Self, rinceau_format::Error> {
                let mut own = self.clone();
                for (name, text) in overrides {
                    let mut values = $crate::params::Values::default();
                    values.set(Self::TABLE, name, text)?;
                    $( if name == $flag { own.$field = <$type as $crate::params::FromValue>::from_value(text.trim()); } )*
                }
                Ok(own)
            }

            /// The parameters a person gave, in their types.
            pub fn from_values(values: &$crate::params::Values) -> Self {
                let mut specs = Self::TABLE.iter();
                let mut next = || specs.next().map(|spec| values.text(spec)).unwrap_or_default();
                $name { $( $field: <$type as $crate::params::FromValue>::from_value(&next()), )* }
            }
        }

        impl Default for $name {
            fn default() -> Self {
                Self::from_values(&$crate::params::Values::default())
            }
        }
    };
}
