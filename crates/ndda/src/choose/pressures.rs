//! Loads that press on contacts: the largest pressure of a scene and its stages, and where it comes from.

use ndda_io::scene::{BlastPressure, BlastWall, Body, FactorRow, Hold, Scene, Stage, Stress, Support};
use ndda_mesh::{BlockSet, Vec3};

use crate::build;

/// A pressure on contacts, and what brings it.
#[derive(Default)]
pub(super) struct Load {
    /// Pressure [Pa].
    pub pa: f64,
    /// What brings it, as a phrase before its value.
    what: String,
}

impl Load {
    /// What brings it, and how much that is.
    pub(super) fn in_words(&self) -> String {
        format!("{} of {:.1e} Pa", self.what, self.pa)
    }

    /// The larger one; the first of two that are equal.
    fn larger(self, other: Self) -> Self {
        if other.pa > self.pa { other } else { self }
    }
}

/// The load of the largest pressure that lasts: tractions, forces and pretension of bolts on a face of a block, stress, and water; `moves` says which blocks can.
pub(super) fn at_rest(scene: &Scene, blocks: &BlockSet, moves: &[bool], block_m: f64) -> Load {
    let mut loads = Vec::new();
    let mut add = |pa: f64, what: &str, stage: Option<&str>| {
        let what = stage.map_or(what.to_string(), |stage| format!("{what} in stage `{stage}`"));
        loads.push(Load { pa, what });
    };
    for (stage, load) in all(scene, &scene.tractions, |stage| stage.tractions.as_ref()) {
        add(norm(load.traction_pa) * largest_factor(&load.factor), "tractions", stage);
    }
    for (stage, load) in all(scene, &scene.forces, |stage| stage.forces.as_ref()) {
        let force_n = norm(load.force_n) * largest_factor(&load.factor);
        add(force_n / block_m.powi(2), "forces on a face of a block", stage);
    }
    if let Some(stress) = &scene.in_situ {
        add(largest(&stress.stress_pa), "stress in the ground (in_situ)", None);
    }
    for block in scene.blocks.iter().filter(|block| block.body != Body::Fixed) {
        add(
            block.initial_stress_pa.as_ref().map_or(0.0, largest),
            "initial stress (initial_stress_pa)",
            None,
        );
    }
    for bolt in &scene.bolts {
        add(bolt.pretension_n / block_m.powi(2), "pretension of bolts on a face of a block", None);
    }
    for (stage, water) in all(scene, &scene.water, |stage| stage.water.as_ref()) {
        let pa = build::water::largest_pa(gravity_in(scene, stage), blocks, water, moves);
        add(pa * largest_factor(&water.factor), "water", stage);
    }
    loads.into_iter().fold(Load::default(), Load::larger)
}

/// The blast of the largest pressure: its peak, in a hole times the part of a face of a block that the hole is seen on from one side.
pub(super) fn of_blasts(scene: &Scene, block_m: f64) -> Load {
    let of_one = |blast: &ndda_io::scene::Blast| {
        let peak_pa = match &blast.pressure {
            BlastPressure::Rows(rows) => rows.iter().map(|row| row.1).fold(0.0, f64::max),
            BlastPressure::Duvall { peak_pa, .. } => *peak_pa,
        };
        let part = match &blast.on {
            BlastWall::Part(_) => 1.0,
            BlastWall::Hole { from_m, to_m, within_m } => {
                let length_m = (Vec3::from(*to_m) - Vec3::from(*from_m)).norm();
                (2.0 * within_m * length_m.min(block_m) / block_m.powi(2)).min(1.0)
            }
        };
        Load { pa: part * peak_pa, what: "a blast on a face of a block".into() }
    };
    scene.blasts.iter().map(of_one).fold(Load::default(), Load::larger)
}

/// The larger of two loads.
pub(super) fn larger<'a>(a: &'a Load, b: &'a Load) -> &'a Load {
    if b.pa > a.pa { b } else { a }
}

/// All gravities of a scene and its stages [m/s²], the first one first.
pub(super) fn gravities(scene: &Scene) -> impl Iterator<Item = Vec3> {
    let of_stages = scene.stages.iter().filter_map(|stage| stage.gravity_m_s2);
    std::iter::once(scene.gravity_m_s2).chain(of_stages).map(Vec3::from)
}

/// Largest speed of supports that follow rows of displacements [m/s].
pub(super) fn speed_of_supports_m_s(scene: &Scene) -> f64 {
    let supports = all(scene, &scene.supports, |stage| stage.supports.as_ref());
    supports.map(|(_, support)| speed_m_s(support)).fold(0.0, f64::max)
}

fn speed_m_s(support: &Support) -> f64 {
    let Hold::Motion(rows) = &support.hold else { return 0.0 };
    let speeds = rows.windows(2).filter(|pair| pair[1].time_s > pair[0].time_s).map(|pair| {
        let gone = Vec3::from(pair[1].displacement_m) - Vec3::from(pair[0].displacement_m);
        gone.norm() / (pair[1].time_s - pair[0].time_s)
    });
    speeds.fold(0.0, f64::max)
}

