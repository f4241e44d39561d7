//! Elastic, affine, rigid and fixed blocks: what they share, and what each is alone in.

use ndda_mesh::Vec3;
use ndda_solver::Simulation;

use crate::evidence::Answer::{AtMost, Within};
use crate::evidence::{rounding, rounding_walk, row};
use crate::{POISSON, YOUNG_PA, assert_uniform_strain, displacements, simulation};

const MOVING: [&str; 3] = ["Elastic", "Affine", "Rigid"];

/// A brick that tumbles in empty space, ω Δt = 0.01.
fn tumbling(body: &str, integrator: &str) -> Simulation {
    simulation(&format!(
        "(title: \"tumbling\", time: (step_s: 1e-3, end_s: 1, integrator: {integrator}),
          materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2600)],
          blocks: [(name: \"brick\", material: \"rock\", shape: Box(size_m: (0.3, 0.2, 0.1), cells: (1, 1, 1)), body: {body},
             velocity_m_s: (1, 2, 3), spin_rad_s: (0.1, 10, 0.1))])"
    ))
}

/// Steps of the free spins; `NDDA_STEPS` sets more.
fn steps() -> usize {
    std::env::var("NDDA_STEPS").ok().and_then(|text| text.parse().ok()).unwrap_or(20_000)
}

/// Steps in which a brick turns over a few times.
const TURNS: usize = 5_000;

#[test]
fn a_tumbling_block_of_any_kind_keeps_angular_momentum_energy_and_size() {
    for body in MOVING {
        let mut simulation = tumbling(body, "Midpoint(theta: 0.5)");
        let start = simulation.sample().unwrap();
        let mut stress = vec![[0.0; 6]; simulation.blocks().tets.len()];
        let mut largest = 0.0f64;
        for step in 0..steps() {
            simulation.step().unwrap();
            if step % 97 == 0 {
                simulation.recover_stress(&mut stress).unwrap();
                largest = stress.iter().flatten().fold(largest, |most, s| most.max(s.abs()));
            }
        }
        let end = simulation.sample().unwrap();
        let worst = simulation.invariants();
        let energy = (end.total_j() / start.total_j() - 1.0).abs();
        let named = |what: &str| format!("{body} brick that tumbles for {} steps: {what}", steps());
        // Conserved exactly: what is left is the rounding of so many steps. Rock that deforms is stretched by its spin, by ρ ω² r²/E = 5e-7, which
        // vibrates: twice that passes. The part of the energy that stretches it is as small, of which the scheme may lose some. Rigid rock has no stress at all.
        let rounds = rounding_walk(steps());
        // A velocity that does not change is rounded alike in each step, by half a unit at most.
        let drift = 0.5 * f64::EPSILON * steps() as f64;
        // A mass centre that is off by half a unit of its way s has the angular momentum ½ ε s M v, beside that of the spin, M (0.3² + 0.1²) ω/12.
        let (speed_m_s, of_spin_m2_s) = (14_f64.sqrt(), 10.0 * (0.3 * 0.3 + 0.1 * 0.1) / 12.0);
        let way_m = speed_m_s * 1e-3 * steps() as f64;
        let turned = rounds + 0.5 * f64::EPSILON * way_m * speed_m_s / of_spin_m2_s;
        row("spin of all kinds of body", &named("momentum"), worst.linear_momentum, AtMost(drift));
        row("spin of all kinds of body", &named("angular momentum"), worst.angular_momentum, AtMost(turned));
        // The rotation of a rigid brick is read from its nodes, 0.19 m from its centre, whose places are rounded by half a unit of the way, which grows: ½ ε s/r √(n/3) of the
        // energy of the spin, a part of all.
        let of_spin = 5.0 * of_spin_m2_s / (5.0 * of_spin_m2_s + 0.5 * speed_m_s * speed_m_s);
        let read = 0.5 / 3_f64.sqrt() * rounds * way_m / 0.19 * of_spin;
        let (lost, stressed) = if body == "Rigid" { (rounds + read, 0.0) } else { (largest / 20e9, 1e-6) };
        row("spin of all kinds of body", &named("change of energy"), energy, AtMost(lost));
        row("spin of all kinds of body", &named("largest stress over E"), largest / 20e9, AtMost(stressed));
    }
}

