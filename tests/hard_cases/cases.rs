//! The gallery: scenes of `meshes/hard/` with their settings and criteria.

use super::checks::{self, Check, Plateau};
use super::exact;

/// A case of the gallery.
pub struct Case {
    /// The heading that it stands under.
    pub group: &'static str,
    /// Its name.
    pub name: String,
    /// The scene in `meshes/hard/`, without its ending.
    pub scene: &'static str,
    /// What is set otherwise than in the scene.
    pub sets: Vec<String>,
    /// Its criteria.
    pub checks: Vec<Check>,
    /// Kinds of the criteria that it does not meet yet; they are shown, and not held.
    pub open: Vec<&'static str>,
    /// Whether it is in the quick set.
    pub quick: bool,
    /// Whether it takes minutes.
    pub long: bool,
}

impl Case {
    /// A run of a scene; `sets`: pairs of key and value, with blanks between the pairs.
    fn new(group: &'static str, name: impl Into<String>, scene: &'static str, sets: &str) -> Self {
        let sets = sets.split_whitespace().map(str::to_owned).collect();
        Self { group, name: name.into(), scene, sets, checks: Vec::new(), open: Vec::new(), quick: false, long: false }
    }

    /// What each run to an end must show: it ends, J > 0, no energy out of nothing, a shape that agrees with F.
    fn base(self) -> Self {
        self.holds().must(checks::shape())
    }

    /// The same of a body that starts with F0 other than 1, whose displacement tells nothing of F.
    fn holds(self) -> Self {
        self.must(checks::ends()).must(checks::sound()).must(checks::energy()).must(checks::watch())
    }

    /// One more criterion.
    fn must(mut self, check: Check) -> Self {
        self.checks.push(check);
        self
    }

