//! The reference page of scenes, `docs/scene.md`: keys and entries as the tables and the registry have them, between what
//! no table can say.

use super::tables;
use crate::expression::FUNCTIONS;
use crate::registry::{
    CONDITIONS, CONTROLS, Entry, FLUXES, Form, GRIDS, LAWS, LAYOUTS, LIMITERS, METHODS, OUTPUTS, Parameter, Preset,
    QUANTITIES, SOLUTIONS, SOURCES, Table,
};

/// The whole page, in Markdown.
pub fn reference() -> String {
    let mut page = include_str!("page/begin.md").to_owned();
    page += "\n## All keys\n\n";
    page += "A key without a default is required. Numbers are finite. Text stands in quotes. Expressions are texts or numbers.\n";
    all(&mut page);
    page += "\n## Words, fields, times, expressions\n\n";
    page += include_str!("page/words.md");
    let functions: Vec<&str> = FUNCTIONS.iter().map(|(name, _)| *name).collect();
    page += &format!(
        "\n**Expressions** know `+ - * / ^`, comparisons (1 where true, else 0), `x`, `y` (m, in the initial configuration), `t` (s), \
         `pi`, `e`, and {}. `if(c, a, b)` is a where c is not 0, else b. `step(s)` is 0 for s < 0, else 1. Angles are in radians, `log` \
         is the natural logarithm.\n\n",
        functions.join(" ")
    );
    page + include_str!("page/end.md")
}

/// The key of `[scheme]` of this name.
pub fn of_scheme(name: &str) -> Option<&'static Parameter> {
    tables::SCHEME.iter().find(|key| key.name == name)
}

/// Every table with its keys, and the entries that it chooses from.
fn all(page: &mut String) {
    *page += "\n### Above all tables\n";
    keys(page, tables::TOP);
    head(page, "[mesh]", "Where the mesh comes from: one of the two keys. The table is required.");
    keys(page, tables::MESH);
    head(page, "[cloud]", "Where the material points stand, and what cells may have of them; see \"Material points\".");
    keys(page, tables::CLOUD);
    entries(page, "layout", &LAYOUTS, |_| String::new());
    head(page, "[[material]]", "One for each group of cells, at least one.");
    keys(page, tables::MATERIAL);
    entries(page, "law", &LAWS, |_| String::new());
    head(page, "[initial]", "The state at the start.");
    keys(page, tables::INITIAL);
    let about = "An exact solution to measure the run by (`errors` in summary.json); none by default. It gives the initial state \
                 where [initial] is absent, and its body force.";
    head(page, "[exact]", about);
    keys(page, tables::EXACT);
    entries(page, "kind", &SOLUTIONS, |solution| match solution.laws {
        [] => "; for laws without internal variables".to_owned(),
        laws => format!("; only for law = {}", code(laws)),
    });
    let about = "One for each group of edges on the boundary. A group with edges inside of the body, or with none, needs no entry.";
    head(page, "[[boundary]]", about);
    keys(page, tables::BOUNDARY);
    entries(page, "kind", &CONDITIONS, |_| String::new());
    head(page, "[[source]]", "A force on the volume; none by default.");
    keys(page, tables::SOURCE);
    entries(page, "kind", &SOURCES, |_| String::new());
    head(
        page,
        "[scheme]",
        "Method, degrees, flux and step size. The table is required. method.md compares the fluxes.",
    );
    keys(page, tables::SCHEME);
    entries(page, "method", &METHODS, |_| String::new());
    entries(page, "flux", &FLUXES, |_| String::new());
    head(page, "[curl]", "The control of the part of F that is not a gradient, see method.md.");
    keys(page, tables::CURL);
    entries(page, "control", &CONTROLS, |_| String::new());
    let about = "What is cut in cells at shocks, and whether lost cells are stepped again; none by default. method.md describes both.";
    head(page, "[limiter]", about);
    keys(page, tables::LIMITER);
    entries(page, "kind", &LIMITERS, |_| String::new());
    head(page, "[time]", "The table is required.");
    keys(page, tables::TIME);
    head(page, "[watch]", "The watch over the energy, see run.md.");
    keys(page, tables::WATCH);
    let about = "When the run is kept so that `dgmpm resume` goes on with it, see run.md; without this table only where a signal asks \
                 for it.";
    head(page, "[checkpoint]", about);
    keys(page, tables::CHECKPOINT);
    head(
        page,
        "[[output]]",
        "What is recorded, and when: one of `at`, `every`, `every_steps`. A ledger and numbers through time (`tracks/`) are recorded at every \
         step by default.",
    );
    keys(page, &[tables::OUTPUT, tables::WHEN, &[tables::EXACT_TIMES]].concat());
    entries(page, "kind", &OUTPUTS, |_| String::new());
    let about = "Quantities of interest: single numbers that a run writes as `quantities` into summary.json, and whose error `dgmpm study` \
                 finds, see cost.md; none by default. One that a scene does not name costs nothing.";
    head(page, "[[quantity]]", about);
    keys(page, tables::QUANTITY);
    entries(page, "kind", &QUANTITIES, |_| String::new());
    let about = "Another grid during the run, see \"Another grid during the run\"; none by default. One of the keys of the second \
                 table says what the new grid is. Times or `when` are required.";
    head(page, "[[regrid]]", about);
    keys(page, &[tables::WHEN, &[tables::EXACT_TIMES], &tables::REGRID].concat());
    entries(page, "key", &GRIDS, |_| String::new());
}

