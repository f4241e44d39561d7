//! A circular tunnel in rock under unequal stresses, the rock glued from blocks by stiff bonds: displacements and stresses around it against the closed form for a
//! finite model (Kirsch 1898, with a fixed outer wall in the place of rock without end).

use std::ops::ControlFlow;
use std::path::Path;

use nalgebra::{Matrix2, Matrix4, Vector2, Vector4};
use ndda::Model;
use ndda::run::Run;
use ndda::summary::LabelWord;
use ndda_mesh::Vec3;
use ndda_mesh::geometry::tet_volume;
use ndda_solver::{Sink, SinkError, View};

use crate::evidence::Answer::AtMost;
use crate::evidence::row;

const SHEAR_PA: f64 = 2.8e9;
const POISSON: f64 = 0.210345;
/// Radius of the tunnel, and of the fixed wall [m].
const A_M: f64 = 1.0;
const R_M: f64 = 5.0;
/// Stresses along x and along z before the tunnel is there, compression positive [Pa].
const ALONG_X_PA: f64 = 30e6;
const ALONG_Z_PA: f64 = 15e6;
/// Tetrahedra in a cell of the blocks.
const CELL: usize = 6;
/// Length of a cell along the radius, beside the tunnel [m].
const CELL_M: f64 = 0.08;
/// Of a displacement that falls as r⁻³, linear elements miss h² u''/8 = 12/8 (h/a)² at the tunnel, and of a stress that falls as r⁻⁴ its mean over a cell is off by
/// h² σ''/24 = 20/24 (h/a)²: together 1.5 %.
const MESH: f64 = (12.0 / 8.0 + 20.0 / 24.0) * CELL_M * CELL_M / (A_M * A_M);

/// Stresses (tension positive) and displacements since the tunnel is there, at a place (r, θ from x).
struct Field {
    radial_m: f64,
    radial_pa: f64,
    hoop_pa: f64,
    shear_pa: f64,
}

/// Airy's function A₀ ln r + C₀ r² + (A r² + B r⁴ + C r⁻² + D) cos 2θ: no traction at the tunnel, no displacement at the wall, in plane strain (Timoshenko & Goodier,
/// Theory of Elasticity, articles 28 and 35).
struct ClosedForm {
    even: Vector2<f64>,
    double: Vector4<f64>,
    /// Mean of the stresses of before, and half of their difference.
    before_pa: [f64; 2],
}

/// Factors of A, B, C, D in σ_r, σ_θ, τ, 2G u_r and 2G u_θ, without cos 2θ and sin 2θ.
fn factors(r: f64) -> [Vector4<f64>; 5] {
    let (r2, r4) = (r * r, r.powi(4));
    [
        Vector4::new(-2.0, 0.0, -6.0 / r4, -4.0 / r2),
        Vector4::new(2.0, 12.0 * r2, 6.0 / r4, 0.0),
        Vector4::new(2.0, 6.0 * r2, -6.0 / r4, -2.0 / r2),
        Vector4::new(-2.0 * r, -4.0 * POISSON * r * r2, 2.0 / (r * r2), 4.0 * (1.0 - POISSON) / r),
        Vector4::new(
            2.0 * r,
            (6.0 - 4.0 * POISSON) * r * r2,
            2.0 / (r * r2),
            -2.0 * (1.0 - 2.0 * POISSON) / r,
        ),
    ]
}

impl ClosedForm {
    fn new() -> Self {
        let [mean, half] = [-0.5 * (ALONG_X_PA + ALONG_Z_PA), -0.5 * (ALONG_X_PA - ALONG_Z_PA)];
        let even = Matrix2::new(1.0 / (A_M * A_M), 2.0, -1.0 / R_M, 2.0 * (1.0 - 2.0 * POISSON) * R_M);
        let (at_tunnel, at_wall) = (factors(A_M), factors(R_M));
        let rows = [at_tunnel[0], at_tunnel[2], at_wall[3], at_wall[4]].map(|row| row.transpose());
        let double = Matrix4::from_rows(&rows);
        Self {
            even: even.lu().solve(&Vector2::new(-mean, 0.0)).unwrap(),
            double: double.lu().solve(&Vector4::new(-half, half, 0.0, 0.0)).unwrap(),
            before_pa: [mean, half],
        }
    }

    fn at(&self, r: f64, theta: f64) -> Field {
        let (cos, sin) = ((2.0 * theta).cos(), (2.0 * theta).sin());
        let [radial, hoop, shear, moved, _] = factors(r).map(|row| row.dot(&self.double));
        let ([a, c], [mean, half]) = (<[f64; 2]>::from(self.even), self.before_pa);
        Field {
            radial_m: (-a / r + 2.0 * (1.0 - 2.0 * POISSON) * c * r + moved * cos) / (2.0 * SHEAR_PA),
            radial_pa: a / (r * r) + 2.0 * c + radial * cos + mean + half * cos,
            hoop_pa: -a / (r * r) + 2.0 * c + hoop * cos + mean - half * cos,
            shear_pa: shear * sin - half * sin,
        }
    }
}

/// Where nodes were when time began.
#[derive(Default)]
struct Start(Vec<Vec3>);

