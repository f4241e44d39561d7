//! Level ground of two layers on rock between quiet sides in the free field, against the closed form of waves that go straight up and down in it: soil on rock
//! amplifies what arrives, and a model that is cut out of it has to move as all of it.

use std::f64::consts::{PI, TAU};

use crate::evidence::Answer::AtMost;
use crate::evidence::row;
use crate::quiet::with_record;

/// Name, height of the upper border [m], Young's modulus [Pa] at ν = ¼, density, and cells of a layer, from the rock on.
const LAYERS: [(&str, f64, f64, f64, u32); 3] =
    [("rock", 4.0, 4.8e9, 2400.0, 4), ("sand", 12.0, 0.7e9, 2000.0, 10), ("clay", 18.0, 0.12e9, 1800.0, 12)];
/// Width of the model [m].
const WIDTH_M: f64 = 6.0;
/// Frequency of most energy of the wave, a wavelet after Ricker, its largest acceleration, and when that arrives at the foot.
const HZ: f64 = 3.5;
const LARGEST_M_S2: f64 = 1.0;
const ARRIVES_S: f64 = 0.5;
const END_S: f64 = 2.2;

/// ρ c [Pa s/m] and c [m/s] of S waves.
fn of_layer(layer: usize) -> (f64, f64) {
    let (_, _, young_pa, density, _) = LAYERS[layer];
    let c = (0.4 * young_pa / density).sqrt();
    (density * c, c)
}

/// a (1 − 2 x²) e^{−x²} with x = π f (t − t₀), whose displacement is −a/(2 π² f²) e^{−x²}.
fn acceleration(t: f64) -> f64 {
    let square = (PI * HZ * (t - ARRIVES_S)).powi(2);
    LARGEST_M_S2 * (1.0 - 2.0 * square) * (-square).exp()
}

/// Displacement of the ground at a time [m]: the spectrum of the wave's displacement times the ratio of the ground's to it (Haskell 1953; Kramer 1996).
fn ground_m(t: f64) -> f64 {
    let amplitude_m = -LARGEST_M_S2 / (2.0 * (PI * HZ).powi(2));
    // Of a Gaussian e^{−π² f² t²}: e^{−ω²/4π²f²}/(√π f); past 6 f nothing is left. Steps of ω repeat the motion after 2π/Δω.
    let step = TAU / 40.0;
    let count = (6.0 * TAU * HZ / step) as u32;
    let part = |k: u32| {
        let w = step * f64::from(k);
        let spectrum = (-(w / (TAU * HZ)).powi(2)).exp() / (PI.sqrt() * HZ);
        let (size, phase) = ratio(w);
        let half = if k == 0 { 0.5 } else { 1.0 };
        half * spectrum * size * (w * (t - ARRIVES_S) + phase).cos()
    };
    amplitude_m * (0..count).map(part).sum::<f64>() * step / PI
}

/// Ratio of the ground's displacement to that of the wave where it arrives, and its phase.
fn ratio(w: f64) -> (f64, f64) {
    let bottom = |layer: usize| if layer == 0 { 0.0 } else { LAYERS[layer - 1].1 };
    // Displacement, and stress over z ω of the layer, both over the displacement of the ground.
    let (mut u, mut s) = (1.0, 0.0);
    for layer in [2, 1] {
        let (z, c) = of_layer(layer);
        let a = w * (LAYERS[layer].1 - bottom(layer)) / c;
        (u, s) = (u * a.cos() - s * a.sin(), u * a.sin() + s * a.cos());
        s *= z / of_layer(layer - 1).0;
    }
    // At the rock's upper border the wave up is ½ (u + i s); it has left the foot earlier.
    let travel_s = LAYERS[0].1 / of_layer(0).1;
    (2.0 / u.hypot(s), -s.atan2(u) - w * travel_s)
}

/// The scene: a block to each layer, glued, quiet at the foot and both sides.
fn scene(step_s: f64) -> String {
    let (mut materials, mut blocks, mut layers, mut bottom_m) =
        (String::new(), String::new(), String::new(), 0.0);
    for (name, top_m, young_pa, density, cells) in LAYERS {
        materials +=
            &format!("(name: \"{name}\", young_pa: {young_pa:e}, poisson: 0.25, density_kg_m3: {density}),");
        blocks += &format!(
            "(name: \"{name}\", material: \"{name}\", at_m: (0, 0, {bottom_m}), shape: Box(size_m: ({WIDTH_M}, 1, {}), cells: (4, 1, {cells}))),",
            top_m - bottom_m
        );
        layers += &format!("(material: \"{name}\", top_m: (0, 0, {top_m})),");
        bottom_m = top_m;
    }
    let wave = "incident: [(wave: S((1, 0, 0)), record: (file: \"quake.csv\"), from_m: (0, 0, 0))]";
    let side = |set: &str| format!("(block: \"*\", on: Set(\"{set}\"), layers: [{layers}], {wave}),");
    format!(
        "(title: \"layers\", time: (step_s: {step_s:e}, end_s: {END_S}), materials: [{materials}], blocks: [{blocks}],
          supports: [(block: \"*\", on: Set(\"y_min\"), hold: Direction((0, 1, 0))), (block: \"*\", on: Set(\"y_max\"), hold: Direction((0, 1, 0)))],
          quiet: [(block: \"rock\", on: Set(\"z_min\"), {wave}), {} {}],
          contact: Potential(penalty_pa: 5e9, potential: Smooth(),
                             friction: (friction_deg: 40, shear_penalty_pa_m: 1e10, cohesion_pa: 1e9, tension_pa: 1e9)))",
        side("x_min"),
        side("x_max")
    )
}

#[test]
fn layered_ground_between_free_field_sides_moves_as_the_closed_form_says() {
    let step_s = 1e-4;
    let rows: Vec<(f64, f64)> =
        (0..=1000).map(|k| 1e-3 * f64::from(k)).map(|t| (t, acceleration(t))).collect();
    let mut simulation = with_record(&scene(step_s), &rows);
    let (origin, top_m) = (simulation.blocks().origin_m, LAYERS[2].1);
    let level: Vec<usize> = (0..simulation.blocks().rest_position.len())
        .filter(|&n| ((simulation.blocks().rest_position[n] + origin).z - top_m).abs() < 1e-6)
        .collect();
    let (mut largest, mut worst, mut spread, mut rise) = (0.0f64, 0.0f64, 0.0f64, 0.0f64);
    for step in 1..=(END_S / step_s).round() as u32 {
        simulation.step().unwrap();
        if step % 20 != 0 {
            continue;
        }
        let exact = ground_m(f64::from(step) * step_s);
        let moved = |n: &usize| simulation.state().position[*n] - simulation.blocks().rest_position[*n];
        let (low, high) = level.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), n| {
            rise = rise.max(moved(n).z.abs());
            (low.min(moved(n).x), high.max(moved(n).x))
        });
        largest = largest.max(exact.abs());
        worst = worst.max((low - exact).abs()).max((high - exact).abs());
        spread = spread.max(high - low);
    }
    let wave_m = LARGEST_M_S2 / (2.0 * (PI * HZ).powi(2));
    assert!(largest > 2.5 * wave_m, "soil amplifies: {largest} for {wave_m}");
    let case = "layered ground";
    row(
        case,
        "largest error of the ground's motion over its largest, sides in the free field",
        worst / largest,
        AtMost(0.01),
    );
    row(
        case,
        "largest difference of motion along the ground over the largest motion",
        spread / largest,
        AtMost(0.02),
    );
    row(case, "largest rise of the ground over its largest motion", rise / largest, AtMost(0.01));
}
