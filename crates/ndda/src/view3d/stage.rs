//! The blocks of a film on a pane: what is in view, and what is seen through.

use std::str::FromStr;

use ndda_mesh::Vec3;
use ndda_mesh::geometry::triangle_area_vector;

use super::bolts::Piece;
use super::camera::{Axes, Bounds, Camera, Pane, View};
use super::film::{Film, Moment};
use super::paint::{Theme, brightness};
use super::raster::{self, Edge, Face, Pixels, SAMPLES_PER_PIXEL, Solid, Style};

/// Surroundings of blocks that move, over the larger side of the room that they move in.
const SURROUNDINGS: f64 = 0.4;
/// Room around everything, over the larger side.
const MARGIN: f64 = 0.02;
/// Blocks at rest that hide more than this part of those that move are seen through.
const HIDDEN: f64 = 0.5;
/// Columns of the small picture that measures how much is hidden.
const TRIAL_PX: f64 = 160.0;
/// How much is seen of the faces and edges of blocks that are seen through.
const VEIL: [f64; 2] = [0.2, 0.42];
/// Everything is in view where that makes the picture less than so many times as small.
const NEARLY_ALL: f64 = 1.5;
/// Most blocks whose outlines at the start are drawn.
const MOST_OUTLINES: usize = 40;
/// How dark those are.
const OUTLINE_WEIGHT: f64 = 0.4;
/// Edges are as dark as this where blocks are many pixels large, and fainter where they are few.
const EDGE_WEIGHT: f64 = 0.85;
/// Size of blocks whose edges have half of that weight [px].
const SMALL_BLOCK_PX: f64 = 7.0;

/// How blocks at rest are drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Resting {
    /// Seen through where they hide most of what moves, else solid.
    #[default]
    Auto,
    /// As the others.
    Solid,
    /// Seen through.
    Clear,
    /// Left out.
    Hidden,
}

impl FromStr for Resting {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "auto" => Ok(Self::Auto),
            "solid" => Ok(Self::Solid),
            "clear" => Ok(Self::Clear),
            "hidden" => Ok(Self::Hidden),
            _ => Err("write auto, solid, clear or hidden".into()),
        }
    }
}

/// How blocks are brought on a pane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setting {
    /// Where the viewer stands.
    pub view: View,
    /// Blocks at rest.
    pub resting: Resting,
    /// Whether all blocks are in view, or else those that move.
    pub whole: bool,
    /// Displacements are drawn so many times as large.
    pub magnify: f64,
    /// Whether outlines show where blocks began, if few move.
    pub outlines: bool,
    /// Width of edges [px].
    pub edge_px: f64,
}

/// A film with its camera: the same for all moments.
pub struct Stage<'a> {
    film: &'a Film,
    theme: Theme,
    setting: Setting,
    /// The projection.
    pub camera: Camera,
    size: [usize; 2],
    style: Style,
    resting: Resting,
}

impl<'a> Stage<'a> {
    /// Chooses what is in view on a pane of so many pixels.
    pub fn new(film: &'a Film, setting: Setting, theme: Theme, size: [usize; 2]) -> Self {
        let axes = Axes::new(setting.view);
        let pane = Pane { x: 0.0, y: 0.0, width: size[0] as f64, height: size[1] as f64 };
        let camera = Camera::fit(axes, &in_view(film, &setting, &axes), &pane);
        let style =
            Style { theme, edge_px: setting.edge_px, edge_weight: edge_weight(film, &camera), veil: VEIL };
        let mut stage = Self { film, theme, setting, camera, size, style, resting: setting.resting };
        if !film.moves.contains(&true) {
            // Nothing is hidden or seen through where nothing moves.
            stage.resting = Resting::Solid;
        }
        if stage.resting == Resting::Auto {
            stage.resting = if stage.hides_motion() { Resting::Clear } else { Resting::Solid };
        }
        stage
    }

    /// Whether blocks at rest hide most of what moves at the last moment.
    fn hides_motion(&self) -> bool {
        let Some(moment) = self.film.moments.last() else { return false };
        let factor = TRIAL_PX / self.size[0].max(self.size[1]) as f64;
        let size = self.size.map(|side| (factor * side as f64).ceil() as usize);
        let camera = self.camera.scaled(factor);
        let solid = |moves: bool| self.solid(moment, &camera, |block| self.film.moves[block] == moves);
        raster::hidden_part(size, &solid(true), &solid(false), &self.style) > HIDDEN
    }

    /// The pixels of a moment.
    pub fn pixels(&self, moment: &Moment) -> Pixels {
        let camera = self.camera.scaled(SAMPLES_PER_PIXEL);
        let moves = |block: usize| self.film.moves[block];
        let (solid, veil) = match self.resting {
            Resting::Solid | Resting::Auto => (self.solid(moment, &camera, |_| true), Solid::default()),
            Resting::Hidden => (self.solid(moment, &camera, moves), Solid::default()),
            Resting::Clear => {
                (self.solid(moment, &camera, moves), self.solid(moment, &camera, |block| !moves(block)))
            }
        };
        let solid = self.with_outlines(solid, moment, &camera);
        raster::draw(self.size, &solid, &veil, &self.style)
    }

