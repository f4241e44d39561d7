//! Blocks of the output folder of a run.

use std::path::{Path, PathBuf};
use std::str::FromStr;

use ndda_io::OutputFolder;
use ndda_io::results::{FieldFrame, ListedFrame};
use ndda_mesh::Vec3;
use ndda_mesh::geometry::Aabb;

use super::Colour;
use super::bolts::{self, Piece};
use super::error::ViewError;
use super::film::{Colouring, Film, Moment, moved, moving, range};
use crate::field::{Field, Place, fields};
use crate::frames::{OtherBlocks, same_blocks, thinned};
use crate::summary::Summary;
use crate::surface::Surface;

/// Folder of the failing run in the output folder of `ndda safety`.
const MECHANISM: &str = "mechanism";
/// Array of velocities, in which blocks at rest have no colour.
const VELOCITY: &str = "velocity_m_s";
/// A mechanism is seen when a block has gone this part of its size.
const SEEN: f64 = 0.1;

/// Which frame of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum FrameChoice {
    /// The last; of a mechanism that `ndda safety` found, the first at which a block has gone a tenth of its size.
    #[default]
    Auto,
    /// The last.
    Last,
    /// By its number, from 0.
    Number(usize),
    /// The nearest to a time [s].
    Time(f64),
}

impl FromStr for FrameChoice {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let time = text.strip_suffix('s').and_then(|seconds| seconds.trim().parse().ok());
        match (text, text.parse(), time) {
            ("auto", ..) => Ok(Self::Auto),
            ("last", ..) => Ok(Self::Last),
            ("first", ..) => Ok(Self::Number(0)),
            (_, Ok(number), _) => Ok(Self::Number(number)),
            (_, _, Some(time_s)) if f64::is_finite(time_s) => Ok(Self::Time(time_s)),
            _ => Err("write last, first, the number of a frame from 0 (12), or a time with its unit (0.35s)"
                .into()),
        }
    }
}

impl std::fmt::Display for FrameChoice {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        match self {
            Self::Auto => write!(f, "auto"),
            Self::Last => write!(f, "last"),
            Self::Number(number) => write!(f, "{number}"),
            Self::Time(time_s) => write!(f, "{time_s}s"),
        }
    }
}

/// The frames of a run that are drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Frames {
    /// One of them.
    One(FrameChoice),
    /// At most so many, evenly spaced, the first and the last among them.
    Most(usize),
}

/// Reads the blocks of a run.
///
/// # Errors
/// [`ViewError`] when the folder has no frames, a frame is damaged or of another run, or there is no such frame or field.
pub fn read(folder: &Path, frames: Frames, colour: &Colour) -> Result<Film, ViewError> {
    let folder = &with_frames(folder)?;
    let listed = ListedFrame::read_all(&folder.join(OutputFolder::FIELDS_INDEX))?;
    let first_listed = listed.first().ok_or_else(|| ViewError::NoFrames { folder: folder.clone() })?;
    let first = FieldFrame::read(&first_listed.path)?;
    let surface = Surface::new(&first);
    let start = positions(&first, &surface, &first_listed.path)?;
    let source = Source::find(colour, &first, &surface)?;
    let bolt_frames = bolts::listed(folder)?;
    let mut moments = Vec::new();
    let shown = match frames {
        Frames::One(FrameChoice::Auto) if folder.ends_with(MECHANISM) => {
            vec![seen(&listed, &first, &surface)?]
        }
        _ => chosen(frames, &listed)?,
    };
    for index in shown {
        let ListedFrame { time_s, path } = &listed[index];
        let frame = FieldFrame::read(path)?;
        same_blocks(path, &first, &frame, &[])?;
        let positions = positions(&frame, &surface, path)?;
        let values = source.values(path, &frame, &surface, [&start, &positions])?;
        let (absent, bolts) = (surface.absent(&frame), bolts::at(&bolt_frames, index, *time_s)?);
        let bolts = bolts.iter().map(Piece::from).collect();
        moments.push(Moment { time_s: Some(*time_s), positions, absent, values, bolts });
    }
    let moves = moving(&surface, &start, &moments);
    let colouring = source.colouring(&surface, &moves, &moments);
    let motion = Summary::read(&folder.join(OutputFolder::SUMMARY)).ok().and_then(|summary| summary.motion);
    let last = moments.last().expect("at least one frame is chosen");
    let is_end = listed.last().map(|listed| listed.time_s) == last.time_s;
    let moved = match &motion {
        // Of stages, a run counts from the last that begins anew.
        Some(motion) if is_end => motion.moved,
        _ => moved(&surface, &start, last),
    };
    let movable = motion.map(|motion| motion.can_move);
    Ok(Film { title: title(folder), surface, start, moves, colouring, moments, moved: Some(moved), movable })
}

