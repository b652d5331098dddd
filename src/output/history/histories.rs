//! Group `/history`: one row per increment, row 0 being the start.

use hdf5::{Attribute, Group};

use super::bodies::BodyHistory;
use super::contacts::{ContactHistory, Impacts, Returns, Touches, create_contacts};
use super::rigid_surfaces::{RigidHistory, create_rigid};
use super::sets::SetHistories;
use super::strains::StrainHistory;
use crate::dynamics::{Energy, IncrementReport, Momentum, SolverCounts};
use crate::model::{ContactMass, LandingRule, Model, Step};
use crate::output::file::{Column, Columns, ROWS, Scalar, Series, counter, group, meaning, scalar};

/// Writes the history.
pub(crate) struct History {
    count: Attribute,
    /// Rows appended.
    rows: usize,
    times: Series<IncrementReport, f64>,
    step: Series<IncrementReport, i64>,
    energy: Series<Energy, f64>,
    momentum: MomentumHistory,
    bodies: BodyHistory,
    strain: StrainHistory,
    contacts: Vec<ContactHistory>,
    impacts: Impacts,
    returns: Option<Returns>,
    touches: Touches,
    rigid: Vec<RigidHistory>,
    sets: SetHistories,
    solver: SolverHistory,
    waiting: Waiting,
}

/// Rows that wait in memory, and at most.
struct Waiting {
    rows: usize,
    most: usize,
    /// Bytes of a row.
    row_bytes: usize,
}

impl History {
    /// Creates the group without rows.
    pub fn create(root: &Group, model: &Model) -> hdf5::Result<Self> {
        let at = group(root, "history")?;
        let mut history = History {
            count: counter(&at, ROWS)?,
            rows: 0,
            times: Series::create(&at, &TIMES)?,
            step: Series::create(&at, &STEP)?,
            energy: Series::create(&group(&at, "energy")?, &ENERGY)?,
            momentum: MomentumHistory::create(&group(&at, "momentum")?, model)?,
            bodies: BodyHistory::create(&group(&at, "bodies")?, model)?,
            strain: StrainHistory::create(&group(&at, "strain")?, model)?,
            contacts: create_contacts(&group(&at, "contact")?, model)?,
            impacts: Impacts::create(&group(&at, "impacts")?)?,
            returns: match model.steps.iter().any(gives_back) {
                true => Some(Returns::create(&group(&at, "returns")?)?),
                false => None,
            },
            touches: Touches::create(&group(&at, "touches")?)?,
            rigid: create_rigid(&group(&at, "rigid")?, model)?,
            sets: SetHistories::create(&at, model)?,
            solver: SolverHistory::create(&group(&at, "solver")?)?,
            waiting: Waiting {
                rows: 0,
                most: 1,
                row_bytes: 0,
            },
        };
        history.waiting.row_bytes = history.columns().iter().map(|c| c.row_bytes()).sum();
        Ok(history)
    }

    /// Lets rows of up to `bytes` bytes wait in memory, or one.
    pub fn let_wait(&mut self, bytes: usize) {
        self.waiting.most = (bytes / self.waiting.row_bytes).max(1);
    }

    /// Appends the row of an increment, which waits in memory.
    pub fn push(&mut self, model: &Model, report: &IncrementReport) {
        self.rows += 1;
        self.times.push(report);
        self.step.push(report);
        self.energy.push(&report.energy);
        self.momentum.push(&report.momentum);
        self.bodies.push(&report.bodies);
        self.strain.push(report);
        for (contact, resultant) in self.contacts.iter_mut().zip(&report.contacts) {
            contact.push(resultant);
        }
        for landing in &report.landings {
            self.impacts.push(model, report.increment, landing);
        }
        if let Some(returns) = &mut self.returns {
            for returned in &report.returns {
                returns.push(model, report.increment, returned);
            }
        }
        for touch in &report.touches {
            self.touches.push(model, touch);
        }
        for (surface, reaction) in self.rigid.iter_mut().zip(&report.rigid) {
            surface.push(model, &report.state, reaction);
        }
        self.sets.push(report);
        self.solver.push(&report.solver);
        let events = [
            report.landings.len(),
            report.returns.len(),
            report.touches.len(),
        ];
        self.waiting.rows += events.into_iter().fold(1, usize::max);
    }

    /// Whether no further row may wait.
    pub fn is_full(&self) -> bool {
        self.waiting.rows >= self.waiting.most
    }

