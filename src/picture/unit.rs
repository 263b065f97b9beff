//! Units with a prefix, so that the numbers of a picture are short.

/// Prefixes by powers of 1000, from 1e-12.
const PREFIXES: [&str; 9] = ["p", "n", "µ", "m", "", "k", "M", "G", "T"];
/// The place of the unit itself.
const PLAIN: i32 = 4;

/// The unit with the prefix that numbers up to `largest` read best in, and what one of it is.
pub fn prefixed(unit: &str, largest: f64) -> (String, f64) {
    // Pure numbers have no prefix, and kg has one already.
    if unit.is_empty() || unit.starts_with("kg") || largest <= 0.0 || !largest.is_finite() {
        return (unit.to_owned(), 1.0);
    }
    let power = ((largest.log10() + 1e-9) / 3.0).floor() as i32;
    let power = power.clamp(-PLAIN, PLAIN);
    (format!("{}{unit}", PREFIXES[(power + PLAIN) as usize]), 1000_f64.powi(power))
}

/// The same, also for numbers that no prefix makes short: with a power of 1000 before the unit, such as `1e-15 kg/s`. What is nearer to 0
/// than a power can say stays as it is.
pub fn scaled(unit: &str, largest: f64) -> (String, f64) {
    let (name, size) = prefixed(unit, largest);
    let rest = largest / size;
    if (1e-3..1e6).contains(&rest) || !(1e-300..1e305).contains(&largest) {
        return (name, size);
    }
    let power = 3 * ((largest.log10() + 1e-9) / 3.0).floor() as i32;
    (format!("1e{power} {unit}").trim_end().to_owned(), 10_f64.powi(power))
}

/// Four digits of a number.
pub fn short(x: f64) -> String {
    if x.abs() >= 1e9 {
        return format!("{x:.3e}");
    }
    let digits = (3 - x.abs().max(1e-300).log10().floor() as i32).clamp(0, 6) as usize;
    let text = format!("{x:.digits$}");
    if digits == 0 { text } else { text.trim_end_matches('0').trim_end_matches('.').to_owned() }
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
        assert_eq!([names("Pa", 1e30), names("kg/s", 7e3)], ["TPa", "kg/s"]);
        assert_eq!([140.0, 1.77, 0.0123456, 12345.6, 0.0].map(short), ["140", "1.77", "0.01235", "12346", "0"]);
        for (unit, x) in [("Pa", 999.0), ("Pa", 1000.0), ("s", 1e-6)] {
            let in_unit = x / prefixed(unit, x).1;
            assert!((0.999..1000.0).contains(&in_unit), "{x}: {in_unit}");
        }
    }

    #[test]
    fn numbers_that_no_prefix_makes_short_have_a_power_before_the_unit() {
        let of = |unit: &str, x: f64| scaled(unit, x).0;
        assert_eq!([of("kg/s", 3e-15), of("", 2e9), of("Pa", 4e300)], ["1e-15 kg/s", "1e9", "1e300 Pa"]);
        assert_eq!([of("kg/s", 7e3), of("", 1.2), of("Pa", 2e8), of("J/m", 0.0)], ["kg/s", "", "MPa", "J/m"]);
        for x in [1e-300, 3e-15, 5e17, 1e300] {
            let in_unit = x / scaled("kg/s", x).1;
            assert!((0.999..1000.0).contains(&in_unit), "{x}: {in_unit}");
        }
        assert_eq!(short(1e300), "1.000e300");
    }
}
