//! J below 0 is found wherever it is looked at, and named by its place; a state from outside and one from a step alike.
use super::*;
use crate::cloud::{Cloud, seed};
use crate::mesh::{Mesh, rectangle};
use crate::step::Speeds;
use crate::step::tests::{KINDS, Kind, distorted, midpoints, scheme, state, unpacked, wall, wavy};
use crate::step::{Survey, Work};

/// Four lines of points a direction, at 1/8, 3/8, .. of a cell: none at a node of degree 2 (.113, .5, .887).
fn cloud(mesh: &Mesh) -> Cloud {
    seed::seed(seed::Layout::Midpoints, 4, mesh.cells.len())
}

/// F11 at the nodes of degree 2 of a cell, F22 being 1: J is below 0 in one kind of places.
type Sick = [f64; 9];

/// At the middle node (-.01); at points not nearer than 1/8 it is above .19.
const AT_NODE: Sick = [1.0, 1.0, 1.0, 1.0, -0.01, 1.0, 1.0, 1.0, 1.0];

/// .05 + 1.1613 (x - .1127) along xi1: -.081 at the face 0, .05 at the first line of nodes, .064 at that of points.
const AT_FACE: Sick = [0.05, 0.05, 0.05, 0.5, 0.5, 0.5, 0.95, 0.95, 0.95];

/// 20 (x - .115) (x - .4) along xi1: above 0 at faces (.92) and nodes (.013, .77, 7.5), -.055 and -.13 at points.
fn at_points() -> Sick {
    let nodes = [0.112_701_665, 0.5, 0.887_298_335];
    std::array::from_fn(|a| 20.0 * (nodes[a / 3] - 0.115) * (nodes[a / 3] - 0.4))
}

/// At rest but for one cell.
fn lost_in(mesh: &Mesh, scheme: &Scheme, cell: usize, sick: &Sick) -> State {
    state(mesh, scheme, |_, a| [if a / 9 == cell { sick[a % 9] } else { 1.0 }, 0.0, 0.0, 1.0, 0.0, 0.0])
}

fn surveyed(scheme: &Scheme, state: &State) -> Result<Survey, Loss> {
    let mut survey = Survey::default();
    scheme.survey_all(state, &Work::new(scheme, state), &mut survey).map(|()| survey)
}

#[test]
fn j_below_0_is_found_at_points_nodes_and_faces_and_named() {
    let mesh = rectangle([1.0, 1.0], [3, 3]).unwrap();
    let scheme = scheme(&mesh, Kind::AderDgmpm, 2, &cloud(&mesh), wall);
    // Cell 8 stands alone in the second block: the lanes beside it are padding.
    for cell in [0, 5, 8] {
        let of = |sick: &Sick| surveyed(&scheme, &lost_in(&mesh, &scheme, cell, sick)).unwrap_err();
        let [node, face, point] = [of(&AT_NODE), of(&AT_FACE), of(&at_points())];
        assert_eq!((node.cell, face.cell, point.cell), (cell, cell, cell));
        assert_eq!(node.site, Site::Node(4));
        assert!(matches!(face.site, Site::Face(0, _)), "{face:?}");
        assert!(matches!(point.site, Site::Point(4..8)), "{point:?}");
        // The nodes of degree 2 to three digits; what stands above.
        let near = |loss: Loss, j: f64| matches!(loss.kind, LossKind::Inverted(found) if (found - j).abs() < 1e-3);
        assert!(near(node, -0.01) && near(face, -0.0809) && near(point, -0.13), "{node:?} {face:?} {point:?}");
        let [x, y] = scheme.position_of(cell, face.site);
        assert!((3.0 * x - (cell % 3) as f64).abs() < 1e-12 && y < 1.0);
    }
}

#[test]
fn a_step_from_a_state_with_j_below_0_at_a_face_is_lost_there_by_all_methods() {
    let mesh = rectangle([1.0, 1.0], [3, 3]).unwrap();
    for kind in KINDS {
        let scheme = scheme(&mesh, kind, 2, &cloud(&mesh), wall);
        let state = lost_in(&mesh, &scheme, 8, &AT_FACE);
        let mut work = Work::new(&scheme, &state);
        let survey = Survey {
            speed: vec![Speeds { fastest: F8::splat(1.5), ..Speeds::default() }; 2],
            fastest: 1.5,
            min_j: 1.0,
        };
        // So short a step that averages over it are the state to 1e-6.
        scheme.step(&state, 1e-7, &survey, &mut work);
        let loss = scheme.surveyed(&mut work, &mut Survey::default()).unwrap_err();
        assert!(matches!(loss, Loss { cell: 8, site: Site::Face(0, _), .. }), "{kind:?} {loss:?}");
    }
}

#[test]
fn min_j_is_the_smallest_at_points_nodes_and_faces_whatever_finds_it() {
    let mesh = distorted(3);
    for kind in KINDS {
        for degree in [1, 2, 3] {
            let scheme = scheme(&mesh, kind, degree, &midpoints(&mesh, degree), wall);
            let state = state(&mesh, &scheme, wavy);
            let (m, n) = (degree + 1, (degree + 1).pow(2));
            let cells = unpacked(&scheme, &state);
            let at = |cell: usize, xi: [f64; 2]| {
                let phi = scheme.operators.line.basis.values_2d(xi);
                let f = [0, 1, 2, 3].map(|k| (0..n).map(|a| phi[a] * cells[(cell * 6 + k) * n + a]).sum());
                tensor::det::<f64>(f)
            };
            let mut smallest = f64::INFINITY;
            for cell in 0..9 {
                let (block, lane) = scheme.operators.blocks.slot[cell];
                let points = (0..scheme.operators.places(block, lane).len()).map(Site::Point);
                let faces = (0..4 * m).map(|k| Site::Face(k / m, k % m));
                for site in points.chain((0..n).map(Site::Node)).chain(faces) {
                    smallest = smallest.min(at(cell, scheme.parent_of(block, lane, site)));
                }
            }
            let survey = surveyed(&scheme, &state).unwrap();
            // Sums of up to 16 products of numbers of size 1.
            assert!((survey.min_j - smallest).abs() < 1e-13, "{kind:?} {degree}: {} {smallest}", survey.min_j);
            // A step finds it again, from its traces and what it makes: so short a step changes nothing beyond 1e-6.
            let (mut work, mut after) = (Work::new(&scheme, &state), Survey::default());
            scheme.step(&state, 1e-7, &survey, &mut work);
            scheme.surveyed(&mut work, &mut after).unwrap();
            assert!((after.min_j - smallest).abs() < 1e-6, "{kind:?} {degree}: {} {smallest}", after.min_j);
        }
    }
}
