//! The control of the curl by rotation: the rotation of F - Pi F is turned away at each node, the deviator relaxed.

use super::Law;
use super::block_work::LawWork;
use super::curl::project;
use super::curl_core::Arrays;
use super::volume::Masses;
use crate::lane::{F8, Kernel, Lanes, Work, load_array, store_array};
use crate::material::{Material, Past, virgin};
use crate::operators::CurlFree;
use crate::tensor::{DEFORMATION, contract};

/// Takes the shares `theta` (of the rotation, of the deviator) of R = F - Pi F from F. At each node
///
/// ```text
/// F <- exp(-theta_r r E) F,    r = q (e : R),   e = E F,   q = 1/|F|^2,   E = [[0, -1], [1, 0]]     (by Cayley's formula)
/// F <- F + theta_d (D - mean D),    D = -(R - r e - q (g : R) g),   g = cof F,   mean D = sum_b w_b J_b D_b / sum_b w_b J_b
/// ```
///
/// and the trace part q (g : R) g stays. The first is a rotation, which no objective law sees: neither strain nor energy change at
/// any node, whatever theta. The second is left out in a cell of an elastic law where it would make energy,
/// sum_a w_a J_a P_a : (D_a - mean D) > 0. `gradients` is memory.
pub struct Rotation<'a> {
    /// Mass matrices are found in its memory.
    pub curl_free: &'a CurlFree,
    /// The block.
    pub block: usize,
    /// Its law, objective.
    pub law: &'a Law,
    /// The instruction set.
    pub kernel: Kernel,
    /// 4 numbers a node.
    pub gradients: &'a mut [F8],
}

impl Rotation<'_> {
    /// Changes F in `u`; the deviator is left alone where `theta[1]` is 0 in all lanes.
    #[inline(always)]
    pub fn run<L: Lanes, const M: usize>(self, theta: [L; 2], masses: Masses<'_, M>, arrays: Arrays, u: &mut [F8]) {
        let n = M * M;
        let Self { curl_free, block, law, kernel, gradients } = self;
        let gradients = &mut gradients[..DEFORMATION * n];
        gradients.copy_from_slice(&u[..DEFORMATION * n]);
        let Masses { line, metric, masses } = masses;
        let find = Masses { line, metric, masses: &mut *masses };
        project::<L, M>(curl_free, block, L::splat(1.0), find, arrays, gradients);
        turn::<L>(theta[0], gradients, u, n);
        let mut rates = F8::ZERO;
        theta[1].store(&mut rates);
        if rates.0.iter().all(|rate| *rate == 0.0) {
            return;
        }
        let mass = Masses::<'_, M> { line, metric, masses }.run::<L>();
        let (mut total, mut sum) = (L::zero(), [L::zero(); DEFORMATION]);
        for (a, mass) in mass.iter().enumerate() {
            let (m, d) = (L::load(mass), super::dense::gather::<L, DEFORMATION>(gradients, n, a));
            total = total + m;
            for k in 0..DEFORMATION {
                sum[k] = m.mul_add(d[k], sum[k]);
            }
        }
        let inverse = L::splat(-1.0) / total;
        let mean = [sum[0] * inverse, sum[1] * inverse, sum[2] * inverse, sum[3] * inverse];
        let mut theta = theta[1];
        if !law.has_memory() {
            let mut numbers = [F8::ZERO; DEFORMATION];
            store_array(mean, &mut numbers);
            let work = Power { f: &u[..DEFORMATION * n], change: gradients, masses: mass, mean: &numbers };
            let work = L::load(&law.block().power(kernel, work));
            // 1 where energy falls, 0 where it rises or nothing is done.
            theta = theta * (-work / (work.max(-work) + L::splat(f64::MIN_POSITIVE))).max(L::zero());
        }
        for (k, (d, f)) in gradients.chunks_exact(n).zip(u.chunks_exact_mut(n)).enumerate().take(DEFORMATION) {
            for (d, f) in d.iter().zip(f) {
                theta.mul_add(L::load(d) + mean[k], L::load(f)).store(f);
            }
        }
    }
}

/// Turns F at the nodes; in `gradients` Pi F in, D out.
#[inline(always)]
fn turn<L: Lanes>(theta: L, gradients: &mut [F8], u: &mut [F8], n: usize) {
    for a in 0..n {
        let (f, pi) =
            (super::dense::gather::<L, DEFORMATION>(u, n, a), super::dense::gather::<L, DEFORMATION>(gradients, n, a));
        let r = [f[0] - pi[0], f[1] - pi[1], f[2] - pi[2], f[3] - pi[3]];
        let (e, g) = ([-f[2], -f[3], f[0], f[1]], [f[3], -f[2], -f[1], f[0]]);
        let q = L::splat(1.0) / contract(f, f);
        let (turn, trace) = (q * contract(e, r), q * contract(g, r));
        // The tangent of half of the angle.
        let half = L::splat(-0.5) * theta * turn;
        let share = L::splat(2.0) / half.mul_add(half, L::splat(1.0));
        let (sine, versine) = (half * share, -(half * half * share));
        for k in 0..DEFORMATION {
            turn.mul_add(e[k], trace.mul_add(g[k], -r[k])).store(&mut gradients[k * n + a]);
            sine.mul_add(e[k], versine.mul_add(f[k], f[k])).store(&mut u[k * n + a]);
        }
    }
}

/// sum_a m_a P_a : (D_a - mean D) with P of virgin material, a lane a cell.
pub struct Power<'a> {
    /// F, [component][node].
    f: &'a [F8],
    /// D, likewise.
    change: &'a [F8],
    /// m.
    masses: &'a [F8],
    /// -mean D.
    mean: &'a [F8; DEFORMATION],
}

impl LawWork for Power<'_> {
    type Out = F8;
    #[inline(always)]
    fn run<L: Lanes, M: Material>(self, law: M) -> F8 {
        let Self { f, change, masses, mean } = self;
        let (n, mut sum, mut out) = (masses.len(), L::zero(), F8::ZERO);
        let mean = load_array::<L, DEFORMATION>(mean);
        for (a, mass) in masses.iter().enumerate() {
            let f = super::dense::gather::<L, DEFORMATION>(f, n, a);
            let p = law.stress(f, &mut Past::now(virgin::<L, M>()));
            let mut power = L::zero();
            for k in 0..DEFORMATION {
                power = p[k].mul_add(L::load(&change[k * n + a]) + mean[k], power);
            }
            sum = L::load(mass).mul_add(power, sum);
        }
        sum.store(&mut out);
        out
    }
}
