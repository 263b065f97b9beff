//! What a run cost and what became of energy and momentum: the table at its end and `summary.json`.

use super::watch::{Alarm, Watch};
use super::{Kept, Settings, Treated};
use crate::state::{State, UNKNOWNS};
use crate::step::phase::{NAMES, Phases};
use crate::step::{Balance, DeepestOverlap, Held, Imbalance, Motion, Scheme, Shares, Survey, Totals};
use cpu_time::ProcessTime;
use serde_json::{Map, Value, json};
use std::time::Instant;

/// Figures of a run.
#[derive(Debug)]
pub struct Report {
    /// Steps done.
    pub steps: usize,
    /// The ends that the run had, s, each with the step from which on it had it: a run that is extended by `resume` has several.
    pub ends: Vec<(usize, f64)>,
    /// Smallest and largest step, s.
    pub dt: [f64; 2],
    /// Seconds per phase, summed over threads.
    pub phases: Phases,
    /// How the steps were divided among threads and ranks, since the run was begun or resumed.
    pub shares: Shares,
    /// Seconds of each observer of the run, in their order, and how often it has observed.
    pub observed: Vec<(f64, usize)>,
    /// Seconds of the rescue: looking for lost cells, and stepping again.
    pub rescue: f64,
    /// Seconds of changes of grid, and how many there were.
    pub regrids: (f64, usize),
    /// Bytes held for single effects.
    pub held: Held,
    /// Totals at the start.
    pub first: Option<Totals>,
    /// Totals at the end.
    pub last: Option<Totals>,
    /// The balance of energy since the start, where an observer wants it.
    pub balance: Option<Balance>,
    /// The work done on the body, and the energy that was made out of nothing.
    pub watch: Watch,
    /// The cells that a limiter and the rescue have changed; none where the scheme has neither.
    pub treated: Option<Treated>,
    /// The deepest overlap of bodies; none where no condition pairs any.
    pub overlap: Option<DeepestOverlap>,
    /// Where a body was deepest in a rigid obstacle or wall; none where no condition is one.
    pub in_obstacle: Option<DeepestOverlap>,
    /// The angular momentum that bodies which keep theirs were not given back, since no step had lost the energy for it, kg m/s (a sum of sizes).
    pub not_restored: Option<f64>,
    /// The smallest J that was seen in a state of the run, at its points, grid nodes and face points.
    pub min_j: f64,
    /// Bytes of operators, state and work.
    pub bytes: usize,
    /// Seconds on the clock.
    pub wall: f64,
    /// Seconds on all processors.
    pub cpu: f64,
    /// DoF-updates: dofs x stages x steps.
    pub updates: f64,
    pub(super) clock: (Instant, ProcessTime),
    /// Seconds on the clock and on all processors before the run was resumed.
    pub(super) before: [f64; 2],
}

impl Default for Report {
    fn default() -> Self {
        Self {
            steps: 0,
            ends: vec![],
            dt: [f64::INFINITY, 0.0],
            phases: Phases::default(),
            shares: Shares::default(),
            observed: vec![],
            rescue: 0.0,
            regrids: (0.0, 0),
            held: Held::default(),
            first: None,
            last: None,
            balance: None,
            watch: Watch::default(),
            treated: None,
            overlap: None,
            in_obstacle: None,
            not_restored: None,
            min_j: f64::INFINITY,
            bytes: 0,
            wall: 0.0,
            cpu: 0.0,
            updates: 0.0,
            clock: (Instant::now(), ProcessTime::now()),
            before: [0.0; 2],
        }
    }
}

impl Report {
    pub(super) fn start(&mut self, scheme: &Scheme, motion: &Motion, settings: &Settings) {
        let Motion { state, survey, work, .. } = motion;
        self.see(survey);
        if self.ends.last().is_none_or(|(_, end)| *end != settings.end) {
            self.ends.push((state.step, settings.end));
        }
        // After a pause the clocks and the balance go on.
        if self.first.is_none() {
            self.clock = (Instant::now(), ProcessTime::now());
            let first = scheme.totals(state);
            self.balance = work.has_balance().then(|| Balance::starting_at(first.accounted()));
            self.watch = Watch::new(scheme, &first, settings.watch);
            self.min_j = self.min_j.min(first.min_j);
            self.treated = Treated::of(scheme);
            self.first = Some(first);
        }
        self.held = work.held();
        let (start, state) = (state, size_of_val(&state.u[..]) + size_of_val(&state.internal[..]));
        self.bytes = self.bytes.max(scheme.operators.bytes() + work.bytes() + state + Kept::bytes(start));
    }

