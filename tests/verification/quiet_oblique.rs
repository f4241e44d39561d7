//! What a quiet face sends back of waves that meet it at an angle: by its closed form, and by a strip of rock.

use std::f64::consts::TAU;

use nalgebra::{Complex, DMatrix, DVector};

use crate::evidence::Answer::Within;
use crate::evidence::row;
use crate::quiet::{DENSITY, YOUNG_PA, speeds, with_record};

type Vector = [Complex<f64>; 2];

/// Slowness k/ω and motion of a wave in the plane (x, z) by its horizontal slowness: P or S, up or down.
fn wave(p: f64, is_p: bool, up: bool) -> (Vector, Vector) {
    let c = if is_p { speeds().0 } else { speeds().1 };
    // Beyond the critical angle it decays away from the face at z = 0, for exp(iω(t − s·x)) and z > 0.
    let vertical = Complex::new(1.0 / (c * c) - p * p, 0.0).sqrt();
    let vertical = if vertical.im > 0.0 { -vertical } else { vertical };
    let s = [Complex::new(p, 0.0), if up { vertical } else { -vertical }];
    let d = if is_p { s } else { [-s[1], s[0]] };
    (s, d.map(|x| x * c))
}

/// Amplitudes of the P and S waves that a quiet face at z = 0 sends up where a P or S wave of amplitude 1 and horizontal slowness `p` comes down: the sum of
/// −σ·n-tractions and Z v of the wave and of those that go up is nothing.
fn sent_up(p: f64, is_p: bool) -> [Complex<f64>; 2] {
    let (cp, cs) = speeds();
    let (mu, lambda) = (DENSITY * cs * cs, DENSITY * (cp * cp - 2.0 * cs * cs));
    // n = −z: σ·n = −(…)(λ (s·d) n + μ ((s·n) d + (d·n) s)), and the face bears −Z v.
    let misfit = |(s, d): &(Vector, Vector)| -> Vector {
        let along = s[0] * d[0] + s[1] * d[1];
        let sigma = [-(-(s[1] * d[0] + d[1] * s[0]) * mu), -(-along * lambda - s[1] * d[1] * (2.0 * mu))];
        [sigma[0] + d[0] * (DENSITY * cs), sigma[1] + d[1] * (DENSITY * cp)]
    };
    let given = misfit(&wave(p, is_p, false));
    let (a, b) = (misfit(&wave(p, true, true)), misfit(&wave(p, false, true)));
    let determinant = a[0] * b[1] - a[1] * b[0];
    [(-given[0] * b[1] + given[1] * b[0]) / determinant, (-a[0] * given[1] + a[1] * given[0]) / determinant]
}

/// Vertical flux of energy over ρ, c² Re(s_z) |a|².
fn flux(p: f64, is_p: bool, amplitude: Complex<f64>) -> f64 {
    let c = if is_p { speeds().0 } else { speeds().1 };
    c * c * wave(p, is_p, true).0[1].re * amplitude.norm_sqr()
}

/// Energy of a P or S wave at an angle from the normal that a quiet face sends back.
fn sent_back(is_p: bool, angle_deg: f64) -> f64 {
    let p = angle_deg.to_radians().sin() / if is_p { speeds().0 } else { speeds().1 };
    let [up_p, up_s] = sent_up(p, is_p);
    (flux(p, true, up_p) + flux(p, false, up_s)) / flux(p, is_p, Complex::new(1.0, 0.0))
}

