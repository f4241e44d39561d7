//! The ground near a boulder as a block, and a simulation of both. It is made anew where the boulder comes near the end of that ground, from the motion of
//! the boulder, so that a step costs the same on any terrain.

use std::collections::BTreeMap;
use std::sync::Arc;

use ndda_contact::{FrictionLaw, FrictionLawTable, PotentialContact, RestitutionTable, VelocityCoulomb};
use ndda_fem::{LinearElastic, Material};
use ndda_io::mesh::terrain_grid::connected;
use ndda_mesh::{BlockMesh, BlockSet, Vec3};
use ndda_solver::{AutoStep, BodyKind, BodySetup, Direct, Mass, Midpoint, Setup, Simulation};

use super::contact::{BOULDER, BoulderDepth, GroundBelow};
use super::terrain::Terrain;

/// Time that a window is ahead of the boulder, as it moves [s].
const AHEAD_S: f64 = 0.4;
/// Most cells of a window on either side of the boulder beyond what it covers.
const MOST_CELLS: f64 = 7.0;
/// Fewest cells, so that a boulder that turns on the spot does not leave it.
const LEAST_CELLS: f64 = 2.0;
/// A boulder's window is changed when fewer than this many cells lie between the boulder and the edge of the window, but not while the boulder touches
/// the ground: what contact remembers of the last step is lost with the window.
pub(super) const FEW_CELLS: f64 = 1.0;

/// Part of μN to which friction of all triangles of the ground together is found: they all act on one boulder, and to find it to more digits takes hundreds
/// of sweeps where it turns on the spot.
const FRICTION: f64 = 1e-3;

/// Part of the bound of ω_c Δt that a step may use: a step that begins or ends a contact may miss ⅛ (ω_c Δt)² of m v², here 3 %, as a rule much less.
const SAFETY: f64 = 0.25;

/// What a boulder and the ground below it do in contact.
pub(super) struct Laws {
    /// Pressure of the contact at a depth of 1 m [Pa].
    pub penalty_pa: f64,
    /// Restitution on the surfaces of all grounds, in the order of [`surface_name`].
    pub restitution: RestitutionTable,
    /// Friction angle [°] of ground outside of all zones, then of each zone.
    pub friction_deg: Vec<f64>,
    /// Density of the boulder [kg/m³].
    pub density_kg_m3: f64,
    /// Gravity along z [m/s²].
    pub gravity_m_s2: f64,
    /// Longest step [s].
    pub step_s: f64,
    /// Energy that a step may gain over the largest in the window.
    pub energy: f64,
}

/// Where a boulder is and how it moves.
#[derive(Clone, Debug)]
pub(super) struct Motion {
    /// Nodes of its mesh, from its mass centre [m].
    pub arms: Vec<Vec3>,
    /// Mass centre [m].
    pub center: Vec3,
    /// Velocity of the mass centre [m/s].
    pub velocity_m_s: Vec3,
    /// Rate of rotation [rad/s].
    pub spin_rad_s: Vec3,
}

/// Cells from the first up to, but without, the last, along x and y.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Cells {
    pub from: [usize; 2],
    pub to: [usize; 2],
}

impl Cells {
    /// The cells around a boulder of a radius, more of them on the side that it moves to; none if it reaches the end of the terrain.
    pub(super) fn around(terrain: &Terrain, motion: &Motion, radius_m: f64) -> Option<Self> {
        Self::below(terrain, &motion.center, radius_m)?;
        let mut cells = Self { from: [0; 2], to: [0; 2] };
        for axis in 0..2 {
            let step = terrain.step_m[axis];
            let ahead = (AHEAD_S * motion.velocity_m_s[axis] / step).clamp(-MOST_CELLS, MOST_CELLS);
            let at = (motion.center[axis] - terrain.origin_m[axis]) / step;
            let reach = radius_m / step + LEAST_CELLS;
            let last = terrain.cells()[axis] as f64;
            cells.from[axis] = (at - reach + ahead.min(0.0)).floor().max(0.0) as usize;
            cells.to[axis] = (at + reach + ahead.max(0.0)).ceil().min(last) as usize;
        }
        Some(cells)
    }

    /// The cells that a boulder is above; none where one of them has no heights or is beyond the grid.
    pub(super) fn below(terrain: &Terrain, center: &Vec3, radius_m: f64) -> Option<Self> {
        let corner = |sign: f64| {
            let at = [0, 1].map(|axis| center[axis] + sign * radius_m);
            terrain.cell_at(at).map(|(cell, _)| cell)
        };
        let (from, last) = (corner(-1.0)?, corner(1.0)?);
        let cells = Self { from, to: last.map(|i| i + 1) };
        cells.each().all(|(i, j)| terrain.has(i, j)).then_some(cells)
    }

