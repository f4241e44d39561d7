//! The static solve: a massless bar held by springs along its length.
//!
//! The displacements U along the bar minimise Σ φ(U₊ − U − p) + Σ ψ(U − G − s), φ being the potentials of the steel between neighbouring nodes and ψ
//! those of grout and plate, with what has yielded before (p, s) and the displacements G of the rock. All potentials are convex and bounded from
//! below, and the sum is piecewise quadratic: Newton's method with a search along its direction, in which springs that yield keep a little
//! stiffness, ends at the minimum from anywhere. The matrix is tridiagonal; it is eliminated as springs in series, without subtractions.

use crate::bolts::law::Law;

/// Stiffness left to springs that yield, for the direction of search alone.
const LEFT: f64 = 1e-9;

/// More than ever needed: see the test of chains drawn at random.
const MOST_ITERATIONS: u32 = 400;

/// A spring between a node of the bar and the rock.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Holder {
    /// The node.
    pub node: u32,
    /// Its law.
    pub law: Law,
}

/// Steel between neighbouring nodes, and springs that hold them, in order along the bar.
#[derive(Clone, Copy)]
pub(crate) struct Chain<'a> {
    /// Steel between node i and i + 1.
    pub steel: &'a [Law],
    /// Elongations that the steel has at rest, negative where it is stretched at the start [m].
    pub rest_m: &'a [f64],
    /// What has yielded of the steel [m].
    pub yielded_m: &'a [f64],
    /// Whether it is broken.
    pub broken: &'a [bool],
    /// Springs that hold the bar.
    pub holders: &'a [Holder],
    /// Their slip [m].
    pub slip_m: &'a [f64],
    /// Displacement of the rock at each [m].
    pub rock_m: &'a [f64],
}

/// Memory of the solve, for the longest bar.
#[derive(Clone, Debug, Default)]
pub(crate) struct Workspace {
    /// Rest of the forces on each node [N].
    rest: Vec<f64>,
    /// Rounding of it [N].
    rounding: Vec<f64>,
    held: Vec<f64>,
    link: Vec<f64>,
    step: Vec<f64>,
    trial: Vec<f64>,
}

impl Workspace {
    /// For bars of so many nodes.
    pub(crate) fn new(nodes: usize) -> Self {
        let zeros = vec![0.0; nodes];
        Self {
            rest: zeros.clone(),
            rounding: zeros.clone(),
            held: zeros.clone(),
            link: zeros.clone(),
            step: zeros.clone(),
            trial: zeros,
        }
    }
}

