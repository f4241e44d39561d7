//! Cases that are measured, by the clock and by counting instructions.
#![allow(dead_code)] // each bench takes some of it

#[path = "../../tests/frictionless/mod.rs"]
pub mod frictionless;

use ndda_contact::integration::RegionQueue;
use ndda_contact::integration::TetFrame;
use ndda_contact::testing::{Random, test_box, test_set};
use ndda_contact::{
    ContactHistory, ContactInput, ContactModel, ContactOutput, ContactReport, Coulomb, ElementPotential,
    PotentialContact, SmoothPotential, VelocityCoulomb, VolumePotential,
};
use ndda_mesh::generate::{BoxPattern, box_block};
use ndda_mesh::geometry::{Aabb, TET_FACES, tet_volume, triangle_area_vector};
use ndda_mesh::{BlockSet, TetId, Vec3};
use pulp::Arch;

/// 1024 pairs of random tetrahedra in the unit cube that overlap; `benches/peers/r3d.c` takes the same.
pub fn random_pairs() -> Vec<[[Vec3; 4]; 2]> {
    let mut random = Random(1);
    let mut random = move || random.unit();
    let mut tet = move || loop {
        let mut corners = [[0.0; 3]; 4].map(|x| Vec3::from(x.map(|_| random())));
        let volume = tet_volume(&corners);
        if volume < 0.0 {
            corners.swap(0, 1);
        }
        if volume.abs() > 0.02 {
            return corners;
        }
    };
    let pairs = std::iter::from_fn(move || Some([tet(), tet()]));
    pairs.filter(|[a, b]| shared_volume(a, b) > 1e-4).take(1024).collect()
}

/// Their common volume.
pub fn shared_volume(a: &[Vec3; 4], b: &[Vec3; 4]) -> f64 {
    ndda_contact::integration::overlap_of(a, &TetFrame::new(b), &a[0]).volume_and_moment().0
}

/// Pairs that overlap, waiting for their integrals.
pub struct Hits {
    pairs: Vec<([[f64; 3]; 4], [f64; 4], f64)>,
    arch: Arch,
    batches: RegionQueue,
}

impl Hits {
    /// Faces of random tetrahedra in others.
    pub fn deep() -> Self {
        Self::moved_out(0.0)
    }

    /// Pairs moved towards a face until a corner is just inside.
    pub fn shallow() -> Self {
        Self::moved_out(0.97)
    }

    fn moved_out(part: f64) -> Self {
        let pairs = random_pairs().iter().filter_map(|[a, b]| hit(a, b, part)).collect();
        let mut hits = Self { pairs, arch: Arch::new(), batches: RegionQueue::default() };
        hits.integrate();
        hits
    }

    /// How many.
    pub fn count(&self) -> usize {
        self.pairs.len()
    }

    /// All that is done for a pair after it has been found to overlap.
    pub fn integrate(&mut self) -> f64 {
        for (pair, (lambda, slopes, area)) in self.pairs.iter().enumerate() {
            self.batches.push_element(self.arch, pair as u32, *area, lambda, slopes);
        }
        let mut total = 0.0;
        self.batches.finish(self.arch, |part| total += part.pressure[0]);
        total
    }
}

/// λ at the corners of a face of `a` moved `out` of its way out of `b`, the slopes of φ, and its area; none where it is outside.
pub fn hit(a: &[Vec3; 4], b: &[Vec3; 4], out: f64) -> Option<([[f64; 3]; 4], [f64; 4], f64)> {
    let frame = TetFrame::new(b);
    let corners = TET_FACES[0].map(|i| a[i]);
    let lambda = frame.lambda_inside(&corners)?;
    let deepest = |b: usize| lambda[b].iter().copied().fold(0.0, f64::max);
    let face = (0..4).min_by(|&x, &y| deepest(x).total_cmp(&deepest(y))).expect("four faces");
    let gradient = frame.gradient(face);
    let moved = corners.map(|x| x - out * deepest(face) * gradient / gradient.norm_squared());
    let area_vector = triangle_area_vector(&moved);
    let lambda = frame.lambda_inside(&moved)?;
    Some((lambda, frame.slopes(&area_vector.normalize()), area_vector.norm()))
}

