//! Everything that a scene can name, as tables: one [`Entry`] for each thing, with its name, one line that describes it,
//! its parameters and how it is built.
//!
//! An entry is the only place that names a thing. What reads scenes, checks them, answers "did you mean", lists what there
//! is in messages and writes `docs/scene.md` follows from the entries; so does the problem that a scene becomes. A new law,
//! condition, source, flux, exact solution, output, quantity, grid, layout, limiter or control of the curl is a file with a type and one entry
//! here (`docs/extend.md`). A program that uses the crate adds entries of its own by [`Table::add`].
//!
//! ```
//! use dgmpm::registry::{CONDITIONS};
//!
//! let wall = CONDITIONS.find("wall").unwrap();
//! assert_eq!(wall.parameters[0].name, "speed");
//! ```

pub mod conditions;
pub mod controls;
pub mod fluxes;
pub mod fields;
mod givers;
pub mod grids;
pub mod laws;
pub mod layouts;
pub mod limiters;
pub mod methods;
pub mod outputs;
mod parameter;
pub mod quantities;
pub mod solutions;
pub mod sources;
mod table;
mod values;

pub use crate::io::LoadTable;
pub use crate::observe::Field;
pub use crate::regrid::points::Policy;
pub use conditions::CONDITIONS;
pub use controls::CONTROLS;
pub use fluxes::FLUXES;
pub use grids::GRIDS;
pub use laws::LAWS;
pub use layouts::LAYOUTS;
pub use limiters::LIMITERS;
pub use methods::{METHODS, Method, Sweeps};
pub use outputs::OUTPUTS;
pub use parameter::*;
pub use quantities::QUANTITIES;
pub use solutions::SOLUTIONS;
pub use sources::SOURCES;
pub use table::Table;
pub use values::{Value, Values, data};

use std::fmt;

/// A thing that scenes can name. `B` is what there is to know of it beside its parameters: at least how it is built.
pub struct Entry<B: 'static> {
    /// Its name in scenes.
    pub name: &'static str,
    /// What it is, in one line.
    pub about: &'static str,
    /// Its parameters.
    pub parameters: &'static [Parameter],
    /// What its parameters have to fulfil together, or beyond their ranges; [`ANY`] where they need nothing more.
    pub check: fn(&Values) -> Result<(), Fault>,
    /// How it is built.
    pub build: B,
}

/// The check of an entry whose parameters need only be in their ranges.
pub const ANY: fn(&Values) -> Result<(), Fault> = |_| Ok(());

/// What is wrong with values that are each in their range.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fault {
    /// The key at fault, below the table of the entry: `value.1` is the second component of `value`.
    pub key: String,
    /// What is wrong.
    pub what: String,
    /// What would be right.
    pub remedy: String,
}

impl Fault {
    /// A fault at a key.
    pub fn new(key: impl Into<String>, what: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self { key: key.into(), what: what.into(), remedy: remedy.into() }
    }
}

/// An entry that a scene has chosen, and what it gives for the parameters.
pub struct Chosen<B: 'static> {
    /// The entry.
    pub entry: &'static Entry<B>,
    /// The values of its parameters.
    pub values: Values,
}

impl<B> Chosen<B> {
    /// The name of the entry.
    pub fn name(&self) -> &'static str {
        self.entry.name
    }

    /// How it is built.
    pub fn build(&self) -> &'static B {
        &self.entry.build
    }

    /// The parameters that are expressions, each with its expressions.
    pub fn expressions(&self) -> impl Iterator<Item = (&'static Parameter, &[crate::expression::Expression])> {
        let all = self.entry.parameters.iter().map(|parameter| (parameter, self.values.expressions(parameter.name)));
        all.filter(|(_, expressions)| !expressions.is_empty())
    }
}

impl<B> Chosen<B> {
    /// The parameters that are tables of loads, each with the path of its file.
    pub fn files(&self) -> impl Iterator<Item = (&'static Parameter, &str)> {
        let all = self.entry.parameters.iter().filter(|parameter| matches!(parameter.form, Form::LoadTable(_)));
        all.filter_map(|parameter| Some((parameter, self.values.maybe_text(parameter.name)?)))
    }
}

impl<B> Clone for Chosen<B> {
    fn clone(&self) -> Self {
        Self { entry: self.entry, values: self.values.clone() }
    }
}

