//! Walls that let go, and obstacles.

use super::{Body, Run, largest};
use dgmpm::Mesh;
use dgmpm::parts::mesh::BoundaryEdge;
use std::collections::HashMap;
use std::f64::consts::PI;

/// A bar of 1 m with c = 1 m/s that flies at -1 mm/s along x, in uniaxial strain.
fn bar(cells: usize, end: f64) -> Body {
    Body::rectangle([1.0, 4.0 / cells as f64], [cells, 4])
        .material("linear-elastic", [1.0, 0.0, 1.0], "")
        .velocity(["-1e-3", "0"])
        .side("bottom", "symmetry", "")
        .side("top", "symmetry", "")
        .method("ader-dgmpm")
        .degree(2)
        .end(end)
}

/// z v of the bar, Pa.
const PUSH: f64 = 1e-3;

#[test]
fn a_bar_leaves_the_wall_after_2_l_over_c_with_its_velocity_the_closer_the_finer_the_mesh() {
    for kind in ["unilateral", "half-plane"] {
        let keys = if kind == "unilateral" { "" } else { "point = [0, 0]\nnormal = [1, 0]" };
        let mut errors = Vec::new();
        for cells in [20, 40] {
            let run = Run::of(bar(cells, 2.5).side("left", kind, keys));
            let height = 4.0 / cells as f64;
            let [touches, leaves] = run.contact(0, PUSH * height);
            // The bounds of the method's design: 1.5 % in time and 2 % in velocity.
            assert!(touches == 0.0 && (leaves / 2.0 - 1.0).abs() < 0.015, "{kind} {cells}: {leaves}");
            let momentum = run.momentum(0);
            let rebound = -momentum.last().unwrap() / momentum[0];
            assert!((0.98..=1.0).contains(&rebound), "{kind} {cells}: {rebound}");
            errors.push(1.0 - rebound);
            let energy = run.ledger.column("total_energy");
            // Never above the start, but for the rounding of a sum over some cells.
            assert!(largest(&energy) <= energy[0] * (1.0 + 1e-13), "{kind}: {:e}", largest(&energy) / energy[0] - 1.0);
        }
        // The front is a jump, whose width of some cells is what is lost: it falls with h to a power of about 3/4.
        assert!(errors[1] < 0.75 * errors[0], "{kind}: {errors:?}");
    }
}

#[test]
fn a_bar_between_two_walls_with_gaps_hits_one_after_the_other() {
    // At the left wall at once, away from it at 2 s; through the gap of .3 mm at the right at 2.3 s, away from there at 4.3 s; and back.
    let body = bar(40, 5.0).side("left", "unilateral", "").side("right", "unilateral", "gap = 3e-4");
    let run = Run::of(body);
    let [touches, leaves] = run.contact(0, -PUSH * 0.1);
    // Half of the force: fronts of some cells of 1/40, and the velocity after the first impact is 1 % too low.
    assert!((touches - 2.3).abs() < 0.03 && (leaves - 4.3).abs() < 0.03, "{touches} {leaves}");
    let [_, again] = run.contact(0, PUSH * 0.1);
    // The left wall is reached once more at 4.6 s.
    assert!((again - 5.0).abs() < 0.01, "{again}");
    let energy = run.ledger.column("total_energy");
    assert!(largest(&energy) <= energy[0] * (1.0 + 1e-13));
}