/// A triangle and 1024 tetrahedra that touch its box and not itself.
pub struct Rejects {
    triangle: [Vec3; 3],
    frames: Vec<TetFrame>,
}

impl Rejects {
    /// Elements of a cube around a triangle.
    pub fn new() -> Self {
        let triangle = [[0.1, 0.05, 0.02], [0.9, 0.1, -0.1], [0.0, 0.7, 0.15]].map(Vec3::from);
        let blocks = test_set(vec![test_box([-1.0; 3], [3.0; 3], [6; 3])]);
        let bounds = Aabb::around(&triangle);
        let frames: Vec<TetFrame> = (0..blocks.tets.len())
            .map(|tet| blocks.tet_corners(TetId(tet as u32), &blocks.rest_position))
            .filter(|corners| Aabb::around(corners).inflated(0.1).touches(&bounds))
            .map(|corners| TetFrame::new(&corners))
            .filter(|frame| frame.lambda_inside(&triangle).is_none())
            .collect();
        Self { triangle, frames: frames.iter().cycle().take(1024).copied().collect() }
    }

    /// Looks at all of them.
    pub fn look(&self) -> usize {
        self.frames.iter().filter(|frame| frame.lambda_inside(&self.triangle).is_some()).count()
    }
}

/// A block of n³ cells pressed into its equal by a hundredth of a cell, askew.
pub fn pressed(n: u32) -> BlockSet {
    let lower = test_box([0.0, 0.0, 0.0], [1.0, 1.0, 1.0], [n, n, n]);
    let upper = test_box([0.13, 0.07, 1.0 - 0.01 / f64::from(n)], [1.0, 1.0, 1.0], [n, n, n]);
    test_set(vec![lower, upper])
}

/// A model and all that one evaluation needs.
pub struct Evaluation {
    blocks: BlockSet,
    model: PotentialContact,
    twin: frictionless::Frictionless,
    history: ContactHistory,
    velocity: Vec<Vec3>,
    force: Vec<Vec3>,
    shear: Vec<Vec3>,
    stiffness: Vec<f64>,
    /// Which blocks may be an affine convex target.
    affine: Vec<bool>,
}

impl Evaluation {
    /// A model on [`pressed`] blocks of n³ cells, by the names of its potential and its friction.
    pub fn new(n: u32, potential: &str, friction: &str) -> Self {
        Self::of(pressed(n), potential, friction)
    }

    fn of(blocks: BlockSet, potential: &str, friction: &str) -> Self {
        let model = PotentialContact::new(1e9);
        let model = match potential {
            "element" => model.with_potential(Box::new(ElementPotential)),
            "smooth" | "whole" => model.with_potential(Box::new(SmoothPotential { reference_m: 1.0 })),
            _ => model.with_potential(Box::new(VolumePotential { exponent: 2.0, reference_m3: 1.0 })),
        };
        let model = match friction {
            "none" => model,
            "spring" => model.with_friction(Box::new(Coulomb::new(30.0, 1e9))),
            _ => model.with_friction(Box::new(VelocityCoulomb::new(30.0))),
        };
        let nodes = blocks.rest_position.len();
        let mut evaluation = Self {
            model,
            twin: Default::default(),
            history: ContactHistory::default(),
            velocity: vec![Vec3::x(); nodes],
            force: vec![Vec3::zeros(); nodes],
            // As the solver does it.
            shear: vec![Vec3::zeros(); if friction == "none" { 0 } else { nodes }],
            stiffness: vec![0.0; nodes],
            affine: vec![potential == "whole"; blocks.len()],
            blocks,
        };
        evaluation.step();
        evaluation.frictionless_step();
        evaluation
    }

