//! Contact damping: the rebound of a central impact is the coefficient of restitution, whatever the body, the potential, the penalty and the step; what
//! rings comes to rest, and friction then holds what statics says that it holds.

use ndda::judge::verdict;
use ndda::summary::LabelWord;
use ndda_contact::testing::Random;
use ndda_mesh::{BlockId, Vec3};
use ndda_solver::{Settle, Simulation};

use crate::evidence::Answer::{AtLeast, AtMost, Near, Within};
use crate::evidence::{rounding, row};
use crate::{advance, displacements, simulation};

const SPEED_M_S: f64 = 0.5;
const DENSITY_KG_M3: f64 = 2500.0;
const CASE: &str = "coefficient of restitution";
/// What none counts as: with less, contact would stay where an impact has pressed it.
const LEAST: f64 = 0.005;

/// A cube of stiff rock that meets a wider plate at a given part of a step.
struct Bounce {
    body: &'static str,
    potential: &'static str,
    restitution: f64,
    penalty_pa: f64,
    /// ω Δt of the cube as one mass on the patch.
    h: f64,
    part: f64,
    integrator: &'static str,
}

impl Bounce {
    /// Two smooth fields, or two volumes of one half, of slope 1 over a metre; four heights of the paper's potential in a cube of two cells.
    fn stiffness_pa_m(&self) -> f64 {
        if self.potential == "Element" { 27.7 * self.penalty_pa } else { 2.0 * self.penalty_pa }
    }

    fn step_s(&self) -> f64 {
        self.h / (self.stiffness_pa_m() / DENSITY_KG_M3).sqrt()
    }

