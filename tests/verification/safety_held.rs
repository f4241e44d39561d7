//! Factors of safety of what accelerates and is held later, or is held by what must not count: anchors and springs, friction across the line of a wedge, loads over
//! time, damping; against limit equilibrium.

use std::path::Path;
use std::sync::Arc;

use ndda::choose;
use ndda::safety::{self, Plan, Question, Safety, Watch};
use ndda_io::read;
use ndda_mesh::Vec3;

use crate::evidence::Answer::{AtLeast, AtMost};
use crate::evidence::row;
use crate::safety_factor::{bracket, holds, normal, pushes_of_planes};

const GRAVITY_M_S2: f64 = 9.81;
const DENSITY_KG_M3: f64 = 2600.0;

/// The factor of a scene that leaves out its penalty and its step.
fn of_chosen_values(text: &str, by: Question, error: f64) -> Safety {
    let loaded =
        read::load_text("case.ron", text, &[], None).unwrap_or_else(|e| panic!("{}", e.render(false)));
    let loaded = choose::complete(loaded, Path::new(".")).unwrap_or_else(|e| panic!("{}", e.render(false)));
    let watch = Watch { out: None, stop: &Arc::default(), tell: &|_| {} };
    let plan = Plan { by, error, ..Plan::default() };
    safety::find(&loaded, ("case", Path::new(".")), &plan, &watch).unwrap_or_else(|e| panic!("{e}"))
}

/// A block of 4 × 4 × 2 m on a plane: gravity is tilted by `slope_deg`.
struct OnPlane {
    slope_deg: f64,
    friction_deg: f64,
    time: &'static str,
    body: &'static str,
    damping: &'static str,
    more: &'static str,
}

impl OnPlane {
    fn of(slope_deg: f64, friction_deg: f64) -> Self {
        Self { slope_deg, friction_deg, time: "", body: "Rigid", damping: "", more: "" }
    }

    fn found(&self) -> Safety {
        let Self { friction_deg, time, body, damping, more, .. } = self;
        let (sin, cos) = self.slope_deg.to_radians().sin_cos();
        let text = format!(
            "(title: \"block\", time: ({time}end_s: 1), gravity_m_s2: ({}, 0, {}),
              materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: {DENSITY_KG_M3}, damping: ({damping}))],
              blocks: [
                (name: \"base\", material: \"rock\", body: Fixed, shape: Box(size_m: (40, 20, 3), cells: (1, 1, 1)), at_m: (-10, -8, -3)),
                (name: \"block\", material: \"rock\", body: {body}, shape: Box(size_m: (4, 4, 2), cells: (1, 1, 1)))],
              {more}
              contact: Potential(potential: Smooth(), friction: (friction_deg: {friction_deg})))",
            GRAVITY_M_S2 * sin,
            -GRAVITY_M_S2 * cos
        );
        of_chosen_values(&text, Question::Strength, Plan::default().error)
    }

    /// N tan φ/S, beside its weight with a force that presses it on the plane and one that holds it along the plane [N].
    fn exact(&self, (pressed_n, held_n): (f64, f64)) -> f64 {
        let weight_n = 4.0 * 4.0 * 2.0 * DENSITY_KG_M3 * GRAVITY_M_S2;
        let (sin, cos) = self.slope_deg.to_radians().sin_cos();
        (weight_n * cos + pressed_n) * self.friction_deg.to_radians().tan() / (weight_n * sin - held_n)
    }
}

/// Its steel yields at 300 kN, after 5 m of free length have stretched by millimetres: contact gives way by micrometres.
#[test]
fn an_anchor_holds_a_block_up_to_its_yield() {
    let block = OnPlane {
        more: "bolts: [(name: \"a\", at: Line(from_m: (3.9, 2, 1.9), to_m: (-3.0282032302755097, 2, -2.1)),
            steel: (young_pa: 200e9, area_m2: 1e-3, yield_n: 300e3), grout: (stiffness_n_m2: 2e9, strength_n_m: 1e6, from_m: 5),
            pretension_n: 100e3, plate: ())],",
        ..OnPlane::of(40.0, 38.0)
    };
    let (along, into) = (30f64.to_radians().cos(), 30f64.to_radians().sin());
    let safety = block.found();
    holds(
        "block of 83 t held by an anchor at its yield",
        &safety,
        block.exact((300e3 * into, 300e3 * along)),
    );
    assert!(
        safety.remarks.iter().any(|remark| remark.contains("only after it has moved")),
        "{:?}",
        safety.remarks
    );
}

