//! The map of a cell, xi in [0, 1]^2 -> X, and its inverse.
//!
//! Of straight cells, X(xi) = X0 + (X1 - X0) xi1 + (X3 - X0) xi2 + (X0 - X1 + X2 - X3) xi1 xi2, corners as in [`super::Mesh`]; of
//! curved cells (isoparametric of degree 2, [`CellMap`]) with what their [`Bulge`] adds.

/// Corners of a cell, in m.
pub type Corners = [[f64; 2]; 4];

/// What the map of degree 2 adds to that of the corners, in m: for the faces 0 to 3 the vector from the middle of the chord to the
/// middle of the edge, then what is left at the middle of the cell. With b(s) = 4 s (1 - s) the sum is
///
/// b(xi2) ((1 - xi1) d0 + xi1 d1) + b(xi1) ((1 - xi2) d2 + xi2 d3) + b(xi1) b(xi2) d4.
///
/// With d4 = 0 it is the map of a serendipity quadrilateral of 8 nodes, else that of one of 9 nodes.
pub type Bulge = [[f64; 2]; 5];

/// The map of a cell, straight or curved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CellMap {
    /// Its corners.
    pub corners: Corners,
    /// None of a cell with straight edges.
    pub bulge: Option<Bulge>,
}

impl CellMap {
    /// The map moved by `by`, m.
    #[must_use]
    pub fn moved(&self, by: [f64; 2]) -> Self {
        Self { corners: self.corners.map(|x| [x[0] + by[0], x[1] + by[1]]), ..*self }
    }
}

/// The [`Bulge`] of a cell by the middles of its faces 0 to 3 and, of a cell of 9 nodes, its own middle; none where it is straight.
///
/// What is below a share of 1e-10 of the chords is rounding of a straight edge and counts as 0. The bits are those that
/// [`middles`] gives back.
pub fn bulge_of(corners: &Corners, faces: [[f64; 2]; 4], middle: Option<[f64; 2]>) -> Option<Bulge> {
    let size = |face: usize| {
        let [a, b] = super::FACE_CORNERS[face].map(|k| corners[k]);
        (b[0] - a[0]).hypot(b[1] - a[1])
    };
    let clear = |d: [f64; 2], size: f64| if d[0].hypot(d[1]) <= ROUNDING * size { [0.0; 2] } else { d };
    let mut out = Bulge::default();
    for (face, x) in faces.into_iter().enumerate() {
        out[face] = clear(apart(x, chord(corners, face)), size(face));
    }
    if let Some(x) = middle {
        out[4] = clear(apart(x, blended(corners, &out)), (0..4).map(size).fold(0.0, f64::max));
    }
    (out != Bulge::default()).then_some(out)
}

/// The share of a chord below which a bulge is rounding.
const ROUNDING: f64 = 1e-10;

/// d with x = from + d, such that the sum gives it back to the bit.
fn apart(x: [f64; 2], from: [f64; 2]) -> [f64; 2] {
    [0, 1].map(|i| (from[i] + (x[i] - from[i])) - from[i])
}

/// The middle of the chord of a face, whichever way it runs.
fn chord(corners: &Corners, face: usize) -> [f64; 2] {
    let [a, b] = super::FACE_CORNERS[face].map(|k| corners[k]);
    [0, 1].map(|i| 0.5 * (a[i] + b[i]))
}

/// Where the middle of a cell is by its corners and the bulges of its faces; sums in an order that no turn of the cell changes.
fn blended(corners: &Corners, bulge: &Bulge) -> [f64; 2] {
    let [a, b, c, d] = corners;
    [0, 1].map(|i| {
        let straight = 0.25 * ((a[i] + c[i]) + (b[i] + d[i]));
        straight + 0.5 * ((bulge[0][i] + bulge[1][i]) + (bulge[2][i] + bulge[3][i]))
    })
}

/// The middles of the faces 0 to 3 and of the cell, m.
pub fn middles(cell: &impl Map) -> [[f64; 2]; 5] {
    let bulge = cell.bulge().copied().unwrap_or_default();
    let add = |x: [f64; 2], d: [f64; 2]| [x[0] + d[0], x[1] + d[1]];
    std::array::from_fn(|k| match k {
        4 => add(blended(cell.corners(), &bulge), bulge[4]),
        face => add(chord(cell.corners(), face), bulge[face]),
    })
}

/// That of a cell in a list with one for each cell, or with none; none of a straight cell.
pub fn bulge_in(bulges: &[Bulge], cell: usize) -> Option<Bulge> {
    bulges.get(cell).filter(|bulge| **bulge != Bulge::default()).copied()
}

/// A cell that has a map: its corners alone, which is a straight cell, or a [`CellMap`].
pub trait Map {
    /// Its corners.
    fn corners(&self) -> &Corners;
    /// None of a straight cell.
    fn bulge(&self) -> Option<&Bulge>;
}

impl Map for Corners {
    #[inline]
    fn corners(&self) -> &Corners {
        self
    }

    #[inline]
    fn bulge(&self) -> Option<&Bulge> {
        None
    }
}