    /// Criteria that are not met.
    fn open(mut self, kinds: &[&'static str]) -> Self {
        self.open.extend(kinds);
        self
    }

    /// In the quick set, where a condition holds.
    fn quick(mut self, condition: bool) -> Self {
        self.quick = condition;
        self
    }

    /// A shock of steel on a wall at v with the limiter: the front, and the plateau up to two cells (the criterion) and up to three
    /// cells behind the exact place of the shock.
    fn shock(self, v: f64, cell: f64) -> Self {
        let plateau = Plateau::impact(v, cell);
        self.must(plateau.exact("plateau", 2.0))
            .must(plateau.exact("plateau behind 3", 3.0))
            .must(plateau.narrow())
            .must(checks::overshoot(["bottom", "velocity_1"], [-v, 0.0]))
    }
}

/// All cases.
pub fn all() -> Vec<Case> {
    [
        impacts(),
        strong_impacts(),
        corners(),
        distorted(),
        clouds(),
        hyperbolicity(),
        rotation(),
        plastic(),
        steps(),
        long_runs(),
        noise(),
    ]
    .into_iter()
    .flatten()
    .collect()
}

fn impacts() -> Vec<Case> {
    let group = "Impact of the paper, with limiter";
    let mut cases = Vec::new();
    for degree in 1..=4 {
        for v in [200, 800, 2000] {
            let sets = format!("scheme.degree={degree} initial.velocity=[-{v},0]");
            let case = Case::new(group, format!("{v} m/s, S{degree}, 30 x 30"), "impact", &sets).base();
            let quick = degree <= 2 || (degree == 3 && v == 2000);
            let case = case.shock(f64::from(v), 0.1).open(&["plateau"]).quick(quick);
            cases.push(if (degree, v) == (1, 200) { case.open(&["plateau behind 3"]) } else { case });
        }
    }
    for (n, degree) in [(60, 2), (120, 1)] {
        let sets = format!("scheme.degree={degree} mesh.rectangle.cells=[{n},{n}]");
        let case = Case::new(group, format!("200 m/s, S{degree}, {n} x {n}"), "impact", &sets).base();
        let open = if degree == 1 { "plateau behind 3" } else { "plateau" };
        cases.push(case.shock(200.0, 3.0 / f64::from(n)).open(&["plateau", open]));
    }
    for (name, sets, open) in [
        ("ADER-DGFEM", "scheme.method=ader-dgfem", "plateau"),
        ("RK-DGFEM", "scheme.method=rk-dgfem", "plateau"),
        ("vertex limiter", "limiter.kind=vertex", "plateau behind 3"),
    ] {
        let case = Case::new(group, format!("200 m/s, S2, {name}"), "impact", sets).base();
        cases.push(case.shock(200.0, 0.1).open(&["plateau", open]).quick(true));
    }
    for degree in [1, 2] {
        let sets = format!("scheme.degree={degree} time.end=1.77e-3");
        let case = Case::new(group, format!("200 m/s, S{degree}, to the end of the paper"), "impact", &sets);
        cases.push(case.base().must(checks::marked()).quick(true));
    }
    cases
}

fn strong_impacts() -> Vec<Case> {
    let group = "Impact beyond what a step can hold: limiter and rescue";
    let of = |name: &str, sets: &str| {
        let case = Case::new(group, name, "impact", sets).base();
        if name.ends_with("S4") || name.ends_with("random points") { case } else { case.open(&["shape"]) }
    };
    let four = "initial.velocity=[-4000,0]";
    vec![
        of("4000 m/s, S1", &format!("{four} time.end=1.77e-3 scheme.degree=1")).quick(true),
        of("4000 m/s, S2", &format!("{four} time.end=1.77e-3")),
        of("4000 m/s, S2, midpoints", &format!("{four} time.end=1.77e-3 cloud.layout=midpoints")),
        of("4000 m/s, S2, random points", &format!("{four} cloud.layout=random")).quick(true),
        of("4000 m/s, S3", &format!("{four} time.end=1.77e-3 scheme.degree=3")),
        of("4000 m/s, S4", &format!("{four} scheme.degree=4")),
        of("6000 m/s, S1", "initial.velocity=[-6000,0] time.end=1.77e-3 scheme.degree=1").quick(true),
    ]
}

fn corners() -> Vec<Case> {
    let group = "Corners and jumps";
    let mut cases = Vec::new();
    for degree in 1..=4 {
        for (name, scene) in [
            ("push at 1000 m/s beside a free side", "push_corner"),
            ("velocity that jumps by 1000 m/s along a side", "punch_corner"),
            ("pressure of 5e10 Pa on a third of a side", "traction_jump"),
            ("L-shape at 1200 m/s", "l_shape"),
        ] {
            let sets = format!("scheme.degree={degree}");
            let case = Case::new(group, format!("{name}, S{degree}"), scene, &sets).base();
            let torn = scene == "traction_jump" || scene == "l_shape";
            cases.push(if torn { case.open(&["shape"]) } else { case }.quick(degree <= 2));
        }
    }
    for refine in [2, 4] {
        let sets = format!("scheme.degree={} regrid=[{{at=[0.0],refine={refine}}}]", 3 - refine / 2);
        let name = format!("push at 1000 m/s beside a free side, S{}, {} cells a side", 3 - refine / 2, 18 * refine);
        let case = Case::new(group, name, "push_corner", &sets).base();
        cases.push(if refine == 4 { case.open(&["shape"]) } else { case });
    }
    for (name, sets) in [("with limiter", ""), ("without limiter", "limiter.kind=off")] {
        cases.push(
            Case::new(group, format!("plate with a hole at 400 m/s, {name}"), "plate_hole", sets)
                .base()
                .open(&["shape"])
                .quick(true),
        );
    }
    cases
}

fn distorted() -> Vec<Case> {
    let group = "Distorted cells";
    let of = |name: &str, scene, sets: &str| Case::new(group, name, scene, sets).base().shock(200.0, 0.1);
    vec![
        of("shock through slivers 1 : 50", "slivers", "").open(&["plateau"]),
        of("shock through cells of 20 degrees, with limiter", "chevrons", "").open(&[
            "plateau",
            "plateau behind 3",
            "width",
            "overshoot",
        ]),
        of("shock through cells of 20 degrees, without limiter", "chevrons", "limiter.kind=off")
            .open(&["plateau", "plateau behind 3", "overshoot"])
            .quick(true),
    ]
}

fn clouds() -> Vec<Case> {
    ["random", "cluster", "rotated", "jitter"]
        .map(|layout| {
            let sets = format!("cloud.layout={layout}");
            let case = Case::new("Clouds through a shock", format!("{layout} points"), "impact", &sets).base();
            case.shock(200.0, 0.1).open(&["plateau"]).quick(layout != "jitter")
        })
        .into()
}

/// The bar of St. Venant-Kirchhoff steel whose halves fly apart, m/s.
const APART: f64 = 600.0;

fn hyperbolicity() -> Vec<Case> {
    let group = "St. Venant-Kirchhoff";
    let (shock, fan) = (exact::tension(APART), exact::fan(APART));
    let range = |a: f64, b: f64| checks::overshoot(["axis", "deformation_11"], [a, b]);
    let (of, values) = (["axis", "deformation_11"], [shock.stretch, 1.0]);
    let plateau = Plateau { of, from: 1.5, speed: shock.speed, values, cell: 0.05 };
    let least = fan(0.0);
    let behind = move |x: f64, t: f64| if x < shock.speed * t { shock.stretch } else { 1.0 };
    let mut cases = vec![
        Case::new(group, "tension: two shocks", "svk_bar", "")
            .base()
            .must(checks::profile("axis", behind))
            .must(plateau.exact("plateau", 2.0))
            .must(plateau.exact("plateau behind 3", 3.0))
            .must(plateau.narrow())
            .must(range(1.0, shock.stretch))
            .open(&["plateau"])
            .quick(true),
    ];
    let signs =
        r#"initial.velocity=["600-1200*step(x-1.5)","0"] boundary.0.value=["600","0"] boundary.1.value=["-600","0"]"#;
    cases.push(
        Case::new(group, "compression: two fans", "svk_bar", signs)
            .base()
            .must(checks::profile("axis", move |x, t| fan(x / t)))
            .must(range(least, 1.0))
            .quick(true),
    );
    for (poisson, at) in [(0.3, 0.7055), (0.0, 0.5855)] {
        let sets = format!("material.0.poisson={poisson:?}");
        let case = Case::new(group, format!("beyond its range, Poisson {poisson}"), "svk_collapse", &sets);
        let case = case.must(checks::sound()).must(checks::energy());
        cases.push(case.must(checks::collapses(at)).must(checks::goes_on()).quick(true));
    }
    cases
}

fn rotation() -> Vec<Case> {
    let group = "Large rotation and bending";
    let spin = |name: &str, sets: &str| {
        Case::new(group, name, "spinning_plate", sets)
            .base()
            .must(checks::turns())
            .must(checks::keeps(0.99))
            .quick(true)
    };
    vec![
        spin("spinning plate, Poisson .45", ""),
        spin("spinning plate, Poisson .499", "material.0.poisson=0.499"),
        spin("spinning plate, with limiter", r#"limiter={kind="moment"}"#),
        Case::new(group, "bending column", "bending_column", "").base().must(checks::keeps(0.95)).quick(true),
        Case::new(group, "oscillating beam", "beam", "").base().must(checks::period(0.25406)).quick(true),
    ]
}

fn plastic() -> Vec<Case> {
    let group = "Plastic flow";
    let bar = |name: &str, scene, sets: &str| Case::new(group, name, scene, sets).base().must(checks::length());
    let shape = &["shape"][..];
    let mut cases = vec![
        bar("Taylor bar, copper, without limiter", "taylor_copper", "limiter.kind=off").open(shape).quick(true),
        bar("Taylor bar, copper, with limiter", "taylor_copper", "").open(shape),
        bar("Taylor bar, copper, with limiter, S1", "taylor_copper", "scheme.degree=1").open(shape),
        bar("Taylor bar, copper, with limiter, S3", "taylor_copper", "scheme.degree=3"),
        bar("Taylor bar, copper, vertex limiter", "taylor_copper", "limiter.kind=vertex"),
        bar("Taylor bar, aluminium, without limiter", "taylor_aluminium", "limiter.kind=off").open(shape).quick(true),
        bar("Taylor bar, aluminium, with limiter", "taylor_aluminium", ""),
    ];
    for (cells, open) in
        [([10, 1], &[][..]), ([30, 3], &["watch"]), ([40, 4], &["watch"]), ([60, 6], &["end", "watch", "length"])]
    {
        let sets = format!("limiter.kind=off mesh.rectangle.cells=[{},{}]", cells[0], cells[1]);
        let name = format!("Taylor bar, copper, without limiter, {} x {} cells", cells[0], cells[1]);
        let case = bar(&name, "taylor_copper", &sets).open(shape).open(open);
        cases.push(Case { long: cells[0] > 30, ..case });
    }
    let plateau = Plateau {
        of: ["bottom", "piola_11"],
        from: 0.0,
        // Design value of the exact solution of the impact of this J2 steel at 200 m/s: speed of the plastic shock, stress behind it.
        speed: 4689.0,
        values: [-7.45656e9, 0.0],
        cell: 0.05,
    };
    for (name, sets, quick) in [("", "", true), (", with limiter", r#"limiter={kind="moment"}"#, false)] {
        let case =
            Case::new(group, format!("plastic shock, new grid every 10 steps{name}"), "plastic_regrid", sets).base();
        cases.push(case.must(plateau.exact("plateau", 2.0)).open(&["plateau"]).quick(quick));
    }
    cases
}

fn steps() -> Vec<Case> {
    let group = "The limit of the time step";
    let mut cases =
        vec![Case::new(group, "1.05 of the limit", "impact", "scheme.safety=1.05").must(checks::refused()).quick(true)];
    for degree in 1..=4 {
        let sets = format!("scheme.degree={degree} scheme.safety=0.99");
        cases.push(Case::new(group, format!(".99 of the limit, S{degree}"), "impact", &sets).base().quick(degree <= 2));
    }
    cases
}

/// Momentum of the free square if all of it moved at 20 m/s, kg/s.
const MOMENTUM: f64 = 7800.0 * 20.0;

fn long_runs() -> Vec<Case> {
    let group = "Long runs";
    // The ends are 1e5 steps; of the quick set 1.5e4.
    let mut cases = Vec::new();
    for (degree, end) in [(1, 0.64), (2, 0.321), (3, 0.193), (4, 0.125), (5, 0.088), (6, 0.066)] {
        for (end, quick) in [(0.15 * end, degree <= 2), (end, false)] {
            let sets = format!("scheme.degree={degree} time.end={end:e}");
            let name = format!("free vibrating square, S{degree}, to {end} s");
            let case = Case::new(group, name, "free_square", &sets).base().must(checks::no_drift(MOMENTUM));
            // What the notice before a run says of ADER of these degrees, a step.
            let growth = [4e-6, 3e-5, 8e-5];
            let case = match degree {
                4.. => case.must(checks::budget(growth[degree - 4])),
                3 => case.must(checks::monotone()).open(&["monotone"]),
                _ => case.must(checks::monotone()),
            };
            cases.push(Case { long: degree >= 5, ..case }.quick(quick));
        }
    }
    cases
}

fn noise() -> Vec<Case> {
    let group = "Noise of 5 mm/s on uniform states, 2000 steps";
    let states = ["1,0,0,1", "0.965,0,0,1", "0.9,0,0,1", "0.9,0,0,0.9", "0.7,0,0,1", "0.7,0,0,0.7", "1,0.2,0,0.9"];
    let ends = [8.4e-3, 4.3e-3, 2.6e-3, 1.7e-3];
    let mut cases = Vec::new();
    for state in states {
        for (degree, end) in (1..).zip(ends) {
            for method in ["ader-dgmpm", "ader-dgfem", "rk-dgfem"] {
                let deformation = state.replace(',', "\",\"");
                let sets = format!(
                    "scheme.degree={degree} scheme.method={method} time.end={end:e} initial.deformation=[\"{deformation}\"]"
                );
                let case = Case::new(group, format!("F = ({state}), S{degree}, {method}"), "compressed_noise", &sets);
                let case = case.holds().must(checks::decays());
                cases.push(case.quick(method == "ader-dgmpm" && degree <= 2));
            }
            for (name, more) in
                [("distorted cells", "mesh={file=\"distorted.msh\"}"), ("jitter", "cloud.layout=jitter")]
            {
                let deformation = state.replace(',', "\",\"");
                let sets =
                    format!("scheme.degree={degree} time.end={end:e} initial.deformation=[\"{deformation}\"] {more}");
                let case = Case::new(group, format!("F = ({state}), S{degree}, {name}"), "compressed_noise", &sets);
                cases.push(case.holds().must(checks::decays()));
            }
        }
    }
    let sides = ["left", "right", "bottom", "top"].map(|side| format!("{{group=\"{side}\",kind=\"free\"}}")).join(",");
    for (name, more) in [("", ""), (", rusanov", "scheme.flux=rusanov"), (", safety .8", "scheme.safety=0.8")] {
        let sets = format!(
            r#"scheme.degree=1 time.end=4e-3 mesh.rectangle.cells=[32,32] initial.deformation=["1","0","0","1"] boundary=[{sides}] {more}"#
        );
        let case = Case::new(group, format!("free square, 32 x 32, S1{name}"), "compressed_noise", &sets).holds();
        cases.push(case.must(checks::decays()));
    }
    cases
}
