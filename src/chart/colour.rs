//! Colours for numbers: equal steps of a number are equal steps for the eye.

/// From dark to light: viridis (Smith, van der Walt), at equal distances.
const VIRIDIS: [[u8; 3]; 10] = [
    [68, 1, 84],
    [72, 40, 120],
    [62, 74, 137],
    [49, 104, 142],
    [38, 130, 142],
    [31, 158, 137],
    [53, 183, 121],
    [110, 206, 88],
    [181, 222, 43],
    [253, 231, 37],
];

/// From blue over grey to red, by Moreland, at equal distances.
const COOL_WARM: [[u8; 3]; 9] = [
    [59, 76, 192],
    [98, 130, 234],
    [141, 176, 254],
    [184, 208, 249],
    [221, 221, 221],
    [245, 196, 173],
    [244, 154, 123],
    [222, 96, 77],
    [180, 4, 38],
];

/// Which colours numbers get.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Palette {
    /// From the smallest to the largest.
    Rising,
    /// To both sides of a number, which is in the middle.
    Around(f64),
}

impl Palette {
    /// The range of colours for numbers from `low` to `high`: symmetric where the palette has a middle, and never empty.
    pub fn range(self, [low, high]: [f64; 2]) -> [f64; 2] {
        let [low, high] = match self {
            Self::Rising => [low, high],
            Self::Around(middle) => {
                let reach = (high - middle).abs().max((low - middle).abs());
                [middle - reach, middle + reach]
            }
        };
        // Differences of the size of rounding are none.
        let least = 1e-12 * low.abs().max(high.abs());
        if high - low > least { [low, high] } else { [low - 0.5 * least.max(1e-300), high + 0.5 * least.max(1e-300)] }
    }

    /// The colour at a share of the range, cut to 0..1.
    pub fn colour(self, share: f64) -> [u8; 3] {
        match self {
            Self::Rising => between(&VIRIDIS, share),
            Self::Around(_) => between(&COOL_WARM, share),
        }
    }
}

fn between(colours: &[[u8; 3]], share: f64) -> [u8; 3] {
    let place = share.clamp(0.0, 1.0) * (colours.len() - 1) as f64;
    let first = (place as usize).min(colours.len() - 2);
    let rest = place - first as f64;
    let [a, b] = [colours[first], colours[first + 1]];
    std::array::from_fn(|k| (f64::from(a[k]) + rest * (f64::from(b[k]) - f64::from(a[k]))).round() as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_go_through_those_of_the_list_and_stay_at_its_ends() {
        for (palette, all) in [(Palette::Rising, &VIRIDIS[..]), (Palette::Around(0.0), &COOL_WARM[..])] {
            for (k, colour) in all.iter().enumerate() {
                assert_eq!(palette.colour(k as f64 / (all.len() - 1) as f64), *colour);
            }
            assert_eq!([palette.colour(-1.0), palette.colour(2.0)], [all[0], all[all.len() - 1]]);
        }
    }

    #[test]
    fn a_range_with_a_middle_is_symmetric_and_none_is_empty() {
        assert_eq!(Palette::Around(1.0).range([0.9, 1.3]), [0.7, 1.3]);
        assert_eq!(Palette::Rising.range([2.0, 5.0]), [2.0, 5.0]);
        for [low, high] in [[0.0, 0.0], [3.0, 3.0], [-2.0, -2.0]] {
            let [a, b] = Palette::Rising.range([low, high]);
            assert!(a < b && a <= low && high <= b, "{low}: {a} {b}");
        }
    }
}
