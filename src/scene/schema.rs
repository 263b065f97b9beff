//! The JSON schema of scenes, `dgmpm schema`: keys, values and descriptions as the tables and the registry have them. Editors complete
//! and check scenes by it. What holds between several keys is checked by the program alone.

use super::tables;
use crate::registry::{
    CONDITIONS, CONTROLS, Check, Entry, Form, GRIDS, LAWS, LAYOUTS, LIMITERS, OUTPUTS, Parameter, Preset, QUANTITIES,
    SOLUTIONS, SOURCES, Table,
};
use serde_json::{Map, Value, json};

/// The schema, of draft 7.
pub fn schema() -> Value {
    let when = [tables::WHEN, &[tables::EXACT_TIMES]].concat();
    let output = [tables::OUTPUT, &when].concat();
    let regrid = [&when[..], &tables::REGRID].concat();
    let layouts = parameters_of(&LAYOUTS);
    let material = [tables::MATERIAL, &layouts].concat();
    let cloud = [tables::CLOUD, &layouts].concat();
    let mut all = Keys::of(tables::TOP);
    all.table("mesh", object(tables::MESH), true);
    all.table("cloud", object(&cloud), false);
    all.list("material", by_name(&material, "law", &LAWS), true);
    all.table("initial", object(tables::INITIAL), false);
    all.table("exact", by_name(tables::EXACT, "kind", &SOLUTIONS), false);
    all.list("boundary", by_name(tables::BOUNDARY, "kind", &CONDITIONS), false);
    all.list("source", by_name(tables::SOURCE, "kind", &SOURCES), false);
    all.table("scheme", object(tables::SCHEME), true);
    all.table("curl", by_name(tables::CURL, "control", &CONTROLS), false);
    all.table("limiter", by_name(tables::LIMITER, "kind", &LIMITERS), false);
    all.table("time", object(tables::TIME), true);
    all.table("watch", object(tables::WATCH), false);
    all.table("checkpoint", object(tables::CHECKPOINT), false);
    all.list("output", by_name(&output, "kind", &OUTPUTS), false);
    all.list("quantity", by_name(tables::QUANTITY, "kind", &QUANTITIES), false);
    all.list("regrid", object(&[regrid, parameters_of(&GRIDS)].concat()), false);
    let mut schema = all.object();
    schema["$schema"] = json!("http://json-schema.org/draft-07/schema#");
    schema["title"] = json!("a scene of dgmpm");
    schema
}

/// The keys of an object.
struct Keys {
    properties: Map<String, Value>,
    required: Vec<String>,
}

impl Keys {
    fn of(parameters: &[Parameter]) -> Self {
        let mut keys = Self { properties: Map::new(), required: Vec::new() };
        for parameter in parameters {
            keys.properties.insert(parameter.name.to_owned(), value(parameter));
            if matches!(parameter.default, Preset::Required) {
                keys.required.push(parameter.name.to_owned());
            }
        }
        keys
    }

    fn table(&mut self, name: &str, schema: Value, is_required: bool) {
        self.properties.insert(name.to_owned(), schema);
        if is_required {
            self.required.push(name.to_owned());
        }
    }

    fn list(&mut self, name: &str, schema: Value, is_required: bool) {
        self.table(name, json!({ "type": "array", "items": schema }), is_required);
    }

    fn object(self) -> Value {
        let Self { properties, required } = self;
        json!({ "type": "object", "properties": properties, "required": required, "additionalProperties": false })
    }
}

/// A table of these keys and no others.
fn object(parameters: &[Parameter]) -> Value {
    Keys::of(parameters).object()
}

/// The keys of all entries of a table of the registry, each name once and none of them required.
fn parameters_of<B>(table: &'static Table<B>) -> Vec<Parameter> {
    let mut all: Vec<Parameter> = Vec::new();
    for parameter in table.iter().flat_map(|entry| entry.parameters) {
        if all.iter().all(|known| known.name != parameter.name) {
            all.push(Parameter { default: Preset::Absent(""), ..*parameter });
        }
    }
    all
}

/// A table whose `key` names an entry: one form for each of them, with the keys of all and its own.
fn by_name<B>(common: &[Parameter], key: &'static str, entries: &'static Table<B>) -> Value {
    let default = common.iter().find(|parameter| parameter.name == key).map(|parameter| parameter.default);
    let form = |Entry { name, about, parameters, .. }: &Entry<B>| {
        // An entry may have a key that all have: its own counts.
        let others = common.iter().filter(|known| parameters.iter().all(|own| own.name != known.name));
        let keys: Vec<Parameter> = others.chain(*parameters).copied().collect();
        let mut keys = Keys::of(&keys);
        keys.properties.insert(key.to_owned(), json!({ "const": name, "description": about }));
        let is_default = matches!(default, Some(Preset::Name(usual)) if usual == *name);
        if !is_default && !keys.required.iter().any(|known| known == key) {
            keys.required.push(key.to_owned());
        }
        let mut schema = keys.object();
        schema["title"] = json!(name);
        schema
    };
    json!({ "anyOf": entries.iter().map(form).collect::<Vec<_>>() })
}

