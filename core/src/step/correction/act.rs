//! Corrections at work: memory, and the sweep over the blocks.

use super::{Corrected, Correction, Made, Notes};
use crate::lane::F8;
use crate::state::State;
use crate::step::rescue::{self, flatten};
use crate::step::worst::Worst;
use crate::step::{Scheme, Work};

/// Memory of the corrections and the rescue of a scheme that has some.
pub(crate) struct Memory {
    /// The worst of each block by itself.
    pub worst: Vec<Worst>,
    /// The state that a stage of Runge-Kutta begins with; none where nothing acts on stages.
    pub stage: Option<State>,
    /// Energy that the rescue took of the state before the last step, and what it and the corrections took of the state after it,
    /// J/m; 0 where the balance is off.
    pub loss: [f64; 2],
    /// See [`Work::treated`].
    pub treated: Vec<F8>,
    /// Changed blocks.
    pub blocks: Blocks,
    /// The memory of the rescue; none where the scheme has none.
    pub rescue: Option<rescue::Memory>,
}

/// Blocks that corrections change, made beside the state.
pub(crate) struct Blocks {
    /// What each correction notes.
    pub notes: Vec<Notes>,
    /// The lanes that something has changed since the step began.
    pub changed: Vec<u8>,
    /// Of these the lanes that corrections have changed.
    pub corrected: Vec<u8>,
    /// Whether internal variables of the block are found anew.
    pub renewed: Vec<bool>,
    /// The cells whose step is done again at order 0, see `step::rescue`; empty where there is no rescue.
    pub flat: Vec<u8>,
    /// The lanes that the correction under way changes.
    under_way: Vec<u8>,
    /// What it makes of those blocks.
    u: Vec<F8>,
    internal: Vec<F8>,
}

impl Memory {
    /// For a scheme and states like `state`; none where there is neither a correction nor a rescue.
    pub fn new(scheme: &Scheme, state: &State) -> Option<Box<Self>> {
        if scheme.corrections.is_empty() && scheme.rescue.is_none() {
            return None;
        }
        let count = scheme.operators.blocks.len();
        let notes = |correction: &std::sync::Arc<dyn Correction>| Notes {
            marked: vec![0; count],
            numbers: vec![F8::ZERO; count * correction.numbers(scheme)],
        };
        let blocks = Blocks {
            notes: scheme.corrections.iter().map(notes).collect(),
            changed: vec![0; count],
            corrected: vec![0; count],
            renewed: vec![false; count],
            flat: vec![0; if scheme.rescue.is_some() { count } else { 0 }],
            under_way: vec![0; count],
            u: state.u.clone(),
            internal: state.internal.clone(),
        };
        Some(Box::new(Self {
            worst: vec![Worst::NONE; count],
            stage: scheme.corrects_stages().then(|| state.clone()),
            loss: [0.0; 2],
            treated: vec![F8::ZERO; 2 * count],
            blocks,
            rescue: scheme.rescue.map(|_| rescue::Memory::new(state, count)),
        }))
    }

    /// Notes which cells were corrected in the step.
    fn note(&mut self) {
        for (lanes, treated) in self.blocks.corrected.iter().zip(self.treated.as_chunks_mut::<2>().0) {
            for (lane, corrected) in treated[0].0.iter_mut().enumerate() {
                *corrected = f64::from(lanes >> lane & 1);
            }
        }
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let Blocks { notes, changed, renewed, flat, u, internal, .. } = &self.blocks;
        let treated = self.treated.len();
        let stage = self.stage.as_ref().map_or(0, |stage| stage.u.len() + stage.internal.len());
        let noted: usize = notes.iter().map(|notes| notes.numbers.len()).sum();
        let bits = notes.len() * changed.len() + 3 * changed.len() + renewed.len() + flat.len();
        let rescue = self.rescue.as_ref().map_or(0, rescue::Memory::bytes);
        (u.len() + internal.len() + stage + noted + treated) * size_of::<F8>()
            + size_of_val(&self.worst[..])
            + bits
            + rescue
    }
}

impl Scheme {
    /// Whether a correction or the rescue acts on the stages of Runge-Kutta.
    pub(in crate::step) fn corrects_stages(&self) -> bool {
        let any = self.corrections.iter().any(|correction| correction.after_stages());
        self.stages() > 1 && (any || self.rescue.is_some())
    }

    /// Lets the rescue and all corrections act on what a step of `dt` has made of `before`, and surveys the changed blocks anew.
    #[inline(never)]
    pub(in crate::step) fn correct(&self, before: &State, dt: f64, work: &mut Work) {
        let Work { next, corrections, .. } = &mut *work;
        let Some(memory) = corrections.as_deref_mut() else { return };
        let blocks = &mut memory.blocks;
        blocks.changed.fill(0);
        blocks.corrected.fill(0);
        blocks.renewed.fill(false);
        blocks.flatten(self, next);
        for (number, correction) in self.corrections.iter().enumerate() {
            self.correct_by((number, &**correction), (before, next), (dt, None), blocks);
        }
        memory.note();
        self.look_anew(before, dt, work);
    }