impl Map for CellMap {
    #[inline]
    fn corners(&self) -> &Corners {
        &self.corners
    }

    #[inline]
    fn bulge(&self) -> Option<&Bulge> {
        self.bulge.as_ref()
    }
}

/// Parent coordinates of the corners.
pub const CORNER_XI: [[f64; 2]; 4] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];

/// X(xi), in m; exactly the corner at a corner.
pub fn position(cell: &impl Map, xi: [f64; 2]) -> [f64; 2] {
    let [a, b] = xi;
    let weights = [(1.0 - a) * (1.0 - b), a * (1.0 - b), a * b, (1.0 - a) * b];
    let straight = [0, 1].map(|i| (0..4).map(|k| weights[k] * cell.corners()[k][i]).sum());
    match cell.bulge() {
        None => straight,
        Some(bulge) => sum(
            straight,
            bulge,
            [bump(b) * (1.0 - a), bump(b) * a, bump(a) * (1.0 - b), bump(a) * b, bump(a) * bump(b)],
        ),
    }
}

/// b(s) = 4 s (1 - s).
fn bump(s: f64) -> f64 {
    4.0 * s * (1.0 - s)
}

fn sum(x: [f64; 2], bulge: &Bulge, weights: [f64; 5]) -> [f64; 2] {
    [0, 1].map(|i| x[i] + bulge.iter().zip(weights).map(|(d, weight)| weight * d[i]).sum::<f64>())
}

/// The Jacobian matrix `j[alpha][beta]` = dX_alpha / dxi_beta, in m.
pub fn jacobian(cell: &impl Map, xi: [f64; 2]) -> [[f64; 2]; 2] {
    let [x0, x1, x2, x3] = cell.corners();
    let straight: [[f64; 2]; 2] = [0, 1].map(|i| {
        [
            (1.0 - xi[1]) * (x1[i] - x0[i]) + xi[1] * (x2[i] - x3[i]),
            (1.0 - xi[0]) * (x3[i] - x0[i]) + xi[0] * (x2[i] - x1[i]),
        ]
    });
    let Some(bulge) = cell.bulge() else { return straight };
    let ([a, b], slope) = (xi, |s: f64| 4.0 - 8.0 * s);
    let (along1, along2) = ([0, 1].map(|i| straight[i][0]), [0, 1].map(|i| straight[i][1]));
    let one = sum(along1, bulge, [-bump(b), bump(b), slope(a) * (1.0 - b), slope(a) * b, slope(a) * bump(b)]);
    let two = sum(along2, bulge, [slope(b) * (1.0 - a), slope(b) * a, -bump(a), bump(a), bump(a) * slope(b)]);
    [0, 1].map(|i| [one[i], two[i]])
}

/// The determinant of a 2 x 2 matrix.
pub fn determinant(m: &[[f64; 2]; 2]) -> f64 {
    m[0][0] * m[1][1] - m[0][1] * m[1][0]
}

/// The inverse of a 2 x 2 matrix. The inverse of [`jacobian`] is `k[beta][alpha]` = dxi_beta / dX_alpha.
pub fn inverse(m: &[[f64; 2]; 2]) -> [[f64; 2]; 2] {
    let det = determinant(m);
    [[m[1][1] / det, -m[0][1] / det], [-m[1][0] / det, m[0][0] / det]]
}

/// The parent coordinates of a point, by Newton's method with step halving from the middle of the cell.
///
/// They lie outside [0, 1]^2 where the point lies outside the cell. `None` where the iteration finds no solution:
/// for a convex cell this happens only to points outside (beyond the fold of the map).
pub fn parent(cell: &impl Map, x: [f64; 2]) -> Option<[f64; 2]> {
    // Relative to a corner, so that cells far from the origin lose no digits.
    let origin = cell.corners()[0];
    let shift = |x: [f64; 2]| [x[0] - origin[0], x[1] - origin[1]];
    let (corners, x) = (cell.corners().map(shift), shift(x));
    match cell.bulge() {
        None => newton(&corners, x),
        Some(&bulge) => newton(&CellMap { corners, bulge: Some(bulge) }, x),
    }
}

fn newton(cell: &impl Map, x: [f64; 2]) -> Option<[f64; 2]> {
    let gap = |xi: [f64; 2]| {
        let at = position(cell, xi);
        [x[0] - at[0], x[1] - at[1]]
    };
    let (mut xi, mut rest) = ([0.5, 0.5], gap([0.5, 0.5]));
    let mut norm = rest[0].hypot(rest[1]);
    // Quadratic convergence: 4 to 6 steps for ordinary cells; 50 is the limit for the thinnest cells.
    for _ in 0..50 {
        let k = inverse(&jacobian(cell, xi));
        let step = [k[0][0] * rest[0] + k[0][1] * rest[1], k[1][0] * rest[0] + k[1][1] * rest[1]];
        if !(step[0].is_finite() && step[1].is_finite()) {
            return None;
        }
        if step[0].abs().max(step[1].abs()) < 1e-14 {
            return Some([xi[0] + step[0], xi[1] + step[1]]);
        }
        let mut scale = 1.0;
        (xi, rest, norm) = loop {
            let next = [xi[0] + scale * step[0], xi[1] + scale * step[1]];
            let next_rest = gap(next);
            let next_norm = next_rest[0].hypot(next_rest[1]);
            if next_norm < norm {
                break (next, next_rest, next_norm);
            }
            scale *= 0.5;
            // No descent: either the result is exact to rounding (the step is tiny), or the point has no image nearby.
            if scale < 1e-3 {
                return (step[0].abs().max(step[1].abs()) < 1e-9).then_some(xi);
            }
        };
    }
    None
}

