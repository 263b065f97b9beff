//! Reads one table of a scene key by key: each getter checks the form, [`Reader::finish`] refuses the keys that nobody
//! asked for, and every message has its place.

use toml_edit::{Item, TableLike, Value as Toml};

use super::origin::{Origin, Part};
use crate::error::{Error, Result};
use crate::expression::Expression;
use crate::names;
use crate::registry::{Check, Parameter, quoted};

/// A table that is being read.
pub(super) struct Reader<'a> {
    table: &'a dyn TableLike,
    path: Vec<String>,
    pub(super) origin: &'a Origin,
    /// How messages name the table, for instance "[scheme]".
    title: String,
    pub(super) known: Vec<&'static str>,
    later: &'static [&'static str],
}

impl<'a> Reader<'a> {
    /// A table of the scene, with its key path.
    pub(super) fn new(table: &'a dyn TableLike, path: Vec<String>, origin: &'a Origin, title: String) -> Self {
        Self { table, path, origin, title, known: Vec::new(), later: &[] }
    }

    /// Keys that the design knows and that are not built yet.
    pub(super) fn later(&mut self, keys: &'static [&'static str]) {
        self.later = keys;
    }

    /// Adds the kind to the title, for messages.
    pub(super) fn of_kind(&mut self, kind: &str) {
        self.title = format!("{} of kind \"{kind}\"", self.title);
    }

    /// How messages name the table.
    pub(super) fn title(&self) -> &str {
        &self.title
    }

    /// Whether the value of a key is this text.
    pub(super) fn is_text(&self, key: &str, text: &str) -> bool {
        self.table.get(key).and_then(Item::as_str) == Some(text)
    }

    /// An error at the value of a key.
    pub(super) fn wrong(&self, key: &str, what: impl Into<String>, remedy: impl Into<String>) -> Error {
        self.origin.error(&self.below(&[key]), Part::Value, what, remedy)
    }

    /// An error at an entry of a list.
    pub(super) fn wrong_entry(
        &self,
        key: &str,
        index: usize,
        what: impl Into<String>,
        remedy: impl Into<String>,
    ) -> Error {
        self.origin.error(&self.below(&[key, &index.to_string()]), Part::Value, what, remedy)
    }

    /// The error of a required key that is not there.
    pub(super) fn missing(&self, key: &str, remedy: &str) -> Error {
        let given: Vec<&str> = self.table.iter().map(|(key, _)| key).filter(|key| !self.known.contains(key)).collect();
        if let Some(misspelt) = names::nearest(key, &given) {
            let what = format!("unknown key `{misspelt}` in {}", self.title);
            let remedy = format!("did you mean `{key}`? {} needs it: {remedy}", self.title);
            return self.origin.error(&self.below(&[misspelt]), Part::Key, what, remedy);
        }
        self.origin.error(&self.path, Part::Value, format!("{} needs the key `{key}`", self.title), remedy)
    }

    /// Refuses keys that were not read.
    pub(super) fn finish(&self) -> Result<()> {
        match self.table.iter().find(|(key, _)| !self.known.contains(key)) {
            Some((key, _)) => Err(self.unknown(key)),
            None => Ok(()),
        }
    }

    /// Whether the key is there.
    pub(super) fn has(&self, key: &str) -> bool {
        self.table.contains_key(key)
    }

    /// A text.
    pub(super) fn text(&mut self, key: &'static str) -> Result<Option<String>> {
        let Some(item) = self.item(key) else { return Ok(None) };
        match item.as_str() {
            Some(text) if !text.trim().is_empty() => Ok(Some(text.to_owned())),
            _ => Err(self.not(key, "a text that is not empty, in quotes", item)),
        }
    }

    /// true or false.
    pub(super) fn boolean(&mut self, key: &'static str) -> Result<Option<bool>> {
        let Some(item) = self.item(key) else { return Ok(None) };
        item.as_bool().map(Some).ok_or_else(|| self.not(key, "true or false", item))
    }

    /// A list of N expressions of x, y, t.
    pub(super) fn expressions<const N: usize>(&mut self, key: &'static str) -> Result<Option<[Expression; N]>> {
        let Some(all) = self.list_of_expressions(key, N)? else { return Ok(None) };
        let count = all.len();
        all.try_into().map(Some).map_err(|_| self.count(key, N, count))
    }

    /// A text, or a list of texts.
    pub(super) fn texts(&mut self, key: &'static str) -> Result<Option<Vec<String>>> {
        if self.table.get(key).is_none_or(|item| !item.is_array()) {
            return Ok(self.text(key)?.map(|text| vec![text]));
        }
        let Some(item) = self.item(key) else { return Ok(None) };
        let texts = item.as_array().into_iter().flatten().map(|value| value.as_str().map(str::to_owned));
        let texts: Option<Vec<String>> = texts.collect();
        let wrong = || self.not(key, "a text, or a list of texts that is not empty", item);
        texts.filter(|texts| !texts.is_empty()).map(Some).ok_or_else(wrong)
    }

    /// A list of finite numbers in a range.
    pub(super) fn numbers(&mut self, parameter: &Parameter, check: &Check) -> Result<Option<Vec<f64>>> {
        let key = parameter.name;
        let Some(item) = self.item(key) else { return Ok(None) };
        let want = "a list of numbers, as in [1.0, 2.0]";
        let list = item.as_array().filter(|list| !list.is_empty()).ok_or_else(|| self.not(key, want, item))?;
        let mut numbers = Vec::with_capacity(list.len());
        for (i, value) in list.iter().enumerate() {
            let number = number_of(value).filter(|n| (check.holds)(*n));
            numbers.push(number.ok_or_else(|| self.not_entry(key, i, &check.words(parameter.unit), value))?);
        }
        Ok(Some(numbers))
    }

    /// A list of points.
    pub(super) fn points(&mut self, parameter: &Parameter, least: usize) -> Result<Option<Vec<[f64; 2]>>> {
        let key = parameter.name;
        let Some(item) = self.item(key) else { return Ok(None) };
        let list = item.as_array().filter(|list| list.len() >= least);
        let list = list.ok_or_else(|| self.not(key, &parameter.words(), item))?;
        let mut points = Vec::with_capacity(list.len());
        for (i, value) in list.iter().enumerate() {
            let both = value.as_array().filter(|both| both.len() == 2);
            let both = both.and_then(|both| Some([number_of(both.get(0)?)?, number_of(both.get(1)?)?]));
            points.push(both.ok_or_else(|| self.not_entry(key, i, "a point, as in [0.5, 1.0]", value))?);
        }
        Ok(Some(points))
    }

    /// One of some names; the names of `later` are known but not built yet.
    pub(super) fn name(&mut self, key: &'static str, names: &[&'static str], later: &[&str]) -> Result<Option<String>> {
        let Some(item) = self.item(key) else { return Ok(None) };
        let want = || format!("one of {}", quoted(names));
        let text = item.as_str().ok_or_else(|| self.not(key, &want(), item))?;
        self.pick(&[key], text, names, later).map(Some)
    }

    /// A list of names, each once.
    pub(super) fn names(&mut self, key: &'static str, names: &[&'static str]) -> Result<Option<Vec<String>>> {
        let Some(item) = self.item(key) else { return Ok(None) };
        let want = || format!("a list of names out of {}", quoted(names));
        let list = item.as_array().filter(|list| !list.is_empty()).ok_or_else(|| self.not(key, &want(), item))?;
        let mut found: Vec<String> = Vec::with_capacity(list.len());
        for (i, value) in list.iter().enumerate() {
            let text = value.as_str().ok_or_else(|| self.not_entry(key, i, "a name", value))?;
            let name = self.pick(&[key, &i.to_string()], text, names, &[])?;
            if found.contains(&name) {
                return Err(self.wrong_entry(key, i, format!("\"{name}\" is there twice"), "remove one"));
            }
            found.push(name);
        }
        Ok(Some(found))
    }

    /// A list of expressions of x, y, t.
    pub(super) fn list_of_expressions(&mut self, key: &'static str, count: usize) -> Result<Option<Vec<Expression>>> {
        let Some(item) = self.item(key) else { return Ok(None) };
        let list = item.as_array().ok_or_else(|| self.not(key, &format!("a list of {count} expressions"), item))?;
        if list.len() != count {
            return Err(self.count(key, count, list.len()));
        }
        let compile = |(i, value): (usize, &Toml)| self.compile(&[key, &i.to_string()], value);
        list.iter().enumerate().map(compile).collect::<Result<_>>().map(Some)
    }

    /// The table under a key.
    pub(super) fn table(&mut self, key: &'static str) -> Result<Option<Reader<'a>>> {
        let Some(item) = self.item(key) else { return Ok(None) };
        let table = item.as_table_like().ok_or_else(|| self.not(key, &format!("a table [{key}]"), item))?;
        Ok(Some(Reader::new(table, self.below(&[key]), self.origin, format!("[{}]", self.below(&[key]).join(".")))))
    }

    /// The tables of a list of tables; none where the key is not there.
    pub(super) fn tables(&mut self, key: &'static str) -> Result<Vec<Reader<'a>>> {
        let Some(item) = self.item(key) else { return Ok(Vec::new()) };
        let count = item.as_array_of_tables().map(|list| list.len()).or(item.as_array().map(|list| list.len()));
        let Some(count) = count else {
            return Err(self.not(key, &format!("a list of tables, each under [[{key}]] in double brackets"), item));
        };
        let mut tables = Vec::with_capacity(count);
        for (i, entry) in (0..count).filter_map(|i| Some((i.to_string(), item.get(i)?))) {
            let path = self.below(&[key, &i]);
            let what = || format!("entry {i} of `{key}` must be a table, not {}", describe(entry.as_value()));
            let table = entry.as_table_like().ok_or_else(|| {
                self.origin.error(&path, Part::Value, what(), format!("write [[{key}]] and its keys"))
            })?;
            tables.push(Reader::new(table, path, self.origin, format!("[[{key}]]")));
        }
        Ok(tables)
    }

    /// The value of a key, which is known from now on.
    pub(super) fn item(&mut self, key: &'static str) -> Option<&'a Item> {
        self.known.push(key);
        self.table.get(key)
    }

    pub(super) fn below(&self, keys: &[&str]) -> Vec<String> {
        self.path.iter().cloned().chain(keys.iter().map(|key| (*key).to_owned())).collect()
    }

    fn pick(&self, keys: &[&str], text: &str, names: &[&'static str], later: &[&str]) -> Result<String> {
        if names.contains(&text) {
            return Ok(text.to_owned());
        }
        let path = self.below(keys);
        let list = quoted(names);
        if later.contains(&text) {
            let what = format!("`{}` = \"{text}\" is not built yet", keys[0]);
            return Err(self.origin.error(&path, Part::Value, what, format!("built are {list}")));
        }
        let remedy = format!("{}there are {list}", names::did_you_mean(text, names));
        Err(self.origin.error(&path, Part::Value, format!("unknown `{}` \"{}\"", keys[0], short(text)), remedy))
    }

    pub(super) fn compile(&self, keys: &[&str], value: &Toml) -> Result<Expression> {
        let path = self.below(keys);
        if let Some(number) = number_of(value) {
            return Ok(Expression::number(number));
        }
        let Some(text) = value.as_str() else {
            let what = format!("`{}` must be {EXPRESSION}, not {}", keys[0], describe(Some(value)));
            return Err(self.origin.error(&path, Part::Value, what, "for instance \"sin(pi*x)\" or 2.5"));
        };
        Expression::compile(text).map_err(|fault| {
            self.origin.error(&path, Part::Inside(fault.offset), format!("`{}`: {}", keys[0], fault.what), fault.remedy)
        })
    }

    fn unknown(&self, key: &str) -> Error {
        let path = self.below(&[key]);
        let known = self.known.join(", ");
        if self.later.contains(&key) {
            let what = format!("`{key}` is not built yet");
            return self.origin.error(&path, Part::Key, what, format!("{} knows {known}", self.title));
        }
        let what = format!("unknown key `{}` in {}", short(key), self.title);
        let remedy = format!("{}{} knows {known}", names::did_you_mean(key, &self.known), self.title);
        self.origin.error(&path, Part::Key, what, remedy)
    }

    pub(super) fn count(&self, key: &str, want: usize, given: usize) -> Error {
        let order = match want {
            2 => "one for each direction",
            4 => "11, 12, 21, 22",
            _ => "see the documentation of scenes",
        };
        self.wrong(key, format!("`{key}` must have {want} entries, not {given}"), order)
    }

    pub(super) fn not(&self, key: &str, want: &str, item: &Item) -> Error {
        self.wrong(key, format!("`{key}` is {}", describe(item.as_value())), format!("it must be {want}"))
    }

    /// As [`Reader::not`], for whole numbers; one with a point is written without it.
    pub(super) fn not_whole(&self, key: &str, want: &str, item: &Item) -> Error {
        match item.as_float().filter(|x| x.fract() == 0.0 && x.abs() < 1e15) {
            Some(x) => {
                let what = format!("`{key}` is {x:?}, which has a decimal point");
                self.wrong(key, what, format!("it must be {want}, written without a point, such as {x:.0}"))
            }
            None => self.not(key, want, item),
        }
    }

    fn not_entry(&self, key: &str, index: usize, want: &str, value: &Toml) -> Error {
        let what = format!("entry {index} of `{key}` is {}", describe(Some(value)));
        self.wrong_entry(key, index, what, format!("it must be {want}"))
    }
}

pub(super) const EXPRESSION: &str = "an expression of x, y, t in quotes, or a number";

/// The finite number that a value is.
pub(super) fn number_of(value: &Toml) -> Option<f64> {
    let number = value.as_float().or_else(|| value.as_integer().map(|n| n as f64));
    number.filter(|n| n.is_finite())
}

/// A value in words; `None` is a table.
fn describe(value: Option<&Toml>) -> String {
    match value {
        Some(Toml::String(text)) => format!("the text \"{}\"", short(text.value())),
        Some(Toml::Integer(n)) => n.value().to_string(),
        Some(Toml::Float(x)) => x.value().to_string(),
        Some(Toml::Boolean(b)) => b.value().to_string(),
        Some(Toml::Datetime(_)) => "a date".to_owned(),
        Some(Toml::Array(list)) => format!("a list of {}", list.len()),
        Some(Toml::InlineTable(_)) | None => "a table".to_owned(),
    }
}

/// At most 40 characters of a text.
fn short(text: &str) -> String {
    let line = text.lines().next().unwrap_or_default();
    let cut: String = line.chars().take(40).collect();
    if cut == text { cut } else { format!("{cut}...") }
}
