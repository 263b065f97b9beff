//! Every entry of the registry and every key of a table in a scene: accepted with its defaults, refused out of its range.

use super::*;
use crate::registry::{
    CONDITIONS, CONTROLS, FLUXES, Form, GRIDS, LAWS, LAYOUTS, LIMITERS, METHODS, OUTPUTS, Parameter, QUANTITIES,
    SOLUTIONS, SOURCES, Value, Values, example,
};

const SCENE: &str = r#"
[mesh]
file = "a.msh"
[[material]]
law = "neo-hookean"
young = 2e11
poisson = 0.3
density = 7800
[[boundary]]
group = "left"
kind = "wall"
[scheme]
method = "ader-dgmpm"
degree = 2
[time]
end = 1e-6
"#;

/// `--set` from the text of further keys.
type Sets = Box<dyn Fn(&str) -> Vec<String>>;

/// An entry in a scene: its name and parameters, and the `--set` that name it, given the text of its other keys.
struct Case {
    name: &'static str,
    parameters: &'static [Parameter],
    sets: Sets,
}

fn case(name: &'static str, parameters: &'static [Parameter], sets: impl Fn(&str) -> Vec<String> + 'static) -> Case {
    Case { name, parameters, sets: Box::new(sets) }
}

fn cases() -> Vec<Case> {
    let mut all = Vec::new();
    for (name, parameters) in LAWS.iter().map(|entry| (entry.name, entry.parameters)) {
        all.push(case(name, parameters, move |keys| vec![format!("material.0={{law=\"{name}\"{keys}}}")]));
    }
    for (name, parameters) in CONDITIONS.iter().map(|entry| (entry.name, entry.parameters)) {
        all.push(case(name, parameters, move |keys| {
            vec![format!("boundary.0={{group=\"left\",kind=\"{name}\"{keys}}}")]
        }));
    }
    for (name, parameters) in SOURCES.iter().map(|entry| (entry.name, entry.parameters)) {
        all.push(case(name, parameters, move |keys| vec![format!("source=[{{kind=\"{name}\"{keys}}}]")]));
    }
    for entry in &SOLUTIONS {
        let law = LAWS.iter().find(|law| entry.build.laws.contains(&law.name)).unwrap_or(LAWS.first());
        let mut values = example(law.parameters);
        // So light that waves are faster than the usual impact.
        values.set("density", Value::Number(1e-9));
        let keys_of_law = given(&values, law.parameters);
        all.push(case(entry.name, entry.parameters, move |keys| {
            let law = format!("material.0={{law=\"{}\"{keys_of_law}}}", law.name);
            vec![law, format!("exact={{kind=\"{}\"{keys}}}", entry.name)]
        }));
    }
    for (name, parameters) in OUTPUTS.iter().map(|entry| (entry.name, entry.parameters)) {
        all.push(case(name, parameters, move |keys| vec![format!("output=[{{kind=\"{name}\",every=1{keys}}}]")]));
    }
    for (name, parameters) in GRIDS.iter().map(|entry| (entry.name, entry.parameters)) {
        all.push(case(name, parameters, move |keys| vec![format!("regrid=[{{every=1{keys}}}]")]));
    }
    for (name, parameters) in LAYOUTS.iter().map(|entry| (entry.name, entry.parameters)) {
        all.push(case(name, parameters, move |keys| vec![format!("cloud={{layout=\"{name}\"{keys}}}")]));
    }
    for (name, parameters) in CONTROLS.iter().map(|entry| (entry.name, entry.parameters)) {
        all.push(case(name, parameters, move |keys| vec![format!("curl={{control=\"{name}\"{keys}}}")]));
    }
    for (name, parameters) in LIMITERS.iter().map(|entry| (entry.name, entry.parameters)) {
        all.push(case(name, parameters, move |keys| vec![format!("limiter={{kind=\"{name}\"{keys}}}")]));
    }
    for (name, parameters) in QUANTITIES.iter().map(|entry| (entry.name, entry.parameters)) {
        all.push(case(name, parameters, move |keys| vec![format!("quantity=[{{name=\"q\",kind=\"{name}\"{keys}}}]")]));
    }
    for name in FLUXES.iter().map(|entry| entry.name) {
        all.push(case(name, &[], move |_| vec![format!("scheme.flux={name}")]));
    }
    for name in METHODS.iter().map(|entry| entry.name) {
        all.push(case(name, &[], move |_| vec![format!("scheme.method={name}")]));
    }
    all
}

/// A value as it stands in a scene.
fn text(value: &Value) -> String {
    match value {
        Value::Boolean(value) => value.to_string(),
        Value::Integer(value) => value.to_string(),
        Value::Number(value) => format!("{value:?}"),
        Value::Text(text) => format!("\"{text}\""),
        Value::Texts(texts) => format!("{texts:?}"),
        Value::Numbers(numbers) => format!("{numbers:?}"),
        Value::Points(points) => format!("{points:?}"),
        // A scene has the path of its file.
        Value::Loads(_) => String::new(),
        Value::Expression(one) => format!("\"{}\"", one.source()),
        Value::Expressions(all) => format!("{:?}", all.iter().map(Expression::source).collect::<Vec<_>>()),
        Value::Table(table) => inline(table),
        Value::Tables(tables) => format!("[{}]", tables.iter().map(inline).collect::<Vec<_>>().join(",")),
    }
}