impl Sink for Start {
    fn step_done(&mut self, view: &mut View) -> Result<ControlFlow<()>, SinkError> {
        if self.0.is_empty() {
            self.0.clone_from(&view.simulation.state().position);
        }
        Ok(ControlFlow::Continue(()))
    }
}

#[test]
fn the_closed_form_is_kirschs_where_the_wall_is_far_and_that_of_rings_under_equal_stresses() {
    // Of u(r = a) over p a/2G and σ_θ over p, with the wall at five radii.
    let form = ClosedForm { double: Vector4::zeros(), before_pa: [-1.0, 0.0], ..ClosedForm::new() };
    let even = form.even / (0.5 * (ALONG_X_PA + ALONG_Z_PA));
    let equal = ClosedForm { even, ..form }.at(A_M, 0.3);
    assert!((equal.hoop_pa + 1.870824).abs() < 1e-6, "{}", equal.hoop_pa);
    assert!((equal.radial_m * 2.0 * SHEAR_PA + 0.897996).abs() < 1e-6);
    let all = ClosedForm::new();
    assert!(all.at(A_M, 0.7).radial_pa.abs() < 1.0 && all.at(A_M, 0.7).shear_pa.abs() < 1.0);
    assert!(all.at(R_M, 0.7).radial_m.abs() < 1e-12);
}

#[test]
fn a_tunnel_in_glued_blocks_has_the_displacements_and_stresses_of_the_closed_form() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/works/kirsch_glued.ron");
    let loaded = ndda_io::read::load(&path, &[]).unwrap_or_else(|errors| panic!("{}", errors.render(false)));
    let model =
        Model::new(loaded, Path::new(".")).unwrap_or_else(|errors| panic!("{}", errors.render(false)));
    let mut start = Start::default();
    let mut outcome = Run::new(model).finish(&mut [&mut start]).unwrap();
    assert_eq!(outcome.summary.label.word, LabelWord::Accurate);
    let exact = ClosedForm::new();
    let blocks = outcome.simulation.blocks().clone();
    let core = blocks.ids().find(|block| blocks.names[block.index()] == "core").unwrap();
    let place = |x: &Vec3| {
        let x = x + blocks.origin_m;
        (x.x.hypot(x.z), x.z.atan2(x.x))
    };
    let (mut largest, mut worst, mut least_r) = (0.0f64, 0.0f64, f64::INFINITY);
    for block in blocks.ids().filter(|block| *block != core) {
        for node in blocks.nodes_of(block) {
            let (r, theta) = place(&blocks.rest_position[node]);
            let moved = outcome.simulation.state().position[node] - start.0[node];
            let field = exact.at(r, theta);
            largest = largest.max(field.radial_m.abs());
            worst = worst.max((moved.x * theta.cos() + moved.z * theta.sin() - field.radial_m).abs());
            least_r = least_r.min(r);
        }
    }
    assert!((least_r - A_M).abs() < 1e-9);
    let case = "tunnel in glued blocks";
    row(
        case,
        "largest error of radial displacements over the largest of them",
        worst / largest,
        AtMost(MESH),
    );
    let mut stress_pa = vec![[0.0; 6]; blocks.tets.len()];
    outcome.simulation.recover_stress(&mut stress_pa).unwrap();
    let (mut worst, mut most_pa, mut at_wall) = ([0.0f64; 3], 0.0f64, 0.0f64);
    for block in blocks.ids().filter(|block| *block != core) {
        let tets: Vec<usize> = blocks.tets_of(block).collect();
        for cell in tets.chunks(CELL) {
            let (mut volume, mut center, mut mean) = (0.0, Vec3::zeros(), [0.0; 6]);
            for &tet in cell {
                let corners = blocks.tets[tet].map(|n| blocks.rest_position[n.index()]);
                let own = tet_volume(&corners);
                volume += own;
                center += own * corners.iter().sum::<Vec3>() / 4.0;
                (0..6).for_each(|k| mean[k] += own * stress_pa[tet][k]);
            }
            let ((r, theta), [xx, _, zz, _, _, xz]) = (place(&(center / volume)), mean.map(|s| s / volume));
            let (cos, sin, field) = (theta.cos(), theta.sin(), exact.at(r, theta));
            let hoop = xx * sin * sin + zz * cos * cos - 2.0 * xz * sin * cos;
            let radial = xx * cos * cos + zz * sin * sin + 2.0 * xz * sin * cos;
            let shear = (zz - xx) * sin * cos + xz * (cos * cos - sin * sin);
            most_pa = most_pa.max(field.hoop_pa.abs());
            for (k, error) in [hoop - field.hoop_pa, radial - field.radial_pa, shear - field.shear_pa]
                .into_iter()
                .enumerate()
            {
                worst[k] = worst[k].max(error.abs());
            }
            if r < 1.1 * A_M {
                at_wall = at_wall.max((hoop / field.hoop_pa - 1.0).abs());
            }
        }
    }
    for (name, error) in ["hoop", "radial", "shear"].iter().zip(worst) {
        let what = format!("largest error of {name} stresses over the largest stress");
        row(case, &what, error / most_pa, AtMost(MESH));
    }
    // Those are less than the largest, and steeper: a third more.
    row(case, "largest error of hoop stresses beside the tunnel, each over its own", at_wall, AtMost(0.02));
}