/// What values a key takes, with what it is.
fn value(parameter: &Parameter) -> Value {
    let Parameter { about, unit, form, default, .. } = parameter;
    let mut schema = of_form(form);
    let unit = if unit.is_empty() { String::new() } else { format!(", {unit}") };
    let words = match default {
        Preset::Absent(words) | Preset::ByDegree(words, _) if !words.is_empty() => format!("; default {words}"),
        _ => String::new(),
    };
    schema["description"] = json!(format!("{about}{unit}{words}"));
    match default {
        Preset::Number(value) => schema["default"] = json!(value),
        Preset::Integer(value) => schema["default"] = json!(value),
        Preset::Boolean(value) => schema["default"] = json!(value),
        Preset::Name(value) => schema["default"] = json!(value),
        Preset::Names(values) => schema["default"] = json!(values),
        Preset::Constant([value]) => schema["default"] = json!(value),
        Preset::Constant(values) => schema["default"] = json!(values),
        Preset::Required | Preset::Unless(_) | Preset::Absent(_) | Preset::ByDegree(..) => {}
    }
    schema
}

fn of_form(form: &Form) -> Value {
    let text = || json!({ "type": "string", "minLength": 1 });
    let list = |items: Value, length: Option<usize>| match length {
        Some(n) => json!({ "type": "array", "items": items, "minItems": n, "maxItems": n }),
        None => json!({ "type": "array", "items": items, "minItems": 1 }),
    };
    let point = || list(json!({ "type": "number" }), Some(2));
    let expression = || json!({ "type": ["string", "number"] });
    match form {
        Form::Number(check) => number(check),
        Form::Integer(from, usize::MAX) => json!({ "type": "integer", "minimum": from }),
        Form::Integer(from, to) => json!({ "type": "integer", "minimum": from, "maximum": to }),
        Form::Boolean => json!({ "type": "boolean" }),
        Form::Numbers(check) => list(number(check), None),
        Form::Vector(check) => list(number(check), Some(2)),
        Form::Points(least) => json!({ "type": "array", "items": point(), "minItems": least }),
        Form::Text | Form::LoadTable(_) => text(),
        Form::Texts => json!({ "anyOf": [text(), list(text(), None)] }),
        Form::Expression => expression(),
        Form::Expressions(n) => list(expression(), Some(*n)),
        Form::Name(names, _) => json!({ "enum": names() }),
        Form::Names(names) => {
            json!({ "type": "array", "items": { "enum": names() }, "minItems": 1, "uniqueItems": true })
        }
        Form::Table(keys) => object(keys),
        Form::Tables(keys) => json!({ "anyOf": [object(keys), list(object(keys), None)] }),
        Form::Or(word, other) => json!({ "anyOf": [{ "const": word }, of_form(other)] }),
    }
}

/// Where ranges of numbers may begin or end.
const BOUNDS: [f64; 5] = [-1.0, 0.0, 0.5, 1.0, 100_000.0];

/// A number with the range of its check, which is found by asking at the usual bounds.
fn number(check: &Check) -> Value {
    let holds = check.holds;
    let is_whole = [1.0, 2.0, 3.0].into_iter().all(holds) && !holds(1.5);
    let step = if is_whole { 1.0 } else { 1e-9 };
    let mut schema = json!({ "type": if is_whole { "integer" } else { "number" } });
    for bound in BOUNDS {
        let [before, at, behind] = [bound - step, bound, bound + step].map(holds);
        match (before, at, behind) {
            (false, true, true) => schema["minimum"] = json!(bound),
            (false, false, true) if !is_whole => schema["exclusiveMinimum"] = json!(bound),
            (true, true, false) => schema["maximum"] = json!(bound),
            (true, false, false) if !is_whole => schema["exclusiveMaximum"] = json!(bound),
            _ => {}
        }
    }
    schema
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::registry::{CELLS, FINITE, NOT_NEGATIVE, POSITIVE, SHARE};

    #[test]
    fn the_range_of_a_number_is_that_of_its_check() {
        assert_eq!(number(&FINITE), json!({ "type": "number" }));
        assert_eq!(number(&POSITIVE), json!({ "type": "number", "exclusiveMinimum": 0.0 }));
        assert_eq!(number(&NOT_NEGATIVE), json!({ "type": "number", "minimum": 0.0 }));
        assert_eq!(number(&SHARE), json!({ "type": "number", "exclusiveMinimum": 0.0, "exclusiveMaximum": 1.0 }));
        assert_eq!(number(&CELLS), json!({ "type": "integer", "minimum": 1.0, "maximum": 100_000.0 }));
    }
}
