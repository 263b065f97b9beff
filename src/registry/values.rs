//! What a scene gives for the parameters of an entry, by name: plain data.

use crate::boundary::Data;
use crate::expression::Expression;
use crate::io::LoadTable;
use serde::Serialize;
use std::collections::BTreeMap;
use std::sync::Arc;

/// The value of a parameter.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Value {
    /// true or false.
    Boolean(bool),
    /// A whole number.
    Integer(usize),
    /// A number.
    Number(f64),
    /// A text, or a name out of a list.
    Text(String),
    /// Texts or names.
    Texts(Vec<String>),
    /// Numbers.
    Numbers(Vec<f64>),
    /// Points.
    Points(Vec<[f64; 2]>),
    /// An expression of x, y, t.
    Expression(Expression),
    /// Expressions of x, y, t.
    Expressions(Vec<Expression>),
    /// A table of loads that has been read from its file.
    Loads(LoadTable),
    /// A table.
    Table(Values),
    /// Tables.
    Tables(Vec<Values>),
}

/// Values by the name of their parameter: those that the scene gives, and the defaults of the others that have one.
///
/// The getters take the name of a parameter of the entry whose values these are. Reading has checked the form: what a
/// getter answers for any other name (NaN, 0, an empty text or list) is never seen.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
#[serde(transparent)]
pub struct Values(BTreeMap<&'static str, Value>);

impl Values {
    /// Gives a parameter a value.
    pub fn set(&mut self, name: &'static str, value: Value) {
        self.0.insert(name, value);
    }

    /// Takes all values of another table too.
    pub fn extend(&mut self, other: Values) {
        self.0.extend(other.0);
    }

    /// Names and values.
    pub fn iter(&self) -> impl Iterator<Item = (&'static str, &Value)> {
        self.0.iter().map(|(name, value)| (*name, value))
    }

    /// The value of a parameter, where it has one.
    pub fn get(&self, name: &str) -> Option<&Value> {
        #[cfg(test)]
        tests::ASKED.with_borrow_mut(|asked| asked.insert(name.to_owned()));
        self.0.get(name)
    }

    /// Whether a parameter has a value.
    pub fn has(&self, name: &str) -> bool {
        self.0.contains_key(name)
    }

    /// A number, where it has a value.
    pub fn maybe(&self, name: &str) -> Option<f64> {
        match self.get(name) {
            Some(Value::Number(value)) => Some(*value),
            _ => None,
        }
    }

    /// A number.
    pub fn number(&self, name: &str) -> f64 {
        self.maybe(name).unwrap_or(f64::NAN)
    }

    /// A whole number, where it has a value.
    pub fn maybe_integer(&self, name: &str) -> Option<usize> {
        match self.get(name) {
            Some(Value::Integer(value)) => Some(*value),
            _ => None,
        }
    }

    /// A whole number.
    pub fn integer(&self, name: &str) -> usize {
        self.maybe_integer(name).unwrap_or_default()
    }

    /// true or false.
    pub fn boolean(&self, name: &str) -> bool {
        self.get(name) == Some(&Value::Boolean(true))
    }

    /// A text or a name, where it has a value.
    pub fn maybe_text(&self, name: &str) -> Option<&str> {
        match self.get(name) {
            Some(Value::Text(text)) => Some(text),
            _ => None,
        }
    }

    /// A text or a name.
    pub fn text(&self, name: &str) -> &str {
        self.maybe_text(name).unwrap_or_default()
    }

    /// Texts or names; a single text is a list of one.
    pub fn texts(&self, name: &str) -> &[String] {
        match self.get(name) {
            Some(Value::Texts(texts)) => texts,
            Some(Value::Text(text)) => std::slice::from_ref(text),
            _ => &[],
        }
    }

    /// Numbers.
    pub fn numbers(&self, name: &str) -> &[f64] {
        match self.get(name) {
            Some(Value::Numbers(numbers)) => numbers,
            _ => &[],
        }
    }

    /// Two numbers.
    pub fn vector(&self, name: &str) -> [f64; 2] {
        self.numbers(name).try_into().unwrap_or([f64::NAN; 2])
    }

    /// Points.
    pub fn points(&self, name: &str) -> &[[f64; 2]] {
        match self.get(name) {
            Some(Value::Points(points)) => points,
            _ => &[],
        }
    }

    /// Data by the expressions of one parameter, or in its place by the columns of the table of loads of another.
    pub fn loads<const N: usize>(&self, expressions: &str, file: &str) -> [Data; N] {
        if let Some(Value::Loads(table)) = self.get(file) {
            let table = Arc::new(table.clone());
            return std::array::from_fn(|k| {
                let table = table.clone();
                Arc::new(move |_: [f64; 2], t| table.at(t, k)) as Data
            });
        }
        let all = self.expressions(expressions);
        std::array::from_fn(|k| data(all.get(k).unwrap_or(&Expression::number(f64::NAN))))
    }

    /// A table.
    pub fn table(&self, name: &str) -> Option<&Values> {
        match self.get(name) {
            Some(Value::Table(table)) => Some(table),
            _ => None,
        }
    }

    /// Tables; a single one is a list of one.
    pub fn tables(&self, name: &str) -> &[Values] {
        match self.get(name) {
            Some(Value::Tables(tables)) => tables,
            Some(Value::Table(table)) => std::slice::from_ref(table),
            _ => &[],
        }
    }

    /// The expressions of a parameter: none, one, or one for each component.
    pub fn expressions(&self, name: &str) -> &[Expression] {
        match self.get(name) {
            Some(Value::Expression(one)) => std::slice::from_ref(one),
            Some(Value::Expressions(all)) => all,
            _ => &[],
        }
    }

    /// An expression, where it has a value.
    pub fn expression(&self, name: &str) -> Option<&Expression> {
        self.expressions(name).first()
    }

    /// An expression as data of a boundary or a source.
    pub fn data(&self, name: &str) -> Data {
        data(self.expression(name).unwrap_or(&Expression::number(f64::NAN)))
    }

    /// Two expressions as data of a boundary or a source.
    pub fn pair(&self, name: &str) -> [Data; 2] {
        let all = self.expressions(name);
        [0, 1].map(|k| data(all.get(k).unwrap_or(&Expression::number(f64::NAN))))
    }
}

/// An expression as data of a boundary or a source.
pub fn data(expression: &Expression) -> Data {
    if let Some(constant) = expression.constant() {
        return Arc::new(move |_, _| constant);
    }
    let expression = expression.clone();
    Arc::new(move |x, t| expression.eval(x, t))
}

#[cfg(test)]
pub(super) mod tests {
    use std::cell::RefCell;
    use std::collections::BTreeSet;

    thread_local! {
        /// The names that getters were asked for.
        pub static ASKED: RefCell<BTreeSet<String>> = const { RefCell::new(BTreeSet::new()) };
    }
}
