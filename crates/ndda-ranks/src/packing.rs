//! Numbers as bytes, with all their bits.

/// A value of a fixed number of bytes.
pub trait Packed: Sized {
    /// How many.
    const BYTES: usize;

    /// Writes the value to so many bytes.
    fn write(&self, to: &mut [u8]);

    /// The value that was written there.
    fn read(from: &[u8]) -> Self;
}

macro_rules! numbers {
    ($($number:ty),*) => {$(
        impl Packed for $number {
            const BYTES: usize = size_of::<$number>();

            #[inline(always)]
            fn write(&self, to: &mut [u8]) {
                to[..Self::BYTES].copy_from_slice(&self.to_le_bytes());
            }

            #[inline(always)]
            fn read(from: &[u8]) -> Self {
                let mut bytes = [0; Self::BYTES];
                bytes.copy_from_slice(&from[..Self::BYTES]);
                Self::from_le_bytes(bytes)
            }
        }
    )*};
}

numbers!(u8, u32, u64, f64);

impl<T: Packed + Copy + Default, const N: usize> Packed for [T; N] {
    const BYTES: usize = N * T::BYTES;

    #[inline(always)]
    fn write(&self, to: &mut [u8]) {
        let to = &mut to[..Self::BYTES];
        for (value, bytes) in self.iter().zip(to.chunks_exact_mut(T::BYTES)) {
            value.write(bytes);
        }
    }

    #[inline(always)]
    fn read(from: &[u8]) -> Self {
        let mut all = [T::default(); N];
        for (value, bytes) in all.iter_mut().zip(from[..Self::BYTES].chunks_exact(T::BYTES)) {
            *value = T::read(bytes);
        }
        all
    }
}

/// Bytes that grow.
#[derive(Clone, Debug, Default)]
pub struct Packer {
    bytes: Vec<u8>,
}

impl Packer {
    /// Begins anew in the same memory.
    pub fn clear(&mut self) {
        self.bytes.clear();
    }

    /// What was packed.
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// Appends a value.
    pub fn put<T: Packed>(&mut self, value: &T) {
        let start = self.bytes.len();
        self.bytes.resize(start + T::BYTES, 0);
        value.write(&mut self.bytes[start..]);
    }

    /// Appends the same number of bytes for each entry of a list, whose length the reader has to know.
    pub fn put_each<T: Packed, E>(&mut self, entries: &[E], of: impl Fn(&E) -> T) {
        let start = self.bytes.len();
        self.bytes.resize(start + T::BYTES * entries.len(), 0);
        for (entry, to) in entries.iter().zip(self.bytes[start..].chunks_exact_mut(T::BYTES)) {
            of(entry).write(to);
        }
    }
}

/// Bytes that are read from the front.
#[derive(Clone, Debug)]
pub struct Unpacker<'a>(&'a [u8]);

impl<'a> Unpacker<'a> {
    /// Reads what a [`Packer`] of the same program has written.
    pub fn new(bytes: &'a [u8]) -> Self {
        Self(bytes)
    }

    /// Whether all has been read.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The next value.
    ///
    /// # Panics
    /// Where none was written.
    pub fn take<T: Packed>(&mut self) -> T {
        let (value, rest) = self.0.split_at(T::BYTES);
        self.0 = rest;
        T::read(value)
    }

    /// The next values, as many as asked for.
    ///
    /// # Panics
    /// Where fewer were written.
    pub fn take_each<T: Packed + 'a>(&mut self, count: usize) -> impl Iterator<Item = T> + 'a + use<'a, T> {
        let (values, rest) = self.0.split_at(count * T::BYTES);
        self.0 = rest;
        values.chunks_exact(T::BYTES).map(T::read)
    }

    /// Replaces each entry of a list by what [`put_each`](Packer::put_each) made of one.
    ///
    /// # Panics
    /// Where fewer were written.
    pub fn take_into<T: Packed + 'a, E>(&mut self, entries: &mut [E], of: impl Fn(T) -> E) {
        let found = self.take_each(entries.len());
        entries.iter_mut().zip(found).for_each(|(entry, found)| *entry = of(found));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_bit_comes_back() {
        let odd = [f64::NAN, -0.0, f64::MIN_POSITIVE / 8.0, f64::INFINITY, 0.1];
        let mut packer = Packer::default();
        packer.put(&7u32);
        packer.put_each(&odd, |x| [*x, -*x]);
        packer.put(&[1u64, u64::MAX]);
        let mut unpacker = Unpacker::new(packer.bytes());
        assert_eq!(unpacker.take::<u32>(), 7);
        for (found, x) in unpacker.take_each::<[f64; 2]>(odd.len()).zip(odd) {
            assert_eq!(found.map(f64::to_bits), [x, -x].map(f64::to_bits));
        }
        let mut pair = [[0; 2]];
        unpacker.take_into(&mut pair, |found: [u64; 2]| found);
        assert_eq!(pair, [[1, u64::MAX]]);
        assert!(unpacker.is_empty());
    }
}