    fn simulation(&self) -> Simulation {
        let Self { body, potential, restitution, penalty_pa, integrator, .. } = self;
        let step_s = self.step_s();
        let height_m = 0.25 + self.part * step_s * SPEED_M_S;
        simulation(&format!(
            "(title: \"bounce\", time: (step_s: {step_s:e}, end_s: 1e3, integrator: {integrator}),
              materials: [(name: \"rock\", young_pa: {:e}, poisson: 0, density_kg_m3: {DENSITY_KG_M3})],
              blocks: [
                (name: \"base\", material: \"rock\", body: Fixed, shape: Box(size_m: (1.93, 1.93, 0.25), cells: (2, 2, 1)), at_m: (-0.46, -0.49, 0)),
                (name: \"cube\", material: \"rock\", body: {body}, shape: Box(size_m: (1, 1, 1), cells: (2, 2, 2)), at_m: (0, 0, {height_m:e}),
                 velocity_m_s: (0, 0, -{SPEED_M_S})),
              ],
              contact: Potential(penalty_pa: {penalty_pa:e}, potential: {potential}, restitution: {restitution}))",
            1.25e5 * self.stiffness_pa_m()
        ))
    }

    /// Bound of the error of the rebound. Explicit contact holds back h²/4 of its energy, h = ω Δt, at either end of it: h²/8 of the speed. Stiff rock takes some for its own
    /// vibrations, by the part that contact's stiffness is of its own, 1/1.25e5. The field of `Smooth` is linear but for the depth v/ω over L₀, the energy of
    /// contact by as much, and the rebound by a quarter of it. So is that of `Element`, but for the depth over the height of the base's
    /// tetrahedra, 0.25 m. Where nothing is to come back, what the blow leaves of vibrations in a cube that deforms counts as
    /// rebound: docs/theory/contact.md says 0.01 in all.
    fn error(&self) -> f64 {
        let depth_m = SPEED_M_S * self.step_s() / self.h;
        let bends = match (self.restitution == 0.0 && self.body != "Rigid", self.potential) {
            (true, _) => return 0.01 - LEAST,
            (_, "Smooth(reference_m: 1)") => 0.25 * depth_m,
            (_, "Element") => 0.25 * depth_m / 0.25,
            _ => 0.0,
        };
        0.125 * self.h * self.h + 8e-6 + bends
    }

    /// Speed after over that before, and the largest work of damping in a step over the energy of the impact, which never gives energy.
    fn rebound(&self) -> (f64, f64) {
        let mut simulation = self.simulation();
        let impact_j = 0.5 * DENSITY_KG_M3 * SPEED_M_S * SPEED_M_S;
        let (mut touched, mut last_j, mut given_j) = (false, 0.0, 0.0f64);
        for _ in 0..(20.0 / self.h) as u32 {
            let report = simulation.step().unwrap();
            let work_j = simulation.sample().unwrap().restitution_work_j;
            given_j = given_j.max(work_j - last_j);
            last_j = work_j;
            touched |= report.contact.contact_pairs > 0;
            if touched && report.contact.contact_pairs == 0 {
                break;
            }
        }
        let momentum = simulation.sample().unwrap().momentum.z;
        (momentum / (DENSITY_KG_M3 * SPEED_M_S), given_j / impact_j)
    }
}

const POTENTIALS: [&str; 3] = ["Smooth(reference_m: 1)", "Element", "Volume(exponent: 2, reference_m3: 1)"];

#[test]
fn a_cube_rebounds_by_the_coefficient_whatever_its_body_the_potential_the_penalty_and_the_step() {
    let mut random = Random(5);
    for potential in POTENTIALS {
        for body in ["Rigid", "Affine", "Elastic"] {
            for restitution in [0.0, 0.3, 0.6, 0.9] {
                let mut given = 0.0f64;
                // Without any restitution a cube stops within a step or two, and its own elasticity sees a blow.
                let steps = if restitution == 0.0 { [0.02, 0.05] } else { [0.05, 0.2] };
                for (h, penalty_pa) in steps.into_iter().zip([4e6, 4e8]) {
                    let part = random.unit();
                    let integrator = "Midpoint()";
                    let bounce = Bounce { body, potential, restitution, penalty_pa, h, part, integrator };
                    let (rebound, given_part) = bounce.rebound();
                    given = given.max(given_part);
                    let what = format!("rebound, e = {restitution}, {body}, {potential}, ω Δt = {h}");
                    row(CASE, &what, rebound, Near(restitution.max(LEAST), bounce.error()));
                }
                // Damping only takes: rounding of up to 20/0.02 steps.
                row(
                    CASE,
                    &format!("energy that damping gave in a step, e = {restitution}, {body}, {potential}"),
                    given,
                    AtMost(rounding(1000)),
                );
            }
        }
    }
}

#[test]
fn generalised_alpha_rebounds_by_the_coefficient_from_its_least_on() {
    for integrator in ["GeneralizedAlpha(radius: 0.8)", "GeneralizedAlpha(radius: 0.5)"] {
        for restitution in [0.3, 0.7] {
            for h in [0.05, 0.1] {
                let potential = POTENTIALS[0];
                let bounce = Bounce {
                    body: "Elastic",
                    potential,
                    restitution,
                    penalty_pa: 4e6,
                    h,
                    part: 0.4,
                    integrator,
                };
                let what = format!("rebound, e = {restitution}, {integrator}, ω Δt = {h}");
                row(CASE, &what, bounce.rebound().0, Near(restitution, bounce.error()));
            }
        }
    }
}

/// A block of 18 m on a plane of 30° that passes through its base.
fn tall_block(friction_deg: f64, restitution: f64, step_s: f64, gravity: &str) -> Simulation {
    simulation(&format!(
        "(title: \"tall\", time: (step_s: {step_s}, end_s: 10), gravity_m_s2: (0, 0, -9.81), {gravity}
          materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2650)],
          rock: [(name: \"slope\", material: \"rock\", body: Rigid, domain: Box(min_m: (0, 0, 0), max_m: (20, 5, 18)),
            joints: [Plane(name: \"p\", dip_deg: 30, dip_direction_deg: 90, point_m: (10, 0, 6))],
            fixed: [Beyond(point_m: (10, 0, 6), normal: (-0.5, 0, -0.8660254037844386))])],
          contact: Potential(penalty_pa: 1e9, potential: Smooth(), restitution: {restitution}, friction: (friction_deg: {friction_deg})))"
    ))
}

/// Farthest that a node has moved [m].
fn farthest_m(simulation: &Simulation) -> f64 {
    displacements(simulation).iter().map(|u| u.norm()).fold(0.0, f64::max)
}

#[test]
fn a_tall_block_stands_on_its_plane_where_statics_says_so_and_undamped_hops_are_not_called_accurate() {
    let mut damped = tall_block(30.5, 0.3, 1e-4, "gravity_ramp_s: 0.5,");
    damped.sample().unwrap();
    advance(&mut damped, 20_000);
    let moved_m = farthest_m(&damped);
    row(CASE, "displacement of a tall block at F = 1.02, e = 0.3, in 2 s [m]", moved_m, AtMost(1e-3));
    advance(&mut damped, 5000);
    // Friction is found to 1e-7 of μN: an acceleration of that part of μ g for half a second.
    let slips_m = 0.5 * 1e-7 * 30.5f64.to_radians().tan() * 9.81 * 0.5 * 0.5;
    row(CASE, "… in the next half second [m]", (farthest_m(&damped) - moved_m).abs(), AtMost(slips_m));
    damped.sample().unwrap();
    assert_eq!(verdict::label(&damped, None).word, LabelWord::Accurate);

    let mut undamped = tall_block(30.5, 1.0, 1e-4, "gravity_ramp_s: 0.5,");
    undamped.sample().unwrap();
    advance(&mut undamped, 20_000);
    undamped.sample().unwrap();
    row(CASE, "… undamped, in 2 s [m]", farthest_m(&undamped), AtLeast(0.1));
    let label = verdict::label(&undamped, None);
    assert_eq!(label.word, LabelWord::Inaccurate);
    assert!(label.reasons.iter().any(|reason| reason.contains("restitution below 1")), "{:?}", label.reasons);
}

#[test]
fn a_tall_block_that_friction_cannot_hold_slides_as_statics_says() {
    let friction_deg = 20f64;
    let mut simulation = tall_block(friction_deg, 0.3, 1e-4, "");
    let dip = 30f64.to_radians();
    let expected = 9.81 * (dip.sin() - dip.cos() * friction_deg.to_radians().tan());
    let block =
        (0..2).map(BlockId).find(|&block| simulation.shape(block).is_free()).expect("a block that moves");
    let nodes = simulation.blocks().nodes_of(block);
    let speed = |simulation: &Simulation| {
        simulation.state().velocity[nodes.clone()].iter().sum::<Vec3>().norm() / nodes.len() as f64
    };
    advance(&mut simulation, 2000);
    let early = speed(&simulation);
    advance(&mut simulation, 3000);
    let found = (speed(&simulation) - early) / 0.3;
    row(CASE, "acceleration of a tall block at φ = 20°, e = 0.3 [m/s²]", found, Within(expected, 1e-3));
}

/// Plates of a metre that lie on a slope of 20° by shear springs, under gravity that comes suddenly.
fn plates(shear_pa_m: f64, step_s: f64) -> Simulation {
    let slope = 20f64.to_radians();
    let plate = |name: &str, z: f64| {
        format!(
            "(name: \"{name}\", material: \"rock\", body: Rigid, shape: Box(size_m: (1, 1, 0.2), cells: (1, 1, 1)), at_m: (0, 0, {z})),"
        )
    };
    simulation(&format!(
        "(title: \"plates\", time: (step_s: {step_s}, end_s: 30), gravity_m_s2: ({:e}, 0, {:e}),
          materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2650)],
          blocks: [
            (name: \"base\", material: \"rock\", body: Fixed, shape: Box(size_m: (4, 4, 1), cells: (1, 1, 1)), at_m: (-2, -2, -1)),
            {}{}{}
          ],
          contact: Potential(penalty_pa: 1e9, potential: Smooth(), restitution: 0.3,
            friction: (friction_deg: 30, shear_penalty_pa_m: {shear_pa_m:e})))",
        9.81 * slope.sin(),
        -9.81 * slope.cos(),
        plate("a", 0.0),
        plate("b", 0.2),
        plate("c", 0.4)
    ))
}

