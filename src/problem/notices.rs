//! What is no error and yet seldom meant: parts that do not see each other, groups inside of the body, numbers that look like
//! other units.

use super::{Cost, Problem, source_notices};
use crate::mesh::parts::{EdgeCount, Part, parts};
use crate::mesh::{BoundaryEdge, Link, Mesh};
use crate::operators::{Blocks, Certificate, Neighbour};
use crate::scene::{Scene, When};
use crate::state::State;
use crate::step::{DeepestOverlap, Scheme, Survey, cfl};
use std::collections::HashMap;

/// Parts that a list names before it only counts.
const NAMED: usize = 4;

/// A body that is longer than this, m, was probably drawn in mm.
const LONG: f64 = 1000.0;

/// The notices of a mesh alone.
pub fn of_mesh(mesh: &Mesh, links: &[[Link; 4]]) -> Vec<String> {
    let behind = |cell: usize| links[cell].iter().filter_map(Link::cell);
    let mut all: Vec<String> = in_parts(mesh, &parts(mesh.cells.len(), behind)).into_iter().collect();
    all.extend(partly_inside(mesh, &mesh.edge_counts(), "these need a group of their own to have a condition"));
    all.extend(large(mesh));
    all
}

/// An overlap at the start from this share of a cell on is said: less is the rounding of a mesh file.
const STARTS_APART: f64 = 1e-6;

/// The notices before a run: those of its mesh, whose periodic boundaries connect, and of its start and first step, s.
pub fn of_run(problem: &Problem, cost: &Cost) -> Vec<String> {
    let Problem { scene, body, scheme, state, .. } = problem;
    let Cost { survey, steps, dt, .. } = cost;
    let (mesh, blocks) = (&body.mesh, &scheme.operators.blocks);
    let meet = meeting(scheme);
    let near = |cell: usize| behind(blocks, cell).into_iter().chain(meet.get(&cell).into_iter().flatten().copied());
    let mut all: Vec<String> = in_parts(mesh, &parts(mesh.cells.len(), near)).into_iter().collect();
    // Along groups with a condition the mesh has been cut.
    all.extend(partly_inside(mesh, &mesh.edge_counts(), "these have no [[boundary]] and are free"));
    all.extend(cuts(scene, mesh));
    all.extend(overlap(scheme, state));
    all.extend(in_obstacles(scene, mesh, scheme, state));
    all.extend(large(mesh));
    all.extend(scene.notice_of_fields(mesh));
    all.extend(fast_start(mesh, scheme, state, survey));
    all.extend(fast_boundary(scene, mesh, scheme));
    all.extend(thin(mesh, blocks, scene.scheme.degree));
    all.extend(slow_cells(mesh, &cost.certificates));
    all.extend(flat_cells(problem, *dt, survey));
    all.extend(short(scene, *dt));
    all.extend(other_springs(problem));
    all.extend(source_notices::of_sources(problem, *dt));
    let notice = scene.curl.build().notice;
    all.extend((!notice.is_empty()).then(|| notice.to_owned()));
    if *steps <= 1.0 {
        all.push(format!(
            "the run is one step: it ends {:.3e} s after its start, and a step is {dt:.3e} s; times are in s, moduli in Pa, \
             densities in kg/m^3, lengths in m",
            scene.end - state.time
        ));
    }
    all
}

/// The notice on ADER of a degree that grows at any step; none for other methods and degrees.
pub fn of_growth(problem: &Problem, cost: &Cost) -> Option<String> {
    let degree = problem.scene.scheme.degree;
    let growth = cfl::growth(&problem.scheme.method, degree)?;
    Some(format!(
        "ADER of degree {degree} grows weakly at any dt: {growth:.0e} a step, a factor of {:.3} over this run",
        (growth * cost.steps).exp()
    ))
}

