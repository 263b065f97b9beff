//! The outputs of a scene: kind, when, fields.

use super::reader::{Check, FINITE, POSITIVE, Reader};
use super::regrid::{Criteria, NewMesh, Regrid};
use super::{Field, LAWS, Output, Scene, What, When};
use crate::error::Result;
use crate::step::Law;

impl Scene {
    /// What is odd and no error: outputs that lie after the end of the run, as after `--set time.end=..`; a grid that is
    /// refined or coarsened without an end.
    pub fn warnings(&self) -> Vec<String> {
        let end = self.end;
        let warning = |(i, output): (usize, &Output)| {
            let (key, what) = match &output.when {
                When::At(times) => {
                    let after = times.iter().filter(|time| **time > end).count();
                    let of = times.len();
                    let what = format!(
                        "{after} of {of} times lie after the end of the run, {end:e} s: its last state stands for them"
                    );
                    ("at", (after > 0).then_some(what)?)
                }
                When::Every(interval) if *interval > end => {
                    ("every", format!("longer than the run, {end:e} s: only its start is recorded"))
                }
                _ => return None,
            };
            Some(format!("{}`{key}` of output \"{}\": {what}", self.place(&format!("output.{i}.{key}")), output.name))
        };
        let again = |(rule, regrid): (usize, &Regrid)| {
            let key = match regrid.grid {
                NewMesh::Refine(_) => "refine",
                NewMesh::Coarsen(_) => "coarsen",
                _ => return None,
            };
            let once = matches!(&regrid.when, When::At(_)) || regrid.criteria != Criteria::default();
            let place = self.place(&format!("regrid.{rule}.{key}"));
            (!once).then(|| format!("{place}`{key}` changes the cells that are there, again each time that it is due"))
        };
        let outputs = self.outputs.iter().enumerate().filter_map(warning);
        outputs.chain(self.regrids.iter().enumerate().filter_map(again)).collect()
    }
}

/// Reads every `[[output]]` of a body of these laws, in a run that begins at `start`.
pub(super) fn outputs(tables: Vec<Reader>, laws: &[Law], start: f64) -> Result<Vec<Output>> {
    let mut outputs: Vec<Output> = Vec::with_capacity(tables.len());
    for mut table in tables {
        let output = output(&mut table, laws)?;
        if let When::At(times) = &output.when
            && let Some(early) = times.iter().position(|time| *time < start)
        {
            let what = format!("{} s lies before the start of the run, {start:e} s", times[early]);
            return Err(table.wrong_entry("at", early, what, "give times from [time] start on"));
        }
        let ledger = |output: &Output| matches!(output.what, What::Ledger { .. });
        if ledger(&output) && outputs.iter().any(ledger) {
            return Err(table.wrong("kind", "two [[output]] of kind \"ledger\"", "one ledger records all: remove one"));
        }
        if outputs.iter().any(|other| other.name == output.name) {
            let what = format!("two [[output]] have the name \"{}\"", output.name);
            return Err(table.wrong("name", what, "give each a `name` of its own (default: the kind)"));
        }
        outputs.push(output);
    }
    Ok(outputs)
}

#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Fields,
    Line,
    Ledger,
}

const KINDS: [(&str, Kind); 3] = [("fields", Kind::Fields), ("line", Kind::Line), ("ledger", Kind::Ledger)];

