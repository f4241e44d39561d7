//! The base on which a block rests: what of its lowest face lies on others, and where forces meet it.

use ndda_mesh::geometry::{Aabb, triangle_area_vector};
use ndda_mesh::planar::{clipped, hull_of_sorted, turn};
use ndda_mesh::{BlockId, Vec3};
use ndda_solver::Simulation;

/// Part of the depth of a base below which a distance from its edge is rounding.
const AT_THE_EDGE: f64 = 1e-9;
/// Cosine and part of a block's size by which faces differ that lie on each other.
const SAME_DIRECTION: f64 = 1.0 - 1e-9;
const SAME_PLANE: f64 = 1e-3;
/// Cosine of the steepest base, against gravity.
const STEEPEST: f64 = 0.5;

/// Places of s₀, from a millionth of the depth of the base inside its edge to four depths.
pub const PLACES: i32 = 400;

/// Where a force acts [m], and the force [N].
pub type Pull = (Vec3, Vec3);

/// A base that tilts about a line across a direction, so that pressures grow in proportion to the distance from that line.
pub struct Bearing {
    /// Corners, along the direction and across it [m].
    points: Vec<[f64; 2]>,
    least_m: f64,
    /// The outermost place along the direction [m].
    pub most_m: f64,
}

impl Bearing {
    /// ∫ (s − s₀) dA [m³] over what bears, and the centre of pressure [m], for one of the [`PLACES`] of s₀ where pressures begin.
    pub fn beyond(&self, place: f64) -> [f64; 2] {
        let inside = 4.0 * 10_f64.powf(-7.0 * place / f64::from(PLACES));
        let from_m = self.most_m - inside * (self.most_m - self.least_m);
        let [first, second] = moments_beyond(&self.points, from_m);
        [first, from_m + second / first]
    }
}

/// Where a block rests on others.
pub struct Base {
    /// Corners of what it rests on, in two axes of the base, from below the mass centre.
    pub points: Vec<[f64; 2]>,
    /// Below the mass centre [m].
    pub origin: Vec3,
    /// The axes, and the normal out of the block.
    pub axes: [Vec3; 3],
    /// The blocks that it rests on.
    pub on: Vec<BlockId>,
}

/// The resultant force on a base, and one of its edges.
pub struct Pressed {
    /// Part of the force across the base [N].
    pub normal_n: f64,
    /// d [m].
    pub inside_m: f64,
    /// w [m].
    pub width_m: f64,
    /// Depth of the base across the edge [m].
    pub across_m: f64,
    /// How far the line of the force moves towards the edge for a tilt of one radian [m].
    pub arm_m: f64,
}

/// Triangles of a block as it is drawn, with their normals: a scene that has settled is judged by what it began with, since what fell on the way lies at rest.
fn faces(simulation: &Simulation, block: BlockId) -> impl Iterator<Item = ([Vec3; 3], Vec3)> {
    let blocks = simulation.blocks();
    let position = &blocks.rest_position;
    blocks.triangles_of(block).map(move |triangle| {
        let corners = blocks.triangles[triangle].map(|node| position[node.index()]);
        (corners, triangle_area_vector(&corners))
    })
}

