//! The fall of one boulder.

use std::collections::BTreeSet;

use ndda_io::scene::{CountingLine, Material, Rockfall, Scene};
use ndda_mesh::Vec3;
use ndda_solver::Simulation;
use serde::{Deserialize, Serialize};

use super::accuracy::Accuracy;
use super::boulder::Boulder;
use super::contact::BOULDER;
use super::draw::{Draw, FRICTIONS_DEG, Of, RESTITUTIONS};
use super::passage::{Moment, crossing, distance_m};
use super::terrain::Terrain;
use super::window::{self, Cells, Laws, Motion};
use super::{release, stopped};

/// Longest step where the scene does not say [s].
const STEP_S: f64 = 2e-3;
/// Stiffness of contact over ρ v²/D, with which a cube that hits with a corner at the speed v is 5 % of its width deep: ½ ρ D³ v² = k z⁴/8 for the depth z of the
/// corner, and z/√3 below the nearest face.
const STIFFNESS: f64 = 7.2e4;

/// Parts of a step near the ground; steps on the way to the ground from which on it is near, and on the way from it.
const NEAR_PARTS: f64 = 8.0;
const NEAR_STEPS: f64 = 2.0;
const FAR_STEPS: f64 = 4.0;
/// Energy that a step may gain, as a part of the largest energy of the whole fall: what a slow boulder gains matters little to its fall.
const STEP_ENERGY: f64 = 1e-4;
/// The same as a part of the largest energy in the present window, which a step must not exceed either.
const MOST_STEP_ENERGY: f64 = 0.02;

/// How a fall ended.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum End {
    /// The boulder came to rest.
    Rest,
    /// It reached the end of the terrain.
    LeftTerrain,
    /// It was still moving when the time was up.
    StillMoving,
    /// The computation could not go on.
    Stopped(String),
}

/// The fall of a boulder.
#[derive(Clone, Debug, PartialEq)]
pub struct Fall {
    /// Its number, from 0.
    pub boulder: u32,
    /// Number of the release that it started from.
    pub release: usize,
    /// Its mass [kg].
    pub mass_kg: f64,
    /// Diameter of a sphere of the same volume [m].
    pub diameter_m: f64,
    /// How it ended.
    pub end: End,
    /// Its path, from the release to the end.
    pub path: Vec<Moment>,
    /// Largest speed [m/s], kinetic energy [J] and height above the ground [m] of all steps.
    pub largest: Largest,
    /// Lines that it crossed, by their numbers, in the order of time.
    pub passages: Vec<(usize, Moment)>,
    /// Cells of the map of reach that it was in, ascending.
    pub cells: Vec<u32>,
    /// How accurate it is.
    pub accuracy: Accuracy,
    /// Steps that it took.
    pub steps: u64,
}

/// The largest of all steps of a fall.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Largest {
    /// Speed of the mass centre [m/s].
    pub speed_m_s: f64,
    /// Kinetic energy [J].
    pub energy_j: f64,
    /// Height of the mass centre above the ground [m].
    pub height_m: f64,
}

impl Largest {
    fn see(&mut self, now: &Moment) {
        self.speed_m_s = self.speed_m_s.max(now.speed_m_s());
        self.energy_j = self.energy_j.max(now.energy_j());
        self.height_m = self.height_m.max(now.height_m);
    }
}

/// What all boulders have in common.
pub(super) struct Case<'a> {
    pub scene: &'a Scene,
    pub rockfall: &'a Rockfall,
    pub terrain: &'a Terrain,
    pub material: &'a Material,
    pub seed: u64,
    /// Distance of the points of a path [m], and most points.
    pub path_m: f64,
    pub most_points: usize,
    /// Side of the cells of the map of reach [m], and how many there are along x and y.
    pub cell_m: f64,
    pub cells: [usize; 2],
}

