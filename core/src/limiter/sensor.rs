//! Which cells are limited.

use super::cells;
use super::neighbour::behind;
use crate::lane::{F8, LANES, Lanes, Work, load_array};
use crate::mesh::FACES;
use crate::operators::{Neighbour, Operators, Side, with_nodes};
use crate::state::UNKNOWNS;
use crate::step::{Made, Notes};
use crate::sum::exact_sum;
use crate::tensor;
use rayon::prelude::*;

/// Marks cells by the jumps at their faces. With w = (J, p/(rho0 c_p)), j the largest root mean square of the jump of w over a face of the
/// cell, A the largest deviation of a cell mean of w from the mean of the body, a cell and those across its faces are marked where
///
/// ```text
/// j > .6 threshold (h/L)^((N+2)/4) A
/// ```
///
/// h the length of the cell, L the largest extent of the body: jumps of a smooth solution fall with h^(N+1), those at a shock stay. With
/// the exponent (N+1)/2, limited cells of high degree mark their neighbours in turn, until most of the body is marked (S3: 80 %).
/// At a mirror ([`crate::boundary::Boundary::mirror`]) the jump of v to its image counts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sensor {
    /// The factor; 1 by default, and with 0 all cells are marked.
    pub threshold: f64,
}

impl Default for Sensor {
    fn default() -> Self {
        Self { threshold: 1.0 }
    }
}

/// The factor of the limit. On the impact of the paper at 200 m/s larger ones leave overshoots at S1 (.09 % with it, 9 % at .13).
const FACTOR: f64 = 0.6;

/// A jump of a strain, or of a velocity over c_p, below this is rounding.
const ROUNDING: f64 = 1e-11;

/// Where the numbers of a block begin: its areas, what is found of it, its means, its traces `[face][point][component]`.
const AREA: usize = 0;
const FOUND: usize = 1;
const MEANS: usize = 2;
const TRACES: usize = MEANS + WATCHED;

/// Components of w: J, v1/c_p, v2/c_p. Of F its determinant alone: rotations and strains that do no work may jump for long where
/// nothing is steep (with all of F, 63 % of the cells of the paper's impact are marked at S2 with the flux `dual`, with J 54 %).
const WATCHED: usize = 3;

impl Sensor {
    /// Numbers of a block.
    pub fn numbers(operators: &Operators) -> usize {
        TRACES + FACES * WATCHED * operators.line.m
    }

