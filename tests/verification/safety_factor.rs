//! Factors of safety of planes, wedges and a column against limit equilibrium.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};

use ndda::safety::{self, Kind, Plan, Question, Safety, SafetyError, State, Watch};
use ndda_io::read;
use ndda_mesh::Vec3;

use crate::evidence::Answer::{AtLeast, AtMost, Near, Within};
use crate::evidence::row;

const ERROR: f64 = 0.01;

pub(crate) fn scene(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("scenes/safety/{name}.ron"));
    std::fs::read_to_string(path).unwrap()
}

fn find(text: &str, by: Question, watch: &Watch) -> Result<Safety, SafetyError> {
    let loaded =
        read::load_text("case.ron", text, &[], None).unwrap_or_else(|e| panic!("{}", e.render(false)));
    let plan = Plan { by, error: ERROR, ..Plan::default() };
    safety::find(&loaded, ("case", Path::new(".")), &plan, watch)
}

pub(crate) fn found(text: &str, by: Question) -> Safety {
    let watch = Watch { out: None, stop: &Arc::default(), tell: &|_| {} };
    find(text, by, &watch).unwrap_or_else(|e| panic!("{e}"))
}

pub(crate) fn bracket(safety: &Safety) -> (f64, f64) {
    let bracket = safety.factor_of_safety;
    (bracket.lower.expect("blocks stand at some factor"), bracket.upper.expect("blocks fail at some factor"))
}

pub(crate) fn kind(safety: &Safety) -> Kind {
    safety.mechanism.as_ref().expect("blocks fail").kind
}

/// The bracket contains a closed form and is as narrow as requested.
pub(crate) fn holds(what: &str, safety: &Safety, exact: f64) {
    let (lower, upper) = bracket(safety);
    row("safety", &format!("{what}: lower end [-]"), lower, AtMost(exact));
    row("safety", &format!("{what}: upper end [-]"), upper, AtLeast(exact));
    row("safety", &format!("{what}: middle [-]"), (lower * upper).sqrt(), Within(exact, 0.5 * ERROR));
    assert!(upper / lower <= 1.0 + ERROR, "{lower} to {upper}");
}

#[test]
fn a_cube_on_a_plane_has_the_factor_tan_phi_over_tan_alpha() {
    let safety = found(&scene("plane_dry"), Question::Strength);
    holds("cube on 30°, φ = 40°", &safety, 40f64.to_radians().tan() / 30f64.to_radians().tan());
    assert_eq!(kind(&safety), Kind::Sliding);
    assert_eq!(safety.moving_blocks.len(), 1);
    assert!((Vec3::from(safety.moving_blocks[0].direction) - Vec3::x()).norm() < 1e-3);
    let tilted = found(&scene("plane_dry"), Question::Gravity { towards: None });
    let (lower, upper) = bracket(&tilted);
    let exact = 40f64.to_radians().tan() / 30f64.to_radians().tan();
    row("safety", "the same by tilting gravity: lower end [-]", lower, Within(exact, ERROR));
    row("safety", "the same by tilting gravity: upper end [-]", upper, Within(exact, ERROR));
}

/// Of a plane the ratio of shear to normal force counts, and of a wedge the tangent of its inclination along its line, wherever else planes dip.
#[test]
fn gravity_that_tilts_gives_the_factor_by_strength_in_any_direction_that_blocks_can_slide() {
    let tan = |angle: f64| angle.to_radians().tan();
    let middle = |safety: &Safety| bracket(safety).0.midpoint(bracket(safety).1);
    let (sin, cos) = 20f64.to_radians().sin_cos();
    let gravity = format!("gravity_m_s2: ({:?}, 0, {:?})", 9.81 * sin, -9.81 * cos);
    let cube = scene("plane_dry").replace("gravity_m_s2: (4.905, 0, -8.495709211125344)", &gravity);
    let cube = cube.replace("friction_deg: 40", "friction_deg: 35");
    // 60° off the dip direction, in the level plane and in that of the scene, which differ by its dip.
    let off = Some([0.5 * cos, 0.75f64.sqrt(), 0.5 * sin]);
    let tilted = found(&cube, Question::Gravity { towards: off });
    let exact = tan(35.0) / tan(20.0);
    assert!((middle(&tilted) / exact - 1.0).abs() < ERROR, "{exact}: {:?}", tilted.factor_of_safety);
    let told = safety::text(&tilted);
    assert!(told.contains("ratio of shear to normal force on the plane of 20.0° multiplied"), "{told}");
    let line = normal(40.0, 130.0).cross(&normal(60.0, 220.0));
    let line = if line.z > 0.0 { -line } else { line };
    let tilted = found(&scene("wedge"), Question::Gravity { towards: Some(line.into()) });
    let (exact, _) = limit_equilibrium([(40.0, 130.0), (60.0, 220.0)], 40.0);
    assert!((middle(&tilted) / exact - 1.0).abs() < ERROR, "{exact}: {:?}", tilted.factor_of_safety);
    assert!(safety::text(&tilted).contains("down the line of two planes, which plunges"));
}