    /// Writes the rows that wait, but not their number.
    pub fn flush(&mut self) -> hdf5::Result<()> {
        self.waiting.rows = 0;
        (self.columns().into_iter()).try_for_each(|column| column.flush())
    }

    /// Writes the numbers of rows.
    pub fn note_counts(&self) -> hdf5::Result<()> {
        self.count.write_scalar(&(self.rows as i64))?;
        self.impacts.note_count()?;
        self.returns.as_ref().map_or(Ok(()), Returns::note_count)?;
        self.touches.note_count()
    }

    /// Bytes by which the file may grow until the rows are written.
    pub fn growth(&mut self) -> u64 {
        let rows = self.waiting.most;
        self.columns()
            .iter()
            .map(|column| column.growth(rows))
            .sum()
    }

    /// Its datasets.
    fn columns(&mut self) -> Columns<'_> {
        let mut all = Columns::new();
        self.times.columns(&mut all);
        self.step.columns(&mut all);
        self.energy.columns(&mut all);
        self.momentum.columns(&mut all);
        self.bodies.columns(&mut all);
        self.strain.columns(&mut all);
        for contact in &mut self.contacts {
            contact.columns(&mut all);
        }
        self.impacts.columns(&mut all);
        if let Some(returns) = &mut self.returns {
            returns.columns(&mut all);
        }
        self.touches.columns(&mut all);
        for surface in &mut self.rigid {
            surface.columns(&mut all);
        }
        self.sets.columns(&mut all);
        self.solver.columns(&mut all);
        all
    }
}

/// Whether the mass of contact surfaces is redistributed in a step.
fn redistributes(step: &Step) -> bool {
    step.settings.contact_mass == ContactMass::Redistributed
}

/// Whether a step may give energy back after landings.
fn gives_back(step: &Step) -> bool {
    step.settings.landing == LandingRule::Return
}

const TIMES: [Scalar<IncrementReport, f64>; 2] = [
    scalar("time", "time at the end of the increment", "time", |r| {
        r.time
    }),
    scalar("dt", "length of the increment", "time", |r| r.dt),
];

const STEP: [Scalar<IncrementReport, i64>; 1] =
    [scalar("step", "number of the step, from 1", "1", |r| {
        r.step as i64
    })];

const ENERGY: [Scalar<Energy, f64>; 12] = [
    scalar("kinetic", "kinetic energy", "energy", |e| e.kinetic),
    scalar("strain", "strain energy", "energy", |e| e.strain),
    scalar(
        "external_work",
        "work of the loads and of the supports' prescribed motion since the start",
        "energy",
        |e| e.external_work,
    ),
    scalar(
        "normal_contact_work",
        "work of the normal contact forces since the start",
        "energy",
        |e| e.normal_contact_work,
    ),
    scalar(
        "friction_dissipation",
        "energy dissipated by friction since the start",
        "energy",
        |e| e.friction_dissipation,
    ),
    scalar(
        "impact_loss",
        "kinetic energy taken by the impact impulses since the start",
        "energy",
        |e| e.impact_loss,
    ),
    scalar(
        "landing_return",
        "kinetic energy given back after landings since the start",
        "energy",
        |e| e.landing_return,
    ),
    scalar(
        "release_loss",
        "strain energy lost by nodes without mass after releases since the start",
        "energy",
        |e| e.release_loss,
    ),
    scalar(
        "damping",
        "energy dissipated by the damping of the materials since the start",
        "energy",
        |e| e.damping,
    ),
    scalar(
        "material_dissipation",
        "energy dissipated by the materials since the start",
        "energy",
        |e| e.material_dissipation,
    ),
    scalar(
        "numerical_dissipation",
        "energy dissipated by the integration scheme since the start",
        "energy",
        |e| e.numerical_dissipation,
    ),
    scalar(
        "balance",
        "what is left of the energy balance: only the unconverged residual",
        "energy",
        |e| e.balance,
    ),
];

const ANGULAR: [Scalar<Momentum, f64>; 2] = [
    scalar(
        "angular",
        "angular momentum about the origin",
        "mass*length^2/time",
        |m| m.angular,
    ),
    scalar(
        "damped_angular",
        "angular momentum taken by mass-proportional damping since the start",
        "mass*length^2/time",
        |m| m.damped_angular,
    ),
];

/// With redistributed mass; where no node gives its mass up it is the other.
const CONSISTENT: [Scalar<Momentum, f64>; 1] = [scalar(
    "consistent_angular",
    "angular momentum about the origin of the consistent mass",
    "mass*length^2/time",
    |m| m.consistent_angular.unwrap_or(m.angular),
)];

