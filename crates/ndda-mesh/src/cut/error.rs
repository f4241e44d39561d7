//! Why rock cannot be cut as asked.

/// Why rock cannot be cut as asked.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CutError {
    /// A plane without direction or place.
    #[error(
        "no plane goes through {point_m:?} m with normal {normal:?}: give finite numbers and a normal that is not zero"
    )]
    Plane {
        /// Point of the plane [m].
        point_m: [f64; 3],
        /// Normal.
        normal: [f64; 3],
    },
    /// An angle outside its range.
    #[error("{what} is {value_deg:?}°: give {least} to {most}°")]
    Angle {
        /// Which angle.
        what: &'static str,
        /// Its value [°].
        value_deg: f64,
        /// Least value [°].
        least: f64,
        /// Largest value [°].
        most: f64,
    },
    /// A number of a joint set outside its range.
    #[error("joint {joint:?}: {what} is {value:?}; give {expected}")]
    Joint {
        /// Name of the joint.
        joint: String,
        /// Which number.
        what: &'static str,
        /// Its value.
        value: f64,
        /// The accepted range.
        expected: &'static str,
    },
    /// More planes than the domain can sensibly be cut by.
    #[error(
        "joint set {joint:?} has more than {most} planes in the domain: widen its spacing of {spacing_m:e} m"
    )]
    TooManyPlanes {
        /// Name of the joint set.
        joint: String,
        /// Mean spacing [m].
        spacing_m: f64,
        /// Most planes.
        most: usize,
    },
    /// More blocks than the limit.
    #[error("the cut makes more than {most} blocks: widen the spacings, or give more memory")]
    TooManyBlocks {
        /// The limit.
        most: usize,
    },
    /// The domain has no volume or extreme or non-finite coordinates.
    #[error(
        "the domain from {min_m:?} to {max_m:?} m has no volume: its largest corner must exceed its smallest, within 1e-50 to 1e50 m"
    )]
    Extent {
        /// Smallest corner [m].
        min_m: [f64; 3],
        /// Largest corner [m].
        max_m: [f64; 3],
    },
    /// A profile that is no simple polygon.
    #[error(
        "the profile of {corners} corners is not a simple polygon: list at least three corners in order, without crossings"
    )]
    Profile {
        /// Number of corners.
        corners: usize,
    },
    /// A face of the surface names too few, repeated or missing vertices.
    #[error("face {face} of the surface must name at least three different vertices below {vertices}")]
    FaceVertices {
        /// Index of the face.
        face: usize,
        /// Number of vertices.
        vertices: usize,
    },
    /// A face of the surface is not flat.
    #[error("face {face} of the surface is {gap_m:e} m from flat: split it into triangles")]
    NotFlat {
        /// Index of the face.
        face: usize,
        /// Largest distance of its vertices from its mean plane [m].
        gap_m: f64,
    },
    /// An edge of the surface without the opposite edge of another face.
    #[error(
        "no other face joins edge {a}-{b} of face {face} as {b}-{a}: close the surface, and turn all faces outward"
    )]
    Open {
        /// Index of the face.
        face: usize,
        /// First vertex.
        a: u32,
        /// Second vertex.
        b: u32,
    },
    /// The convex parts do not add up to the surface.
    #[error(
        "the surface encloses {surface_m3:e} m³, but its convex parts have {parts_m3:e} m³: the surface is inside out or cuts \
         itself; turn its faces outward, or remove the crossing"
    )]
    Inconsistent {
        /// Volume under the surface [m³].
        surface_m3: f64,
        /// Volume of the parts [m³].
        parts_m3: f64,
    },
    /// More convex parts than a concave domain should have.
    #[error(
        "the surface falls into more than {most} convex parts: simplify it, or use a terrain with columns"
    )]
    TooManyParts {
        /// Most parts.
        most: usize,
    },
    /// No column stands under a triangle of a terrain.
    #[error(
        "triangle {face} of the terrain must be counter-clockwise from above, not upright, and above the base at {base_m} m"
    )]
    Column {
        /// Index of the triangle.
        face: usize,
        /// Level of the base [m].
        base_m: f64,
    },
    /// Too few, coinciding or non-finite seeds of Voronoi cells.
    #[error("seed {seed} at {at_m:?} m is not finite or coincides with another: give distinct points")]
    Seed {
        /// Index of the seed.
        seed: usize,
        /// Its place [m].
        at_m: [f64; 3],
    },
    /// No seeds at all.
    #[error("no seeds: give at least one")]
    NoSeeds,
}