/// It slides by a tenth of a metre, and comes to rest against a block that is fixed: it did not stand.
#[test]
fn a_cube_that_comes_to_rest_elsewhere_has_a_factor_below_1() {
    let stop = "(name: \"stop\", material: \"rock\", body: Fixed, shape: Box(size_m: (0.5, 2, 0.5), cells: (1, 1, 1)), at_m: (1.1, -0.5, 0)),
        (name: \"cube\"";
    let text =
        scene("plane_dry").replace("friction_deg: 40", "friction_deg: 20").replace("(name: \"cube\"", stop);
    let safety = found(&text, Question::Strength);
    let exact = 20f64.to_radians().tan() / 30f64.to_radians().tan();
    holds("cube on 30°, φ = 20°, above a block that would stop it", &safety, exact);
}

/// A block so tall that it rocks while it slides, and still too wide to topple: vibration must not hold it.
#[test]
fn a_tall_block_that_rocks_slides_at_the_factor_of_its_plane() {
    let (sin, cos) = 30f64.to_radians().sin_cos();
    let text = format!(
        "(title: \"tall block\", time: (step_s: 1e-3, end_s: 1), gravity_m_s2: (0, 0, -9.81),
          materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2650)],
          rock: [(name: \"slope\", material: \"rock\", body: Rigid, domain: Box(min_m: (0, 0, 0), max_m: (20, 5, 18)),
            joints: [Plane(name: \"p\", dip_deg: 30, dip_direction_deg: 90, point_m: (10, 0, 6))],
            fixed: [Beyond(point_m: (10, 0, 6), normal: ({:?}, 0, {:?}))])],
          contact: Potential(penalty_pa: 1e9, potential: Smooth(), friction: (friction_deg: 40)))",
        -sin, -cos
    );
    let safety = found(&text, Question::Strength);
    holds("block of 18 m on 30°, φ = 40°", &safety, 40f64.to_radians().tan() / 30f64.to_radians().tan());
}

/// F = tan φ / tan α + c / (ρ g h sin α cos α).
#[test]
fn a_slab_with_cohesion_that_it_keeps_has_the_factor_of_its_plane() {
    let safety = found(&scene("plane_slide"), Question::Strength);
    let (alpha, weight_pa) = (35f64.to_radians(), 2600.0 * 9.81 * 5.0);
    let exact = 30f64.to_radians().tan() / alpha.tan() + 20e3 / (weight_pa * alpha.sin() * alpha.cos());
    holds("slab on 35°, φ = 30°, c = 20 kPa", &safety, exact);
    assert_eq!(kind(&safety), Kind::Sliding);
}

#[test]
fn a_wedge_slides_along_the_line_of_its_joints() {
    let safety = found(&scene("wedge"), Question::Strength);
    let (lower, upper) = bracket(&safety);
    row("safety", "wedge 40/130, 60/220, φ = 40°: lower end [-]", lower, AtLeast(1.268));
    row("safety", "wedge 40/130, 60/220, φ = 40°: upper end [-]", upper, AtMost(1.281));
    assert_eq!(kind(&safety), Kind::Wedge);
    let mut joints: Vec<_> =
        safety.moving_blocks[0].planes.iter().map(|plane| plane.joint.clone().unwrap()).collect();
    joints.sort();
    assert_eq!(joints, ["a", "b"]);
}

/// The friction angle at which the wedge has a factor of 1.
#[test]
fn a_wedge_at_its_critical_friction_angle_has_a_factor_of_1() {
    let planes = [(40.0, 130.0), (60.0, 220.0)];
    let (at_40, _) = limit_equilibrium(planes, 40.0);
    let critical_deg = (40f64.to_radians().tan() / at_40).atan().to_degrees();
    row(
        "safety",
        "critical friction angle of the wedge 40/130, 60/220 [°]",
        critical_deg,
        Near(33.357, 1e-3),
    );
    let safety = found(&wedge(planes, critical_deg), Question::Strength);
    holds("wedge 40/130, 60/220 at its critical friction angle", &safety, 1.0);
    assert_eq!(kind(&safety), Kind::Wedge);
}

