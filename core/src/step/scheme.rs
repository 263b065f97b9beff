//! What stays the same from step to step.

use super::boundary_memory::BoundaryMemory;
use super::meetings::{Contacts, Pairing};
use super::partition::Partition;
use super::{Control, Correction, Flux, Histories, Law, Rescue, Sweeps, Tableau};
use crate::basis::TimeBasis;
use crate::boundary::Boundary;
use crate::error::{Error, Result};
use crate::exchange::Exchange;
use crate::lane::Kernel;
use crate::operators::{Neighbour, Operators};
use crate::riemann::Medium;
use crate::source::Source;
use std::sync::Arc;

/// How time is integrated.
#[derive(Debug, Clone, PartialEq)]
pub enum Method {
    /// Local space-time predictor and one corrector a step (15)-(21): ADER-DGMPM, and ADER-DGFEM at the nodes.
    Ader {
        /// The time nodes and their integration matrix.
        time: TimeBasis,
        /// The schedule of its Picard sweeps.
        sweeps: Sweeps,
    },
    /// Explicit Runge-Kutta: RK-DGFEM.
    RungeKutta(Tableau),
}

impl Method {
    /// ADER of degree N_T in time for degree N in space, with the sweeps of [`Sweeps::of_degree`].
    pub fn ader(degree: usize, time_degree: usize) -> Self {
        let time = TimeBasis::new(time_degree);
        Method::Ader { sweeps: Sweeps::of_degree(degree, &time), time }
    }
}

/// Everything that stays the same during a run: read freely, made by [`Scheme::new`].
#[non_exhaustive]
pub struct Scheme {
    /// Matrices of mesh and cloud.
    pub operators: Operators,
    /// The laws, by number.
    pub laws: Vec<Law>,
    /// Where internal variables lie in a state.
    pub histories: Histories,
    /// Where the memory of boundary conditions lies in a state.
    pub(super) boundary_memory: BoundaryMemory,
    /// Time integration.
    pub method: Method,
    /// Interface flux between cells of one law.
    pub flux: Flux,
    /// rho0 c_p^2 of the laws at F = 1, Pa, where the flux has springs in the faces ([`crate::riemann::hold`],
    /// [`crate::riemann::creep`]); empty where it has none.
    pub(super) moduli: Vec<f64>,
    /// How stiff the springs are by which faces give back what they creep; empty where they have none.
    pub(super) stiffness: super::springs::Stiffness,
    /// Condition of each boundary group of the mesh.
    pub boundaries: Vec<Arc<dyn Boundary>>,
    /// The faces that interact across gaps; none where no condition pairs any.
    pub(super) contacts: Option<Contacts>,
    /// Sources of momentum.
    pub sources: Vec<Arc<dyn Source>>,
    /// The control of the curl of F; none where it is off.
    pub curl: Option<Control>,
    /// What changes the new state after each step, one after the other.
    pub corrections: Vec<Arc<dyn Correction>>,
    /// Which cells are stepped again at order 0; none where it is off.
    pub rescue: Option<Rescue>,
    /// Whether a condition looks at whole faces.
    pub(super) sees_faces: bool,
    /// The bodies whose angular momentum is kept; none where that is off.
    pub(super) bodies: Option<super::angular_momentum::Bodies>,
    /// The ranks that step the body together; none where it runs alone.
    pub(super) exchange: Option<Arc<dyn Exchange>>,
    /// What cells of each law are made of, found once: a law is a dynamic call away.
    pub(super) media: Vec<Medium<f64>>,
    /// Which blocks each rank has; none where ranks have runs of equal weight.
    pub(super) partition: Option<Partition>,
    /// The instruction set.
    pub kernel: Kernel,
    /// Hash of the scene that it was made from, for files that say where a state comes from; empty where there is none.
    pub scene: String,
}

impl Scheme {
    /// The largest degree N that steps are compiled for.
    pub const LARGEST_DEGREE: usize = 6;

