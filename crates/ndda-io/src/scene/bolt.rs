//! Rock bolts and anchors.

use serde::{Deserialize, Serialize};

/// A rock bolt, or rows of equal ones: a bar in a borehole, held by grout over all of its length or a part of it.
///
/// A bolt has no mass; in each step its forces are in balance. Tension acts along it and turns with the blocks. Where it crosses from one block to the next,
/// a dowel resists shear.
///
/// ```text
/// bolts: [
///     // A fully grouted bolt of 3 m with a plate.
///     (name: "one", at: Line(from_m: (0, 0, 0), to_m: (0, 0, 3)),
///      steel: (young_pa: 200e9, area_m2: 491e-6, yield_n: 245e3, break_strain: 0.05),
///      grout: (stiffness_n_m2: 2e9, strength_n_m: 400e3), plate: (strength_n: 150e3)),
///     // Rows of anchors with a free length of 9 m, tensioned to 600 kN.
///     (name: "anchor", at: Rows(corner_m: (0, 0, 2), along_m: (0, 20, 0), up_m: (0, 0, 6), spacing_m: (4, 3), direction: (1, 0, -0.26), length_m: 15),
///      steel: (young_pa: 195e9, area_m2: 840e-6, yield_n: 1300e3),
///      grout: (stiffness_n_m2: 2e9, strength_n_m: 400e3, from_m: 9), pretension_n: 600e3, plate: ()),
/// ],
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Bolt {
    /// Name; those of rows get the numbers of row and column, as in `anchor_1_3`.
    pub name: String,
    /// Where it is.
    pub at: BoltPlace,
    /// Its bar.
    pub steel: BoltSteel,
    /// Its bond to the rock.
    pub grout: BoltGrout,
    /// Resistance to shear at joints. Default: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dowel: Option<BoltDowel>,
    /// Tension with which the bolt is locked, jacked against the plate [N]. What blocks and contact give way under it from then on takes part of it: in a
    /// cube of 2 m under 500 kN 0.2 % with E = 10 GPa, 1.4 % with 1 GPa. Default: none.
    #[serde(default)]
    pub pretension_n: f64,
    /// Plate that ties the head to the face. Default: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub plate: Option<BoltPlate>,
    /// Longest segment of the bonded length [m]; at most 1/(4λ), λ = √(k_b/EA). Default: 1/(8λ).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub segment_m: Option<f64>,
}

/// Where bolts are.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub enum BoltPlace {
    /// One bolt; what of it lies in front of the first block holds nothing.
    Line {
        /// Head [m], on a face or in front of it: lengths from the head count from this point.
        from_m: [f64; 3],
        /// End [m].
        to_m: [f64; 3],
    },
    /// Equal bolts over a rectangle, in rows along its first side; each head is where its line from the rectangle first meets a block.
    Rows {
        /// A corner of the rectangle, on the face or in front of it [m].
        corner_m: [f64; 3],
        /// First side, from the corner [m].
        along_m: [f64; 3],
        /// Second side, from the corner [m].
        up_m: [f64; 3],
        /// Spacing along both sides [m]; what is left over is shared by both ends.
        spacing_m: (f64, f64),
        /// Direction of the bolts, into the rock; its length does not matter.
        direction: [f64; 3],
        /// Length of a bolt from its head [m].
        length_m: f64,
        /// Whether every second row is shifted by half the spacing; these have one bolt less. Default: no.
        #[serde(default)]
        staggered: bool,
    },
}

/// The bar of a bolt.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct BoltSteel {
    /// Young's modulus [Pa].
    pub young_pa: f64,
    /// Area of its section [m²].
    pub area_m2: f64,
    /// Force at which it yields, in tension and compression [N]. Default: never.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub yield_n: Option<f64>,
    /// Strain at which it breaks, over a gauge length of 5.65 √A as in a tensile test (ISO 6892-1). Default: never.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub break_strain: Option<f64>,
}

/// The bond of a bolt.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct BoltGrout {
    /// Shear force per length of bolt and slip, k_b [N/m²].
    pub stiffness_n_m2: f64,
    /// Largest shear force per length of bolt, s_b = π D τ of a borehole of diameter D and a bond of strength τ [N/m].
    pub strength_n_m: f64,
    /// Where the bonded length begins, from the head [m]; the bolt is free before it. The head is the point `from_m` of a `Line`, also where that lies in front of the rock,
    /// and of `Rows` the point where the bolt meets it. Default: at the head.
    #[serde(default)]
    pub from_m: f64,
    /// Where it ends, from the head [m]. Default: at the end.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub to_m: Option<f64>,
}

/// Resistance of a bolt to shear where it crosses from one block to the next.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct BoltDowel {
    /// Shear force per offset [N/m].
    pub stiffness_n_m: f64,
    /// Largest shear force [N].
    pub capacity_n: f64,
}

/// The plate of a bolt.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct BoltPlate {
    /// Force at which it gives way [N]. Default: never.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub strength_n: Option<f64>,
}
