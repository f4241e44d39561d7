//! Quiet boundaries: what they send back, what arrives through them, and what they hold up (Lysmer & Kuhlemeyer 1969).

use std::f64::consts::{PI, TAU};

use ndda_mesh::Vec3;
use ndda_solver::{Settle, Simulation};

use crate::evidence::Answer::{AtMost, Within};
use crate::evidence::row;

pub const YOUNG_PA: f64 = 20e9;
pub const DENSITY: f64 = 2650.0;
/// Edge of a cell of columns [m].
pub const CELL_M: f64 = 1.0;

/// c_p and c_s at ν = ¼ [m/s].
pub fn speeds() -> (f64, f64) {
    ((1.2 * YOUNG_PA / DENSITY).sqrt(), (0.4 * YOUNG_PA / DENSITY).sqrt())
}

/// A column of cells along z of which the nodes of each level move alike; `more` goes into the scene, which may name `quake.csv` with these rows.
fn column(cells: u32, step_s: f64, (mass, a): (&str, f64), more: &str, rows: &[(f64, f64)]) -> Simulation {
    let height = CELL_M * f64::from(cells);
    let text = format!(
        "(title: \"column\", time: (step_s: {step_s:e}, end_s: 1, mass: {mass}),
          materials: [(name: \"rock\", young_pa: {YOUNG_PA:e}, poisson: 0.25, density_kg_m3: {DENSITY}),
                      (name: \"beyond\", young_pa: {:e}, poisson: 0.25, density_kg_m3: {:e})],
          blocks: [(name: \"column\", material: \"rock\",
                    shape: Box(size_m: ({CELL_M}, {CELL_M}, {height}), cells: (1, 1, {cells})))],
          ties: [(block: \"column\", on: [All])], {more})",
        a * YOUNG_PA,
        a * DENSITY
    );
    with_record(&text, rows)
}

/// The simulation of a scene beside a record `quake.csv` of (time [s], acceleration [m/s²]).
pub fn with_record(text: &str, rows: &[(f64, f64)]) -> Simulation {
    let loaded = ndda_io::read::load_text("case.ron", text, &[], None).unwrap_or_else(|e| panic!("{e}"));
    let folder = tempfile::tempdir().unwrap();
    let rows: String = rows.iter().map(|(t, a)| format!("{t:e},{a:e}\n")).collect();
    std::fs::write(folder.path().join("quake.csv"), format!("time_s,acceleration_m_s2\n{rows}")).unwrap();
    let blocks = ndda::build::blocks(&loaded.scene, folder.path()).unwrap();
    let built = ndda::build::simulation(&loaded.scene, blocks, folder.path());
    built.unwrap_or_else(|faults| panic!("{faults:?}"))
}

/// Velocity of a level, along an axis.
pub fn velocity(simulation: &Simulation, z_m: f64, axis: usize) -> f64 {
    let blocks = simulation.blocks();
    let at = |x: &Vec3| ((x + blocks.origin_m).z - z_m).abs() < 1e-6;
    let node = blocks.rest_position.iter().position(at).expect("a level of nodes");
    simulation.state().velocity[node][axis]
}

/// A column under a sine traction at its top, quiet at its foot with rock of an impedance beyond that is `a` times its own: amplitude of the waves up
/// over that of those down, by least squares over a period.
fn reflected(nodes_a_wave: u32, mass: &str, a: f64) -> f64 {
    let c = speeds().0;
    let cells = 6 * nodes_a_wave;
    let period_s = f64::from(nodes_a_wave) * CELL_M / c;
    let steps_a_period = 40 * nodes_a_wave;
    let step_s = period_s / f64::from(steps_a_period);
    let omega = TAU / period_s;
    // A ramp of three periods, then a steady state.
    let factor: String = (0..=40 * 40)
        .map(|k| f64::from(k) * period_s / 40.0)
        .map(|t| (t, (omega * t).sin() * (1.0 - (PI * (t / (6.0 * period_s)).min(1.0)).cos()) / 2.0))
        .map(|(t, f)| format!("(time_s: {t:e}, factor: {f:e}),"))
        .collect();
    let mut simulation = column(
        cells,
        step_s,
        (mass, a),
        &format!(
            "quiet: [(block: \"column\", on: Set(\"z_min\"), beyond: \"beyond\"), (block: \"column\", on: Set(\"z_max\"))],
             tractions: [(block: \"column\", on: Set(\"z_max\"), traction_pa: (0, 0, 1e6), factor: [{factor}])]"
        ),
        &[],
    );
    let levels: Vec<f64> = (1..=2 * nodes_a_wave).map(|k| CELL_M * f64::from(k)).collect();
    (0..18 * steps_a_period).for_each(|_| {
        simulation.step().unwrap();
    });
    // Complex amplitude of each level, over one period.
    let mut amplitude = vec![(0.0, 0.0); levels.len()];
    for k in 0..steps_a_period {
        simulation.step().unwrap();
        let phase = TAU * f64::from(k) / f64::from(steps_a_period);
        for (sum, z) in amplitude.iter_mut().zip(&levels) {
            let v = velocity(&simulation, *z, 2);
            *sum = (sum.0 + v * phase.cos(), sum.1 - v * phase.sin());
        }
    }
    let h = omega * CELL_M / c;
    let q = wave_number(h, mass);
    let (down, up) = split(&levels, &amplitude, q);
    up.0.hypot(up.1) / down.0.hypot(down.1)
}

/// q h of the mesh at ω h/c: sin(q h/2) = ω h/2c for lumped masses, 6 (1 − cos q h)/(2 + cos q h) = (ω h/c)² for consistent ones.
pub fn wave_number(h: f64, mass: &str) -> f64 {
    match mass {
        "Lumped" => 2.0 * (0.5 * h).asin() / CELL_M,
        _ => ((6.0 - 2.0 * h * h) / (6.0 + h * h)).acos() / CELL_M,
    }
}

/// A complex number.
pub type Complex = (f64, f64);

/// A and B of the best A exp(i q z) + B exp(−i q z), the waves down and up.
pub fn split(levels: &[f64], amplitude: &[Complex], q: f64) -> (Complex, Complex) {
    let n = levels.len() as f64;
    let mut cross = (0.0, 0.0);
    let (mut down, mut up) = ((0.0, 0.0), (0.0, 0.0));
    for (z, v) in levels.iter().zip(amplitude) {
        let (c, s) = ((q * z).cos(), (q * z).sin());
        // conj(exp(i q z)) v and conj(exp(−i q z)) v, and the product of the two.
        down = (down.0 + c * v.0 + s * v.1, down.1 + c * v.1 - s * v.0);
        up = (up.0 + c * v.0 - s * v.1, up.1 + c * v.1 + s * v.0);
        cross = (cross.0 + (2.0 * q * z).cos(), cross.1 - (2.0 * q * z).sin());
    }
    // [n x; x̄ n] (A, B) = (down, up).
    let times = |a: (f64, f64), b: (f64, f64)| (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0);
    let (xu, xd) = (times(cross, up), times((cross.0, -cross.1), down));
    let a = (n * down.0 - xu.0, n * down.1 - xu.1);
    let b = (n * up.0 - xd.0, n * up.1 - xd.1);
    let d = n * n - cross.0 * cross.0 - cross.1 * cross.1;
    ((a.0 / d, a.1 / d), (b.0 / d, b.1 / d))
}

/// |R| at the foot of a mesh with a dashpot of `a` times its impedance: of A exp(i q z) + B exp(−i q z), the equation of the last node.
fn discrete(nodes_a_wave: u32, mass: &str, impedance: f64) -> f64 {
    let h = TAU / f64::from(nodes_a_wave);
    let q = wave_number(h, mass) * CELL_M;
    let (own, other) = if mass == "Lumped" { (0.5, 0.0) } else { (1.0 / 3.0, 1.0 / 6.0) };
    // (1 − own h²) u₀ − (1 + other h²) u₁ + i h u₀ = 0.
    let (a, b) = (1.0 - own * h * h, -(1.0 + other * h * h));
    let size = |sign: f64| (a + b * q.cos()).hypot(impedance * h + sign * b * q.sin());
    size(1.0) / size(-1.0)
}

#[test]
fn a_quiet_face_sends_back_what_the_mesh_makes_of_it() {
    for (mass, printed) in
        [("Lumped", [0.0260, 0.00625, 0.00155]), ("Consistent", [0.00836, 0.00206, 0.000515])]
    {
        for (nodes, printed) in [10, 20, 40].into_iter().zip(printed) {
            let exact = discrete(nodes, mass, 1.0);
            assert!((exact / printed - 1.0f64).abs() < 5e-3, "{mass} {nodes}: {exact}");
        }
        for nodes in [10, 20, 40] {
            // The answer knows no time step: waves are off by (ω Δt)²/12 for that, and what returns by as much over its part. Six times that passes.
            let exact = discrete(nodes, mass, 1.0);
            let steps = 0.5 * (TAU / f64::from(40 * nodes)).powi(2) / exact;
            row(
                "quiet face",
                &format!("reflected amplitude, normal incidence, {nodes} nodes a wave, {mass} mass"),
                reflected(nodes, mass, 1.0),
                Within(exact, steps),
            );
        }
    }
}

#[test]
fn a_wrong_impedance_beyond_a_face_sends_its_own_part_back() {
    for a in [0.9f64, 0.5, 2.0] {
        let exact = ((a - 1.0) / (a + 1.0)).abs();
        row(
            "quiet face",
            &format!("reflected amplitude where the rock beyond has {a} times the impedance"),
            reflected(20, "Consistent", a),
            Within(exact, 0.05),
        );
    }
}

/// Acceleration of a velocity that rises to 0.1 m/s and comes back, v = 0.05 (1 − cos 2πt/T), in rows that hold it well.
pub fn pulse(length_s: f64) -> Vec<(f64, f64)> {
    let a = |t: f64| 0.05 * TAU / length_s * (TAU * t / length_s).sin();
    (0..=400).map(|k| f64::from(k) / 400.0 * length_s).map(|t| (t, a(t))).collect()
}

/// Its velocity.
fn pulse_velocity(t: f64, length_s: f64) -> f64 {
    if (0.0..length_s).contains(&t) { 0.05 * (1.0 - (TAU * t / length_s).cos()) } else { 0.0 }
}

#[test]
fn a_wave_arrives_doubles_at_the_ground_and_leaves() {
    let cells = 40;
    let height = CELL_M * f64::from(cells);
    for (kind, c, axis) in [("P", speeds().0, 2), ("S((1, 0, 0))", speeds().1, 0)] {
        let length_s = 40.0 * CELL_M / c;
        let step_s = 0.1 * CELL_M / c;
        for (is, share) in [("Upgoing", 1.0), ("Outcrop", 0.5)] {
            let quiet = format!(
                "quiet: [(block: \"column\", on: Set(\"z_min\"), incident: [(wave: {kind}, motion: {is}, record: (file: \"quake.csv\"))])]"
            );
            let mut simulation = column(cells, step_s, ("Consistent", 1.0), &quiet, &pulse(length_s));
            let (mut error, mut brought_j, mut most_j) = (0.0f64, 0.0, 0.0f64);
            simulation.sample().unwrap();
            let steps = ((2.0 * height / c + 1.5 * length_s) / step_s) as u32;
            for step in 1..=steps {
                simulation.step().unwrap();
                let t = f64::from(step) * step_s;
                let exact = 2.0 * share * pulse_velocity(t - height / c, length_s);
                error = error.max((velocity(&simulation, height, axis) - exact).abs());
                let arriving = share * pulse_velocity(t - 0.5 * step_s, length_s);
                brought_j += step_s * DENSITY * c * arriving * arriving * CELL_M * CELL_M;
                most_j = most_j.max(brought_j);
            }
            let name = |what: &str| format!("{what}, {kind} wave, {is}");
            row(
                "wave from below",
                &name("error at the ground over 2 v"),
                error / (0.2 * share),
                AtMost(0.01),
            );
            let sample = simulation.sample().unwrap();
            row(
                "wave from below",
                &name("work of the wave [J]"),
                sample.load_work_j,
                Within(brought_j, 1e-3),
            );
            row("wave from below", &name("energy that left [J]"), sample.radiated_j, Within(brought_j, 1e-3));
            let lost = (sample.kinetic_j + sample.strain_j) / most_j;
            // What the foot sends back of a wave of 40 cells, and four times its energy.
            let back = 4.0 * discrete(40, "Consistent", 1.0).powi(2);
            row("wave from below", &name("energy that stays over that which came"), lost, AtMost(back));
            // Rounding, of places of 60 m over displacements of millimetres among others: it has no closed form, and differs by 500 between cases.
            row("wave from below", &name("balance of energy"), sample.balance_j.abs() / most_j, AtMost(1e-9));
        }
    }
}

#[test]
fn a_record_from_within_moves_the_foot_as_it_says() {
    let (cells, c) = (20, speeds().1);
    let height = CELL_M * f64::from(cells);
    let length_s = 60.0 * CELL_M / c;
    let step_s = 0.2 * CELL_M / c;
    let quiet = format!(
        "quiet: [(block: \"column\", on: Set(\"z_min\"), incident: [
           (wave: S((1, 0, 0)), motion: Within, ground_m: (0, 0, {height}), record: (file: \"quake.csv\"))])]"
    );
    let mut simulation = column(cells, step_s, ("Consistent", 1.0), &quiet, &pulse(length_s));
    let mut error = 0.0f64;
    for step in 1..=(length_s / step_s) as u32 {
        simulation.step().unwrap();
        let exact = pulse_velocity(f64::from(step) * step_s, length_s);
        error = error.max((velocity(&simulation, 0.0, 0) - exact).abs());
    }
    row("wave from below", "error at the foot over the record, Within", error / 0.1, AtMost(0.01));
}

#[test]
fn a_settled_column_stays_and_one_that_nothing_holds_sinks() {
    let cells = 10;
    let more = "gravity_m_s2: (0, 0, -9.81), quiet: [(block: \"column\", on: Set(\"z_min\"))]";
    let mut simulation = column(cells, 1e-3, ("Consistent", 1.0), more, &[]);
    simulation.settle(&Settle::new(1e-8, 100_000)).unwrap();
    let start = simulation.state().position.clone();
    let top = start.iter().map(|x| x.z).fold(f64::NEG_INFINITY, f64::max);
    let squeezed = cells as f64 * CELL_M - (top - start.iter().map(|x| x.z).fold(f64::INFINITY, f64::min));
    let modulus = DENSITY * speeds().0.powi(2);
    let height = f64::from(cells) * CELL_M;
    row(
        "settled column",
        "shortening under its weight [m]",
        squeezed,
        // It settled to 1e-8 of its largest speed: twice that part.
        Within(DENSITY * 9.81 * height * height / (2.0 * modulus), 2.0 * 1e-8),
    );
    simulation.sample().unwrap();
    for _ in 0..1000 {
        simulation.step().unwrap();
    }
    let moved = simulation.state().position.iter().zip(&start).map(|(x, old)| (x - old).norm());
    row("settled column", "drift on a quiet foot in 1 s [m]", moved.fold(0.0, f64::max), AtMost(1e-9));
    let sample = simulation.sample().unwrap();
    // What a foot sends off in that second that drifts as fast as is permitted above.
    let sent_j = DENSITY * speeds().0 * 1e-9 * 1e-9 * CELL_M * CELL_M;
    row("settled column", "energy that left in 1 s [J]", sample.radiated_j, AtMost(sent_j));

    // A fresh simulation goes on from a snapshot with the same reactions, to the last bit.
    let mut resumed = column(cells, 1e-3, ("Consistent", 1.0), more, &[]);
    resumed.restore(simulation.snapshot()).unwrap();
    for _ in 0..10 {
        simulation.step().unwrap();
        resumed.step().unwrap();
    }
    assert_eq!(simulation.state(), resumed.state());

    // The load of the foot's own nodes is kept, half a cell of the column.
    let mut falling = column(cells, 1e-3, ("Consistent", 1.0), more, &[]);
    for _ in 0..200 {
        falling.step().unwrap();
    }
    assert!((9.81 * height / speeds().0 - 32.60e-3f64).abs() < 5e-6);
    let terminal = 9.81 * (height - 0.5 * CELL_M) / speeds().0;
    row(
        "settled column",
        "speed of a column that did not settle [m/s]",
        -velocity(&falling, 0.0, 2),
        Within(terminal, 5e-3),
    );
}

#[test]
fn the_sides_of_level_ground_move_as_the_ground_far_away() {
    let (size, height, c) = (20.0, 10.0, speeds().1);
    let length_s = 30.0 / c;
    let step_s = 0.2 / c;
    let side = |set: &str| {
        format!(
            "(block: \"ground\", on: Set(\"{set}\"), incident: [(wave: S((1, 0, 0)), from_m: (0, 0, 0), ground_m: (0, 0, {height}),
               record: (file: \"quake.csv\"))]),"
        )
    };
    let text = format!(
        "(title: \"ground\", time: (step_s: {step_s:e}, end_s: 1),
          materials: [(name: \"rock\", young_pa: {YOUNG_PA:e}, poisson: 0.25, density_kg_m3: {DENSITY})],
          blocks: [(name: \"ground\", material: \"rock\", shape: Box(size_m: ({size}, 1, {height}), cells: (20, 1, 10)))],
          supports: [(block: \"ground\", on: Set(\"y_min\"), hold: Normal2), (block: \"ground\", on: Set(\"y_max\"), hold: Normal2)],
          quiet: [{} {} {}])",
        side("z_min"),
        side("x_min"),
        side("x_max")
    )
    .replace("Normal2", "Direction((0, 1, 0))");
    let mut simulation = with_record(&text, &pulse(length_s));
    let origin = simulation.blocks().origin_m;
    let (mut worst, mut scattered) = (0.0f64, 0.0f64);
    simulation.sample().unwrap();
    for step in 1..=((length_s + 3.0 * height / c) / step_s) as u32 {
        simulation.step().unwrap();
        let t = f64::from(step) * step_s;
        for (v, x) in simulation.state().velocity.iter().zip(&simulation.blocks().rest_position) {
            let z = (x + origin).z;
            let exact =
                pulse_velocity(t - z / c, length_s) + pulse_velocity(t - (2.0 * height - z) / c, length_s);
            worst = worst.max((v - Vec3::new(exact, 0.0, 0.0)).norm());
        }
        scattered = scattered.max(simulation.sample().unwrap().radiated_j);
    }
    row("level ground", "largest error of any node over 2 v, quiet sides", worst / 0.2, AtMost(0.02));
    let brought = DENSITY * c * size * 0.05f64.powi(2) * 1.5 * length_s;
    row("level ground", "energy that is scattered over that which came", scattered / brought, AtMost(1e-3));
}