/// Energy that goes up over that which would by [`sent_up`], where a wave at an angle comes down in a strip of rock that repeats itself: `cells` of 1 m wide, as
/// long as the wave is along the face. The quiet upper end sends some waves down again, of the other kind, too: they count with what came.
fn measured(is_p: bool, angle_deg: f64, cells: u32, height: u32) -> f64 {
    let c = if is_p { speeds().0 } else { speeds().1 };
    let (sine, cosine) = angle_deg.to_radians().sin_cos();
    let kind = if is_p { "P".to_string() } else { format!("S(({cosine}, 0, {sine}))") };
    let width = f64::from(cells);
    let period_s = width * sine / c;
    let omega = TAU / period_s;
    let steps_a_period = 60;
    let step_s = period_s / f64::from(steps_a_period);
    let grown = |t: f64| (t / (3.0 * period_s)).min(1.0);
    let rows: Vec<(f64, f64)> = (0..=3000)
        .map(|k| f64::from(k) / 100.0 * period_s)
        .map(|t| (t, omega * (omega * t).cos() * grown(t)))
        .collect();
    let text = format!(
        "(title: \"strip\", time: (step_s: {step_s:e}, end_s: 1),
          materials: [(name: \"rock\", young_pa: {YOUNG_PA:e}, poisson: 0.25, density_kg_m3: {DENSITY})],
          blocks: [(name: \"strip\", material: \"rock\", shape: Box(size_m: ({width}, 1, {height}), cells: ({cells}, 1, {height})))],
          supports: [(block: \"strip\", on: Set(\"y_min\"), hold: Direction((0, 1, 0))), (block: \"strip\", on: Set(\"y_max\"), hold: Direction((0, 1, 0)))],
          ties: [(block: \"strip\", on: [Set(\"x_min\"), Set(\"x_max\")])],
          quiet: [(block: \"strip\", on: Set(\"z_min\")),
                  (block: \"strip\", on: Set(\"z_max\"), incident: [(wave: {kind}, along: ({sine}, 0, -{cosine}), record: (file: \"quake.csv\"))])])"
    );
    let mut simulation = with_record(&text, &rows);
    for _ in 0..(20 * steps_a_period) {
        simulation.step().unwrap();
    }
    let origin = simulation.blocks().origin_m;
    let places: Vec<_> = simulation.blocks().rest_position.iter().map(|x| x + origin).collect();
    let middle = |n: &usize| {
        places[*n].y < 0.5
            && places[*n].x < width - 0.5
            && (5.0..f64::from(height) - 4.5).contains(&places[*n].z)
    };
    let nodes: Vec<usize> = (0..places.len()).filter(middle).collect();
    let mut found = vec![[Complex::new(0.0, 0.0); 2]; nodes.len()];
    for k in 0..steps_a_period {
        simulation.step().unwrap();
        let turn = Complex::from_polar(1.0, -TAU * f64::from(k) / f64::from(steps_a_period));
        for (sum, n) in found.iter_mut().zip(&nodes) {
            let v = simulation.state().velocity[*n];
            *sum = [sum[0] + turn * v.x, sum[1] + turn * v.z];
        }
    }
    // Down as it came, up P, up S, and the other one down.
    let p = sine / c;
    let waves = [wave(p, is_p, false), wave(p, true, true), wave(p, false, true), wave(p, !is_p, false)];
    let matrix = DMatrix::from_fn(2 * nodes.len(), 4, |i, k| {
        let (x, (s, d)) = (places[nodes[i / 2]], &waves[k]);
        (Complex::new(0.0, -omega) * (s[0] * x.x + s[1] * x.z)).exp() * d[i % 2]
    });
    let side = DVector::from_fn(2 * nodes.len(), |i, _| found[i / 2][i % 2]);
    let amplitude = (matrix.adjoint() * &matrix).lu().solve(&(matrix.adjoint() * side)).expect("four waves");
    let other = sent_up(p, !is_p);
    let came = sent_up(p, is_p);
    let expected: [_; 2] = std::array::from_fn(|k| amplitude[0] * came[k] + amplitude[3] * other[k]);
    let energy = |[up_p, up_s]: [Complex<f64>; 2]| flux(p, true, up_p) + flux(p, false, up_s);
    energy([amplitude[1], amplitude[2]]) / energy(expected)
}

#[test]
fn a_quiet_face_sends_back_of_oblique_waves_what_its_closed_form_says() {
    for (is_p, angle_deg, printed) in [
        (true, 30.0, 0.00031),
        (true, 45.0, 0.00394),
        (true, 60.0, 0.03590),
        (true, 75.0, 0.20269),
        (false, 15.0, 0.00297),
        (false, 30.0, 0.03590),
        (false, 45.0, 0.02869),
        (false, 60.0, 0.11325),
    ] {
        let exact = sent_back(is_p, angle_deg);
        assert!((exact - printed).abs() < 6e-6, "P {is_p}, {angle_deg}°: {exact} {printed}");
    }
    for (is_p, angle_deg, cells, height) in [
        (true, 60.0, 48, 40),
        (true, 75.0, 48, 40),
        (false, 30.0, 48, 40),
        (false, 45.0, 48, 40),
        (false, 60.0, 48, 40),
    ] {
        let kind = if is_p { "P" } else { "S" };
        row(
            "oblique wave",
            &format!(
                "energy that a quiet face sends back of a{} {kind} wave at {angle_deg}°",
                if is_p { "" } else { "n" }
            ),
            sent_back(is_p, angle_deg) * measured(is_p, angle_deg, cells, height),
            Within(sent_back(is_p, angle_deg), 0.05),
        );
    }
}
