//! Explicit Runge-Kutta tableaux: the time integration of RK-DGFEM.

/// At most so many stages: they stand on the stack.
pub(super) const MOST_STAGES: usize = 12;

/// k_i = f(t + c_i dt, U + dt sum_j a_ij k_j), U^(n+1) = U^n + dt sum_i b_i k_i.
#[derive(Debug, Clone, PartialEq)]
pub struct Tableau {
    /// Name, as printed.
    pub name: &'static str,
    /// Lower triangle, row by row.
    pub a: Vec<Vec<f64>>,
    /// Weights.
    pub b: Vec<f64>,
    /// Nodes c_i = sum_j a_ij.
    pub c: Vec<f64>,
    /// 2D limits of dt c / h with the Rusanov flux and relaxed LCF for N = 0..6; 0: unstable at every step.
    pub limits: [f64; 7],
}

/// Limits: RK2 at N = 1, RK4 at N = 2, 3, RK5 at N = 4 from the spectrum of the step without control (`dgmpm stability --limit`;
/// with the flux `dual` .1166 and .0708 at N = 2, 3, with lcf .1170 and .0716); the others measured by
/// `examples/limits.rs` on 4 x 4 cells between walls, times .92, the smallest ratio of the two where both are known.
const EULER: [f64; 7] = [0.5, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
const RK2: [f64; 7] = [0.5, 0.1667, 0.0825, 0.0498, 0.0331, 0.0241, 0.0185];
const RK4: [f64; 7] = [0.67, 0.2365, 0.1160, 0.0696, 0.0464, 0.0339, 0.0259];
const RK5: [f64; 7] = [0.72, 0.285, 0.1397, 0.0834, 0.0551, 0.0404, 0.0302];
const RK6: [f64; 7] = [0.68, 0.25, 0.1243, 0.0734, 0.0482, 0.0351, 0.0259];
const DOP853: [f64; 7] = [0.72, 0.524, 0.272, 0.1607, 0.108, 0.0778, 0.0588];

impl Tableau {
    /// The tableau of a time degree: 0 Euler, 1 Heun's RK2, 2 and 3 the classical RK4, 4 Dormand and Prince's RK5,
    /// 5 Butcher's RK6, 6 DOP853.
    pub fn of_degree(time_degree: usize) -> Self {
        match time_degree {
            0 => Self::new("Euler", &[&[]], &[1.0], EULER),
            1 => Self::new("RK2 (Heun)", &[&[], &[1.0]], &[0.5, 0.5], RK2),
            2 | 3 => Self::new(
                "RK4",
                &[&[], &[0.5], &[0.0, 0.5], &[0.0, 0.0, 1.0]],
                &[1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0],
                RK4,
            ),
            4 => dormand_prince_5(),
            5 => butcher_6(),
            _ => Self::new("DOP853", &DOP853_A, &DOP853_B, DOP853),
        }
    }

    fn new(name: &'static str, a: &[&[f64]], b: &[f64], limits: [f64; 7]) -> Self {
        let c = a.iter().map(|row| row.iter().sum()).collect();
        Self { name, a: a.iter().map(|row| row.to_vec()).collect(), b: b.to_vec(), c, limits }
    }

    /// Number of stages.
    pub fn stages(&self) -> usize {
        self.b.len()
    }
}

/// Dormand and Prince, J. Comput. Appl. Math. 6 (1980) 19-26: the six stages of the fifth-order solution.
fn dormand_prince_5() -> Tableau {
    Tableau::new(
        "RK5 (Dormand-Prince)",
        &[
            &[],
            &[1.0 / 5.0],
            &[3.0 / 40.0, 9.0 / 40.0],
            &[44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0],
            &[19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0],
            &[9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0],
        ],
        &[35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0],
        RK5,
    )
}

/// Butcher, J. Austral. Math. Soc. 4 (1964) 179-194: seven stages, sixth order.
fn butcher_6() -> Tableau {
    Tableau::new(
        "RK6 (Butcher)",
        &[
            &[],
            &[1.0 / 3.0],
            &[0.0, 2.0 / 3.0],
            &[1.0 / 12.0, 1.0 / 3.0, -1.0 / 12.0],
            &[25.0 / 48.0, -55.0 / 24.0, 35.0 / 48.0, 15.0 / 8.0],
            &[3.0 / 20.0, -11.0 / 24.0, -1.0 / 8.0, 1.0 / 2.0, 1.0 / 10.0],
            &[-261.0 / 260.0, 33.0 / 13.0, 43.0 / 156.0, -118.0 / 39.0, 32.0 / 195.0, 80.0 / 39.0],
        ],
        &[13.0 / 200.0, 0.0, 11.0 / 40.0, 11.0 / 40.0, 4.0 / 25.0, 4.0 / 25.0, 13.0 / 200.0],
        RK6,
    )
}

/// Dormand and Prince 8(5,3), coefficients as in DOP853 (Hairer, Norsett, Wanner, Solving ODEs I):.
#[rustfmt::skip]
const DOP853_A: [&[f64]; 12] = [
    &[],
    &[0.05260015195876773],
    &[0.0197250569845379, 0.0591751709536137],
    &[0.02958758547680685, 0.0, 0.08876275643042054],
    &[0.2413651341592667, 0.0, -0.8845494793282861, 0.924834003261792],
    &[0.037037037037037035, 0.0, 0.0, 0.17082860872947386, 0.12546768756682242],
    &[0.037109375, 0.0, 0.0, 0.17025221101954405, 0.06021653898045596, -0.017578125],
    &[0.03709200011850479, 0.0, 0.0, 0.17038392571223998, 0.10726203044637328, -0.015319437748624402, 0.008273789163814023],
    &[0.6241109587160757, 0.0, 0.0, -3.3608926294469414, -0.868219346841726, 27.59209969944671, 20.154067550477894, -43.48988418106996],
    &[0.47766253643826434, 0.0, 0.0, -2.4881146199716677, -0.590290826836843, 21.230051448181193, 15.279233632882423, -33.28821096898486, -0.020331201708508627],
    &[-0.9371424300859873, 0.0, 0.0, 5.186372428844064, 1.0914373489967295, -8.149787010746927, -18.52006565999696, 22.739487099350505, 2.4936055526796523, -3.0467644718982196],
    &[2.273310147516538, 0.0, 0.0, -10.53449546673725, -2.0008720582248625, -17.9589318631188, 27.94888452941996, -2.8589982771350235, -8.87285693353063, 12.360567175794303, 0.6433927460157636],
];
#[rustfmt::skip]
const DOP853_B: [f64; 12] = [0.054293734116568765, 0.0, 0.0, 0.0, 0.0, 4.450312892752409, 1.8915178993145003, -5.801203960010585, 0.3111643669578199, -0.1521609496625161, 0.20136540080403034, 0.04471061572777259];

#[cfg(test)]
mod tests {
    use super::*;

    /// Error at t = 1 of u' = t - u^2 (and its own non-linear coupling) against a much finer run.
    fn solve(tableau: &Tableau, steps: usize) -> [f64; 2] {
        let f = |t: f64, u: [f64; 2]| [t - u[0] * u[1], u[0] - u[1] * u[1] * t];
        let (mut u, dt) = ([1.0, 0.5], 1.0 / steps as f64);
        for step in 0..steps {
            let mut k: Vec<[f64; 2]> = Vec::new();
            for i in 0..tableau.stages() {
                let stage = [0, 1].map(|e| u[e] + dt * tableau.a[i].iter().zip(&k).map(|(a, k)| a * k[e]).sum::<f64>());
                k.push(f((step as f64 + tableau.c[i]) * dt, stage));
            }
            u = [0, 1].map(|e| u[e] + dt * tableau.b.iter().zip(&k).map(|(b, k)| b * k[e]).sum::<f64>());
        }
        u
    }

    #[test]
    fn each_tableau_has_its_order() {
        let exact = solve(&Tableau::of_degree(6), 400);
        for (degree, order, steps) in [(0, 1, 64), (1, 2, 32), (2, 4, 8), (3, 4, 8), (4, 5, 8), (5, 6, 6), (6, 8, 2)] {
            let tableau = Tableau::of_degree(degree);
            let error = |steps| {
                let u = solve(&tableau, steps);
                (u[0] - exact[0]).hypot(u[1] - exact[1])
            };
            let rate = (error(steps) / error(2 * steps)).log2();
            // The rate of two finite steps is off by O(dt); measured within .35 of the order.
            assert!(rate > order as f64 - 0.4, "{}: {rate}", tableau.name);
        }
    }
}
