//! A cube falls onto a face with an edge or a corner ahead, its mass centre above it: nothing slips, and friction takes no energy whatever its angle.

use crate::bouncing_block::step_until_it_leaves;
use crate::evidence::Answer::{AtMost, Within};
use crate::evidence::row;
use crate::simulation;

const FALL_M: f64 = 1.0;
const GRAVITY_M_S2: f64 = 9.81;

/// Velocity after the rebound over that of the impact: along the normal, and across it.
fn rebound(body: &str, turns: &str, friction_deg: f64) -> [f64; 2] {
    let mut simulation = simulation(&format!(
        "(title: \"cube\", time: (step_s: 5e-5, end_s: 1), gravity_m_s2: (0, 0, -{GRAVITY_M_S2}),
          materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2600)],
          blocks: [
              (name: \"floor\", material: \"rock\", body: Fixed, shape: Box(size_m: (6, 6, 1), cells: (1, 1, 1)), at_m: (-3, -3, -1)),
              (name: \"cube\", material: \"rock\", body: {body}, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1), pattern: TwentyFour), {turns},
               at_m: (0, 0, {FALL_M})),
          ],
          contact: Potential(penalty_pa: 2e9, potential: Smooth(), friction: (friction_deg: {friction_deg})))"
    ));
    let block = simulation.blocks().find("cube").unwrap();
    let nodes = simulation.blocks().nodes_of(block);
    let heights = simulation.state().position[nodes.clone()].iter().map(|x| x.z);
    let impact_m_s = (2.0 * GRAVITY_M_S2 * heights.fold(f64::INFINITY, f64::min)).sqrt();
    step_until_it_leaves(&mut simulation);
    let velocity = simulation.shape(block).operator.center(&simulation.state().velocity[nodes]);
    // Gravity has slowed it down by as much as it had made it quicker below the first contact.
    [velocity.z / impact_m_s, velocity.x.hypot(velocity.y) / impact_m_s]
}

#[test]
fn friction_takes_nothing_from_a_cube_that_falls_on_its_edge_or_its_corner() {
    let edge = "turns: [(axis: (1, 0, 0), angle_deg: 45)]";
    // A diagonal of the cube upright.
    let corner =
        "turns: [(axis: (0, 0, 1), angle_deg: 45), (axis: (0, 1, 0), angle_deg: 54.735610317245346)]";
    let falls = [("edge", edge), ("corner", corner)];
    for (body, (name, turns)) in
        ["Rigid", "Affine", "Elastic"].iter().flat_map(|body| falls.map(|fall| (body, fall)))
    {
        let without = rebound(body, turns, 0.0);
        for friction_deg in [15.0, 30.0, 45.0, 60.0] {
            let [along, across] = rebound(body, turns, friction_deg);
            let what = format!(
                "speed of a cube ({body}) after a fall on its {name} over that without friction, φ = {friction_deg}°"
            );
            row("friction at edges", &what, along / without[0], Within(1.0, 1e-4));
            let what = format!("sideways after a fall of a cube ({body}) on its {name}, φ = {friction_deg}°");
            row("friction at edges", &what, across, AtMost(1e-3));
        }
        let what = format!(
            "speed of a cube ({body}) after a fall on its {name} without friction over that of the impact"
        );
        row("friction at edges", &what, without[0], Within(1.0, 0.01));
    }
}
