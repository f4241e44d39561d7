//! The plan of a run: its parts and what it leaves out, read off the simulation as it is set up.

use ndda_contact::Part;
use serde::Serialize;

use crate::bodies::batch::ENOUGH_TOGETHER;
use crate::bodies::body::Body;
use crate::bodies::kind::BodyKind;
use crate::bodies::prototype::Prototype;
use crate::step::{Problem, Simulation};

/// The plan of a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Plan {
    /// Blocks by how they may move.
    pub kinds: Vec<KindPlan>,
    /// Distinct matrices, the largest first.
    pub factors: Vec<FactorPlan>,
    /// Parts that are in, and parts that are left out.
    pub parts: Vec<Part>,
}

/// Blocks that move alike.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct KindPlan {
    /// How they may move.
    pub kind: BodyKind,
    /// How many they are.
    pub blocks: usize,
    /// Their tetrahedra.
    pub tets: usize,
    /// Number of unknowns over all of them.
    pub unknowns: usize,
}

/// A matrix that is factored once.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FactorPlan {
    /// How its equations are solved.
    pub solver: &'static str,
    /// Its size.
    pub unknowns: usize,
    /// The first block that uses it.
    pub block: String,
    /// Blocks that use it.
    pub blocks: usize,
    /// Of them, those that are solved for together.
    pub together: usize,
}

impl Simulation {
    /// The parts of this simulation's step and what it leaves out.
    pub fn plan(&self) -> Plan {
        let mut parts = self.block_parts();
        parts.extend(self.load_parts());
        parts.extend(self.contact_parts());
        parts.extend(self.time_parts());
        Plan { kinds: self.kinds(), factors: self.factor_plans(), parts }
    }

    fn kinds(&self) -> Vec<KindPlan> {
        let all = [BodyKind::Elastic, BodyKind::Affine, BodyKind::Rigid, BodyKind::Fixed];
        let plan = |kind| {
            let shapes =
                self.problem.blocks.ids().map(|block| self.shape(block)).filter(|shape| shape.kind == kind);
            let mut plan = KindPlan { kind, blocks: 0, tets: 0, unknowns: 0 };
            for shape in shapes {
                plan.blocks += 1;
                plan.tets += shape.operator.tets.len();
                plan.unknowns += shape.unknowns.len();
            }
            plan
        };
        all.map(plan).into_iter().filter(|plan| plan.blocks > 0).collect()
    }

    fn factor_plans(&self) -> Vec<FactorPlan> {
        let mut plans = Vec::new();
        for (index, shape) in self.problem.shapes.iter().enumerate() {
            let Some(factor) = &shape.factor else { continue };
            let users =
                self.bodies.iter().zip(&self.problem.blocks.names).filter(|(body, _)| body.shape == index);
            let names: Vec<&String> = users.map(|(_, name)| name).collect();
            let runs = self.problem.runs.ranges().filter(|run| self.bodies[run.start].shape == index);
            let together =
                runs.filter(|run| self.bodies[run.start].batch.is_some()).map(|run| run.len()).sum();
            plans.push(FactorPlan {
                solver: factor.name(),
                unknowns: factor.unknowns(),
                block: names.first().map_or_else(String::new, |name| name.to_string()),
                blocks: names.len(),
                together,
            });
        }
        plans.sort_by_key(|plan| std::cmp::Reverse(plan.unknowns));
        plans
    }

    fn any_shape(&self, of: impl Fn(&Prototype) -> bool) -> bool {
        self.problem.shapes.iter().any(of)
    }

    fn any_body(&self, of: impl Fn(&Body) -> bool) -> bool {
        self.bodies.iter().any(of)
    }

    /// Whether blocks that share memory are solved for together.
    fn has_runs_in_workspaces(&self) -> bool {
        let Problem { runs, workspaces, shapes, .. } = &self.problem;
        runs.ranges().filter(|run| run.len() >= ENOUGH_TOGETHER).any(|run| {
            let shape = self.bodies[run.start].shape;
            workspaces[shape].is_some() && shapes[shape].factor.is_some()
        })
    }

