//! What a user asks of a study, and the plan that comes of it.

use super::case::{Case, Series};
use super::choice::Aim;
use super::measure::Measure;
use super::session::Plan;
use crate::error::{Error, Result};
use crate::registry::Method;
use crate::scene::{MEASURES, Scene};

/// The smallest error that a study looks for: double precision over thousands of steps.
const ROUNDING: f64 = 1e-13;
/// The largest degree of a scene.
const MOST_DEGREE: usize = 6;

/// Keys that have an option of their own.
const OPTIONS: [(&str, &str); 5] = [
    ("scheme.method", "--methods"),
    ("scheme.degree", "--degrees"),
    ("scheme.time_degree", "--time-degrees"),
    ("mesh", "--refine"),
    ("cloud.layout", "--layouts"),
];

/// Tables that would hide these keys.
const TABLES: [(&str, &str); 2] = [
    ("scheme", "--methods, --degrees, --time-degrees, or one key such as scheme.flux"),
    ("cloud", "--layouts, or one key such as cloud.per_direction"),
];

/// Tables that say what is computed and what is looked at: runs that differ in them cannot be compared by an error.
const FIXED: [&str; 8] = ["title", "time", "exact", "quantity", "output", "regrid", "checkpoint", "watch"];

/// What is compared, as a user names it. An empty list stands for the default.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Request {
    /// Names of methods.
    pub methods: Vec<String>,
    /// Degrees N.
    pub degrees: Vec<usize>,
    /// Degrees N_T of each N; empty: N alone.
    pub time_degrees: Vec<usize>,
    /// Cells per direction over those of the scene; whole numbers where its mesh is a file.
    pub refinements: Vec<f64>,
    /// Names of layouts of ADER-DGMPM; empty: that of the scene.
    pub layouts: Vec<String>,
    /// Keys of the scene with the values that are compared, such as `curl.control=lcf|off`; several: each with each.
    pub compare: Vec<String>,
    /// Degree and refinement of the reference run; empty: one degree more than the largest, on the finest mesh.
    pub reference: Vec<f64>,
    /// What settings are compared by: standard, l1 or the name of a quantity of the scene; empty: standard.
    pub measure: String,
    /// The error that the cheapest setting is looked for.
    pub error: Option<f64>,
    /// The CPU seconds that the most accurate setting is looked for.
    pub seconds: Option<f64>,
}

impl Request {
    /// The plan for a scene.
    ///
    /// # Errors
    /// A name, degree or number that cannot be used; a scene with `[[regrid]]`.
    pub fn plan(&self, scene: &Scene) -> Result<Plan> {
        if !scene.regrids.is_empty() {
            let what = "a study compares runs on one grid each, and the scene has [[regrid]]";
            return Err(scene.error("regrid", what, "leave them out by --set regrid=[]"));
        }
        let (aim, (series, notes), refinements) = (self.aim()?, self.series(scene)?, self.refinements(scene)?);
        let measure = if self.measure.is_empty() { MEASURES[0] } else { &self.measure };
        let measure = Measure::named(measure, scene)?;
        // Quantities are extrapolated: a reference run is made for them only where it is asked for.
        let asked = measure.needs_reference() || !self.reference.is_empty();
        let reference = self.reference(&refinements)?;
        Ok(Plan { series, refinements, aim, measure, reference: asked.then_some(reference), notes })
    }

    fn aim(&self) -> Result<Option<Aim>> {
        match (self.error, self.seconds) {
            (Some(x), _) | (_, Some(x)) if !(x.is_finite() && x > 0.0) => {
                Err(Error::input(format!("--error or --seconds is {x}"), "give a number above 0"))
            }
            (Some(error), _) if error < ROUNDING => {
                let what = format!("--error is {error:e}, below what rounding leaves of any run");
                Err(Error::input(what, format!("give {ROUNDING:e} or more")))
            }
            (Some(error), _) => Ok(Some(Aim::Error(error))),
            (_, seconds) => Ok(seconds.map(Aim::Seconds)),
        }
    }

    /// The meshes, from coarse to fine.
    fn refinements(&self, scene: &Scene) -> Result<Vec<f64>> {
        let of_file = scene.mesh_path().is_some();
        let mut all = self.refinements.clone();
        if all.is_empty() {
            all = match of_file {
                false => vec![0.25, 0.5, 1.0],
                // Three meshes are the least that extrapolation takes.
                true if !scene.quantities.is_empty() => vec![1.0, 2.0, 3.0],
                true => vec![1.0, 2.0],
            };
        }
        all.sort_by(f64::total_cmp);
        all.dedup();
        let usable = |r: f64| r.is_finite() && r > 0.0 && (!of_file || r.fract() == 0.0);
        if let Some(bad) = all.iter().chain(self.reference.get(1)).find(|r| !usable(**r)) {
            let range = if of_file { "whole numbers from 1: the mesh is a file" } else { "numbers above 0" };
            return Err(Error::input(format!("a refinement is {bad}"), format!("give {range}")));
        }
        Ok(all)
    }

