//! Pictures of blocks in three dimensions, drawn by the program itself: no browser, no graphics card, the same bits on any machine.
//!
//! | module | contents |
//! |---|---|
//! | `camera` | parallel projection |
//! | `film`, `from_run`, `from_scene` | blocks, their colours, and the moments of a run |
//! | `stage` | what is in view, and which blocks are seen through |
//! | `raster`, `paint` | triangles and edges as pixels; colours and light |
//! | `bolts`, `bolt_lines` | bolts, and their lines over the blocks |
//! | `overlay`, `numbers` | title, scale of colours, axes, scale bar |
//! | `image`, `animation` | a picture, an animation |

#[cfg(feature = "png")]
mod animation;
mod bolt_lines;
pub(crate) mod bolts;
mod camera;
mod error;
mod film;
mod from_run;
mod from_scene;
mod image;
mod numbers;
mod overlay;
mod paint;
mod raster;
mod stage;
#[cfg(test)]
mod testing;

use std::fmt;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use ndda_io::WriteError;
use ndda_mesh::BlockSet;
use serde::Serialize;

use crate::numbers::counted;
pub use bolts::BoltColour;
pub use camera::View;
pub use error::ViewError;
use film::Film;
pub use from_run::{FrameChoice, Frames};
pub use image::Look;
use image::{LARGEST_PX, MOST_PX, Picture, SMALLEST_PX};
pub(crate) use paint::viridis;
pub use stage::Resting;

/// Quantity that blocks are coloured by.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Colour {
    /// Distance from the first frame.
    Displacement,
    /// Speed.
    Velocity,
    /// Von Mises stress.
    Stress,
    /// A colour per block.
    Block,
    /// A colour per material.
    Material,
    /// A colour per joint or set of joints, of a scene.
    Joint,
    /// An array of the frames, by its name or the beginning of it.
    Field(String),
}

impl FromStr for Colour {
    type Err = std::convert::Infallible;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        Ok(match text {
            "displacement" | "displacement_m" => Self::Displacement,
            "velocity" => Self::Velocity,
            "stress" => Self::Stress,
            "block" => Self::Block,
            "material" => Self::Material,
            "joint" => Self::Joint,
            other => Self::Field(other.into()),
        })
    }
}

impl fmt::Display for Colour {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(match self {
            Self::Displacement => "displacement",
            Self::Velocity => "velocity",
            Self::Stress => "stress",
            Self::Block => "block",
            Self::Material => "material",
            Self::Joint => "joint",
            Self::Field(name) => name,
        })
    }
}

/// A picture to draw.
#[derive(Clone, Debug, PartialEq)]
pub struct Request {
    /// Output folder of a run, or a scene file.
    pub input: PathBuf,
    /// Values of a scene that are replaced, `path=value`.
    pub overrides: Vec<String>,
    /// Frames of a run.
    pub frames: Frames,
    /// Colours; displacement of a run and blocks of a scene if none are requested.
    pub colour: Option<Colour>,
    /// How it looks.
    pub look: Look,
    /// Pictures of an animation in a second.
    pub per_second: u16,
}

/// The file that was written.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Written {
    /// The picture or animation.
    pub picture: PathBuf,
    /// Moments that it shows.
    pub frames: usize,
    /// Columns and rows [px].
    pub size: (u32, u32),
    /// Blocks.
    pub blocks: usize,
    /// Blocks that have moved, as the run counts them, or in a scene may.
    pub moving: usize,
    /// Blocks that can move, where a run says so.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub movable: Option<usize>,
    /// Whether it is of a scene before its run.
    #[serde(skip)]
    pub is_scene: bool,
    /// Bolts that it shows.
    #[serde(skip_serializing_if = "is_zero")]
    pub bolts: usize,
    /// Joints, and sets of them, that it shows in colours.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub joints: Option<usize>,
}

fn is_zero(count: &usize) -> bool {
    *count == 0
}