    /// Marks the cells of a state.
    pub fn mark(&self, made: &Made, notes: &mut Notes) {
        let operators = &made.scheme.operators;
        if self.threshold == 0.0 {
            let all = notes.marked.iter_mut().enumerate();
            return all.for_each(|(block, marked)| *marked = cells(operators, block));
        }
        let stride = Self::numbers(operators);
        notes.numbers.par_chunks_mut(stride).enumerate().for_each(|(block, out)| {
            with_nodes!(operators.line.m, M => made.scheme.kernel.run(Traces::<'_, M> { made, block, out }));
        });
        let (deviation, length) = (deviation(operators, &notes.numbers, stride), extent(operators));
        let power = 0.25 * (operators.line.m + 1) as f64;
        let factor = self.threshold * FACTOR * deviation / length.powf(power);
        let Notes { marked, numbers } = notes;
        let all = &*numbers;
        marked.par_iter_mut().enumerate().for_each(|(block, marked)| {
            let h = &operators.geometry.blocks[block].h;
            let most = F8(h.0.map(|h| (factor * h.powf(power)).max(ROUNDING).powi(2)));
            let jumps = Jumps { made, all, stride, block, most };
            *marked = with_nodes!(operators.line.m, M => made.scheme.kernel.run(OfDegree::<'_, M>(jumps)));
        });
        spread(operators, marked, numbers, stride);
    }
}

/// Marks the cells across the faces of marked cells, too.
fn spread(operators: &Operators, marked: &mut [u8], numbers: &mut [F8], stride: usize) {
    for (block, marked) in marked.iter().enumerate() {
        numbers[block * stride + FOUND] = F8(std::array::from_fn(|lane| f64::from(marked >> lane & 1)));
    }
    for block in 0..marked.len() {
        let found = numbers[block * stride + FOUND];
        for lane in (0..LANES).filter(|lane| found.0[*lane] > 0.0) {
            for face in 0..FACES {
                if let Some(there) = behind(&operators.blocks, block, lane, face) {
                    marked[there.block] |= 1 << there.lane;
                }
            }
        }
    }
}

/// A: the largest deviation of a cell mean from the mean of the body, whose sums over the blocks are exact.
fn deviation(operators: &Operators, numbers: &[F8], stride: usize) -> f64 {
    let sum = |of: &dyn Fn(&[F8], usize) -> f64| {
        let blocks = numbers.chunks_exact(stride).zip(&operators.blocks.count);
        exact_sum(blocks.map(|(numbers, &count)| (0..count).map(|lane| of(numbers, lane)).sum()))
    };
    let area = sum(&|numbers, lane| numbers[AREA].0[lane]);
    let mean: [f64; WATCHED] =
        std::array::from_fn(|k| sum(&|numbers, lane| numbers[AREA].0[lane] * numbers[MEANS + k].0[lane]) / area);
    let mut most = [0.0f64; LANES];
    for (numbers, &count) in numbers.chunks_exact(stride).zip(&operators.blocks.count) {
        for (lane, most) in most.iter_mut().enumerate().take(count) {
            let square: f64 = mean.iter().zip(&numbers[MEANS..]).map(|(mean, own)| (own.0[lane] - mean).powi(2)).sum();
            *most = most.max(square);
        }
    }
    most.iter().fold(0.0f64, |a, b| a.max(*b)).sqrt()
}

/// L: the largest extent of the body, m.
fn extent(operators: &Operators) -> f64 {
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for corner in operators.geometry.corners.as_chunks::<2>().0 {
        for (axis, x) in corner.iter().enumerate() {
            for x in x.0 {
                (low[axis], high[axis]) = (low[axis].min(x), high[axis].max(x));
            }
        }
    }
    (high[0] - low[0]).max(high[1] - low[1])
}

/// Looks for cells of a block with a jump beyond a limit.
struct Jumps<'a> {
    made: &'a Made<'a>,
    /// The numbers of all blocks.
    all: &'a [F8],
    stride: usize,
    block: usize,
    /// The square of the limit.
    most: F8,
}

struct OfDegree<'a, const M: usize>(Jumps<'a>);

impl<const M: usize> Work for OfDegree<'_, M> {
    type Out = u8;
    #[inline(always)]
    fn run<L: Lanes>(self) -> u8 {
        let Jumps { made, all, stride, block, most } = self.0;
        let operators = &made.scheme.operators;
        let face_of = |face: usize| &all[face / FACES * stride + TRACES + face % FACES * WATCHED * M..][..WATCHED * M];
        let mut lanes = 0;
        for face in 0..FACES {
            let plan = operators.blocks.plan[block][face];
            let own = face_of(FACES * block + face);
            let mut sum = L::zero();
            for (point, weight) in operators.line.basis.weights.iter().enumerate() {
                let (mine, other) =
                    (&own[point * WATCHED..][..WATCHED], beyond::<L>(operators, plan.side, point, M, &face_of));
                for (mine, other) in mine.iter().zip(other) {
                    let jump = L::load(mine) - other;
                    sum = (L::splat(*weight) * jump).mul_add(jump, sum);
                }
            }
            let mut squares = F8::ZERO;
            sum.store(&mut squares);
            if plan.has_boundary_or_interface {
                outside(made, (block, face), own, &mut squares);
            }
            for lane in 0..operators.blocks.count[block] {
                // A jump that is no number is beyond, too.
                lanes |= u8::from(squares.0[lane].is_nan() || squares.0[lane] > most.0[lane]) << lane;
            }
        }
        lanes
    }
}

/// w at a point on the other side of a face.
#[inline(always)]
fn beyond<'a, L: Lanes>(
    operators: &Operators,
    side: Side,
    point: usize,
    points: usize,
    face_of: &impl Fn(usize) -> &'a [F8],
) -> [L; WATCHED] {
    let mut out = [L::zero(); WATCHED];
    match side {
        Side::Aligned(face) => out = load_array(&face_of(face)[point * WATCHED..][..WATCHED]),
        Side::Joined { first, second, by } => {
            let (first, second) = (face_of(first), face_of(second));
            for (k, out) in out.iter_mut().enumerate() {
                let [a, b] = [first, second].map(|face| &face[point * WATCHED + k].0);
                let at = |lane: usize| if lane + by < LANES { a[lane + by] } else { b[lane + by - LANES] };
                *out = L::from_lanes(std::array::from_fn(at));
            }
        }
        Side::Gathered(number) => {
            let from = &operators.blocks.gathered[number];
            for source in from.sources() {
                let point = if source.flip { points - 1 - point } else { point };
                let there = &face_of(source.face as usize)[point * WATCHED..][..WATCHED];
                for (out, there) in out.iter_mut().zip(there) {
                    *out = out.pick(there, &from.lane, source.lanes);
                }
            }
        }
    }
    out
}

