//! A study from its plan to its files.

use super::case::{Case, Series};
use super::choice::{Aim, Choice, ranked};
use super::compared::compared;
use super::front::{answers, front};
use super::measure::Measure;
use super::plot::{Axis, plot};
use super::record::Record;
use super::reference::Reference;
use super::table::{self, csv, machine};
use super::words::{answer, line, title};
use super::{SHORT, Study, trend};
use crate::error::{Error, Result};
use crate::format::{count, shell, short_seconds};
use crate::io::pending::write_text;
use crate::lane::Kernel;
use crate::scene::Scene;
use serde_json::{Value, json};
use std::path::PathBuf;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

/// Settings that are tried for an aim before the study gives up.
const TRIES: usize = 4;
/// CPU seconds that one run of the calibration may take.
const CALIBRATION: f64 = 2.0;
/// The best settings of which each gets a mesh near by before one is chosen.
const RIVALS: usize = 3;
/// Meshes that may be measured on the way to the chosen one.
const BETWEEN: usize = 16;

/// What is to be studied.
#[derive(Debug, Clone)]
pub struct Plan {
    /// Methods, degrees, layouts, values of compared keys.
    pub series: Vec<Series>,
    /// Cells per direction over those of the scene, rising.
    pub refinements: Vec<f64>,
    /// What is asked for; none: everything is measured.
    pub aim: Option<Aim>,
    /// What settings are compared by.
    pub measure: Measure,
    /// Degree and refinement of the reference run, where no exact solution is known; none: no reference run.
    pub reference: Option<(usize, f64)>,
    /// What of it says nothing, a line each.
    pub notes: Vec<String>,
}

/// The plots, and the names of their files.
const PLOTS: [(Axis, &str); 2] = [(Axis::Seconds, "error_over_seconds"), (Axis::Dofs, "error_over_dofs")];

/// A study under way.
pub struct Session<'a> {
    study: Study<'a>,
    plan: Plan,
    /// The folder of its files.
    out: PathBuf,
    /// Problem, reference and machine, for the head of the table.
    head: Vec<String>,
    /// Takes a line for the user.
    say: &'a dyn Fn(&str),
}

/// Never set: the table is kept after each run, and an interrupt may simply end the program.
static NEVER: AtomicBool = AtomicBool::new(false);

impl<'a> Session<'a> {
    /// A study of a scene, with `repeat` runs of a short case. Its files go to the folder `out`, and lines for the user to
    /// `say`. Where no exact solution is known, this makes the reference run.
    ///
    /// # Errors
    /// Bad input; a reference run that loses stability.
    pub fn new(
        scene: &'a Scene,
        plan: Plan,
        repeat: usize,
        out: PathBuf,
        say: &'a dyn Fn(&str),
    ) -> Result<Session<'a>> {
        let mesh = scene.build_mesh()?;
        say(&format!("{}: what accuracy costs in time", scene.title));
        scene.check_quantities(&mesh)?;
        let reference = match (plan.reference, scene.build_exact()) {
            (Some((degree, refinement)), _) => Reference::new(scene, degree, refinement, &NEVER)?,
            (None, Some(exact)) => Reference::Exact(exact),
            (None, None) => Reference::Nothing,
        };
        let head = vec![
            format!("problem: {}", scene.title),
            format!(
                "error: {}, against {}",
                plan.measure.label(),
                plan.measure.against(&reference.words(&plan.measure))
            ),
            format!("machine: {}", machine(Kernel::widest())),
        ];
        head.iter().chain(&plan.notes).for_each(|line| say(line));
        let (cells, h) = (mesh.cells.len(), mesh.smallest_h());
        let measure = plan.measure.clone();
        let study = Study { scene, cells, h, reference, measure, records: vec![], repeat, interrupt: &NEVER };
        Ok(Session { study, plan, out, head, say })
    }
}

