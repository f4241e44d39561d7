//! Friction laws' own numbers per facet, beside the history that all laws share.

use crate::friction::bonds_of_facet::Key;
use crate::friction::law::FrictionLaw;
use crate::model::{ContactError, ContactHistory, FacetMemory};

impl FacetMemory {
    /// Facet, target and element by which it is found, in this order.
    pub(crate) fn key(&self) -> Key {
        (self.facet, self.target, self.element)
    }

    /// The memory of a facet that has stopped touching: without force and area.
    pub(crate) fn at_rest(self) -> Self {
        Self { shear_n: [0.0; 2], twist_n_m: 0.0, area_m2: 0.0, ..self }
    }
}

/// The law of a facet before a change of laws and after it.
type Laws<'a> = [Option<&'a dyn FrictionLaw>; 2];

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

    /// Goes on under other laws, with a number of values per facet: numbers that mean the same to the law of a facet before and after are kept, the others begin anew.
    pub(crate) fn change_laws<'a>(&mut self, len: usize, laws_of: impl Fn(&FacetMemory) -> Laws<'a>) {
        let mut state = vec![0.0; len * self.facets.len()];
        for (place, memory) in self.facets.iter().enumerate() {
            if let [before, Some(law)] = laws_of(memory) {
                let own = &mut state[place * len..][..law.state_len()];
                law.begin(own);
                if let Some(before) = before {
                    keep_parts((before, self.state_of(place)), (law, own));
                }
            }
        }
        (self.law_state_len, self.law_state) = (len as u32, state);
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

    /// Place of a facet among those remembered, or where it belongs.
    pub(crate) fn find(&self, wanted: &Key) -> Result<usize, usize> {
        self.facets.binary_search_by_key(wanted, FacetMemory::key)
    }

    /// Adds a facet.
    pub(crate) fn insert(&mut self, place: usize, memory: FacetMemory) {
        let len = self.law_state_len as usize;
        self.facets.insert(place, memory);
        self.law_state.splice(place * len..place * len, std::iter::repeat_n(0.0, len));
    }
}

/// Takes over the numbers of one law that another has, too.
fn keep_parts((before, old): (&dyn FrictionLaw, &[f64]), (law, new): (&dyn FrictionLaw, &mut [f64])) {
    let parts_before = before.state_parts();
    let mut start = 0;
    for part in law.state_parts() {
        let place = parts_before.iter().position(|known| *known == part);
        let first = place.map(|place| parts_before[..place].iter().map(|(_, count)| count).sum::<usize>());
        if let Some(kept) = first.and_then(|first| old.get(first..first + part.1)) {
            new[start..start + part.1].copy_from_slice(kept);
        }
        start += part.1;
    }
}

#[cfg(test)]
mod tests {
    use ndda_mesh::{BlockId, TriangleId};

    use super::*;
    use crate::friction::barton_bandis::{BartonBandis, Roughness};
    use crate::friction::coulomb::Coulomb;
    use crate::friction::dilating::{Dilating, Dilation};
    use crate::friction::softening_coulomb::SofteningCoulomb;

    /// Numbers that a facet keeps when laws change: `old` and `new` are those of this facet and of another one.
    fn kept(old: [&dyn FrictionLaw; 2], new: [&dyn FrictionLaw; 2], of_first: &[f64]) -> Vec<f64> {
        let facet = |facet| FacetMemory {
            facet: TriangleId(facet),
            target: BlockId(0),
            element: None,
            shear_n: [0.0; 2],
            twist_n_m: 0.0,
            area_m2: 1.0,
            broken: false,
        };
        let len = |laws: [&dyn FrictionLaw; 2]| laws.map(|law| law.state_len()).into_iter().max().unwrap();
        let mut history = ContactHistory::default();
        history.expect_state(len(old)).unwrap();
        [0, 1].into_iter().for_each(|place| history.insert(place, facet(place as u32)));
        history.state_of_mut(0)[..of_first.len()].copy_from_slice(of_first);
        history.change_laws(len(new), |memory| {
            let place = memory.facet.index();
            [Some(old[place]), Some(new[place])]
        });
        history.state_of(0)[..new[0].state_len()].to_vec()
    }

    #[test]
    fn a_joint_keeps_its_numbers_when_the_law_of_another_joint_changes() {
        let soft = SofteningCoulomb::new(1e9, (40.0, 0.0), (30.0, 0.0), 1e-3);
        let plain = Coulomb::new(30.0, 1e9);
        let angle = || Dilation::Angle { psi_deg: 5.0, to_slip_m: 0.1 };
        let opening = Dilating::new(Box::new(Coulomb::new(30.0, 1e9)), angle());
        let rough = Roughness { jrc: 10.0, jcs_pa: 100e6, residual_deg: 30.0, length_m: 0.1 };
        let worn = BartonBandis::new(rough, 1e9).mobilised();
        for first in [&soft as &dyn FrictionLaw, &worn] {
            assert_eq!(kept([first, &plain], [first, &opening], &[0.02]), [0.02]);
            assert_eq!(kept([first, &opening], [first, &plain], &[0.02]), [0.02]);
        }
        let both = Dilating::new(Box::new(worn), Dilation::Own);
        let all = [1.0, 2.0, 3.0, 4.0, 5.0];
        assert_eq!(kept([&opening, &plain], [&opening, &both], &all[..4]), all[..4]);
        assert_eq!(kept([&opening, &both], [&opening, &plain], &all[..4]), all[..4]);
        assert_eq!(kept([&both, &plain], [&both, &soft], &all), all);
    }

    #[test]
    fn what_two_laws_of_a_joint_have_in_common_goes_on_and_the_rest_begins_anew() {
        let plain = Coulomb::new(30.0, 1e9);
        let soft = || SofteningCoulomb::new(1e9, (40.0, 0.0), (30.0, 0.0), 1e-3);
        let angle = || Dilation::Angle { psi_deg: 5.0, to_slip_m: 0.1 };
        let opening = Dilating::new(Box::new(plain), angle());
        let both = Dilating::new(Box::new(soft()), angle());
        let all = [1.0, 2.0, 3.0, 4.0, 5.0];
        assert_eq!(kept([&both, &plain], [&opening, &plain], &all), all[1..]);
        assert_eq!(kept([&opening, &plain], [&both, &plain], &all[..4]), [0.0, 1.0, 2.0, 3.0, 4.0]);
        assert_eq!(kept([&both, &plain], [&soft(), &plain], &all), [1.0]);
        let rough = Roughness { jrc: 10.0, jcs_pa: 100e6, residual_deg: 30.0, length_m: 0.1 };
        assert_eq!(
            kept([&soft(), &plain], [&BartonBandis::new(rough, 1e9).mobilised(), &plain], &[1.0]),
            [0.0]
        );
    }
}