/// Springs of a support hold a block whatever its friction is.
#[test]
fn a_block_on_the_springs_of_a_support_never_fails() {
    let block = OnPlane {
        body: "Affine",
        more: "supports: [(block: \"block\", on: Set(\"x_min\"), hold: Direction((1, 0, 0)), by: Springs(stiffness_n_m: 5e6))],",
        ..OnPlane::of(30.0, 40.0)
    };
    let bracket = block.found().factor_of_safety;
    row(
        "safety",
        "block on springs: largest factor that was tried, at which it stands [-]",
        bracket.lower.unwrap(),
        AtLeast(100.0),
    );
    assert_eq!(bracket.upper, None);
}

#[test]
fn loads_over_time_act_with_their_last_value() {
    let block = OnPlane {
        more:
            "water: [(on: Part(block: \"block\", region: Set(\"z_min\")), pressure: Linear(pressure_pa: 12e3),
            factor: [(time_s: 0, factor: 0), (time_s: 10, factor: 1)])],",
        ..OnPlane::of(25.0, 35.0)
    };
    let safety = block.found();
    holds("block on water that rises in 10 s", &safety, block.exact((-12e3 * 16.0, 0.0)));
    assert!(
        safety.remarks.iter().any(|remark| remark.contains("last of its values")),
        "{:?}",
        safety.remarks
    );
}

#[test]
fn damping_in_proportion_to_mass_holds_nothing() {
    let block = OnPlane { damping: "mass_per_s: 500", ..OnPlane::of(25.0, 35.0) };
    holds("block whose rock is damped by 500 /s", &block.found(), block.exact((0.0, 0.0)));
}

/// A scheme that is stable with any step gets the step of the default one.
#[test]
fn a_scheme_without_a_bound_has_the_same_factor() {
    for time in ["integrator: Newmark(), ", "contact_at: End(), "] {
        let block = OnPlane { time, ..OnPlane::of(25.0, 35.0) };
        holds(
            &format!("block on 25°, φ = 35°, {time}step left out"),
            &block.found(),
            block.exact((0.0, 0.0)),
        );
    }
}