impl Base {
    /// The lowest face of a block, where others touch that one only, or its top.
    pub fn of(simulation: &Simulation, block: BlockId, gravity: &Vec3) -> Option<Self> {
        let down = gravity.normalize();
        let nodes = &simulation.blocks().rest_position[simulation.blocks().nodes_of(block)];
        let bounds = Aabb::around(nodes);
        let near_m = SAME_PLANE * bounds.diagonal();
        let bounds = bounds.inflated(near_m);
        let own: Vec<([Vec3; 3], Vec3)> = faces(simulation, block).collect();
        let (first, normal) = own
            .iter()
            .map(|(corners, area)| (corners[0], area.normalize()))
            .max_by(|a, b| a.1.dot(&down).total_cmp(&b.1.dot(&down)))?;
        let cosine = normal.dot(&down);
        let centre = simulation.shape(block).operator.center(nodes);
        let height_m = (first - centre).dot(&normal);
        if cosine < STEEPEST || height_m <= 0.0 {
            return None;
        }
        let origin = centre + height_m * normal;
        let across = normal.cross(&Vec3::ith(normal.iamin(), 1.0)).normalize();
        let axes = [across, normal.cross(&across), normal];
        let flat = |x: &Vec3| [0, 1].map(|k| axes[k].dot(&(x - origin)));
        let is_on = |plane: &([Vec3; 3], Vec3), other: &([Vec3; 3], Vec3)| {
            let normal = plane.1.normalize();
            let faces = normal.dot(&other.1.normalize()) < -SAME_DIRECTION;
            faces && (other.0[0] - plane.0[0]).dot(&normal).abs() < near_m
        };
        let is_base = |plane: &([Vec3; 3], Vec3)| plane.1.normalize().dot(&normal) > SAME_DIRECTION;
        let outline = hull(
            own.iter()
                .filter(|plane| is_base(plane))
                .flat_map(|(corners, _)| corners.iter().map(flat))
                .collect(),
        );
        let (mut points, mut on) = (Vec::new(), Vec::new());
        let is_there = |other: &BlockId| *other != block && !simulation.is_absent(*other);
        for other in simulation.blocks().ids().filter(is_there) {
            for face in faces(simulation, other).filter(|(corners, _)| Aabb::around(corners).touches(&bounds))
            {
                let Some(plane) = own.iter().find(|plane| is_on(plane, &face)) else { continue };
                if is_base(plane) {
                    let shared = clipped(face.0.map(|x| flat(&x)).to_vec(), &outline);
                    if !shared.is_empty() && on.last() != Some(&other) {
                        on.push(other);
                    }
                    points.extend(shared);
                } else if plane.1.normalize().dot(&normal) > -STEEPEST {
                    return None;
                }
            }
        }
        Some(Self { points: hull(points), origin, axes, on })
    }

    /// The force on the base and the distance of its line from each edge; none where they pull, or where their line meets it outside.
    ///
    /// With heights h_i, places s_i, normal parts N_i and tangential parts T_i of the forces, the line meets the base at Σ (N_i s_i + h_i T_i)/N.
    /// A tilt of one radian about the edge with the outward direction e there moves that along e by Σ (N_i h_i − (s_i·e)(T_i·e))/N.
    pub fn pressed(&self, pulls: &[Pull]) -> Vec<Pressed> {
        let (normal_n, foot) = self.resultant(pulls);
        let press = |(inside_m, along, [width_m, across_m]): (f64, Vec3, [f64; 2])| {
            let arm_m = self.arm(pulls, (normal_n, &foot), &Vec3::new(along.y, -along.x, 0.0));
            Pressed { normal_n, inside_m, width_m, across_m, arm_m }
        };
        let all = self.inside(&foot).into_iter().map(press);
        all.filter(|pressed| pressed.normal_n > 0.0 && pressed.arm_m > 0.0).collect()
    }

    /// Soft contact moves the foot of a force outwards, straight away from the middle of the base: by which part of the way from there to the rim (1 where the block
    /// falls), and the length of that way [m]. At a corner a triangle bears, where at an edge a strip does. `soft_m_pa` is L₀/k_n.
    pub fn moved_outwards(&self, pulls: &[Pull], soft_m_pa: f64) -> Option<(f64, f64)> {
        let (normal_n, foot) = self.resultant(pulls);
        if self.inside(&foot).is_empty() {
            return None;
        }
        let out = (foot - self.middle()).try_normalize(0.0)?;
        let arm_m = self.arm(pulls, (normal_n, &foot), &out);
        if normal_n <= 0.0 || arm_m <= 0.0 {
            return None;
        }
        let (bearing, way_m) = (self.bearing(&out), self.way_to_rim(&foot, &out));
        // How far it moves where pressures begin at a place, and whether they hold it there.
        let moved = |place: f64| {
            let [first, centre_m] = bearing.beyond(place);
            let moved_m = 0.5 * soft_m_pa * normal_n * arm_m / first;
            (moved_m / way_m, first > 0.0 && centre_m >= foot.dot(&out) + moved_m)
        };
        let holds = (0..PLACES).map(f64::from).find(|place| moved(*place).1).map(|place| {
            let (mut low, mut high) = ((place - 1.0).max(0.0), place);
            for _ in 0..40 {
                let middle = 0.5 * (low + high);
                if moved(middle).1 { high = middle } else { low = middle }
            }
            moved(high).0
        });
        Some((holds.unwrap_or(1.0).min(1.0), way_m))
    }

