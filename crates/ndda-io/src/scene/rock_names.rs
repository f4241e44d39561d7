//! Names of the blocks of a rock.

use super::Rock;

impl Rock {
    /// Whether a block of this name comes from this rock.
    pub fn makes(&self, block: &str) -> bool {
        let is_number = |n: &str| !n.is_empty() && n.bytes().all(|c| c.is_ascii_digit());
        let number = |stem: &str| {
            block.strip_prefix(stem).and_then(|rest| rest.strip_prefix('_')).is_some_and(is_number)
        };
        self.stems().any(number)
    }

    /// Whether blocks of this rock may have names of a pattern, of which the part before the first `*` tells.
    pub(crate) fn may_make(&self, pattern: &str) -> bool {
        let head = pattern.split('*').next().unwrap_or_default();
        let is_number = |rest: &str| rest.bytes().all(|c| c.is_ascii_digit());
        self.stems().any(|stem| {
            let begin = format!("{stem}_");
            begin.starts_with(head) || head.strip_prefix(&begin).is_some_and(is_number)
        })
    }

    /// The names that those of its blocks begin with.
    fn stems(&self) -> impl Iterator<Item = &str> {
        [self.name.as_str()].into_iter().chain(self.excavations.iter().map(|space| space.name.as_str()))
    }
}
