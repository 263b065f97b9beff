//! Units with a prefix, so that the numbers of a picture are short.

/// Prefixes by powers of 1000, from 1e-12.
const PREFIXES: [&str; 9] = ["p", "n", "µ", "m", "", "k", "M", "G", "T"];
/// The place of the unit itself.
const PLAIN: i32 = 4;

/// The unit with the prefix that numbers up to `largest` read best in, and what one of it is.
pub fn prefixed(unit: &str, largest: f64) -> (String, f64) {
    // Pure numbers have no prefix; nor has what does not begin with its unit.
    if unit.is_empty() || largest <= 0.0 || !largest.is_finite() {
        return (unit.to_owned(), 1.0);
    }
    // .1 m and not 100 mm; 12000 Pa and not 1.2e4 Pa would be as good.
    let power = ((largest.log10() + 1e-9) / 3.0).floor() as i32;
    let power = power.clamp(-PLAIN, PLAIN);
    (format!("{}{unit}", PREFIXES[(power + PLAIN) as usize]), 1000_f64.powi(power))
}

/// A name with its unit.
pub fn label(name: &str, unit: &str) -> String {
    if unit.is_empty() { name.to_owned() } else { format!("{name} [{unit}]") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_one_to_three_digits_before_the_point() {
        let names = |unit: &str, x: f64| prefixed(unit, x).0;
        assert_eq!([names("Pa", 2.3e8), names("s", 1.77e-3), names("s", 4.9e-5)], ["MPa", "ms", "µs"]);
        assert_eq!([names("m/s", 200.0), names("", 1e9), names("J/m", 0.0)], ["m/s", "", "J/m"]);
        assert_eq!(names("Pa", 1e30), "TPa");
        for (unit, x) in [("Pa", 999.0), ("Pa", 1000.0), ("s", 1e-6)] {
            let in_unit = x / prefixed(unit, x).1;
            assert!((0.999..1000.0).contains(&in_unit), "{x}: {in_unit}");
        }
    }
}
