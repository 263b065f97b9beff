//! Schedules of the predictor's Picard sweeps: which time nodes each maps to which, and with what weights.

use crate::basis::{Lagrange, TimeBasis};

/// One sweep: u_s = U^n + dt ( sum_k `W[s][k]` r_k + rho0 sum_k `B[s][k]` b_k ) at its time nodes s, from the rates r_k at
/// the nodes of the sweep before and the accelerations b_k at the N_T + 1 time nodes of the scheme.
#[derive(Debug, Clone, PartialEq)]
pub struct Sweep {
    /// Time nodes that it maps to.
    pub to: usize,
    /// tau of each of them.
    pub tau: Vec<f64>,
    /// Time nodes of the sweep before; 0 for the constant guess u = U^n.
    pub from: usize,
    /// W, `[to][from]`.
    pub rates: Vec<f64>,
    /// B, `[to][N_T + 1]`.
    pub sources: Vec<f64>,
    /// As W, to the N_T + 1 time nodes of the scheme, `[N_T + 1][from]`: for sources that depend on the velocity.
    pub at_times: Vec<f64>,
}

/// All sweeps of a step. The first is the guess u = U^n at a single node, since all nodes are equal there: one
/// evaluation of the law. The last gives the states at the N_T + 1 time nodes, which are averaged.
#[derive(Debug, Clone, PartialEq)]
pub struct Sweeps {
    /// The sweeps whose rates the next one needs.
    pub inner: Vec<Sweep>,
    /// The last, of which the time averages are taken.
    pub last: Sweep,
    /// sum_s w_s `W[s][k]` of the last: the time average of u itself.
    pub mean_rates: Vec<f64>,
    /// sum_s w_s `B[s][k]` of the last.
    pub mean_sources: Vec<f64>,
}

impl Sweeps {
    /// The paper's: `count` sweeps u <- U^n + dt At r(u) (20) on all time nodes; the default is max(N, N_T) + 1.
    /// 1 + count (N_T + 1) evaluations of the law at a point.
    pub fn paper(time: &TimeBasis, count: usize) -> Self {
        let len = time.len();
        if len == 1 {
            // N_T = 0 is explicit Euler: no predictor.
            return Self::new(time, vec![guess(len)]);
        }
        let (at, tau) = (time.integration.clone(), time.tau.clone());
        let mut sweeps = vec![
            guess(len),
            Sweep {
                to: len,
                tau: tau.clone(),
                from: 1,
                rates: tau.clone(),
                sources: at.clone(),
                at_times: tau.clone(),
            },
        ];
        sweeps.resize(
            count.max(1) + 1,
            Sweep { to: len, tau, from: len, rates: at.clone(), sources: at.clone(), at_times: at },
        );
        Self::new(time, sweeps)
    }

    /// The ladder (design section 3, not in the paper), for N_T = N: sweep j of N maps j Gauss nodes to j + 1 by
    /// `W[s][k]` = int_0^tau_s l_k of the j-node rule. (N + 1)(N + 2)/2 evaluations of the law at a point. For a linear law
    /// it gives what the paper's sweeps give when they are stopped after N.
    pub fn ladder(time: &TimeBasis) -> Self {
        let len = time.len();
        let rungs = (1..len).map(|j| {
            let to = Lagrange::new(j).nodes;
            let rates = integrals(j, &to);
            let at_times = integrals(j, &time.tau);
            Sweep { to: j + 1, from: j, rates, sources: integrals(len, &to), at_times, tau: to }
        });
        Self::new(time, std::iter::once(guess(len)).chain(rungs).collect())
    }

    /// What a scene has where it does not say: the ladder where N_T = N, else the paper's.
    pub fn of_degree(degree: usize, time: &TimeBasis) -> Self {
        let n_t = time.len() - 1;
        if n_t == degree { Self::ladder(time) } else { Self::paper(time, degree.max(n_t) + 1) }
    }

    /// `all` has at least one sweep; the last ends on the time nodes of `time`.
    fn new(time: &TimeBasis, mut all: Vec<Sweep>) -> Self {
        let last = all.pop().unwrap_or_else(|| guess(time.len()));
        let mean = |matrix: &[f64], columns: usize| -> Vec<f64> {
            let entry = |k: usize| (0..last.to).map(|s| time.weights[s] * matrix[s * columns + k]).sum();
            (0..columns).map(entry).collect()
        };
        let (mean_rates, mean_sources) = (mean(&last.rates, last.from), mean(&last.sources, time.len()));
        Self { inner: all, last, mean_rates, mean_sources }
    }

    /// Evaluations of the law at a point and step.
    pub fn evaluations(&self) -> usize {
        self.inner.iter().map(|sweep| sweep.to).sum::<usize>() + self.last.to
    }