    /// Lets those corrections that act on stages act on the state that a stage begins with.
    #[inline(never)]
    pub(in crate::step) fn correct_stage(
        &self,
        (before, start): (&State, &mut State),
        (dt, stage): (f64, usize),
        blocks: &mut Blocks,
    ) {
        blocks.flatten(self, start);
        for (number, correction) in self.corrections.iter().enumerate().filter(|(_, one)| one.after_stages()) {
            self.correct_by((number, &**correction), (before, start), (dt, Some(stage)), blocks);
        }
    }

    /// Lets one correction act: all changed blocks are made beside the state, and then copied into it.
    fn correct_by(
        &self,
        (number, correction): (usize, &dyn Correction),
        (before, next): (&State, &mut State),
        (dt, stage): (f64, Option<usize>),
        blocks: &mut Blocks,
    ) {
        let Blocks { notes, changed, corrected, renewed, under_way, u, internal, .. } = blocks;
        let nothing = Notes::default();
        let made = Made { scheme: self, before, state: next, notes: &nothing, dt, stage };
        correction.look(&made, &mut notes[number]);
        let made = Made { notes: &notes[number], ..made };
        Part { first: 0, under_way, u, internal }.correct(correction, made);
        let stride = next.components * self.operators.nodes();
        for block in (0..under_way.len()).filter(|block| under_way[*block] != 0) {
            changed[block] |= under_way[block];
            corrected[block] |= under_way[block];
            renewed[block] |= correction.renews_internal();
            let (numbers, history) = (stride * block..stride * (block + 1), self.histories.range(block));
            next.u[numbers.clone()].copy_from_slice(&u[numbers]);
            next.internal[history.clone()].copy_from_slice(&internal[history]);
        }
    }
}

impl Work {
    /// Of each cell, whether a correction changed it in the last step (1 or 0), and in how many steps it was rescued: `[block][2]`.
    /// Empty where there is neither.
    pub fn treated(&self) -> &[F8] {
        self.corrections.as_ref().map_or(&[], |memory| &memory.treated)
    }

    /// Goes on from such numbers of a run that was saved; of the same number of blocks.
    pub(crate) fn set_treated(&mut self, treated: Vec<F8>) {
        if let Some(memory) = &mut self.corrections {
            memory.treated = treated;
        }
    }
}

/// How many cells corrections and the rescue have looked at and changed in a step.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Counts {
    /// Cells that a correction marked.
    pub marked: usize,
    /// Cells that a correction changed.
    pub corrected: usize,
    /// Cells that were stepped again at order 0.
    pub rescued: usize,
}

impl Work {
    /// The counts of the last step.
    pub fn counts(&self) -> Counts {
        let Some(memory) = &self.corrections else { return Counts::default() };
        let Blocks { notes, corrected, flat, .. } = &memory.blocks;
        let sum = |lanes: &[u8]| lanes.iter().map(|lanes| lanes.count_ones() as usize).sum();
        Counts {
            marked: notes.iter().map(|notes| sum(&notes.marked)).sum(),
            corrected: sum(corrected),
            rescued: sum(flat),
        }
    }
}

impl Blocks {
    /// Makes the cells that are stepped at order 0 constant.
    fn flatten(&mut self, scheme: &Scheme, state: &mut State) {
        let stride = state.components * scheme.operators.nodes();
        for (block, &lanes) in self.flat.iter().enumerate().filter(|(_, lanes)| **lanes != 0) {
            flatten(scheme, block, lanes, &mut state.u[stride * block..stride * (block + 1)]);
            self.changed[block] |= lanes;
            self.renewed[block] = true;
        }
    }
}

/// The memory of some blocks that follow each other.
struct Part<'a> {
    first: usize,
    under_way: &'a mut [u8],
    u: &'a mut [F8],
    internal: &'a mut [F8],
}

/// So many blocks are corrected by one thread at least.
const PART: usize = 16;

impl Part<'_> {
    /// Corrects the blocks to which a correction applies: halves until few are left, since nothing may be allocated.
    fn correct(self, correction: &dyn Correction, made: Made) {
        let Self { first, under_way, u, internal } = self;
        let start = made.scheme.histories.range(first).start;
        if under_way.len() > PART {
            let half = under_way.len() / 2;
            let (under_way, under_way2) = under_way.split_at_mut(half);
            let (u, u2) = u.split_at_mut(half * made.state.components * made.scheme.operators.nodes());
            let (internal, internal2) = internal.split_at_mut(made.scheme.histories.range(first + half).start - start);
            let left = Part { first, under_way, u, internal };
            let right = Part { first: first + half, under_way: under_way2, u: u2, internal: internal2 };
            rayon::join(|| left.correct(correction, made), || right.correct(correction, made));
            return;
        }
        let stride = made.state.components * made.scheme.operators.nodes();
        for (at, (lanes, u)) in under_way.iter_mut().zip(u.chunks_exact_mut(stride)).enumerate() {
            let number = first + at;
            *lanes = 0;
            if correction.applies(&made, number) {
                let history = made.scheme.histories.range(number);
                let internal = &mut internal[history.start - start..history.end - start];
                u.copy_from_slice(made.unknowns(number));
                internal.copy_from_slice(made.internal(number));
                let mut block = Corrected { number, u, internal, changed: u8::MAX };
                correction.correct(&made, &mut block);
                *lanes = block.changed;
            }
        }
    }
}