    /// One evaluation.
    pub fn step(&mut self) -> ContactReport {
        let input = ContactInput {
            affine: &self.affine,
            ..ContactInput::new(&self.blocks, &self.blocks.rest_position, &self.velocity, 1e-5)
        };
        let mut output = ContactOutput {
            force: &mut self.force,
            friction_force: &mut self.shear,
            stiffness: &mut self.stiffness,
        };
        self.model.add_forces(&input, &mut self.history, &mut output).expect("sound blocks")
    }

    /// One step of a model without friction.
    pub fn frictionless_step(&mut self) -> ContactReport {
        let input = ContactInput::new(&self.blocks, &self.blocks.rest_position, &self.velocity, 1e-5);
        let mut output =
            ContactOutput { force: &mut self.force, friction_force: &mut [], stiffness: &mut self.stiffness };
        self.twin.add_forces(&input, 1e9, &mut output)
    }

    /// The energy.
    pub fn energy(&mut self) -> f64 {
        let input = ContactInput::new(&self.blocks, &self.blocks.rest_position, &self.velocity, 1e-5);
        self.model.energy_j(&input, &self.history).expect("sound blocks")
    }

    /// The tangent of normal contact.
    pub fn tangent(&mut self, pairs: &mut Vec<ndda_contact::PairStiffness>) {
        let input = ContactInput::new(&self.blocks, &self.blocks.rest_position, &self.velocity, 1e-5);
        pairs.clear();
        self.model.add_stiffness(&input, &self.history, pairs).expect("sound blocks");
    }

    /// The paper's sum over all pairs of elements.
    pub fn slow_twin(&self) -> Vec<Vec3> {
        ndda_contact::element_pairs::forces(&self.blocks, &self.blocks.rest_position, 1e9)
    }
}

/// A cube with a corner in another of the same mesh, and all pairs of their elements whose boxes touch.
pub struct Cubes {
    evaluation: Evaluation,
    pairs: Vec<[[Vec3; 4]; 2]>,
    forces: Vec<[[Vec3; 4]; 2]>,
    kernel: ndda_contact::reference::tet_pair::NodalForces,
}

impl Cubes {
    /// Of so many cells.
    pub fn new(cells: [u32; 3], pattern: BoxPattern) -> Self {
        let cube = box_block([1.0; 3], cells, pattern).expect("cells");
        let turn = nalgebra::Rotation3::new(Vec3::new(0.3, -0.2, 0.5)).into_inner();
        let blocks = test_set(vec![cube.clone(), cube.placed(&turn, &Vec3::new(0.4, 0.3, 0.9))]);
        let corners = |tet: usize| blocks.tet_corners(TetId(tet as u32), &blocks.rest_position);
        let [lower, upper] = [0, 1].map(|b| blocks.tets_of(ndda_mesh::BlockId(b)));
        let pairs: Vec<_> = lower
            .flat_map(|a| upper.clone().map(move |b| (a, b)))
            .map(|(a, b)| [corners(a), corners(b)])
            .filter(|[a, b]| Aabb::around(a).touches(&Aabb::around(b)))
            .collect();
        let forces = vec![[[Vec3::zeros(); 4]; 2]; pairs.len()];
        Self {
            evaluation: Evaluation::of(blocks, "element", "none"),
            pairs,
            forces,
            kernel: Default::default(),
        }
    }

    /// Elements of one cube.
    pub fn tets(&self) -> usize {
        self.evaluation.blocks.tets.len() / 2
    }

    /// The sum over boundary triangles.
    pub fn boundary(&mut self) -> ContactReport {
        self.evaluation.step()
    }

    /// The paper's sum over pairs of elements by the same kernel; scattering it to nodes is not even counted.
    pub fn all_elements(&mut self) {
        self.kernel.of(&self.pairs, 1e9, &mut self.forces);
    }
}