    /// A scheme on the widest instruction set, without sources, corrections and control of the curl. `laws` are those of the
    /// material numbers of the cells, `boundaries` the conditions of the boundary groups of the mesh, by number.
    ///
    /// # Errors
    /// A degree beyond [`Scheme::LARGEST_DEGREE`]; fewer laws or conditions than cells and faces ask for; ADER on operators
    /// without points.
    pub fn new(
        operators: Operators,
        laws: Vec<Law>,
        method: Method,
        flux: Flux,
        boundaries: Vec<Arc<dyn Boundary>>,
    ) -> Result<Self> {
        let (degree, most) = (operators.degree, Self::LARGEST_DEGREE);
        if degree > most {
            return Err(Error::input(format!("the degree is {degree}"), format!("give a degree from 0 to {most}")));
        }
        let time_degree = match &method {
            Method::Ader { time, .. } => time.len() - 1,
            Method::RungeKutta(_) => 0,
        };
        if time_degree > most {
            let what = format!("the degree in time is {time_degree}");
            return Err(Error::input(what, format!("give a degree from 0 to {most}")));
        }
        let (materials, groups) = asked_for(&operators);
        if laws.len() < materials {
            let what = format!("the cells have {materials} materials, and there are {} laws", laws.len());
            return Err(Error::input(what, "give a law for each material number"));
        }
        if boundaries.len() < groups {
            let what = format!("the mesh has {groups} boundary groups, and there are {} conditions", boundaries.len());
            return Err(Error::input(what, "give a condition for each boundary group, by its number"));
        }
        if matches!(method, Method::Ader { .. }) && operators.points.is_none() {
            let what = "ADER samples the law at points, and the operators have none";
            return Err(Error::input(what, "build the operators with Needs { sampling: Some(..), .. }"));
        }
        let (histories, boundary_memory) =
            (Histories::new(&operators, &laws), BoundaryMemory::new(&operators, &boundaries));
        let media = media(&operators, &laws);
        let sees_faces = boundaries.iter().any(|boundary| boundary.sees_faces());
        let moduli = super::springs::moduli(&laws, &flux);
        let (sources, corrections, curl, kernel) = (vec![], vec![], None, Kernel::widest());
        Ok(Self {
            operators,
            laws,
            histories,
            boundary_memory,
            method,
            flux,
            moduli,
            stiffness: super::springs::Stiffness::default(),
            boundaries,
            contacts: None,
            sources,
            curl,
            corrections,
            rescue: None,
            sees_faces,
            bodies: None,
            exchange: None,
            partition: None,
            media,
            kernel,
            scene: String::new(),
        })
    }

    /// With other laws, and all that follows from them.
    #[cfg(test)]
    pub(crate) fn with_laws(self, laws: Vec<Law>) -> Self {
        let (histories, media) = (Histories::new(&self.operators, &laws), media(&self.operators, &laws));
        let moduli = super::springs::moduli(&laws, &self.flux);
        Self { laws, histories, media, moduli, ..self }
    }

    /// Whether the predictor samples laws away from the Gauss nodes. The stress at the nodes is then a fit of that at the points, whose power is
    /// not the rate of the strain energy of a nonlinear law.
    pub fn samples_between_nodes(&self) -> bool {
        let between = |points: &crate::operators::Points| {
            let are_nodes = |matrices: &_| matches!(matrices, crate::operators::PointMatrices::Nodes(_));
            !points.pool.own.is_empty() || !points.pool.shared.iter().all(are_nodes)
        };
        matches!(self.method, Method::Ader { .. }) && self.operators.points.as_ref().is_some_and(between)
    }

    /// With sources of momentum.
    #[must_use]
    pub fn with_sources(self, sources: Vec<Arc<dyn Source>>) -> Self {
        Self { sources, ..self }
    }

    /// Whether faces of the body act on each other.
    pub fn has_contacts(&self) -> bool {
        self.contacts.is_some()
    }

    /// With what acts between pairs of boundary groups. The memory of a law is that of the conditions of its groups
    /// ([`crate::contact::Paired`]).
    ///
    /// # Errors
    /// An edge of a cut ([`crate::contact::Pairs::Initial`]) without its other side.
    pub fn with_pairings(self, pairings: &[Pairing]) -> Result<Self> {
        let contacts = Contacts::new(&self.operators, &self.laws, pairings);
        if let Some([a, b]) = contacts.as_ref().and_then(Contacts::without_partner) {
            let what = format!("the edge from {a:?} to {b:?} has no other side");
            return Err(Error::input(
                what,
                "a cohesive group lies inside of the body, or has both sides of a gap of width 0",
            ));
        }
        Ok(Self { contacts, ..self })
    }