impl Chain<'_> {
    /// Elongation of the steel between node i and i + 1 beyond what has yielded [m].
    pub(crate) fn stretch_m(&self, i: usize, u: &[f64]) -> f64 {
        u[i + 1] - u[i] - self.rest_m[i] - self.yielded_m[i]
    }

    /// Displacement of the bar beyond the rock and the slip at holder k [m].
    pub(crate) fn offset_m(&self, k: usize, u: &[f64]) -> f64 {
        u[self.holders[k].node as usize] - self.rock_m[k] - self.slip_m[k]
    }

    /// Tension between node i and i + 1 [N].
    pub(crate) fn tension_n(&self, i: usize, u: &[f64]) -> f64 {
        if self.broken[i] { 0.0 } else { self.steel[i].force_n(self.stretch_m(i, u)) }
    }

    /// Force of the bar on the rock at holder k [N].
    pub(crate) fn hold_n(&self, k: usize, u: &[f64]) -> f64 {
        self.holders[k].law.force_n(self.offset_m(k, u))
    }

    /// The potential that is least at rest [J].
    pub(crate) fn potential_j(&self, u: &[f64]) -> f64 {
        let steel = self.steel.iter().enumerate().filter(|(i, _)| !self.broken[*i]);
        let steel = steel.map(|(i, law)| law.potential_j(self.stretch_m(i, u))).sum::<f64>();
        let holders = self.holders.iter().enumerate();
        steel + holders.map(|(k, one)| one.law.potential_j(self.offset_m(k, u))).sum::<f64>() + 0.0
    }

    /// u ← where the bar is in balance, from where it was; returns the number of iterations.
    pub(crate) fn solve(&self, u: &mut [f64], workspace: &mut Workspace) -> u32 {
        for iteration in 0..MOST_ITERATIONS {
            if self.gather(u, workspace) {
                return iteration;
            }
            self.find_step(u.len(), workspace);
            self.go(u, workspace);
        }
        MOST_ITERATIONS
    }

    /// Forces that are left and the stiffnesses of the moment; whether nothing is left but rounding.
    fn gather(&self, u: &[f64], workspace: &mut Workspace) -> bool {
        let nodes = u.len();
        workspace.rest[..nodes].fill(0.0);
        workspace.rounding[..nodes].fill(0.0);
        workspace.held[..nodes].fill(0.0);
        for (k, holder) in self.holders.iter().enumerate() {
            let (i, x) = (holder.node as usize, self.offset_m(k, u));
            workspace.rest[i] -= holder.law.force_n(x);
            let size_m = u[i].abs() + self.rock_m[k].abs() + self.slip_m[k].abs();
            workspace.rounding[i] += holder.law.stiffness_n_m * size_m;
            workspace.held[i] += tangent(&holder.law, x);
        }
        for (i, law) in self.steel.iter().enumerate() {
            workspace.link[i] = 0.0;
            if self.broken[i] {
                continue;
            }
            let x = self.stretch_m(i, u);
            let force_n = law.force_n(x);
            workspace.rest[i] += force_n;
            workspace.rest[i + 1] -= force_n;
            let size_m = u[i].abs() + u[i + 1].abs() + self.rest_m[i].abs() + self.yielded_m[i].abs();
            let rounding = law.stiffness_n_m * size_m;
            workspace.rounding[i] += rounding;
            workspace.rounding[i + 1] += rounding;
            workspace.link[i] = tangent(law, x);
        }
        let mut pairs = workspace.rest[..nodes].iter().zip(&workspace.rounding[..nodes]);
        pairs.all(|(rest, rounding)| rest.abs() <= 4.0 * f64::EPSILON * rounding)
    }

    /// step ← K⁻¹ rest. Node by node, all that is left of it is a spring E to the rock: E₊ = k₊ + l E/(l + E).
    fn find_step(&self, nodes: usize, workspace: &mut Workspace) {
        let Workspace { rest, held, link, step, .. } = workspace;
        for i in 0..nodes {
            step[i] = rest[i];
            if i > 0 {
                // The share of what is left behind that steel carries on.
                let share = link[i - 1] / (link[i - 1] + held[i - 1]);
                held[i] += share * held[i - 1];
                step[i] += share * step[i - 1];
            }
        }
        step[nodes - 1] /= held[nodes - 1];
        for i in (0..nodes - 1).rev() {
            step[i] = (step[i] + link[i] * step[i + 1]) / (link[i] + held[i]);
        }
    }

    /// u ← u + t step, where the slope along it is well below that at t = 0.
    fn go(&self, u: &mut [f64], workspace: &mut Workspace) {
        let Workspace { rest, step, trial, .. } = workspace;
        let (nodes, step) = (u.len(), &*step);
        let first: f64 = rest[..nodes].iter().zip(step).map(|(r, d)| r * d).sum();
        let place = |t: f64, trial: &mut [f64]| {
            trial.iter_mut().zip(u.iter().zip(step)).for_each(|(w, (u, d))| *w = u + t * d);
        };
        let (mut low, mut high, mut t) = (0.0, f64::INFINITY, 1.0);
        for _ in 0..64 {
            place(t, &mut trial[..nodes]);
            let slope = self.downhill(&trial[..nodes], step);
            if slope < -0.1 * first {
                high = t;
            } else if t == 1.0 || slope <= 0.1 * first {
                break;
            } else {
                low = t;
            }
            t = 0.5 * (low + high);
        }
        place(t, &mut trial[..nodes]);
        u.copy_from_slice(&trial[..nodes]);
    }

    /// −dΠ/dt along a direction.
    fn downhill(&self, u: &[f64], step: &[f64]) -> f64 {
        let mut slope = 0.0;
        for (k, holder) in self.holders.iter().enumerate() {
            slope -= self.hold_n(k, u) * step[holder.node as usize];
        }
        for i in 0..self.steel.len() {
            slope -= self.tension_n(i, u) * (step[i + 1] - step[i]);
        }
        slope
    }
}

fn tangent(law: &Law, elongation_m: f64) -> f64 {
    if law.is_elastic(elongation_m) { law.stiffness_n_m } else { LEFT * law.stiffness_n_m }
}

#[cfg(test)]
#[path = "chain_tests.rs"]
mod tests;
