//! Where velocity has a steep front.

use super::Present;
use crate::observe::Solution;

/// Cells within which velocity varies by more than a share of its range over the body.
pub fn fronts(present: &Present, share: f64) -> Vec<usize> {
    let solution = Solution::of_state(present.view.scheme, present.view.state, present.material);
    let n = present.view.scheme.operators.nodes();
    let range = |cells: &mut dyn Iterator<Item = usize>| {
        let mut range = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
        for cell in cells {
            let (start, density) = (cell * solution.components * n, solution.law(cell).density());
            for (k, range) in range.iter_mut().enumerate() {
                for p in &solution.u[start + (4 + k) * n..start + (5 + k) * n] {
                    *range = [range[0].min(p / density), range[1].max(p / density)];
                }
            }
        }
        (range[0][1] - range[0][0]).max(range[1][1] - range[1][0])
    };
    let cells = present.view.mesh.cells.len();
    let whole = range(&mut (0..cells));
    // Uniform motion has no front but rounding.
    let speed = present.view.survey.fastest;
    (0..cells).filter(|&cell| whole > 1e-12 * speed && range(&mut std::iter::once(cell)) > share * whole).collect()
}
