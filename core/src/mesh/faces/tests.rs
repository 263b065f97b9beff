use super::*;
use crate::mesh::{BoundaryEdge, rectangle};

/// The cells of `b` beside those of `a`, nodes not merged; groups by the indices of `a`.
fn beside(a: &Mesh, b: &Mesh, shift: [f64; 2]) -> Mesh {
    let (nodes, cells) = (a.nodes.len(), a.cells.len());
    let mut both = a.clone();
    both.nodes.extend(b.nodes.iter().map(|x| [x[0] + shift[0], x[1] + shift[1]]));
    both.cells.extend(b.cells.iter().map(|cell| cell.map(|node| node + nodes)));
    both.cell_group.extend(&b.cell_group);
    both.edges.extend(b.edges.iter().map(|e| BoundaryEdge { cell: e.cell + cells, ..*e }));
    both.original = (1..=both.cells.len() as u64).collect();
    both
}

fn without(mut mesh: Mesh, group: usize) -> Mesh {
    mesh.edges.retain(|e| e.group != group);
    mesh
}

#[test]
fn a_rectangle_links_neighbours_without_flips_and_boundaries_by_group() {
    let links = links(&rectangle([3.0, 2.0], [3, 2]).unwrap()).unwrap();
    assert_eq!(links[1][0], Link::Cell { cell: 0, face: 1, flip: false });
    assert_eq!(links[1][1], Link::Cell { cell: 2, face: 0, flip: false });
    assert_eq!(links[1][2], Link::Boundary(2));
    assert_eq!(links[1][3], Link::Cell { cell: 4, face: 2, flip: false });
    assert_eq!(links[5][1], Link::Boundary(1));
}

#[test]
fn links_are_mutual_and_flips_agree_with_coordinates_when_cells_are_turned() {
    let mut mesh = rectangle([4.0, 3.0], [4, 3]).unwrap();
    for cell in 0..mesh.cells.len() {
        mesh.cells[cell].rotate_left((7 * cell + cell / 3) % 4);
    }
    // Turned cells have other local faces: tag every free edge anew.
    let free: Vec<_> =
        sorted_faces(&mesh).chunk_by(|a, b| a.nodes == b.nodes).filter(|s| s.len() == 1).map(|s| s[0]).collect();
    mesh.edges = free.iter().map(|f| BoundaryEdge { cell: f.cell, face: f.face, group: 0 }).collect();
    let links = links(&mesh).unwrap();
    let mut flips = 0;
    for (cell, faces) in links.iter().enumerate() {
        for (face, link) in faces.iter().enumerate() {
            if let Link::Cell { cell: other, face: their, flip } = *link {
                assert_eq!(links[other][their], Link::Cell { cell, face, flip });
                let (mine, mut theirs) = (mesh.face_nodes(cell, face), mesh.face_nodes(other, their));
                if flip {
                    theirs.reverse();
                    flips += 1;
                }
                assert_eq!(mine, theirs);
            }
        }
    }
    assert!(flips > 0);
}

#[test]
fn untagged_edges_are_counted_and_the_first_is_named() {
    let error = links(&without(rectangle([3.0, 2.0], [3, 2]).unwrap(), 3)).unwrap_err();
    assert_eq!(error, Error::Untagged { count: 3, at: [[0.0, 2.0], [1.0, 2.0]], cell: 4 });
    assert!(error.remedy().contains("Physical Curve"));
}

#[test]
fn a_tagged_edge_between_two_cells_is_ignored() {
    let mut mesh = rectangle([2.0, 1.0], [2, 1]).unwrap();
    let expected = links(&mesh).unwrap();
    mesh.edges.push(BoundaryEdge { cell: 0, face: 1, group: 0 });
    assert_eq!(links(&mesh).unwrap(), expected);
}

#[test]
fn an_edge_in_two_groups_is_refused_and_one_named_twice_is_not() {
    let mut mesh = rectangle([2.0, 1.0], [2, 1]).unwrap();
    mesh.edges.push(mesh.edges[0]);
    assert!(links(&mesh).is_ok());
    mesh.edges.push(BoundaryEdge { group: 3, ..mesh.edges[0] });
    let error = links(&mesh).unwrap_err();
    assert!(error.to_string().contains("`left` and `top`"), "{error}");
}

#[test]
fn three_cells_on_one_edge_are_refused() {
    let mut mesh = rectangle([2.0, 1.0], [2, 1]).unwrap();
    mesh.cells.push(mesh.cells[1]);
    mesh.cell_group.push(0);
    mesh.original.push(3);
    assert!(matches!(links(&mesh), Err(Error::Crowded { cells, .. }) if cells == [1, 2, 3]));
}

#[test]
fn nodes_in_one_place_are_refused_where_an_edge_there_has_no_group() {
    let square = rectangle([1.0, 1.0], [2, 2]).unwrap();
    // Rounding between the two sides must not hide them.
    let mesh = beside(&without(square.clone(), 1), &without(square, 0), [1.0 + 1e-13, 0.0]);
    let error = links(&mesh).unwrap_err();
    assert!(matches!(error, Error::Duplicate { count: 3, cells: [2, 5], .. }), "{error}");
}

#[test]
fn two_bodies_in_contact_may_have_nodes_in_one_place_when_both_sides_bear_groups() {
    let square = rectangle([1.0, 1.0], [2, 2]).unwrap();
    let links = links(&beside(&square, &square, [1.0, 0.0])).unwrap();
    assert_eq!((links[1][1], links[4][0]), (Link::Boundary(1), Link::Boundary(0)));
}

#[test]
fn bodies_that_lie_upon_each_other_are_refused() {
    let square = rectangle([1.0, 1.0], [2, 2]).unwrap();
    // Only the node in the middle is inside of both.
    assert!(matches!(links(&beside(&square, &square, [0.0, 0.0])), Err(Error::Duplicate { count: 1, .. })));
}

#[test]
fn a_hanging_node_is_refused_with_edge_and_both_cells() {
    let (coarse, fine) = (rectangle([1.0, 1.0], [1, 1]).unwrap(), rectangle([1.0, 1.0], [2, 2]).unwrap());
    let mut mesh = beside(&without(coarse, 1), &without(fine, 0), [1.0, 0.0]);
    // Merge the two shared corners, so that only the node in the middle is wrong.
    for cell in &mut mesh.cells {
        *cell = cell.map(|node| match node {
            4 => 1,
            10 => 3,
            node => node,
        });
    }
    let error = links(&mesh).unwrap_err();
    assert!(
        matches!(error, Error::Hanging { at: [1.0, 0.5], owner: 2, edge: [[1.0, 0.0], [1.0, 1.0]], cell: 1 }),
        "{error}"
    );
}

#[test]
fn scales_and_offsets_do_not_matter() {
    for (scale, offset) in [(1e-6, 0.0), (1e6, 0.0), (1e-3, 1e3)] {
        let mut mesh = rectangle([1.0, 1.0], [4, 4]).unwrap();
        mesh.nodes.iter_mut().for_each(|x| *x = x.map(|x| scale * x + offset));
        assert!(links(&mesh).is_ok(), "{scale} {offset}");
    }
}