    /// With the edges that moving blocks had at the start, if they are few.
    fn with_outlines(&self, mut solid: Solid, moment: &Moment, camera: &Camera) -> Solid {
        let Film { surface, start, moves, .. } = self.film;
        let moving = moves.iter().filter(|moves| **moves).count();
        if !self.setting.outlines || moving > MOST_OUTLINES || moment.positions == *start {
            return solid;
        }
        let blocks = self.film.block_of_node();
        let began = surface.edges.iter().filter(|ends| moves[blocks[ends[0] as usize] as usize]);
        solid.edges.extend(began.map(|ends| Edge {
            ends: ends.map(|n| camera.project(&start[n as usize])),
            block: blocks[ends[0] as usize],
            weight: OUTLINE_WEIGHT * self.style.edge_weight,
        }));
        solid
    }

    /// Faces and edges of some blocks.
    fn solid(&self, moment: &Moment, camera: &Camera, holds: impl Fn(usize) -> bool) -> Solid {
        let Film { surface, .. } = self.film;
        let holds = |block: usize| holds(block) && moment.absent.binary_search(&(block as u32)).is_err();
        let places = shown_places(self.film, moment, self.setting.magnify);
        let projected: Vec<[f64; 3]> = places.iter().map(|x| camera.project(x)).collect();
        let Axes { right, up, towards } = camera.axes;
        let face = |triangle: usize| {
            let corners = surface.triangles[triangle];
            let normal = triangle_area_vector(&corners.map(|n| places[n as usize])).normalize();
            // Surfaces are closed: a face turned away is behind others.
            (normal.dot(&towards) > 0.0).then(|| Face {
                corners: corners.map(|n| projected[n as usize]),
                coat: self.film.coat(moment, triangle, &self.theme),
                brightness: brightness(&Vec3::new(normal.dot(&right), normal.dot(&up), normal.dot(&towards))),
                block: surface.blocks[triangle],
            })
        };
        let blocks = self.film.block_of_node();
        let held = (0..surface.triangles.len()).filter(|&t| holds(surface.blocks[t] as usize));
        let edge = |ends: &[u32; 2]| {
            let block = blocks[ends[0] as usize];
            let ends = ends.map(|n| projected[n as usize]);
            holds(block as usize).then_some(Edge { ends, block, weight: self.style.edge_weight })
        };
        Solid {
            faces: held.filter_map(face).collect(),
            edges: surface.edges.iter().filter_map(edge).collect(),
        }
    }
}

/// Positions with magnified displacements.
fn shown_places(film: &Film, moment: &Moment, magnify: f64) -> Vec<Vec3> {
    if magnify == 1.0 {
        return moment.positions.clone();
    }
    moment.positions.iter().zip(&film.start).map(|(x, x0)| x0 + magnify * (x - x0)).collect()
}

/// Bounds of the blocks that move and their surroundings, or of all blocks.
fn in_view(film: &Film, setting: &Setting, axes: &Axes) -> Bounds {
    let (mut all, mut moving) = (Bounds::EMPTY, Bounds::EMPTY);
    let blocks = film.block_of_node();
    let mut take = |places: &[Vec3]| {
        for (x, &block) in places.iter().zip(&blocks) {
            let (point, _) = axes.plane(x);
            let is_moving = film.moves[block as usize];
            if is_moving || setting.resting != Resting::Hidden || !film.moves.contains(&true) {
                all.grow(point);
            }
            if is_moving {
                moving.grow(point);
            }
        }
    };
    take(&film.start);
    film.moments.iter().for_each(|moment| take(&shown_places(film, moment, setting.magnify)));
    // Bolts are seen whole where a block that they hold is.
    let moves = |piece: &Piece| piece.block.is_some_and(|block| film.moves[block as usize]);
    for pieces in film.moments.iter().flat_map(|moment| moment.bolts.chunk_by(|a, b| a.bolt == b.bolt)) {
        let is_moving = pieces.iter().any(moves);
        for (point, _) in pieces.iter().flat_map(|piece| piece.ends).map(|end| axes.plane(&end)) {
            all.grow(point);
            if is_moving {
                moving.grow(point);
            }
        }
    }
    let near = moving.with_surroundings(SURROUNDINGS, &all);
    let [near_size, all_size] = [near.size(), all.size()];
    let smaller = (0..2).map(|i| all_size[i] / near_size[i]).fold(0.0, f64::max);
    let seen = if setting.whole || moving.is_empty() || smaller < NEARLY_ALL { all } else { near };
    let [width, height] = seen.size();
    let margin = MARGIN * width.max(height);
    Bounds { least: seen.least.map(|x| x - margin), most: seen.most.map(|x| x + margin) }
}

