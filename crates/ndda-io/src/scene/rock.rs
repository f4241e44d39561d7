//! Rock that is cut into blocks.

use serde::{Deserialize, Serialize};

use super::{Body, Fill, Pieces, one};

/// A piece of rock that is cut into blocks. They are named `rock_0001`, `rock_0002`, … after its name.
///
/// Rock is cut with x to the east, y to the north and z up. Blocks of a rock come after the explicit ones, in the order of the cut; their node sets
/// have the names of the joints and of the faces of the domain that bound them (`cells` between Voronoi cells). A column on a base:
///
/// ```text
/// rock: [
///     (
///         name: "column", material: "rock",
///         domain: Box(min_m: (0, 0, 0), max_m: (5, 5, 10)),
///         joints: [
///             Set(name: "bedding", dip_deg: 40, dip_direction_deg: 90, spacing_m: 2),
///             Set(name: "cross", dip_deg: 90, dip_direction_deg: 0, spacing_m: 2.5),
///         ],
///         fill: Centre,
///     ),
///     (name: "base", material: "rock", domain: Box(min_m: (-3, -3, -10), max_m: (8, 8, 0))),
/// ],
/// supports: [(block: "base_*", on: Set("z_min"), hold: Direction((0, 0, 1)))],
/// monitors: [(name: "largest_x", block: "column_*", at: Largest((1, 0, 0)))],
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Rock {
    /// Name, unique in the scene, that the names of the blocks begin with. Default: `rock`.
    #[serde(default = "rock")]
    pub name: String,
    /// Name of its material.
    pub material: String,
    /// The rock before it is cut.
    pub domain: Domain,
    /// Discontinuities that cut it, in this order: later ones meet smaller blocks. Default: none.
    #[serde(default)]
    pub joints: Vec<Discontinuity>,
    /// Cuts it into Voronoi cells instead. Default: none.
    #[serde(default)]
    pub voronoi: Option<Voronoi>,
    /// Seed of scatter, persistence and cells: the same seed gives the same blocks. Default: 0.
    #[serde(default)]
    pub seed: u64,
    /// Blocks thinner than this, or smaller than a cube of this width, are slivers [m]. Default: 0.
    #[serde(default)]
    pub sliver_width_m: f64,
    /// Treatment of slivers. Default: `Merge`.
    #[serde(default)]
    pub slivers: Slivers,
    /// How blocks are filled with tetrahedra. Default: `Fewest`.
    #[serde(default)]
    pub fill: Fill,
    /// Pieces that each block is taken apart into, which bonds hold together. Default: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub into: Option<Pieces>,
    /// How blocks may move. Default: `Elastic`.
    #[serde(default)]
    pub body: Body,
    /// Spaces that stages of construction excavate: their borders cut the rock beforehand, and are glued until then. Default: none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub excavations: Vec<Excavation>,
    /// Blocks that are taken out: an excavation. Default: none.
    #[serde(default)]
    pub removed: Vec<Whereabouts>,
    /// Blocks that stay where they are, as `body: Fixed`. Default: none.
    #[serde(default)]
    pub fixed: Vec<Whereabouts>,
}