    /// Whether these cells hold all those below a boulder, and so many more around them unless the terrain ends there.
    pub(super) fn hold(&self, terrain: &Terrain, center: &Vec3, radius_m: f64, more: f64) -> bool {
        (0..2).all(|axis| {
            let at = (center[axis] - terrain.origin_m[axis]) / terrain.step_m[axis];
            let reach = radius_m / terrain.step_m[axis];
            let (first, last) = (self.from[axis], self.to[axis]);
            let before = if first == 0 { 0.0 } else { more };
            let beyond = if last == terrain.cells()[axis] { 0.0 } else { more };
            at - reach - before >= first as f64 && at + reach + beyond <= last as f64
        })
    }

    /// Cosine of the angle of the steepest triangle of these cells: a height above the ground times it is no more than the distance from the ground.
    pub(super) fn steepest_cosine(&self, terrain: &Terrain) -> f64 {
        let [dx, dy] = terrain.step_m;
        let rise = |(i, j): (usize, usize)| {
            let [a, b, c, d] =
                [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| terrain.node_m(i, j));
            let [one, other] = [((b - a) / dx, (c - b) / dy), ((c - d) / dx, (d - a) / dy)];
            one.0.hypot(one.1).max(other.0.hypot(other.1))
        };
        let steepest = self.each().filter(|&(i, j)| terrain.has(i, j)).map(rise).fold(0.0, f64::max);
        1.0 / steepest.hypot(1.0)
    }

    fn each(self) -> impl Iterator<Item = (usize, usize)> {
        (self.from[1]..self.to[1]).flat_map(move |j| (self.from[0]..self.to[0]).map(move |i| (i, j)))
    }
}

/// The cells with heights that are connected edge by edge with the one below a boulder: it leaves the terrain before it gets to any beyond a gap.
fn in_reach(terrain: &Terrain, cells: Cells, center: &Vec3) -> Vec<(usize, usize)> {
    let all: Vec<(usize, usize)> = cells.each().filter(|&(i, j)| terrain.has(i, j)).collect();
    let [width, length] = [0, 1].map(|axis| cells.to[axis] - cells.from[axis]);
    let has_gaps = all.len() < width * length;
    let Some((below, _)) = terrain.cell_at([center.x, center.y]).filter(|_| has_gaps) else { return all };
    let [x, y] = cells.from;
    let is_reached =
        connected([width, length], [[below[0] - x, below[1] - y]], |i, j| terrain.has(x + i, y + j));
    all.into_iter().filter(|&(i, j)| is_reached[(j - y) * width + i - x]).collect()
}

/// The ground of some cells below a boulder: a tetrahedron from each triangle to one point that is below all of them.
fn ground((terrain, cells): (&Terrain, Cells), center: &Vec3, grounds: usize) -> BlockMesh {
    let columns = cells.to[0] - cells.from[0] + 1;
    let mut number: Vec<u32> = vec![u32::MAX; columns * (cells.to[1] - cells.from[1] + 1)];
    let (mut nodes, mut triangles) = (vec![Vec3::zeros()], Vec::new());
    // All of them, so that each has the same number in every window.
    let mut surfaces: BTreeMap<String, Vec<[u32; 3]>> =
        (0..grounds).map(|zone| (surface_name(zone), Vec::new())).collect();
    for (i, j) in in_reach(terrain, cells, center) {
        let corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| {
            let place = (j - cells.from[1]) * columns + i - cells.from[0];
            if number[place] == u32::MAX {
                number[place] = nodes.len() as u32;
                nodes.push(terrain.corner_m(i, j));
            }
            number[place]
        });
        let [a, b, c, d] = corners;
        for (triangle, zone) in [[a, b, c], [a, c, d]].into_iter().zip(terrain.zones_at(i, j)) {
            triangles.push(triangle);
            let mut sorted = triangle;
            sorted.sort_unstable();
            surfaces.entry(surface_name(zone.into())).or_default().push(sorted);
        }
    }
    nodes[0] = apex(&nodes, &triangles);
    let tets = triangles.iter().map(|&[a, b, c]| [0, a, b, c]).collect();
    BlockMesh { nodes, tets, surfaces, ..BlockMesh::default() }
}

/// Name of the surface of ground outside of all zones, 0, or of a zone, from 1; names are in the order of zones.
fn surface_name(zone: usize) -> String {
    format!("ground_{zone:05}")
}

/// Restitution of ground outside of all zones, then of each zone.
pub(super) fn restitution_of(grounds: &[f64]) -> RestitutionTable {
    let mut table = RestitutionTable::everywhere(grounds[0]);
    for (surface, restitution) in (0..).zip(grounds) {
        table.set_on(&[surface], *restitution);
    }
    table
}

