//! The values of a scene around a byte of its text.

use std::ops::Range;

use super::Node;

impl Node {
    /// The innermost bracketed value around a byte.
    pub(crate) fn innermost(&self, offset: usize) -> Option<&Self> {
        if self.opening.is_none() || !(self.span.start <= offset && offset <= self.span.end) {
            return None;
        }
        let inside = |c: &&Self| c.span.start < offset && offset < c.span.end;
        self.children.iter().find(inside).and_then(|c| c.innermost(offset)).or(Some(self))
    }

    /// Bytes of the innermost field or item of a list around a byte, the name of the field included.
    pub(crate) fn entry_around(&self, offset: usize) -> Option<Range<usize>> {
        let child = self.children.iter().find(|c| c.begun() <= offset && offset < c.span.end)?;
        let is_entry = child.key.is_some() || self.opening == Some('[');
        child.entry_around(offset).or(is_entry.then(|| child.begun()..child.span.end))
    }

    /// Whether the name of a field begins at a byte.
    pub(crate) fn has_key_at(&self, offset: usize) -> bool {
        self.children.iter().any(|c| c.key.is_some() && c.key_span.start == offset || c.has_key_at(offset))
    }

    /// The outermost value that begins at a byte.
    pub(crate) fn beginning_at(&self, offset: usize) -> Option<&Self> {
        if self.span.start == offset {
            return Some(self);
        }
        self.children.iter().find_map(|child| child.beginning_at(offset))
    }

    /// The word, number or string around or just before a byte.
    pub(crate) fn leaf_around(&self, offset: usize) -> Option<&Self> {
        if self.opening.is_none() {
            return (self.span.start <= offset && offset <= self.span.end).then_some(self);
        }
        self.children.iter().find_map(|child| child.leaf_around(offset))
    }

    /// The value whose closing bracket stands at a byte, or else the innermost one around the byte before.
    pub(crate) fn closed_at(&self, offset: usize) -> Option<&Self> {
        let mut node = self;
        while node.opening.is_none() || node.span.end != offset + 1 {
            let Some(child) = node.children.iter().find(|c| c.span.contains(&offset)) else {
                return self.innermost(offset.saturating_sub(1));
            };
            node = child;
        }
        Some(node)
    }
}