/// Cells that may act on each other across a gap, by cell.
fn meeting(scheme: &Scheme) -> HashMap<usize, Vec<usize>> {
    let mut all: HashMap<usize, Vec<usize>> = HashMap::new();
    for cells in scheme.cells_that_meet() {
        for pair in cells.windows(2) {
            all.entry(pair[0]).or_default().push(pair[1]);
            all.entry(pair[1]).or_default().push(pair[0]);
        }
    }
    all
}

/// A word on bodies that overlap at the start.
fn overlap(scheme: &Scheme, state: &State) -> Option<String> {
    let DeepestOverlap { depth, share, x: [x, y] } =
        scheme.overlap(state).filter(|overlap| overlap.share > STARTS_APART)?;
    Some(format!(
        "bodies in contact overlap by {depth:.3e} m at the start, {:.0} % of a cell, at ({x:.4}, {y:.4}): they will be pushed apart",
        100.0 * share
    ))
}

/// A word on each group that lies in its obstacle at the start.
fn in_obstacles(scene: &Scene, mesh: &Mesh, scheme: &Scheme, state: &State) -> Vec<String> {
    let found = scheme.points_in_obstacles(state).into_iter();
    let deep = found.filter(|(_, _, _, deepest)| deepest.share > STARTS_APART);
    let text = |(group, count, of, DeepestOverlap { depth, share, x: [x, y] }): (
        usize,
        usize,
        usize,
        DeepestOverlap,
    )| {
        let name = &mesh.edge_groups[group];
        let kind =
            scene.boundaries.iter().find(|own| own.group == *name).map_or("obstacle", |own| own.condition.name());
        format!(
            "{count} of {of} points of group \"{name}\" lie in their {kind} at the start, the deepest by {depth:.3e} m, {:.0} % of a cell, at ({x:.4}, {y:.4}): an obstacle \
             does not push out what lies in it, and holds only faces that look into it; move the obstacle or the body apart",
            100.0 * share
        )
    };
    deep.map(text).collect()
}

/// A word on each group with a condition along which the body is cut.
fn cuts(scene: &Scene, mesh: &Mesh) -> Vec<String> {
    let has_condition = |group: &str| scene.boundaries.iter().any(|boundary| boundary.groups().any(|own| own == group));
    let text = |(group, EdgeCount { inner, boundary }): (usize, EdgeCount)| {
        let name = &mesh.edge_groups[group];
        let more =
            if boundary > 0 { format!(", and {boundary} edge(s) at one side of the body only") } else { String::new() };
        (inner > 0 && has_condition(name)).then(|| {
            format!(
                "the condition of `{name}` cuts the body along {inner} edge(s), of which both sides are boundary{more}"
            )
        })
    };
    mesh.cut_counts().into_iter().enumerate().filter_map(text).collect()
}

/// The cells behind the faces of a cell.
fn behind(blocks: &Blocks, cell: usize) -> Vec<usize> {
    let (block, lane) = blocks.slot[cell];
    let of_face = |lanes: &[Neighbour; crate::lane::LANES]| match lanes[lane] {
        Neighbour::Cell(across) | Neighbour::Interface(across, _) => Some(blocks.cells[across.face / 4][across.lane]),
        Neighbour::Boundary(_) | Neighbour::Padding => None,
    };
    blocks.neighbours[block].iter().filter_map(of_face).collect()
}

fn in_parts(mesh: &Mesh, parts: &[Part]) -> Option<String> {
    if parts.len() < 2 {
        return None;
    }
    let text = |part: &Part| format!("{} cell(s) with cell {}", part.cells, mesh.number(part.first));
    let mut list: Vec<String> = parts.iter().take(NAMED).map(text).collect();
    if parts.len() > NAMED {
        list.push(format!("and {} more", parts.len() - NAMED));
    }
    Some(format!(
        "the mesh has {} parts that share no edge and do not see each other, there is no contact between them unless a [[boundary]] says so: {}; parts of \
         one body must share their nodes (in Gmsh `Coherence;`, or `Coherence Mesh;` after meshing)",
        parts.len(),
        list.join(", ")
    ))
}

