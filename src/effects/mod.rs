//! The effects that a scene can ask for, as a list: keys, formula, and what each costs the standard scene. `dgmpm effects` prints it,
//! and `docs/effects.md` is it. The costs are stored figures ([`measure`] makes them anew).

mod formulas;
mod measure;

pub use measure::{Cost, measure, stored, text};

use crate::registry::{CONDITIONS, CONTROLS, GRIDS, LIMITERS, OUTPUTS, Parameter, QUANTITIES, SOURCES, Table};

/// An effect.
#[derive(Debug, Clone, Copy)]
pub struct Effect {
    /// The table of the scene that names it, such as `[[source]]`.
    pub table: &'static str,
    /// Its name there.
    pub name: &'static str,
    /// What it is, in one line.
    pub about: &'static str,
    /// Its keys, without those that all of the table have.
    pub keys: &'static [Parameter],
    /// The same as a formula, where one is written down.
    pub formula: Option<&'static str>,
}

/// The entries of a table.
fn of<B>(table: &'static str, entries: &'static Table<B>) -> Vec<Effect> {
    let effect = |entry: &'static crate::registry::Entry<B>| {
        let (name, about, keys) = (entry.name, entry.about, entry.parameters);
        Effect { table, name, about, keys, formula: formulas::formula(table, name) }
    };
    entries.iter().map(effect).collect()
}

/// The keys of `[scheme]` that are effects: each is its own key.
const OF_SCHEME: [&str; 2] = ["angular_momentum", "springs"];

fn of_scheme() -> impl Iterator<Item = Effect> {
    OF_SCHEME.iter().filter_map(|name| {
        let key = crate::scene::of_scheme(name)?;
        let (table, formula) = ("[scheme]", formulas::formula("[scheme]", name));
        Some(Effect { table, name: key.name, about: key.about, keys: &[], formula })
    })
}

/// All effects, those that a program has added too. `off` is none.
pub fn effects() -> Vec<Effect> {
    let mut all = of("[[boundary]]", &CONDITIONS);
    all.extend(of("[[source]]", &SOURCES));
    all.extend(of("[curl]", &CONTROLS));
    all.extend(of("[limiter]", &LIMITERS));
    all.extend(of_scheme());
    all.extend(of("[[regrid]]", &GRIDS));
    all.extend(of("[[output]]", &OUTPUTS));
    all.extend(of("[[quantity]]", &QUANTITIES));
    all.retain(|effect| effect.name != "off");
    all
}

/// The cost of an effect in words.
fn cost_of(effect: &Effect, costs: &[Cost]) -> String {
    let own = costs.iter().find(|cost| cost.table == effect.table && cost.name == effect.name);
    own.map_or("-".to_owned(), |cost| format!("{:+.1} %", cost.percent))
}

fn keys_of(effect: &Effect) -> Vec<&'static str> {
    effect.keys.iter().map(|key| key.name).collect()
}

/// The list for a terminal.
pub fn lines() -> Vec<String> {
    let (head, costs) = stored();
    let mut out =
        vec!["effect: its keys; formula; what it adds to the standard scene, where it was measured".to_owned()];
    out.extend(head);
    let mut table = "";
    for effect in effects() {
        if effect.table != table {
            table = effect.table;
            out.push(table.to_owned());
        }
        let keys = keys_of(&effect);
        let keys = if keys.is_empty() { "no keys".to_owned() } else { keys.join(", ") };
        let formula = effect.formula.unwrap_or(effect.about);
        out.push(format!("  {:<12} {keys}; {formula}; {}", effect.name, cost_of(&effect, &costs)));
    }
    out
}

/// The page `docs/effects.md`, in Markdown.
pub fn page() -> String {
    let (head, costs) = stored();
    let mut page = include_str!("begin.md").to_owned();
    head.iter().for_each(|line| page += &format!("- {line}\n"));
    let mut table = "";
    for effect in effects() {
        if effect.table != table {
            table = effect.table;
            page +=
                &format!("\n## `{table}`\n\n| effect | what it is | formula | keys | cost |\n|---|---|---|---|---|\n");
        }
        let keys: Vec<String> = keys_of(&effect).iter().map(|key| format!("`{key}`")).collect();
        let formula = effect.formula.map_or(String::new(), |formula| format!("`{}`", formula.replace('|', "\\|")));
        let cost = cost_of(&effect, &costs);
        let row = format!("| `{}` | {} | {formula} | {} | {cost} |\n", effect.name, effect.about, keys.join(", "));
        page += &row.replace("|  |", "| |");
    }
    page
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formulas_and_costs_are_those_of_entries() {
        let all = effects();
        let is_one = |table: &str, name: &str| all.iter().any(|effect| effect.table == table && effect.name == name);
        formulas::all().for_each(|(table, name)| assert!(is_one(table, name), "{table} {name}"));
        stored().1.iter().for_each(|cost| assert!(is_one(cost.table, &cost.name), "{} {}", cost.table, cost.name));
        measure::CASES.iter().for_each(|case| assert!(is_one(case.table, case.name), "{} {}", case.table, case.name));
        assert!(lines().len() > all.len());
    }
}
