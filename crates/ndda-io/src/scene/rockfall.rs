//! Rockfall of a scene: terrain, zones of ground, boulders and where they are released, lines at which they are counted.

use serde::{Deserialize, Serialize};

use super::study::Distribution;

/// Boulders that are released one by one over terrain; `ndda rockfall` runs them. Each moves until it rests, leaves the terrain, or `time.end_s` has
/// passed. `time.step_s` is then the longest step, 2 ms by default: steps are an eighth of it near the ground, and shorter while a boulder touches it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Rockfall {
    /// The ground.
    pub terrain: Ground,
    /// Ground outside of all zones.
    pub ground: GroundLaw,
    /// Parts of the terrain with ground of their own; where they overlap, the later one counts. Default: none.
    #[serde(default)]
    pub zones: Vec<Zone>,
    /// File of a grid with a class of ground, a whole number, for each cell, in the coordinates of the terrain's file: an ESRI ASCII grid (`.asc`) or another of the
    /// terrain's formats; path relative to the scene file. Zones name their `classes`. Default: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub class_grid: Option<String>,
    /// What falls.
    pub boulders: Boulders,
    /// Where boulders start; one after the other takes its boulder, as often as its `share` says.
    pub releases: Vec<Release>,
    /// How many boulders are released. Default: 100.
    #[serde(default = "hundred")]
    pub count: u32,
    /// Seed of all that is drawn. A boulder depends on it and on its own number, not on how many there are. Default: 1.
    #[serde(default = "one_seed")]
    pub seed: u64,
    /// Lines on the map at which boulders are counted and measured, such as a road or a barrier. Default: none.
    #[serde(default)]
    pub lines: Vec<CountingLine>,
    /// Corners of the profile on the map (x, y), along which results are given over the distance from its start [m]. Default: from the
    /// middle of the releases to the middle of the ends.
    #[serde(default)]
    pub profile_m: Vec<[f64; 2]>,
    /// When a boulder has come to rest.
    #[serde(default)]
    pub rest: RockfallRest,
    /// How the ground resists, and what is written.
    #[serde(default)]
    pub detail: RockfallDetail,
}

/// The ground of a rockfall: heights on a regular grid, two triangles in each cell.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub enum Ground {
    /// Heights in a file: an ESRI ASCII grid (`.asc`), points of a regular grid (`.xyz`, `.txt`, `.csv`), a GeoTIFF (`.tif`, `.tiff`), or a surface of triangles
    /// (`.stl`). A first line of names (x, east; y, north; z, height, …) says which columns of points are which; without one they are x, y, z.
    File {
        /// Path, relative to the scene file.
        file: String,
        /// Point (x, y) of the map that is (0, 0) in the scene [m]. Default: (0, 0).
        #[serde(default)]
        origin_m: [f64; 2],
        /// Distance of the heights that a surface of triangles is sampled at by vertical rays [m]; files of heights have their own. Default: a two-hundredth of the
        /// longer side of the surface.
        #[serde(default)]
        sample_m: Option<f64>,
    },
    /// Heights that are written out.
    Heights {
        /// Place of the first height (x, y) [m].
        origin_m: [f64; 2],
        /// Distance of heights along x and y [m].
        step_m: [f64; 2],
        /// Rows of heights along x, one row after the other along y [m].
        heights_m: Vec<Vec<f64>>,
    },
}

/// How ground answers to a boulder.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct GroundLaw {
    /// Coefficient of restitution e from 0 to 1: speed along the normal of the ground after a central impact over that before.
    pub restitution: Scatter,
    /// Friction angle φ between boulder and ground [°]; what a boulder loses along the ground follows from it and from its spin.
    pub friction_deg: Scatter,
}

/// A part of the terrain with ground of its own, within an outline or of some classes of `class_grid`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Zone {
    /// Its name.
    pub name: String,
    /// Corners of its outline on the map (x, y) [m]; a triangle of the terrain is in the zone if its middle is. Default: none, it has `classes`.
    #[serde(default)]
    pub outline_m: Vec<[f64; 2]>,
    /// Classes of `class_grid`; a triangle of the terrain is in the zone if its middle is in a cell of one of them. Default: none, it has an outline.
    #[serde(default)]
    pub classes: Vec<u32>,
    /// Coefficient of restitution e from 0 to 1.
    pub restitution: Scatter,
    /// Friction angle φ between boulder and ground [°].
    pub friction_deg: Scatter,
}