/// A word on each group that is a boundary with some of its edges only; `rest` says what is with these.
fn partly_inside(mesh: &Mesh, counts: &[EdgeCount], rest: &str) -> Vec<String> {
    let partly = |(_, count): &(usize, &EdgeCount)| count.inner > 0 && count.boundary > 0;
    let text = |(group, count): (usize, &EdgeCount)| {
        format!(
            "the group `{}` lies partly inside of the body: {} edge(s) inside, where it is no boundary, and {} boundary \
             edge(s); {rest}",
            mesh.edge_groups[group], count.inner, count.boundary
        )
    };
    counts.iter().enumerate().filter(partly).map(text).collect()
}

/// A word on a start from a snapshot whose run had springs in its faces where this scene has none, or the other way round.
fn other_springs(Problem { scene, scheme, state, .. }: &Problem) -> Option<String> {
    scene.initial.snapshot.as_ref()?;
    match (scheme.keeps_creep(), state.creep.is_empty()) {
        (true, true) => Some(
            "the snapshot has no creep of faces, since its run had no springs: what its faces have crept stays, and those of this scene \
             (scheme.springs = true) give back what comes from here on"
                .to_owned(),
        ),
        (false, false) => Some(
            "the snapshot has the creep of faces of a run with springs, and this scene has none: its faces stay where they are, and the \
             energy in their springs (face_energy of that run) is lost; scheme.springs = true keeps both"
                .to_owned(),
        ),
        _ => None,
    }
}

/// A word on cells with a boundary on two opposite sides, where the degree is 1: they do not hold bending.
fn thin(mesh: &Mesh, blocks: &Blocks, degree: usize) -> Option<String> {
    let is_edge = |cell: usize, face: usize| {
        let (block, lane) = blocks.slot[cell];
        matches!(blocks.neighbours[block][face][lane], Neighbour::Boundary(_))
    };
    let is_thin = |cell: &usize| (is_edge(*cell, 0) && is_edge(*cell, 1)) || (is_edge(*cell, 2) && is_edge(*cell, 3));
    let cells: Vec<usize> = if degree == 1 { (0..mesh.cells.len()).filter(is_thin).collect() } else { vec![] };
    let first = cells.first()?;
    Some(format!(
        "{} cell(s), such as cell {}, have a boundary on two opposite sides: with degree 1 one cell through the thickness has no \
         lasting stiffness in bending and loses its energy; give degree 2, or three cells through the thickness",
        cells.len(),
        mesh.number(*first)
    ))
}

/// A cell whose own limit of the step is less than the median by more than this factor is named: the whole body waits for it.
/// Meshes that are graded on purpose stay below.
const SLOW: f64 = 20.0;

/// The cells that make the step of all others small; none where none does.
fn slow_cells(mesh: &Mesh, certificates: &[Certificate]) -> Option<String> {
    let mut limits: Vec<(f64, usize)> = certificates.iter().map(|c| c.dt).zip(0..).collect();
    limits.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (median, (least, cell)) = (limits.get(limits.len() / 2)?.0, *limits.first()?);
    let slow = limits.iter().take_while(|(dt, _)| SLOW * dt < median).count();
    (slow > 0).then(|| {
        format!(
            "{slow} cell(s), such as cell {}, allow a step of {least:.3e} s, where half of the cells allow {median:.3e} s or more: the run \
             takes {:.0} times the steps that those need; such cells are small, flat, or have two edges in one smooth side of the body",
            mesh.number(cell),
            median / least
        )
    })
}

/// A word on flat cells that make the step of ADER smaller than its cfl number says.
fn flat_cells(problem: &Problem, dt: f64, survey: &Survey) -> Option<String> {
    let usual = problem.settings.courant * problem.body.mesh.smallest_h() / survey.fastest;
    (problem.settings.decay == 0.0 && dt < (1.0 - 1e-9) * usual).then(|| {
        format!(
            "flat cells make the step {dt:.3e} s in place of {usual:.3e} s: with the longer one a jump of the velocity at a wall, or in contact, would \
             make energy"
        )
    })
}

