//! Whether a mesh may be one of the body that a run begins with, by what is seen at once: its area and its centre. The transfer looks
//! closely, at the time of the regrid.

use crate::mesh::Mesh;
use crate::regrid::LARGEST_DIFFERENCE;

/// In words what differs; none where the mesh may be of the same body.
pub(super) fn difference(mesh: &Mesh, first: &Mesh) -> Option<String> {
    let [(area, centre), (wanted, middle)] = [moments(mesh), moments(first)];
    if (area - wanted).abs() > LARGEST_DIFFERENCE * wanted {
        return Some(format!("its area is {area:e} m^2, and that of the body is {wanted:e} m^2"));
    }
    // A share of the area that is elsewhere moves the centre by at most this share of the width of the body, twice.
    let most = 2.0 * LARGEST_DIFFERENCE * width(first);
    let apart = (centre[0] - middle[0]).hypot(centre[1] - middle[1]);
    let [[a, b], [c, d]] = [centre, middle];
    (apart > most).then(|| format!("its centre is ({a:.4}, {b:.4}), and that of the body is ({c:.4}, {d:.4})"))
}

/// Area, m^2, and centre, by the triangles that the edges of the cells make with a point of the mesh.
fn moments(mesh: &Mesh) -> (f64, [f64; 2]) {
    let origin = mesh.nodes.first().copied().unwrap_or_default();
    let (mut twice, mut sum) = (0.0, [0.0; 2]);
    for cell in 0..mesh.cells.len() {
        let corners = mesh.corners(cell).map(|x| [x[0] - origin[0], x[1] - origin[1]]);
        for k in 0..corners.len() {
            let (a, b) = (corners[k], corners[(k + 1) % corners.len()]);
            let cross = a[0] * b[1] - a[1] * b[0];
            twice += cross;
            sum = [0, 1].map(|axis| sum[axis] + cross * (a[axis] + b[axis]) / 3.0);
        }
    }
    (0.5 * twice, [0, 1].map(|axis| origin[axis] + sum[axis] / twice))
}

/// The diagonal of the box around a mesh, m.
fn width(mesh: &Mesh) -> f64 {
    let range = |axis: usize| {
        let all = mesh.nodes.iter().map(|x| x[axis]);
        all.clone().fold(f64::NEG_INFINITY, f64::max) - all.fold(f64::INFINITY, f64::min)
    };
    range(0).hypot(range(1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::rectangle;

    #[test]
    fn another_size_or_place_is_seen_and_other_cells_are_not() {
        let first = rectangle([1.0, 0.5], [4, 2]).unwrap();
        assert_eq!(difference(&rectangle([1.0, 0.5], [3, 5]).unwrap(), &first), None);
        let larger = difference(&rectangle([2.0, 1.0], [2, 2]).unwrap(), &first).unwrap();
        assert!(larger.contains("its area is 2e0 m^2"), "{larger}");
        let turned = difference(&rectangle([0.5, 1.0], [2, 2]).unwrap(), &first).unwrap();
        assert!(turned.contains("its centre is (0.2500, 0.5000)"), "{turned}");
        let mut moved = first.clone();
        moved.nodes.iter_mut().for_each(|x| x[0] += 10.0);
        assert!(difference(&moved, &first).is_some());
    }
}