fn inline(table: &Values) -> String {
    let keys: Vec<String> = table.iter().map(|(key, value)| format!("{key}={}", text(value))).collect();
    format!("{{{}}}", keys.join(","))
}

/// The keys that a scene must give, after a comma.
fn given(values: &Values, parameters: &[Parameter]) -> String {
    let needed = parameters.iter().filter(|parameter| parameter.default.is_asked());
    needed.filter_map(|parameter| Some(format!(",{}={}", parameter.name, text(values.get(parameter.name)?)))).collect()
}

fn parse(sets: &[String]) -> Result<Scene> {
    Scene::parse(SCENE, Path::new("case.toml"), sets)
}

#[test]
fn every_entry_is_accepted_with_its_defaults() {
    for Case { name, parameters, sets } in cases() {
        let values = example(parameters);
        let scene = parse(&sets(&given(&values, parameters))).unwrap_or_else(|error| panic!("{name}: {error}"));
        let json = serde_json::to_string(&scene).unwrap();
        assert!(json.contains(&format!("\"{name}\"")), "{name}: {json}");
        // With all that has a value written out, too.
        let all: String = values.iter().map(|(key, value)| format!(",{key}={}", text(value))).collect();
        let again = parse(&sets(&all)).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_eq!(json, serde_json::to_string(&again).unwrap(), "{name}");
    }
}

/// Values out of the range of a parameter, and what a message has to say of it; only numbers have a range.
fn bad(parameter: &Parameter) -> Vec<(String, &'static str)> {
    let out = |check: &crate::registry::Check| {
        let outside = [-1.5, 0.0, 0.75, 1.5, 1e9].into_iter().filter(|value| !(check.holds)(*value));
        outside.map(|value| format!("{value:?}")).chain(["nan".to_owned(), "inf".to_owned()]).collect::<Vec<_>>()
    };
    match &parameter.form {
        Form::Number(check) | Form::Or(_, Form::Number(check)) => {
            let range = if check.range == "finite" { "a number" } else { check.range };
            out(check).into_iter().map(|value| (value, range)).collect()
        }
        Form::Integer(from, to) => {
            let below = from.checked_sub(1).map_or("-1".to_owned(), |below| below.to_string());
            let above = to.checked_add(1).map(|above| above.to_string());
            [Some(below), above].into_iter().flatten().map(|value| (value, "a whole number")).collect()
        }
        Form::Vector(check) => out(check).into_iter().map(|value| (format!("[1, {value}]"), "number")).collect(),
        _ => vec![],
    }
}

#[test]
fn every_parameter_of_an_entry_out_of_its_range_is_refused() {
    let mut count = 0;
    for Case { name, parameters, sets } in cases() {
        for parameter in parameters {
            let others: Vec<Parameter> =
                parameters.iter().copied().filter(|other| other.name != parameter.name).collect();
            for (value, range) in bad(parameter) {
                let keys = format!("{},{}={value}", given(&example(parameters), &others), parameter.name);
                let message = parse(&sets(&keys)).expect_err(&format!("{name}: {keys}")).to_string();
                assert!(message.contains(parameter.name) && message.contains(range), "{name}: {keys}: {message}");
                count += 1;
            }
        }
    }
    assert!(count > 100, "only {count}");
}

#[test]
fn every_key_of_a_table_out_of_its_range_is_refused() {
    let mut count = 0;
    for (table, keys) in [
        ("cloud", tables::CLOUD),
        ("scheme", tables::SCHEME),
        ("time", tables::TIME),
        ("watch", tables::WATCH),
        ("output.0", tables::WHEN),
        ("regrid.0", tables::WHEN),
        ("regrid.0.when", tables::CRITERIA),
        ("mesh.rectangle", crate::registry::grids::RECTANGLE),
    ] {
        for parameter in keys {
            for (value, range) in bad(parameter) {
                let kind = if table.starts_with("output") { "output.0.kind=ledger" } else { "title=a" };
                let sets = [kind.to_owned(), format!("{table}.{}={value}", parameter.name)];
                let message = parse(&sets).expect_err(&sets[1]).to_string();
                assert!(message.contains(parameter.name) && message.contains(range), "{}: {message}", sets[1]);
                count += 1;
            }
        }
    }
    assert!(count > 30, "only {count}");
}

#[test]
fn an_empty_list_of_tables_is_refused_at_its_key() {
    for key in ["rectangles", "strips"] {
        let text = format!("{SCENE}[[regrid]]\nat = [1e-6]\n{key} = []\n");
        let why = Scene::parse(&text, Path::new("a.toml"), &[]).unwrap_err().to_string();
        assert!(why.contains(&format!("`{key}` is an empty list")) && why.contains("at least one"), "{why}");
    }
}
