//! Springs against the creep of faces.
//!
//! Where v* = mean v + Y `[t]`, a traction jump that lasts moves the face away from its cells for good: the face creeps, and takes
//! energy. So each face point keeps its creep a = int R^T (v* - mean v) dt, in the axes of the body, and a spring k against it:
//!
//! ```text
//! v* = mean v + Y ([t] - k R a),    da/dt = R^T Y ([t] - (1 + epsilon) k R a),    k = beta M / l
//! ```
//!
//! R is the rotation of the mean F of both sides (at the ends of the face between cells of one law), so that a turns with the body, M = rho0 c_p^2 of the law at F = 1 (Pa, between two laws
//! [`in_series`]) and l the length of the face. What the jump of traction does at the face is then
//! `[t].(v* - mean v)` = Y^-1 |da/dt|^2 + d/dt (k/2 |a|^2): a loss and a stored energy, neither below 0, whatever R and the law.
//! Waves that pass a cell in less than the relaxation time 1/(Y k), some 2 l/(beta theta c_p), see the flux as it is. What lasts longer is
//! held, and the face gives back what it has crept. But springs forget: da/dt is less by [`FORGETS`] Y k R a, which the cells do not feel, and
//! takes that share of k R a . Y k R a of what is stored. A free surface has Z^-1 for Y, -t for `[t]`, and k c_s/c_p for k: its shear creeps at
//! 1/(rho0 c_s).

use crate::lane::Lane;

/// beta by degree. A ring of straight cells (2 x 32) that vibrates keeps in two periods .10, .51 and .64 of its energy without springs (N = 1, 2,
/// 3), .63 and .92 with .1 (N = 1, 3), .76, .925 and .967 with .3. What lasts sees v* = mean v, a central flux, which has the order N alone where N is
/// odd: with .3 the errors of the manufactured problem grow by 12, 36 and 83 % at N = 3 (8, 16, 32 cells), by 1 and 4 % (8 and 16 cells) with .03; at
/// even N by 2, 1 and 5 %. At N = 0 a jump is all that a cell knows of its neighbour, and nothing is held.
/// A law with memory has no springs: where it flows jumps of traction last, and what holds the faces then makes a Taylor bar (S1 to S3) gain
/// .8, .12 and .5 % where it gains .01, .05 and .2 % without. (Measured with the whole of k at free sides.)
const SPRING: [f64; 7] = [0.0, 0.03, 0.3, 0.03, 0.3, 0.03, 0.3];

/// epsilon, what springs forget: in 1/epsilon relaxation times, a thousand lengths of a cell over c_p, what they hold. A jump that is held grows
/// by whatever drives it, be it little: in a body that spins the stress of points that are no Gauss points does so, for its fit to the
/// nodes is not objective. A soft square of 2 x 2 cells (S2, `paper`) makes in 25 turns 5.0, .53, .08 and .002 % of energy with 0, .01, .03 and .1 (.33 %
/// without springs); the ring loses .6, 1.4 and 4.4 % more by .01, .03 and .1 in two periods, the bracket .1, .3 and .7 %.
pub const FORGETS: f64 = 0.03;

/// beta of a degree N.
pub fn spring(degree: usize) -> f64 {
    SPRING[degree.min(SPRING.len() - 1)]
}

/// The modulus of a face between two laws, from those of both (Pa): springs in series, M between two of M.
pub fn in_series([a, b]: [f64; 2]) -> f64 {
    2.0 * a * b / (a + b)
}

/// cos and sin of the rotation R of F, of which `f` may be any multiple above 0: that of the polar decomposition, in two dimensions
/// (F + cof F) over its size. No F with J > 0 has none.
#[inline(always)]
pub fn rotation<L: Lane>(f: [L; 4]) -> [L; 2] {
    let (cos, sin) = (f[0] + f[3], f[2] - f[1]);
    let scale = L::splat(1.0) / cos.mul_add(cos, sin * sin).sqrt();
    [cos * scale, sin * scale]
}

/// R a.
#[inline(always)]
pub fn turned<L: Lane>([cos, sin]: [L; 2], a: [L; 2]) -> [L; 2] {
    [cos.mul_add(a[0], -(sin * a[1])), sin.mul_add(a[0], cos * a[1])]
}

/// R^T a.
#[inline(always)]
pub fn turned_back<L: Lane>([cos, sin]: [L; 2], a: [L; 2]) -> [L; 2] {
    turned([cos, -sin], a)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tensor::{cofactor, times};
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_rotation_of_a_stretch_and_a_rotation_is_that_rotation(angle in -3.1..3.1f64, a in 0.3..3.0f64, b in 0.3..3.0f64, shear in -0.5..0.5f64) {
            // F = R U with U symmetric and positive.
            let shear = shear * (a * b).sqrt();
            let (cos, sin) = (angle.cos(), angle.sin());
            let f = [cos * a - sin * shear, cos * shear - sin * b, sin * a + cos * shear, sin * shear + cos * b];
            let found = rotation(f.map(|x| 7.0 * x));
            // Some ten operations on numbers of size 10.
            prop_assert!((found[0] - cos).abs() < 1e-13 && (found[1] - sin).abs() < 1e-13, "{found:?}");
            let sum = [0, 1, 2, 3].map(|k| f[k] + cofactor(f)[k]);
            let direction = times(sum, [1.0, 0.0]);
            prop_assert!((direction[0] * sin - direction[1] * cos).abs() < 1e-12);
        }

        #[test]
        fn turning_back_undoes_turning(angle in -3.1..3.1f64, a in prop::array::uniform2(-1.0..1.0f64)) {
            let rotation = [angle.cos(), angle.sin()];
            let back = turned_back(rotation, turned(rotation, a));
            // Eight operations on numbers of size 1.
            prop_assert!((back[0] - a[0]).abs() < 1e-15 && (back[1] - a[1]).abs() < 1e-15);
        }
    }
}
