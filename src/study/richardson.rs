//! Richardson's extrapolation: from the values of a quantity on three meshes to its limit, its order and its error.
//!
//! With q(h) = Q + C h^p on meshes h1 > h2 > h3 the differences obey (q1 - q3) / (q2 - q3) = (h1^p - h3^p) / (h2^p - h3^p), which
//! rises with p, and q3 - Q = (q2 - q3) / ((h2/h3)^p - 1). Values of which this is not true are refused with the reason.

use std::fmt;

/// Differences below this share of the values are rounding.
const ROUNDING: f64 = 1e-12;
/// Meshes whose sizes differ by less than this factor tell no order: noise would be taken for it.
const APART: f64 = 1.2;
/// The smallest order that is believed.
const SLOWEST: f64 = 0.25;
/// Where the search for an order ends.
const FASTEST: f64 = 64.0;

/// What three meshes tell of a quantity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// The limit Q.
    pub limit: f64,
    /// The order p; none where the values differ by rounding only.
    pub order: Option<f64>,
    /// |q3 - Q| of the finest mesh.
    pub error: f64,
}

/// Why three meshes tell no limit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Doubt {
    /// Less than three meshes have a value.
    TooFew,
    /// A value is not a number.
    NoNumber,
    /// The last two differences have opposite signs.
    Oscillates([f64; 2]),
    /// The last two differences do not fall.
    DoesNotFall([f64; 2]),
    /// The order lies outside of what is believed: the values are not near their limit, or meet it by chance.
    Order {
        /// p.
        order: f64,
        /// The smallest and the largest that are believed.
        range: [f64; 2],
    },
}

/// As a clause, for messages and tables.
impl fmt::Display for Doubt {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooFew => write!(f, "needs three meshes, each finer by a factor of {APART} or more"),
            Self::NoNumber => write!(f, "a value is missing"),
            Self::Oscillates([a, b]) => write!(f, "does not converge: the last differences are {a:.1e} and {b:.1e}"),
            Self::DoesNotFall([a, b]) => {
                write!(f, "does not converge: the last differences are {a:.1e} and {b:.1e}, which do not fall")
            }
            Self::Order { order, range: [low, high] } if *order >= FASTEST => {
                write!(f, "does not converge: no order between {low} and {high}")
            }
            Self::Order { order, range: [low, high] } => {
                write!(f, "does not converge: its order {order:.2} is not between {low} and {high}")
            }
        }
    }
}

/// The order p for which `(h, d)`, sizes over that of the finest mesh and the distances from its value, obey
/// d ~ h^p - 1: between `low` and `high`, at the nearer end where it lies outside.
pub fn order(half: (f64, f64), quarter: (f64, f64), [mut low, mut high]: [f64; 2]) -> f64 {
    let ratio = |p: f64| (quarter.0.powf(p) - 1.0) / (half.0.powf(p) - 1.0);
    // The ratio rises with p.
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if ratio(middle) < quarter.1 / half.1 { low = middle } else { high = middle }
    }
    low
}