/// Two planes of unlike dip and friction, under gravity with a part to the south: F = (N₁ tan φ₁ + N₂ tan φ₂)/(W · l).
#[test]
fn wedges_of_unlike_planes_whose_step_is_left_out_have_the_factor_of_limit_equilibrium() {
    // Dips, dip directions and friction angles of both planes [°], size [m], and gravity to the east and north over g.
    let cases = [
        ([50.0, 130.0, 36.97884498518386], [45.0, 220.0, 27.799946629467318], 20.0, [0.0, 0.0]),
        ([50.0, 130.0, 45.0], [45.0, 220.0, 35.0], 20.0, [0.0, -0.15]),
        ([61.566, 142.089, 44.827], [37.427, 238.829, 40.548], 100.0, [0.0, -0.2]),
    ];
    let mut worst = 0.0f64;
    for (a, b, size_m, [east, north]) in cases {
        let planes = [a, b].map(|[dip_deg, direction_deg, _]| normal(dip_deg, direction_deg));
        let middle = format!("({}, {}, {})", 0.6 * size_m, 0.5 * size_m, 0.3 * size_m);
        let joint = |name: &str, [dip_deg, direction_deg, _]: [f64; 3]| {
            format!(
                "Plane(name: \"{name}\", dip_deg: {dip_deg}, dip_direction_deg: {direction_deg}, point_m: {middle})"
            )
        };
        let fixed = planes
            .map(|n| format!("Beyond(point_m: {middle}, normal: ({:e}, {:e}, {:e}))", -n.x, -n.y, -n.z));
        let text = format!(
            "(title: \"wedge\", time: (end_s: 1), gravity_m_s2: ({}, {}, -9.81),
              materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2600)],
              rock: [(name: \"s\", material: \"rock\", body: Rigid, domain: Box(min_m: (0, 0, 0), max_m: ({size_m}, {size_m}, {})),
                joints: [{}, {}], fill: Centre, fixed: [{}, {}])],
              contact: Potential(potential: Smooth(), rock_joints: [
                (joint: \"a\", friction: (friction_deg: {})), (joint: \"b\", friction: (friction_deg: {}))]))",
            east * GRAVITY_M_S2,
            north * GRAVITY_M_S2,
            0.6 * size_m,
            joint("a", a),
            joint("b", b),
            fixed[0],
            fixed[1],
            a[2],
            b[2],
        );
        let safety = of_chosen_values(&text, Question::Strength, Plan::default().error);
        let exact = on_two_planes(planes, [a[2], b[2]], Vec3::new(east, north, -1.0));
        let (lower, upper) = bracket(&safety);
        println!("{a:?} {b:?}: {lower:.4} to {upper:.4}, exact {exact:.4}");
        worst = worst.max(lower / exact - 1.0).max(1.0 - upper / exact);
    }
    row(
        "safety",
        "wedges of unlike planes, step left out: limit equilibrium outside of the bracket by [-]",
        worst,
        AtMost(0.002),
    );
}

fn on_two_planes([a, b]: [Vec3; 2], friction_deg: [f64; 2], weight: Vec3) -> f64 {
    let pushes = pushes_of_planes([a, b], weight).into_iter();
    let held: f64 = pushes.zip(friction_deg).map(|(push, deg)| push * deg.to_radians().tan()).sum();
    held / weight.dot(&a.cross(&b).normalize()).abs()
}

/// A key 2 m high and 6 m long lies in a notch of some angle whose line plunges by 15°, and is lifted off it by 0.3 of its weight. Its friction acts along the line:
/// F = (W cos 15° − W sin 15° sin ½β/tan φ)/P. Friction that pointed across the line at rest must not hold it, nor what the load has found it pressed in with, also where
/// ½β < φ, so that statics would let it stay.
#[test]
fn a_key_in_a_notch_slides_at_the_load_of_limit_equilibrium_to_the_error_that_is_asked_for() {
    let mut worst = 0.0f64;
    for (notch_deg, error) in [(90f64, 0.01), (90.0, 0.002), (60.0, 0.01), (60.0, 0.002), (40.0, 0.005)] {
        let (text, exact) = key_in_a_notch(notch_deg);
        let (lower, upper) = bracket(&of_chosen_values(&text, Question::Load, error));
        println!("notch of {notch_deg}°, error {error}: {lower:.4} to {upper:.4}, exact {exact:.4}");
        assert!(upper / lower - 1.0 <= 2.0 * error, "notch of {notch_deg}°: {lower} to {upper}");
        worst = worst.max((lower / exact - 1.0).max(1.0 - upper / exact) / error);
    }
    // The statement: the error that is asked for; half of it, since the middle of the bracket is taken.
    let what = "key in a notch, lifted: limit equilibrium outside of the bracket by, over the error that is asked for [-]";
    row("safety", what, worst.max(0.0), AtMost(0.5));
}

/// The scene of a key that is lifted in a notch of an angle, and its exact factor.
fn key_in_a_notch(notch_deg: f64) -> (String, f64) {
    let (sin, cos) = 15f64.to_radians().sin_cos();
    let half = (0.5 * notch_deg).to_radians();
    let width_m = 2.0 * half.tan();
    let weight_n = 12.0 * width_m * DENSITY_KG_M3 * GRAVITY_M_S2;
    let load_n = 0.3 * weight_n;
    let side = |name: &str, way: f64| {
        // Seen along the line: the face of the notch, and a block 4 m high behind it.
        let far_m = 1.5 * width_m;
        let outline = [(0.0, 0.0), (far_m, 3.0), (far_m + 4.0, 3.0), (far_m + 4.0, -1.0), (0.0, -1.0)];
        let corners = |x_m: f64| outline.map(|(y, z)| format!("({x_m}, {}, {z})", way * y)).join(", ");
        let mut faces = [[0, 1, 2, 3, 4].to_vec(), [9, 8, 7, 6, 5].to_vec()].to_vec();
        faces.extend((0..5).map(|k| vec![(k + 1) % 5, k, k + 5, (k + 1) % 5 + 5]));
        if way > 0.0 {
            faces.iter_mut().for_each(|face| face.reverse());
        }
        format!(
            "(name: \"{name}\", material: \"rock\", body: Fixed, shape: Polyhedron(corners_m: [{}, {}], faces: {faces:?}, fill: Centre))",
            corners(12.0),
            corners(-3.0)
        )
    };
    let text = format!(
        "(title: \"notch\", time: (end_s: 1), gravity_m_s2: ({}, 0, {}),
          materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: {DENSITY_KG_M3})],
          blocks: [{}, {},
            (name: \"key\", material: \"rock\", body: Rigid, shape: Polyhedron(
              corners_m: [(6, 0, 0), (6, {width_m}, 2), (6, -{width_m}, 2), (0, 0, 0), (0, {width_m}, 2), (0, -{width_m}, 2)],
              faces: [[0, 1, 2], [5, 4, 3], [1, 0, 3, 4], [2, 1, 4, 5], [0, 2, 5, 3]], fill: Centre))],
          forces: [(block: \"key\", force_n: (0, 0, {load_n}))],
          contact: Potential(potential: Smooth(), friction: (friction_deg: 30)))",
        GRAVITY_M_S2 * sin,
        -GRAVITY_M_S2 * cos,
        side("left", -1.0),
        side("right", 1.0),
    );
    (text, weight_n * (cos - sin * half.sin() / 30f64.to_radians().tan()) / load_n)
}