impl Case<'_> {
    /// The longest step [s].
    pub(super) fn step_s(&self) -> f64 {
        let step_s = self.scene.time.step_s;
        if step_s.is_nan() { STEP_S.min(self.scene.time.end_s) } else { step_s }
    }

    /// What a boulder and the ground do in contact.
    fn laws(&self, boulder: &Boulder, draw: &Draw) -> Laws {
        let Rockfall { ground, zones, detail, .. } = self.rockfall;
        let restitutions = std::iter::once(&ground.restitution).chain(zones.iter().map(|z| &z.restitution));
        let each = |(k, e)| draw.value(Of::Restitution, k, e, RESTITUTIONS);
        let restitution: Vec<f64> = restitutions.enumerate().map(each).collect();
        let frictions = std::iter::once(&ground.friction_deg).chain(zones.iter().map(|z| &z.friction_deg));
        let each = |(k, phi)| draw.value(Of::Friction, k, phi, FRICTIONS_DEG);
        let density_kg_m3 = self.material.density_kg_m3;
        Laws {
            penalty_pa: STIFFNESS * density_kg_m3 * detail.impact_m_s.powi(2) / boulder.diameter_m(),
            restitution: window::restitution_of(&restitution),
            friction_deg: frictions.enumerate().map(each).collect(),
            density_kg_m3,
            gravity_m_s2: self.scene.gravity_m_s2[2],
            step_s: self.step_s(),
            energy: STEP_ENERGY,
        }
    }

    /// The boulder with a number, and where it starts; its release is that of the list.
    fn released(&self, number: u32) -> (Boulder, usize, Result<Motion, String>, Draw) {
        let draw = Draw::new(self.seed, number);
        let boulder = Boulder::draw(&self.rockfall.boulders, self.material.density_kg_m3, &draw);
        let index = release::release_of(self.rockfall, number);
        let release = &self.rockfall.releases[index];
        let start = release::start((release, &boulder), number, self.terrain, &draw);
        (boulder, index, start, draw)
    }

    /// Why the boulder with a number cannot be released, and the place in the scene that says it.
    pub(super) fn refusal(&self, number: u32) -> Option<(String, String)> {
        let (_, release, start, _) = self.released(number);
        let [x, y] = match start {
            Ok(motion) => [motion.center.x, motion.center.y],
            Err(reason) => return Some((format!("rockfall.releases[{release}].place"), reason)),
        };
        let is_through =
            |line: &CountingLine| distance_m(&line.points_m, [x, y]) <= self.terrain.rounding_m();
        let k = self.rockfall.lines.iter().position(is_through)?;
        let reason = format!(
            "line `{}` passes through ({x:.3}, {y:.3}), where boulder {number} starts, so that rounding would decide whether it crosses the line: move one of them",
            self.rockfall.lines[k].name
        );
        Some((format!("rockfall.lines[{k}].points_m"), reason))
    }

    /// The fall of the boulder with a number.
    pub(super) fn fall(&self, number: u32) -> Fall {
        let (boulder, release, start, draw) = self.released(number);
        let fall = Fall {
            boulder: number,
            release,
            mass_kg: self.material.density_kg_m3 * boulder.volume_m3,
            diameter_m: boulder.diameter_m(),
            end: End::StillMoving,
            path: Vec::new(),
            largest: Largest::default(),
            passages: Vec::new(),
            cells: Vec::new(),
            accuracy: Accuracy::default(),
            steps: 0,
        };
        let mut motion = match start {
            Ok(motion) => motion,
            Err(reason) => return Fall { end: End::Stopped(reason), ..fall },
        };
        let mut laws = self.laws(&boulder, &draw);
        let mut largest_j = 0.0f64;
        let fall_mass_kg = fall.mass_kg;
        let mut watch = Watch {
            case: self,
            radius_m: boulder.radius_m,
            spacing_m: self.path_m,
            slow_since_s: None,
            cells: BTreeSet::new(),
            last: Moment::default(),
            fall,
        };
        let mut time_s = 0.0;
        let end = loop {
            let Some(cells) = Cells::around(self.terrain, &motion, boulder.radius_m) else {
                break End::LeftTerrain;
            };
            let span = Span::new(self, cells, &motion, boulder.radius_m);
            laws.step_s = if span.is_near { self.step_s() / NEAR_PARTS } else { self.step_s() };
            let now_j = 0.5 * fall_mass_kg * motion.velocity_m_s.norm_squared();
            largest_j = largest_j.max(now_j);
            laws.energy =
                (STEP_ENERGY * largest_j / now_j.max(f64::MIN_POSITIVE)).clamp(STEP_ENERGY, MOST_STEP_ENERGY);
            let set_up = window::simulation((self.terrain, cells), (&boulder.mesh.tets, &motion), &laws);
            let mut simulation = match set_up {
                Ok(simulation) => simulation,
                Err(reason) => break End::Stopped(reason),
            };
            let end = watch.within(&mut simulation, &span, time_s);
            time_s += simulation.time_s();
            motion = window::motion(&simulation);
            if let Some(end) = end {
                break end;
            }
        };
        watch.finish(end)
    }
}