/// `/history/momentum`.
struct MomentumHistory {
    linear: Column<f64>,
    damped_linear: Column<f64>,
    angular: Series<Momentum, f64>,
    consistent: Option<Series<Momentum, f64>>,
}

impl MomentumHistory {
    fn create(at: &Group, model: &Model) -> hdf5::Result<Self> {
        let text = meaning("linear momentum", "mass*length/time");
        let damped = meaning(
            "linear momentum taken by mass-proportional damping since the start",
            "mass*length/time",
        );
        Ok(MomentumHistory {
            linear: Column::series(at, "linear", &[2], text)?,
            damped_linear: Column::series(at, "damped_linear", &[2], damped)?,
            angular: Series::create(at, &ANGULAR)?,
            consistent: match model.steps.iter().any(redistributes) {
                true => Some(Series::create(at, &CONSISTENT)?),
                false => None,
            },
        })
    }

    fn push(&mut self, momentum: &Momentum) {
        self.linear.push(momentum.linear);
        self.damped_linear.push(momentum.damped_linear);
        self.angular.push(momentum);
        if let Some(consistent) = &mut self.consistent {
            consistent.push(momentum);
        }
    }

    fn columns<'a>(&'a mut self, all: &mut Columns<'a>) {
        all.push(&mut self.linear);
        all.push(&mut self.damped_linear);
        self.angular.columns(all);
        if let Some(consistent) = &mut self.consistent {
            consistent.columns(all);
        }
    }
}

const COUNTS: [Scalar<SolverCounts, i64>; 8] = [
    scalar("passes", "predictor and corrector passes", "1", |s| {
        s.passes as i64
    }),
    scalar("lcps", "complementarity problems solved", "1", |s| {
        s.lcps as i64
    }),
    scalar(
        "lcp_size",
        "largest number of pairs in one of them",
        "1",
        |s| s.lcp_size as i64,
    ),
    scalar("pivots", "pivots of Lemke's method", "1", |s| {
        s.pivots as i64
    }),
    scalar(
        "active_set_iterations",
        "iterations of the active-set method",
        "1",
        |s| s.active_set_iterations as i64,
    ),
    scalar(
        "gauss_seidel_sweeps",
        "sweeps of the Gauss-Seidel method",
        "1",
        |s| s.gauss_seidel_sweeps as i64,
    ),
    scalar("lemke_calls", "calls of Lemke's method", "1", |s| {
        s.lemke_calls as i64
    }),
    scalar(
        "factorizations",
        "factorisations of the effective matrix",
        "1",
        |s| s.factorizations as i64,
    ),
];

const ERRORS: [Scalar<SolverCounts, f64>; 5] = [
    scalar(
        "residual",
        "relative force residual of the last pass",
        "1",
        |s| s.residual,
    ),
    scalar(
        "overlap",
        "largest overlap of an open pair at the end, in lengths of its segment",
        "1",
        |s| s.violation.overlap,
    ),
    scalar(
        "gap_violation",
        "largest gap of a closed pair at the end, in lengths of its segment",
        "1",
        |s| s.violation.gap,
    ),
    scalar(
        "slip_violation",
        "largest slip of a sticking pair in the increment, in lengths of its segment",
        "1",
        |s| s.violation.slip,
    ),
    scalar(
        "penetration",
        "largest penetration at the end, of an open pair or of edges that cross, in lengths of the edge",
        "1",
        |s| s.violation.penetration,
    ),
];

const CONVERGED: [Scalar<SolverCounts, u8>; 1] = [scalar(
    "converged",
    "1 when the increment converged, else 0",
    "1",
    |s| s.converged.into(),
)];

/// `/history/solver`.
struct SolverHistory {
    counts: Series<SolverCounts, i64>,
    errors: Series<SolverCounts, f64>,
    converged: Series<SolverCounts, u8>,
}

impl SolverHistory {
    fn create(at: &Group) -> hdf5::Result<Self> {
        Ok(SolverHistory {
            counts: Series::create(at, &COUNTS)?,
            errors: Series::create(at, &ERRORS)?,
            converged: Series::create(at, &CONVERGED)?,
        })
    }

    fn push(&mut self, counts: &SolverCounts) {
        self.counts.push(counts);
        self.errors.push(counts);
        self.converged.push(counts);
    }

    fn columns<'a>(&'a mut self, all: &mut Columns<'a>) {
        self.counts.columns(all);
        self.errors.columns(all);
        self.converged.columns(all);
    }
}
