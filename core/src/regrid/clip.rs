//! Intersections of convex polygons (Sutherland and Hodgman, 1974).

/// Corners of the intersection of two quadrilaterals: at most eight.
const CORNERS: usize = 8;

/// A convex polygon, counter-clockwise, in m.
#[derive(Debug, Clone, Copy)]
pub(super) struct Polygon {
    corners: [[f64; 2]; CORNERS],
    count: usize,
}

impl Polygon {
    /// A quadrilateral.
    pub fn quad(corners: [[f64; 2]; 4]) -> Self {
        let mut out = Self { corners: [[0.0; 2]; CORNERS], count: 4 };
        out.corners[..4].copy_from_slice(&corners);
        out
    }

    /// Its corners.
    pub fn corners(&self) -> &[[f64; 2]] {
        &self.corners[..self.count]
    }

    /// The part of the polygon inside a convex counter-clockwise quadrilateral.
    pub fn clipped(mut self, by: &[[f64; 2]; 4]) -> Self {
        for k in 0..4 {
            if self.count == 0 {
                break;
            }
            self = self.left_of(by[k], by[(k + 1) % 4]);
        }
        self
    }

    /// The part to the left of the line from a to b.
    fn left_of(&self, a: [f64; 2], b: [f64; 2]) -> Self {
        let side = |x: [f64; 2]| (b[0] - a[0]) * (x[1] - a[1]) - (b[1] - a[1]) * (x[0] - a[0]);
        let mut out = Self { corners: [[0.0; 2]; CORNERS], count: 0 };
        let mut from = self.corners[self.count - 1];
        let mut from_side = side(from);
        for &to in self.corners() {
            let to_side = side(to);
            // A corner on the line is kept once, as a corner: no crossing is made there.
            if (from_side < 0.0 && to_side > 0.0) || (from_side > 0.0 && to_side < 0.0) {
                let share = from_side / (from_side - to_side);
                out.push([0, 1].map(|i| from[i] + share * (to[i] - from[i])));
            }
            if to_side >= 0.0 {
                out.push(to);
            }
            (from, from_side) = (to, to_side);
        }
        out
    }

    /// By rounding a nearly flat polygon may cross a line more than twice. Corners beyond the capacity are dropped;
    /// they enclose no area.
    fn push(&mut self, x: [f64; 2]) {
        if self.count < CORNERS {
            self.corners[self.count] = x;
            self.count += 1;
        }
    }

    /// Its area, in m^2.
    pub fn area(&self) -> f64 {
        let mut sum = 0.0;
        for k in 2..self.count {
            let [o, a, b] = [0, k - 1, k].map(|k| self.corners[k]);
            sum += (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
        }
        0.5 * sum
    }

    /// Calls `visit` for quadrilaterals (corner numbers) that fill the polygon. If the number of corners is odd, the
    /// last one is a triangle: its last corner is given twice.
    pub fn quads(&self, mut visit: impl FnMut([usize; 4])) {
        let mut k = 1;
        while k + 1 < self.count {
            visit([0, k, k + 1, (k + 2).min(self.count - 1)]);
            k += 2;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: [[f64; 2]; 4] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];

    fn moved(by: [f64; 2], scale: f64, turn: f64) -> [[f64; 2]; 4] {
        let (s, c) = turn.sin_cos();
        SQUARE.map(|x| {
            let y = [scale * (x[0] - 0.5), scale * (x[1] - 0.5)];
            [0.5 + by[0] + c * y[0] - s * y[1], 0.5 + by[1] + s * y[0] + c * y[1]]
        })
    }

    #[test]
    fn overlap_of_shifted_squares_is_the_product_of_lengths() {
        let piece = Polygon::quad(SQUARE).clipped(&moved([0.25, -0.5], 1.0, 0.0));
        assert!((piece.area() - 0.375).abs() < 1e-16);
        assert_eq!(piece.corners().len(), 4);
    }

    #[test]
    fn a_square_turned_by_45_degrees_cuts_an_octagon() {
        // Side 1.2: half diagonal .6 sqrt 2 = .8485; each corner of the unit square loses a triangle of height
        // .7071 - .6 = .1071 and base twice that: area .01147.
        let piece = Polygon::quad(SQUARE).clipped(&moved([0.0, 0.0], 1.2, std::f64::consts::FRAC_PI_4));
        let height = 0.5f64.sqrt() - 0.6;
        assert_eq!(piece.corners().len(), 8);
        assert!((piece.area() - (1.0 - 4.0 * height * height)).abs() < 1e-15);
        let mut quads = 0;
        piece.quads(|_| quads += 1);
        assert_eq!(quads, 3);
    }

    #[test]
    fn neighbours_and_far_squares_have_no_area() {
        for by in [[1.0, 0.0], [0.0, -1.0], [1.0, 1.0], [5.0, 0.0]] {
            assert_eq!(Polygon::quad(SQUARE).clipped(&moved(by, 1.0, 0.0)).area(), 0.0, "{by:?}");
        }
    }

    #[test]
    fn pieces_of_a_grid_fill_what_they_cut() {
        // 0.3 m squares turned by 0.4: their pieces of the unit square sum up to it.
        let mut sum = 0.0;
        for i in -6..=6 {
            for j in -6..=6 {
                let (s, c) = 0.4f64.sin_cos();
                let by = [0.3 * (c * i as f64 - s * j as f64), 0.3 * (s * i as f64 + c * j as f64)];
                let piece = Polygon::quad(SQUARE).clipped(&moved(by, 0.3, 0.4));
                let mut quads = 0.0;
                piece.quads(|k| {
                    let x = k.map(|k| piece.corners()[k]);
                    quads += crate::mesh::map::area(&x);
                });
                assert!((quads - piece.area()).abs() < 1e-15);
                sum += piece.area();
            }
        }
        assert!((sum - 1.0).abs() < 1e-14, "{sum}");
    }
}