#[test]
fn a_rigid_block_keeps_the_energy_of_its_spin_to_rounding_and_turns_over_about_its_middle_axis() {
    for integrator in
        ["Midpoint(theta: 0.5)", "Newmark(alpha: 0.5, delta: 1)", "GeneralizedAlpha(radius: 0.5)"]
    {
        let mut simulation = tumbling("Rigid", integrator);
        let start = simulation.sample().unwrap();
        let mut lowest = f64::INFINITY;
        for _ in 0..TURNS {
            simulation.step().unwrap();
            let x = &simulation.state().position;
            // The box's own y axis: Dzhanibekov's turn takes it over.
            let side = x[2] - x[0];
            lowest = lowest.min(side.y / side.norm());
        }
        let end = simulation.sample().unwrap();
        let named = |what: &str| format!("rigid brick that turns over, {integrator}: {what}");
        row(
            "spin of all kinds of body",
            &named("kinetic energy [J]"),
            end.kinetic_j,
            Within(start.kinetic_j, rounding_walk(TURNS)),
        );
        row(
            "spin of all kinds of body",
            &named("angular momentum"),
            simulation.invariants().angular_momentum,
            AtMost(rounding_walk(TURNS)),
        );
        assert!(lowest < -0.5, "{integrator}: it never turned over ({lowest})");
        let rest = &simulation.blocks().rest_position;
        let x = &simulation.state().position;
        let diagonal = (rest[7] - rest[0]).norm();
        let stretch = ((x[7] - x[0]).norm() / diagonal - 1.0).abs();
        // Its corners are found from its centre and its turn at each step: both ends are rounded to half a digit of where it has flown to.
        let rounds = f64::EPSILON * x[0].amax() / diagonal;
        row("spin of all kinds of body", &named("stretch of its diagonal"), stretch, AtMost(rounds));
    }
}