/// The cells of a window, and whether the ground is near in it.
struct Span {
    cells: Cells,
    /// Cosine of the steepest slope.
    cosine: f64,
    /// Whether the boulder may touch the ground within a few steps: these are then shorter from the start. One that meets the ground in a long step would be
    /// deep in it before any force has acted, and how often it is halved depends on where in the step that happens.
    is_near: bool,
}

impl Span {
    fn new(case: &Case, cells: Cells, motion: &Motion, radius_m: f64) -> Self {
        let ground_m =
            case.terrain.at([motion.center.x, motion.center.y]).map_or(motion.center.z, |(z, _)| z);
        let mut span = Self { cells, cosine: cells.steepest_cosine(case.terrain), is_near: false };
        let clearance_m = span.clearance_m(motion.center.z - ground_m, radius_m);
        span.is_near = clearance_m < NEAR_STEPS * case.step_s() * motion.velocity_m_s.norm();
        span
    }

    /// Least distance from the ground of a boulder whose centre is at a height above it [m].
    fn clearance_m(&self, height_m: f64, radius_m: f64) -> f64 {
        self.cosine * height_m - radius_m
    }

    /// Whether steps have another length at this distance from the ground.
    fn is_over(&self, clearance_m: f64, way_m: f64) -> bool {
        if self.is_near { clearance_m > FAR_STEPS * way_m } else { clearance_m < NEAR_STEPS * way_m }
    }
}

/// What is noted while a boulder falls.
struct Watch<'a> {
    case: &'a Case<'a>,
    radius_m: f64,
    /// Distance of the points of the path [m].
    spacing_m: f64,
    slow_since_s: Option<f64>,
    cells: BTreeSet<u32>,
    last: Moment,
    fall: Fall,
}