    /// The base as it bears when it tilts towards a direction.
    pub fn bearing(&self, out: &Vec3) -> Bearing {
        let points: Vec<[f64; 2]> =
            self.points.iter().map(|[x, y]| [out.x * x + out.y * y, out.x * y - out.y * x]).collect();
        let least_m = points.iter().fold(f64::MAX, |least, [s, _]| least.min(*s));
        let most_m = points.iter().fold(f64::MIN, |most, [s, _]| most.max(*s));
        Bearing { points, least_m, most_m }
    }

    /// Directions straight over each of its edges, and over its corners midway between those; none where it is no area.
    pub fn outwards(&self) -> Vec<Vec3> {
        if self.points.len() < 3 {
            return Vec::new();
        }
        let over: Vec<Vec3> =
            self.edges().map(|(a, b)| Vec3::new(b[1] - a[1], a[0] - b[0], 0.0).normalize()).collect();
        let next = over.iter().cycle().skip(1);
        over.iter().zip(next).flat_map(|(one, next)| [*one, (one + next).normalize()]).collect()
    }

    /// The two corners of each edge, counter-clockwise.
    fn edges(&self) -> impl Iterator<Item = ([f64; 2], [f64; 2])> + '_ {
        let next = self.points.iter().cycle().skip(1);
        self.points.iter().copied().zip(next.copied())
    }

    /// N, and where the line of the forces meets the base.
    pub fn resultant(&self, pulls: &[Pull]) -> (f64, Vec3) {
        let normal_n: f64 = pulls.iter().map(|(_, f)| f.dot(&self.axes[2])).sum();
        let foot = self.parts(pulls).map(|(s, h, n, t)| n * s + h * t).sum::<Vec3>() / normal_n;
        (normal_n, foot)
    }

    /// How far the foot moves along a direction of the base for a tilt of one radian [m].
    pub fn arm(&self, pulls: &[Pull], (normal_n, foot): (f64, &Vec3), out: &Vec3) -> f64 {
        let arm = |(s, h, n, t): (Vec3, f64, f64, Vec3)| n * h - (s - foot).dot(out) * t.dot(out);
        self.parts(pulls).map(arm).sum::<f64>() / normal_n
    }

    /// Place along the base and height [m] of each force, and its parts across and along the base [N].
    fn parts<'a>(&'a self, pulls: &'a [Pull]) -> impl Iterator<Item = (Vec3, f64, f64, Vec3)> + 'a {
        let [one, two, normal] = &self.axes;
        let flat = move |v: &Vec3| Vec3::new(one.dot(v), two.dot(v), 0.0);
        pulls.iter().map(move |(x, f)| {
            (flat(&(x - self.origin)), (self.origin - x).dot(normal), f.dot(normal), flat(f))
        })
    }

    /// The middle of its area.
    fn middle(&self) -> Vec3 {
        let (mut sum, mut area) = (Vec3::zeros(), 0.0);
        for k in 2..self.points.len() {
            let [a, b, c] = [self.points[0], self.points[k - 1], self.points[k]];
            let part = turn(&a, &b, &c);
            area += part;
            sum += part / 3.0 * Vec3::new(a[0] + b[0] + c[0], a[1] + b[1] + c[1], 0.0);
        }
        sum / area
    }

    /// From a point inside along a direction to the rim [m].
    fn way_to_rim(&self, from: &Vec3, along: &Vec3) -> f64 {
        let ways = self.edges().filter_map(|(a, b)| {
            let outwards = along.x * (b[1] - a[1]) - along.y * (b[0] - a[0]);
            (outwards > 0.0).then(|| turn(&a, &b, &[from.x, from.y]) / outwards)
        });
        ways.fold(f64::INFINITY, f64::min)
    }

    /// Distance of a foot from each edge, the direction of that, and the extents of the base along and across it [m]; none where it lies outside.
    fn inside(&self, foot: &Vec3) -> Vec<(f64, Vec3, [f64; 2])> {
        let corners = &self.points;
        let extent = |axis: Vec3| {
            let places = corners.iter().map(|x| axis.x * x[0] + axis.y * x[1]);
            places.clone().fold(f64::MIN, f64::max) - places.fold(f64::MAX, f64::min)
        };
        let from_edge = |(a, b): ([f64; 2], [f64; 2])| {
            let way = Vec3::new(b[0] - a[0], b[1] - a[1], 0.0);
            let (inside_m, along) = (turn(&a, &b, &[foot.x, foot.y]) / way.norm(), way.normalize());
            (inside_m, along, [extent(along), extent(Vec3::new(-along.y, along.x, 0.0))])
        };
        let all: Vec<(f64, Vec3, [f64; 2])> = self.edges().map(from_edge).collect();
        let is_inside =
            |(inside_m, _, [_, across_m]): &(f64, Vec3, [f64; 2])| *inside_m > AT_THE_EDGE * across_m;
        if corners.len() > 2 && all.iter().all(is_inside) { all } else { Vec::new() }
    }
}

