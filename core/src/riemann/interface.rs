//! The flux between two materials, whatever the flux elsewhere: [F] N jumps physically there.

use super::{Impedance, Trace, current_normal, star};
use crate::lane::Lane;

/// v* = (Z^- + Z^+)^-1 (Z^- v^- + Z^+ v^+ + t^+ - t^-), t* = t^- + Z^- (v* - v^-).
///
/// It dissipates `[t]` (Z^- + Z^+)^-1 `[t]` + `[v]` (1/Z^- + 1/Z^+)^-1 `[v]`, whatever the contrast. A penalty on (`[F]` T) (x) T, which
/// is 0 in the solution, has no sign: with a contrast of 1e4 it makes energy.
///
/// Z^-, Z^+ from each side's own speeds and density (kg/m^3). Both share the current normal n, so that
/// Z^- + Z^+ is again an impedance. Never Rusanov there: two densities in uniform motion would give a false stress.
#[inline(always)]
pub fn interface<L: Lane>(minus: &Trace<L>, plus: &Trace<L>, n: [L; 2], density: [L; 2]) -> [L; 6] {
    let normal = current_normal(minus.f, plus.f, n);
    let own = Impedance::new(minus.c, density[0], normal);
    let other = Impedance::new(plus.c, density[1], normal);
    let sum = sum([minus, plus], normal, density);
    // Relative to v^-, so that uniform motion gives exactly v^-.
    let dv = [plus.v[0] - minus.v[0], plus.v[1] - minus.v[1]];
    let drive = other.times(dv);
    let step = sum.solve([drive[0] + (plus.t[0] - minus.t[0]), drive[1] + (plus.t[1] - minus.t[1])]);
    let dt = own.times(step);
    star([minus.v[0] + step[0], minus.v[1] + step[1]], [minus.t[0] + dt[0], minus.t[1] + dt[1]], n)
}

/// Z^- + Z^+ on the current normal n.
#[inline(always)]
fn sum<L: Lane>([minus, plus]: [&Trace<L>; 2], n: [L; 2], density: [L; 2]) -> Impedance<L> {
    let both = [
        density[0].mul_add(minus.c[0], density[1] * plus.c[0]),
        density[0].mul_add(minus.c[1], density[1] * plus.c[1]),
    ];
    Impedance::new(both, L::splat(1.0), n)
}

/// Z^- + Z^+, whose inverse is Y of v* = .. + Y `[t]` between two laws.
pub fn summed_impedance<L: Lane>(sides: [&Trace<L>; 2], n: [L; 2], density: [L; 2]) -> Impedance<L> {
    let [minus, plus] = sides;
    sum(sides, current_normal(minus.f, plus.f, n), density)
}
