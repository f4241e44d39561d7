//! Where bonds form.

use ndda_mesh::geometry::triangle_area_vector;
use ndda_mesh::planar::turn;

use crate::affine::convex_target::ConvexBlocks;
use crate::broad_phase::candidates::{Candidates, Facet};
use crate::friction::law_table::{FrictionLawTable, Memory};
use crate::friction::stretch;
use crate::integration::clip::{Form, Outline, Polygon};
use crate::model::{Bond, ContactInput};

/// A facet touches a block when it is no further outside than this part of the size of the target's tetrahedron.
const TOUCHING: f64 = 1e-5;
/// Least area of a bond over that of the facet.
const LEAST_SHARE: f64 = 1e-6;

/// Forms the bonds of a scene whose contact is evaluated for the first time.
pub(crate) fn form(
    joints: &FrictionLawTable,
    (candidates, hulls): (&Candidates, &ConvexBlocks),
    input: &ContactInput,
    bonds: &mut Vec<Bond>,
) {
    let holds = |facet: &Facet| {
        joints.law(input.blocks, facet.triangle, facet.target).is_some_and(|law| law.holds_together())
    };
    let facets = candidates.facets().filter(holds);
    for facet in facets {
        let Some(patch) = Patch::of(&facet, hulls, input) else { continue };
        // With memory per element, what a facet has in each element is a contact of its own.
        if joints.memory == Memory::Body {
            let points = patch.points();
            let three = points.into_iter().zip(loads(&points));
            bonds.extend(three.filter_map(|(at, bears)| patch.bond(at, (1.0 / 3.0, bears), input)));
        } else {
            bonds.extend(patch.bond(patch.center, (1.0, [1.0; 3]), input));
        }
    }
}

/// The parts of a force on a facet that three of its points bear together, per corner of the facet that it acts at; equal parts where they lie in a line.
fn loads(points: &[[f64; 2]; 3]) -> [[f64; 3]; 3] {
    let area = |[a, b, c]: [[f64; 2]; 3]| turn(&a, &b, &c);
    let all = area(*points);
    let corners = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
    [0, 1, 2].map(|point| {
        corners.map(|corner| {
            let mut with = *points;
            with[point] = corner;
            if all.abs() > f64::MIN_POSITIVE { area(with) / all } else { 1.0 / 3.0 }
        })
    })
}

/// The area where a facet touches its target.
struct Patch<'a> {
    facet: &'a Facet<'a>,
    /// Over the area of the facet.
    share: f64,
    /// Second and third barycentric coordinate of its centre.
    center: [f64; 2],
    /// Mean of both coordinates' products about the centre: of the second with itself, of both, of the third with itself.
    spread: [f64; 3],
}

impl<'a> Patch<'a> {
    /// None where a facet does not touch.
    fn of(facet: &'a Facet, hulls: &ConvexBlocks, input: &ContactInput) -> Option<Self> {
        let corners = input.blocks.triangle_corners(facet.triangle, input.position);
        let normal = triangle_area_vector(&corners).normalize();
        let (mut share, mut moment, mut second) = (0.0, [0.0; 2], [0.0; 3]);
        for tet in facet.tets() {
            let frame = stretch::frame_of(tet, input);
            let into = TOUCHING * frame.volume_m3.cbrt() * normal;
            let shifted = corners.map(|x| x + into);
            let mut polygon = Polygon::all_of(&Outline::TRIANGLE);
            let mut cut = |at: [f64; 3]| polygon.cut(&Form::through(&at), f64::MIN_POSITIVE);
            match hulls.affine_target(facet.target) {
                Some(_) => {
                    hulls.faces_of(facet.target).iter().for_each(|face| cut(shifted.map(|x| face.phi(&x))))
                }
                None => frame.lambda(&shifted).into_iter().for_each(&mut cut),
            }
            if polygon.corners().len() < 3 {
                continue;
            }
            for ([a, b, c], twice) in polygon.fan() {
                share += twice;
                let sum = [0, 1].map(|k| a[k] + b[k] + c[k]);
                [0, 1].into_iter().for_each(|k| moment[k] += twice * sum[k] / 3.0);
                for (k, (i, j)) in [(0, 0), (0, 1), (1, 1)].into_iter().enumerate() {
                    let corners = a[i] * a[j] + b[i] * b[j] + c[i] * c[j];
                    second[k] += twice * (sum[i] * sum[j] + corners) / 12.0;
                }
            }
        }
        if share <= LEAST_SHARE {
            return None;
        }
        let center = moment.map(|m| m / share);
        let products = [center[0] * center[0], center[0] * center[1], center[1] * center[1]];
        let spread = [0, 1, 2].map(|k| second[k] / share - products[k]);
        Some(Self { facet, share, center, spread })
    }

    /// Three points with the centre and the second moments of the area, so that they carry its moments: c + L u, L Lᵀ being the second moments and u the corners of an
    /// equilateral triangle at √2 from the origin.
    fn points(&self) -> [[f64; 2]; 3] {
        let [xx, xy, yy] = self.spread;
        let first = xx.max(0.0).sqrt();
        let mixed = if first > 0.0 { xy / first } else { 0.0 };
        let second = (yy - mixed * mixed).max(0.0).sqrt();
        [0.0f64, 1.0, 2.0].map(|k| {
            let angle = k * std::f64::consts::TAU / 3.0;
            let (sine, cosine) = angle.sin_cos();
            let [x, y] = [std::f64::consts::SQRT_2 * cosine, std::f64::consts::SQRT_2 * sine];
            [self.center[0] + first * x, self.center[1] + mixed * x + second * y]
        })
    }

    /// A bond at a point, of a part of the area and of the force, with the element that the point is deepest in.
    fn bond(&self, at: [f64; 2], (part, bears): (f64, [f64; 3]), input: &ContactInput) -> Option<Bond> {
        let corners = input.blocks.triangle_corners(self.facet.triangle, input.position);
        let weights = [1.0 - at[0] - at[1], at[0], at[1]];
        let point = stretch::mean(&corners, &weights);
        let lambda_in = |tet| (tet, stretch::frame_of(tet, input).lambda_at(&point));
        let least = |lambda: &[f64; 4]| lambda.iter().copied().fold(f64::INFINITY, f64::min);
        let pairs = self.facet.tets().map(lambda_in);
        let deepest = pairs.max_by(|a, b| least(&a.1).total_cmp(&least(&b.1)));
        let (facet, share) = (self.facet.triangle, part * self.share);
        deepest.map(|(tet, lambda)| Bond {
            facet,
            tet,
            weights,
            lambda,
            share,
            part,
            damage: 0.0,
            slip_m: 0.0,
            opened_m: 0.0,
            bears,
        })
    }
}