fn output(table: &mut Reader, laws: &[Law]) -> Result<Output> {
    let kind = table.choice("kind", &KINDS, &[])?;
    let kind = kind.ok_or_else(|| table.missing("kind", "\"fields\", \"line\" or \"ledger\""))?;
    let kind_name = KINDS[kind as usize].0;
    table.of_kind(kind_name);
    let name = if kind == Kind::Ledger { None } else { table.text("name")? };
    let when = when(table)?;
    let exact_times = match when {
        Some(When::EverySteps(_)) => None,
        _ => table.boolean("exact_times")?,
    };
    let all = || Field::of_laws(laws);
    let (what, fields) = match kind {
        Kind::Fields => (What::Fields, fields(table, laws)?.unwrap_or_else(all)),
        Kind::Line => {
            (line(table)?, fields(table, laws)?.unwrap_or_else(|| vec![Field::CauchyStress, Field::Velocity]))
        }
        Kind::Ledger => (What::Ledger { balance: table.boolean("balance")?.unwrap_or(true) }, Vec::new()),
    };
    table.finish()?;
    if name.is_none() && kind == Kind::Line {
        return Err(table.missing("name", "the line is written to lines/<name>.csv"));
    }
    let name = name.unwrap_or_else(|| kind_name.to_owned());
    if !fit_for_a_file(&name) {
        let remedy = "it becomes the name of a file: letters, digits, `_`, `-` and `.`, not a `.` first";
        return Err(table.wrong("name", format!("`name` is \"{name}\""), remedy));
    }
    let when = match (when, kind) {
        (Some(when), _) => when,
        (None, Kind::Ledger) => When::EverySteps(1),
        (None, _) => return Err(table.missing("at", "a list of times, in s; or every (s), or every_steps")),
    };
    Ok(Output { name, what, when, exact_times: exact_times.unwrap_or(false), fields })
}

fn fields(table: &mut Reader, laws: &[Law]) -> Result<Option<Vec<Field>>> {
    let known = Field::of_laws(&LAWS.iter().map(super::Law::sample).collect::<Vec<_>>());
    let known: Vec<(&str, Field)> = known.iter().map(|field| (field.name(), *field)).collect();
    let Some(fields) = table.choices("fields", &known)? else { return Ok(None) };
    if let Some(i) = fields.iter().position(|field| !field.is_of(laws)) {
        let what = format!("no material of the scene has \"{}\"", fields[i].name());
        return Err(table.wrong_entry("fields", i, what, "remove it, or give a material law = \"j2\""));
    }
    let twice = (0..fields.len()).find(|&i| fields[..i].contains(&fields[i]));
    match twice {
        Some(i) => {
            Err(table.wrong_entry("fields", i, format!("\"{}\" is there twice", fields[i].name()), "remove one"))
        }
        None => Ok(Some(fields)),
    }
}

const SAMPLES: std::ops::RangeInclusive<usize> = 2..=1_000_000;

fn line(table: &mut Reader) -> Result<What> {
    let from = table.array("from", FINITE)?;
    let to = table.array("to", FINITE)?;
    let samples = table.integer("samples", SAMPLES)?;
    let (Some(from), Some(to), Some(samples)) = (from, to, samples) else {
        let key = [("from", from.is_some()), ("to", to.is_some()), ("samples", samples.is_some())];
        let missing = key.iter().find(|(_, given)| !given).map_or("from", |(key, _)| key);
        return Err(table.missing(missing, "a line needs from = [x, y], to = [x, y] and samples"));
    };
    if from == to {
        return Err(table.wrong("to", "the line has no length: `from` and `to` are the same", "give two points"));
    }
    Ok(What::Line { from, to, samples })
}

/// The keys at, every, every_steps: at most one.
pub(super) fn when(table: &mut Reader) -> Result<Option<When>> {
    let at = table.numbers("at", TIME)?;
    let every = table.number("every", POSITIVE)?;
    let every_steps = table.integer("every_steps", 1..=usize::MAX)?;
    let given: Vec<&str> = ["at", "every", "every_steps"].into_iter().filter(|key| table.has(key)).collect();
    if let [first, second, ..] = given[..] {
        let what = format!("{} has both `{first}` and `{second}`", table.title());
        return Err(table.wrong(second, what, "keep one of at, every, every_steps"));
    }
    let at = at.map(|mut times| {
        times.sort_by(f64::total_cmp);
        times.dedup();
        When::At(times)
    });
    Ok(at.or(every.map(When::Every)).or(every_steps.map(When::EverySteps)))
}

/// 0 is the initial state.
const TIME: Check = Check { range: "not negative (s)", holds: |time| time >= 0.0 };

fn fit_for_a_file(name: &str) -> bool {
    let plain = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '-' | '.');
    name.len() <= 100 && !name.starts_with('.') && name.chars().all(plain)
}
