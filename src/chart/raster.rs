//! A field as coloured pixels.

use super::Palette;

/// Pixels of a raster for each pixel of the picture, in each direction: edges are smooth then.
const FINE: usize = 2;

/// So many of these pixels beyond its edges a triangle is filled: displacements of cells differ a little at their faces, and no line of
/// white stays open between them or below the outline.
const MARGIN: f64 = 0.75;

/// A corner of a triangle: its position in pixels of the picture, and the number there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Corner {
    /// Position, from the upper left.
    pub at: [f64; 2],
    /// The number.
    pub value: f64,
}

/// Pixels with a colour or none.
#[derive(Debug, Clone, PartialEq)]
pub struct Raster {
    at: [u32; 2],
    size: [u32; 2],
    /// Red, green, blue, opacity, row by row.
    pixels: Vec<u8>,
}

impl Raster {
    /// An empty one at a place of the picture, in its pixels.
    pub fn new(at: [u32; 2], size: [u32; 2]) -> Self {
        let count = size.map(|n| n as usize * FINE).iter().product::<usize>();
        Self { at, size, pixels: vec![0; 4 * count] }
    }

    /// Its upper left corner in the picture.
    pub fn at(&self) -> [u32; 2] {
        self.at
    }

    /// Its size in pixels of the picture.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Its own pixels in each direction.
    pub fn resolution(&self) -> [u32; 2] {
        self.size.map(|n| n * FINE as u32)
    }

    /// Red, green, blue and opacity, row by row.
    pub fn pixels(&self) -> &[u8] {
        &self.pixels
    }

    /// Fills a triangle, with numbers that are linear in between, in colours for numbers in `range`.
    pub fn fill(&mut self, corners: [Corner; 3], palette: Palette, [low, high]: [f64; 2]) {
        let [width, height] = self.resolution().map(|n| n as usize);
        let place =
            |corner: Corner| [0, 1].map(|axis| (corner.at[axis] - f64::from(self.at[axis])) * FINE as f64 - 0.5);
        let [a, b, c] = corners.map(place);
        let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        if area == 0.0 || !area.is_finite() {
            return;
        }
        let ends = |axis: usize, most: usize| {
            let all = [a[axis], b[axis], c[axis]];
            let (low, high) = all.iter().fold((f64::MAX, f64::MIN), |(l, h), x| (l.min(*x), h.max(*x)));
            let end = ((high + MARGIN).floor() + 1.0).clamp(0.0, most as f64) as usize;
            ((low - MARGIN).ceil().max(0.0) as usize)..end
        };
        let length = |p: [f64; 2], q: [f64; 2]| (q[0] - p[0]).hypot(q[1] - p[1]);
        let slack = [length(b, c), length(c, a), length(a, b)].map(|length| MARGIN * length / area.abs());
        for y in ends(1, height) {
            for x in ends(0, width) {
                let (px, py) = (x as f64, y as f64);
                let of = |p: [f64; 2], q: [f64; 2]| ((q[0] - p[0]) * (py - p[1]) - (q[1] - p[1]) * (px - p[0])) / area;
                let weights = [of(b, c), of(c, a), of(a, b)];
                if weights.iter().zip(slack).any(|(weight, slack)| *weight < -slack) {
                    continue;
                }
                let value: f64 = weights.iter().zip(corners).map(|(weight, corner)| weight * corner.value).sum();
                let [r, g, b] = palette.colour((value - low) / (high - low));
                let start = 4 * (y * width + x);
                self.pixels[start..start + 4].copy_from_slice(&[r, g, b, 255]);
            }
        }
    }

    /// Lays it over a picture of so many pixels a row, as means of its own pixels.
    pub(super) fn blend(&self, picture: &mut [u8], row: usize) {
        let [width, height] = self.size.map(|n| n as usize);
        for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
            let fine = (0..FINE).flat_map(|j| (0..FINE).map(move |i| (y * FINE + j) * width * FINE + x * FINE + i));
            let (mut sum, mut opacity) = ([0_u32; 3], 0_u32);
            for pixel in fine {
                let pixel = &self.pixels[4 * pixel..4 * pixel + 4];
                let is_there = u32::from(pixel[3] > 0);
                opacity += is_there;
                (0..3).for_each(|k| sum[k] += is_there * u32::from(pixel[k]));
            }
            let start = 3 * ((y + self.at[1] as usize) * row + x + self.at[0] as usize);
            let Some(under) = picture.get_mut(start..start + 3) else { continue };
            let count = (FINE * FINE) as u32;
            for (under, sum) in under.iter_mut().zip(sum) {
                *under = ((sum + (count - opacity) * u32::from(*under)) / count) as u8;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_triangles_fill_their_square_and_nothing_else() {
        let corner = |x: f64, y: f64| Corner { at: [x, y], value: x };
        let [a, b, c, d] = [corner(12.0, 22.0), corner(16.0, 22.0), corner(16.0, 26.0), corner(12.0, 26.0)];
        let mut raster = Raster::new([10, 20], [8, 8]);
        raster.fill([a, b, c], Palette::Rising, [12.0, 16.0]);
        raster.fill([a, c, d], Palette::Rising, [12.0, 16.0]);
        let filled = raster.pixels().chunks(4).filter(|pixel| pixel[3] == 255).count();
        // One pixel more at each side, half a pixel beyond the edge; not at the corners where the diagonal ends.
        let side = 4 * FINE;
        assert!(((side + 2).pow(2) - 4..=(side + 2).pow(2)).contains(&filled), "{filled}");
        let mut picture = vec![255; 3 * 30 * 40];
        raster.blend(&mut picture, 30);
        let at = |x: usize, y: usize| &picture[3 * (30 * y + x)..3 * (30 * y + x) + 3];
        assert_eq!(at(10, 23), [255; 3], "outside");
        assert_ne!(at(12, 22), [255; 3], "inside");
        // Dark on the left, light on the right.
        assert!(at(12, 24)[1] < at(15, 24)[1]);
    }
}