/// A rod of 10 in (1 in x 1 in) flies at 202.2 in/s through a gap of .01 in: contact at 4.946e-5 s, release at 1.4812e-4 s, 29922 lbf.
#[test]
fn a_rod_meets_a_wall_behind_a_gap_and_leaves_it_when_and_as_hard_as_it_should() {
    const INCH: f64 = 0.0254;
    const PSI: f64 = 6894.757293168;
    let (young, speed, c) = (3e7 * PSI, 202.2 * INCH, 202721.0 * INCH);
    let velocity = format!("{}", -speed);
    let body = Body::rectangle([10.0 * INCH, INCH], [40, 4])
        .material("linear-elastic", [young, 0.0, young / (c * c)], "")
        .velocity([&velocity, "0"])
        .side("left", "unilateral", &format!("gap = {}", 0.01 * INCH))
        .method("ader-dgmpm")
        .degree(2)
        .end(1.6e-4);
    let run = Run::of(body);
    let force = 29922.0 * 4.4482216152605 / INCH;
    let [touches, leaves] = run.contact(0, force);
    assert!(
        (touches / 4.946e-5 - 1.0).abs() < 0.01 && (leaves / 1.4812e-4 - 1.0).abs() < 0.01,
        "{touches:e} {leaves:e}"
    );
    // The mean of the plateau, away from its ends.
    let (all, t) = (run.force(0), run.times());
    let plateau: Vec<f64> = (0..all.len()).filter(|&k| (6e-5..1.4e-4).contains(&t[k])).map(|k| all[k]).collect();
    let mean = plateau.iter().sum::<f64>() / plateau.len() as f64;
    assert!((mean / force - 1.0).abs() < 0.01, "{mean:e} {force:e}");
    let energy = run.ledger.column("total_energy");
    assert!(largest(&energy) <= energy[0] * (1.0 + 1e-13));
}

/// A disc of radius 1 m around the origin: a square of n x n cells in its middle, and n/2 layers around it.
fn disc(n: usize) -> Mesh {
    let mut mesh = Mesh { groups: vec!["body".to_owned()], edge_groups: vec!["edge".to_owned()], ..Mesh::default() };
    let mut known = HashMap::new();
    let mut node = |mesh: &mut Mesh, x: [f64; 2]| {
        let key = x.map(|x| (x * 1e9).round() as i64);
        *known.entry(key).or_insert_with(|| {
            mesh.nodes.push(x);
            mesh.nodes.len() - 1
        })
    };
    let core = |i: usize, j: usize| {
        let [s, t] = [i, j].map(|k| 2.0 * k as f64 / n as f64 - 1.0);
        [0.45 * s * (1.0 + 0.15 * (1.0 - t * t)), 0.45 * t * (1.0 + 0.15 * (1.0 - s * s))]
    };
    let layer = |side: usize, k: usize, r: usize| {
        let inner = [core(n, k), core(n - k, n), core(0, n - k), core(k, 0)][side];
        let angle = PI * (side as f64 / 2.0 + 0.5 * k as f64 / n as f64 - 0.25);
        let w = 2.0 * r as f64 / n as f64;
        [(1.0 - w) * inner[0] + w * angle.cos(), (1.0 - w) * inner[1] + w * angle.sin()]
    };
    let around = [[0, 0], [1, 0], [1, 1], [0, 1]];
    for (i, j) in (0..n * n).map(|k| (k % n, k / n)) {
        let cell = around.map(|[a, b]| node(&mut mesh, core(i + a, j + b)));
        mesh.cells.push(cell);
    }
    for (side, k, r) in (0..2 * n * n).map(|q| (q / (n * n / 2), (q / (n / 2)) % n, q % (n / 2))) {
        let cell = around.map(|[a, b]| node(&mut mesh, layer(side, k + b, r + a)));
        mesh.cells.push(cell);
        if r + 1 == n / 2 {
            mesh.edges.push(BoundaryEdge { cell: mesh.cells.len() - 1, face: 1, group: 0 });
        }
    }
    mesh.cell_group = vec![0; mesh.cells.len()];
    mesh.original = (1..=mesh.cells.len() as u64).collect();
    mesh
}