/// The folder itself, or that of the failing run in it, which `ndda safety` writes.
fn with_frames(folder: &Path) -> Result<PathBuf, ViewError> {
    let candidates = [folder.to_path_buf(), folder.join(MECHANISM)];
    let found = candidates.into_iter().find(|folder| folder.join(OutputFolder::FIELDS_INDEX).is_file());
    found.ok_or_else(|| ViewError::NoFrames { folder: folder.to_path_buf() })
}

/// The title in the summary; the name of the folder while there is none.
fn title(folder: &Path) -> String {
    let name = || folder.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    match Summary::read(&folder.join(OutputFolder::SUMMARY)) {
        Ok(summary) if !summary.title.trim().is_empty() => summary.title,
        _ => name(),
    }
}

/// The numbers of the frames.
fn chosen(frames: Frames, listed: &[ListedFrame]) -> Result<Vec<usize>, ViewError> {
    let last = listed.len() - 1;
    let distance = |frame: &ListedFrame, time_s: f64| (frame.time_s - time_s).abs();
    match frames {
        Frames::Most(most) => Ok(thinned(listed.len(), most)),
        Frames::One(FrameChoice::Last | FrameChoice::Auto) => Ok(vec![last]),
        Frames::One(FrameChoice::Number(number)) if number <= last => Ok(vec![number]),
        Frames::One(FrameChoice::Time(time_s))
            if (0.0..=listed[last].time_s * (1.0 + 1e-9)).contains(&time_s) =>
        {
            let nearer = |a: &usize, b: &usize| {
                distance(&listed[*a], time_s).total_cmp(&distance(&listed[*b], time_s))
            };
            Ok((0..=last).min_by(nearer).into_iter().collect())
        }
        Frames::One(asked) => Err(ViewError::NoFrame {
            asked: asked.to_string(),
            count: listed.len(),
            last_s: listed[last].time_s,
        }),
    }
}

/// The first frame at which a block has gone a part of its size; the last where none has.
fn seen(listed: &[ListedFrame], first: &FieldFrame, surface: &Surface) -> Result<usize, ViewError> {
    let start = positions(first, surface, &listed[0].path)?;
    let mut bounds = vec![Aabb::empty(); surface.block_count()];
    for (corners, &block) in surface.triangles.iter().zip(&surface.blocks) {
        corners.iter().for_each(|&n| bounds[block as usize].grow(&start[n as usize]));
    }
    for (index, ListedFrame { path, .. }) in listed.iter().enumerate() {
        let frame = FieldFrame::read(path)?;
        same_blocks(path, first, &frame, &[])?;
        let now = positions(&frame, surface, path)?;
        let has_gone = |(corners, &block): (&[u32; 3], &u32)| {
            let moved = (now[corners[0] as usize] - start[corners[0] as usize]).norm();
            moved > SEEN * bounds[block as usize].diagonal()
        };
        if surface.triangles.iter().zip(&surface.blocks).any(has_gone) {
            return Ok(index);
        }
    }
    Ok(listed.len() - 1)
}

fn positions(frame: &FieldFrame, surface: &Surface, path: &Path) -> Result<Vec<Vec3>, ViewError> {
    let bad = surface.nodes.iter().find(|&&n| frame.points[n as usize].iter().any(|x| !x.is_finite()));
    match bad {
        Some(&node) => Err(ViewError::NotFinite { path: path.to_path_buf(), node: node as usize }),
        None => Ok(surface.nodes.iter().map(|&n| frame.points[n as usize]).collect()),
    }
}

/// Where the colours come from.
enum Source {
    Displacement,
    Array { field: Field, numbers: usize, with_resting: bool },
    Groups { of_block: Vec<u32>, plural: &'static str, with_resting: bool },
}

impl Source {
    fn find(colour: &Colour, frame: &FieldFrame, surface: &Surface) -> Result<Self, ViewError> {
        let of_array = |name: &str, advice: &'static str| {
            let fields = fields(frame);
            let begins = |field: &&Field| field.array.starts_with(name) || field.label.starts_with(name);
            let names = || fields.iter().map(|field| field.array.clone()).collect();
            let no_field = || ViewError::NoField { asked: colour.to_string(), advice, names: names() };
            let field = fields.iter().find(begins).cloned().ok_or_else(no_field)?;
            let numbers = field.array_of(frame).map_or(0, |array| array.values.len());
            let with_resting = field.array != VELOCITY;
            Ok(Self::Array { field, numbers, with_resting })
        };
        match colour {
            Colour::Displacement => Ok(Self::Displacement),
            Colour::Velocity => of_array(VELOCITY, ": add Velocity to output.fields of the scene"),
            Colour::Stress => of_array("von Mises", ": add VonMises or Stress to output.fields of the scene"),
            Colour::Joint => Err(ViewError::JointsOfRun),
            Colour::Field(name) => of_array(name, ""),
            Colour::Block => {
                let of_block = (0..surface.block_count() as u32).collect();
                Ok(Self::Groups { of_block, plural: "blocks", with_resting: false })
            }
            Colour::Material => Self::materials(frame, surface).ok_or_else(|| ViewError::NoField {
                asked: colour.to_string(),
                advice: ": add Material to output.fields of the scene",
                names: fields(frame).into_iter().map(|field| field.array).collect(),
            }),
        }
    }