    /// The most time nodes whose rates are held at once.
    pub fn widest(&self) -> usize {
        self.inner.iter().map(|sweep| sweep.to).max().unwrap_or(0)
    }
}

/// u = U^n at one node, without sources.
fn guess(times: usize) -> Sweep {
    Sweep { to: 1, tau: vec![0.0], from: 0, rates: vec![], sources: vec![0.0; times], at_times: vec![] }
}

/// int_0^tau l_k for each tau (rows) and each Lagrange polynomial of the `count`-node Gauss rule (columns).
fn integrals(count: usize, ends: &[f64]) -> Vec<f64> {
    let basis = Lagrange::new(count - 1);
    // The rule itself, scaled to [0, tau], is exact for its own Lagrange polynomials.
    let integral = |tau: f64, k: usize| -> f64 {
        basis.nodes.iter().zip(&basis.weights).map(|(x, w)| tau * w * basis.values(tau * x)[k]).sum()
    };
    ends.iter().flat_map(|&tau| (0..count).map(|k| integral(tau, k)).collect::<Vec<_>>()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The last states of u' = z u, u(0) = 1, as functions of z: coefficients of powers of z, `[node][power]`.
    fn linear(sweeps: &Sweeps, powers: usize) -> Vec<Vec<f64>> {
        let mut before: Vec<Vec<f64>> = vec![];
        for sweep in sweeps.inner.iter().chain([&sweeps.last]) {
            let at = |s: usize, power: usize| match power {
                0 => 1.0,
                // r = z u raises the power by one.
                _ => before.iter().enumerate().map(|(k, u)| sweep.rates[s * sweep.from + k] * u[power - 1]).sum(),
            };
            before = (0..sweep.to).map(|s| (0..powers).map(|power| at(s, power)).collect()).collect();
        }
        before
    }

    #[test]
    fn for_a_linear_law_the_ladder_is_the_papers_predictor_stopped_after_n_sweeps() {
        for degree in 0..=6 {
            let time = TimeBasis::new(degree);
            let (ladder, paper) = (Sweeps::ladder(&time), Sweeps::paper(&time, degree));
            let (a, b) = (linear(&ladder, 8), linear(&paper, 8));
            assert_eq!(a.len(), degree + 1);
            for (a, b) in a.iter().flatten().zip(b.iter().flatten()) {
                // At comes from a solve of condition up to 1e3 at degree 6, where .4e-14 was measured; numbers up to 1.
                // The design's figure, 2e-15, holds up to degree 4.
                assert!((a - b).abs() < if degree <= 4 { 2e-15 } else { 2e-14 }, "{degree}: {a} {b}");
            }
        }
    }

    #[test]
    fn the_ladder_has_the_taylor_series_of_the_exponential_up_to_power_n() {
        for degree in 0..=6 {
            let time = TimeBasis::new(degree);
            for (u, tau) in linear(&Sweeps::ladder(&time), degree + 1).iter().zip(&time.tau) {
                let mut term = 1.0;
                for (power, u) in u.iter().enumerate() {
                    // Sums of at most 7 numbers below 1.
                    assert!((u - term).abs() < 2e-15, "{degree} {power}: {u} {term}");
                    term *= tau / (power + 1) as f64;
                }
            }
        }
    }

    #[test]
    fn evaluations_are_those_of_the_design() {
        for degree in 1..=6 {
            let time = TimeBasis::new(degree);
            let (m, paper) = (degree + 1, Sweeps::paper(&time, degree + 1));
            assert_eq!(Sweeps::ladder(&time).evaluations(), m * (m + 1) / 2);
            assert_eq!(paper.evaluations(), 1 + m * m);
            assert_eq!((paper.widest(), Sweeps::ladder(&time).widest()), (m, degree));
        }
    }

    #[test]
    fn a_constant_source_is_integrated_exactly_at_the_nodes_of_every_sweep() {
        for degree in 1..=6 {
            let time = TimeBasis::new(degree);
            for sweeps in [Sweeps::ladder(&time), Sweeps::paper(&time, degree + 1)] {
                for sweep in sweeps.inner[1..].iter().chain([&sweeps.last]) {
                    let nodes = Lagrange::new(sweep.to - 1).nodes;
                    for (row, tau) in sweep.sources.chunks(time.len()).zip(nodes) {
                        // Rows of At sum to tau to 1e-13 (`TimeBasis`), those of the ladder to rounding.
                        assert!((row.iter().sum::<f64>() - tau).abs() < 1e-13);
                    }
                }
                // The average of b t is b/2.
                assert!((sweeps.mean_sources.iter().sum::<f64>() - 0.5).abs() < 1e-13);
            }
        }
    }
}