impl fmt::Display for Written {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self { picture, frames, size: (width, height), blocks, moving, movable, is_scene, bolts, joints } =
            self;
        write!(f, "{}: {width} x {height} pixels, ", picture.display())?;
        if *frames > 1 {
            write!(f, "{frames} frames, ")?;
        }
        if *bolts > 0 {
            write!(f, "{}, ", counted(*bolts, "bolt", "bolts"))?;
        }
        if let Some(joints) = joints {
            return write!(f, "{}", counted(*joints, "joint or set", "joints or sets"));
        }
        match movable {
            Some(movable) => {
                let blocks = counted(*movable, "movable block", "movable blocks");
                let whose = if *movable == 1 { "its radius" } else { "their radii" };
                write!(f, "{moving} of {blocks} moved by more than 1 % of {whose}")
            }
            None => write!(f, "{moving} of {blocks} blocks {}", if *is_scene { "may move" } else { "moved" }),
        }
    }
}

/// Draws a picture, or an animation where there are [`Frames::Most`], to a file.
///
/// # Errors
/// [`ViewError`] when the input cannot be used, the picture would be too large, or the file cannot be written.
pub fn draw(request: &Request, out: &Path) -> Result<Written, ViewError> {
    check_size(request.look.size)?;
    let is_animation = matches!(request.frames, Frames::Most(_));
    check_ending(out, is_animation)?;
    let film = read(request)?;
    check_bolts(&film, request.look.bolts)?;
    let (asked, most) = (request.look.magnify, film.largest_factor());
    if asked > most && asked > 1.0 {
        return Err(ViewError::Magnify { asked, most });
    }
    match is_animation {
        #[cfg(feature = "png")]
        true => animation::write(&film, request.look, request.per_second, out)?,
        _ => write_picture(&film, request.look, out)?,
    }
    let moving = film.moves.iter().filter(|moves| **moves).count();
    Ok(Written {
        joints: (request.colour == Some(Colour::Joint)).then_some(moving),
        bolts: if request.look.bolts == BoltColour::Hidden { 0 } else { film.bolt_count() },
        picture: out.to_path_buf(),
        frames: film.moments.len(),
        size: request.look.size,
        blocks: film.moves.len(),
        moving: film.moved.unwrap_or(moving),
        movable: film.movable,
        is_scene: film.moments[0].time_s.is_none(),
    })
}

/// The file where a picture of `input` is written if none is asked for: in the folder of a run, or in the present folder with the name
/// of the scene; an SVG picture without the feature `png`.
pub fn default_file(input: &Path, is_animation: bool) -> PathBuf {
    let ending = if cfg!(feature = "png") { "png" } else { "svg" };
    match input.is_dir() {
        true => input.join(if is_animation { "animation" } else { "picture" }).with_extension(ending),
        false => Path::new(input.file_stem().unwrap_or("scene".as_ref())).with_extension(ending),
    }
}

/// Draws blocks of no run, in a colour each.
///
/// # Errors
/// [`WriteError`] when the picture cannot be drawn or written.
pub fn draw_blocks(title: &str, blocks: &BlockSet, out: &Path) -> Result<(), WriteError> {
    write_picture(&from_scene::of_blocks(title, blocks), Look::default(), out).map_err(|error| match error {
        ViewError::Write(error) => error,
        other => WriteError::Encode { path: out.to_path_buf(), reason: other.to_string() },
    })
}

/// Columns and rows, as `1200x800`.
///
/// # Errors
/// An example, for another text.
pub fn parse_size(text: &str) -> Result<(u32, u32), String> {
    let sides =
        text.split_once('x').and_then(|(w, h)| Some((w.trim().parse().ok()?, h.trim().parse().ok()?)));
    sides.ok_or_else(|| "write columns and rows with an x between them, as 1200x800".into())
}

/// A factor of displacements, a finite number above 0.
///
/// # Errors
/// An example, for another text.
pub fn parse_factor(text: &str) -> Result<f64, String> {
    let factor = text.parse().ok().filter(|factor: &f64| factor.is_finite() && *factor > 0.0);
    factor.ok_or_else(|| "write a number above 0, as 100".into())
}