    /// Counts a step of `dt` that led to the state of `motion`; what the watch over the energy says of it.
    pub(super) fn count(&mut self, scheme: &Scheme, dt: f64, motion: &mut Motion) -> Option<Alarm> {
        let Motion { state, survey, work, .. } = motion;
        self.steps += 1;
        self.updates += (dofs(scheme) * scheme.stages()) as f64;
        self.dt = [self.dt[0].min(dt), self.dt[1].max(dt)];
        self.see(survey);
        self.phases.add(&work.take_phases());
        work.add_shares(&mut self.shares);
        self.rescue += work.take_rescue_seconds();
        if let Some(balance) = &mut self.balance {
            work.settle(scheme, balance);
        }
        if let Some(treated) = &mut self.treated {
            treated.count(work.counts(), scheme.operators.blocks.slot.len());
        }
        if let Some(overlap) = work.overlap() {
            self.overlap = Some(self.overlap.unwrap_or_default().or(overlap));
        }
        if scheme.keeps_angular_momentum() {
            self.not_restored = Some(self.not_restored.unwrap_or(0.0) + work.take_not_restored());
        }
        if let Some(depth) = work.in_obstacle() {
            self.in_obstacle = Some(self.in_obstacle.unwrap_or_default().or(depth));
        }
        self.watch.step(scheme, state, work, self.balance.as_ref())
    }

    /// Counts what a survey has seen.
    pub(super) fn see(&mut self, survey: &Survey) {
        self.min_j = self.min_j.min(survey.min_j);
    }

    /// What a regrid took of the energy, J/m.
    pub fn regrid(&mut self, before: &Totals, after: &Totals) {
        let (before, after) = (before.accounted(), after.accounted());
        self.watch.regrid(before, after);
        if let Some(balance) = &mut self.balance {
            balance.regrid(before, after);
        }
    }

    /// Seconds on the clock and on all processors so far.
    pub(super) fn seconds(&self) -> [f64; 2] {
        [self.before[0] + self.clock.0.elapsed().as_secs_f64(), self.before[1] + self.clock.1.elapsed().as_secs_f64()]
    }

    /// Stops the clocks and takes the totals; also for a run that stopped early.
    pub fn finish(&mut self, scheme: &Scheme, state: &State) {
        [self.wall, self.cpu] = self.seconds();
        let last = scheme.totals(state);
        self.min_j = self.min_j.min(last.min_j);
        self.watch.close(last.accounted(), state);
        self.last = Some(last);
    }

    /// The share of the energy (of the start and of the work done) that contact, friction and cohesive edges have taken.
    pub fn taken_by_contact(&self) -> f64 {
        let had =
            self.first.as_ref().map_or(0.0, Totals::accounted) + (self.watch.work[0] + self.watch.work[1]).max(0.0);
        if had > 0.0 { -self.watch.contact_work / had } else { 0.0 }
    }

    /// DoF-updates per CPU second.
    pub fn rate(&self) -> f64 {
        if self.cpu > 0.0 { self.updates / self.cpu } else { 0.0 }
    }

    /// What is there at the end (kinetic and strain energy, and what laws have dissipated) and what was given to the
    /// outside, over what was there at the start and what came from outside: at most 1. It is 1 where there was nothing.
    pub fn energy_ratio(&self) -> f64 {
        let work = self.watch.work[0] + self.watch.work[1];
        match (&self.first, &self.last) {
            (Some(first), Some(last)) if first.accounted() + work.max(0.0) > 0.0 => {
                (last.accounted() - work.min(0.0)) / (first.accounted() + work.max(0.0))
            }
            _ => 1.0,
        }
    }