/// Duration of the contact of a soft disc that falls at 1 m/s on an obstacle, s, as (int F dt)^2 / int F^2 dt, which is the duration of a constant
/// force; and the share of its momentum afterwards.
fn impact(n: usize, kind: &str, keys: &str) -> (f64, f64) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("disc.msh");
    dgmpm::parts::io::write_mesh(&path, &disc(n)).unwrap();
    let body = Body::of_file(&path)
        .material("neo-hookean", [1e6, 0.3, 1000.0], "")
        .velocity(["0", "-1"])
        .side("edge", kind, keys)
        .method("ader-dgmpm")
        .degree(2)
        .end(0.23);
    let run = Run::with_row_every(5, body);
    let energy = run.ledger.column("total_energy");
    assert!(largest(&energy) <= energy[0] * (1.0 + 1e-13), "{kind} {n}: {:e}", largest(&energy) / energy[0] - 1.0);
    let (force, t) = (run.force(1), run.times());
    let sum = |power: i32| (0..force.len()).map(|k| force[k].powi(power) * (t[k + 1] - t[k])).sum::<f64>();
    let momentum = run.momentum(1);
    // Symmetry: nothing along x, to the rounding of forces of 5e4 N/m over .2 s.
    assert!(run.momentum(0).iter().all(|p| p.abs() < 1e-8 * momentum[0].abs()));
    (sum(1).powi(2) / sum(2), -momentum.last().unwrap() / momentum[0])
}

#[test]
fn the_contact_of_a_disc_with_a_half_plane_lasts_the_same_on_finer_and_finer_meshes() {
    let all = [4, 8, 12].map(|n| impact(n, "half-plane", "point = [0, -1]\nnormal = [0, 1]"));
    let [a, b, c] = all.map(|(time, _)| time);
    // Found: .1656, .1620, .1630 s; the boundary is a polygon, so the differences fall by 4 at best.
    assert!((c - b).abs() < 0.5 * (b - a).abs() && (c / b - 1.0).abs() < 0.01, "{all:?}");
    // Found: .953, .976, .978: some of the energy stays in vibrations, and the mesh loses less and less.
    assert!(all[2].1 > 0.97 && all[2].1 > all[0].1, "{all:?}");
}

#[test]
fn a_large_disc_and_a_large_square_are_half_planes() {
    let [plane, ..] = [impact(4, "half-plane", "point = [0, -1]\nnormal = [0, 1]")];
    let square = impact(4, "polygon", "corners = [[-9, -9], [9, -9], [9, -1], [-9, -1]]");
    // The same positions but for rounding, which shifts a contact by a step at most.
    assert!((square.0 / plane.0 - 1.0).abs() < 2e-3 && (square.1 - plane.1).abs() < 1e-3, "{square:?} {plane:?}");
    let round = impact(4, "disc", "centre = [0, -1001]\nradius = 1000");
    // The contact is .6 m wide: .3^2/2000 = 5e-5 m further away at its ends, 1e-3 of the penetration.
    assert!((round.0 / plane.0 - 1.0).abs() < 5e-3 && (round.1 - plane.1).abs() < 2e-3, "{round:?} {plane:?}");
}

#[test]
fn an_obstacle_that_moves_does_what_it_does_to_a_body_that_moves() {
    let keys = "point = [0, -1]\nnormal = [0, 1]";
    let moving = format!("{keys}\nvelocity = [0, 1]");
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("disc.msh");
    dgmpm::parts::io::write_mesh(&path, &disc(4)).unwrap();
    let body = |velocity: &str, keys: &str| {
        Body::of_file(&path)
            .material("neo-hookean", [1e6, 0.3, 1000.0], "")
            .velocity(["0", velocity])
            .side("edge", "half-plane", keys)
            .method("ader-dgmpm")
            .degree(1)
            .end(0.1)
    };
    let [still, pushed] = [body("-1", keys), body("0", &moving)].map(Run::of);
    let [a, b] = [still.momentum(1), pushed.momentum(1)];
    let mass = -a[0];
    // Galilei: the momentum differs by that of the frame. The step follows the wave speed, which is the same; rounding may shift a point's contact by
    // a step.
    assert!(((b.last().unwrap() - a.last().unwrap()) / mass - 1.0).abs() < 1e-3, "{a:?} {b:?}");
    // And its work is the energy that the body has, and what is lost.
    let energy = pushed.accounted();
    assert!(
        *energy.last().unwrap() <= 1e-9 * mass && pushed.ledger.column("boundary_work").last().unwrap() > &(0.5 * mass)
    );
}