/// Fainter edges where blocks are small in the picture: s / (s + s₀) of the usual weight for a median size of s pixels.
fn edge_weight(film: &Film, camera: &Camera) -> f64 {
    let mut bounds = vec![Bounds::EMPTY; film.surface.block_count()];
    for (x, &block) in film.start.iter().zip(&film.block_of_node()) {
        bounds[block as usize].grow(camera.axes.plane(x).0);
    }
    let mut sizes: Vec<f64> =
        bounds.iter().filter(|b| !b.is_empty()).map(|b| b.size()[0].max(b.size()[1])).collect();
    sizes.sort_by(f64::total_cmp);
    let median = sizes.get(sizes.len() / 2).map_or(0.0, |size| size * camera.px_per_m);
    EDGE_WEIGHT * median / (median + SMALL_BLOCK_PX)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view3d::paint::LIGHT_THEME;
    use crate::view3d::testing::boxes;

    fn setting(view: &str) -> Setting {
        Setting {
            view: view.parse().unwrap(),
            resting: Resting::Auto,
            whole: false,
            magnify: 1.0,
            outlines: false,
            edge_px: 0.0,
        }
    }

    #[test]
    fn a_cube_seen_from_the_front_covers_a_square_in_the_middle() {
        let film = boxes(&[([0.0; 3], [1.0; 3], [0.0; 3])]);
        let stage = Stage::new(&film, setting("front"), LIGHT_THEME, [300, 208]);
        // One metre and a fiftieth on each side fill the rows.
        assert!((stage.camera.px_per_m - 200.0).abs() < 1e-9);
        let pixels = stage.pixels(&film.moments[0]);
        for (x, y) in (0..300).flat_map(|x| (0..208).map(move |y| (x, y))) {
            let inside = (50..250).contains(&x) && (4..204).contains(&y);
            assert_eq!(pixels.at(x, y) != LIGHT_THEME.background, inside, "{x} {y}");
        }
    }

    #[test]
    fn a_cube_covers_what_the_projection_of_its_corners_bounds_from_any_side() {
        // The shadow of a unit cube has the area |n_x| + |n_y| + |n_z| across a direction n.
        let film = boxes(&[([0.0; 3], [1.0; 3], [0.0; 3])]);
        for view in ["iso", "200,-35", "75,60"] {
            let stage = Stage::new(&film, setting(view), LIGHT_THEME, [400, 400]);
            let pixels = stage.pixels(&film.moments[0]);
            let covered = pixels.rgb.chunks(3).filter(|p| *p != LIGHT_THEME.background).count() as f64;
            let shadow = stage.camera.axes.towards.abs().sum() * stage.camera.px_per_m.powi(2);
            assert!((covered / shadow - 1.0).abs() < 0.01, "{view}: {covered} for {shadow}");
        }
    }

    #[test]
    fn the_picture_is_of_the_block_that_moves_where_others_are_far_larger() {
        let small = ([0.0, 0.0, 20.0], [1.0; 3], [0.5, 0.0, 0.0]);
        let film = boxes(&[([-50.0, -50.0, 0.0], [100.0, 100.0, 20.0], [0.0; 3]), small]);
        assert_eq!(film.moves, [false, true]);
        let scale = |whole: bool| {
            let setting = Setting { whole, ..setting("front") };
            Stage::new(&film, setting, LIGHT_THEME, [300, 300]).camera.px_per_m
        };
        assert!(scale(false) > 30.0 * scale(true), "{} {}", scale(false), scale(true));
    }

    #[test]
    fn blocks_at_rest_are_seen_through_only_where_they_hide_most_of_what_moves() {
        let (inner, outer) = (([0.0; 3], [1.0; 3], [0.1, 0.0, 0.0]), ([-1.0; 3], [3.0; 3], [0.0; 3]));
        let resting = |blocks: &[_]| {
            let film = boxes(blocks);
            Stage::new(&film, setting("iso"), LIGHT_THEME, [300, 300]).resting
        };
        assert_eq!(resting(&[inner, outer]), Resting::Clear);
        assert_eq!(resting(&[inner, ([0.0, 0.0, -2.0], [1.0; 3], [0.0; 3])]), Resting::Solid);
    }

    #[test]
    fn magnified_displacements_are_so_many_times_as_long() {
        let film = boxes(&[([0.0; 3], [1.0; 3], [0.01, 0.0, 0.0]), ([3.0, 0.0, 0.0], [1.0; 3], [0.0; 3])]);
        let moment = &film.moments[0];
        let moved = shown_places(&film, moment, 50.0);
        for (now, start) in moved.iter().zip(&film.start).filter(|(_, start)| start.x < 2.0) {
            assert!((now - start - Vec3::new(0.5, 0.0, 0.0)).norm() < 1e-12);
        }
    }
}