/// A number that may differ from boulder to boulder, in the unit of its field.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Scatter {
    /// The same for all.
    Always(f64),
    /// Mean and standard deviation.
    Normal(f64, f64),
    /// Mean and standard deviation of the number itself, not of its logarithm.
    LogNormal(f64, f64),
    /// Least and largest value.
    Uniform(f64, f64),
    /// Least, most likely and largest value.
    Triangular(f64, f64, f64),
}

impl Scatter {
    /// The distribution; none for what is always the same.
    pub fn as_distribution(&self) -> Option<Distribution> {
        match *self {
            Self::Always(_) => None,
            Self::Normal(mean, deviation) => Some(Distribution::Normal(mean, deviation)),
            Self::LogNormal(mean, deviation) => Some(Distribution::LogNormal(mean, deviation)),
            Self::Uniform(least, largest) => Some(Distribution::Uniform(least, largest)),
            Self::Triangular(least, likeliest, largest) => {
                Some(Distribution::Triangular(least, likeliest, largest))
            }
        }
    }

    /// Least and largest value.
    pub fn ends(&self) -> (f64, f64) {
        match *self {
            Self::Always(value) => (value, value),
            Self::Normal(..) => (f64::NEG_INFINITY, f64::INFINITY),
            Self::LogNormal(..) => (f64::MIN_POSITIVE, f64::INFINITY),
            Self::Uniform(least, largest) | Self::Triangular(least, _, largest) => (least, largest),
        }
    }

    /// The value that half of all do not exceed.
    pub fn median(&self) -> f64 {
        match *self {
            Self::LogNormal(mean, deviation) => mean / (1.0 + (deviation / mean).powi(2)).sqrt(),
            Self::Triangular(least, likeliest, largest) => {
                let (rise, fall, width) = (likeliest - least, largest - likeliest, largest - least);
                if rise >= fall {
                    least + (0.5 * width * rise).sqrt()
                } else {
                    largest - (0.5 * width * fall).sqrt()
                }
            }
            _ => self.middle(),
        }
    }

    /// Mean, or likeliest value.
    pub fn middle(&self) -> f64 {
        match *self {
            Self::Always(value) => value,
            Self::Normal(mean, _) | Self::LogNormal(mean, _) => mean,
            Self::Uniform(least, largest) => 0.5 * (least + largest),
            Self::Triangular(_, likeliest, _) => likeliest,
        }
    }
}

/// What falls.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Boulders {
    /// Name of their material; its density counts, they do not deform.
    pub material: String,
    /// Size.
    pub size: BoulderSize,
    /// Least and largest size, in the unit of the size: the distribution is cut off there. Default: as it is.
    #[serde(default)]
    pub within: Option<(f64, f64)>,
    /// Shapes, of which each boulder has one at random. Default: random polyhedra of 14 faces with axes as 1 : 0.8 : 0.65.
    #[serde(default = "shapes")]
    pub shapes: Vec<BoulderShape>,
}

/// Size of boulders.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub enum BoulderSize {
    /// By the diameter of a sphere of the same volume.
    Diameter {
        /// Diameter [m].
        diameter_m: Scatter,
    },
    /// By volume.
    Volume {
        /// Volume [m³].
        volume_m3: Scatter,
    },
    /// By mass.
    Mass {
        /// Mass [kg].
        mass_kg: Scatter,
    },
}