    /// The keys of `summary.json` that the run itself knows.
    pub fn json(&self, scheme: &Scheme, state: &State) -> Map<String, Value> {
        let phases: Map<String, Value> =
            NAMES.iter().zip(self.phases.seconds).map(|(name, s)| ((*name).to_owned(), json!(s))).collect();
        let last = self.last.unwrap_or_else(|| scheme.totals(state));
        let mut pairs = vec![
            ("cells", json!(scheme.operators.blocks.slot.len())),
            ("dofs", json!(dofs(scheme))),
            ("steps", json!(self.steps)),
            ("dt_min", if self.steps > 0 { json!(self.dt[0]) } else { Value::Null }),
            ("dt_max", json!(self.dt[1])),
            ("end_time", json!(state.time)),
            ("ends", json!(self.ends)),
            ("threads", json!(rayon::current_num_threads())),
            ("cpu_seconds", json!(self.cpu)),
            ("wall_seconds", json!(self.wall)),
            ("phases", Value::Object(phases)),
            ("dof_updates_per_second", json!(self.rate())),
            ("peak_memory_mib", json!(peak_memory_mib())),
            ("kinetic_energy", json!(last.kinetic)),
            ("strain_energy", json!(last.strain)),
            ("total_energy_ratio", json!(self.energy_ratio())),
            ("momentum", json!(last.momentum)),
            ("work", self.work_json()),
            ("energy_made", made_json(&self.watch)),
            ("min_j", json!(self.min_j)),
            ("max_curl_f", json!(last.max_curl)),
        ];
        if let Some(shares) = shares_json(&self.shares) {
            pairs.push(("threads_imbalance", shares));
        }
        if let Some(drift) = last.max_drift {
            pairs.push(("max_drift", json!(drift)));
        }
        if last.in_faces > 0.0 {
            pairs.push(("face_energy", json!(last.in_faces)));
        }
        if let Some(dissipated) = last.dissipated {
            pairs.push(("material_dissipation", json!(dissipated)));
        }
        if let Some(balance) = &self.balance {
            pairs.push(("balance", balance_json(balance, last.accounted())));
        }
        if let Some(treated) = &self.treated {
            pairs.push(("treated_cells", treated.json()));
        }
        self.push_of_bodies(&mut pairs, &last);
        pairs.into_iter().map(|(key, value)| (key.to_owned(), value)).collect()
    }
}

impl Report {
    /// Adds what bodies do to each other and to obstacles, and their angular momentum.
    fn push_of_bodies(&self, pairs: &mut Vec<(&str, Value)>, last: &Totals) {
        for (key, deepest) in [("contact_overlap", self.overlap), ("obstacle_overlap", self.in_obstacle)] {
            let Some(DeepestOverlap { depth, share, x }) = deepest else { continue };
            pairs.push((key, json!({ "depth": depth, "share_of_cell": share, "place": x })));
        }
        if let Some(not_restored) = self.not_restored {
            pairs.push(("angular_momentum_not_restored", json!(not_restored)));
        }
        let first = self.first.and_then(|first| first.angular_momentum);
        if let Some((first, last)) = first.zip(last.angular_momentum) {
            pairs.push(("angular_momentum", json!([first, last])));
        }
    }

    /// Work of the outside; where faces act on each other, theirs as well.
    fn work_json(&self) -> Value {
        let [boundary, sources] = self.watch.work;
        let mut work = json!({ "boundary": boundary, "sources": sources });
        if self.overlap.is_some() {
            work["contact"] = json!(self.watch.contact_work);
        }
        work
    }
}

/// None where one thread has done all.
fn shares_json(shares: &Shares) -> Option<Value> {
    let of = |Imbalance { predicted, measured }| json!({ "predicted": predicted, "measured": measured });
    let mut out = of(shares.of_threads()?);
    out["seconds"] = json!(shares.seconds());
    if let Some(ranks) = shares.of_ranks() {
        out["ranks"] = of(ranks);
        for (k, name) in ["pack", "wait", "unpack"].iter().enumerate() {
            out["ranks"][name] = shares.messages().iter().map(|rank| rank[k]).collect();
        }
    }
    Some(out)
}

/// Null where the watch is off.
fn made_json(watch: &Watch) -> Value {
    let made = watch.made;
    match watch.is_on() {
        true => json!({ "joule": made.joule, "share": made.share, "time": made.time, "step": made.step }),
        false => Value::Null,
    }
}

fn balance_json(balance: &Balance, energy: f64) -> Value {
    json!({
        "boundary_work": balance.boundary_work,
        "source_work": balance.source_work,
        "contact_work": balance.contact_work,
        "flux_dissipation": balance.flux_dissipation,
        "boundary_dissipation": balance.boundary_dissipation,
        "curl_dissipation": balance.curl_dissipation,
        "regrid_dissipation": balance.regrid_dissipation,
        "correction_dissipation": balance.correction_dissipation,
        "remainder": balance.remainder(energy),
        "jumps": balance.jumps,
    })
}

/// 6 (N+1)^2 cells: the grid unknowns, for all methods.
pub fn dofs(scheme: &Scheme) -> usize {
    UNKNOWNS * scheme.operators.nodes() * scheme.operators.blocks.slot.len()
}

/// The largest resident memory of the process so far, MiB; 0 where the system does not tell.
pub fn peak_memory_mib() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kib = line.and_then(|rest| rest.split_whitespace().next()).and_then(|number| number.parse::<f64>().ok());
    kib.unwrap_or(0.0) / 1024.0
}