    /// Degree and refinement of the reference run.
    fn reference(&self, refinements: &[f64]) -> Result<(usize, f64)> {
        let finest = refinements.last().copied().unwrap_or(1.0);
        let largest = self.degrees.iter().copied().max().unwrap_or(1);
        match self.reference[..] {
            [] => Ok(((largest + 1).min(MOST_DEGREE), finest)),
            [degree, refinement] if degree.fract() == 0.0 && (0.0..=MOST_DEGREE as f64).contains(&degree) => {
                Ok((degree as usize, refinement))
            }
            _ => Err(Error::input("--reference is not DEGREE,REFINEMENT", "give two numbers, such as 5,2")),
        }
    }

    /// Each value of each key with each of the others: lists of `key=value`; one empty list where nothing is compared.
    fn compared(&self) -> Result<Vec<Vec<String>>> {
        let mut all = vec![Vec::new()];
        for text in &self.compare {
            let parts = text.split_once('=').map(|(key, values)| (key.trim(), values.split('|').map(str::trim)));
            let Some((key, values)) =
                parts.filter(|(key, values)| !key.is_empty() && values.clone().all(|v| !v.is_empty()))
            else {
                let what = format!("--compare {text:?} is not KEY=VALUE|VALUE");
                return Err(Error::input(
                    what,
                    "give a key of the scene with its values, such as \"curl.control=lcf|off\"",
                ));
            };
            let with_option = OPTIONS.iter().find(|(own, _)| key == *own || key.starts_with(&format!("{own}.")));
            if let Some((_, option)) = with_option.or_else(|| TABLES.iter().find(|(table, _)| key == *table)) {
                return Err(Error::input(format!("--compare takes no `{key}`"), format!("give {option}")));
            }
            let table = key.split('.').next().unwrap_or(key);
            if FIXED.contains(&table) {
                let what =
                    format!("--compare takes no `{key}`: runs that differ in it cannot be compared by their error");
                return Err(Error::input(what, "make two scenes, and a study of each"));
            }
            if all.iter().flatten().any(|set: &String| set.starts_with(&format!("{key}="))) {
                return Err(Error::input(
                    format!("--compare names `{key}` twice"),
                    "give all its values at once, with | between them",
                ));
            }
            let with = |sets: &Vec<String>, value| [&sets[..], &[format!("{key}={value}")]].concat();
            all = all.iter().flat_map(|sets| values.clone().map(move |value| with(sets, value))).collect();
        }
        Ok(all)
    }

    /// All series, and a line for each method and degree in which a compared key has no effect.
    fn series(&self, scene: &Scene) -> Result<(Vec<Series>, Vec<String>)> {
        let (mut all, compared) = (Vec::new(), self.compared()?);
        for name in &self.methods {
            let Some(method) = Method::named(name) else {
                let what = format!("there is no method `{name}`");
                return Err(Error::input(what, format!("--methods takes {}", Method::listed())));
            };
            let layouts: Vec<Option<String>> = match method {
                Method::AderDgmpm if !self.layouts.is_empty() => self.layouts.iter().cloned().map(Some).collect(),
                _ => vec![None],
            };
            for &degree in &self.degrees {
                let own = [degree];
                let times = if self.time_degrees.is_empty() { &own[..] } else { &self.time_degrees };
                for &time_degree in times {
                    for (layout, sets) in layouts.iter().flat_map(|layout| compared.iter().map(move |s| (layout, s))) {
                        all.push(Series { method, degree, time_degree, layout: layout.clone(), sets: sets.clone() });
                    }
                }
            }
        }
        // A misspelt layout or a degree beyond the range is an error of the request, not of one case.
        let mut notes = Vec::new();
        for series in &all {
            let scene = scene.with(&Case { series: series.clone(), refinement: 1.0 }.sets(scene))?;
            scene.settings()?;
            notes.extend(without_effect(&scene, series));
        }
        notes.dedup();
        Ok((all, notes))
    }
}

/// The compared keys that have no effect in a series, a line each.
fn without_effect(scene: &Scene, series: &Series) -> Vec<String> {
    let keys: Vec<&str> = series.sets.iter().filter_map(|set| Some(set.split_once('=')?.0)).collect();
    let own = |key: &str| keys.iter().any(|known| key == *known || key.starts_with(&format!("{known}.")));
    let all = scene.without_effect().into_iter().filter(|(key, _)| own(key));
    let name = Series { sets: Vec::new(), ..series.clone() }.name();
    all.map(|(key, why)| format!("note: --compare {key} has no effect on {name}: {why}")).collect()
}
