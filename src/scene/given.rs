//! What a table of a scene gives for the parameters that it may have, and the entry of the registry that it chooses.

use super::origin::Part;
use super::reader::{EXPRESSION, Reader, number_of};
use crate::error::{Error, Result};
use crate::registry::{Chosen, Entry, Fault, Form, Parameter, Preset, Table, Value, Values};

impl Reader<'_> {
    /// What the table gives for some parameters.
    pub(super) fn values(&mut self, parameters: &[Parameter]) -> Result<Values> {
        let mut values = Values::default();
        for parameter in parameters {
            if let Some(value) = self.value(parameter)? {
                values.set(parameter.name, value);
            }
        }
        Ok(values)
    }

    /// Adds the defaults of parameters that the table does not give; those that it must give are missing.
    pub(super) fn complete(&self, parameters: &[Parameter], values: &mut Values, degree: usize) -> Result<()> {
        for parameter in parameters {
            let other = if let Preset::Unless(other) = parameter.default { Some(other) } else { None };
            let has_other = other.is_some_and(|other| self.has(other));
            match (self.has(parameter.name), has_other) {
                (true, true) => return Err(self.both(parameter.name, other.unwrap_or_default())),
                (true, false) | (false, true) => continue,
                (false, false) => {}
            }
            if let Some(other) = other {
                let remedy = format!("{}: {}; or give `{other}`", parameter.about, parameter.words());
                return Err(self.missing(parameter.name, &remedy));
            }
            if let Preset::Required = parameter.default {
                return Err(self.missing(parameter.name, &format!("{}: {}", parameter.about, parameter.words())));
            }
            if let Some(value) = parameter.default.value(degree) {
                values.set(parameter.name, value);
            }
        }
        Ok(())
    }

    /// Two keys of which one takes the place of the other.
    fn both(&self, one: &str, other: &str) -> Error {
        self.wrong(other, format!("{} has both `{one}` and `{other}`", self.title()), "keep one of them")
    }

    /// The entry that a key names, if the key is there.
    pub(super) fn maybe_entry<B>(
        &mut self,
        key: &Parameter,
        entries: &'static Table<B>,
    ) -> Result<Option<&'static Entry<B>>> {
        let values = self.values(std::slice::from_ref(key))?;
        Ok(values.maybe_text(key.name).and_then(|name| entries.find(name)))
    }

    /// The entry that a key names.
    pub(super) fn entry<B>(&mut self, key: &Parameter, entries: &'static Table<B>) -> Result<&'static Entry<B>> {
        let entry = self.maybe_entry(key, entries)?;
        entry.ok_or_else(|| self.missing(key.name, &format!("{}: {}", key.about, key.words())))
    }

    /// All that is left of a table: the parameters of an entry, which is its kind.
    pub(super) fn rest<B>(&mut self, entry: &'static Entry<B>, degree: usize) -> Result<Chosen<B>> {
        self.of_kind(entry.name);
        self.rest_of(entry, degree)
    }

    /// All that is left of a table: the parameters of an entry.
    pub(super) fn rest_of<B>(&mut self, entry: &'static Entry<B>, degree: usize) -> Result<Chosen<B>> {
        let mut values = self.values(entry.parameters)?;
        self.finish()?;
        self.complete(entry.parameters, &mut values, degree)?;
        self.fits(entry, &values)?;
        Ok(Chosen { entry, values })
    }

    /// Whether the values of an entry fit together.
    pub(super) fn fits<B>(&self, entry: &Entry<B>, values: &Values) -> Result<()> {
        (entry.check)(values).map_err(|fault| self.fault(&fault))
    }

    /// A fault of values as an error at their key.
    pub(super) fn fault(&self, fault: &Fault) -> Error {
        let path: Vec<&str> = fault.key.split('.').collect();
        self.origin.error(&self.below(&path), Part::Value, &fault.what, &fault.remedy)
    }

    /// A key that the table may have.
    pub(super) fn know(&mut self, key: &'static str) {
        self.known.push(key);
    }

    /// What the table gives for a parameter.
    fn value(&mut self, parameter: &Parameter) -> Result<Option<Value>> {
        self.value_of(parameter, &parameter.form)
    }

    fn value_of(&mut self, parameter: &Parameter, form: &Form) -> Result<Option<Value>> {
        let key = parameter.name;
        Ok(match form {
            Form::Number(check) => {
                let Some(item) = self.item(key) else { return Ok(None) };
                let number = item.as_value().and_then(number_of).filter(|n| (check.holds)(*n));
                Some(Value::Number(number.ok_or_else(|| self.not(key, &form.words(parameter.unit), item))?))
            }
            Form::Integer(from, to) => {
                let Some(item) = self.item(key) else { return Ok(None) };
                let number = item.as_integer().and_then(|n| usize::try_from(n).ok());
                let number = number.filter(|n| (from..=to).contains(&n));
                Some(Value::Integer(number.ok_or_else(|| self.not_whole(key, &form.words(""), item))?))
            }
            Form::Boolean => self.boolean(key)?.map(Value::Boolean),
            Form::Numbers(check) => self.numbers(parameter, check)?.map(Value::Numbers),
            Form::Vector(check) => match self.numbers(parameter, check)? {
                Some(numbers) if numbers.len() != 2 => return Err(self.count(key, 2, numbers.len())),
                numbers => numbers.map(Value::Numbers),
            },
            Form::Points(least) => self.points(parameter, *least)?.map(Value::Points),
            Form::Text | Form::LoadTable(_) => self.text(key)?.map(Value::Text),
            Form::Texts => self.texts(key)?.map(Value::Texts),
            Form::Expression => {
                let Some(item) = self.item(key) else { return Ok(None) };
                let value = item.as_value().ok_or_else(|| self.not(key, EXPRESSION, item))?;
                Some(Value::Expression(self.compile(&[key], value)?))
            }
            Form::Expressions(count) => self.list_of_expressions(key, *count)?.map(Value::Expressions),
            Form::Name(names, later) => self.name(key, &names(), later)?.map(Value::Text),
            Form::Names(names) => self.names(key, &names())?.map(Value::Texts),
            Form::Table(keys) => match self.table(key)? {
                Some(mut table) => Some(Value::Table(table.all(keys)?)),
                None => None,
            },
            Form::Tables(keys) => {
                let mut tables = self.tables(key)?;
                let all = tables.iter_mut().map(|table| table.all(keys)).collect::<Result<Vec<_>>>()?;
                if all.is_empty() && self.has(key) {
                    return Err(self.wrong(key, format!("`{key}` is an empty list"), "give at least one table"));
                }
                (!all.is_empty()).then_some(Value::Tables(all))
            }
            Form::Or(word, _) if self.is_text(key, word) => self.text(key)?.map(Value::Text),
            Form::Or(word, other) => {
                return self
                    .value_of(parameter, other)
                    .map_err(|why| why.with_remedy(|remedy| format!("{remedy}, or \"{word}\"")));
            }
        })
    }

    /// All of a table that has these keys and no others.
    pub(super) fn all(&mut self, parameters: &[Parameter]) -> Result<Values> {
        let mut values = self.values(parameters)?;
        self.finish()?;
        self.complete(parameters, &mut values, 0)?;
        Ok(values)
    }
}
