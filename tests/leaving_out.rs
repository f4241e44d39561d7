//! What a scene does not need is left out: the same bits as with the part in, counters at zero, no unknowns, no packages.
//!
//! One block has no contact: tests/verification/one_block_alone.rs. Without friction no friction code acts:
//! crates/ndda-contact/tests/without_friction.rs. Files and arrays are those asked for: apps/ndda-cli/tests/output.rs.

use ndda::build;
use ndda_io::read::load_text;
use ndda_solver::{BodyKind, Simulation};

const MATERIAL: &str = "name: \"rock\", young_pa: 1e9, poisson: 0.25, density_kg_m3: 2500";

fn scene(time: &str, material: &str, blocks: &str, more: &str) -> Simulation {
    let text = format!(
        "(title: \"t\", time: (step_s: 1e-3, end_s: 1, {time}), gravity_m_s2: (1, 0, -9.8),
          materials: [({MATERIAL}, {material})], blocks: [{blocks}], {more})"
    );
    let loaded = load_text("case.ron", &text, &[], None).unwrap_or_else(|e| panic!("{}", e.render(false)));
    let folder = std::path::Path::new(".");
    let blocks = build::blocks(&loaded.scene, folder).unwrap_or_else(|faults| panic!("{faults:?}"));
    build::simulation(&loaded.scene, blocks, folder).unwrap_or_else(|faults| panic!("{faults:?}"))
}

/// A box with its corner at x, on z = 0.
fn cube(name: &str, x: f64, more: &str) -> String {
    format!(
        "(name: \"{name}\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), at_m: ({x}, 0, 0), {more}),"
    )
}

/// Two cubes, the first of which runs into the second.
fn meeting() -> String {
    cube("a", 0.0, "velocity_m_s: (2, 0, 0), spin_rad_s: (0, 1, 1)") + &cube("b", 1.01, "")
}

fn assert_same_bits(mut without: Simulation, mut with: Simulation, what: &str) {
    for _ in 0..200 {
        without.step().unwrap();
        with.step().unwrap();
    }
    assert_eq!(without.state().position, with.state().position, "{what}");
    assert_eq!(without.state().velocity, with.state().velocity, "{what}");
}

fn advance(simulation: &mut Simulation, steps: u32) {
    for _ in 0..steps {
        simulation.step().unwrap();
    }
}

#[test]
fn blocks_that_never_meet_have_the_bits_of_blocks_without_contact_and_count_no_pairs() {
    let blocks = cube("a", 0.0, "spin_rad_s: (1, 2, 3)") + &cube("b", 30.0, "velocity_m_s: (1, 0, 0)");
    let contact = "contact: Potential(penalty_pa: 1e7, friction: (friction_deg: 30))";
    assert_same_bits(scene("", "", &blocks, "contact: Off"), scene("", "", &blocks, contact), "contact");
    let mut apart = scene("", "", &blocks, contact);
    advance(&mut apart, 100);
    let worst = apart.invariants();
    assert_eq!((worst.candidate_pairs_total, worst.contact_pairs_total), (0, 0));
    let memory = &apart.state().contact;
    assert!(memory.facets.is_empty() && memory.faces.is_empty() && memory.bonds.is_empty());
}

#[test]
fn parts_that_are_in_but_have_nothing_to_do_change_no_bit() {
    let contact = "contact: Potential(penalty_pa: 1e7)";
    let with = |time: &str, material: &str, more: &str| {
        scene(time, material, &meeting(), &format!("{contact}, {more}"))
    };
    assert_same_bits(with("", "", ""), with("", "damping: (mass_per_s: 0, stiffness_s: 0)", ""), "damping");
    assert_same_bits(with("", "", ""), with("", "", "in_situ: (stress_pa: ())"), "initial stress");
    let load = "tractions: [(block: \"a\", on: Set(\"x_min\"), traction_pa: (1e3, 0, 0), factor: [(time_s: 0, factor: 0)])]";
    assert_same_bits(with("", "", ""), with("", "", load), "loads over time");
    let water = "water: [(on: Part(block: \"a\", region: Set(\"x_min\")), pressure: Level(at_m: (0, 0, 1)), factor: [(time_s: 0, factor: 0)])]";
    assert_same_bits(with("", "", ""), with("", "", water), "water");
    assert_same_bits(
        with("", "", ""),
        with("step: Auto(safety: 1, energy: 1e9)", "", ""),
        "control of the step",
    );
}