/// The height of a cell, m: min over its 4 corners (of a curved cell over 3 x 3 points) of det(dX/dxi) / max(|X_xi1|, |X_xi2|). It is the shorter side of a
/// rectangle.
pub fn height(cell: &impl Map) -> f64 {
    least(cell, |j| determinant(j) / j[0][0].hypot(j[1][0]).max(j[0][1].hypot(j[1][1])))
}

/// The least of a number of dX/dxi at the corners of a cell, and at the middles of a curved one.
fn least(cell: &impl Map, of: impl Fn(&[[f64; 2]; 2]) -> f64) -> f64 {
    let at = |xi| of(&jacobian(cell, xi));
    let corners = CORNER_XI.into_iter().map(at).fold(f64::INFINITY, f64::min);
    let middles = [[0.5, 0.0], [1.0, 0.5], [0.5, 1.0], [0.0, 0.5], [0.5, 0.5]];
    match cell.bulge() {
        None => corners,
        Some(_) => middles.into_iter().map(at).fold(corners, f64::min),
    }
}

/// The length h_e of a cell: min over its 4 corners of 2 det(dX/dxi) / (|X_xi1| + |X_xi2|), in m; of a curved cell over 3 x 3
/// points, with the middles of its edges and its own.
///
/// It is h on squares and 2 hx hy / (hx + hy) on rectangles; the time step, `cfl` and the curl control use it.
pub fn h_e(cell: &impl Map) -> f64 {
    least(cell, |j| 2.0 * determinant(j) / (j[0][0].hypot(j[1][0]) + j[0][1].hypot(j[1][1])))
}

/// The area of a cell, in m^2; negative where its corners run clockwise. Between a chord and its curved edge lie 2/3 of chord x bulge.
pub fn area(cell: &impl Map) -> f64 {
    let [x0, x1, x2, x3] = cell.corners();
    let straight = 0.5 * ((x2[0] - x0[0]) * (x3[1] - x1[1]) - (x3[0] - x1[0]) * (x2[1] - x0[1]));
    let Some(bulge) = cell.bulge() else { return straight };
    // Counter-clockwise.
    let sides = [(x0, x1, bulge[2]), (x1, x2, bulge[1]), (x2, x3, bulge[3]), (x3, x0, bulge[0])];
    let beside = sides.map(|(a, b, d)| (b[0] - a[0]) * d[1] - (b[1] - a[1]) * d[0]);
    straight - beside.iter().sum::<f64>() * 2.0 / 3.0
}

/// J dxi_1/dX and J dxi_2/dX at a place of a cell, m; J = det(dX/dxi).
pub fn cofactors(cell: &impl Map, xi: [f64; 2]) -> [[f64; 2]; 2] {
    let j = jacobian(cell, xi);
    [[j[1][1], -j[0][1]], [-j[1][0], j[0][0]]]
}

/// Where on the parent cell the place s in [0, 1] of a face is.
#[inline]
pub fn on_face(face: usize, s: f64) -> [f64; 2] {
    let end = (face % 2) as f64;
    if face < 2 { [end, s] } else { [s, end] }
}

/// The unit outward normal at a place s in [0, 1] of a face, and |dX/ds| there, m.
pub fn outward(cell: &impl Map, face: usize, s: f64) -> ([f64; 2], f64) {
    let [a, b] = cofactors(cell, on_face(face, s))[face / 2].map(|n| if face.is_multiple_of(2) { -n } else { n });
    let length = a.hypot(b);
    ([a / length, b / length], length)
}

/// The box of points that holds a cell: its corners and, of a curved cell, points beyond the farthest that its edges reach.
pub fn hull<M: Map>(cell: &M) -> impl Iterator<Item = [f64; 2]> + use<M> {
    let corners = *cell.corners();
    // |sum| of the bulge is at most |d| of two opposite faces, the larger of each pair, and that of the middle.
    let reach = cell.bulge().map(|d| {
        let size = |k: usize| d[k][0].hypot(d[k][1]);
        size(0).max(size(1)) + size(2).max(size(3)) + size(4)
    });
    let around = reach.into_iter().flat_map(move |reach| {
        corners.into_iter().flat_map(move |x| [[x[0] - reach, x[1] - reach], [x[0] + reach, x[1] + reach]])
    });
    corners.into_iter().chain(around)
}

#[cfg(test)]
mod tests;
