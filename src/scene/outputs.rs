//! `[[output]]`: what is recorded, and when.

use super::reader::Reader;
use super::tables::{EXACT_TIMES, OUTPUT, WHEN};
use super::{Material, Output, Scene, When};
use crate::error::Result;
use crate::registry::{OUTPUTS, outputs};

impl Scene {
    /// What is odd and no error: outputs that lie after the end of the run, as after `--set time.end=..`; a grid that is
    /// refined or coarsened without an end.
    pub fn warnings(&self) -> Vec<String> {
        let outputs = (0..self.outputs.len()).filter_map(|i| self.warning_of_output(i));
        outputs.chain((0..self.regrids.len()).filter_map(|rule| self.warning_of_regrid(rule))).collect()
    }

    fn warning_of_output(&self, i: usize) -> Option<String> {
        let (output, end) = (&self.outputs[i], self.end);
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
    }

    fn warning_of_regrid(&self, rule: usize) -> Option<String> {
        let regrid = &self.regrids[rule];
        let key = regrid.grid.name();
        let once = matches!(&regrid.when, When::At(_)) || !regrid.criteria.are_none();
        let place = self.place(&format!("regrid.{rule}.{key}"));
        let what = "changes the cells that are there, again each time that it is due";
        (regrid.grid.build().repeats && !once).then(|| format!("{place}`{key}` {what}"))
    }
}

/// Reads every `[[output]]` of a body of these materials, in a run that begins at `start`.
pub(super) fn outputs(tables: Vec<Reader>, materials: &[Material], start: f64, degree: usize) -> Result<Vec<Output>> {
    let laws: Vec<_> = materials.iter().map(|material| (material.law.build())(&material.law.values)).collect();
    let mut outputs: Vec<Output> = Vec::with_capacity(tables.len());
    for mut table in tables {
        let output = output(&mut table, degree)?;
        outputs::check_fields(&output.what, &laws).map_err(|fault| table.fault(&fault))?;
        if let When::At(times) = &output.when
            && let Some(early) = times.iter().position(|time| *time < start)
        {
            let what = format!("{} s lies before the start of the run, {start:e} s", times[early]);
            return Err(table.wrong_entry("at", early, what, "give times from [time] start on"));
        }
        let (kind, once) = (output.what.name(), output.what.build().always.is_some());
        if once && outputs.iter().any(|other| other.what.name() == kind) {
            let what = format!("two [[output]] of kind \"{kind}\"");
            return Err(table.wrong("kind", what, format!("one {kind} records all: remove one")));
        }
        if outputs.iter().any(|other| other.name == output.name) {
            let what = format!("two [[output]] have the name \"{}\"", output.name);
            return Err(table.wrong("name", what, "give each a `name` of its own (default: the kind)"));
        }
        outputs.push(output);
    }
    Ok(outputs)
}

fn output(table: &mut Reader, degree: usize) -> Result<Output> {
    let entry = table.entry(&OUTPUT[0], &OUTPUTS)?;
    table.of_kind(entry.name);
    let times = when(table)?;
    let exact_times = match times {
        Some(When::EverySteps(_)) => None,
        _ => table.boolean(EXACT_TIMES.name)?,
    };
    let what = table.rest_of(entry, degree)?;
    let name = what.values.maybe_text("name").unwrap_or(entry.name).to_owned();
    if !fit_for_a_file(&name) {
        let remedy = "it becomes the name of a file: letters, digits, `_`, `-` and `.`, not a `.` first";
        return Err(table.wrong("name", format!("`name` is \"{name}\""), remedy));
    }
    let default = entry.build.every_steps.map(When::EverySteps);
    let when = times.or(default);
    let when = when.ok_or_else(|| table.missing("at", "a list of times, in s; or every (s), or every_steps"))?;
    Ok(Output { name, what, when, exact_times: exact_times.unwrap_or(false) })
}

/// The keys at, every, every_steps: at most one.
pub(super) fn when(table: &mut Reader) -> Result<Option<When>> {
    let values = table.values(WHEN)?;
    let given: Vec<&str> = WHEN.iter().map(|key| key.name).filter(|key| table.has(key)).collect();
    if let [first, second, ..] = given[..] {
        let what = format!("{} has both `{first}` and `{second}`", table.title());
        return Err(table.wrong(second, what, "keep one of at, every, every_steps"));
    }
    let at = values.has("at").then(|| {
        let mut times = values.numbers("at").to_vec();
        times.sort_by(f64::total_cmp);
        times.dedup();
        When::At(times)
    });
    let every_steps = values.maybe_integer("every_steps").map(When::EverySteps);
    Ok(at.or(values.maybe("every").map(When::Every)).or(every_steps))
}

fn fit_for_a_file(name: &str) -> bool {
    let plain = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '-' | '.');
    name.len() <= 100 && !name.starts_with('.') && name.chars().all(plain)
}
