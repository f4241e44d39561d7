//! How blocks fail at the upper end of the bracket.

use ndda_io::scene::Contact;
use ndda_solver::Snapshot;

use super::Search;
use crate::Model;
use crate::lean;
use crate::safety::{Kind, Mechanism, MovingBlock, SafetyError, changes, edges, film, mechanism, opened};

/// What blocks do that fail.
type Found = (Option<Mechanism>, Vec<MovingBlock>);

impl Search<'_> {
    /// That trial once more, with its contacts, and its film beside it.
    pub(super) fn mechanism(&self, from: &Snapshot) -> Result<Found, SafetyError> {
        let answer = self.answer.lock().expect("no trial panics").clone();
        let Some(factor) = answer.factor_of_safety.upper else { return Ok((None, Vec::new())) };
        if let Some((at, how, moving)) = &self.known_mechanism
            && *at == factor
        {
            return Ok((Some(how.clone()), moving.clone()));
        }
        let trial = answer.trials.into_iter().find(|trial| trial.factor == factor);
        let film = || match (self.watch.out, &trial) {
            (Some(out), Some(trial)) => film::record(self.model(factor, from)?, trial, out, self.watch.stop),
            _ => Ok(()),
        };
        let (found, filmed) = rayon::join(|| self.found(factor, from), film);
        filmed.and(found)
    }

    /// That blocks topple before rigid edges would let them, in words.
    pub(super) fn leaning(&self, how: &Mechanism, moving: &[MovingBlock]) -> Option<String> {
        let bracket = self.answer.lock().expect("no trial panics").factor_of_safety;
        let (lower, upper) = bracket.lower.zip(bracket.upper).filter(|_| how.kind == Kind::Toppling)?;
        let lean = |factor: f64| {
            let model = self.model(factor, &self.start.snapshot).ok()?;
            Some((lean::worst(&model.loaded.scene, &model.simulation), model))
        };
        let (found, model) = lean(lower)?;
        let Some(Contact::Potential { penalty_pa, .. }) = &model.loaded.scene.contact else { return None };
        let Some(found) = found else {
            let topple = moving.iter().filter(|block| block.kind == Kind::Toppling).count();
            return (topple > 1).then(|| edges::several(topple, *penalty_pa));
        };
        let next = lean(lower * (1.0 + edges::LITTLE)).and_then(|(next, _)| next);
        let same = next.filter(|next| next.block == found.block);
        let rigid = same.and_then(|next| edges::rigid(lower, found.inside_m, next.inside_m));
        match rigid {
            Some(rigid) => edges::one(&found.block, (lower, upper, rigid), self.plan.error, *penalty_pa),
            None => Some(format!(
                "blocks topple sooner than on a rigid edge, and the factor is too small: {found}"
            )),
        }
    }

    fn found(&self, factor: f64, from: &Snapshot) -> Result<Found, SafetyError> {
        let mut model = self.ended(factor, from)?;
        let mut found = mechanism::of(&mut model, &self.start.position);
        let lower = self.answer.lock().expect("no trial panics").factor_of_safety.lower;
        if let (Some(how), Some(lower)) = (&mut found.0, lower)
            && changes::keeps_cohesion(&self.loaded.scene)
        {
            // Where they still stand: blocks that slide go on to open joints.
            let moving: Vec<&str> = found.1.iter().map(|block| block.name.as_str()).collect();
            how.opened = opened::of(&self.ended(lower, from)?, &self.folder, &moving)?;
        }
        Ok(found)
    }

    /// The end of a trial, with its contacts.
    fn ended(&self, factor: f64, from: &Snapshot) -> Result<Model, SafetyError> {
        let mut model = self.model(factor, from)?;
        model.simulation.watch_contacts(true);
        let failing = self.failing();
        let course = self.course(&failing, &|| false);
        course.run(&mut model.simulation, factor).ok_or(SafetyError::Interrupted)?;
        Ok(model)
    }
}