#[test]
fn a_stack_on_shear_springs_stops_to_creep_once_its_ringing_is_damped() {
    for shear_pa_m in [1e9, 1e8] {
        let step_s = 1e-4;
        let mut simulation = plates(shear_pa_m, step_s);
        advance(&mut simulation, 10_000);
        let early = displacements(&simulation);
        let end_s = if std::env::var_os("NDDA_LARGE").is_some() { 30 } else { 2 };
        advance(&mut simulation, (end_s - 1) * 10_000);
        let late = displacements(&simulation);
        let crept_m = early.iter().zip(&late).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
        let what = format!(
            "slip of a stack of three after its first second, k_s = {shear_pa_m:e} Pa/m, e = 0.3 [m]"
        );
        // The statement: nothing is left of its ringing. A thousandth of what three plates stretch the lowest spring by is nothing.
        let stretch_m = 3.0 * 2650.0 * 0.2 * 9.81 * 20f64.to_radians().sin() / shear_pa_m;
        row(CASE, &what, crept_m, AtMost(1e-3 * stretch_m));
    }
}

/// Three cubes of a metre that fall on a floor and on each other.
fn falling_cubes(body: &str, step_s: f64) -> Simulation {
    let cube = |name: &str, at: &str, turn: f64| {
        format!(
            "(name: \"{name}\", material: \"rock\", body: {body}, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), at_m: {at},
              turns: [(axis: (0.3, 1, 0.2), angle_deg: {turn})]),"
        )
    };
    simulation(&format!(
        "(title: \"fall\", time: (step_s: {step_s:e}, end_s: 10), gravity_m_s2: (0, 0, -9.81),
          materials: [(name: \"rock\", young_pa: 5e9, poisson: 0.2, density_kg_m3: 2500)],
          blocks: [
            (name: \"floor\", material: \"rock\", body: Fixed, shape: Box(size_m: (6, 6, 1), cells: (1, 1, 1)), at_m: (-2.5, -2.5, -1)),
            {}{}{}
          ],
          contact: Potential(penalty_pa: 1e8, potential: Smooth(), restitution: 0.3, friction: (friction_deg: 35)))",
        cube("a", "(0, 0, 0.05)", 3.0),
        cube("b", "(0.1, 0.05, 1.2)", 0.0),
        cube("c", "(1.4, 0, 0.3)", 12.0)
    ))
}

#[test]
fn damping_that_adds_energy_is_no_accurate_run() {
    let step_s: f64 = 2e-4;
    let mut simulation = falling_cubes("Elastic", step_s);
    for _ in 0..40 {
        advance(&mut simulation, (0.1 / step_s).round() as u64);
        simulation.sample().unwrap();
    }
    let gain = simulation.invariants().damping_gain;
    row(
        CASE,
        "energy that damping of elastic cubes adds at Δt = 2e-4 s, over the largest",
        gain,
        AtLeast(1e-4),
    );
    let label = verdict::label(&simulation, None);
    assert!(label.reasons.iter().any(|reason| reason.contains("contact damping")), "{:?}", label.reasons);
}

#[test]
fn a_stack_that_falls_comes_to_rest_and_energy_never_grows() {
    // Rock that deforms goes on to vibrate in itself, which contact does not damp; at steps of 1e-4 s dashpots feed these vibrations.
    for (body, step_s, left) in [("Rigid", 2e-4f64, 1e-8), ("Elastic", 5e-5, 1e-5)] {
        let mut simulation = falling_cubes(body, step_s);
        let start_j = simulation.sample().unwrap().total_j();
        let (mut most_j, mut kinetic_j, mut peak_j) = (f64::NEG_INFINITY, 0.0, 0.0f64);
        for _ in 0..150 {
            advance(&mut simulation, (0.02 / step_s).round() as u64);
            let sample = simulation.sample().unwrap();
            most_j = most_j.max(sample.total_j() - start_j);
            peak_j = peak_j.max(sample.kinetic_j);
            kinetic_j = sample.kinetic_j;
        }
        row(
            CASE,
            &format!("energy gained by falling cubes, {body}, over the largest kinetic energy"),
            most_j / peak_j,
            // The statement: none, not even in a step.
            AtMost(0.0),
        );
        row(
            CASE,
            &format!("kinetic energy of cubes that have fallen, {body}, after 3 s, over the largest"),
            kinetic_j / peak_j,
            AtMost(left),
        );
    }
}

#[test]
fn each_joint_and_each_pair_of_materials_has_its_own_restitution() {
    for (what, more) in [
        (
            "of the materials",
            "restitution: 0.9, material_pairs: [(between: (\"rock\", \"steel\"), restitution: 0.4)]",
        ),
        ("of the joint", "restitution: 1, rock_joints: [(joint: \"flat\", restitution: 0.4)]"),
    ] {
        let rock = what == "of the joint";
        let blocks = if rock {
            "rock: [(name: \"r\", material: \"rock\", body: Rigid, domain: Box(min_m: (0, 0, 0), max_m: (1, 1, 2)),
               joints: [Plane(name: \"flat\", dip_deg: 0, dip_direction_deg: 0, point_m: (0.5, 0.5, 1))],
               fixed: [Beyond(point_m: (0, 0, 1), normal: (0, 0, -1))])], gravity_m_s2: (0, 0, -10),"
        } else {
            "blocks: [(name: \"base\", material: \"steel\", body: Fixed, shape: Box(size_m: (2, 2, 1), cells: (1, 1, 1)), at_m: (-0.5, -0.5, 0)),
               (name: \"cube\", material: \"rock\", body: Rigid, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), at_m: (0, 0, 1), velocity_m_s: (0, 0, -1))],"
        };
        let mut simulation = simulation(&format!(
            "(title: \"own\", time: (step_s: 1e-4, end_s: 1), {blocks}
              materials: [(name: \"rock\", young_pa: 1e10, poisson: 0.2, density_kg_m3: 2500), (name: \"steel\", young_pa: 2e11, poisson: 0.3, density_kg_m3: 7800)],
              contact: Potential(penalty_pa: 1e7, potential: Smooth(), {more}))"
        ));
        if rock {
            // Gravity that comes suddenly rings without damping: swings of the depth between zero and twice its mean. Of ½ m g²/ω² each half swing
            // leaves e² = 0.16, and 1 s has 27 of them, of which 24 have to show.
            advance(&mut simulation, 10_000);
            let kinetic_j = simulation.sample().unwrap().kinetic_j;
            row(
                CASE,
                &format!("kinetic energy of a block that rang on a joint, restitution {what} [J]"),
                kinetic_j,
                AtMost(0.5 * 2500.0 * 10.0 * 10.0 / (2e7 / 2500.0) * 0.4f64.powi(2 * 24)),
            );
        } else {
            advance(&mut simulation, 1500);
            let momentum = simulation.sample().unwrap().momentum.z;
            // Of first order in the depth v/ω over L₀, as above; h² is far less.
            let omega: f64 = (2e7f64 / 2500.0).sqrt();
            row(CASE, &format!("rebound, restitution {what}"), momentum / 2500.0, Near(0.4, 0.25 / omega));
        }
    }
}

/// A rigid cube of 1 m that a force pushes on a plate, up to half of what friction bears after 0.05 s: it sticks, on shear springs of K = 1e5 N/m with
/// dashpots. Its velocity along the plate [m/s], and the label.
fn pushed_on_springs(restitution: f64, step_s: f64) -> (f64, LabelWord) {
    let mut simulation = simulation(&format!(
        "(title: \"pushed\", time: (step_s: {step_s:e}, end_s: 0.05), gravity_m_s2: (0, 0, -9.81),
          materials: [(name: \"rock\", young_pa: 5e9, poisson: 0.25, density_kg_m3: 2600)],
          blocks: [
            (name: \"plate\", material: \"rock\", body: Fixed, shape: Box(size_m: (3, 2, 0.5), cells: (2, 2, 1)), at_m: (-1, -0.5, -0.5)),
            (name: \"block\", material: \"rock\", body: Rigid, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), at_m: (0, 0.05, 0)),
          ],
          forces: [(block: \"block\", force_n: (10e3, 0, 0), factor: [(time_s: 0, factor: 0), (time_s: 0.05, factor: 1)])],
          contact: Potential(penalty_pa: 1e8, potential: Smooth(), friction: (friction_deg: 40, shear_penalty_pa_m: 1e5),
                             restitution: {restitution}))"
    ));
    simulation.sample().unwrap();
    advance(&mut simulation, (0.05 / step_s).round() as u64);
    simulation.sample().unwrap();
    let block = simulation.blocks().nodes_of(BlockId(1));
    let velocity = &simulation.state().velocity[block];
    let mean = velocity.iter().sum::<Vec3>() / velocity.len() as f64;
    (mean.x, verdict::label(&simulation, None).word)
}

/// The same of one mass, m x'' = F t/T − K x − α √(m K) x', by the midpoint rule in steps that are far shorter.
fn pushed_mass_m_s(factor: f64) -> f64 {
    let (mass_kg, spring_n_m, force_n, end_s) = (2600.0, 1e5, 1e4, 0.05);
    let dashpot = factor * f64::sqrt(mass_kg * spring_n_m);
    let steps = 200_000;
    let dt_s = end_s / f64::from(steps);
    let (mut x, mut v) = (0.0, 0.0);
    for step in 0..steps {
        let push_n = force_n * (f64::from(step) + 0.5) / f64::from(steps);
        let rate = |x: f64, v: f64| (push_n - spring_n_m * x - dashpot * v) / mass_kg;
        let (mid_x, mid_v) = (x + 0.5 * dt_s * v, v + 0.5 * dt_s * rate(x, v));
        x += dt_s * mid_v;
        v += dt_s * rate(mid_x, mid_v);
    }
    v
}

#[test]
fn a_block_creeps_against_its_dashpots_at_the_same_speed_whatever_the_step() {
    // α of docs/theory/contact.md.
    for (restitution, factor, steps_s, tilt) in
        [(0.3, 1.6706, [1e-3, 5e-4, 2.5e-4], 0.01), (0.0, 34.5007, [5e-4, 2.5e-4, 1.25e-4], 0.06)]
    {
        let exact = pushed_mass_m_s(factor);
        let (fine, _) = pushed_on_springs(restitution, steps_s[2] / 8.0);
        // Springs also turn the cube, whose dashpots see that.
        let what = format!("a block pushed on springs with dashpots, e = {restitution}: velocity [m/s]");
        row(CASE, &what, fine, Within(exact, tilt));
        for step_s in steps_s {
            let (found, label) = pushed_on_springs(restitution, step_s);
            let what = format!("… steps of {step_s:e} s, {}, over that with finer ones", label.as_str());
            row(CASE, &what, found / fine, Near(1.0, 0.01));
        }
    }
}

/// A plate of 4 × 4 × 0.02 m on a fixed one, so flat that it does not rock, at rest, that is given 1 mm/s along it: the speed at which it passes its place again after half an oscillation on
/// the shear springs, over that.
fn shear_rebound(normal: f64, shear: &str, body: &str, h: f64) -> f64 {
    let (shear_pa_m, area_m2, mass_kg) = (1e9f64, 16.0, DENSITY_KG_M3 * 0.32);
    let step_s = h / (shear_pa_m * area_m2 / mass_kg).sqrt();
    let mut simulation = simulation(&format!(
        "(title: \"plate\", time: (step_s: {step_s:e}, end_s: {:e}), gravity_m_s2: (0, 0, -10),
          materials: [(name: \"rock\", young_pa: 60e9, poisson: 0, density_kg_m3: {DENSITY_KG_M3})],
          blocks: [(name: \"base\", material: \"rock\", body: Fixed, shape: Box(size_m: (6, 6, 1), cells: (1, 1, 1)), at_m: (-1, -1, -1)),
                   (name: \"plate\", material: \"rock\", body: {body}, shape: Box(size_m: (4, 4, 0.02), cells: (2, 2, 1)), velocity_m_s: (1e-3, 0, 0))],
          contact: Potential(penalty_pa: 1e9, potential: Smooth(), restitution: {normal}, {shear} friction: (friction_deg: 60, shear_penalty_pa_m: {shear_pa_m:e})))",
        1e4 * step_s
    ));
    simulation.settle(&Settle::new(1e-3, 1_000_000)).unwrap();
    let nodes = simulation.blocks().nodes_of(BlockId(1));
    let mean = |values: &[Vec3]| values[nodes.clone()].iter().map(|v| v.x).sum::<f64>() / nodes.len() as f64;
    let start_m = mean(&simulation.state().position);
    let (mut gone_m, mut speed_m_s) = (0.0, 1e-3);
    for _ in 0..(4.0 * std::f64::consts::PI / h) as u64 {
        simulation.step().unwrap();
        let (now_m, now_m_s) =
            (mean(&simulation.state().position) - start_m, mean(&simulation.state().velocity));
        if now_m <= 0.0 {
            let part = gone_m / (gone_m - now_m);
            return -(speed_m_s + part * (now_m_s - speed_m_s)) / 1e-3;
        }
        (gone_m, speed_m_s) = (now_m, now_m_s);
    }
    panic!("the plate does not come back")
}

#[test]
fn half_an_oscillation_on_a_shear_spring_leaves_the_coefficient_along_the_face_whatever_the_normal_one() {
    let found = |normal: f64, e: f64, body: &str, h: f64| {
        shear_rebound(normal, &format!("shear_restitution: {e},"), body, h)
    };
    for body in ["Rigid", "Affine", "Elastic"] {
        for (normal, e) in [(1.0, 0.3), (0.5, 0.6), (0.5, 0.9), (0.9, 0.1)] {
            let what =
                format!("rebound along the face, e = {e}, {normal} along the normal, {body}, ω Δt = 0.01");
            row(CASE, &what, found(normal, e, body, 0.01), Near(e, 1e-2));
        }
    }
    // Dashpots are found to first order in the step.
    let [long, short] = [0.04, 0.02].map(|h| found(0.9, 0.1, "Rigid", h) - 0.1);
    row(
        CASE,
        "order of the rebound along the face in the step, e = 0.1",
        (long / short).log2(),
        Near(1.0, 0.15),
    );
    // Without one of its own, springs are damped by the α of the normal, 1.67 for 0.3: ζ = α/2.
    let zeta = 0.5 * 1.67f64;
    let expected = (-std::f64::consts::PI * zeta / (1.0 - zeta * zeta).sqrt()).exp();
    let what = "rebound along the face, e = 0.3 along the normal alone";
    row(CASE, what, shear_rebound(0.3, "", "Rigid", 0.01), Near(expected, 1e-2));
}