/// What studies of many samples ask: a single factor, without a bracket.
#[test]
fn a_wedge_fails_just_below_its_critical_friction_and_stands_just_above() {
    let planes = [(40.0, 130.0), (60.0, 220.0)];
    let (at_40, _) = limit_equilibrium(planes, 40.0);
    for (part, expected) in [(0.985, State::Fails), (1.015, State::Stands), (1.2, State::Stands)] {
        let friction_deg = (part * 40f64.to_radians().tan() / at_40).atan().to_degrees();
        let loaded = read::load_text("case.ron", &wedge(planes, friction_deg), &[], None).unwrap();
        let (plan, stop) = (Plan { error: ERROR, ..Plan::default() }, Arc::default());
        let watch = Watch { out: None, stop: &stop, tell: &|_| {} };
        let state = safety::at(&loaded, ("case", Path::new(".")), 1.0, &plan, &watch).unwrap();
        assert_eq!(state, expected, "{part} of the critical tan φ");
    }
}

/// Dip and dip direction of a joint whose normal is tilted from that of a mean, in a direction clockwise from the dip.
fn tilted((dip_deg, direction_deg): (f64, f64), tilt_deg: f64, turn_deg: f64) -> (f64, f64) {
    let mean = normal(dip_deg, direction_deg);
    // Down the dip, turned clockwise about the normal as it is seen from above.
    let dip = normal(dip_deg + 90.0, direction_deg);
    let (turn, tilt) = (-turn_deg.to_radians(), tilt_deg.to_radians());
    let towards = turn.cos() * dip + turn.sin() * mean.cross(&dip);
    let n = tilt.cos() * mean + tilt.sin() * towards;
    (n.z.acos().to_degrees(), n.x.atan2(n.y).to_degrees())
}

#[test]
fn a_wedge_of_tilted_joints_has_the_factor_of_their_orientations() {
    let safety = found(&scene("wedge_fisher"), Question::Strength);
    let planes = [tilted((40.0, 130.0), 3.0, 50.0), tilted((60.0, 220.0), 2.0, 200.0)];
    let (exact, expected) = limit_equilibrium(planes, 40.0);
    holds("wedge of joints tilted by 3° and 2°, φ = 40°", &safety, exact);
    assert_eq!(kind(&safety), expected);
}

#[test]
fn a_column_slides_where_joints_weaken_and_topples_where_gravity_tilts() {
    let safety = found(&scene("toppling_column"), Question::Strength);
    let tan = |angle: f64| angle.to_radians().tan();
    holds("column on 15°, φ = 40°", &safety, tan(40.0) / tan(15.0));
    assert_eq!(kind(&safety), Kind::Sliding);
    // The weight of the column acts beyond its edge at b/(h tan α) = 1.4928.
    let told = safety.remarks.iter().any(|remark| remark.contains("1.49") && remark.contains("--by gravity"));
    assert!(told, "{:?}", safety.remarks);
    let tilted = found(&scene("toppling_column"), Question::Gravity { towards: None });
    holds("column of 0.8 m by 2 m that topples as gravity tilts from 15°", &tilted, 0.8 / (2.0 * tan(15.0)));
    assert_eq!(kind(&tilted), Kind::Toppling);
}

/// Upward normal of a plane.
pub(crate) fn normal(dip_deg: f64, direction_deg: f64) -> Vec3 {
    let (dip, direction) = (dip_deg.to_radians(), direction_deg.to_radians());
    Vec3::new(dip.sin() * direction.sin(), dip.sin() * direction.cos(), dip.cos())
}

/// Limit equilibrium of a dry wedge of equal friction (Hoek & Bray): along the line of intersection where both planes are pressed, else
/// on the one that is.
pub(crate) fn limit_equilibrium([a, b]: [(f64, f64); 2], friction_deg: f64) -> (f64, Kind) {
    let (n_a, n_b) = (normal(a.0, a.1), normal(b.0, b.1));
    let line = n_a.cross(&n_b).normalize();
    let weight = -Vec3::z();
    let pushes = pushes_of_planes([n_a, n_b], weight);
    let friction = friction_deg.to_radians().tan();
    match pushes {
        [push_a, push_b] if push_a > 0.0 && push_b > 0.0 => {
            (friction * (push_a + push_b) / weight.dot(&line).abs(), Kind::Wedge)
        }
        [push_a, _] => {
            let dip_deg = if push_a > 0.0 { a.0 } else { b.0 };
            (friction / dip_deg.to_radians().tan(), Kind::Sliding)
        }
    }
}