    /// The material of each block, by that of a tetrahedron behind its surface.
    fn materials(frame: &FieldFrame, surface: &Surface) -> Option<Self> {
        let numbers = &frame.cell_data.get("material")?.values;
        let mut of_block = vec![0; surface.block_count()];
        for (&tet, &block) in surface.tets.iter().zip(&surface.blocks) {
            of_block[block as usize] = *numbers.get(tet as usize)? as u32;
        }
        Some(Self::Groups { of_block, plural: "materials", with_resting: true })
    }

    /// Values of a frame.
    fn values(
        &self,
        path: &Path,
        frame: &FieldFrame,
        surface: &Surface,
        [start, now]: [&[Vec3]; 2],
    ) -> Result<Vec<f32>, ViewError> {
        match self {
            Self::Groups { .. } => Ok(Vec::new()),
            Self::Displacement => Ok(now.iter().zip(start).map(|(x, x0)| (x - x0).norm() as f32).collect()),
            Self::Array { field, numbers, .. } => match field.array_of(frame) {
                Some(array) if array.values.len() == *numbers => Ok(field.values(array, surface)),
                other => Err(OtherBlocks {
                    path: path.to_path_buf(),
                    what: format!("numbers in {}", field.array),
                    found: other.map_or(0, |array| array.values.len()),
                    needed: *numbers,
                }
                .into()),
            },
        }
    }

    /// Colours with the range of what is drawn in them. Where nothing has moved all blocks have the colour of their value.
    fn colouring(mut self, surface: &Surface, moves: &[bool], moments: &[Moment]) -> Colouring {
        if let (false, Self::Array { with_resting, .. } | Self::Groups { with_resting, .. }) =
            (moves.contains(&true), &mut self)
        {
            *with_resting = true;
        }
        let (label, unit, of_nodes, with_resting) = match self {
            Self::Groups { of_block, plural, with_resting } => {
                let count = of_block.iter().max().map_or(0, |&last| last as usize + 1);
                let word = plural.trim_end_matches('s');
                let names = (0..count).map(|i| format!("{word} {i}")).collect();
                return Colouring::Groups { names, plural, of_block, with_resting };
            }
            Self::Displacement => ("displacement".to_string(), "m", true, false),
            Self::Array { field, with_resting, .. } => {
                (field.label, field.unit, field.place == Place::Node, with_resting)
            }
        };
        let drawn: Vec<usize> = (0..surface.triangles.len())
            .filter(|&t| with_resting || moves[surface.blocks[t] as usize])
            .collect();
        let values = moments.iter().flat_map(|moment| {
            drawn.iter().flat_map(move |&t| match of_nodes {
                true => surface.triangles[t].map(|node| moment.values[node as usize]),
                false => [moment.values[t]; 3],
            })
        });
        let mut range = range(values);
        // Lengths and speeds are shown from rest on.
        if matches!(unit, "m" | "m/s") {
            range[0] = range[0].min(0.0);
        }
        Colouring::Scale { label, unit, of_nodes, with_resting, range }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn listed(times: &[f64]) -> Vec<ListedFrame> {
        times.iter().map(|&time_s| ListedFrame { time_s, path: PathBuf::new() }).collect()
    }

    #[test]
    fn frames_go_by_number_by_time_or_by_being_the_last() {
        let listed = listed(&[0.0, 0.1, 0.2, 0.3]);
        let one = |text: &str| chosen(Frames::One(text.parse().unwrap()), &listed);
        assert_eq!(one("last").unwrap(), [3]);
        assert_eq!(one("first").unwrap(), [0]);
        assert_eq!(one("2").unwrap(), [2]);
        assert_eq!(one("0.12s").unwrap(), [1]);
        assert_eq!(one("0.3 s").unwrap(), [3]);
        for text in ["4", "0.4s", "-1s"] {
            let error = one(text).unwrap_err().to_string();
            assert!(error.contains("4 frames, 0 to 3, of 0 s to 0.3 s"), "{error}");
        }
        for text in ["", "x", "0.5", "-1", "infs", "s"] {
            assert!(text.parse::<FrameChoice>().unwrap_err().contains("0.35s"), "{text}");
        }
    }
}