/// The squares of lanes whose face has no cell of the same law behind it: 0, and at a mirror the jump of v.N to the image.
#[cold]
fn outside(made: &Made, (block, face): (usize, usize), own: &[F8], squares: &mut F8) {
    let operators = &made.scheme.operators;
    let geometry = &operators.geometry;
    for (lane, square) in squares.0.iter_mut().enumerate().take(operators.blocks.count[block]) {
        let neighbour = operators.blocks.neighbours[block][face][lane];
        if let Neighbour::Cell(_) = neighbour {
            continue;
        }
        *square = 0.0;
        let Neighbour::Boundary(group) = neighbour else { continue };
        let middle = [[0.0, 0.5], [1.0, 0.5], [0.5, 0.0], [0.5, 1.0]][face];
        let x = crate::mesh::map::position(&geometry.map_of(block, lane), middle);
        let Some(speed) = made.scheme.boundaries[group].mirror(x, made.state.time) else { continue };
        let wall = speed / speed_of(made, block);
        for (point, weight) in operators.line.basis.weights.iter().enumerate() {
            let (n, _) = geometry.of(block).at_face_of(lane, face, point);
            let v = [1, 2].map(|k| own[point * WATCHED + k].0[lane]);
            *square += weight * (2.0 * (v[0] * n[0] + v[1] * n[1] - wall)).powi(2);
        }
    }
}

/// c_p of the law of a block at F = 1, m/s.
fn speed_of(made: &Made, block: usize) -> f64 {
    let law = &made.scheme.laws[made.scheme.operators.blocks.material[block]];
    law.pressure_speed([1.0, 0.0, 0.0, 1.0], [1.0, 0.0])
}

/// Areas, means and traces of w of a block.
struct Traces<'a, const M: usize> {
    made: &'a Made<'a>,
    block: usize,
    out: &'a mut [F8],
}

impl<const M: usize> Work for Traces<'_, M> {
    type Out = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Self { made, block, out } = self;
        let (operators, u) = (&made.scheme.operators, &made.unknowns(block)[..UNKNOWNS * M * M]);
        let (line, metric) = (&operators.line, operators.geometry.of(block));
        let law = &made.scheme.laws[operators.blocks.material[block]];
        let scale = L::splat(1.0 / (law.density() * speed_of(made, block)));
        let (head, traces) = out.split_at_mut(TRACES);
        let (mut area, mut sums) = (L::zero(), [L::zero(); WATCHED]);
        for a in 0..M * M {
            let (i, j) = (a / M, a % M);
            let [one, two] = metric.at_node::<L>(line, i, j);
            let weight = L::splat(line.basis.weights[i] * line.basis.weights[j]);
            let mass = weight * crate::operators::determinant(one, two);
            area = area + mass;
            let mut at = [L::zero(); UNKNOWNS];
            for (k, at) in at.iter_mut().enumerate() {
                *at = L::load(&u[k * M * M + a]);
            }
            for (sum, w) in sums.iter_mut().zip(watched(scale, at)) {
                *sum = mass.mul_add(w, *sum);
            }
        }
        for (sum, mean) in sums.into_iter().zip(&mut head[MEANS..]) {
            (sum / area).store(mean);
        }
        area.store(&mut head[AREA]);
        for face in 0..FACES {
            let ends = &line.ends[face % 2][..M];
            for point in 0..M {
                let (first, step) = if face < 2 { (point, M) } else { (point * M, 1) };
                let mut at = [L::zero(); UNKNOWNS];
                for (k, at) in at.iter_mut().enumerate() {
                    for (i, l) in ends.iter().enumerate() {
                        *at = L::splat(*l).mul_add(L::load(&u[k * M * M + first + step * i]), *at);
                    }
                }
                for (k, w) in watched(scale, at).into_iter().enumerate() {
                    w.store(&mut traces[(face * M + point) * WATCHED + k]);
                }
            }
        }
    }
}

/// w from the components of U.
#[inline(always)]
fn watched<L: Lanes>(scale: L, u: [L; UNKNOWNS]) -> [L; WATCHED] {
    [tensor::det([u[0], u[1], u[2], u[3]]), u[4] * scale, u[5] * scale]
}

const _: () = assert!(LANES == u8::BITS as usize);
