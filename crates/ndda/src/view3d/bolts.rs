//! Bolts of a run or a scene, piece by piece, and what their colours may say.

use std::path::Path;
use std::str::FromStr;

use ndda_io::mesh_file::MeshFileError;
use ndda_io::results::ListedFrame;
use ndda_io::{BoltLine, OutputFolder};
use ndda_mesh::Vec3;

/// What the colours of bolts say.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BoltColour {
    /// Axial force, of a run.
    #[default]
    Force,
    /// Axial force over that at which the steel yields, of a run.
    Yield,
    /// Elastic, debonded, yielding or broken, of a run.
    State,
    /// Where they are.
    Plain,
    /// They are left out.
    Hidden,
}

impl FromStr for BoltColour {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "force" => Ok(Self::Force),
            "yield" => Ok(Self::Yield),
            "state" => Ok(Self::State),
            "plain" => Ok(Self::Plain),
            "hidden" => Ok(Self::Hidden),
            _ => Err("write force, yield, state, plain or hidden".into()),
        }
    }
}

/// A piece of a bolt in a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piece {
    /// Its ends [m].
    pub ends: [Vec3; 2],
    /// Index of the bolt.
    pub bolt: usize,
    /// Index of the block in which it begins; none before a run.
    pub block: Option<u32>,
    /// Tension [N].
    pub axial_n: f64,
    /// Tension over the force at which it yields.
    pub utilisation: f64,
    /// Number of its state.
    pub state: u8,
}

impl From<&BoltLine> for Piece {
    fn from(line: &BoltLine) -> Self {
        Self {
            ends: line.ends_m.map(Vec3::from),
            bolt: line.bolt,
            block: Some(line.block),
            axial_n: line.axial_n,
            utilisation: line.utilisation,
            state: line.state,
        }
    }
}

/// A bolt without forces between its ends [m].
pub fn plain(bolt: usize, ends: [Vec3; 2]) -> Piece {
    Piece { ends, bolt, block: None, axial_n: 0.0, utilisation: 0.0, state: 0 }
}

/// The frames of bolts of a run; none where it has no bolts.
///
/// # Errors
/// The list of them cannot be read.
pub fn listed(folder: &Path) -> Result<Vec<ListedFrame>, MeshFileError> {
    let index = folder.join(OutputFolder::BOLTS_INDEX);
    if index.is_file() { ListedFrame::read_all(&index) } else { Ok(Vec::new()) }
}

/// The bolts of the frame of some number and time [s]; several frames may have the same time.
///
/// # Errors
/// The frame cannot be read.
pub fn at(listed: &[ListedFrame], number: usize, time_s: f64) -> Result<Vec<BoltLine>, MeshFileError> {
    let same = |frame: &&ListedFrame| frame.time_s == time_s;
    match listed.get(number).filter(same).or_else(|| listed.iter().find(same)) {
        Some(frame) => BoltLine::read_all(&frame.path),
        None => Ok(Vec::new()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_that_there_are_not_are_refused_with_those_that_there_are() {
        assert_eq!("yield".parse(), Ok(BoltColour::Yield));
        assert!("axial".parse::<BoltColour>().unwrap_err().contains("force, yield"));
    }
}