/// A word on each output and change of grid whose interval is below the first step, s.
fn short(scene: &Scene, dt: f64) -> Vec<String> {
    let outputs =
        scene.outputs.iter().map(|output| (format!("output \"{}\"", output.name), &output.when, output.exact_times));
    let regrids = scene.regrids.iter().map(|regrid| ("[[regrid]]".to_owned(), &regrid.when, regrid.exact_times));
    let text = |(of, when, exact): (String, &When, bool)| match when {
        When::Every(interval) if *interval < dt && !exact => Some(format!(
            "`every` of {of} is {interval:e} s, shorter than a step of {dt:.3e} s: it is due at each step"
        )),
        _ => None,
    };
    outputs.chain(regrids).filter_map(text).collect()
}

fn large(mesh: &Mesh) -> Option<String> {
    let [low, high] = mesh.extent();
    let size = [0, 1].map(|axis| high[axis] - low[axis]);
    (size[0].max(size[1]) > LONG)
        .then(|| format!("the body is {:e} m x {:e} m large: lengths are in m", size[0], size[1]))
}

/// The first cell at whose nodes |v| is most above the wave speed.
fn fast_start(mesh: &Mesh, scheme: &Scheme, state: &State, survey: &Survey) -> Option<String> {
    let (blocks, n) = (&scheme.operators.blocks, scheme.operators.nodes());
    let mut worst = (1.0, None);
    for (cell, &(block, lane)) in blocks.slot.iter().enumerate() {
        let u = state.of_block(block, n);
        let density = scheme.laws[blocks.material[block]].density();
        let c = survey.speed[block].fastest.0[lane];
        let p = |k: usize, a: usize| u[k * n + a].0[lane];
        let v = (0..n).map(|a| p(4, a).hypot(p(5, a)) / density).fold(0.0, f64::max);
        if v > worst.0 * c {
            worst = (v / c, Some((cell, v, c)));
        }
    }
    worst.1.map(|(cell, v, c)| {
        let cell = mesh.number(cell);
        format!("the initial velocity is {v:.4e} m/s in cell {cell}, above the wave speed there, {c:.4e} m/s; {SPEEDS}")
    })
}

const SPEEDS: &str = "velocities are in m/s, moduli in Pa, densities in kg/m^3";

/// Conditions that prescribe a speed above all wave speeds of the unstrained body: at the start, half-way or at the end of
/// the run, at the middles of its edges.
fn fast_boundary(scene: &Scene, mesh: &Mesh, scheme: &Scheme) -> Vec<String> {
    let speed = |law: &crate::step::Law| law.largest_speeds([1.0, 0.0, 0.0, 1.0], &law.virgin())[0];
    let c = scheme.laws.iter().map(speed).fold(0.0, f64::max);
    let times = [scene.start, 0.5 * (scene.start + scene.end), scene.end];
    let mut all = Vec::new();
    for (name, components) in scene.prescribed_speeds() {
        let largest = |edge: &BoundaryEdge| {
            let [a, b] = mesh.face_nodes(edge.cell, edge.face).map(|node| mesh.nodes[node]);
            let x = [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];
            let at = |t: f64| components.iter().map(|speed| speed.eval(x, t)).fold(0.0, f64::hypot);
            times.map(at).into_iter().fold(0.0, f64::max)
        };
        let edges = mesh.edges.iter().filter(|edge| mesh.edge_groups[edge.group] == name);
        let v = edges.map(largest).fold(0.0, f64::max);
        if v > c {
            let sources: Vec<String> = components.iter().map(|speed| format!("`{}`", speed.source())).collect();
            all.push(format!(
                "the speed of the boundary `{name}` is {v:.4e} m/s, above the wave speed {c:.4e} m/s: its expression is {}; \
                 {SPEEDS}",
                sources.join(", ")
            ));
        }
    }
    all
}
