//! What the paths do alike, and the numbers that they join and pick.

use super::*;
use proptest::prelude::*;

#[test]
fn inverse_cube_root_is_exact_to_rounding_on_its_whole_range() {
    for i in 0..200_000 {
        let x = 10f64.powf(-6.0 + 12.0 * i as f64 / 2e5);
        let relative = (x.inverse_cube_root() * x.cbrt() - 1.0).abs();
        // 3 ulp: two roundings in the last step, one in the product formed here.
        assert!(relative < 7e-16, "x = {x}: {relative:e}");
    }
}

/// Three numbers from both runs.
struct Join<'a>(&'a [F8], usize);
impl Work for Join<'_> {
    type Out = [F8; 3];
    #[inline(always)]
    fn run<L: Lanes>(self) -> [F8; 3] {
        let mut out = [F8::ZERO; 3];
        store_array(L::load_joined::<3>(&self.0[4..], self.0, 1, self.1), &mut out);
        out
    }
}

#[test]
fn joined_numbers_are_the_end_of_one_and_the_start_of_the_other_on_every_path() {
    let all: Vec<F8> = (0..9).map(|k| F8(std::array::from_fn(|lane| (8 * k + lane) as f64))).collect();
    for r in 1..8 {
        for kernel in paths() {
            for (k, out) in kernel.enter(Join(&all, r)).iter().enumerate() {
                let both: Vec<f64> = all[5 + k].0.iter().chain(&all[1 + k].0).copied().collect();
                assert_eq!(out.0, both[r..r + 8], "{kernel:?} {k} {r}");
            }
        }
    }
}

/// Lanes of two numbers, picked and read one by one.
struct Pick<'a>(&'a [F8], [u8; LANES], u8);
impl Work for Pick<'_> {
    type Out = [F8; 2];
    #[inline(always)]
    fn run<L: Lanes>(self) -> [F8; 2] {
        let Self(all, from, lanes) = self;
        let (mut out, mut faces, mut first) = ([F8::ZERO; 2], [&all[2..3]; LANES], [0; LANES]);
        for lane in 0..LANES {
            first[lane] = usize::from(from[lane]);
            if lanes >> lane & 1 == 1 {
                faces[lane] = &all[1..2];
            }
        }
        L::zero().pick(&all[2], &from, !lanes).pick(&all[1], &from, lanes).store(&mut out[0]);
        store_array(load_lanes::<L, 1>(&faces, &first), &mut out[1..]);
        out
    }
}

proptest! {
    #[test]
    fn picked_lanes_are_those_read_one_by_one_on_every_path(from in prop::array::uniform8(0u8..8), lanes: u8) {
        let all: Vec<F8> = (0..3).map(|k| F8(std::array::from_fn(|lane| (8 * k + lane) as f64))).collect();
        for kernel in paths() {
            let expected = F8(std::array::from_fn(|lane| {
                all[if lanes >> lane & 1 == 1 { 1 } else { 2 }].0[usize::from(from[lane])]
            }));
            prop_assert_eq!(kernel.enter(Pick(&all, from, lanes)), [expected; 2]);
        }
    }
}

/// All that this processor has.
fn paths() -> impl Iterator<Item = Kernel> {
    Kernel::NAMES.iter().map(|(_, kernel)| *kernel).filter(|kernel| kernel.is_available())
}

struct EveryOperation(F8, F8);
impl Work for EveryOperation {
    type Out = [F8; 6];
    #[inline(always)]
    fn run<L: Lanes>(self) -> [F8; 6] {
        let (a, b) = (L::load(&self.0), L::load(&self.1));
        let results = [a + b * a - b, a / b, a.mul_add(b, -a), a.sqrt(), a.min(b), a.max(b) + a.inverse_cube_root()];
        results.map(|x| {
            let mut out = F8::ZERO;
            x.store(&mut out);
            out
        })
    }
}

proptest! {
    #[test]
    fn all_paths_agree_to_the_rounding_of_one_fused_multiplication(
        a in prop::array::uniform8(1e-3..1e3f64), b in prop::array::uniform8(1e-3..1e3f64)) {
        let portable = Kernel::Portable.enter(EveryOperation(F8(a), F8(b)));
        for kernel in paths() {
            let other = kernel.enter(EveryOperation(F8(a), F8(b)));
            for (p, w) in as_f64(&portable).iter().zip(as_f64(&other)) {
                // Products reach 1e6 and may cancel: four roundings of 1e6 * 2^-52 = 2.3e-10.
                prop_assert!((p - w).abs() <= 4.0 * 2.3e-10);
            }
        }
    }
}