/// Pushes N of two planes, along their normals n, on a wedge of this weight that slides on both: N_a n_a + N_b n_b takes up what is across their line of intersection.
pub(crate) fn pushes_of_planes([a, b]: [Vec3; 2], weight: Vec3) -> [f64; 2] {
    let line = a.cross(&b).normalize();
    let across = weight - weight.dot(&line) * line;
    let (cos, p_a, p_b) = (a.dot(&b), -across.dot(&a), -across.dot(&b));
    [(p_a - cos * p_b) / (1.0 - cos * cos), (p_b - cos * p_a) / (1.0 - cos * cos)]
}

pub(crate) fn wedge(planes: [(f64, f64); 2], friction_deg: f64) -> String {
    let [a, b] = planes;
    let beyond = |plane: (f64, f64)| {
        let n = -normal(plane.0, plane.1);
        format!("Beyond(point_m: (10, 10, 6), normal: ({:e}, {:e}, {:e}))", n.x, n.y, n.z)
    };
    let joint = |name: &str, plane: (f64, f64)| {
        format!(
            "Plane(name: \"{name}\", dip_deg: {}, dip_direction_deg: {}, point_m: (10, 10, 6))",
            plane.0, plane.1
        )
    };
    format!(
        "(title: \"wedge\", time: (step_s: 2e-4, end_s: 1), gravity_m_s2: (0, 0, -9.81),
          materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2600)],
          rock: [(name: \"slope\", material: \"rock\", body: Rigid, domain: Box(min_m: (0, 0, 0), max_m: (20, 20, 12)),
            joints: [{}, {}], fill: Centre, fixed: [{}, {}])],
          contact: Potential(penalty_pa: 2e9, potential: Smooth(), friction: (friction_deg: {friction_deg})))",
        joint("a", a),
        joint("b", b),
        beyond(a),
        beyond(b),
    )
}

#[test]
fn an_answer_does_not_depend_on_threads_and_goes_on_after_an_interruption() {
    let text = scene("plane_dry");
    let whole = found(&text, Question::Strength);
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let alone = one.install(|| found(&text, Question::Strength));
    let place = tempfile::tempdir().unwrap();
    let stop: Arc<AtomicBool> = Arc::default();
    let trials = AtomicU32::new(0);
    let tell = |_: &str| stop.store(trials.fetch_add(1, Ordering::Relaxed) >= 2, Ordering::Relaxed);
    let watch = Watch { out: Some(place.path()), stop: &stop, tell: &tell };
    assert!(matches!(find(&text, Question::Strength, &watch), Err(SafetyError::Interrupted)));
    let told = AtomicU32::new(0);
    let count = |_: &str| {
        told.fetch_add(1, Ordering::Relaxed);
    };
    let watch = Watch { out: Some(place.path()), stop: &Arc::default(), tell: &count };
    let resumed = find(&text, Question::Strength, &watch).unwrap();
    assert!(
        told.load(Ordering::Relaxed) < whole.trials.len() as u32,
        "trials that are done are not run again"
    );
    let states = |safety: &Safety| -> Vec<(f64, State, u64)> {
        safety.trials.iter().map(|trial| (trial.factor, trial.state, trial.steps)).collect()
    };
    for other in [&alone, &resumed] {
        assert_eq!(other.factor_of_safety, whole.factor_of_safety);
        assert_eq!(states(other), states(&whole));
        assert_eq!(other.moving_blocks, whole.moving_blocks);
    }
    assert!(place.path().join("mechanism/summary.json").exists());
}

#[test]
fn what_cannot_fail_is_refused_with_what_to_give() {
    let text = scene("plane_dry");
    let watch = Watch { out: None, stop: &Arc::default(), tell: &|_| {} };
    let refused = |text: &str, by| find(text, by, &watch).unwrap_err().to_string();
    let smooth = text.replace(", friction: (friction_deg: 40)", "");
    assert!(refused(&smooth, Question::Strength).contains("give contact.friction"));
    assert!(refused(&text, Question::Load).contains("give `forces`"));
    let level = text.replace("gravity_m_s2: (4.905, 0, -8.495709211125344)", "gravity_m_s2: (0, 0, -9.81)");
    assert!(refused(&level, Question::Gravity { towards: None }).contains("no slope"));
    for towards in [[0.0, 1.0, 0.0], [-1.0, 0.2, 0.0]] {
        let told = refused(&text, Question::Gravity { towards: Some(towards) });
        assert!(told.contains("the steepest way down is (1, 0, 0), which it is across or against"), "{told}");
    }
    let fixed = text.replace("body: Rigid", "body: Fixed");
    assert!(refused(&fixed, Question::Strength).contains("every block of the scene is fixed"));
}