fn read(request: &Request) -> Result<Film, ViewError> {
    let Request { input, overrides, frames, colour, .. } = request;
    match (input.is_dir(), input.is_file()) {
        (true, _) if !overrides.is_empty() => Err(ViewError::HasRun(input.clone())),
        (true, _) => from_run::read(input, *frames, colour.as_ref().unwrap_or(&Colour::Displacement)),
        (_, true) if crate::stereonet::is_table(input) => Err(ViewError::Table(input.clone())),
        (_, true) => check_options_of_scene(request)
            .and_then(|()| from_scene::read(input, overrides, colour.as_ref().unwrap_or(&Colour::Block))),
        _ => Err(ViewError::NoInput(input.clone())),
    }
}

/// Refuses options that would change nothing in the picture of a scene.
fn check_options_of_scene(request: &Request) -> Result<(), ViewError> {
    match (request.frames, request.look.magnify) {
        (Frames::Most(_), _) => Err(ViewError::Still),
        _ if !request.look.outlines => Err(ViewError::NotRun("--no-outlines")),
        (Frames::One(frame), _) if frame != FrameChoice::Auto => Err(ViewError::NotRun("--frame")),
        (_, factor) if factor != 1.0 => Err(ViewError::NotRun("--magnify")),
        _ => Ok(()),
    }
}

/// Refuses colours of bolts that are not there, or that carry nothing before a run.
fn check_bolts(film: &Film, asked: BoltColour) -> Result<(), ViewError> {
    let says_forces = matches!(asked, BoltColour::Yield | BoltColour::State);
    match asked {
        BoltColour::Force => Ok(()),
        _ if film.bolt_count() == 0 => Err(ViewError::Bolts("there are no bolts: leave it out")),
        _ if says_forces && film.moments[0].time_s.is_none() => Err(ViewError::Bolts(
            "bolts carry nothing before the run: choose plain or hidden, or name the output folder of a run",
        )),
        _ => Ok(()),
    }
}

fn check_size((width, height): (u32, u32)) -> Result<(), ViewError> {
    let sides = SMALLEST_PX..=LARGEST_PX;
    let fits = sides.contains(&width) && sides.contains(&height) && width * height <= MOST_PX;
    if fits { Ok(()) } else { Err(ViewError::Size { width, height }) }
}

fn check_ending(path: &Path, is_animation: bool) -> Result<(), ViewError> {
    let path_buf = || path.to_path_buf();
    match path.extension().and_then(|ending| ending.to_str()).unwrap_or("") {
        "png" | "apng" | "webm" | "mp4" if !cfg!(feature = "png") => Err(ViewError::NoPng(path_buf())),
        _ if is_animation && !cfg!(feature = "png") => Err(ViewError::NoPng(path_buf())),
        #[cfg(feature = "png")]
        _ if is_animation => Ok(()),
        "svg" | "png" => Ok(()),
        _ => Err(ViewError::Ending { path: path_buf(), what: "a picture", endings: ".png or .svg" }),
    }
}

fn write_picture(film: &Film, look: Look, out: &Path) -> Result<(), ViewError> {
    let picture = Picture::new(film, look);
    let encode = |reason| ViewError::Encode { path: out.to_path_buf(), reason };
    let moment = &film.moments[film.moments.len() - 1];
    let bytes = match out.extension().is_some_and(|ending| ending == "svg") {
        true => picture.svg(moment).map_err(encode)?.into_bytes(),
        #[cfg(feature = "png")]
        false => {
            let rgba = picture.rgba(&picture.stage(1), moment).map_err(encode)?;
            image::opaque_png(look.size, &rgba).map_err(encode)?
        }
        #[cfg(not(feature = "png"))]
        false => return Err(ViewError::NoPng(out.to_path_buf())),
    };
    Ok(ndda_io::atomic::write_named(out, &bytes)?)
}