/// The limit of `values`, pairs of h in any unit and q, by falling h, of a method of degree N: from the finest and the next two coarser ones
/// that are each coarser by a factor of at least [`APART`].
///
/// # Errors
/// Values that do not converge, or are too few.
pub fn estimate(values: &[(f64, f64)], degree: usize) -> Result<Estimate, Doubt> {
    let mut apart: Vec<(f64, f64)> = Vec::new();
    for &(h, q) in values.iter().rev() {
        if apart.last().is_none_or(|(finer, _)| h >= APART * finer) {
            apart.push((h, q));
        }
    }
    let [(h3, q3), (h2, q2), (h1, q1), ..] = apart[..] else { return Err(Doubt::TooFew) };
    if ![q1, q2, q3].iter().all(|q| q.is_finite()) {
        return Err(Doubt::NoNumber);
    }
    let (differences, scale) = ([q1 - q2, q2 - q3], q1.abs().max(q2.abs()).max(q3.abs()));
    let [first, second] = differences;
    if differences.iter().all(|d| d.abs() <= ROUNDING * scale) {
        return Ok(Estimate { limit: q3, order: None, error: first.abs().max(second.abs()) });
    }
    if first * second < 0.0 {
        return Err(Doubt::Oscillates(differences));
    }
    // That of p = 0: for meshes of one ratio, differences of one size.
    if first.abs() * (h2 / h3).ln() <= second.abs() * (h1 / h2).ln() {
        return Err(Doubt::DoesNotFall(differences));
    }
    // Functionals of a smooth solution converge by up to 2N + 1; half an order more is noise of coarse meshes.
    let range = [SLOWEST, (2 * degree) as f64 + 1.5];
    let order = order((h2 / h3, second), (h1 / h3, first + second), [1e-3, FASTEST]);
    if !(range[0]..=range[1]).contains(&order) {
        return Err(Doubt::Order { order, range });
    }
    let above = second / ((h2 / h3).powf(order) - 1.0);
    Ok(Estimate { limit: q3 - above, order: Some(order), error: above.abs() })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn series(h: &[f64], q: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
        h.iter().map(|&h| (h, q(h))).collect()
    }

    #[test]
    fn a_series_of_order_2_has_its_limit_order_and_error_for_any_ratio_of_meshes() {
        for h in [&[1.0, 0.5, 0.25][..], &[1.0, 0.7, 0.3], &[8.0, 4.0, 3.0, 2.0]] {
            let found = estimate(&series(h, |h| 3.0 + 0.1 * h * h), 2).unwrap();
            let finest = h[h.len() - 1];
            // Exact data: rounding of the differences and of a bisection.
            assert!((found.limit - 3.0).abs() < 1e-9, "{found:?}");
            assert!((found.order.unwrap() - 2.0).abs() < 1e-6, "{found:?}");
            assert!((found.error - 0.1 * finest * finest).abs() < 1e-9, "{found:?}");
        }
    }

    #[test]
    fn only_the_last_three_meshes_count() {
        let mut values = series(&[4.0, 2.0, 1.0], |h| 1.0 + h);
        values.insert(0, (8.0, -50.0));
        assert!((estimate(&values, 1).unwrap().limit - 1.0).abs() < 1e-9);
    }

    #[test]
    fn meshes_of_nearly_one_size_do_not_make_an_order() {
        let noisy = [(4.0, 5.0), (2.0, 3.0), (1.02, 2.0202), (1.01, 1.99), (1.0, 2.0)];
        assert!((estimate(&noisy, 1).unwrap().limit - 1.0).abs() < 1e-9);
        assert_eq!(estimate(&noisy[2..], 1), Err(Doubt::TooFew));
    }

    #[test]
    fn values_that_oscillate_grow_or_are_too_few_do_not_converge() {
        let h = [4.0, 2.0, 1.0];
        let of = |q: [f64; 3]| estimate(&h.into_iter().zip(q).collect::<Vec<_>>(), 2);
        assert_eq!(of([1.0, 2.0, 1.5]), Err(Doubt::Oscillates([-1.0, 0.5])));
        assert_eq!(of([1.0, 2.0, 4.0]), Err(Doubt::DoesNotFall([-1.0, -2.0])));
        // Steps of one size go on for ever.
        assert_eq!(of([1.0, 2.0, 3.0]), Err(Doubt::DoesNotFall([-1.0, -1.0])));
        assert_eq!(of([1.0, f64::NAN, 3.0]), Err(Doubt::NoNumber));
        assert_eq!(estimate(&[(2.0, 1.0), (1.0, 1.0)], 2), Err(Doubt::TooFew));
        for doubt in [of([1.0, 2.0, 1.5]), of([1.0, 2.0, 4.0])] {
            assert!(doubt.unwrap_err().to_string().contains("does not converge"));
        }
    }

    #[test]
    fn orders_that_no_method_has_are_chance() {
        let with = |p: f64, degree| estimate(&series(&[4.0, 2.0, 1.0], |h| 1.0 + 1e-3 * h.powf(p)), degree);
        assert!(matches!(with(0.1, 2), Err(Doubt::Order { order, .. }) if (order - 0.1).abs() < 1e-3));
        assert!(matches!(with(6.0, 2), Err(Doubt::Order { order, .. }) if (order - 6.0).abs() < 1e-3));
        assert!(with(5.0, 2).is_ok() && with(0.5, 2).is_ok() && with(5.0, 1).is_err());
        // The last two meshes agree to the last bit, the first does not.
        let same = estimate(&[(4.0, 2.0), (2.0, 1.0), (1.0, 1.0)], 2).unwrap_err();
        assert!(same.to_string().contains("no order between"), "{same}");
    }

    #[test]
    fn values_that_differ_by_rounding_are_their_limit() {
        let found = estimate(&[(4.0, 1.0), (2.0, 1.0 + 1e-15), (1.0, 1.0 - 1e-15)], 3).unwrap();
        assert_eq!((found.limit, found.order), (1.0 - 1e-15, None));
        assert!(found.error < 1e-14);
        let zero = estimate(&[(4.0, 0.0), (2.0, 0.0), (1.0, 0.0)], 3).unwrap();
        assert_eq!(zero, Estimate { limit: 0.0, order: None, error: 0.0 });
    }
}