    /// With corrections of the new state, in this order.
    #[must_use]
    pub fn with_corrections(self, corrections: Vec<Arc<dyn Correction>>) -> Self {
        Self { corrections, ..self }
    }

    /// With cells stepped again at order 0 where the step lost them.
    #[must_use]
    pub fn with_rescue(self, rescue: Option<Rescue>) -> Self {
        Self { rescue, ..self }
    }

    /// The same on another grid of the same body, with the conditions of its boundary groups and what acts between them.
    ///
    /// # Errors
    /// As [`Scheme::new`].
    pub fn on_grid(
        &self,
        operators: Operators,
        boundaries: Vec<Arc<dyn Boundary>>,
        pairings: &[Pairing],
    ) -> Result<Self> {
        let (laws, method, flux) = (self.laws.clone(), self.method.clone(), self.flux.clone());
        let new = Self::new(operators, laws, method, flux, boundaries)?;
        let (sources, corrections) = (self.sources.clone(), self.corrections.clone());
        let new =
            new.with_sources(sources).with_corrections(corrections).with_rescue(self.rescue).with_kernel(self.kernel);
        let new = Self { exchange: self.exchange.clone(), scene: self.scene.clone(), ..new.with_pairings(pairings)? };
        let new = if self.has_springs() { new.with_stiffness() } else { new };
        let new = if self.keeps_angular_momentum() { new.keeping_angular_momentum()? } else { new };
        match self.curl {
            Some(control) => new.with_curl(control),
            None => Ok(new),
        }
    }

    /// With the control of the curl of F.
    ///
    /// # Errors
    /// Operators without the projection onto gradients.
    pub fn with_curl(self, control: Control) -> Result<Self> {
        if self.operators.curl_free.is_none() {
            let what = "the control of the curl needs the projection onto gradients, and the operators have none";
            return Err(Error::input(what, "build the operators with Needs { curl_free: true, .. }"));
        }
        Ok(Self { curl: Some(control), ..self })
    }

    /// Stepped together with other ranks, all of which have this scheme.
    #[must_use]
    pub fn with_exchange(self, exchange: Arc<dyn Exchange>) -> Self {
        Self { exchange: Some(exchange), ..self }
    }

    /// The ranks that step it together; none where it runs alone.
    pub fn exchange(&self) -> Option<&dyn Exchange> {
        self.exchange.as_deref()
    }

    /// On this instruction set.
    #[must_use]
    pub fn with_kernel(self, kernel: Kernel) -> Self {
        Self { kernel, ..self }
    }

    /// The largest dt c over the smallest height of a cell with which a step makes no energy at a wall, see [`super::cfl::at_walls`]; none for
    /// Runge-Kutta.
    pub fn limit_at_walls(&self) -> Option<f64> {
        matches!(self.method, Method::Ader { .. }).then(|| super::cfl::at_walls(self.operators.degree))
    }

    /// Number of stages of a step (1 for ADER).
    pub fn stages(&self) -> usize {
        match &self.method {
            Method::Ader { .. } => 1,
            Method::RungeKutta(tableau) => tableau.stages(),
        }
    }
}

/// What cells of each law are made of.
fn media(operators: &Operators, laws: &[Law]) -> Vec<Medium<f64>> {
    let long_cells = operators.geometry.has_long_cells();
    let of_law = |law: &Law| {
        let medium = Medium::new(law.density(), law.shear_modulus(), operators.degree);
        medium.objective(law.is_objective()).in_long_cells(long_cells)
    };
    laws.iter().map(of_law).collect()
}

/// How many materials and boundary groups the blocks name.
fn asked_for(operators: &Operators) -> (usize, usize) {
    let blocks = &operators.blocks;
    let (mut materials, mut groups) = (0, 0);
    for &material in &blocks.material {
        materials = materials.max(material + 1);
    }
    for neighbour in blocks.neighbours.iter().flatten().flatten() {
        match neighbour {
            Neighbour::Boundary(group) => groups = groups.max(group + 1),
            Neighbour::Interface(_, material) => materials = materials.max(material + 1),
            Neighbour::Cell(_) | Neighbour::Padding => {}
        }
    }
    (materials, groups)
}
