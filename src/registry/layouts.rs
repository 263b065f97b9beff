//! Where material points stand, `[cloud] layout = ..` and `[[material]] layout = ..`.

use super::{ANY, Check, Entry, FINITE, Form, POSITIVE, Parameter, Preset, Table, Values};
use crate::cloud::{Cloud, Pattern, body, seed};
use crate::mesh::Mesh;

/// What there is to know of a layout.
pub struct Layout {
    /// How its points are made.
    pub points: Points,
    /// Points per direction beyond N + 1, where the scene does not say how many: so many that most cells carry the degree
    /// wherever chance puts their points. Of cells with random points 0, 5, 40 % (N = 1, 2, 3) do not with 2 more, and 8, 39,
    /// 82 % with 1 more.
    pub more: usize,
    /// Whether all cells have the same points.
    pub is_lattice: bool,
    /// Whether N + 1 points per direction are the Gauss nodes.
    pub on_nodes: bool,
}

impl Layout {
    /// Whether it is the points of a file.
    pub fn is_file(&self) -> bool {
        matches!(self.points, Points::File)
    }
}

/// How points are made.
pub enum Points {
    /// Cell by cell.
    Cells(fn(&Values) -> InCell),
    /// Through the body, without regard to its cells: in the cells that are members, with k^2 points a cell in the mean.
    Body(fn(&Values, &Mesh, &[bool], usize) -> Cloud),
    /// The points of the file `path`; only `[cloud]` can name it.
    File,
}

/// The k^2 points of the cell of a number, in parent coordinates.
pub type InCell = Box<dyn Fn(usize, usize) -> Vec<[f64; 2]>>;

/// The layout of laws with memory in a scene that names none: histories need not leave the points then.
pub const WITH_MEMORY: &str = "gauss";

/// The layout of a scene with contact or obstacles that names none. What presses and shears at a contact strains cells unevenly, and a law
/// that is sampled away from the Gauss nodes then makes energy.
pub const IN_CONTACT: &str = "gauss";

/// The layout of any other scene that names none, see [`seed::default_layout`].
pub fn default_name(degree: usize) -> &'static str {
    match seed::default_layout(degree) {
        seed::Layout::Paper => "paper",
        _ => "midpoints",
    }
}

const SEED: Parameter =
    Parameter::new("seed", "seed of the random numbers", "", Form::Integer(0, usize::MAX), Preset::Integer(1));
const SPACING: &str = "by `per_direction`";

const fn lattice(points: fn(&Values) -> InCell) -> Layout {
    Layout { points: Points::Cells(points), more: 0, is_lattice: true, on_nodes: false }
}

fn of(layout: seed::Layout) -> InCell {
    Box::new(move |k, cell| layout.points(k, cell))
}

/// Every layout; a file last.
pub static LAYOUTS: Table<Layout> = Table::new(&[
    Entry {
        name: "paper",
        about: "lattice of the paper; the default up to degree 2",
        parameters: &[],
        check: ANY,
        build: lattice(|_| of(seed::Layout::Paper)),
    },
    Entry {
        name: "midpoints",
        about: "lattice: the points stand for equal parts of the cell; the default from degree 3 on",
        parameters: &[],
        check: ANY,
        build: lattice(|_| of(seed::Layout::Midpoints)),
    },
    Entry {
        name: "gauss",
        about: "lattice of Gauss-Legendre points; the default for laws with internal variables, and of scenes with contact, obstacles or unilateral walls",
        parameters: &[],
        check: ANY,
        build: Layout { on_nodes: true, ..lattice(|_| of(seed::Layout::Gauss)) },
    },
    Entry {
        name: "jitter",
        about: "midpoints, each moved at random",
        parameters: &[
            SEED,
            Parameter::number(
                "amount",
                "largest move, in spacings",
                "",
                Check { range: "from 0 to 0.5", holds: |a| (0.0..=0.5).contains(&a) },
                seed::Layout::JITTER,
            ),
        ],
        check: ANY,
        build: Layout {
            points: Points::Cells(|v| of(seed::Layout::Jitter { seed: seed_of(v), amount: v.number("amount") })),
            more: 0,
            is_lattice: false,
            on_nodes: false,
        },
    },
    Entry {
        name: "random",
        about: "random points in each cell",
        parameters: &[SEED],
        check: ANY,
        build: Layout {
            points: Points::Cells(|v| of(seed::Layout::Random { seed: seed_of(v) })),
            more: 2,
            is_lattice: false,
            on_nodes: false,
        },
    },
    Entry {
        name: "cluster",
        about: "random points around random centres in each cell",
        parameters: &[
            SEED,
            Parameter::new(
                "clusters",
                "number of centres in a cell",
                "",
                Form::Integer(1, 100),
                Preset::Integer(seed::Layout::CLUSTERS),
            ),
            Parameter::number(
                "radius",
                "largest distance from the centre, in cells",
                "",
                Check { range: "from 0 to 1", holds: |a| (0.0..=1.0).contains(&a) },
                seed::Layout::RADIUS,
            ),
        ],
        check: ANY,
        build: Layout {
            points: Points::Cells(|v| {
                let (clusters, radius) = (v.integer("clusters"), v.number("radius"));
                of(seed::Layout::Cluster { seed: seed_of(v), clusters, radius })
            }),
            more: 2,
            is_lattice: false,
            on_nodes: false,
        },
    },
    Entry {
        name: "poisson-disk",
        about: "random points through the whole body that keep their distance",
        parameters: &[
            SEED,
            Parameter::new("spacing", "least distance", "m", Form::Number(POSITIVE), Preset::Absent(SPACING)),
        ],
        check: ANY,
        build: Layout {
            points: Points::Body(|v, mesh, member, k| {
                let usual = || Pattern::DISK * body::mean_spacing(mesh, member, k);
                let spacing = v.maybe("spacing").unwrap_or_else(usual);
                Pattern::PoissonDisk { seed: seed_of(v), spacing }.seed(mesh, member)
            }),
            more: 1,
            is_lattice: false,
            on_nodes: false,
        },
    },
    Entry {
        name: "rotated",
        about: "square lattice through the whole body, turned against the grid",
        parameters: &[
            // Not the angle of any usual grid, nor of its diagonals.
            Parameter::number("angle", "from the x axis to that of the lattice", "degrees", FINITE, 30.0),
            Parameter::new("spacing", "distance of neighbours", "m", Form::Number(POSITIVE), Preset::Absent(SPACING)),
        ],
        check: ANY,
        build: Layout {
            points: Points::Body(|v, mesh, member, k| {
                let spacing = v.maybe("spacing").unwrap_or_else(|| body::mean_spacing(mesh, member, k));
                Pattern::Rotated { angle: v.number("angle"), spacing }.seed(mesh, member)
            }),
            more: 1,
            is_lattice: false,
            on_nodes: false,
        },
    },
    Entry {
        name: "file",
        about: "the points of a file; a `path` alone means this layout",
        parameters: &[Parameter::required(
            "path",
            "a .vtu file such as an exported points_*.vtu, a .csv file with rows x, y in m, or the .h5 file of `dgmpm seed`",
            "",
            Form::Text,
        )],
        check: ANY,
        build: Layout { points: Points::File, more: 0, is_lattice: false, on_nodes: false },
    },
]);

fn seed_of(values: &Values) -> u64 {
    values.integer("seed") as u64
}
