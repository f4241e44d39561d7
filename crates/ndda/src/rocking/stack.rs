//! A block and what rests on it, on a base that accelerates.

use ndda_mesh::{BlockId, Vec3};
use ndda_solver::Simulation;

use crate::base_of_block::{Base, PLACES, with_all_on_it};

/// Part of the largest demand on a base from which on an instant is looked at.
const LEAST_DEMAND: f64 = 0.5;
/// Accelerations beyond so many g are not looked for.
const MOST_G: f64 = 100.0;

/// A block and all that rests on it alone, on its base.
#[derive(Clone)]
pub struct Stack<'a> {
    base: &'a Base,
    /// Number of blocks on the first.
    pub blocks_on_it: usize,
    mass_kg: f64,
    /// Mass centre [m].
    centre: Vec3,
    gravity: &'a Vec3,
}

/// Where weight and inertia meet the base, along a direction across it.
struct Foot {
    /// N, which presses the stack on its base [N].
    normal_n: f64,
    /// Place along the direction, from the base's origin [m].
    foot_m: f64,
    /// How far a tilt moves it on, per radian [m].
    arm_m: f64,
}

impl<'a> Stack<'a> {
    /// None where something rests on the stack and on other blocks, and where it does not stand at rest.
    pub fn new(
        simulation: &Simulation,
        bases: &[(BlockId, Base)],
        first: BlockId,
        base: &'a Base,
        gravity: &'a Vec3,
    ) -> Option<Self> {
        let stack = with_all_on_it(bases, first)?;
        let mass = |block: &BlockId| {
            let (operator, nodes) =
                (&simulation.shape(*block).operator, simulation.blocks().nodes_of(*block));
            (operator.mass_kg, operator.center(&simulation.blocks().rest_position[nodes]))
        };
        let masses: Vec<(f64, Vec3)> = stack.iter().map(mass).collect();
        let mass_kg: f64 = masses.iter().map(|(mass_kg, _)| mass_kg).sum();
        let centre = masses.iter().map(|(mass_kg, x)| *mass_kg * x).sum::<Vec3>() / mass_kg;
        let stack = Self { base, blocks_on_it: masses.len() - 1, mass_kg, centre, gravity };
        // One that falls under its own weight has no acceleration at which it begins to rock.
        let outs = base.outwards();
        let stands = outs.iter().all(|out| stack.stands_towards(out, &Vec3::zeros(), 0.0));
        (stands && !outs.is_empty()).then_some(stack)
    }

    /// Of the accelerations of its base, those that come nearest to toppling it over an edge or a corner.
    pub fn peaks(&self, accelerations: &[Vec3]) -> Vec<Vec3> {
        let nearest = |out: Vec3| {
            let at_rest_m = self.foot(&out, &Vec3::zeros()).foot_m;
            let left_m = self.base.bearing(&out).most_m - at_rest_m;
            // Part of what is left to the foot that it moves by.
            let demand = |acceleration: &Vec3| {
                let Foot { normal_n, foot_m, .. } = self.foot(&out, acceleration);
                if normal_n > 0.0 { (foot_m - at_rest_m) / left_m } else { f64::INFINITY }
            };
            let demands = accelerations.iter().map(|acceleration| (demand(acceleration), *acceleration));
            demands.max_by(|a, b| a.0.total_cmp(&b.0))
        };
        let mut peaks: Vec<(f64, Vec3)> = self.base.outwards().into_iter().filter_map(nearest).collect();
        let largest = peaks.iter().fold(0.0, |most, (demand, _)| f64::max(most, *demand));
        peaks.retain(|(demand, _)| *demand >= LEAST_DEMAND * largest && *demand > 0.0);
        let mut distinct: Vec<Vec3> = Vec::new();
        for (_, peak) in peaks {
            if !distinct.contains(&peak) {
                distinct.push(peak);
            }
        }
        distinct
    }

    /// The acceleration of the base along a direction up to which it stands [m/s²], for θ N = `soft_per_m` N²/∫ (s − s₀) dA; none where it does not stand at rest, or
    /// where nothing topples it.
    pub fn threshold(&self, along: &Vec3, soft_per_m: f64) -> Option<f64> {
        // Inertia tips it against the acceleration.
        let [one, two, _] = &self.base.axes;
        let own = Vec3::new(-one.dot(along), -two.dot(along), 0.0).try_normalize(0.0);
        let mut least = None;
        for out in own.into_iter().chain(self.base.outwards()) {
            let stands =
                |acceleration_m_s2: f64| self.stands_towards(&out, &(acceleration_m_s2 * along), soft_per_m);
            let (mut low, mut high) = (0.0, least.unwrap_or(MOST_G * self.gravity.norm()));
            if stands(high) {
                continue;
            }
            if !stands(low) {
                return None;
            }
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if stands(middle) { low = middle } else { high = middle }
            }
            least = Some(low);
        }
        least
    }

    /// Where weight and inertia meet the base as it accelerates, along a direction across it.
    fn foot(&self, out: &Vec3, acceleration: &Vec3) -> Foot {
        let pulls = [(self.centre, self.mass_kg * (self.gravity - acceleration))];
        let (normal_n, foot) = self.base.resultant(&pulls);
        Foot { normal_n, foot_m: foot.dot(out), arm_m: self.base.arm(&pulls, (normal_n, &foot), out) }
    }

    /// Whether a base that accelerates holds it from tipping in a direction.
    fn stands_towards(&self, out: &Vec3, acceleration: &Vec3, soft_per_m: f64) -> bool {
        let Foot { normal_n, foot_m, arm_m } = self.foot(out, acceleration);
        if normal_n <= 0.0 {
            return false;
        }
        let bearing = self.base.bearing(out);
        if soft_per_m == 0.0 || foot_m > bearing.most_m {
            return foot_m <= bearing.most_m;
        }
        (0..PLACES).any(|k| {
            let [first, centre_m] = bearing.beyond(f64::from(k));
            first > 0.0 && centre_m >= foot_m + soft_per_m * normal_n / first * arm_m
        })
    }
}