/// Shape of boulders: convex, of at most 24 faces.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub enum BoulderShape {
    /// A box.
    Cuboid {
        /// Its edges relative to each other [-]. Default: (1, 1, 1).
        #[serde(default = "ones")]
        axes: [f64; 3],
    },
    /// A ball or ellipsoid of 20 triangles.
    Ellipsoid {
        /// Its axes relative to each other [-]. Default: (1, 1, 1).
        #[serde(default = "ones")]
        axes: [f64; 3],
    },
    /// A convex polyhedron with faces at random, another one for each boulder.
    Polyhedron {
        /// Number of faces, 6 to 24. Default: 14.
        #[serde(default = "fourteen")]
        faces: u32,
        /// Axes of the ellipsoid that its faces are about, relative to each other [-]. Default: (1, 0.8, 0.65).
        #[serde(default = "oblong")]
        axes: [f64; 3],
    },
}

/// Where boulders start, and how. They are turned at random.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Release {
    /// Its name.
    pub name: String,
    /// Where.
    pub place: ReleasePlace,
    /// Weight against the other releases [-]. Default: 1.
    #[serde(default = "super::one")]
    pub share: f64,
    /// Height of the lowest point of the boulder above the ground at its start [m]. Default: none, it touches the ground.
    #[serde(default)]
    pub height_m: Option<Scatter>,
    /// Speed at the start [m/s]. Default: none.
    #[serde(default)]
    pub speed_m_s: Option<Scatter>,
    /// Direction of the speed on the map, clockwise from north (y) [°]. Default: down the steepest slope at the start.
    #[serde(default)]
    pub azimuth_deg: Option<Scatter>,
    /// Dip of the speed below the horizontal [°]; negative is upward. Default: along the ground for a speed without `azimuth_deg`, else 0.
    #[serde(default)]
    pub dip_deg: Option<Scatter>,
    /// Rate of forward rotation about a horizontal axis across the speed, or across the steepest slope where there is none [rad/s]. Default: none.
    #[serde(default)]
    pub spin_rad_s: Option<Scatter>,
}

/// Where boulders start on the map.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum ReleasePlace {
    /// At points (x, y) [m], one after the other.
    Points(Vec<[f64; 2]>),
    /// Anywhere on a line through these corners (x, y) [m].
    Line(Vec<[f64; 2]>),
    /// Anywhere in the area within these corners (x, y) [m].
    Area(Vec<[f64; 2]>),
}

/// A line on the map at which boulders are counted.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct CountingLine {
    /// Its name.
    pub name: String,
    /// Its corners on the map (x, y) [m].
    pub points_m: Vec<[f64; 2]>,
}

/// When a boulder that touches the ground has come to rest.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default)]
pub struct RockfallRest {
    /// No point of it is faster than this [m/s] … Default: 0.2.
    pub speed_m_s: f64,
    /// … for this time [s]. Default: 0.5.
    pub over_s: f64,
}

impl Default for RockfallRest {
    fn default() -> Self {
        Self { speed_m_s: 0.2, over_s: 0.5 }
    }
}

/// How the ground resists, and what is written.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default)]
pub struct RockfallDetail {
    /// Speed along the normal of the ground up to which a boulder that hits with a corner goes no deeper than 5 % of its width [m/s]: the contact is as
    /// stiff as that takes. Larger values give shorter steps. Default: 15.
    pub impact_m_s: f64,
    /// Distance of the points that are kept of a path [m]. Default: half a step of the terrain, or less where it has few.
    pub path_m: Option<f64>,
    /// Side of the cells in which the probability of reach is counted [m]. Default: the step of the terrain.
    pub cell_m: Option<f64>,
    /// Length of the parts of the profile in which heights, speeds and energies are collected [m]. Default: a hundredth of the profile.
    pub part_m: Option<f64>,
}

impl Default for RockfallDetail {
    fn default() -> Self {
        Self { impact_m_s: 15.0, path_m: None, cell_m: None, part_m: None }
    }
}

fn hundred() -> u32 {
    100
}

fn one_seed() -> u64 {
    1
}

fn shapes() -> Vec<BoulderShape> {
    vec![BoulderShape::Polyhedron { faces: fourteen(), axes: oblong() }]
}

fn fourteen() -> u32 {
    14
}

fn ones() -> [f64; 3] {
    [1.0; 3]
}

fn oblong() -> [f64; 3] {
    [1.0, 0.8, 0.65]
}