    fn block_parts(&self) -> Vec<Part> {
        let deforms = Prototype::deforms;
        let stiff = self.problem.blocks.ids().filter(|&block| !deforms(self.shape(block)));
        let (count, tets) =
            stiff.fold((0, 0), |(n, tets), block| (n + 1, tets + self.problem.blocks.tets_of(block).len()));
        let stressed = |body: &Body| body.kept().is_some_and(|kept| kept.initial_force.is_some());
        let batches = self.any_body(|body| body.batch.is_some()) || self.has_runs_in_workspaces();
        vec![
            Part::of(
                "elasticity",
                self.any_shape(deforms),
                match count {
                    0 => "of all blocks".into(),
                    1 => format!("of all blocks but one that is rigid or fixed ({tets} tetrahedra)"),
                    n => format!("of all blocks but {n} that are rigid or fixed ({tets} tetrahedra)"),
                },
                "no block deforms",
            ),
            Part::of(
                "solving for blocks together",
                batches,
                "equal blocks that follow each other are solved eight at a time, with one factor of their matrix",
                format!("no {ENOUGH_TOGETHER} equal blocks follow each other"),
            ),
            Part::of(
                "damping",
                self.any_shape(|shape| !shape.damping.is_none()),
                "Rayleigh",
                "no material has damping",
            ),
            Part::of(
                "initial stress",
                self.any_body(stressed),
                "a constant force per block",
                "no block has any",
            ),
        ]
    }

    fn load_parts(&self) -> Vec<Part> {
        let held = self.any_shape(|shape| !shape.supports.held.is_empty());
        let springs = self.any_shape(|shape| !shape.supports.springs.is_empty());
        let moved = self.any_shape(|shape| !shape.supports.motions.is_empty());
        let quiet = self.any_shape(|shape| !shape.supports.quiet.dashpots.is_empty());
        let tied = self.any_shape(|shape| !shape.supports.ties.is_empty());
        vec![
            Part::of(
                "quiet faces",
                quiet,
                "dashpots of the rock beyond, in the equations of the block",
                "no face is quiet",
            ),
            Part::of("ties", tied, "one unknown for nodes that move alike", "no nodes are tied"),
            Part::of(
                "loads over time",
                !self.loads.changing().is_empty(),
                "summed anew in every step",
                "no load changes: they are summed once",
            ),
            Part::of(
                "supports by elimination",
                held,
                "held unknowns are left out of the equations",
                "no support fixes nodes",
            ),
            Part::of("supports by springs", springs, "part of the matrix", "there are none"),
            Part::of("prescribed motion", moved, "its work is recorded", "no support moves"),
        ]
    }

    fn contact_parts(&self) -> Vec<Part> {
        let Some(model) = &self.contact else {
            let why =
                if self.problem.blocks.len() < 2 { "there is one block only" } else { "the scene has none" };
            return vec![Part::left_out("contact", why)];
        };
        let mut parts =
            vec![Part::included("contact", format!("between {} blocks", self.problem.blocks.len()))];
        parts.extend(model.plan());
        parts.push(Part::of(
            "work of friction",
            !self.scratch.friction_force.is_empty(),
            "recorded in every step",
            "the model has no friction",
        ));
        parts.push(Part::of(
            "rigid motion of blocks for contact",
            model.needs_bodies(),
            "friction on velocities or contact damping needs it",
            "no law needs it",
        ));
        parts
    }

    fn time_parts(&self) -> Vec<Part> {
        let bound = match self.contact_bound() {
            Some(bound) => format!("contact at predicted positions needs ω_c Δt < {bound}"),
            None => "contact at predicted positions is not stable at any step with this integrator".into(),
        };
        vec![
            Part::included("integrator", self.problem.integrator.name()),
            Part::of(
                "contact at the end of the step",
                self.newton.is_some(),
                "solved for by Newton's method: stable at any step",
                if self.contact.is_some() { bound } else { "there is no contact".into() },
            ),
            Part::of(
                "control of the step",
                self.control.is_some(),
                "steps that violate a limit are discarded and repeated with smaller substeps",
                "every step is as long as the scene says: matrices are factored once",
            ),
            Part::of(
                "accelerations at the start",
                self.weights.needs_acceleration,
                "solved for once, as the integrator needs them",
                "the integrator does not need them",
            ),
            Part::of(
                "elastic forces kept between steps",
                !self.state.internal_force.is_empty(),
                "the integrator weights those at the start of a step",
                "the integrator takes those at the end alone",
            ),
        ]
    }
}