#[test]
fn friction_of_zero_gives_the_bits_of_none_and_remembers_nothing() {
    for friction in ["(friction_deg: 0)", "(friction_deg: 0, shear_penalty_pa_m: 1e7)"] {
        let contact = |friction: &str| format!("contact: Potential(penalty_pa: 1e7, {friction})");
        let with = || scene("", "", &meeting(), &contact(&format!("friction: {friction}")));
        assert_same_bits(scene("", "", &meeting(), &contact("")), with(), friction);
        let mut simulation = with();
        advance(&mut simulation, 100);
        assert!(simulation.invariants().contact_pairs_max > 0, "they do not meet");
        assert!(simulation.state().contact.facets.is_empty(), "{friction} is remembered");
    }
}

#[test]
fn congruent_blocks_share_a_factor_and_a_constant_step_makes_each_once() {
    // Three alike, one of them turned by nothing but its name; one of another size.
    let other = "(name: \"d\", material: \"rock\", shape: Box(size_m: (1, 1, 2), cells: (1, 1, 2)), at_m: (9, 0, 0)),";
    let blocks = cube("a", 0.0, "") + &cube("b", 3.0, "") + &cube("c", 6.0, "") + other;
    let mut simulation = scene("", "", &blocks, "contact: Potential(penalty_pa: 1e7)");
    assert_eq!(simulation.factors(), 2, "as many as distinct blocks");
    advance(&mut simulation, 10);
    assert_eq!(simulation.factors(), 2);
    let users: Vec<usize> = simulation.plan().factors.iter().map(|factor| factor.blocks).collect();
    assert_eq!(users.iter().sum::<usize>(), 4, "{users:?}");
}

#[test]
fn fixed_and_rigid_blocks_have_no_unknowns_of_elements_and_no_factor() {
    let blocks = cube("elastic", 0.0, "")
        + &cube("affine", 3.0, "body: Affine")
        + &cube("rigid", 6.0, "body: Rigid")
        + &cube("fixed", 9.0, "body: Fixed");
    let simulation = scene("", "", &blocks, "contact: Potential(penalty_pa: 1e7)");
    let unknowns: Vec<(BodyKind, usize)> =
        simulation.plan().kinds.iter().map(|kind| (kind.kind, kind.unknowns)).collect();
    let expected =
        [(BodyKind::Elastic, 24), (BodyKind::Affine, 12), (BodyKind::Rigid, 0), (BodyKind::Fixed, 0)];
    assert_eq!(unknowns, expected);
    assert_eq!(simulation.unknowns(), 36);
    assert_eq!(simulation.factors(), 2, "one of the elastic and one of the affine block");
}

/// Packages of others that the command line needs with these features, as docs/reference/features.md counts them.
fn packages(features: &str) -> usize {
    let arguments =
        ["tree", "--locked", "--offline", "-p", "ndda-cli", "-e", "normal", "--no-default-features"];
    let mut command = std::process::Command::new(env!("CARGO"));
    command.current_dir(env!("CARGO_MANIFEST_DIR")).args(arguments).args([
        "--features",
        features,
        "--prefix",
        "none",
    ]);
    let out = command.output().unwrap();
    assert!(out.status.success(), "{}", String::from_utf8_lossy(&out.stderr));
    let text = String::from_utf8(out.stdout).unwrap();
    let packages = text.lines().map(|line| line.trim_end_matches(" (*)"));
    let others = packages.filter(|line| !line.is_empty() && !line.starts_with("ndda"));
    others.collect::<std::collections::BTreeSet<&str>>().len()
}

// Other systems have packages of their own.
#[cfg(all(target_os = "linux", target_arch = "x86_64"))]
#[test]
fn features_that_are_not_enabled_leave_their_packages_out() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/reference/features.md");
    let text = std::fs::read_to_string(path).unwrap();
    let mut rows = 0;
    for line in text.lines() {
        let cells: Vec<&str> = line.split('|').map(str::trim).collect();
        let [_, feature, _, count, _] = cells[..] else { continue };
        let Ok(count) = count.parse::<usize>() else { continue };
        let features = match feature {
            "none" => "",
            name => name.trim_start_matches('`').split('`').next().unwrap(),
        };
        assert_eq!(
            packages(features),
            count,
            "packages with `{features}`: docs/reference/features.md says {count}"
        );
        rows += 1;
    }
    assert_eq!(rows, 12, "rows of docs/reference/features.md");
}