impl Watch<'_> {
    /// Steps until the boulder leaves the cells or steps have another length, where the answer is none, or it ends its fall.
    fn within(&mut self, simulation: &mut Simulation, span: &Span, since_s: f64) -> Option<End> {
        if self.fall.path.is_empty() {
            self.last = self.moment(simulation, 0.0);
            self.fall.largest.see(&self.last);
            self.keep();
        }
        let mut touches = false;
        let end = loop {
            touches = match simulation.step() {
                Ok(report) => report.contact.contact_pairs > 0,
                Err(error) => break Some(End::Stopped(stopped::why(&error))),
            };
            self.fall.steps += 1;
            let end = self.see(simulation, since_s + simulation.time_s(), touches);
            if end.is_some() {
                break end;
            }
            let center = Vec3::from(self.last.at_m);
            let more = if touches { 0.0 } else { window::FEW_CELLS };
            let clearance_m = span.clearance_m(self.last.height_m, self.radius_m);
            let way_m = self.case.step_s() * self.last.speed_m_s();
            if !span.cells.hold(self.case.terrain, &center, self.radius_m, more)
                || (!touches && span.is_over(clearance_m, way_m))
            {
                break None;
            }
        };
        // What cannot be sampled has stopped the run already.
        if let Ok(sample) = simulation.sample() {
            self.fall.accuracy.add(simulation, &sample, touches);
        }
        end
    }

    /// Takes note of a step; the end of the fall, if it is one.
    fn see(&mut self, simulation: &Simulation, time_s: f64, touches: bool) -> Option<End> {
        let now = self.moment(simulation, time_s);
        let before = std::mem::replace(&mut self.last, now);
        self.fall.largest.see(&now);
        for (k, line) in self.case.rockfall.lines.iter().enumerate() {
            if let Some(part) = crossing(&line.points_m, before.map_m(), now.map_m()) {
                self.fall.passages.push((k, before.towards(&now, part)));
            }
        }
        self.cells.extend(self.cell(now.map_m()));
        let kept = self.fall.path.last().map_or([f64::INFINITY; 3], |moment| moment.at_m);
        if (Vec3::from(kept) - Vec3::from(now.at_m)).norm() >= self.spacing_m {
            self.keep();
        }
        let Some((ground_m, _)) = self.case.terrain.at(now.map_m()) else { return Some(End::LeftTerrain) };
        if now.at_m[2] < ground_m - 2.0 * self.radius_m {
            let reason = "the boulder went through the ground: raise rockfall.detail.impact_m_s".to_string();
            return Some(End::Stopped(reason));
        }
        if self.rests(simulation, time_s, touches) {
            return Some(End::Rest);
        }
        (time_s >= self.case.scene.time.end_s).then_some(End::StillMoving)
    }

    /// Whether no point has been fast for long enough, from one step in which the boulder touched the ground to another: in the air it may be slow for a while.
    fn rests(&mut self, simulation: &Simulation, time_s: f64, touches: bool) -> bool {
        let rest = &self.case.rockfall.rest;
        let nodes = simulation.blocks().nodes_of(BOULDER);
        let velocity = &simulation.state().velocity[nodes];
        if velocity.iter().any(|v| v.norm_squared() > rest.speed_m_s * rest.speed_m_s) {
            self.slow_since_s = None;
            return false;
        }
        touches && time_s - *self.slow_since_s.get_or_insert(time_s) >= rest.over_s
    }

    /// Keeps this moment in the path; where there are too many, every second of them is dropped, from then on.
    fn keep(&mut self) {
        let path = &mut self.fall.path;
        path.push(self.last);
        if path.len() > self.case.most_points {
            let mut k = 0;
            path.retain(|_| {
                k += 1;
                k % 2 == 1
            });
            self.spacing_m *= 2.0;
        }
    }

    /// The cell of the map of reach that a place is in.
    fn cell(&self, at_m: [f64; 2]) -> Option<u32> {
        let [nx, ny] = self.case.cells;
        let origin = self.case.terrain.origin_m;
        let [i, j] = [0, 1].map(|axis| ((at_m[axis] - origin[axis]) / self.case.cell_m).floor());
        let is_on_map = i >= 0.0 && j >= 0.0 && i < nx as f64 && j < ny as f64;
        is_on_map.then(|| j as u32 * nx as u32 + i as u32)
    }

    fn moment(&self, simulation: &Simulation, time_s: f64) -> Moment {
        let (blocks, state) = (simulation.blocks(), simulation.state());
        let nodes = blocks.nodes_of(BOULDER);
        let (position, velocity) = (&state.position[nodes.clone()], &state.velocity[nodes]);
        let operator = &simulation.shape(BOULDER).operator;
        let center = operator.center(position) + blocks.origin_m;
        let mean = operator.center(velocity);
        let ground_m = self.case.terrain.at([center.x, center.y]).map_or(f64::NAN, |(z, _)| z);
        let top = position.iter().map(|x| x.z).fold(f64::NEG_INFINITY, f64::max) + blocks.origin_m.z;
        let translation_j = 0.5 * operator.mass_kg * mean.norm_squared();
        // Rounding may leave less than nothing.
        let rotation_j = (operator.kinetic_energy_j(velocity) - translation_j).max(0.0);
        Moment {
            time_s,
            at_m: center.into(),
            velocity_m_s: mean.into(),
            height_m: center.z - ground_m,
            top_m: top - ground_m,
            translation_j,
            rotation_j,
        }
    }

    fn finish(mut self, end: End) -> Fall {
        if self.fall.path.last() != Some(&self.last) {
            self.fall.path.push(self.last);
        }
        // Beyond the terrain there is no height.
        self.fall.path.retain(|moment| moment.height_m.is_finite());
        self.fall.cells = self.cells.into_iter().collect();
        self.fall.end = end;
        self.fall.accuracy.close(self.fall.largest.energy_j);
        self.fall
    }
}