/// Rock before it is cut. Its faces give the blocks their node sets, as joints do.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub enum Domain {
    /// A box; faces `x_min` to `z_max`.
    Box {
        /// Lowest corner [m].
        min_m: [f64; 3],
        /// Highest corner [m].
        max_m: [f64; 3],
    },
    /// An outline drawn along an axis; faces `side_0` from corner 0 to 1, …, `start` and `end`.
    Column {
        /// Corners in order, either way round, convex or not [m]: (y, z) along `X`, (x, z) along `Y`, (x, y) along `Z`.
        outline_m: Vec<[f64; 2]>,
        /// The axis. Default: `Z`.
        #[serde(default)]
        axis: Axis,
        /// Where it starts on the axis [m].
        start_m: f64,
        /// Where it ends [m].
        end_m: f64,
    },
    /// A body under flat faces; `face_0`, `face_1`, ….
    Polyhedron {
        /// Corners [m].
        corners_m: Vec<[f64; 3]>,
        /// Corners of each face, counter-clockwise seen from outside, counted from 0.
        faces: Vec<Vec<u32>>,
    },
    /// Rock under a closed surface in a file, STL, OBJ, VTK's `.vtp` or `.vtk`; its faces have the names that the file gives.
    File {
        /// Path, relative to the scene file.
        file: String,
        /// Metres per unit of the file. Default: 1.
        #[serde(default = "one")]
        unit_m: f64,
    },
    /// Rock under a grid of heights; faces `terrain`, `base` and `side`.
    Terrain {
        /// Place of the first height (x, y) [m].
        origin_m: [f64; 2],
        /// Distance of heights along x and y [m].
        step_m: [f64; 2],
        /// Rows of heights along x, one row after the other along y [m].
        heights_m: Vec<Vec<f64>>,
        /// Height of the base [m].
        base_m: f64,
    },
    /// Rock under heights in a file: an ESRI ASCII grid (`.asc`), points of a regular grid (`.xyz`, `.txt`, `.csv`), a GeoTIFF (`.tif`, `.tiff`), or a surface of
    /// triangles (`.stl`), sampled at a two-hundredth of its longer side; faces as of `Terrain`. Cells with a corner without height are left out.
    /// A first line of names (x, east; y, north; z, height, …) says which columns of points are which; without one they are x, y, z.
    TerrainFile {
        /// Path, relative to the scene file.
        file: String,
        /// Point (x, y) of the map that is (0, 0) in the scene [m]. Default: (0, 0).
        #[serde(default)]
        origin_m: [f64; 2],
        /// Height of the base [m].
        base_m: f64,
    },
}

/// Treatment of slivers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Slivers {
    /// Each is united with the neighbour with which it shares the largest face, provided that both together are convex; others stay. No
    /// void is left; the joint between the two is closed there. What stays is not united with what is `removed`.
    #[default]
    Merge,
    /// They are taken out, and leave voids, into which blocks may fall.
    Remove,
}

/// A coordinate axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Axis {
    /// East.
    X,
    /// North.
    Y,
    /// Up.
    #[default]
    Z,
}

/// Something that cuts rock. x is east, y north, z up; dip is below the plane of x and y, whatever gravity is, its direction clockwise from north.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub enum Discontinuity {
    /// Planes of one orientation, one spacing apart.
    Set {
        /// Name of the node sets on it.
        name: String,
        /// Dip, 0 to 90 [°].
        dip_deg: f64,
        /// Dip direction [°].
        dip_direction_deg: f64,
        /// Mean distance of planes along their normal [m].
        spacing_m: f64,
        /// A point of one of the planes [m]. Default: (0, 0, 0).
        #[serde(default)]
        origin_m: [f64; 3],
        /// Probability that a plane cuts a block that it crosses. Default: 1.
        #[serde(default = "one")]
        persistence: f64,
        /// Scatter of orientations. Default: none.
        #[serde(default)]
        orientation_scatter: OrientationScatter,
        /// Scatter of distances. Default: none.
        #[serde(default)]
        spacing_scatter: SpacingScatter,
    },
    /// One plane through all of the rock.
    Plane {
        /// Name of the node sets on it.
        name: String,
        /// Dip, 0 to 90 [°].
        dip_deg: f64,
        /// Dip direction [°].
        dip_direction_deg: f64,
        /// A point of it [m].
        point_m: [f64; 3],
    },
    /// A disc. A block is cut through and through or not at all, by the rule.
    Disc {
        /// Name of the node sets on it.
        name: String,
        /// Dip, 0 to 90 [°].
        dip_deg: f64,
        /// Dip direction [°].
        dip_direction_deg: f64,
        /// Centre [m].
        center_m: [f64; 3],
        /// Radius [m].
        radius_m: f64,
        /// Which blocks it cuts. Default: `Share(0.5)`.
        #[serde(default)]
        rule: DiscRule,
    },
    /// Discs from a table, a discrete fracture network (DFN). They cut in the order of their radius, largest first, whatever the
    /// order of the rows.
    Discs {
        /// Name of the node sets on discs whose row names no set; those of others go by their set. Default: `discs`.
        #[serde(default = "discs")]
        name: String,
        /// CSV file with the columns `dip_deg`, `dip_direction_deg`, `x_m`, `y_m`, `z_m`, `radius_m` and `set`, which may be left out;
        /// its path is relative to the scene file.
        file: String,
        /// Which blocks they cut. Default: `Share(0.5)`.
        #[serde(default)]
        rule: DiscRule,
    },
}

