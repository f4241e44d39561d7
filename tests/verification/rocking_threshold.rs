//! A cube on a base that accelerates begins to rock where `ndda check` says, in whatever direction the base moves. On a base with a steady acceleration a it stands as it does
//! under gravity g − a; the largest a under which it still comes to rest is found by halving.

use ndda::rocking;
use ndda_mesh::Vec3;
use ndda_solver::{Settle, Simulation};

use crate::evidence::Answer::Within;
use crate::evidence::row;

const G: f64 = 9.81;
const PENALTY_PA: f64 = 2e8;

/// A cube of 1 m on a fixed base, under some gravity; `supports` are those of the base.
fn text(gravity_m_s2: Vec3, supports: &str) -> String {
    let [x, y, z] = [gravity_m_s2.x, gravity_m_s2.y, gravity_m_s2.z];
    format!(
        "(title: \"cube\", time: (step_s: 1e-3, end_s: 1), gravity_m_s2: ({x}, {y}, {z}),
          materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2500)],
          blocks: [
              (name: \"base\", material: \"rock\", body: Fixed, shape: Box(size_m: (4, 4, 1), cells: (1, 1, 1)), at_m: (-2, -2, -1)),
              (name: \"cube\", material: \"rock\", body: Rigid, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), at_m: (-0.5, -0.5, 0)),
          ],
          supports: [{supports}],
          contact: Potential(penalty_pa: {PENALTY_PA:e}, potential: Smooth(reference_m: 1), friction: (friction_deg: 70)))"
    )
}

/// The acceleration at which the cube begins to rock on a base that a record moves in a direction [m/s²], as `ndda check` says.
fn foreseen(direction: Vec3) -> f64 {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("record.csv"), "time_s,acceleration_m_s2\n0,0\n1,5\n2,0\n").unwrap();
    let [x, y, z] = [direction.x, direction.y, direction.z];
    let record = format!("(direction: ({x}, {y}, {z}), record: (file: \"record.csv\"))");
    let supports = format!("(block: \"base\", on: All, hold: Shaking([{record}]))");
    let text = text(Vec3::new(0.0, 0.0, -G), &supports);
    let loaded = ndda_io::read::load_text("case.ron", &text, &[], None).unwrap_or_else(|e| panic!("{e}"));
    let blocks = ndda::build::blocks(&loaded.scene, folder.path()).unwrap();
    let simulation = ndda::build::simulation(&loaded.scene, blocks, folder.path()).unwrap();
    rocking::worst(&loaded.scene, &simulation).expect("a base that shakes").rocks_at_m_s2
}

/// Whether the cube comes to rest on a base that accelerates.
fn stands(acceleration: Vec3) -> bool {
    let mut simulation: Simulation = crate::simulation(&text(Vec3::new(0.0, 0.0, -G) - acceleration, ""));
    simulation.settle(&Settle::new(1e-6, 20_000)).is_ok()
}

#[test]
fn a_cube_begins_to_rock_where_the_check_says_in_whatever_direction_its_base_moves() {
    for (name, direction) in [
        ("straight across an edge", Vec3::new(1.0, 0.0, 0.0)),
        ("obliquely by 22.5°", Vec3::new(22.5_f64.to_radians().cos(), 22.5_f64.to_radians().sin(), 0.0)),
        ("over a corner", Vec3::new(0.5_f64.sqrt(), 0.5_f64.sqrt(), 0.0)),
        ("obliquely by 30° and downwards", Vec3::new(0.75_f64.sqrt(), 0.5, -0.5).normalize()),
    ] {
        let rocks_at = foreseen(direction);
        let (mut low, mut high) = (0.9 * rocks_at, 1.1 * rocks_at);
        assert!(stands(low * direction) && !stands(high * direction), "{name}: {rocks_at}");
        for _ in 0..7 {
            let middle = 0.5 * (low + high);
            if stands(middle * direction) { low = middle } else { high = middle }
        }
        let name = format!("acceleration at which a cube begins to rock, {name} [m/s²]");
        // A third of what the label lets penetration take. Under oblique motion the base tilts about two axes; the check lets it tilt about one.
        row("rocking threshold", &name, low, Within(rocks_at, 0.02));
    }
}
