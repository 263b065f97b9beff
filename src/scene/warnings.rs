//! What is odd in a scene and no error: times after the end of the run, and keys that change nothing. A scene with such keys
//! stays good, as the next `--set scheme.method=..` may give them a meaning.

use super::origin::Given;
use super::{Histories, Scene, When};
use crate::registry::layouts;

impl Scene {
    /// What is odd and no error: outputs and changes of grid that lie after the end of the run, as after `--set time.end=..`; a
    /// grid that is refined or coarsened without an end; keys that have no effect; keys of the file that a `--set` replaces.
    pub fn warnings(&self) -> Vec<String> {
        let outputs = (0..self.outputs.len()).filter_map(|i| self.warning_of_output(i));
        let regrids = (0..self.regrids.len()).flat_map(|rule| self.warnings_of_regrid(rule));
        let without_effect = self.without_effect().into_iter();
        let without_effect = without_effect.map(|(key, why)| format!("{}{}", self.place(&key), words(&key, &why)));
        self.origin.replaced.iter().cloned().chain(outputs).chain(regrids).chain(without_effect).collect()
    }

    fn warning_of_output(&self, i: usize) -> Option<String> {
        let output = &self.outputs[i];
        let (key, what) = match &output.when {
            When::At(times) => ("at", self.times_after_the_end(times, "its last state stands for them")?),
            When::Every(interval) if *interval > self.end - self.start => (
                "every",
                format!("longer than the run, {:e} s: it has the start and the end of the run alone", self.end),
            ),
            _ => return None,
        };
        Some(format!("{}`{key}` of output \"{}\": {what}", self.place(&format!("output.{i}.{key}")), output.name))
    }

    fn warnings_of_regrid(&self, rule: usize) -> Vec<String> {
        let regrid = &self.regrids[rule];
        let warning = |key: &str, what: &str| {
            let place = self.place(&format!("regrid.{rule}.{key}"));
            format!("{place}`{key}` {what}")
        };
        let late = match &regrid.when {
            When::At(times) => self.times_after_the_end(times, "nothing happens then"),
            _ => None,
        };
        let key = regrid.grid.name();
        let once = matches!(&regrid.when, When::At(_)) || !regrid.criteria.are_none();
        let what = "changes the cells that are there, again each time that it is due";
        let again = (regrid.grid.build().repeats && !once).then(|| warning(key, what));
        late.map(|what| warning("at", &format!("of [[regrid]]: {what}"))).into_iter().chain(again).collect()
    }

    fn times_after_the_end(&self, times: &[f64], then: &str) -> Option<String> {
        let after = times.iter().filter(|time| **time > self.end).count();
        let of = times.len();
        (after > 0).then(|| format!("{after} of {of} times lie after the end of the run, {:e} s: {then}", self.end))
    }

    /// The keys that the scene gives and that change nothing, and why.
    pub(crate) fn without_effect(&self) -> Vec<(String, String)> {
        let given = self.origin.given();
        let (method, degree) = (self.scheme.method, self.scheme.degree);
        let name = method.name();
        let mut all: Vec<(String, String)> = Vec::new();
        let mut add = |key: &str, why: String| {
            if given.has(key) && all.iter().all(|(known, _)| known != key) {
                all.push((key.to_owned(), why));
            }
        };
        if method.build().samples.is_none() {
            add("scheme.sweeps", format!("{name} has no predictor"));
        }
        if degree == 0 {
            add("curl", "fields of degree 0 have no curl".to_owned());
        }
        if self.initial.snapshot.is_some() {
            add("time.start", "the run starts at the time of its snapshot".to_owned());
        }
        let at_points = |k: &usize| method.has_points() && self.materials[*k].histories != Some(Histories::Nodes);
        if !(0..self.materials.len()).any(|k| at_points(&k)) {
            let why = "no cell computes at its material points";
            if !self.initial.from_cloud {
                ["cloud.face_lebesgue", "cloud.condition"].into_iter().for_each(|key| add(key, why.to_owned()));
            }
            let rules = 0..self.regrids.len();
            rules.for_each(|rule| {
                add(&format!("regrid.{rule}.when.certificate"), format!("{why}, so that no certificate changes"));
            });
        }
        self.of_points_without_effect(&given, &mut add);
        if self.materials.iter().all(|material| material.histories.is_none()) {
            add("cloud.histories", "no law of the scene has internal variables".to_owned());
        }
        for key in ["layout", "per_direction", "histories"] {
            let needs = |k: &usize| key != "histories" || self.materials[*k].histories.is_some();
            if (0..self.materials.len()).filter(needs).all(|k| given.has(&format!("material.{k}.{key}"))) {
                add(&format!("cloud.{key}"), "each [[material]] that it may concern has its own".to_owned());
            }
        }
        all
    }

    /// Keys of points in a method without points, and of internal variables at points that are the Gauss nodes.
    fn of_points_without_effect(&self, given: &Given, add: &mut dyn FnMut(&str, String)) {
        let (method, degree) = (self.scheme.method, self.scheme.degree);
        let name = method.name();
        let own = (0..self.materials.len()).map(|k| format!("material.{k}"));
        for (k, table) in own.enumerate() {
            let (material, general) = (&self.materials[k], "cloud".to_owned());
            let table_of = |key: &str| if given.has(&format!("{table}.{key}")) { &table } else { &general };
            if material.histories == Some(Histories::Points) {
                let key = format!("{}.histories", table_of("histories"));
                let layout = material.cloud.layout.build();
                if !method.has_points() {
                    add(&key, format!("{name} keeps internal variables on the Gauss nodes"));
                } else if layout.on_nodes && material.cloud.per_direction == degree + 1 {
                    add(&key, "the material points are the Gauss nodes".to_owned());
                }
            }
            if !method.has_points() {
                let why = format!("{name} computes on the Gauss nodes, and the points are only for exports");
                add(&format!("{}.per_direction", table_of("per_direction")), why.clone());
                if material.cloud.layout.name() != layouts::default_name(degree) {
                    add(&format!("{}.layout", table_of("layout")), why);
                }
            }
        }
    }
}

/// A key without effect in words.
fn words(key: &str, why: &str) -> String {
    let last = key.rsplit('.').next().unwrap_or(key);
    format!("`{last}` has no effect on this run: {why}")
}