#[test]
fn blocks_of_unlike_kinds_meet_and_keep_their_momenta() {
    for (a, b) in [("Rigid", "Elastic"), ("Affine", "Rigid"), ("Rigid", "Rigid"), ("Affine", "Elastic")] {
        let mut simulation = simulation(&format!(
            "(title: \"glancing\", time: (step_s: 2e-4, end_s: 1),
              materials: [(name: \"rock\", young_pa: 1e9, poisson: 0.2, density_kg_m3: 2500)],
              blocks: [
                (name: \"a\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (2, 1, 1)), body: {a}, velocity_m_s: (2, 0, 0.3),
                 spin_rad_s: (0.5, 2, -1)),
                (name: \"b\", material: \"rock\", shape: Box(size_m: (1, 0.5, 1), cells: (1, 1, 1)), body: {b}, at_m: (1.01, 0.6, 0.7)),
              ],
              contact: Potential(penalty_pa: 1e7, friction: (friction_deg: 30)))"
        ));
        simulation.sample().unwrap();
        let mut pairs = 0;
        for _ in 0..1500 {
            pairs += simulation.step().unwrap().contact.contact_pairs;
        }
        simulation.sample().unwrap();
        let worst = simulation.invariants();
        assert!(pairs > 100, "they do not meet");
        let named = |what: &str| format!("{a} and {b} blocks that meet: {what}");
        // Kept but for rounding; a block that does not deform may round the same way for as long as it keeps its velocity and spin.
        let rounds = AtMost(rounding(1500));
        row("bodies", &named("momentum"), worst.linear_momentum, rounds);
        row("bodies", &named("angular momentum"), worst.angular_momentum, rounds);
        // While blocks are pressed, explicit contact holds back h²/4 of its energy, and at either end of it as much: h²/2 at most.
        let most = (0.5 * worst.max_h * worst.max_h).min(1e-3);
        row("bodies", &named("energy gained"), worst.energy_gain, AtMost(most));
    }
}

#[test]
fn an_affine_bar_on_rollers_takes_a_uniform_strain_exactly() {
    let traction = 1e6;
    let mut simulation = simulation(&format!(
        "(title: \"bar\", time: (step_s: 2e-4, end_s: 1, integrator: Newmark(alpha: 0.5, delta: 1)),
          materials: [(name: \"rock\", young_pa: {YOUNG_PA:e}, poisson: {POISSON}, density_kg_m3: 2500)],
          blocks: [(name: \"bar\", material: \"rock\", shape: Box(size_m: (2, 1, 0.5), cells: (4, 2, 1)), body: Affine)],
          supports: [{}], tractions: [(block: \"bar\", on: Set(\"x_max\"), traction_pa: ({traction:e}, 0, 0))])",
        crate::rollers("")
    ));
    assert_eq!(simulation.unknowns(), 3, "the rollers leave three stretches");
    crate::settle(&mut simulation);
    let strain = traction / YOUNG_PA;
    assert_uniform_strain(&simulation, Vec3::new(strain, -POISSON * strain, -POISSON * strain), 1e-9);
}

#[test]
fn a_fixed_block_has_no_unknowns_bears_its_load_and_goes_where_it_is_told_to() {
    let mut simulation = simulation(
        "(title: \"base\", time: (step_s: 1e-3, end_s: 1), gravity_m_s2: (0, 0, -10),
          materials: [(name: \"rock\", young_pa: 1e9, poisson: 0.2, density_kg_m3: 2000)],
          blocks: [
            (name: \"still\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (2, 2, 2)), body: Fixed),
            (name: \"moved\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), body: Fixed, at_m: (5, 0, 0)),
          ],
          supports: [(block: \"moved\", on: All, hold: Motion([(time_s: 0, displacement_m: (0, 0, 0)),
                      (time_s: 1, displacement_m: (0.3, 0, 0.4))]))],
          contact: Off)",
    );
    assert_eq!((simulation.unknowns(), simulation.factors()), (0, 0));
    let start = simulation.sample().unwrap();
    for _ in 0..500 {
        simulation.step().unwrap();
    }
    let moved = displacements(&simulation);
    assert!(moved[..27].iter().all(|u| *u == Vec3::zeros()));
    assert!(moved[27..].iter().all(|u| (u - Vec3::new(0.15, 0.0, 0.2)).norm() < 1e-15));
    let sample = simulation.sample().unwrap();
    // Lifting 2000 kg by 0.2 m. It moves at 0.5 m/s from the start on, which is energy that the scene begins with.
    let moving_j = 0.5 * 2000.0 * 0.5 * 0.5;
    row(
        "bodies",
        "kinetic energy of a moved block at the start [J]",
        start.kinetic_j,
        Within(moving_j, rounding(8)),
    );
    let work_j = 2000.0 * 10.0 * 0.2;
    row(
        "bodies",
        "work of moving a fixed block [J]",
        sample.motion_work_j,
        Within(work_j, rounding_walk(500)),
    );
    // What moves it books as much momentum as it has.
    let rounds = rounding_walk(500);
    row("bodies", "momentum of fixed blocks", simulation.invariants().linear_momentum, AtMost(rounds));
}

#[test]
fn supports_that_a_kind_of_body_cannot_have_are_refused_by_name() {
    for (body, support, word) in [
        ("Rigid", "on: Set(\"z_min\"), hold: Fixed", "rigid"),
        ("Fixed", "on: Set(\"z_min\"), hold: Fixed", "held already"),
        ("Affine", "on: Set(\"z_min\"), hold: Motion([(time_s: 0, displacement_m: (0, 0, 0))])", "affine"),
    ] {
        let text = format!(
            "(title: \"no\", time: (step_s: 1e-3, end_s: 1),
              materials: [(name: \"rock\", young_pa: 1e9, poisson: 0.2, density_kg_m3: 2000)],
              blocks: [(name: \"b\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), body: {body})],
              supports: [(block: \"b\", {support})])"
        );
        let loaded = ndda_io::read::load_text("case.ron", &text, &[], None).unwrap();
        let folder = std::path::Path::new(".");
        let blocks = ndda::build::blocks(&loaded.scene, folder).unwrap();
        let faults = ndda::build::simulation(&loaded.scene, blocks, folder).err().expect("a refusal");
        assert_eq!(faults[0].path, "supports[0]");
        assert!(faults[0].message.contains(word), "{faults:?}");
    }
}

#[test]
fn a_block_of_any_kind_slides_down_a_fixed_ramp_as_the_closed_form_says() {
    // A flat block that starts just in touch; no friction: s = ½ g sin α t².
    for body in MOVING {
        let mut simulation = simulation(&format!(
            "(title: \"ramp\", time: (step_s: 1e-4, end_s: 1), gravity_m_s2: (6.929646455628166, 0, -6.929646455628166),
              materials: [(name: \"rock\", young_pa: 200e9, poisson: 0.25, density_kg_m3: 2650)],
              blocks: [
                (name: \"ramp\", material: \"rock\", shape: Box(size_m: (4, 1, 0.5), cells: (8, 2, 1)), body: Fixed),
                (name: \"block\", material: \"rock\", shape: Box(size_m: (0.2, 0.2, 0.06), cells: (2, 2, 1)), body: {body},
                 at_m: (0.5, 0.4, 0.5)),
              ],
              contact: Potential(penalty_pa: 2e6, potential: Smooth(reference_m: 1)))"
        ));
        simulation.sample().unwrap();
        for _ in 0..5000 {
            simulation.step().unwrap();
        }
        let block = &displacements(&simulation)[simulation.blocks().nodes_of(ndda_mesh::BlockId(1))];
        let mean = block.iter().sum::<Vec3>() / block.len() as f64;
        let exact = 0.5 * 6.929646455628166 * 0.25;
        let (gain, h) = (simulation.invariants().energy_gain, simulation.invariants().max_h);
        // The scheme is exact for a constant acceleration: rounding of 5000 steps, tenfold. Nodes of rock that deforms are off their mass
        // centre by a strain of ρ g h/E.
        let strain = if body == "Elastic" { 2650.0 * 9.8 * 0.06 / 200e9 } else { 0.0 };
        row(
            "the paper's ramps",
            &format!("slide of a block on a fixed ramp, {body} [m]"),
            mean.x,
            Within(exact, strain + 10.0 * rounding(5000)),
        );
        // Explicit contact holds back up to h²/2 of the energy.
        let most = (0.5 * h * h).min(1e-4);
        row("the paper's ramps", &format!("energy gained by it, {body}"), gain, AtMost(most));
    }
}
