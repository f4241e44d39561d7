use super::*;
use crate::Model;

/// Blocks on a floor, under gravity with a level part, and with forces.
fn text(penalty_pa: f64, level_m_s2: f64, blocks: &str, forces: &str) -> String {
    format!(
        "(title: \"t\", time: (step_s: 1e-3, end_s: 1), gravity_m_s2: ({level_m_s2}, 0, -9.81),
         materials: [(name: \"rock\", young_pa: 2e10, poisson: 0.25, density_kg_m3: 2500)],
         blocks: [(name: \"floor\", material: \"rock\", body: Fixed, shape: Box(size_m: (4, 3, 1), cells: (2, 1, 1)), at_m: (-2, -1, -1)), {blocks}],
         forces: [{forces}],
         contact: Potential(penalty_pa: {penalty_pa}, potential: Smooth(reference_m: 1), friction: (friction_deg: 60)))"
    )
}

fn leaning(text: &str) -> Option<Lean> {
    let loaded = ndda_io::read::load_text("t.ron", text, &[], None).unwrap();
    let scene = loaded.scene.clone();
    worst(&scene, &Model::new(loaded, std::path::Path::new(".")).unwrap().simulation)
}

/// A column of 1 × 1 × 4 m, its lower corner so far from that of a floor.
fn pushed(penalty_pa: f64, level_m_s2: f64, at_x_m: f64, forces: &str) -> Option<Lean> {
    let column = format!(
        "(name: \"column\", material: \"rock\", body: Rigid, shape: Box(size_m: (1, 1, 4), cells: (1, 1, 1)), at_m: ({at_x_m}, 0, 0))"
    );
    leaning(&text(penalty_pa, level_m_s2, &column, forces))
}

fn found(penalty_pa: f64, level_m_s2: f64, at_x_m: f64) -> Option<Lean> {
    pushed(penalty_pa, level_m_s2, at_x_m, "")
}

#[test]
fn a_weight_near_an_edge_is_measured_by_its_distance_from_it() {
    // tan α = 0.2: the foot is 0.1 m from the edge.
    let lean = found(2e8, 0.2 * 9.81, 0.0).unwrap();
    let exact = 2500.0 * 4.0 * 9.81 * 2.0 * 1.04 / (9.0 * 2e8 * 1e-3);
    assert!((lean.inside_m - 0.1).abs() < 1e-9 && (lean.m / exact - 1.0).abs() < 1e-6, "{lean:?}, {exact}");
    assert!(lean.to_string().contains(" mm inside the edge of its base"), "{lean}");
    assert_eq!(found(1e10, 0.2 * 9.81, 0.0), None, "contact is stiff");
    assert_eq!(found(2e8, 0.0, 0.0), None, "its weight acts in the middle of a base that is stiff enough");
    assert_eq!(found(2e8, 0.3 * 9.81, 0.0), None, "its weight acts beyond the edge, so that it topples");
}

/// A side of 4 × 1 m with T = 0.2 of the weight, which acts 0.9 m behind the foot; water up to 2 m, whose pressure sinks with the face; and the same for a moment.
#[test]
fn tractions_and_water_move_the_foot_of_a_weight_and_pulses_do_not() {
    let column = "(name: \"column\", material: \"rock\", body: Rigid, shape: Box(size_m: (1, 1, 4), cells: (1, 1, 1)), at_m: (0, 0, 0))";
    let weight_n = 2500.0 * 4.0 * 9.81;
    let loaded = |penalty_pa: f64, loads: &str| {
        leaning(&text(penalty_pa, 0.0, column, "").replace("forces: [],", loads))
    };
    let traction = |factor: &str| {
        format!(
            "tractions: [(block: \"column\", on: Set(\"x_min\"), traction_pa: ({}, 0, 0){factor})],",
            0.05 * weight_n
        )
    };
    let lasting = ", factor: [(time_s: 0, factor: 0), (time_s: 1, factor: 1), (time_s: 3, factor: 0)]";
    for factor in ["", lasting] {
        let lean = loaded(2e8, &traction(factor)).unwrap();
        let exact = weight_n * (2.0 + 0.2 * 0.9) / (9.0 * 2e8 * 1e-3);
        assert!(
            (lean.inside_m - 0.1).abs() < 1e-9 && (lean.m / exact - 1.0).abs() < 1e-9,
            "{lean:?}, {exact}"
        );
    }
    let pulse = ", factor: [(time_s: 0, factor: 0), (time_s: 0.1, factor: 1), (time_s: 0.2, factor: 0)]";
    assert_eq!(loaded(2e8, &traction(pulse)), None);
    // H = ρ g 2²/2 m acts 2/3 m above the base, which moves the weight by 4/30 m.
    let water =
        "water: [(on: Part(block: \"column\", region: Set(\"x_min\")), pressure: Level(at_m: (0, 0, 2)))],";
    let lean = loaded(2e6, water).unwrap();
    assert!((lean.inside_m - (0.5 - 4.0 / 30.0)).abs() < 1e-9, "{lean:?}");
}

#[test]
fn a_force_moves_the_foot_of_a_weight_as_a_level_part_of_gravity_does() {
    let level = found(2e8, 0.2 * 9.81, 0.0).unwrap();
    let force_n = 2500.0 * 4.0 * 0.2 * 9.81;
    // Through the mass centre; on a point at its height; with a factor over time; and where it pushes with half the force at twice the height.
    for force in [
        format!("(block: \"column\", force_n: ({force_n}, 0, 0))"),
        format!("(block: \"column\", at_m: (0.5, 0.5, 2), force_n: ({force_n}, 0, 0))"),
        format!(
            "(block: \"col*\", force_n: ({force_n}, 0, 0), factor: [(time_s: 0, factor: 0), (time_s: 1, factor: 1), (time_s: 2, factor: 0.5)])"
        ),
    ] {
        let pushed = pushed(2e8, 0.0, 0.0, &force).unwrap();
        assert!(
            (pushed.inside_m - 0.1).abs() < 1e-9 && (pushed.m / level.m - 1.0).abs() < 1e-9,
            "{pushed:?}, {level:?}"
        );
    }
    let high = format!("(block: \"column\", at_m: (0, 0.5, 4), force_n: ({}, 0, 0))", 0.5 * force_n);
    let high = pushed(2e8, 0.0, 0.0, &high).unwrap();
    // Arm: h for the weight, and 0.1 × 0.9 m for the force, which acts 0.9 m behind the foot.
    let exact = 2500.0 * 4.0 * 9.81 * (2.0 + 0.1 * 0.9) / (9.0 * 2e8 * 1e-3);
    assert!((high.inside_m - 0.1).abs() < 1e-9 && (high.m / exact - 1.0).abs() < 1e-9, "{high:?}, {exact}");
}

/// Gravity that is tilted by 0.05 moves the foot by 0.1 m of the middle: R = 0.3 takes it 0.0429 m on, of 0.4 m to the edge; beyond R = 0.511 it falls. Upright, R = 1 decides.
#[test]
fn a_weight_in_the_middle_third_counts_by_the_tilt_of_the_whole_base() {
    let at = |r: f64, level: f64| {
        let weight_n = 2500.0 * 4.0 * 9.81;
        found(6.0 * weight_n * 2.0 * (1.0 + level * level) / r, level * 9.81, 0.0)
    };
    let lean = at(0.3, 0.05).unwrap();
    assert!(
        (lean.inside_m - 0.4).abs() < 1e-9 && (lean.moved - 0.3 / 0.7 * 0.1 / 0.4).abs() < 1e-9,
        "{lean:?}"
    );
    assert!(at(0.51, 0.05).unwrap().moved < 1.0 && at(0.512, 0.05).unwrap().moved == 1.0);
    assert!(at(0.99, 0.0).is_none() && at(1.01, 0.0).unwrap().moved == 1.0);
    let advised = found(lean.penalty_pa, 0.05 * 9.81, 0.0);
    assert!(advised.is_none(), "{advised:?}");
}

/// A joint across a column changes nothing: its lower part bears all of the weight.
#[test]
fn blocks_that_rest_on_a_block_count_with_it() {
    let column = "(name: \"column\", material: \"rock\", body: Rigid, shape: Box(size_m: (1, 1, 4), cells: (1, 1, 1)), at_m: (0, 0, 0))";
    let drum = |k: usize| {
        format!(
            "(name: \"drum_{k}\", material: \"rock\", body: Rigid, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), at_m: (0, 0, {k}))"
        )
    };
    let drums = [0, 1, 2, 3].map(drum).join(", ");
    // Gravity alone, and with a force on the uppermost one.
    for (level_m_s2, force) in [
        (0.2 * 9.81, String::new()),
        (
            0.0,
            format!(
                "(block: \"NAME\", at_m: (0.5, 0.5, 3.5), force_n: ({}, 0, 0))",
                2500.0 * 4.0 * 0.2 * 9.81 * 2.0 / 3.5
            ),
        ),
    ] {
        let [whole, parted] = [(column, "column"), (drums.as_str(), "drum_3")].map(|(blocks, name)| {
            let text = text(2e8, level_m_s2, blocks, &force.replace("NAME", name));
            leaning(&text).unwrap()
        });
        assert_eq!((parted.block.as_str(), parted.blocks_on_it), ("drum_0", 3));
        assert!((parted.m / whole.m - 1.0).abs() < 1e-9, "{parted:?}, {whole:?}");
        let words = "the weight of block `drum_0` and of 3 blocks on it, with the loads on them, acts 100";
        assert!(parted.to_string().starts_with(words), "{parted}");
    }
}

/// Over a corner of 90° a triangle bears: y³ (1 − y) = 3 N h L₀/(16 k_n d⁴) for the part y of d that is left, up to 27/256.
#[test]
fn over_a_corner_a_triangle_bears_and_gives_way_more() {
    let column = "(name: \"column\", material: \"rock\", body: Rigid, shape: Box(size_m: (1, 1, 4), cells: (1, 1, 1)), turns: [(axis: (0, 0, 1), angle_deg: 45)])";
    let (inside_m, weight_n) = (0.02_f64.sqrt(), 2500.0 * 4.0 * 9.81);
    let tangent = 0.5 * (0.5_f64.sqrt() - inside_m);
    let at = |m: f64| {
        let penalty_pa = 3.0 * weight_n * 2.0 * (1.0 + tangent * tangent) / (16.0 * inside_m.powi(4) * m);
        leaning(&text(penalty_pa, 9.81 * tangent, column, ""))
    };
    let lean = at(0.08).unwrap();
    let y = 1.0 - lean.moved;
    assert!(
        (lean.inside_m - inside_m).abs() < 1e-9 && (y.powi(3) * (1.0 - y) / 0.08 - 1.0).abs() < 1e-6,
        "{lean:?}"
    );
    assert!(at(0.105).unwrap().moved < 0.3 && at(0.106).unwrap().moved == 1.0);
    let advised = leaning(&text(at(0.106).unwrap().penalty_pa, 9.81 * tangent, column, ""));
    assert!(advised.is_none(), "{advised:?}");
}

/// A slab of 2 × 1 × 1 m whose weight acts 0.18 m inside a long edge and 0.2 m inside a short one, over which it moves more.
#[test]
fn the_edge_over_which_a_weight_moves_most_need_not_be_the_nearest() {
    let slab =
        "(name: \"slab\", material: \"rock\", body: Rigid, shape: Box(size_m: (2, 1, 1), cells: (1, 1, 1)))";
    let weight_n = 2500.0 * 2.0 * 9.81;
    let force = format!("(block: \"slab\", force_n: ({}, {}, 0))", 1.6 * weight_n, 0.64 * weight_n);
    let [short, long] = [(0.5 + 1.6 * 0.8, 1.0, 0.2_f64), (0.5 + 0.64 * 0.32, 2.0, 0.18)]
        .map(|(arm_m, width_m, inside_m)| weight_n * arm_m / (9.0 * width_m * inside_m.powi(3)));
    let lean = leaning(&text(short / 0.1, 0.0, slab, &force)).unwrap();
    assert!(long / short < 0.3 && lean.moved >= 1.0 - left(0.1) - 1e-6, "{lean:?}");
}

#[test]
fn a_scene_that_has_settled_is_judged_by_how_it_was_drawn() {
    let column = "(name: \"column\", material: \"rock\", body: Rigid, shape: Box(size_m: (1, 1, 4), cells: (1, 1, 1)), at_m: (0, 0, 0))";
    let loaded = ndda_io::read::load_text("t.ron", &text(2e8, 0.2 * 9.81, column, ""), &[], None).unwrap();
    let scene = loaded.scene.clone();
    let mut simulation = Model::new(loaded, std::path::Path::new(".")).unwrap().simulation;
    let drawn = worst(&scene, &simulation);
    simulation.settle(&ndda_solver::Settle::new(1e-6, 100_000)).unwrap();
    assert!(drawn.is_some() && worst(&scene, &simulation) == drawn, "{drawn:?}");
}

#[test]
fn the_edge_is_that_of_what_a_block_rests_on() {
    // The floor ends at x = 2: 0.55 m of the base lie on it.
    let lean = found(2e8, 0.0, 1.45).unwrap();
    assert!((lean.inside_m - 0.05).abs() < 1e-9, "{lean:?}");
    assert!(lean.to_string().contains("the block falls"), "{lean}");
}
