//! A problem that several ranks run together. All of them step it; the first one alone has the folder of the run.

use super::{Body, Problem};
use crate::error::{Error, Result};
use crate::exchange::{self, first_that_differs};
use crate::lane::Kernel;
use crate::observe::{NewGrid, Observer, Schedule, Sight, View};
use crate::operators::Operators;
use crate::run::{Folder, Report};
use crate::scene::Scene;
use crate::step::Scheme;
use crate::words::Saved;

/// With the blocks in the order in which ranks have them: a `scheme` on a body, built again where the engine divides its blocks.
pub(super) fn divided(
    scheme: Scheme,
    scene: &Scene,
    body: &Body,
    build: impl FnOnce(Operators) -> Result<Scheme>,
) -> Result<Scheme> {
    let Some(partition) = scheme.partition() else { return Ok(scheme) };
    let links = scene.links(&body.mesh)?;
    let operators = scheme.operators.in_order(&body.mesh, &links, &body.material, &partition.order);
    Ok(build(operators)?.with_partition(partition))
}

impl Problem {
    /// Whether this rank writes the files of the run: the first one does, and who runs alone.
    pub fn writes(&self) -> bool {
        self.scheme.exchange().is_none_or(|exchange| exchange.rank() == 0)
    }

    /// The result of this rank where all ranks have got on; alone its own. All ranks call it.
    ///
    /// # Errors
    /// The error of this rank, or that another one has failed.
    pub fn agree<T>(&self, result: Result<T>) -> Result<T> {
        match self.scheme.exchange() {
            Some(exchange) => exchange::agree(exchange, result),
            None => result,
        }
    }

    /// Gives all ranks what each of them has measured of its share of the steps. All ranks call it.
    pub(super) fn gather_shares(&self, report: &mut Report) {
        if let Some(exchange) = self.scheme.exchange() {
            report.shares.gather(exchange, rayon::current_num_threads());
        }
    }

    /// Whether all ranks have the same problem, and step it in the same way. All ranks call it, and find the same.
    ///
    /// # Errors
    /// The first rank that differs from rank 0, and in what.
    pub fn check_ranks(&self) -> Result<()> {
        let Some(exchange) = self.scheme.exchange() else { return Ok(()) };
        let differs = |own: f64| first_that_differs(exchange, own);
        let kernel = Kernel::NAMES.iter().position(|(_, kernel)| *kernel == self.scheme.kernel).unwrap_or(0);
        if let Some((rank, [other, first])) = differs(kernel as f64) {
            let [other, first] = [other, first].map(|kernel| Kernel::NAMES[kernel as usize].0);
            let what = format!("rank {rank} would step by {other}, and rank 0 by {first}: their last digits differ");
            return Err(Error::input(what, "name one instruction set that all machines have, by --kernel"));
        }
        if let Some((rank, [other, first])) = differs(rayon::current_num_threads() as f64) {
            let what = format!("rank {rank} has {other} threads, and rank 0 has {first}");
            return Err(Error::input(what, "give all ranks as many, by --threads"));
        }
        if let Some((rank, _)) = differs(self.short_hash()) {
            let what = format!("rank {rank} has another scene, mesh, cloud or start than rank 0");
            return Err(Error::input(what, "let all ranks read the same files"));
        }
        Ok(())
    }

    /// A hash of all that a run depends on: 48 bits, which a number holds.
    fn short_hash(&self) -> f64 {
        let mut hash = blake3::Hasher::new();
        hash.update(self.scene.to_toml().as_bytes());
        hash.update(self.scheme.operators.key().as_bytes());
        hash.update(&self.state.time.to_le_bytes());
        for number in self.state.u.iter().chain(&self.state.internal).flat_map(|lanes| lanes.0) {
            hash.update(&number.to_le_bytes());
        }
        let hash = hash.finalize();
        hash.as_bytes()[..6].iter().fold(0.0, |sum, byte| 256.0 * sum + f64::from(*byte))
    }

    /// The observers of the scene where this rank writes; elsewhere they only know when they are due.
    ///
    /// # Errors
    /// As for [`Problem::observers`].
    pub(super) fn observers_of_rank(&self, folder: &Folder) -> Result<Vec<Box<dyn Observer>>> {
        if self.writes() {
            return self.observers(folder);
        }
        // An observer begins its file when it is made: here in a folder that goes away.
        let private = tempfile::tempdir().map_err(|why| Error::output(&std::env::temp_dir(), why))?;
        let all = self.observers(&Folder::new(private.path()))?;
        Ok(all.into_iter().map(|observer| Box::new(Silent(observer)) as _).collect())
    }
}

/// An observer of a rank that writes nothing. It has the times of the one that it holds, since steps may end at them.
pub(super) struct Silent<'a>(pub Box<dyn Observer + 'a>);

impl Observer for Silent<'_> {
    fn wants_balance(&self) -> bool {
        self.0.wants_balance()
    }

    fn wants_forces(&self) -> bool {
        self.0.wants_forces()
    }

    fn looks_at(&self) -> Sight {
        self.0.looks_at()
    }

    fn schedule(&mut self) -> &mut Schedule {
        self.0.schedule()
    }

    fn observe(&mut self, _: &View) -> Result<()> {
        Ok(())
    }

    fn restore(&mut self, from: &mut Saved) -> Result<()> {
        from.skip();
        Ok(())
    }

    fn regrid(&mut self, _: &NewGrid) -> Result<()> {
        Ok(())
    }
}
