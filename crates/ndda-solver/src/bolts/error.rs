//! Why a bolt cannot be set.

/// Segments of a bolt at most.
pub(crate) const MOST_SEGMENTS: f64 = 1e4;

/// Why a bolt cannot be set.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BoltError {
    /// It meets no block.
    #[error("it lies in no block: move from_m or to_m")]
    Nowhere,
    /// It runs in the contact face of two blocks, or these overlap.
    #[error(
        "it runs in the face between `{first}` and `{second}`, or these overlap along it: shift it, so that it is in one of them"
    )]
    BetweenBlocks {
        /// One block.
        first: String,
        /// The other.
        second: String,
    },
    /// Nothing of it is bonded.
    #[error(
        "its bonded length, from {from_m} to {to_m} m from its head, lies in no block: it enters rock at {enters_m:.4} m and ends at {ends_m:.4} m"
    )]
    Unbonded {
        /// Begin of the bonded length [m].
        from_m: f64,
        /// Its end [m].
        to_m: f64,
        /// Begin of the bolt in rock [m].
        enters_m: f64,
        /// Its end in rock [m].
        ends_m: f64,
    },
    /// Segments too long for the bond.
    #[error(
        "segments of {asked_m} m are too long, and would make the bolt too stiff in its grout: give segment_m at most {most_m:.4} m"
    )]
    Coarse {
        /// What was asked for [m].
        asked_m: f64,
        /// A quarter of 1/λ, or the gauge length of the break strain [m].
        most_m: f64,
    },
    /// More segments than are ever needed.
    #[error(
        "segments of {segment_m:e} m would be {count:.1e} of them, and at most {MOST_SEGMENTS:.0} are possible: give a longer segment_m or a softer grout"
    )]
    Fine {
        /// Their length [m].
        segment_m: f64,
        /// How many there would be.
        count: f64,
    },
    /// Pretension without a plate.
    #[error("pretension_n needs a plate at the head, against which the bolt is tensioned: add plate")]
    NoPlate,
    /// More pretension than it carries.
    #[error("pretension_n {pretension_n} is more than its {part} carries, {most_n:.6} N")]
    Overstressed {
        /// What was asked for [N].
        pretension_n: f64,
        /// Which part.
        part: &'static str,
        /// What it carries [N].
        most_n: f64,
    },
}