impl Session<'_> {
    /// Measures what the plan asks for, and writes `study.csv` (after each run), `study.json`, `table.md` and the plots.
    ///
    /// # Errors
    /// An aim that no setting can meet; an interrupt; files that cannot be written.
    pub fn run(mut self) -> Result<()> {
        let tries = match self.plan.aim {
            None => self.all().map(|()| vec![])?,
            Some(aim) => self.aim(aim)?,
        };
        self.finish(tries)
    }

    fn say(&self, text: impl AsRef<str>) {
        (self.say)(text.as_ref());
    }

    /// Measures a case, prints its row and keeps the table so far.
    fn measure(&mut self, case: Case) -> Result<Record> {
        let record = self.study.measure(case)?.clone();
        self.say(line(&record));
        write_text(&self.out.join("study.csv"), &self.csv())?;
        Ok(record)
    }

    /// Every series on every mesh, from coarse to fine.
    fn all(&mut self) -> Result<()> {
        let start = Instant::now();
        let mut predicted = None;
        self.say(title());
        for (level, refinement) in self.plan.refinements.clone().into_iter().enumerate() {
            // Two meshes tell what a step costs whatever its size; one alone is all there is before the second of two.
            if level > 0 && level == (self.plan.refinements.len() - 1).min(2) {
                let spent = start.elapsed().as_secs_f64();
                let whole = spent + self.rest(level, spent);
                self.say(format!("  the whole study will take about {}", short_seconds(whole)));
                predicted = Some(whole);
            }
            for series in self.plan.series.clone() {
                self.measure(Case { series, refinement })?;
            }
        }
        if let Some(predicted) = predicted {
            let took = short_seconds(start.elapsed().as_secs_f64());
            self.say(format!("  the whole study took {took}, predicted {}", short_seconds(predicted)));
        }
        Ok(())
    }

    /// Seconds of the levels from `level` on, by the models of the series; matrices and errors go with the cells.
    fn rest(&self, level: usize, spent: f64) -> f64 {
        let times = |cpu: f64| if cpu < SHORT { cpu * self.study.repeat as f64 } else { cpu };
        let beside = (spent - self.study.records.iter().map(|r| times(r.cpu)).sum::<f64>()).max(0.0);
        let (done, rest) = self.plan.refinements.split_at(level);
        let area: f64 = done.iter().map(|r| r * r).sum();
        let of = |refinement: f64| -> f64 {
            let case = |series: &Series| Case { series: series.clone(), refinement };
            let cpu = |series| self.study.model(series).map_or(0.0, |m| m.at(self.study.size(&case(series))).cpu);
            self.plan.series.iter().map(|s| times(cpu(s))).sum::<f64>() + beside * refinement * refinement / area
        };
        rest.iter().map(|r| of(*r)).sum()
    }

    /// Calibrates, then chooses, predicts and runs until the aim is met.
    fn aim(&mut self, aim: Aim) -> Result<Vec<Value>> {
        self.say(match aim {
            Aim::Error(error) => {
                let error = self.plan.measure.words(error);
                format!("the cheapest setting with an error of {error}; first, short runs")
            }
            Aim::Seconds(s) => format!("the most accurate setting that takes {s} CPU seconds; first, short runs"),
        });
        self.say(title());
        self.calibrate(aim)?;
        let mut tries = Vec::new();
        while tries.len() < TRIES {
            let choice = self.choice(aim)?;
            let (record, found) = self.attempt(&choice)?;
            let met = aim.is_met(record.cpu, found);
            tries.push(json!({
                "setting": record.case.series.name(),
                "refinement": record.case.refinement,
                "sets": record.case.sets(self.study.scene),
                "predicted": choice.prediction,
                "found": {"cpu": record.cpu, "error": found},
                "met": met,
            }));
            if met {
                let sets = record.case.sets(self.study.scene);
                let sets: Vec<String> = sets.iter().map(|set| format!("--set {}", shell(set))).collect();
                let scene = shell(self.study.scene.path().display());
                self.say(format!("run it by: dgmpm run {scene} {}", sets.join(" ")));
                return Ok(tries);
            }
            self.say("not met");
        }
        self.say(format!("the aim was not met in {TRIES} tries, each with what the last had shown"));
        Ok(tries)
    }

    /// The meshes of the plan for each series, as long as they are cheap and the aim lies beyond.
    fn calibrate(&mut self, aim: Aim) -> Result<()> {
        let budget = match aim {
            Aim::Error(_) => CALIBRATION,
            Aim::Seconds(s) => CALIBRATION.min(0.3 * s),
        };
        for series in self.plan.series.clone() {
            for (level, refinement) in self.plan.refinements.clone().into_iter().enumerate() {
                let case = Case { series: series.clone(), refinement };
                let model = self.study.model(&series);
                // Two meshes are the least that tells a rate, three the least that extrapolation takes.
                let least = if self.plan.measure.needs_reference() { 2 } else { 3 };
                let most = if level < least { 10.0 * budget } else { budget };
                let dear = model.is_some_and(|m| m.at(self.study.size(&case)).cpu > most);
                let beyond = |r: &Record| matches!((aim, r.bound()), (Aim::Error(aim), Some(e)) if e < aim);
                if dear || level >= least && self.study.records.iter().any(|r| r.case.series == series && beyond(r)) {
                    break;
                }
                self.measure(case)?;
            }
        }
        Ok(())
    }

    /// The best setting, once the best few were measured near by: a model is not believed far from what it rests on.
    fn choice(&mut self, aim: Aim) -> Result<Choice> {
        for _ in 0..BETWEEN {
            let ranked = ranked(&self.study, &self.plan.series, aim);
            let Some(best) = ranked.first().map(|choice| choice.prediction.cpu) else { break };
            // Not worth it where looking closer costs more than the best is expected to.
            let step = |choice: &Choice| {
                let (case, cpu) = self.between(choice);
                (!choice.calibrated && cpu <= best).then_some(case)
            };
            let Some(case) = ranked.iter().take(RIVALS).find_map(step) else { break };
            self.measure(case)?;
        }
        ranked(&self.study, &self.plan.series, aim).into_iter().next().ok_or_else(|| self.no_setting())
    }

    /// A mesh on the way to a choice, at most twice as fine as what its series was measured on, and its CPU seconds.
    fn between(&self, choice: &Choice) -> (Case, f64) {
        let model = self.study.model(&choice.case.series);
        let reach = model.as_ref().map_or(1.0, |model| model.reach());
        let between = (reach * choice.case.refinement).sqrt().min(2.0 * reach);
        let refinement = if self.study.scene.mesh_path().is_some() { between.ceil() } else { between };
        let case = Case { refinement, series: choice.case.series.clone() };
        let cpu = model.map_or(0.0, |model| model.at(self.study.size(&case)).cpu);
        (case, cpu)
    }

    /// Runs a choice, prediction beside result.
    fn attempt(&mut self, choice: &Choice) -> Result<(Record, f64)> {
        let (cpu, error) = (choice.prediction.cpu, choice.prediction.error);
        let name = format!("{} with refinement {:.4}", choice.case.series.name(), choice.case.refinement);
        self.say(format!("choice: {name}: predicted {}, error {error:.2e}", short_seconds(cpu)));
        let record = self.measure(choice.case.clone())?;
        // What the error is below may be enough.
        let Some(found) = record.bound() else {
            let what = match record.is_done() {
                true => format!("the error of the chosen setting is not known: {}", self.doubt(&record.case.series)),
                false => format!("the chosen setting does not run: {}", record.status),
            };
            return Err(Error::input(what, "give other --degrees or --refine"));
        };
        let took = format!("{} (predicted {})", short_seconds(record.cpu), short_seconds(cpu));
        self.say(format!("result: {took}, error {} (predicted {error:.2e})", record.error_words()));
        Ok((record, found))
    }

    /// Front, answers, quantities, plots and `study.json`.
    fn finish(self, tries: Vec<Value>) -> Result<()> {
        let (records, measure, scene) = (&self.study.records, &self.plan.measure, self.study.scene);
        let answers = answers(records);
        self.say(if answers.is_empty() { "cheapest by error: no run has a known error" } else { "cheapest by error:" });
        answers.iter().for_each(|a| self.say(answer(measure, a.error, &records[a.record])));
        let comparisons = compared(records);
        comparisons.iter().for_each(|comparison| self.say(comparison.line()));
        trend::lines(records, scene).iter().for_each(|line| self.say(line));
        let setting = |r: &Record| {
            json!({
                "setting": r.case.series.name(),
                "refinement": r.case.refinement,
                "cells": r.cells,
                "cpu_seconds": r.cpu,
                "error": r.error(),
                "error_below": r.below,
            })
        };
        let words = answers.iter().map(|a| json!({"for_error": a.error, "use": setting(&records[a.record])}));
        let all = json!({
            "title": scene.title,
            "head": self.head,
            "measure": measure.name(),
            "reference_error": self.study.reference.error(measure),
            "answers": words.collect::<Vec<_>>(),
            "front": front(records).into_iter().map(|k| setting(&records[k])).collect::<Vec<_>>(),
            "quantities": trend::json(records, scene),
            "compared": comparisons,
            "notes": self.plan.notes,
            "tries": tries,
        });
        write_text(&self.out.join("study.csv"), &self.csv())?;
        write_text(&self.out.join("study.json"), &format!("{all:#}\n"))?;
        write_text(&self.out.join("table.md"), &table::markdown(records, measure))?;
        if !scene.quantities.is_empty() {
            write_text(&self.out.join("quantities.md"), &trend::markdown(records, scene))?;
        }
        self.plots()?;
        self.doubt_reference(records);
        self.say(format!("tables and plots in {}", self.out.display()));
        Ok(())
    }

    /// The plots of error over seconds and unknowns; none where no error of a run that went well is known.
    fn plots(&self) -> Result<()> {
        let (records, measure) = (&self.study.records, &self.plan.measure);
        let paths =
            PLOTS.map(|(axis, name)| (axis, ["svg", "png"].map(|ending| self.out.join(name).with_extension(ending))));
        if !records.iter().filter_map(Record::error).any(|error| error > 0.0) {
            let why = match (records.iter().any(|r| r.error().is_some()), records.iter().any(Record::is_done)) {
                (true, _) => "all errors are 0".to_owned(),
                (false, true) => format!("no run has a known error by `{}`", measure.name()),
                (false, false) => "no run went well".to_owned(),
            };
            self.say(format!("no plot: {why}"));
            // Those of an earlier study in this folder would be taken for plots of this one.
            paths.iter().flat_map(|(_, paths)| paths).for_each(|path| drop(std::fs::remove_file(path)));
            return Ok(());
        }
        for (axis, paths) in paths {
            for path in paths {
                plot(records, axis, &self.study.scene.title, measure, &path)?;
            }
        }
        Ok(())
    }

    fn csv(&self) -> String {
        csv(&self.study.records, &self.study.scene.quantities, &self.head)
    }

    /// Why the error of a series by the measure is not known.
    fn doubt(&self, series: &Series) -> String {
        let Measure::Quantity { number, .. } = &self.plan.measure else { return "there is no reference".to_owned() };
        let trends = trend::trends(&self.study.records, self.study.scene, *number);
        let own = trends.into_iter().find(|trend| trend.series == *series);
        own.map_or("no run went well".to_owned(), |trend| trend.limit.words())
    }

    /// The error of an aim that no setting meets.
    fn no_setting(&self) -> Error {
        let measure = &self.plan.measure;
        if measure.needs_reference() || self.study.records.iter().any(|r| r.error().is_some()) {
            return Error::input("no setting of the study can meet this", "allow more, or other --degrees");
        }
        let doubts = self.plan.series.iter().map(|series| format!("{}: {}", series.name(), self.doubt(series)));
        let what =
            format!("no setting has a known error by `{}`: {}", measure.name(), doubts.collect::<Vec<_>>().join("; "));
        Error::input(what, "give finer meshes by --refine, other --degrees, or another --measure")
    }

    /// A result whose error is not far above that of the reference says little, and one below it nothing.
    fn doubt_reference(&self, records: &[Record]) {
        let below = count(records.iter().filter(|r| r.below.is_some()).count(), "run");
        let is_below = records.iter().any(|r| r.below.is_some());
        if !self.plan.measure.needs_reference() {
            if is_below {
                let what =
                    format!("note: {below} met the extrapolated limit more closely than the finest mesh, by chance");
                self.say(format!("{what}: they are `<` that error. Finer meshes by --refine tell more"));
            }
            return;
        }
        if let (true, Some(own)) = (is_below, self.study.reference.error(&self.plan.measure)) {
            let what = format!("note: {below} came nearer to the reference than its own error, about {own:.1e}");
            self.say(format!("{what}: their errors are not known, only that they are `<` what stands in the table"));
            return self.say("  give a finer --reference DEGREE,REFINEMENT to see them");
        }
        let smallest = records.iter().filter_map(Record::error).fold(f64::INFINITY, f64::min);
        let own = self.study.reference.error(&self.plan.measure);
        if own.is_none_or(|own| own > 0.3 * smallest) {
            let own = own.map_or("not known".to_owned(), |own| format!("about {own:.1e}"));
            let what =
                format!("warning: the error of the reference itself is {own}, the smallest found is {smallest:.1e}");
            self.say(format!("{what}: give a finer --reference DEGREE,REFINEMENT"));
        }
    }
}
