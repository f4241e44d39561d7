//! Friction laws' own numbers per facet, beside the history that all laws share.

use crate::model::{ContactError, ContactHistory, FacetMemory};

impl FacetMemory {
    /// The same of a facet that does not touch.
    pub(crate) fn at_rest(self) -> Self {
        Self { shear_n: [0.0; 2], twist_n_m: 0.0, area_m2: 0.0, ..self }
    }
}

impl ContactHistory {
    /// Takes up a number of values per facet when contact begins.
    ///
    /// # Errors
    /// [`ContactError::OtherLaws`] when facets were remembered by laws that keep another number.
    pub(crate) fn expect_state(&mut self, len: usize) -> Result<(), ContactError> {
        if self.law_state_len as usize == len {
            return Ok(());
        }
        if !self.facets.is_empty() {
            return Err(ContactError::OtherLaws { kept: self.law_state_len as usize, expected: len });
        }
        self.law_state_len = len as u32;
        self.law_state.clear();
        Ok(())
    }

    /// Lets laws begin anew that keep another number of values per facet.
    pub(crate) fn begin_laws(&mut self, len: usize) {
        if self.law_state_len as usize != len {
            self.law_state_len = len as u32;
            self.law_state = vec![0.0; len * self.facets.len()];
        }
    }

    /// The law's own numbers of a facet.
    pub(crate) fn state_of(&self, place: usize) -> &[f64] {
        let len = self.law_state_len as usize;
        &self.law_state[place * len..(place + 1) * len]
    }

    /// The same, to change it.
    pub(crate) fn state_of_mut(&mut self, place: usize) -> &mut [f64] {
        let len = self.law_state_len as usize;
        &mut self.law_state[place * len..(place + 1) * len]
    }

    /// Adds a facet.
    pub(crate) fn insert(&mut self, place: usize, memory: FacetMemory) {
        let len = self.law_state_len as usize;
        self.facets.insert(place, memory);
        self.law_state.splice(place * len..place * len, std::iter::repeat_n(0.0, len));
    }
}
