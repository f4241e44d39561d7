//! Stages of construction: what is taken out springs back by one-dimensional theory, at once or without a blast, and the balance closes.

use ndda::Model;
use ndda::run::{Outcome, Run};
use ndda::summary::LabelWord;
use ndda_io::table::Table;

use crate::evidence::Answer::{AtMost, Near, Within};
use crate::evidence::row;

const YOUNG_PA: f64 = 1e9;
const DENSITY: f64 = 2500.0;
const GRAVITY: f64 = 10.0;
const PENALTY_PA: f64 = 2e10;
/// Weight of a block of 1 m³ [N].
const WEIGHT_N: f64 = DENSITY * GRAVITY;

/// Three blocks of 1 m³ on top of each other, with ν = 0 and no friction: bars in one dimension, with a spring of 2 k_n between each two.
fn column(stages: &str) -> Outcome {
    run(&column_text(stages))
}

fn column_text(stages: &str) -> String {
    format!(
        "(title: \"column\", time: (step_s: 1e-5, end_s: 1e-5), gravity_m_s2: (0, 0, -{GRAVITY}), settle: (tolerance: 1e-7),
          materials: [(name: \"rock\", young_pa: {YOUNG_PA:e}, poisson: 0, density_kg_m3: {DENSITY})],
          blocks: [{}],
          supports: [(block: \"*\", on: All, hold: Direction((1, 0, 0))), (block: \"*\", on: All, hold: Direction((0, 1, 0))),
                     (block: \"low\", on: Set(\"z_min\"), hold: Fixed)],
          contact: Potential(penalty_pa: {PENALTY_PA:e}, potential: Smooth(reference_m: 1)),
          monitors: [(name: \"mid\", block: \"mid\"), (name: \"tip\", block: \"mid\", at: Point((0.5, 0.5, 2)))],
          stages: [{stages}], output: (history_rows: 2000, frames: 0))",
        ["low", "mid", "top"].iter().enumerate().map(|(i, name)| format!(
            "(name: \"{name}\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (1, 1, 6)), at_m: (0, 0, {i})),"
        )).collect::<String>()
    )
}

fn run(text: &str) -> Outcome {
    let model = Model::from_text(text).unwrap_or_else(|errors| panic!("{}", errors.render(false)));
    Run::new(model).finish(&mut []).unwrap()
}

fn values<'a>(history: &'a Table, name: &str) -> &'a [f64] {
    &history.columns[history.names.iter().position(|known| known == name).unwrap()]
}

/// The value of the last row up to a time.
fn at(history: &Table, name: &str, time_s: f64) -> f64 {
    let last = values(history, "time_s").partition_point(|t| *t <= time_s + 1e-9) - 1;
    values(history, name)[last]
}

/// How far the centre of the middle block rises when the weight of the top goes: what it and the block below stretch by, and what the joint
/// between them opens by.
fn rise_m() -> f64 {
    1.5 * WEIGHT_N / YOUNG_PA + WEIGHT_N / (2.0 * PENALTY_PA)
}

/// The longest period of the two blocks that are left, a bar of 2 m held at its foot: 4 L/c.
fn period_s() -> f64 {
    4.0 * 2.0 / (YOUNG_PA / DENSITY).sqrt()
}

#[test]
fn a_block_that_is_taken_out_over_ten_periods_leaves_no_motion_behind() {
    let (over_s, end_s) = (10.0 * period_s(), 11.0 * period_s());
    let outcome =
        column(&format!("(name: \"take\", remove: [\"top\"], over_s: {over_s}, then: Run({end_s}))"));
    let history = outcome.history.unwrap();
    // The energy that the weight of the top had stored in the two blocks below: ½ ∫ (σ² − σ₁²)/E, σ₁ without it.
    let released_j = (WEIGHT_N * WEIGHT_N / (2.0 * YOUNG_PA)) * (2.0 + 2.0 * 2.0);
    let after = values(&history, "time_s").partition_point(|t| *t < 1e-5 + over_s);
    let kinetic_j = values(&history, "kinetic_j")[after..].iter().copied().fold(0.0, f64::max);
    row(
        "stages",
        "kinetic energy after a removal over ten periods, over the strain energy that it released",
        kinetic_j / released_j,
        AtMost(1e-4),
    );
    let risen_m = at(&history, "mid.displacement_z_m", 1.0);
    row("stages", "rise of a column whose top is removed [m]", risen_m, Within(rise_m(), 5e-3));
    let balance_j = values(&history, "balance_j").iter().map(|j| j.abs()).fold(0.0, f64::max);
    row(
        "stages",
        "balance of energy across a removal, over the energy that it released",
        balance_j / released_j,
        AtMost(1e-5),
    );
    // Its own strain, ½ ∫ σ²/E, and half the work of the joint under it.
    let top_j = WEIGHT_N * WEIGHT_N / (6.0 * YOUNG_PA) + 0.5 * WEIGHT_N * WEIGHT_N / (2.0 * PENALTY_PA);
    row(
        "stages",
        "energy of the removed block and its contact [J]",
        at(&history, "removed_j", 1.0),
        Within(top_j, 2e-2),
    );
    assert_eq!(outcome.summary.label.word, LabelWord::Accurate, "{:?}", outcome.summary.label.reasons);
}

#[test]
fn a_block_that_is_taken_out_at_once_lets_the_column_spring_to_twice_its_rise() {
    let end_s = 2.0 * period_s();
    let outcome = column(&format!("(name: \"take\", remove: [\"top\"], then: Run({end_s}))"));
    let history = outcome.history.unwrap();
    let tip = values(&history, "tip.displacement_z_m");
    let still_m = 2.0 * WEIGHT_N / YOUNG_PA + WEIGHT_N / (2.0 * PENALTY_PA);
    let (highest, largest_m) =
        (0..tip.len()).map(|i| (i, tip[i])).max_by(|a, b| a.1.total_cmp(&b.1)).unwrap();
    row(
        "stages",
        "largest rise of a column whose top goes at once [m]",
        largest_m,
        Within(2.0 * still_m, 5e-2),
    );
    // It is highest after half a period, or one and a half.
    let periods = (values(&history, "time_s")[highest] - 1e-5) / period_s();
    row("stages", "time of that, over the period 4 L/c", periods % 1.0, Near(0.5, 3e-2));
}

/// A quiet foot rests on springs of ρ c/2Δt per area while the scene settles, and what they bear then stays.
#[test]
fn a_column_on_a_quiet_foot_comes_to_rest_in_a_stage_and_stays_there() {
    let stages = "(name: \"take\", remove: [\"top\"], over_s: 1e-3, then: Settle(tolerance: 1e-9)), (name: \"stay\", then: Run(0.05))";
    let held = "(block: \"low\", on: Set(\"z_min\"), hold: Fixed)],";
    let text = column_text(stages).replace(held, "], quiet: [(block: \"low\", on: Set(\"z_min\"))],");
    let outcome = run(&text);
    let history = outcome.history.as_ref().unwrap();
    let (rest_s, end_s) = (1e-5 + 1e-3, 1e-5 + 1e-3 + 0.05);
    let foot_m = WEIGHT_N * 2e-5 / (DENSITY * (YOUNG_PA / DENSITY).sqrt());
    let risen_m = at(history, "mid.displacement_z_m", rest_s);
    row(
        "stages",
        "rise of a column on a quiet foot whose top is removed, at rest [m]",
        risen_m,
        Within(rise_m() + foot_m, 5e-3),
    );
    let drift_m = (at(history, "mid.displacement_z_m", end_s) - risen_m).abs();
    // It settled to 1e-9 of its largest speed, that of its rise, and of the loads on it: a thousand times that part.
    row("stages", "drift of it in the time after [m]", drift_m, AtMost(1e-6 * rise_m()));
    let balance_j = at(history, "balance_j", end_s).abs();
    let released_j = (WEIGHT_N * WEIGHT_N / (2.0 * YOUNG_PA)) * (2.0 + 2.0 * 2.0);
    row(
        "stages",
        "balance of energy of it, over the energy that the removal released",
        balance_j / released_j,
        // (Δt/T)²/12 of the work of forces that fade over T, by the trapezoidal rule; a fade whose ends are flat is off by less.
        AtMost((1e-5f64 / 1e-3).powi(2) / 12.0),
    );
    assert_eq!(outcome.summary.label.word, LabelWord::Accurate, "{:?}", outcome.summary.label.reasons);
}

/// Slip of a block of 1.5 m³ on a fixed one, over what the springs of the joint stretch by. It is pushed along by 0.7 of the friction that it has once
/// a block like it is taken from on top of it, within one period of its own on the contact.
fn slip_of_pushed_block(ramp: &str) -> (f64, Outcome) {
    let (weight_n, shear_pa_m) = (1.5 * WEIGHT_N, 1e10);
    let push_n = 0.7 * f64::tan(30f64.to_radians()) * weight_n;
    // 1250 kg on springs of 2 k_n for each square metre.
    let over_s = std::f64::consts::TAU * (0.5 * DENSITY / (2.0 * PENALTY_PA)).sqrt();
    let rigid = |name: &str, body: &str, z: f64| {
        format!(
            "(name: \"{name}\", material: \"rock\", body: {body}, shape: Box(size_m: (3, 1, 0.5), cells: (1, 1, 1)), at_m: (0, 0, {z})),"
        )
    };
    let outcome = run(&format!(
        "(title: \"pushed\", time: (step_s: 1e-5, end_s: 1e-5), gravity_m_s2: (0, 0, -{GRAVITY}), settle: (tolerance: 1e-6),
          materials: [(name: \"rock\", young_pa: {YOUNG_PA:e}, poisson: 0, density_kg_m3: {DENSITY})],
          blocks: [{} {} {}],
          contact: Potential(penalty_pa: {PENALTY_PA:e}, potential: Smooth(reference_m: 1), friction: (friction_deg: 30, shear_penalty_pa_m: {shear_pa_m:e})),
          forces: [(block: \"mid\", force_n: ({push_n}, 0, 0))], monitors: [(name: \"mid\", block: \"mid\")],
          stages: [(name: \"take\", remove: [\"top\"], over_s: {over_s}, reset_displacements: true, then: Settle(tolerance: 1e-7, ramp: {ramp}))],
          output: (frames: 0))",
        rigid("low", "Fixed", 0.0),
        rigid("mid", "Rigid", 0.5),
        rigid("top", "Rigid", 1.0),
    ));
    (outcome.monitor("mid").unwrap().displacement[0] / (push_n / (3.0 * shear_pa_m)), outcome)
}

#[test]
fn a_damped_ramp_does_not_let_a_joint_slip_that_a_slow_one_would_hold() {
    let (held, outcome) = slip_of_pushed_block("Damped");
    // Facets at the rim, where pressure is least, give way to their neighbours.
    row(
        "stages",
        "slip of a joint that is unloaded over a damped ramp, over the stretch of its springs",
        held.abs(),
        AtMost(1e-3),
    );
    let history = outcome.history.as_ref().unwrap();
    let end_s = outcome.summary.stages[0].end_s;
    assert_eq!(*values(history, "time_s").last().unwrap(), end_s);
    row(
        "stages",
        "balance of energy across a damped ramp, over the energy that the removal released",
        at(history, "balance_j", end_s).abs() / (1.5 * WEIGHT_N * 0.5 * WEIGHT_N / (2.0 * PENALTY_PA)),
        // All work but that of friction, loads and motions is booked as damping: only rounding is left.
        AtMost(1e-9),
    );
    assert_eq!(outcome.summary.label.word, LabelWord::Accurate, "{:?}", outcome.summary.label.reasons);
    // Where motion is not damped, pressure falls below what it is at rest, and the joint slips.
    let (slipped, _) = slip_of_pushed_block("Dynamic");
    assert!(slipped > 0.02, "{slipped:e}");
}

#[test]
fn a_prop_that_is_taken_away_over_ten_periods_leaves_no_motion_behind() {
    // A bar of 1 m between two supports, each of which bears half of its weight; ten periods 4 L/c.
    let over_s = 10.0 * 4.0 / (YOUNG_PA / DENSITY).sqrt();
    let held = |set: &str| format!("(block: \"bar\", on: Set(\"{set}\"), hold: Direction((0, 0, 1))),");
    let sideways = "(block: \"bar\", on: All, hold: Direction((1, 0, 0))), (block: \"bar\", on: All, hold: Direction((0, 1, 0))),";
    let (foot, head) = (held("z_min"), held("z_max"));
    let outcome = run(&format!(
        "(title: \"prop\", time: (step_s: 2e-5, end_s: 2e-5), gravity_m_s2: (0, 0, -{GRAVITY}), settle: (tolerance: 1e-7), contact: Off,
          materials: [(name: \"rock\", young_pa: {YOUNG_PA:e}, poisson: 0, density_kg_m3: {DENSITY})],
          blocks: [(name: \"bar\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (1, 1, 6)))],
          supports: [{sideways} {foot} {head}],
          stages: [(name: \"take\", supports: [{sideways} {foot}], over_s: {over_s}, then: Run({}))],
          monitors: [(name: \"head\", block: \"bar\", at: Point((0.5, 0.5, 1)))], output: (history_rows: 500, frames: 0))",
        1.1 * over_s
    ));
    let history = outcome.history.as_ref().unwrap();
    let sunk_m = outcome.monitor("head").unwrap().displacement[2];
    row(
        "stages",
        "sinking of a bar whose upper support is taken away [m]",
        sunk_m,
        Within(-0.5 * WEIGHT_N / YOUNG_PA, 5e-3),
    );
    let released_j = 0.5 * (0.5 * WEIGHT_N) * (0.5 * WEIGHT_N) / YOUNG_PA;
    let after = values(history, "time_s").partition_point(|t| *t < 2e-5 + over_s);
    let kinetic_j = values(history, "kinetic_j")[after..].iter().copied().fold(0.0, f64::max);
    row(
        "stages",
        "kinetic energy after a support has been taken away over ten periods, over the work that it released",
        kinetic_j / released_j,
        AtMost(1e-4),
    );
}

#[test]
fn a_block_that_is_put_back_brings_the_column_to_where_it_was() {
    let outcome = column(
        "(name: \"take\", remove: [\"top\"], over_s: 0.05, then: Settle(tolerance: 1e-5)),
         (name: \"rest\", reset_displacements: true, then: Settle(tolerance: 1e-5)),
         (name: \"back\", add: [\"top\"], over_s: 0.05, then: Settle(tolerance: 1e-5))",
    );
    let ends: Vec<_> =
        outcome.summary.stages.iter().map(|stage| (stage.name.as_str(), stage.blocks)).collect();
    assert_eq!(ends, [("take", 2), ("rest", 2), ("back", 3)]);
    assert!(outcome.summary.stages.iter().all(|stage| stage.settling_steps > 0));
    let history = outcome.history.as_ref().unwrap();
    let risen_m = at(history, "mid.displacement_z_m", outcome.summary.stages[0].end_s);
    row("stages", "rise to rest of a column whose top is removed [m]", risen_m, Within(rise_m(), 5e-3));
    let sunk_m = outcome.monitor("mid").unwrap().displacement[2];
    row(
        "stages",
        "sinking of the column when the block is put back, counted from before [m]",
        sunk_m,
        Within(-rise_m(), 5e-3),
    );
    let largest_j = values(history, "strain_j").iter().copied().fold(0.0, f64::max);
    let balance_j = values(history, "balance_j").iter().map(|j| j.abs()).fold(0.0, f64::max);
    row(
        "stages",
        "balance of energy through stages that come to rest, over the largest energy",
        balance_j / largest_j,
        AtMost(1e-3),
    );
}

/// Two blocks that slide on a floor, and a third that is not there until the end.
fn sliding(third: &str, add: &str) -> Outcome {
    run(&format!(
        "(title: \"sliding\", time: (step_s: 1e-4, end_s: 1e-3), gravity_m_s2: (2, 0, -9.81),
          materials: [(name: \"rock\", young_pa: 1e9, poisson: 0.2, density_kg_m3: 2600)],
          blocks: [(name: \"floor\", material: \"rock\", body: Fixed, shape: Box(size_m: (9, 3, 1), cells: (1, 1, 1)), at_m: (-1, -1, -1)),
                   (name: \"one\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (2, 2, 2))),
                   (name: \"two\", material: \"rock\", body: Rigid, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), at_m: (1.0001, 0, 0)), {third}],
          contact: Potential(penalty_pa: 1e9, friction: (friction_deg: 10)),
          monitors: [(name: \"one\", block: \"one\"), (name: \"two\", block: \"two\")],
          stages: [(name: \"go\", then: Run(0.03)), (name: \"end\", {add} then: Run(1e-4))],
          output: (history_rows: 100, frames: 0))"
    ))
}

#[test]
fn a_block_that_is_not_there_changes_no_bit_of_the_others_and_is_never_looked_at() {
    let third = "(name: \"three\", material: \"rock\", shape: Box(size_m: (1.5, 0.5, 0.7), cells: (2, 1, 1)), at_m: (0.3, 0.2, 0.4)),";
    let [without, with] = [sliding("", ""), sliding(third, "add: [\"three\"],")];
    let [alone, beside] = [&without, &with].map(|outcome| outcome.history.as_ref().unwrap());
    let until = values(alone, "time_s").partition_point(|t| *t < 0.0310005);
    assert!(until > 90);
    for name in alone.names.iter().filter(|name| !name.starts_with("angular")) {
        let bits = |table| values(table, name)[..until].iter().map(|x| x.to_bits()).collect::<Vec<_>>();
        assert!(bits(alone) == bits(beside), "{name}");
    }
    assert_eq!(without.summary.stages[0], with.summary.stages[0]);
}

#[test]
fn rock_with_an_excavation_drawn_in_it_is_as_stiff_as_without_until_it_is_dug() {
    let strain_j = |excavation: &str, stages: &str| {
        let outcome = run(&format!(
            "(title: \"pillar\", time: (step_s: 1e-5, end_s: 1e-4), gravity_m_s2: (0, 0, -10), settle: (tolerance: 1e-4),
              materials: [(name: \"rock\", young_pa: 1e9, poisson: 0, density_kg_m3: 2500)],
              rock: [(name: \"rock\", material: \"rock\", fill: Size(size_m: 0.5), domain: Box(min_m: (0, 0, 0), max_m: (1, 1, 3)), {excavation})],
              supports: [(block: \"*\", on: Set(\"z_min\"), hold: Fixed)],
              contact: Potential(penalty_pa: 1e10), {stages} output: (frames: 0))"
        ));
        (at(outcome.history.as_ref().unwrap(), "strain_j", 1e-4), outcome.summary)
    };
    let drawn = "excavations: [(name: \"dug\", axis: Y, outline_m: [(0, 2), (1, 2), (1, 3), (0, 3)], start_m: 0, end_m: 1)]";
    let stage =
        "stages: [(name: \"dig\", remove: [\"dug_*\"], over_s: 0.05, then: Settle(tolerance: 1e-3))],";
    let ((whole_j, _), (glued_j, summary)) = (strain_j("", ""), strain_j(drawn, stage));
    row(
        "stages",
        "strain energy of rock with a glued cut across it, over that without",
        glued_j / whole_j,
        Near(1.0, 2e-2),
    );
    let names: Vec<&str> = summary.blocks.0.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["rock_0001", "dug_0001"]);
    assert_eq!(summary.stages[0].blocks, 1);
}

/// Slide of the dam in so many seconds from 18 m of water on, which rises to 20 m in the first: loads change by 3 u² − 2 u³ in time, and the dam
/// moves by what exceeds friction, found by small steps of Newton's law.
fn slide_m(time_s: f64) -> f64 {
    let (water, width_m, mu) = (1000.0 * 9.81, 16.0, 35f64.to_radians().tan());
    let mass_kg = 2400.0 * 176.0;
    let (push_n, uplift_n) = (|h: f64| 0.5 * water * h * h, |h: f64| 0.5 * water * h * width_m);
    let (mut x_m, mut v_m_s) = (0.0, 0.0f64);
    let steps = 100_000;
    let dt_s = time_s / f64::from(steps);
    for step in 0..steps {
        let u = ((f64::from(step) + 0.5) * dt_s).min(1.0);
        let part = u * u * (3.0 - 2.0 * u);
        let between = |f: &dyn Fn(f64) -> f64| f(18.0) + part * (f(20.0) - f(18.0));
        let excess_n = between(&push_n) - mu * (9.81 * mass_kg - between(&uplift_n));
        v_m_s = (v_m_s + dt_s * excess_n / mass_kg).max(0.0);
        x_m += dt_s * v_m_s;
    }
    x_m
}

#[test]
fn a_dam_stands_and_slides_at_the_levels_of_limit_equilibrium() {
    let file = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/works/dam_impounding.ron");
    let model = Model::open(&file, &["output.frames=0".into()]).unwrap();
    let outcome = Run::new(model).finish(&mut []).unwrap();
    let [low, middle, high] = [0, 1, 2].map(|k| outcome.summary.stages[k].motion.clone());
    // F = 4.80 and 1.203; the dam leans by less than a millimetre.
    row("stages", "motion of a dam with 10 m of water [m]", low.farthest_m, AtMost(1e-3));
    row("stages", "motion of a dam with 18 m of water [m]", middle.farthest_m, AtMost(1e-3));
    row(
        "stages",
        "slide of a dam with 20 m of water, 1.4 s after it began to rise from 18 m [m]",
        high.farthest_m,
        Within(slide_m(1.4), 3e-2),
    );
    assert_eq!(outcome.summary.label.word, LabelWord::Accurate, "{:?}", outcome.summary.label.reasons);
}

#[test]
fn stages_that_cannot_be_are_refused_with_what_to_change() {
    let with = |stages: &str| {
        let text = format!(
            "(title: \"x\", time: (step_s: 1e-3, end_s: 0.01), materials: [(name: \"rock\", young_pa: 1e9, poisson: 0.2, density_kg_m3: 2600)],
              blocks: [(name: \"a\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1))),
                       (name: \"b\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), at_m: (0, 0, 1))],
              contact: Potential(penalty_pa: 1e9), stages: [{stages}])"
        );
        Model::from_text(&text).err().expect("it is refused").render(false)
    };
    for (stages, expected) in [
        ("(name: \"s\", remove: [\"c\"], then: Run(1))", "there is no block `c`"),
        ("(name: \"s\", remove: [\"c*\"], then: Run(1))", "no block is named `c*`"),
        (
            "(name: \"s\", remove: [\"a\"], then: Run(1)), (name: \"t\", remove: [\"a\"], then: Run(1))",
            "block `a` is not there",
        ),
        (
            "(name: \"s\", remove: [\"a\"], then: Run(1)), (name: \"t\", remove: [\"a*\"], then: Run(1))",
            "all blocks `a*` are not there",
        ),
        ("(name: \"s\", remove: [\"a\"], add: [\"a\"], then: Run(1))", "add it in a later one"),
        ("(name: \"s\", remove: [\"a\"], then: Run(1)), (name: \"s\", then: Run(1))", "is used twice"),
        ("(name: \"s\", over_s: 2, then: Run(1))", "are longer than the stage"),
        ("(name: \"s\", then: Run(-1))", "must be positive"),
        ("(name: \"s\", then: Settle(tolerance: 2))", "must be between 0 and 1"),
        (
            "(name: \"s\", supports: [(block: \"d\", on: All, hold: Fixed)], then: Run(1))",
            "stages[0].supports[0].block",
        ),
        (
            "(name: \"s\", supports: [(block: \"a\", on: Set(\"far\"), hold: Fixed)], then: Run(1))",
            "has no set `far`",
        ),
        (
            "(name: \"s\", supports: [(block: \"a\", on: All, hold: Fixed, by: Springs())], then: Run(1))",
            "cannot begin with a stage",
        ),
        ("(name: \"s\", laws: (friction: (friction_deg: 100)), then: Run(1))", "stages[0].laws.friction"),
    ] {
        let found = with(stages);
        assert!(found.contains(expected), "{stages}:\n{found}");
    }
}
