//! Shapes of blocks.

use serde::{Deserialize, Serialize};

use super::one;

/// Shape and mesh of a block.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub enum Shape {
    /// A box with one corner at the origin.
    Box {
        /// Edge lengths [m].
        size_m: [f64; 3],
        /// Cells along each edge.
        cells: [u32; 3],
        /// How a cell is cut into tetrahedra. Default: `Six`.
        #[serde(default)]
        pattern: Pattern,
    },
    /// A triangle in the x-y plane extruded along z.
    Prism {
        /// Corners of the triangle, counter-clockwise [m].
        outline_m: [[f64; 2]; 3],
        /// Length of the extrusion [m].
        height_m: f64,
        /// Cells along each edge of the triangle, and along the height.
        cells: [u32; 2],
    },
    /// A box whose eight corners are anywhere: four below, counter-clockwise seen from above, then the four above them.
    Hexahedron {
        /// The corners [m].
        corners_m: [[f64; 3]; 8],
        /// Cells along x (corner 0 to 1), y (0 to 3) and z (0 to 4).
        cells: [u32; 3],
        /// How a cell is cut into tetrahedra. Default: `Six`.
        #[serde(default)]
        pattern: Pattern,
    },
    /// A stone of a circular arch about the y axis.
    Voussoir {
        /// Radius of the lower side [m].
        inner_radius_m: f64,
        /// Radius of the upper side [m].
        outer_radius_m: f64,
        /// Angle of the first joint from x towards z [°].
        start_deg: f64,
        /// Angle of the second joint [°].
        end_deg: f64,
        /// Extent along y, from 0 [m].
        width_m: f64,
        /// Cells along the radius, the width and the arc.
        cells: [u32; 3],
        /// How a cell is cut into tetrahedra. Default: `Six`.
        #[serde(default)]
        pattern: Pattern,
    },
    /// A cylinder about the z axis, from z = 0 up.
    Cylinder {
        /// Radius [m].
        radius_m: f64,
        /// Height [m].
        height_m: f64,
        /// Rings around the axis (the outline has 6 corners per ring) and layers.
        cells: [u32; 2],
    },
    /// A sphere about the origin, of 8^(levels + 1) tetrahedra. In contact with `Smooth` or `Closure`, which take at most 13 faces beside a tetrahedron, `levels` is at
    /// most 1; with `Element` and `Volume`, there may be more.
    Sphere {
        /// Radius [m].
        radius_m: f64,
        /// How often an octahedron is refined and rounded.
        levels: u32,
    },
    /// A body under flat faces, convex or not.
    Polyhedron {
        /// Corners [m].
        corners_m: Vec<[f64; 3]>,
        /// Corners of each face, counter-clockwise seen from outside, counted from 0; node sets are `face_0`, `face_1`, ….
        faces: Vec<Vec<u32>>,
        /// How it is filled. Default: `Fewest`.
        #[serde(default)]
        fill: Fill,
    },
    /// A closed surface in a file, filled: STL, OBJ, VTK's `.vtp` or `.vtk`; node sets have the names of its parts.
    Surface {
        /// Path, relative to the scene file.
        file: String,
        /// Metres per unit of the file. Default: 1.
        #[serde(default = "one")]
        unit_m: f64,
        /// How it is filled. Default: `Fewest`.
        #[serde(default)]
        fill: Fill,
    },
    /// A tetrahedral mesh in a file: Gmsh `.msh`, TetGen `.ele`, VTK `.vtu` and `.vtk`, Abaqus `.inp`; or a geometry,
    /// `.geo` or `.step`, that an installed Gmsh meshes.
    Mesh {
        /// Path, relative to the scene file.
        file: String,
        /// Body of the file that is this block; may be left out when the file holds one body. Default: none.
        #[serde(default)]
        body: Option<String>,
        /// Metres per unit of the file. Default: 1.
        #[serde(default = "one")]
        unit_m: f64,
        /// Longest edge that Gmsh makes in a geometry [m]. Default: what the geometry says.
        #[serde(default)]
        size_m: Option<f64>,
        /// Where Gmsh makes a geometry's mesh finer. Default: nowhere.
        #[serde(default)]
        finer: Vec<Grading>,
    },
}

/// How a box cell is cut into tetrahedra.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Pattern {
    /// Six tetrahedra around one diagonal: fewest elements.
    #[default]
    Six,
    /// Twenty-four around the centre: as symmetric as the cell.
    TwentyFour,
}

/// How a polyhedron is filled with tetrahedra.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub enum Fill {
    /// As few as there can be; no node inside. Blocks of a rock with more than 13 faces are filled as with `Centre` where contact is `Smooth` or `Closure`.
    #[default]
    Fewest,
    /// A star from one node at the centroid.
    Centre,
    /// Edges of about one length.
    Size {
        /// The length [m].
        size_m: f64,
        /// Where to be finer. Default: nowhere.
        #[serde(default)]
        finer: Vec<Grading>,
    },
    /// By TetGen, for surfaces as rough as they come; a build with the feature `tetgen` only, which is under the AGPL.
    TetGen {
        /// Longest edge, about [m].
        size_m: f64,
    },
}

/// Shorter edges towards a place, growing with the distance from it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Grading {
    /// The place, in the coordinates of the shape before it is turned, or of the rock.
    pub towards: Towards,
    /// Length of edges there [m].
    pub size_m: f64,
    /// Growth of the length per metre of distance. Default: 0.3.
    #[serde(default = "gentle")]
    pub growth: f64,
}

/// Places towards which a mesh is finer.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub enum Towards {
    /// A point [m].
    Point([f64; 3]),
    /// A plane, that of a face for instance.
    Plane {
        /// A point of it [m].
        point_m: [f64; 3],
        /// Its normal; its length does not matter.
        normal: [f64; 3],
    },
}

fn gentle() -> f64 {
    0.3
}
