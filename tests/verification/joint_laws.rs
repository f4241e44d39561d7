//! Laws of rock joints: by the driver of `ndda joint` against closed forms, and in scenes.

use ndda::build::friction::joint_law;
use ndda::joint::{ClosureTest, Hold, NormalStiffness, ShearRow, ShearTest};
use ndda::safety::Question;
use ndda_io::scene::{Contact, Friction, Scene};
use ndda_mesh::{BlockId, Vec3};
use ndda_solver::{Settle, Simulation};

use crate::evidence::Answer::{AtMost, Within};
use crate::evidence::{rounding, row};
use crate::{advance, displacements, safety_factor, simulation};

const SHEAR_PA_M: f64 = 10e9;
/// Rounding of what is exact without time steps: a few dozen operations, elementary functions among them, and a search to 4 ε.
const ROUNDED: f64 = 100.0 * f64::EPSILON;

fn tan(deg: f64) -> f64 {
    deg.to_radians().tan()
}

/// The law that a scene would have.
fn law(text: &str) -> Friction {
    let scene = format!(
        "(title: \"joint\", time: (step_s: 1, end_s: 1), materials: [(name: \"rock\", young_pa: 1e9, poisson: 0.2, density_kg_m3: 2600)],
          blocks: [(name: \"a\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)))],
          contact: Potential(penalty_pa: 1e9, potential: Smooth(), friction: (shear_penalty_pa_m: {SHEAR_PA_M:e}, {text})))"
    );
    let loaded = ndda_io::read::load_text("joint.ron", &scene, &[], None).unwrap_or_else(|e| panic!("{e}"));
    match loaded.scene {
        Scene { contact: Some(Contact::Potential { friction: Some(friction), .. }), .. } => friction,
        other => panic!("{other:?}"),
    }
}

/// A joint with this law, sheared along a path.
pub(crate) fn sheared(text: &str, stress_pa: f64, hold: Hold, path_m: &[f64]) -> Vec<ShearRow> {
    let normal = NormalStiffness::Linear { stiffness_pa_m: 10e9 };
    let test = ShearTest { stress_pa, hold, normal, path_m: path_m.to_vec() };
    test.run(joint_law(&law(text)).expect("a strength").as_ref()).expect("a test")
}

#[test]
fn rough_joints_have_the_strength_of_barton_and_bandis() {
    for stress_mpa in [0.5f64, 1.0, 2.0, 5.0, 10.0] {
        let text = "friction_deg: 30, roughness: (jrc: 10, jcs_pa: 100e6)";
        let rows = sheared(text, 1e6 * stress_mpa, Hold::Stress, &[0.01]);
        let exact_pa = 1e6 * stress_mpa * tan(30.0 + 10.0 * (100.0 / stress_mpa).log10());
        let what =
            format!("shear strength of a joint of JRC 10, JCS 100 MPa, φ_r 30° at {stress_mpa} MPa [Pa]");
        row("rough joints", &what, rows[1].shear_pa, Within(exact_pa, ROUNDED));
    }
    let long = "friction_deg: 30, roughness: (jrc: 10, jcs_pa: 100e6, length_m: 2)";
    let rows = sheared(long, 1e6, Hold::Stress, &[0.01]);
    let ratio = 20f64;
    let exact_pa = 1e6 * tan(30.0 + 10.0 * ratio.powf(-0.2) * (100.0 * ratio.powf(-0.3)).log10());
    row(
        "rough joints",
        "the same of a joint 2 m long at 1 MPa [Pa]",
        rows[1].shear_pa,
        Within(exact_pa, ROUNDED),
    );
}

#[test]
fn dilation_lifts_loads_and_dissipates_as_its_closed_forms() {
    let yields_m = 1e6 * tan(30.0) / SHEAR_PA_M;
    for to_slip_m in [1.0f64, 3e-3] {
        let text = format!("friction_deg: 30, dilation: (psi_deg: 10, to_slip_m: {to_slip_m})");
        let path_m = [0.0, 3e-3, 5e-3].map(|slip| yields_m + slip);
        let end = sheared(&text, 1e6, Hold::Stress, &path_m)[3];
        let lift_m = to_slip_m.min(5e-3) * tan(10.0);
        let until = format!("φ 30°, ψ 10° to a slip of {to_slip_m} m, 5 mm of slip at 1 MPa");
        row("dilation", &format!("lift, {until} [m]"), end.opening_m, Within(lift_m, ROUNDED));
        let lost_j_m2 = 1e6 * (5e-3 * tan(30.0) - lift_m);
        row(
            "dilation",
            &format!("energy lost, {until} [J/m²]"),
            end.dissipated_j_m2,
            Within(lost_j_m2, ROUNDED),
        );
    }
    let spring = Hold::Stiffness { stiffness_pa_m: 1e9 };
    for (hold, held_pa_m, words) in
        [(Hold::Volume, 1e10, "constant volume"), (spring, 1e10 / 11.0, "1 GPa/m in series")]
    {
        let text = "friction_deg: 30, dilation: (psi_deg: 10, to_slip_m: 1)";
        for end in &sheared(text, 1e6, hold, &[1e-3, 2e-3, 5e-3])[1..] {
            let exact_pa = (1e6 + held_pa_m * tan(10.0) * end.slip_m)
                / (1.0 + held_pa_m * tan(10.0) * tan(30.0) / SHEAR_PA_M);
            let what = format!("normal stress at a slip of {} mm, {words} [Pa]", 1e3 * end.slip_m);
            row("dilation", &what, end.normal_pa, Within(exact_pa, ROUNDED));
        }
    }
}

#[test]
fn a_closing_joint_has_the_stiffness_and_energy_of_bandis() {
    let (initial_pa_m, most_m) = (20e9, 0.3e-3);
    let normal = NormalStiffness::Hyperbolic { initial_pa_m, most_m };
    for stress_pa in [1e6f64, 2e6, 10e6] {
        let end = ClosureTest { stress_pa, normal, steps: 50 }.run().expect("a test")[50];
        let closure_m = most_m * stress_pa / (initial_pa_m * most_m + stress_pa);
        let tangent_pa_m = initial_pa_m * (1.0 - stress_pa / (most_m * initial_pa_m + stress_pa)).powi(-2);
        let part = closure_m / most_m;
        let energy_j_m2 = -initial_pa_m * most_m * most_m * ((1.0 - part).ln() + part);
        let at = format!("at {} MPa, k_ni 20 GPa/m, V_m 0.3 mm", 1e-6 * stress_pa);
        row("closure", &format!("closure {at} [m]"), end.closure_m, Within(closure_m, ROUNDED));
        // Differences over 2e-4 of one of 50 steps: they lose that part of the digits, twentyfold.
        let lost = 20.0 * rounding(50) / 2e-4;
        row(
            "closure",
            &format!("stiffness by differences {at} [Pa/m]"),
            end.tangent_pa_m,
            Within(tangent_pa_m, lost),
        );
        row(
            "closure",
            &format!("energy by quadrature {at} [J/m²]"),
            end.energy_j_m2,
            // Rounding of 50 steps of five points each, twofold; the rule itself is exact to degree 9.
            Within(energy_j_m2, 2.0 * rounding(250)),
        );
    }
}

/// A block that has settled on a fixed one, of rock 40 m high in weight: σ 1.04 MPa.
#[test]
fn a_block_closes_the_joint_that_it_stands_on_by_the_hyperbola() {
    let mut settled = simulation(
        "(title: \"closure\", time: (step_s: 1e-4, end_s: 1), gravity_m_s2: (0, 0, -10),
          materials: [(name: \"floor\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2600), (name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 104e3)],
          blocks: [
              (name: \"floor\", material: \"floor\", body: Fixed, shape: Box(size_m: (3, 3, 1), cells: (3, 3, 1)), at_m: (-1, -1, -1)),
              (name: \"block\", material: \"rock\", body: Rigid, shape: Box(size_m: (1, 1, 1), cells: (2, 2, 2))),
          ],
          contact: Potential(penalty_pa: 10e9, potential: Closure(max_closure_m: 0.3e-3), friction: (friction_deg: 30)))",
    );
    settled.settle(&Settle::new(1e-8, 200_000)).unwrap();
    let block = settled.blocks().nodes_of(BlockId(1));
    let sunk_m =
        -displacements(&settled)[block.clone()].iter().map(|u| u.z).sum::<f64>() / block.len() as f64;
    let stress_pa = 104e3 * 10.0;
    let closure_m = 0.3e-3 * stress_pa / (20e9 * 0.3e-3 + stress_pa);
    row("closure", "closure under a block that has settled [m]", sunk_m, Within(closure_m, 1e-3));
    let energy_j = settled.sample().unwrap().contact_j;
    let exact_j = -20e9 * 0.3e-3f64.powi(2) * ((1.0 - closure_m / 0.3e-3).ln() + closure_m / 0.3e-3);
    row("closure", "energy of its contact [J]", energy_j, Within(exact_j, 2e-3));
}

const GRAVITY_M_S2: f64 = 9.8;
const SLOPE_DEG: f64 = 35.0;
/// Gravity grows for so long, so that the slab does not bounce [s].
const RAMP_S: f64 = 0.02;
const END_S: f64 = 0.25;

/// A rigid slab on a joint that dips, its law being that of `contact`.
fn slab(gravity: &str, contact: &str) -> String {
    format!(
        "(title: \"slab\", time: (step_s: 1e-4, end_s: {END_S}), gravity_m_s2: (0, 0, -{GRAVITY_M_S2}), {gravity}
          materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2650)],
          rock: [(name: \"slope\", material: \"rock\", domain: Box(min_m: (0, 0, 0), max_m: (4, 2, 5)), body: Rigid, fill: Centre,
              fixed: [Beyond(point_m: (2, 1, 2.5), normal: (-{0}, 0, -{1}))],
              joints: [Plane(name: \"bed\", dip_deg: {SLOPE_DEG}, dip_direction_deg: 90, point_m: (2, 1, 2.5)),
                  Plane(name: \"top\", dip_deg: {SLOPE_DEG}, dip_direction_deg: 90, point_m: (2, 1, 3.5))],
              removed: [Beyond(point_m: (2, 1, 3.5), normal: ({0}, 0, {1}))])],
          contact: Potential(penalty_pa: 2e9, potential: Smooth(), {contact}))",
        SLOPE_DEG.to_radians().sin(),
        SLOPE_DEG.to_radians().cos(),
    )
}

/// How far it slides in a quarter of a second [m].
fn slides_m(contact: &str) -> f64 {
    let mut slab = simulation(&slab(&format!("gravity_ramp_s: {RAMP_S},"), contact));
    advance(&mut slab, 2500);
    let blocks = slab.blocks();
    let downhill = Vec3::new(SLOPE_DEG.to_radians().cos(), 0.0, -SLOPE_DEG.to_radians().sin());
    let moved = displacements(&slab);
    let along = |block: BlockId| {
        let nodes = blocks.nodes_of(block);
        moved[nodes.clone()].iter().map(|u| u.dot(&downhill)).sum::<f64>() / nodes.len() as f64
    };
    blocks.ids().map(along).fold(0.0, f64::max)
}

/// v' = g (sin α − cos α tan φ) under gravity that grows, φ by the stress of a metre of rock, measured upright, by small steps.
fn barton_slide_m() -> f64 {
    let (slope, steps) = (SLOPE_DEG.to_radians(), 1_000_000);
    let (step_s, mut speed_m_s, mut slide_m) = (END_S / f64::from(steps), 0.0f64, 0.0);
    for k in 0..steps {
        let gravity_m_s2 = GRAVITY_M_S2 * ((f64::from(k) + 0.5) * step_s / RAMP_S).min(1.0);
        let stress_pa = 2650.0 * gravity_m_s2 * slope.cos() * slope.cos();
        let friction = tan(10.0 + 10.0 * (1e6 / stress_pa).log10());
        let faster = step_s * gravity_m_s2 * (slope.sin() - friction * slope.cos());
        slide_m += step_s * (speed_m_s + 0.5 * faster.max(-speed_m_s));
        speed_m_s = (speed_m_s + faster).max(0.0);
    }
    slide_m
}

#[test]
fn a_slab_slides_on_a_rough_joint_whether_its_law_is_of_materials_or_of_the_joint() {
    let rough = "friction: (friction_deg: 10, shear_penalty_pa_m: 1e9, roughness: (jrc: 10, jcs_pa: 1e6))";
    let exact_m = barton_slide_m();
    let pair = format!("material_pairs: [(between: (\"rock\", \"rock\"), {rough})]");
    let joint = format!("friction: (friction_deg: 60), rock_joints: [(joint: \"bed\", {rough})]");
    // Undamped contact rings after the ramp of gravity. Barton's strength is concave in the pressure, so that a pressure that rings bears less: by 0.86 % of the slide.
    for (words, contact) in [("all joints", rough), ("two materials", &pair), ("the joint", &joint)] {
        let contact = &format!("restitution: 0.05, {contact}");
        let what = format!("slide on a rough joint by the law of {words} [m]");
        row("rough joints", &what, slides_m(contact), Within(exact_m, 5e-3));
    }
    let held = "friction: (friction_deg: 25, shear_penalty_pa_m: 1e9, roughness: (jrc: 10, jcs_pa: 1e6))";
    row("rough joints", "slide on a joint that holds [m]", slides_m(held), AtMost(1e-3));
}

/// F = tan(φ_r + JRC log₁₀(JCS/σ))/tan α.
#[test]
fn a_slab_on_a_rough_joint_has_the_factor_of_safety_of_its_strength() {
    let rough = "friction: (friction_deg: 25, shear_penalty_pa_m: 1e9, roughness: (jrc: 10, jcs_pa: 1e6))";
    let stress_pa = 2650.0 * GRAVITY_M_S2 * SLOPE_DEG.to_radians().cos().powi(2);
    let exact = tan(25.0 + 10.0 * (1e6 / stress_pa).log10()) / tan(SLOPE_DEG);
    let safety = safety_factor::found(&slab("", rough), Question::Strength);
    safety_factor::holds("slab on 35°, φ_r = 25°, JRC 10, JCS 1 MPa", &safety, exact);
}

/// A slab whose joint has softened to 25°, from 40° over 5 mm or from 60° at once, slides on a ramp of 35° with g (sin α − cos α tan φ_r); before it has slipped it
/// stands. Its weight acts 0.1 m above the joint, so that pressure falls to 0.58 of its mean uphill, where shear must not exceed the peak of a joint that falls at once:
/// tan 35°/0.58 is tan 50°.
#[test]
fn a_slab_on_a_ramp_stands_until_it_is_pushed_and_then_slides_on_its_residual_friction() {
    slab_that_softens("softening", 40, ", over_m: 5e-3");
    slab_that_softens("softening at once", 60, "");
}

fn slab_that_softens(what: &str, peak_deg: u32, over: &str) {
    let (sin, cos) = 35f64.to_radians().sin_cos();
    let run = |pushed_m_s: f64| {
        let mut slab = simulation(&format!(
            "(title: \"ramp\", time: (step_s: 1e-4, end_s: 1), gravity_m_s2: ({}, 0, {}),
              materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2600)],
              blocks: [
                  (name: \"ramp\", material: \"rock\", body: Fixed, shape: Box(size_m: (9, 3, 1), cells: (1, 1, 1)), at_m: (-1, -1, -1)),
                  (name: \"slab\", material: \"rock\", body: Rigid, shape: Box(size_m: (1, 1, 0.2), cells: (1, 1, 1)), velocity_m_s: ({pushed_m_s}, 0, 0)),
              ],
              contact: Potential(penalty_pa: 1e9, potential: Smooth(), friction: (friction_deg: {peak_deg}, shear_penalty_pa_m: 1e9,
                  residual: (friction_deg: 25{over}))))",
            9.81 * sin,
            -9.81 * cos,
        ));
        let nodes = slab.blocks().nodes_of(BlockId(1));
        let speed_m_s = |slab: &Simulation| {
            slab.state().velocity[nodes.clone()].iter().map(|v| v.x).sum::<f64>() / nodes.len() as f64
        };
        slab.settle(&Settle::new(1e-8, 200_000)).unwrap();
        let along_m = |slab: &Simulation| {
            displacements(slab)[nodes.clone()].iter().map(|u| u.x).sum::<f64>() / nodes.len() as f64
        };
        let start_m = along_m(&slab);
        advance(&mut slab, 2000);
        let moved_m = along_m(&slab) - start_m;
        let before_m_s = speed_m_s(&slab);
        advance(&mut slab, 4000);
        (moved_m, (speed_m_s(&slab) - before_m_s) / 0.4)
    };
    let (rested_m, _) = run(0.0);
    // It settled to 1e-8 of its largest speed, that of stretching its shear spring by m g sin α/k_s: a hundred times that part of the stretch.
    let stretch_m = 2600.0 * 0.2 * 9.81 * sin / 1e9;
    row(
        what,
        &format!("slip of the slab at rest on 35° with a peak of {peak_deg}° [m]"),
        rested_m,
        AtMost(1e-6 * stretch_m),
    );
    let (slipped_m, rate_m_s2) = run(0.5);
    assert!(slipped_m > 5e-3, "it has softened after {slipped_m} m");
    let exact_m_s2 = 9.81 * (sin - cos * tan(25.0));
    assert!((exact_m_s2 - 1.87959).abs() < 1e-5);
    // If it bounced as deep as it has sunk, at up to ω d = 4 mm/s, its speed would be off by μ of twice that: 0.5 % over 0.4 s.
    row(what, "acceleration on 35° with a residual angle of 25° [m/s²]", rate_m_s2, Within(exact_m_s2, 5e-3));
}

/// A plate of 1 × 1 × 0.2 m with a cohesion of 50 kPa rocks on one edge, so that its joint opens but there. However its strength falls, it is residual then: pushed by
/// 10 kN from 0.3 s on, which the cohesion would hold, it slides with (F − μ m g)/m.
#[test]
fn a_joint_that_opened_while_its_block_rocked_has_its_residual_strength() {
    let (mass_kg, push_n, gravity_m_s2) = (2600.0 * 0.2, 1e4, 9.8);
    let lift = "(block: \"plate\", at_m: (0, 0.5, 0.2), force_n: (0, 0, 4e3), factor: [(time_s: 0, factor: 0), (time_s: 0.001, factor: 1), (time_s: 0.02, factor: 1), (time_s: 0.021, factor: 0)])";
    let push = "(block: \"plate\", force_n: (1e4, 0, 0), factor: [(time_s: 0.3, factor: 0), (time_s: 0.301, factor: 1)])";
    for strength in [
        "",
        ", residual: (friction_deg: 30)",
        ", residual: (friction_deg: 30, over_m: 0.01)",
        ", tension_pa: 1e3, residual: (friction_deg: 30)",
    ] {
        let mut plate = simulation(&format!(
            "(title: \"rocked\", time: (step_s: 1e-4, end_s: 0.5), gravity_m_s2: (0, 0, -{gravity_m_s2}),
              materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2600)],
              blocks: [
                  (name: \"base\", material: \"rock\", body: Fixed, shape: Box(size_m: (3, 3, 1), cells: (1, 1, 1)), at_m: (-1, -1, -1)),
                  (name: \"plate\", material: \"rock\", body: Rigid, shape: Box(size_m: (1, 1, 0.2), cells: (1, 1, 1)), at_m: (0, 0, -2.6e-6)),
              ],
              forces: [{lift}, {push}],
              contact: Potential(penalty_pa: 1e9, potential: Smooth(), restitution: 0.1,
                  friction: (friction_deg: 30, cohesion_pa: 50e3, shear_penalty_pa_m: 1e9{strength})))"
        ));
        let nodes = plate.blocks().nodes_of(BlockId(1));
        let speed_m_s = |plate: &Simulation| {
            plate.state().velocity[nodes.clone()].iter().map(|v| v.x).sum::<f64>() / nodes.len() as f64
        };
        advance(&mut plate, 3100);
        let before_m_s = speed_m_s(&plate);
        advance(&mut plate, 1900);
        let rate_m_s2 = (speed_m_s(&plate) - before_m_s) / 0.19;
        let exact_m_s2 = push_n / mass_kg - tan(30.0) * gravity_m_s2;
        let what = format!("acceleration of a plate that rocked before{strength} [m/s²]");
        // A vibration of the normal force at 0.1 of itself for the last of its time would make as much of the friction.
        row("joints that opened", &what, rate_m_s2, Within(exact_m_s2, 0.01));
    }
}
