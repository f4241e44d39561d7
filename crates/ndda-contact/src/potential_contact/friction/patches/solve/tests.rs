use super::*;
use crate::friction::patches::patch::{PatchDetail, PatchSummary};
use crate::friction::patches::tolerance::Tolerance;

const COLUMNS: usize = 6;
const ROWS: usize = 4;
/// Columns and rows of a wall whose patches are divided among threads.
const LARGE: [usize; 2] = [70, 64];
const DT_S: f64 = 1e-4;

/// Cubes of a wall on a base that does not move, with velocities that all friction together may or may not stop.
fn bodies([columns, rows]: [usize; 2]) -> Vec<Body> {
    let mut state = 1u64;
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
    };
    let held = Body::at_rest(f64::INFINITY);
    let mut all = vec![held];
    for k in 0..columns * rows {
        all.push(Body {
            mass_kg: 2600.0,
            inverse_inertia: Mat3::identity() * (6.0 / 2600.0),
            center: Vec3::new((k % columns) as f64, 0.0, (k / columns) as f64 + 0.5),
            velocity_m_s: 2e-3 * Vec3::new(1.0 + random(), random(), 0.0),
            spin_rad_s: 1e-3 * Vec3::new(random(), random(), random()),
            ..held
        });
    }
    all
}

/// A patch on a face with the most friction that it can carry.
fn patch(
    [owner, target]: [usize; 2],
    center: Vec3,
    axes: [Vec3; 3],
    most_n: f64,
) -> (ContactPatch, PatchDetail) {
    let surface = LimitSurface::new(most_n, [1.0 / 12.0, 1.0 / 15.0]);
    let [owner, target] = [owner, target].map(|block| BlockId(block as u32));
    let patch = ContactPatch { owner, target, center, most_n, ..ContactPatch::default() };
    (patch, PatchDetail { axes, surface, ..PatchDetail::default() })
}

/// Faces on which cubes lie and stand beside each other, with a slight patch at an edge of each.
fn patches([columns, rows]: [usize; 2]) -> Vec<(ContactPatch, PatchDetail)> {
    let (x, y, z) = (Vec3::x(), Vec3::y(), Vec3::z());
    let mut all = Vec::new();
    for k in 0..columns * rows {
        let (column, row) = (k % columns, k / columns);
        let (block, below) = (k + 1, if row == 0 { 0 } else { k + 1 - columns });
        let foot = Vec3::new(column as f64, 0.0, row as f64);
        let most_n = 15e3 * (rows - row) as f64;
        all.push(patch([block, below], foot, [x, y, z], most_n));
        all.push(patch([block, below], foot + 0.5 * x, [y, z, x], 2e-6 * most_n));
        if column > 0 {
            all.push(patch([block, block - 1], foot + 0.5 * (z - x), [y, z, x], 3e3));
        }
    }
    all
}

struct Solved {
    /// Friction of patches that are not slight, by number.
    friction: Vec<(u32, Vec3)>,
    /// How many patches were slight.
    slight: usize,
    /// Velocities with friction.
    end: Vec<Body>,
    search: Search,
    /// How many groups threads visit side by side.
    groups: usize,
}

/// The friction of all patches, which is that of each looked at alone where the search has ended.
fn solved(tolerance: f64) -> Solved {
    solved_with(tolerance, stage::VISITS_ALONE)
}

/// The same, with so many visits of each patch before Newton's method.
fn solved_with(tolerance: f64, alone: usize) -> Solved {
    solved_wall([COLUMNS, ROWS], tolerance, alone)
}

