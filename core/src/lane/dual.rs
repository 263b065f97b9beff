//! Forward-mode differentiation: numbers that carry their derivative through the code of a law.

use super::Lane;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// value + slope e with e^2 = 0: every operation carries the derivative along one direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dual {
    /// The number.
    pub value: f64,
    /// Its derivative.
    pub slope: f64,
}

impl Dual {
    /// From a number and its derivative.
    pub fn new(value: f64, slope: f64) -> Self {
        Self { value, slope }
    }

    /// The function with this value and derivative at `self`.
    fn chain(self, value: f64, derivative: f64) -> Self {
        Self { value, slope: derivative * self.slope }
    }

    /// sin and cos.
    pub fn sin_cos(self) -> (Self, Self) {
        let (sine, cosine) = self.value.sin_cos();
        (self.chain(sine, cosine), self.chain(cosine, -sine))
    }
}

impl Add for Dual {
    type Output = Dual;
    fn add(self, b: Dual) -> Dual {
        Dual::new(self.value + b.value, self.slope + b.slope)
    }
}

impl Sub for Dual {
    type Output = Dual;
    fn sub(self, b: Dual) -> Dual {
        Dual::new(self.value - b.value, self.slope - b.slope)
    }
}

impl Mul for Dual {
    type Output = Dual;
    fn mul(self, b: Dual) -> Dual {
        Dual::new(self.value * b.value, self.slope * b.value + self.value * b.slope)
    }
}

impl Div for Dual {
    type Output = Dual;
    fn div(self, b: Dual) -> Dual {
        let value = self.value / b.value;
        Dual::new(value, (self.slope - value * b.slope) / b.value)
    }
}

impl Neg for Dual {
    type Output = Dual;
    fn neg(self) -> Dual {
        Dual::new(-self.value, -self.slope)
    }
}

impl Lane for Dual {
    fn splat(x: f64) -> Dual {
        Dual::new(x, 0.0)
    }
    fn mul_add(self, b: Dual, c: Dual) -> Dual {
        self * b + c
    }
    fn sqrt(self) -> Dual {
        let root = self.value.sqrt();
        self.chain(root, 0.5 / root)
    }
    fn min(self, other: Dual) -> Dual {
        if self.value < other.value { self } else { other }
    }
    fn max(self, other: Dual) -> Dual {
        if self.value > other.value { self } else { other }
    }
    fn inverse_cube_root_guess(self) -> Dual {
        self.inverse_cube_root()
    }
    fn split(self) -> (Dual, Dual) {
        let (mantissa, power) = self.value.split();
        (self.chain(mantissa, (-power).power_of_two()), Dual::splat(power))
    }
    fn nearest(self) -> Dual {
        Dual::splat(self.value.nearest())
    }
    fn power_of_two(self) -> Dual {
        Dual::splat(self.value.power_of_two())
    }
    fn where_positive(self, yes: Dual, no: Dual) -> Dual {
        if self.value > 0.0 { yes } else { no }
    }
    fn inverse_cube_root(self) -> Dual {
        let root = 1.0 / self.value.cbrt();
        self.chain(root, -root / (3.0 * self.value))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lane::functions::{atanh_ratio, exp, ln};

    #[test]
    fn every_operation_has_the_slope_of_differences() {
        let all = |x: Dual| {
            let c = Dual::splat(1.7);
            let (sine, cosine) = x.sin_cos();
            let simple = [x + c * x, c - x, x * x * x, c / x, -x, x.mul_add(x, c)];
            let roots = [x.sqrt(), x.inverse_cube_root(), sine, cosine];
            let functions =
                [ln(x), ln(c * c * x), exp(x), exp(-x), atanh_ratio(x / c), atanh_ratio(x - Dual::splat(0.82))];
            [&simple[..], &roots, &functions].concat()
        };
        let (x, h) = (0.83, 1e-5);
        let (plus, minus) = (all(Dual::splat(x + h)), all(Dual::splat(x - h)));
        for (k, dual) in all(Dual::new(x, 1.0)).iter().enumerate() {
            let difference = (plus[k].value - minus[k].value) / (2.0 * h);
            // h^2 times third derivatives of size 6, and rounding 1e-16 / h.
            assert!((dual.slope - difference).abs() < 1e-8, "{k}: {} {difference}", dual.slope);
        }
    }
}
