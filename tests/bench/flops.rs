//! The flops that `dgmpm bench` counts are those of the formulas.

use dgmpm::parts::basis::TimeBasis;
use dgmpm::parts::bench::{Domain, Setup, count};
use dgmpm::parts::lane::counted::{self, Counts, SLOTS};
use dgmpm::parts::lane::{F8, Kernel, Lanes, Work, load_array};
use dgmpm::parts::material::{LinearElastic, Material, NeoHookean, Past, virgin};
use dgmpm::parts::step::Phase;
use dgmpm::parts::step::sweeps::{Sweep, Sweeps};
use dgmpm::registry::Method;

fn setup(method: Method, degree: usize, layout: &str) -> Setup {
    Setup {
        method,
        degree,
        domain: Domain::Cells([8, 8]),
        layout: Some(layout.to_owned()),
        law: "neo-hookean".to_owned(),
        kernel: Kernel::Portable,
        sets: vec![],
    }
}

struct Stress<M>(M);
impl<M: Material> Work for Stress<M> {
    type Out = ();
    fn run<L: Lanes>(self) {
        let f = load_array::<L, 4>(&[1.1, 0.1, 0.2, 0.9].map(F8::splat));
        self.0.stress(f, &mut Past::now(virgin::<L, M>()));
    }
}

/// Flops of the stress of neo-Hookean: det 1 mul 1 fma; J^(-1/3) twice 3 mul 4 fma; I 2 mul 2 add 2 fma; powers of the
/// root and A 3 mul; B 3 mul 1 add 1 fma; A F + B cof F 4 mul 4 fma.
const STRESS: u64 = 54;

#[test]
fn stress_takes_the_flops_of_its_formula() {
    let of = |counts: [Counts; SLOTS]| counts[SLOTS - 1];
    let neo_hookean = of(counted::count(|| Kernel::Counting.run(Stress(NeoHookean::new(1.0, 0.3, 1.0)))));
    let expected = Counts { additions: 3, multiplications: 19, fused: 16, divisions: 0, roots: 0 };
    assert_eq!((neo_hookean, neo_hookean.flops()), (expected, STRESS));
    // tr eps 3 add, times lambda 1 mul; shear 1 add 1 mul; the diagonal 2 add 2 fma.
    let linear = of(counted::count(|| Kernel::Counting.run(Stress(LinearElastic::new(1.0, 0.3, 1.0)))));
    assert_eq!(linear, Counts { additions: 6, multiplications: 2, fused: 2, divisions: 0, roots: 0 });
}

#[test]
fn dense_products_at_the_points_take_two_flops_an_entry_and_field() {
    for degree in 1..=4 {
        let flops = count(&setup(Method::AderDgmpm, degree, "jitter")).unwrap();
        let n = ((degree + 1) * (degree + 1)) as f64;
        // G2P of six fields; P2G of F, v and P, ten fields.
        assert_eq!(flops.of(Phase::GridToPoints as usize), 2.0 * 6.0 * n * n, "S{degree}");
        assert_eq!(flops.of(Phase::PointsToGrid as usize), 2.0 * 10.0 * n * n, "S{degree}");
    }
}

#[test]
fn the_predictor_takes_the_flops_of_its_sweeps() {
    for degree in 1..=3 {
        let flops = count(&setup(Method::AderDgmpm, degree, "jitter")).unwrap();
        let n = ((degree + 1) * (degree + 1)) as u64;
        let sweeps = Sweeps::of_degree(degree, &TimeBasis::new(degree));
        // At a point and time node: u as a sum of rates, the law, p / rho0; then rows of D along X1, X2 for four fields
        // each (affine cells: the matrices hold derivatives along X).
        let inner = |s: &Sweep| s.to as u64 * n * (2 * 6 * s.from as u64 + STRESS + 2 + 2 * 8 * n);
        let (to, from) = (sweeps.last.to as u64, sweeps.last.from as u64);
        // Averages: of u from the rates, of P from F at the last nodes.
        let average = n * (2 * 6 * from + 2) + n * to * (2 * 4 * from + STRESS + 2 * 4);
        let expected = sweeps.inner.iter().map(inner).sum::<u64>() + average;
        assert_eq!(flops.of(Phase::Predictor as usize), expected as f64, "S{degree}");
    }
}

#[test]
fn the_volume_term_takes_the_flops_of_sum_factorisation() {
    for degree in 1..=4 {
        let flops = count(&setup(Method::AderDgfem, degree, "gauss")).unwrap();
        let m = (degree + 1) as f64;
        // At a node: four contravariant tractions at 1 mul 1 fma; eight sums along lines of 1 mul and m - 1 fma; four
        // gradients at 1 mul 1 fma; two rows of momentum at 1 add. Two cofactors of 1 fma on each of 2 m lines.
        let expected = m * m * (4.0 * 3.0 + 8.0 * (2.0 * m - 1.0) + 4.0 * 3.0 + 2.0) + 2.0 * m * 2.0 * 2.0;
        assert_eq!(flops.of(Phase::Volume as usize), expected, "S{degree}");
    }
}

#[test]
fn the_curl_free_projection_takes_the_flops_of_its_halves() {
    for degree in 1..=4 {
        for method in [Method::RkDgfem, Method::AderDgfem] {
            let lcf = Setup { sets: vec!["curl.control=lcf".into()], ..setup(method, degree, "gauss") };
            let flops = count(&lcf).unwrap();
            let n = (degree + 1) * (degree + 1);
            let (even, odd, middle) = (n.div_ceil(2) as f64, (n / 2) as f64, (n % 2) as f64);
            // For each of four fields a sum and a difference a pair of nodes and 2 more behind the products, then theta of
            // them is subtracted. Products of both rows of F with two square matrices, two rows a node; at four nodes sums do
            // not begin from zero.
            let mut product = 4.0 * (odd * 8.0 + middle * 2.0) + 2.0 * 2.0 * (4.0 * even * even + 4.0 * odd * odd);
            product -= if degree == 1 { 2.0 * 2.0 * (even + odd) } else { 0.0 };
            // theta: its argument 1 mul 1 div; k 1 mul 2 add, r 1 fma, the series 11 fma and 2 powers, q 1 fma, and 1 add 1
            // fma.
            let theta = 2.0 + 3.0 + 2.0 + 2.0 * 11.0 + 2.0 + 2.0 + 3.0;
            assert_eq!(flops.of(Phase::CurlFree as usize), product + theta, "{method:?} S{degree}");
        }
        let off = Setup { sets: vec!["curl.control=off".into()], ..setup(Method::RkDgfem, degree, "gauss") };
        assert_eq!(count(&off).unwrap().of(Phase::CurlFree as usize), 0.0);
    }
}

#[test]
fn counts_of_a_cell_do_not_depend_on_the_mesh() {
    let squares = setup(Method::RkDgfem, 2, "gauss");
    let slender = Setup { domain: Domain::Cells([48, 2]), ..squares.clone() };
    assert_eq!(count(&squares).unwrap(), count(&slender).unwrap());
}
