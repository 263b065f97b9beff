//! A key of a scene: its name, one line that describes it, its unit, what values it takes, and its default.

/// A key of a table of the scene.
#[derive(Debug, Clone, Copy)]
pub struct Parameter {
    /// The key in scenes.
    pub name: &'static str,
    /// What it is, in one line that begins with a small letter, such as "the traction on the boundary".
    pub about: &'static str,
    /// Its unit; empty for a pure number and for what is no number.
    pub unit: &'static str,
    /// What values it takes.
    pub form: Form,
    /// What holds where the scene does not give it.
    pub default: Preset,
}

/// What values a number may take.
#[derive(Debug, Clone, Copy)]
pub struct Check {
    /// In words that complete "must be".
    pub range: &'static str,
    /// The rule; it never sees NaN or infinity.
    pub holds: fn(f64) -> bool,
}

/// Any finite number.
pub const FINITE: Check = Check { range: "finite", holds: |_| true };
/// A number above 0.
pub const POSITIVE: Check = Check { range: "greater than 0", holds: |value| value > 0.0 };
/// A number that may be 0.
pub const NOT_NEGATIVE: Check = Check { range: "not negative", holds: |value| value >= 0.0 };
/// A number below 1.
pub const BELOW_1: Check = Check { range: "below 1", holds: |value| value < 1.0 };
/// A number from 1 on.
pub const AT_LEAST_1: Check = Check { range: "at least 1", holds: |value| value >= 1.0 };
/// A part of a whole.
pub const SHARE: Check = Check { range: "between 0 and 1", holds: |x| x > 0.0 && x < 1.0 };
/// A number of cells.
pub const CELLS: Check =
    Check { range: "whole, from 1 to 100000", holds: |n| n.fract() == 0.0 && (1.0..=100_000.0).contains(&n) };

/// What values a parameter takes.
#[derive(Debug, Clone, Copy)]
pub enum Form {
    /// A finite number in a range.
    Number(Check),
    /// A whole number in a range; `usize::MAX` is no limit.
    Integer(usize, usize),
    /// true or false.
    Boolean,
    /// A list of numbers.
    Numbers(Check),
    /// A list of at least so many points.
    Points(usize),
    /// A CSV file with the columns t and so many values, beside the scene.
    LoadTable(usize),
    /// Two numbers, one for each direction.
    Vector(Check),
    /// A text.
    Text,
    /// A text, or a list of texts.
    Texts,
    /// An expression of x, y, t.
    Expression,
    /// A list of so many expressions of x, y, t.
    Expressions(usize),
    /// One of some names; those of the second list are known and not built yet.
    Name(Names, &'static [&'static str]),
    /// A list of some names, each at most once.
    Names(Names),
    /// A table with keys of its own.
    Table(&'static [Parameter]),
    /// A list of tables.
    Tables(&'static [Parameter]),
    /// This word, or what the other form takes.
    Or(&'static str, &'static Form),
}

/// A list of names.
pub type Names = fn() -> Vec<&'static str>;

/// What holds where the scene does not give a parameter.
#[derive(Debug, Clone, Copy)]
pub enum Preset {
    /// The scene must give it.
    Required,
    /// The scene must give it, or another parameter in its place; not both.
    Unless(&'static str),
    /// It has no value then; in words what holds.
    Absent(&'static str),
    /// A number.
    Number(f64),
    /// A whole number.
    Integer(usize),
    /// true or false.
    Boolean(bool),
    /// A name.
    Name(&'static str),
    /// Names.
    Names(&'static [&'static str]),
    /// Numbers as expressions.
    Constant(&'static [f64]),
    /// A number that depends on the degree in space; in words.
    ByDegree(&'static str, fn(usize) -> f64),
}

impl Parameter {
    /// A parameter that the scene must give.
    pub const fn required(name: &'static str, about: &'static str, unit: &'static str, form: Form) -> Self {
        Self { name, about, unit, form, default: Preset::Required }
    }

    /// A parameter with a default.
    pub const fn new(name: &'static str, about: &'static str, unit: &'static str, form: Form, default: Preset) -> Self {
        Self { name, about, unit, form, default }
    }

    /// A number with a default.
    pub const fn number(
        name: &'static str,
        about: &'static str,
        unit: &'static str,
        check: Check,
        default: f64,
    ) -> Self {
        Self::new(name, about, unit, Form::Number(check), Preset::Number(default))
    }

    /// What values it takes, in words that complete "must be".
    pub fn words(&self) -> String {
        self.form.words(self.unit)
    }
}

impl Check {
    /// What numbers, in words that complete "must be".
    pub fn words(&self, unit: &str) -> String {
        match (self.range, unit) {
            ("finite", "") => "a number".to_owned(),
            ("finite", unit) => format!("a number, in {unit}"),
            (range, "") => format!("a number, {range}"),
            (range, unit) => format!("a number, {range} {unit}"),
        }
    }
}

impl Form {
    /// What values, in words that complete "must be"; numbers are in `unit`.
    pub fn words(&self, unit: &str) -> String {
        let of_unit = if unit.is_empty() { String::new() } else { format!(", in {unit}") };
        let count = |n: &usize| ["no", "one", "two", "three", "four"].get(*n).map_or(n.to_string(), |&w| w.to_owned());
        match self {
            Form::Number(check) => check.words(unit),
            Form::Integer(from, usize::MAX) => format!("a whole number, at least {from}"),
            Form::Integer(from, to) => format!("a whole number from {from} to {to}"),
            Form::Boolean => "true or false".to_owned(),
            Form::Numbers(check) => format!("a list of numbers, each {}{of_unit}", check.range),
            Form::Vector(check) => format!("two numbers, each {}{of_unit}", check.range),
            Form::Points(least) => format!("a list of at least {} points [x, y]{of_unit}", count(least)),
            Form::LoadTable(n) => format!("a CSV file with the column t, in s, and {} more{of_unit}", count(n)),
            Form::Text => "a text".to_owned(),
            Form::Texts => "a text, or a list of texts".to_owned(),
            Form::Expression => format!("an expression of x, y, t{of_unit}"),
            Form::Expressions(n) => format!("{} expressions of x, y, t{of_unit}", count(n)),
            Form::Name(names, _) => format!("one of {}", quoted(&names())),
            Form::Names(names) => format!("a list of names out of {}", quoted(&names())),
            Form::Table(keys) => format!("a table with the keys {}", keys_of(keys)),
            Form::Tables(keys) => format!("a list of tables with the keys {}", keys_of(keys)),
            Form::Or(word, other) => format!("\"{word}\", or {}", other.words(unit)),
        }
    }
}

/// Names in quotes, with commas.
pub fn quoted(names: &[&str]) -> String {
    names.iter().map(|name| format!("\"{name}\"")).collect::<Vec<_>>().join(", ")
}

fn keys_of(keys: &[Parameter]) -> String {
    keys.iter().map(|key| key.name).collect::<Vec<_>>().join(", ")
}
