//! Who does what: consecutive entries of a list, about as much work for each rank.

use std::ops::Range;

/// First entry of each rank, with the end appended: consecutive entries whose weights add up to about the same on each rank. The division
/// follows from the weights alone, so that all ranks find the same one.
///
/// ```
/// assert_eq!(ndda_ranks::divide([1, 1, 1, 3].into_iter(), 2), [0, 3, 4]);
/// assert_eq!(ndda_ranks::divide([5].into_iter(), 3), [0, 0, 1, 1]);
/// ```
pub fn divide(weights: impl Iterator<Item = u64> + Clone, ranks: usize) -> Vec<usize> {
    let total: u128 = weights.clone().map(u128::from).sum();
    let (mut starts, mut before, mut entries) = (vec![0], 0u128, 0);
    for weight in weights {
        // An entry goes to the rank in whose part its middle lies.
        let middle = 2 * before + u128::from(weight);
        while starts.len() < ranks && middle * ranks as u128 >= 2 * total * starts.len() as u128 {
            starts.push(entries);
        }
        before += u128::from(weight);
        entries += 1;
    }
    starts.resize(ranks, entries);
    starts.push(entries);
    starts
}

/// The entries of a rank in a [division](divide).
pub fn share(starts: &[usize], rank: usize) -> Range<usize> {
    starts[rank]..starts[rank + 1]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_are_whole_consecutive_and_within_an_entry_of_each_other() {
        let mut seed = 1u64;
        let mut next = |most: u64| {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 33) % most
        };
        for ranks in 1..9 {
            for entries in [0, 1, 2, 5, 100] {
                let weights: Vec<u64> = (0..entries).map(|_| next(50)).collect();
                let starts = divide(weights.iter().copied(), ranks);
                assert_eq!((starts.len(), starts[0], starts[ranks]), (ranks + 1, 0, entries as usize));
                assert!(starts.is_sorted());
                let (total, most): (u64, u64) =
                    (weights.iter().sum(), weights.iter().copied().max().unwrap_or(0));
                for rank in 0..ranks {
                    let own: u64 = weights[share(&starts, rank)].iter().sum();
                    assert!(own <= total / ranks as u64 + most + 1, "{own} of {total} on {ranks}");
                }
            }
        }
    }

    #[test]
    fn entries_without_weight_are_somebodys() {
        assert_eq!(divide([0, 0].into_iter(), 3).last(), Some(&2));
        assert_eq!(divide(std::iter::empty(), 2), [0, 0, 0]);
    }
}