impl<B> PartialEq for Chosen<B> {
    fn eq(&self, other: &Self) -> bool {
        self.name() == other.name() && self.values == other.values
    }
}

impl<B> fmt::Debug for Chosen<B> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {:?}", self.name(), self.values)
    }
}

impl<B> serde::Serialize for Chosen<B> {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        use serde::ser::SerializeMap;
        let mut map = serializer.serialize_map(Some(1))?;
        map.serialize_entry(self.name(), &self.values)?;
        map.end()
    }
}

/// The values of parameters that a scene does not give: the defaults.
pub fn defaults(parameters: &'static [Parameter], degree: usize) -> Values {
    let mut values = Values::default();
    for parameter in parameters {
        if let Some(value) = parameter.default.value(degree) {
            values.set(parameter.name, value);
        }
    }
    values
}

impl Preset {
    /// Whether a scene has to give the parameter, or another one in its place.
    pub fn is_asked(&self) -> bool {
        matches!(self, Preset::Required | Preset::Unless(_))
    }

    /// The value, for a degree in space; none where it has none.
    pub fn value(&self, degree: usize) -> Option<Value> {
        let number = crate::expression::Expression::number;
        match *self {
            Preset::Required | Preset::Unless(_) | Preset::Absent(_) => None,
            Preset::Number(value) => Some(Value::Number(value)),
            Preset::Integer(value) => Some(Value::Integer(value)),
            Preset::Boolean(value) => Some(Value::Boolean(value)),
            Preset::Name(name) => Some(Value::Text(name.to_owned())),
            Preset::Names(names) => Some(Value::Texts(names.iter().map(|&name| name.to_owned()).collect())),
            Preset::Constant([one]) => Some(Value::Expression(number(*one))),
            Preset::Constant(all) => Some(Value::Expressions(all.iter().map(|&value| number(value)).collect())),
            Preset::ByDegree(_, of) => Some(Value::Number(of(degree))),
        }
    }
}

/// Values for all parameters of an entry: the defaults, and for the others some that are in the range of each.
pub fn example(parameters: &'static [Parameter]) -> Values {
    let mut values = defaults(parameters, 1);
    for (k, parameter) in parameters.iter().enumerate() {
        if parameter.default.is_asked() {
            values.set(parameter.name, parameter.form.example(k));
        }
    }
    values
}

impl Form {
    /// A value that the parameter of a number takes.
    pub fn example(&self, k: usize) -> Value {
        let number = |check: &Check| {
            let inside = [0.25, 1.0, 2.0, 0.0].into_iter().find(|value| (check.holds)(*value));
            inside.unwrap_or(-1.0)
        };
        let expression = || crate::expression::Expression::number(1.0);
        match self {
            Form::Number(check) => Value::Number(number(check)),
            Form::Integer(from, _) => Value::Integer(*from),
            Form::Boolean => Value::Boolean(true),
            Form::Numbers(check) => Value::Numbers(vec![number(check)]),
            // Two parameters of an entry are never the same point.
            Form::Vector(check) => Value::Numbers(vec![number(check) * (k + 1) as f64; 2]),
            // A convex polygon, counterclockwise.
            Form::Points(least) => {
                let angle = |k: usize| std::f64::consts::TAU * k as f64 / *least as f64;
                Value::Points((0..*least).map(|k| [angle(k).cos(), angle(k).sin()]).collect())
            }
            Form::LoadTable(_) => Value::Text("load.csv".to_owned()),
            Form::Text => Value::Text("other".to_owned()),
            Form::Texts => Value::Texts(vec!["other".to_owned()]),
            Form::Expression => Value::Expression(expression()),
            Form::Expressions(n) => Value::Expressions(vec![expression(); *n]),
            Form::Name(names, _) => Value::Text(names().first().copied().unwrap_or_default().to_owned()),
            Form::Names(names) => Value::Texts(names().first().map(|&name| name.to_owned()).into_iter().collect()),
            Form::Table(keys) => Value::Table(example(keys)),
            Form::Tables(keys) => Value::Tables(vec![example(keys)]),
            Form::Or(word, _) => Value::Text((*word).to_owned()),
        }
    }
}

#[cfg(test)]
mod tests;