/// A block and all that rests on it alone, of these bases; none where something rests on them and on other blocks.
pub fn with_all_on_it(bases: &[(BlockId, Base)], first: BlockId) -> Option<Vec<BlockId>> {
    let mut stack = vec![first];
    let on_it = |stack: &[BlockId], base: &Base| base.on.iter().filter(|on| stack.contains(on)).count();
    loop {
        let rests = |(block, base): &&(BlockId, Base)| {
            !base.on.is_empty() && on_it(&stack, base) == base.on.len() && !stack.contains(block)
        };
        let more: Vec<BlockId> = bases.iter().filter(rests).map(|(block, _)| *block).collect();
        if more.is_empty() {
            break;
        }
        stack.extend(more);
    }
    let leans = |(block, base): &(BlockId, Base)| !stack.contains(block) && on_it(&stack, base) > 0;
    (!bases.iter().any(leans)).then_some(stack)
}

/// ∫ σ dA and ∫ σ² dA over the part of a convex polygon where σ = s − s₀ > 0; s is the first coordinate.
fn moments_beyond(polygon: &[[f64; 2]], from_m: f64) -> [f64; 2] {
    let mut kept: Vec<[f64; 2]> = Vec::with_capacity(polygon.len() + 1);
    for (k, p) in polygon.iter().enumerate() {
        let q = &polygon[(k + 1) % polygon.len()];
        let (at_p, at_q) = (p[0] - from_m, q[0] - from_m);
        if at_p >= 0.0 {
            kept.push([at_p, p[1]]);
        }
        if at_p * at_q < 0.0 {
            kept.push([0.0, p[1] + at_p / (at_p - at_q) * (q[1] - p[1])]);
        }
    }
    let mut sums = [0.0; 2];
    for k in 2..kept.len() {
        let [a, b, c] = [kept[0], kept[k - 1], kept[k]];
        let area_m2 = 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])).abs();
        let sum = a[0] + b[0] + c[0];
        sums[0] += area_m2 * sum / 3.0;
        sums[1] += area_m2 * (sum * sum + a[0] * a[0] + b[0] * b[0] + c[0] * c[0]) / 12.0;
    }
    sums
}

/// The convex hull, counter-clockwise.
fn hull(mut points: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    points.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    hull_of_sorted(&points, |at| *at, 0.0)
}