/// What a scene has from its start, and what its stages bring, with their names.
pub(super) fn all<'a, T>(
    scene: &'a Scene,
    first: &'a [T],
    of_stage: impl Fn(&'a Stage) -> Option<&'a Vec<T>> + 'a,
) -> impl Iterator<Item = (Option<&'a str>, &'a T)> {
    let later = scene.stages.iter().flat_map(move |stage| {
        of_stage(stage).into_iter().flatten().map(|one| (Some(stage.name.as_str()), one))
    });
    first.iter().map(|one| (None, one)).chain(later)
}

/// Gravity in a stage; that of the start for none.
fn gravity_in(scene: &Scene, stage: Option<&str>) -> [f64; 3] {
    let until = scene.stages.iter().position(|one| Some(one.name.as_str()) == stage).map_or(0, |k| k + 1);
    scene.stages[..until].iter().filter_map(|one| one.gravity_m_s2).next_back().unwrap_or(scene.gravity_m_s2)
}

fn norm(v: [f64; 3]) -> f64 {
    Vec3::from(v).norm()
}

fn largest_factor(rows: &[FactorRow]) -> f64 {
    match rows.is_empty() {
        true => 1.0,
        false => rows.iter().map(|row| row.factor.abs()).fold(0.0, f64::max),
    }
}

fn largest(s: &Stress) -> f64 {
    [s.xx, s.yy, s.zz, s.xy, s.yz, s.zx].into_iter().map(f64::abs).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use crate::Model;

    /// The penalty that is chosen for a cube of 1 m on a fixed base, and why.
    fn chosen(of_cube: &str, more: &str) -> (f64, String) {
        let text = format!(
            "(title: \"loads\", time: (step_s: 1e-5, end_s: 1e-3),
            materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2500)],
            blocks: [(name: \"base\", material: \"rock\", body: Fixed, shape: Box(size_m: (3, 3, 2), cells: (1, 1, 1)), at_m: (-1, -1, -2)),
                     (name: \"cube\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)){of_cube})],
            contact: Potential(potential: Smooth()), {more})"
        );
        let chosen = Model::from_text(&text).unwrap().loaded.chosen;
        (chosen[0].value, chosen[0].reason.clone())
    }

    #[test]
    fn every_load_counts_for_the_penalty_and_is_named_wherever_it_is_written() {
        let bolt = |rest: &str| {
            format!(
                "bolts: [(name: \"b\", at: Line(from_m: (0.5, 0.5, 1), to_m: (0.5, 0.5, -1)), steel: (young_pa: 2e11, area_m2: 1e-3),
                  grout: (stiffness_n_m2: 2e9, strength_n_m: 4e6, from_m: 1.2), plate: (), pretension_n: 1e6)]{rest}"
            )
        };
        let traction = "tractions: [(block: \"cube\", on: Set(\"z_max\"), traction_pa: (0, 0, -1e6))]";
        let force = "forces: [(block: \"cube\", force_n: (0, 0, -5e5), factor: [(time_s: 0, factor: 1), (time_s: 1, factor: 2)])]";
        let water = "water: [(on: Part(block: \"cube\", region: Set(\"z_max\")), pressure: Linear(pressure_pa: 1e6))]";
        let blast = "blasts: [(block: \"cube\", on: Part(Set(\"z_max\")), pressure: Rows([(0, 0), (1e-4, 1e6), (1e-3, 0)]))]";
        let later = |what: &str| format!("stages: [(name: \"later\", {what}, then: Run(1e-3))]");
        let (of_traction_pa, _) = chosen("", traction);
        assert_eq!(of_traction_pa, 1e10);
        let cases = [
            ("", force.to_string(), "forces"),
            ("", water.to_string(), "water"),
            ("", blast.to_string(), "a blast"),
            ("", bolt(""), "pretension of bolts"),
            (
                "",
                bolt(", stages: [(name: \"later\", install: [\"b\"], then: Run(1e-3))]"),
                "pretension of bolts",
            ),
            (", initial_stress_pa: (zz: -1e6)", String::new(), "initial stress"),
            ("", later(traction), "tractions in stage `later`"),
            ("", later(force), "in stage `later`"),
            ("", later(water), "water in stage `later`"),
        ];
        for (of_cube, more, named) in cases {
            let (penalty_pa, why) = chosen(of_cube, &more);
            assert_eq!(penalty_pa, of_traction_pa, "{more}: {why}");
            assert!(why.contains(named), "{named}: {why}");
        }
    }

    #[test]
    fn gravity_of_a_stage_and_supports_that_move_count_for_the_penalty() {
        let heavy = "stages: [(name: \"later\", gravity_m_s2: (0, 0, -9.81), then: Run(1e-3))]";
        assert_eq!(chosen("", heavy).0, chosen("", "gravity_m_s2: (0, 0, -9.81)").0);
        let moved = "supports: [(block: \"base\", on: All, hold: Motion([(time_s: 0, displacement_m: (0, 0, 0)), (time_s: 0.1, displacement_m: (0, 0, 1))]))]";
        let (penalty_pa, why) = chosen("", moved);
        assert_eq!(penalty_pa, chosen(", velocity_m_s: (0, 0, -10)", "").0);
        assert!(why.contains("10.00 m/s"), "{why}");
    }
}