/// A point below the planes of all triangles, by as much as the ground is wide; the first of the nodes is not one of theirs.
fn apex(nodes: &[Vec3], triangles: &[[u32; 3]]) -> Vec3 {
    let bounds = ndda_mesh::geometry::Aabb::around(&nodes[1..]);
    let middle = bounds.center();
    let below = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(|n| nodes[n as usize]);
        let normal = (b - a).cross(&(c - a));
        a.z - (normal.x * (middle.x - a.x) + normal.y * (middle.y - a.y)) / normal.z
    };
    let lowest = triangles.iter().map(below).fold(f64::INFINITY, f64::min);
    Vec3::new(middle.x, middle.y, lowest - bounds.diagonal())
}

/// A simulation of a boulder, as it moves, over the ground of some cells.
///
/// # Errors
/// Why it cannot be set up.
pub(super) fn simulation(
    (terrain, cells): (&Terrain, Cells),
    (tets, motion): (&[[u32; 4]], &Motion),
    laws: &Laws,
) -> Result<Simulation, String> {
    // Map coordinates are so large that rounding them would bend the faces of the boulder.
    let origin_m = motion.center.map(f64::round);
    let center = motion.center - origin_m;
    let nodes = motion.arms.iter().map(|arm| center + arm).collect();
    let boulder = BlockMesh { nodes, tets: tets.to_vec(), ..BlockMesh::default() };
    let mut ground = ground((terrain, cells), &motion.center, laws.friction_deg.len());
    ground.nodes.iter_mut().for_each(|x| *x -= origin_m);
    let mut blocks = BlockSet::new(vec![("boulder".to_string(), boulder), ("ground".to_string(), ground)])
        .map_err(|error| error.to_string())?;
    blocks.origin_m += origin_m;
    let contact = contact(laws);
    // Rigid and fixed blocks have no moduli.
    let rock = LinearElastic::new(1e9, 0.25, laws.density_kg_m3).map_err(|error| error.to_string())?;
    let material: Arc<dyn Material> = Arc::new(rock);
    let body = |kind, velocity_m_s, spin_rad_s| BodySetup {
        kind,
        material: material.clone(),
        supports: Vec::new(),
        initial_stress: None,
        tractions: Vec::new(),
        forces: Vec::new(),
        pressures: Vec::new(),
        ties: Vec::new(),
        quiet: Vec::new(),
        velocity_m_s,
        spin_rad_s,
    };
    let mut simulation = Simulation::new(Setup {
        blocks,
        bodies: vec![
            body(BodyKind::Rigid, motion.velocity_m_s, motion.spin_rad_s),
            body(BodyKind::Fixed, Vec3::zeros(), Vec3::zeros()),
        ],
        gravity_m_s2: Vec3::new(0.0, 0.0, laws.gravity_m_s2),
        gravity_factor: None,
        mass: Mass::Consistent,
        step_s: laws.step_s,
        integrator: Box::new(Midpoint { theta: 0.5 }),
        contact: Some(Box::new(contact)),
        implicit_contact: None,
        solver: Box::new(Direct),
        auto_step: Some(AutoStep { safety: SAFETY, energy: laws.energy, most_halvings: 12 }),
        bolts: Vec::new(),
    })
    .map_err(|error| super::stopped::why_not_begun(&error))?;
    simulation.go_on_course();
    Ok(simulation)
}

/// Contact with the laws of each ground on the triangles of its surface.
fn contact(laws: &Laws) -> PotentialContact {
    let mut friction = FrictionLawTable::between(Vec::new(), 1);
    for (surface, &friction_deg) in (0..).zip(&laws.friction_deg) {
        let law = || -> Box<dyn FrictionLaw> { Box::new(VelocityCoulomb::new(friction_deg)) };
        friction.set_on(&[surface], (friction_deg > 0.0).then(law));
    }
    friction.tolerance = FRICTION;
    let model = PotentialContact::new(laws.penalty_pa)
        .with_potential(Box::new(BoulderDepth))
        .with_broad_phase(Box::new(GroundBelow))
        .with_restitution(laws.restitution.clone());
    if friction.have_laws() { model.with_law_table(friction) } else { model }
}

/// The boulder of a simulation as it is now.
pub(super) fn motion(simulation: &Simulation) -> Motion {
    let (blocks, state) = (simulation.blocks(), simulation.state());
    let nodes = blocks.nodes_of(BOULDER);
    let (position, velocity) = (&state.position[nodes.clone()], &state.velocity[nodes]);
    let motion = simulation.shape(BOULDER).operator.rigid_motion(position, velocity);
    Motion {
        arms: position.iter().map(|x| x - motion.center).collect(),
        center: motion.center + blocks.origin_m,
        velocity_m_s: motion.velocity_m_s,
        spin_rad_s: motion.spin_rad_s,
    }
}
