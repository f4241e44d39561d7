//! Blasts of a scene: pressure over time on the walls of holes.

use std::sync::Arc;

use ndda_fem::{LinearField, PressureField, PressurePiece, Table};
use ndda_io::scene::{Blast, BlastPressure, BlastWall, Scene};
use ndda_mesh::{BlockId, BlockSet, Vec3};
use ndda_solver::{BodySetup, PressureSetup};

use super::regions::{boundary, in_region, outward_triangles};
use super::{Fault, vec3};

/// Rows of a table that is made of exponentials.
const ROWS: u32 = 2000;
/// Part of the peak at which it ends.
const OVER: f64 = 1e-6;

/// Gives bodies the pressure of blasts.
pub(super) fn add_blasts(
    scene: &Scene,
    blocks: &BlockSet,
    bodies: &mut [BodySetup],
    faults: &mut Vec<Fault>,
) {
    let one = LinearField { value: 1.0, gradient: Vec3::zeros() };
    let everywhere = PressurePiece { within: Vec::new(), pressure_pa: one };
    let field = Arc::new(PressureField { pieces: vec![everywhere] });
    for (i, blast) in scene.blasts.iter().enumerate() {
        let factor = Table { rows: pressure(blast) };
        match in_region(blocks, &blast.block, |block| wall(blocks, block, &blast.on)) {
            Ok(parts) => {
                for (block, triangles) in parts {
                    let (field, factor) = (field.clone(), Some(factor.clone()));
                    bodies[block.index()].pressures.push(PressureSetup { triangles, field, factor });
                }
            }
            Err(message) => faults.push(Fault::new(format!("blasts[{i}].on"), message)),
        }
    }
}

/// Triangles of a block that a blast presses on, counter-clockwise seen from outside.
fn wall(blocks: &BlockSet, block: BlockId, on: &BlastWall) -> Result<Vec<[u32; 3]>, String> {
    let (from_m, to_m, within_m) = match on {
        BlastWall::Part(region) => return outward_triangles(blocks, block, region),
        BlastWall::Hole { from_m, to_m, within_m } => (from_m, to_m, within_m),
    };
    let (from, to) = (vec3(*from_m) - blocks.origin_m, vec3(*to_m) - blocks.origin_m);
    let (length_m, axis) = ((to - from).norm(), (to - from).normalize());
    let slack_m = 0.01 * within_m;
    let rest = &blocks.rest_position[blocks.nodes_of(block)];
    let is_near = |n: &u32| {
        let arm = rest[*n as usize] - from;
        let along = arm.dot(&axis);
        (-slack_m..=length_m + slack_m).contains(&along) && (arm - along * axis).norm() <= *within_m
    };
    let near = boundary(blocks, block).map(|(_, nodes)| nodes).filter(|nodes| nodes.iter().all(is_near));
    let near: Vec<[u32; 3]> = near.collect();
    if near.is_empty() {
        let name = &blocks.names[block.index()];
        return Err(format!(
            "no boundary triangle of block `{name}` is within {within_m} m of this axis: the hole must be meshed, or within_m larger"
        ));
    }
    Ok(near)
}

/// Pressure over time [Pa], nothing before and after.
fn pressure(blast: &Blast) -> Vec<(f64, f64)> {
    let mut rows = match &blast.pressure {
        BlastPressure::Rows(rows) => rows.clone(),
        BlastPressure::Duvall { peak_pa, alpha_per_s, beta_per_s } => {
            duvall(*peak_pa, (*alpha_per_s, *beta_per_s))
        }
    };
    rows.iter_mut().for_each(|row| row.0 += blast.start_s);
    // A table is constant beyond its ends: jumps to and from nothing take the smallest time there is.
    let (first, last) = (rows[0], rows[rows.len() - 1]);
    if first.1 != 0.0 && first.0 > 0.0 {
        rows.insert(0, (first.0.next_down(), 0.0));
    }
    if first.1 != 0.0 && first.0 == 0.0 && last.0 > 0.0 {
        // A scene that settles does so at t = 0, before it.
        rows[0].0 = f64::EPSILON * last.0;
        rows.insert(0, (0.0, 0.0));
    }
    if last.1 != 0.0 {
        rows.push((last.0.next_up(), 0.0));
    }
    rows
}

/// p₀ ξ (exp(−α t) − exp(−β t)), with rows that are denser where it is steeper; each is that of an equal ratio of time.
fn duvall(peak_pa: f64, (alpha, beta): (f64, f64)) -> Vec<(f64, f64)> {
    let shape = |t: f64| (-alpha * t).exp() - (-beta * t).exp();
    let peak_s = (beta / alpha).ln() / (beta - alpha);
    let scale = peak_pa / shape(peak_s);
    let end_s = -(OVER * shape(peak_s)).ln() / alpha;
    let growth = (1.0 + end_s * beta).ln();
    let time = |k: u32| (growth * f64::from(k) / f64::from(ROWS)).exp_m1() / beta;
    let mut rows: Vec<(f64, f64)> = (0..ROWS).map(time).map(|t| (t, scale * shape(t))).collect();
    rows.push((end_s, 0.0));
    rows
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_double_exponential_has_its_peak_and_its_impulse() {
        for (alpha, beta) in [(1200.0, 12000.0), (500.0, 510.0), (1e3, 1e6)] {
            let table = Table { rows: duvall(2e8, (alpha, beta)) };
            let peak_s = (beta / alpha).ln() / (beta - alpha);
            assert!((table.at(peak_s) / 2e8 - 1.0).abs() < 1e-4, "{alpha} {beta}: {}", table.at(peak_s));
            let end_s = table.rows[table.rows.len() - 1].0;
            let impulse = table.between(0.0, end_s).mean * end_s;
            let scale = 2e8 / ((-alpha * peak_s).exp() - (-beta * peak_s).exp());
            let exact = scale * (1.0 / alpha - 1.0 / beta);
            assert!((impulse / exact - 1.0).abs() < 1e-4, "{alpha} {beta}: {}", impulse / exact);
        }
    }

    #[test]
    fn a_table_that_begins_or_ends_with_pressure_presses_at_no_other_time() {
        let rows = BlastPressure::Rows(vec![(0.0, 5.0), (1.0, 3.0)]);
        let on = BlastWall::Part(ndda_io::scene::Region::All);
        let blast = Blast { block: "a".into(), on, pressure: rows, start_s: 2.0 };
        let table = Table { rows: pressure(&blast) };
        for (t, p) in [(1.0, 0.0), (2.0, 5.0), (2.5, 4.0), (3.0, 3.0), (3.5, 0.0)] {
            assert_eq!(table.at(t), p, "{t}");
        }
        // From the start of a run on, before which a scene may settle.
        let table = Table { rows: pressure(&Blast { start_s: 0.0, ..blast }) };
        assert_eq!((table.at(0.0), table.at(0.5), table.at(1.5)), (0.0, 4.0, 0.0));
        assert!((table.between(0.0, 1.0).mean - 4.0).abs() < 1e-14);
    }
}