/// How planes of a set scatter about their mean orientation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub enum OrientationScatter {
    /// All planes are parallel.
    #[default]
    None,
    /// Poles tilt by a normally distributed angle about each of two axes.
    Normal {
        /// Standard deviation [°].
        deviation_deg: f64,
    },
    /// Fisher's distribution.
    Fisher {
        /// Concentration κ; 100 scatters by about 8°.
        kappa: f64,
    },
    /// Poles are uniform within an angle of the mean.
    Uniform {
        /// The angle [°].
        within_deg: f64,
    },
}

/// How distances of successive planes scatter about the spacing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub enum SpacingScatter {
    /// All are equal.
    #[default]
    None,
    /// Uniform about the spacing.
    Uniform {
        /// Half of the range, less than the spacing [m].
        half_width_m: f64,
    },
    /// Normal, at least a tenth of the spacing.
    Normal {
        /// Standard deviation [m].
        deviation_m: f64,
    },
    /// Exponential.
    Exponential,
}

/// Which blocks a disc cuts. Its plane cuts a block in a section, of which the disc covers a part.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum DiscRule {
    /// Blocks of whose section the disc covers at least this part of the area, 0 to 1.
    Share(f64),
    /// Blocks that the disc meets, however little of the section it covers.
    Meets,
    /// Blocks of which it covers the whole section: no cut is larger than the disc.
    Covers,
}

impl Default for DiscRule {
    fn default() -> Self {
        Self::Share(0.5)
    }
}

/// Voronoi cells of random points.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Voronoi {
    /// Number of points in the rock, and of cells; fewer fit when they keep too large a distance.
    pub count: u32,
    /// Distance that points keep where they can [m]. Default: 0.
    #[serde(default)]
    pub least_distance_m: f64,
}

/// Which blocks of a rock, by the place of their centroids.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub enum Whereabouts {
    /// Blocks in a box.
    Inside {
        /// Lowest corner [m].
        min_m: [f64; 3],
        /// Highest corner [m].
        max_m: [f64; 3],
    },
    /// Blocks on the side of a plane that its normal points to.
    Beyond {
        /// A point of the plane [m].
        point_m: [f64; 3],
        /// Its normal; its length does not matter.
        normal: [f64; 3],
    },
}

/// A space that stages of construction excavate: an outline drawn along an axis.
///
/// Blocks that it meets are cut along its border, and those inside are named after it, `heading_0001`, `heading_0002`, …, so that a stage can take out
/// `heading_*`. The faces of these cuts, and only these, are glued by bonds that no stress breaks: the rock behaves as before, until one side is taken out.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Excavation {
    /// Its name, unique among all excavations, rocks and joints.
    pub name: String,
    /// Corners in order, either way round, convex or not [m]: (y, z) along `X`, (x, z) along `Y`, (x, y) along `Z`.
    pub outline_m: Vec<[f64; 2]>,
    /// The axis. Default: `Z`.
    #[serde(default)]
    pub axis: Axis,
    /// Where it starts on the axis [m].
    pub start_m: f64,
    /// Where it ends [m].
    pub end_m: f64,
    /// Stiffness of the glue [Pa/m]. Default: that of normal contact there.
    #[serde(default)]
    pub glue_pa_m: Option<f64>,
}

impl Discontinuity {
    /// Its name; of discs from a table that of those without a set.
    pub fn name(&self) -> &str {
        match self {
            Self::Set { name, .. }
            | Self::Plane { name, .. }
            | Self::Disc { name, .. }
            | Self::Discs { name, .. } => name,
        }
    }

    /// Dip and dip direction [°], of a set the mean ones; none of discs from a table.
    pub fn orientation_deg(&self) -> Option<[f64; 2]> {
        match self {
            Self::Set { dip_deg, dip_direction_deg, .. }
            | Self::Plane { dip_deg, dip_direction_deg, .. }
            | Self::Disc { dip_deg, dip_direction_deg, .. } => Some([*dip_deg, *dip_direction_deg]),
            Self::Discs { .. } => None,
        }
    }
}

fn discs() -> String {
    "discs".into()
}

fn rock() -> String {
    "rock".into()
}
