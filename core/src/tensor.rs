//! Tensors of plane strain, generic over the lane: a tensor is [T11, T12, T21, T22], a vector [v1, v2].

use crate::lane::Lane;

/// Axes of the plane: components of a vector.
pub const AXES: usize = 2;

/// Components of a tensor of the plane, as F and P are.
pub const DEFORMATION: usize = AXES * AXES;

/// det F = F11 F22 - F12 F21 (the jacobian J, since F33 = 1).
#[inline(always)]
pub fn det<L: Lane>(f: [L; 4]) -> L {
    f[0].mul_add(f[3], -(f[1] * f[2]))
}

/// cof F = J F^-T = [F22, -F21, -F12, F11].
#[inline(always)]
pub fn cofactor<L: Lane>(f: [L; 4]) -> [L; 4] {
    [f[3], -f[2], -f[1], f[0]]
}

/// a . b
#[inline(always)]
pub fn dot<L: Lane>(a: [L; 2], b: [L; 2]) -> L {
    a[0].mul_add(b[0], a[1] * b[1])
}

/// a_1 b_2 - a_2 b_1.
#[inline(always)]
pub fn cross<L: Lane>(a: [L; 2], b: [L; 2]) -> L {
    a[0] * b[1] - a[1] * b[0]
}

/// a - b.
#[inline(always)]
pub fn minus<L: Lane>(a: [L; 2], b: [L; 2]) -> [L; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

/// A : B
#[inline(always)]
pub fn contract<L: Lane>(a: [L; 4], b: [L; 4]) -> L {
    a[0].mul_add(b[0], a[1] * b[1]) + a[2].mul_add(b[2], a[3] * b[3])
}

/// F N
#[inline(always)]
pub fn times<L: Lane>(f: [L; 4], n: [L; 2]) -> [L; 2] {
    [dot([f[0], f[1]], n), dot([f[2], f[3]], n)]
}

/// A B^T
#[inline(always)]
pub fn times_transposed<L: Lane>(a: [L; 4], b: [L; 4]) -> [L; 4] {
    let rows = [[a[0], a[1]], [a[2], a[3]]];
    let columns = [[b[0], b[1]], [b[2], b[3]]];
    [dot(rows[0], columns[0]), dot(rows[0], columns[1]), dot(rows[1], columns[0]), dot(rows[1], columns[1])]
}

/// C = F^T F, [C11, C12, C22].
#[inline(always)]
pub fn right_cauchy_green<L: Lane>(f: [L; 4]) -> [L; 3] {
    [dot([f[0], f[2]], [f[0], f[2]]), dot([f[0], f[2]], [f[1], f[3]]), dot([f[1], f[3]], [f[1], f[3]])]
}

/// v / |v|
#[inline(always)]
pub fn normalised<L: Lane>(v: [L; 2]) -> [L; 2] {
    let inverse = L::splat(1.0) / dot(v, v).sqrt();
    [v[0] * inverse, v[1] * inverse]
}

/// Eigenvalues (larger, smaller) of the symmetric [[a, b], [b, c]].
#[inline(always)]
pub fn eigenvalues<L: Lane>(a: L, b: L, c: L) -> [L; 2] {
    let half = L::splat(0.5);
    let (mean, difference) = (half * (a + c), half * (a - c));
    let radius = difference.mul_add(difference, b * b).sqrt();
    [mean + radius, mean - radius]
}

/// Unit eigenvector (cos t, sin t) of the smaller eigenvalue of the symmetric [[a, b], [b, c]].
///
/// From cos 2t = -(a - c) / (2 r), sin 2t = -b / r, r the radius of Mohr's circle: exact to 1e-8 in t, which is
/// 1e-16 in the eigenvalue. For a multiple of the identity it is (1, -1) / sqrt(2), as good as any.
#[inline(always)]
pub fn smaller_eigenvector<L: Lane>(a: L, b: L, c: L) -> [L; 2] {
    let (one, half) = (L::splat(1.0), L::splat(0.5));
    let difference = half * (a - c);
    let radius = difference.mul_add(difference, b * b).sqrt() + L::splat(f64::MIN_POSITIVE);
    let cosine = (-difference / radius).min(one).max(-one);
    let sign = b.mul_add(L::splat(f64::MAX), one).min(one).max(-one);
    [(half * (one + cosine)).sqrt(), -sign * (half * (one - cosine)).sqrt()]
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn smaller_eigenvector_satisfies_its_equation(a in -3.0..3.0f64, b in -3.0..3.0f64, c in -3.0..3.0f64) {
            for b in [b, 0.0, b * 1e-9] {
                let v = smaller_eigenvector(a, b, c);
                let l = eigenvalues(a, b, c)[1];
                // The angle is exact to 1e-8 where the cosine is near 1.
                prop_assert!((a * v[0] + b * v[1] - l * v[0]).abs() < 1e-6);
                prop_assert!((b * v[0] + c * v[1] - l * v[1]).abs() < 1e-6);
                prop_assert!((dot(v, v) - 1.0).abs() < 1e-14);
            }
        }

        #[test]
        fn cofactor_times_transposed_is_det(f in prop::array::uniform4(-2.0..2.0f64)) {
            let identity = times_transposed(f, cofactor(f));
            for (x, expected) in identity.iter().zip([det(f), 0.0, 0.0, det(f)]) {
                // Products of size 4: a few roundings.
                prop_assert!((x - expected).abs() < 8.0 * f64::EPSILON * 4.0);
            }
        }
    }
}
