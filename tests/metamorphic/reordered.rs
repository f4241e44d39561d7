//! Sums over blocks do not depend on the order in which a scene lists them: `history.csv` has the same bits.
//!
//! Forces on one block are added in the order of its neighbours, so that this holds where no block touches several at a time; `renumbered.rs` bounds what is left
//! elsewhere.

use ndda::run::Sensitivity;
use ndda::{Model, Run};

/// Numbers of a history by column, and the error terms of the run.
type Ended = (Vec<(String, Vec<u64>)>, [u64; 4]);

/// A scene with these blocks, in their order or the opposite one.
fn ended((blocks, rest): (&[String], &str), is_reversed: bool) -> Ended {
    let mut list = blocks.to_vec();
    if is_reversed {
        list.reverse();
    }
    let monitors: String = (0..blocks.len()).map(|k| format!("(name: \"m{k}\", block: \"b{k}\"),")).collect();
    let text = format!(
        "(title: \"Blocks in any order\", {rest}
        materials: [(name: \"rock\", young_pa: 2e9, poisson: 0.25, density_kg_m3: 2650)],
        blocks: [{}], monitors: [{monitors}], output: (frames: 0, history_rows: 40))",
        list.concat()
    );
    let model = Model::from_text(&text).unwrap_or_else(|errors| panic!("{}", errors.render(false)));
    let outcome = Run::new(model).sensitivity(Sensitivity::Never).finish(&mut []).expect("it runs");
    let history = outcome.history.expect("it is in memory");
    let columns = history.columns.iter().map(|column| column.iter().map(|x| x.to_bits()).collect());
    let worst = &outcome.summary.invariants;
    let errors = [worst.linear_momentum, worst.angular_momentum, worst.energy_gain, worst.energy_loss];
    (history.names.iter().cloned().zip(columns).collect(), errors.map(f64::to_bits))
}

/// Checks a scene and its twin; whether blocks touched in it.
fn same(blocks: &[String], rest: &str) -> bool {
    let ((listed, errors), (reversed, also)) = (ended((blocks, rest), false), ended((blocks, rest), true));
    assert!(listed.len() > 10 && listed[0].1.len() > 10, "{rest}");
    for ((name, values), (other, twins)) in listed.iter().zip(&reversed) {
        assert_eq!(name, other);
        let numbers = |bits: &[u64]| bits.iter().map(|bits| f64::from_bits(*bits)).collect::<Vec<_>>();
        assert!(values == twins, "{name}: {:?} against {:?}: {rest}", numbers(values), numbers(twins));
    }
    assert_eq!(errors, also, "{rest}");
    let contact = listed.iter().find(|(name, _)| name == "contact_j").expect("a column of its energy");
    contact.1.iter().any(|bits| f64::from_bits(*bits) > 0.0)
}

/// A box of its own size and motion; `k` counts.
fn block(k: u32, body: &str, at_m: [f64; 3], velocity_m_s: [f64; 3]) -> String {
    let t = f64::from(k);
    format!(
        "(name: \"b{k}\", material: \"rock\", body: {body}, shape: Box(size_m: ({}, {}, {}), cells: (2, 1, 1)), at_m: {:?}, \
         velocity_m_s: {:?}, spin_rad_s: ({}, 0.7, {})),",
        1.0 + 0.0371 * t,
        0.9 - 0.0113 * t,
        0.8 + 0.0079 * t * t,
        (at_m[0], at_m[1], at_m[2]),
        (velocity_m_s[0], velocity_m_s[1], velocity_m_s[2]),
        0.31 * t - 1.0,
        1.0 / (1.0 + t),
    )
}

const BODIES: [&str; 3] = ["Elastic", "Affine", "Rigid"];
const STEPS: &str = "step_s: 5e-4, end_s: 0.06";

#[test]
fn blocks_that_do_not_touch_have_one_history_in_any_order() {
    let blocks: Vec<String> = (0..11)
        .map(|k| {
            let t = f64::from(k);
            block(
                k,
                BODIES[k as usize % 3],
                [2.5 * t, 0.137 * t * t, -0.3 * t],
                [0.1 * t, 0.37 - t, 0.01 * t],
            )
        })
        .collect();
    for time in [
        STEPS,
        "step_s: 5e-4, end_s: 0.06, integrator: Newmark(alpha: 0.25, delta: 0.5)",
        "step_s: 5e-4, end_s: 0.06, integrator: GeneralizedAlpha(radius: 0.7)",
        "step_s: 2e-3, end_s: 0.06, step: Auto()",
    ] {
        let rest =
            format!("time: ({time}), gravity_m_s2: (0.3, 0, -9.81), contact: Potential(penalty_pa: 2e8),");
        assert!(!same(&blocks, &rest), "blocks touch: {rest}");
    }
}

#[test]
fn pairs_of_blocks_that_collide_and_slide_have_one_history_in_any_order() {
    for body in BODIES {
        // Pairs are far from each other, and each is listed with others in between.
        let pairs = 4;
        let place = |k: u32| [7.0 * f64::from(k % pairs), 0.11 * f64::from(k), 0.9 * f64::from(k / pairs)];
        let speed = |k: u32| [0.2, 0.0, 1.0 - 2.3 * f64::from(k / pairs)];
        let blocks: Vec<String> = (0..2 * pairs).map(|k| block(k, body, place(k), speed(k))).collect();
        let springs = "friction: (friction_deg: 30, shear_penalty_pa_m: 2e8)";
        for (time, contact) in [
            (STEPS, "potential: Element".to_string()),
            (STEPS, format!("potential: Element, {springs}")),
            (STEPS, format!("potential: Smooth(), {springs}")),
            (
                "step_s: 1e-3, end_s: 0.06, integrator: Newmark(alpha: 0.5, delta: 1.0), contact_at: End()",
                "potential: Smooth()".into(),
            ),
        ] {
            let rest = format!(
                "time: ({time}), gravity_m_s2: (0, 0, -1), contact: Potential(penalty_pa: 2e8, {contact}),"
            );
            assert!(same(&blocks, &rest), "no blocks touch: {rest}");
        }
    }
}
