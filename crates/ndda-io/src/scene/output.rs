//! The output of a run.

use serde::{Deserialize, Serialize};

/// Files that are written and how often. Quantities that are not requested are not computed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default)]
pub struct Output {
    /// Frames of fields after the first; 0 writes none. Default: 20.
    pub frames: u32,
    /// Fields of a frame besides positions. Default: `[Displacement, Velocity, VonMises, Stress, BlockId]`.
    pub fields: Vec<Field>,
    /// How frames are written. Default: `Compressed`.
    pub format: FieldFormat,
    /// Numbers of the fields; positions are always `F64`, since coordinates may be large. Default: `F64`.
    pub precision: Precision,
    /// Rows of `history.csv` after the first, at most one per step. Default: 1000.
    pub history_rows: u32,
    /// Format of the tables `history`, `contacts` and `blocks`. Default: `Csv`.
    pub history: TableFormat,
    /// Whether what each pair of touching blocks does to each other is written in every row, as `contacts.csv`. Default: false.
    pub contacts: bool,
    /// Whether displacement, rotation, velocity and spin of each block are written at the times of the frames, as `blocks.csv`.
    /// Default: true.
    pub blocks: bool,
    /// Whether the forces of supports on held blocks are columns of the history. Default: false.
    pub reactions: bool,
    /// Wall-clock time between checkpoints [s], which `ndda resume` goes on from; one is written at the start and at
    /// the end, too. Default: 60.
    pub checkpoint_wall_s: f64,
}

impl Default for Output {
    fn default() -> Self {
        Self {
            frames: 20,
            fields: vec![
                Field::Displacement,
                Field::Velocity,
                Field::Stress,
                Field::VonMises,
                Field::BlockId,
            ],
            format: FieldFormat::default(),
            precision: Precision::default(),
            history_rows: 1000,
            history: TableFormat::default(),
            blocks: true,
            contacts: false,
            reactions: false,
            checkpoint_wall_s: 60.0,
        }
    }
}

/// A field of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Field {
    /// Displacement since the start per node [m].
    Displacement,
    /// Velocity per node [m/s].
    Velocity,
    /// Acceleration per node [m/s²].
    Acceleration,
    /// Cauchy stress per tetrahedron [Pa], tension positive: XX YY ZZ XY YZ XZ.
    Stress,
    /// Von Mises stress per tetrahedron [Pa].
    VonMises,
    /// Contact force per node [N], friction included, of the last step.
    ContactForce,
    /// Contact force over the surface of a node [Pa].
    ContactTraction,
    /// Per node: 0 no contact, 1 held by friction, 2 at least one facet slides.
    FrictionState,
    /// Number of the block per tetrahedron, from 0 in the order of the blocks.
    BlockId,
    /// Number of the material per tetrahedron, from 0 in the order of `materials`.
    Material,
}

/// How a frame is written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum FieldFormat {
    /// Arrays appended as raw data, packed by zlib: the smallest.
    #[default]
    Compressed,
    /// Arrays appended as raw data: the quickest.
    Appended,
    /// Arrays inline as base 64: text from end to end, the largest.
    Base64,
}

/// Numbers of a field.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Precision {
    /// Four bytes, seven digits.
    F32,
    /// Eight bytes, as computed.
    #[default]
    F64,
}

/// Files of a table.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum TableFormat {
    /// Text that grows while the run goes on.
    #[default]
    Csv,
    /// Parquet, made of the text at the end of the run, which then is removed.
    Parquet,
    /// Both.
    Both,
}

impl TableFormat {
    /// Whether there is a Parquet file at the end.
    pub fn has_parquet(self) -> bool {
        self != Self::Csv
    }
}
