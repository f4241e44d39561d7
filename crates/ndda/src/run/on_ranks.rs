//! A run that several processes take together: each has the whole scene, the first one writes the files.

use std::path::Path;
use std::sync::Arc;

use ndda_io::{OutputFolder, checkpoint};
use ndda_ranks::{Communicator, Gathered, RanksError, Topic};

use super::Run;
use super::outputs::SavedRun;
use super::resume::{ResumeError, Resumed, is_judged, last_checkpoint};
use crate::build::Choices;
use crate::machine;

impl Run {
    /// Shares the steps of the run with other ranks. All of them make the same run with the same settings, and finish it; the first may
    /// [record](Self::record) it, no other. History and state have the same bits as those of a run by one process.
    ///
    /// # Errors
    /// [`RanksError`] where the ranks have other scenes or programs, or one of them has given up.
    pub fn on_ranks(mut self, ranks: &Arc<dyn Communicator>) -> Result<Self, RanksError> {
        let text = &self.model.loaded.text;
        let own = checkpoint::fingerprint(&(env!("CARGO_PKG_VERSION"), machine::COMMIT, text));
        let mut all = Gathered::default();
        ranks.exchange(Topic::Start, &own.to_le_bytes(), &mut all)?;
        if let Some(rank) = (0..ranks.size()).find(|rank| all.of(*rank) != own.to_le_bytes()) {
            return Err(RanksError::OutOfStep { rank });
        }
        self.model.simulation.share_steps(ranks.clone());
        Ok(self)
    }

    /// Goes on with the run that is recorded in a folder, on ranks of which the first alone needs to see the folder; the files that the scene names
    /// are read by all. The run may have been on any number of ranks before.
    ///
    /// # Errors
    /// As [`resume`](Self::resume); what the first rank cannot read ends all.
    pub fn resume_on_ranks(folder: &Path, ranks: &Arc<dyn Communicator>) -> Result<Resumed, ResumeError> {
        let (mut warnings, mut own, mut bytes) = (Vec::new(), None, Vec::new());
        if ranks.rank() == 0 {
            let given_up = |error: ResumeError| {
                ranks.give_up(&error.to_string());
                error
            };
            let folder = OutputFolder::open(folder).map_err(|error| given_up(error.into()))?;
            let saved = last_checkpoint(&folder, &mut warnings).map_err(given_up)?;
            warnings.extend(saved.identity.edited());
            bytes.push(u8::from(is_judged(&folder)));
            bytes.extend(checkpoint::to_bytes(&saved));
            own = Some(folder);
        }
        let mut all = Gathered::default();
        ranks.exchange(Topic::Start, &bytes, &mut all)?;
        let unusable = || ResumeError::Unusable("the checkpoint of the first rank cannot be read".into());
        let (is_judged, saved) = all.of(0).split_first().ok_or_else(unusable)?;
        let saved: SavedRun = checkpoint::from_bytes(saved).ok_or_else(unusable)?;
        let run = Self::resume_saved((saved, *is_judged == 1), (folder, own), Choices::default())?;
        Ok(Resumed { run: run.on_ranks(ranks)?, warnings })
    }
}