/// The same of a wall of so many columns and rows.
fn solved_wall(wall: [usize; 2], tolerance: f64, alone: usize) -> Solved {
    let (start, mut end, mut nodal) = (bodies(wall), bodies(wall), Nodal::default());
    let found = patches(wall);
    let summary = |patch: &ContactPatch| PatchSummary { has_friction: true, ..patch.summary() };
    let mut summaries: Vec<_> = found.iter().map(|(patch, _)| summary(patch)).collect();
    Tolerance::of_friction(tolerance).find(&mut summaries, &start, &mut Vec::new());
    let mut order: Vec<u32> =
        (0..).zip(&summaries).filter(|each| each.1.matters()).map(|each| each.0).collect();
    let (mut division, moving) = (Division::default(), |k: u32| summaries[k as usize].moving(&start));
    division.divide(&mut order, moving);
    let coupled = order.iter().filter_map(|&k| {
        let ((patch, detail), summary) = (&found[k as usize], &summaries[k as usize]);
        let detail = PatchDetail { patch: k, ..*detail };
        CoupledPatch::new((patch, &detail, summary.tolerance_n), (&start, &nodal), [None; 2], DT_S)
    });
    let mut coupled: Vec<_> = coupled.collect();
    division.take_groups(coupled.iter().map(|patch| moving(patch.patch)));
    let mut motion = Motion {
        bodies: &mut end,
        nodal: &mut nodal,
        division: &division,
        dt_s: DT_S,
        is_iterated: false,
        visits: &mut Visits::default(),
        alone: alone * coupled.len(),
        eased: usize::MAX,
    };
    let search = solve(&mut coupled, &start, (&mut motion, &mut Newton::default()));
    let slight = summaries.iter().filter(|summary| summary.is_slight()).count();
    if search.left_m_s == 0.0 {
        assert_alone_would_not_change(&mut coupled, &mut motion);
    }
    let friction = coupled.iter().map(|patch| (patch.patch, patch.friction().0)).collect();
    Solved { friction, slight, end, search, groups: division.groups() }
}

/// Each patch, looked at alone while the others keep their friction, has found its own.
fn assert_alone_would_not_change(patches: &mut [CoupledPatch], motion: &mut Motion) {
    for patch in patches.iter() {
        let (slip, stiffness) = (patch.slip_in(motion), patch.stiffness / GAMMA);
        let free_slip = slip - GAMMA * (patch.flexibility * patch.force);
        let (alone, _) = patch.surface.friction(&stiffness, (&free_slip, &slip), 0.0, true);
        let off_n = (alone - patch.force).amax();
        assert!(off_n <= 20.0 * patch.tolerance_n, "{off_n} N of {} N", patch.tolerance_n);
    }
}

#[test]
fn newtons_method_ends_within_eight_steps_of_each_stage() {
    let Solved { search: Search { visits, left_m_s }, friction, .. } = solved(1e-10);
    assert_eq!(left_m_s, 0.0);
    let each = visits as f64 / friction.len() as f64;
    let alone = 2.0 * stage::VISITS_ALONE as f64;
    assert!(each > alone && each <= alone + 32.0, "{each} visits of each patch in both stages");
}

/// Rounding alone is more than such a tolerance, and visits of one patch after the other come nearer by a part each time.
#[test]
fn a_search_that_ends_before_friction_is_found_tells_how_much_it_still_changed() {
    let search = solved_with(1e-18, usize::MAX / 1000).search;
    assert!(search.left_m_s > 0.0 && search.left_m_s < 1e-6, "{search:?}");
}

/// The reference has no slight patches, and a hundred thousandth of the tolerance.
#[test]
fn slight_patches_leave_the_friction_of_others_within_the_tolerance() {
    let tolerance = 1e-4;
    let (exact, found) = (solved(1e-9), solved(tolerance));
    assert_eq!((exact.slight, found.slight), (0, COLUMNS * ROWS));
    assert_eq!((exact.search.left_m_s, found.search.left_m_s), (0.0, 0.0));
    let most_n = 15e3 * ROWS as f64;
    let off =
        found.friction.iter().map(|(k, a)| (a - exact.friction[*k as usize].1).norm()).fold(0.0, f64::max);
    assert!(off <= 10.0 * tolerance * most_n, "{off} N of {most_n} N");
    let stopped = 1e-4 * most_n / 2600.0;
    for (a, b) in found.end.iter().zip(&exact.end) {
        assert!((a.velocity_m_s - b.velocity_m_s).norm() <= 10.0 * tolerance * stopped);
    }
}

#[test]
fn threads_that_visit_patches_side_by_side_find_the_same_friction_to_the_bit() {
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| solved_wall(LARGE, 1e-5, stage::VISITS_ALONE))
    };
    let one = on(1);
    assert!(one.groups > 4 && one.search.left_m_s == 0.0, "{} groups, {:?}", one.groups, one.search);
    for threads in [2, 3] {
        let other = on(threads);
        assert_eq!(one.friction, other.friction);
        assert_eq!(one.end, other.end);
    }
}