#[test]
fn a_spike_and_a_disc_between_the_points_of_a_side_hold_the_body_and_never_make_energy() {
    // A square of .6 m of 5 x 5 cells, points 3 to 5 cm apart, falls at 10 m/s on what is finer.
    for (name, kind, keys) in [
        ("spike", "polygon", "corners = [[0.28, 0], [0.68, 0], [0.475, 0.5]]"),
        ("disc", "disc", "centre = [0.475, 0.49]\nradius = 0.01"),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("square.msh");
        let mut mesh = dgmpm::rectangle([0.6, 0.6], [5, 5]).unwrap();
        mesh.nodes.iter_mut().for_each(|x| *x = [x[0] + 0.2, x[1] + 0.501]);
        dgmpm::parts::io::write_mesh(&path, &mesh).unwrap();
        let body = Body::of_file(&path)
            .material("neo-hookean", [1e7, 0.3, 1000.0], "")
            .velocity(["0", "-10"])
            .sides("free")
            .side("bottom", kind, keys)
            .method("ader-dgmpm")
            .degree(2)
            .end(5e-3);
        let run = Run::of(body);
        let energy = run.accounted();
        assert!(largest(&energy) <= energy[0] * (1.0 + 1e-12), "{name}: {:e}", largest(&energy) / energy[0] - 1.0);
        // At rest it does no work: roundings of the forces of some 1e6 N/m.
        let work = run.ledger.column("boundary_work");
        assert!(work.iter().all(|work| work.abs() < 1e-9 * energy[0]), "{name}");
        // Unseen, momentum stays as it was (for the spike until a point meets its flank); held, a wave has come from the top by now.
        let momentum = run.momentum(1);
        let left = momentum.last().unwrap() / momentum[0];
        assert!(left < 0.9, "{name}: {left}");
    }
}

/// A block of 10 x 5 cells of 12 cm that falls at 3 m/s on a disc of 4 cm, at rest, whose top it touches at x.
fn on_a_small_disc(x: f64) -> Run {
    let body = Body::rectangle([1.2, 0.6], [10, 5])
        .material("neo-hookean", [1e6, 0.3, 1000.0], "")
        .velocity(["0", "-3"])
        .sides("free")
        .side("bottom", "disc", &format!("centre = [{x}, -0.045]\nradius = 0.04"))
        .method("ader-dgmpm")
        .degree(2)
        .end(0.15);
    Run::with_row_every(20, body)
}

#[test]
fn a_disc_smaller_than_a_cell_holds_a_body_where_two_sides_join_as_in_the_middle_of_a_side() {
    // At the node between two sides, beside it, and in the middle of a side.
    for x in [0.6, 0.61, 0.66] {
        let run = on_a_small_disc(x);
        let momentum = run.momentum(1);
        let rebound = -momentum.last().unwrap() / momentum[0];
        // Where it went through, .9 of the momentum was still downward. In the middle it leaves with .6.
        assert!(rebound > 0.3, "{x}: {rebound}");
        let energy = run.accounted();
        // Crushed cells make a little: the middle of a side made 2e-4 before, too.
        assert!(largest(&energy) <= energy[0] * (1.0 + 1e-12), "{x}: {:e}", largest(&energy) / energy[0] - 1.0);
    }
}

#[test]
fn a_square_that_spins_on_a_wall_with_friction_makes_no_energy_on_the_points_of_the_defaults() {
    // With the points of the paper, the default of other scenes, it made 13 % and more.
    let body = Body::rectangle([1.0, 1.0], [8, 8])
        .material("neo-hookean", [1e6, 0.3, 1000.0], "")
        .velocity(["-6*(y - 0.5)", "6*(x - 0.5) - 2"])
        .sides("free")
        .side("bottom", "unilateral", "friction = 0.5")
        .method("ader-dgmpm")
        .degree(2)
        .end(0.2);
    let run = Run::with_row_every(10, body);
    let energy = run.accounted();
    // The watch over the energy warns from 1e-3 on.
    assert!(largest(&energy) <= energy[0] * (1.0 + 1e-3), "{:e}", largest(&energy) / energy[0] - 1.0);
}