fn head(page: &mut String, title: &str, about: &str) {
    *page += &format!("\n### `{title}`\n\n{about}\n");
}

/// The keys of a table, one a row; those of tables below it too.
fn keys(page: &mut String, parameters: &[Parameter]) {
    *page += "\n| key | what it is | unit | values | default |\n|---|---|---|---|---|\n";
    parameters.iter().for_each(|parameter| row(page, parameter, ""));
}

fn row(page: &mut String, parameter: &Parameter, above: &str) {
    let name = format!("{above}{}", parameter.name);
    let Parameter { about, unit, form, default, .. } = parameter;
    let line = format!("| `{name}` | {about} | {unit} | {} | {} |\n", values(form), words(default));
    *page += &line.replace("|  |", "| |");
    if let Form::Table(below) | Form::Tables(below) = form {
        below.iter().for_each(|parameter| row(page, parameter, &format!("{name}.")));
    }
}

/// The entries that a key chooses from, each with its keys.
fn entries<B>(page: &mut String, key: &str, entries: &'static Table<B>, more: fn(&B) -> String) {
    let any = entries.iter().any(|entry| !entry.parameters.is_empty());
    *page += &format!(
        "\n| {key} | what it is |{}\n|---|---|{}\n",
        if any { " its keys |" } else { "" },
        if any { "---|" } else { "" }
    );
    for Entry { name, about, parameters, build, .. } in entries {
        let mut all = Vec::new();
        parameters.iter().for_each(|parameter| list(&mut all, parameter, ""));
        let last = if any { format!(" {} |", all.join("<br>")).replace("  |", " |") } else { String::new() };
        *page += &format!("| `{name}` | {about}{} |{last}\n", more(build));
    }
}

/// A key of an entry in one line.
fn list(all: &mut Vec<String>, parameter: &Parameter, above: &str) {
    let name = format!("{above}{}", parameter.name);
    let Parameter { about, unit, form, default, .. } = parameter;
    let unit = if unit.is_empty() { String::new() } else { format!(", {unit}") };
    let default = match default {
        Preset::Required => String::new(),
        Preset::Unless(other) => format!("; or `{other}`"),
        default => format!("; default {}", words(default)),
    };
    all.push(format!("`{name}`: {about} ({}{unit}{default})", values(form)));
    if let Form::Table(below) | Form::Tables(below) = form {
        below.iter().for_each(|parameter| list(all, parameter, &format!("{name}.")));
    }
}

/// What values a form takes; names as in scenes, but those that are not built yet.
fn values(form: &Form) -> String {
    match form {
        Form::Name(names, _) => code(&names()),
        Form::Names(_) => "a list of names of fields".to_owned(),
        Form::Table(_) => "a table".to_owned(),
        Form::Tables(_) => "a list of tables".to_owned(),
        Form::Or(word, other) => format!("`\"{word}\"`, or {}", values(other)),
        Form::Vector(_) => form.words("").replace("two numbers", "`[.., ..]`").replace(", each finite", ""),
        Form::Expressions(2) => "`[.., ..]`, two expressions".to_owned(),
        Form::Expression => "an expression".to_owned(),
        Form::Expressions(_) => form.words("").replace(" of x, y, t", ""),
        _ => form.words(""),
    }
}

/// Texts as they stand in scenes.
fn code(texts: &[&str]) -> String {
    texts.iter().map(|text| format!("`\"{text}\"`")).collect::<Vec<_>>().join(", ")
}

fn words(default: &Preset) -> String {
    match default {
        Preset::Required | Preset::Unless(_) => String::new(),
        Preset::Absent(words) | Preset::ByDegree(words, _) => (*words).to_owned(),
        Preset::Number(value) => value.to_string(),
        Preset::Integer(value) => value.to_string(),
        Preset::Boolean(value) => value.to_string(),
        Preset::Name(name) => format!("`\"{name}\"`"),
        Preset::Names(names) => code(names),
        Preset::Constant(all) => all.iter().map(f64::to_string).collect::<Vec<_>>().join(", "),
    }
}
