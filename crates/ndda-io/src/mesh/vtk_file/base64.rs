//! Base 64 as VTK writes it: pieces with padding of their own, one after the other (RFC 4648).

const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/// Appends `bytes` as one piece.
pub(super) fn encode(bytes: &[u8], text: &mut String) {
    for group in bytes.chunks(3) {
        let byte = |i: usize| u32::from(group.get(i).copied().unwrap_or(0));
        let bits = byte(0) << 16 | byte(1) << 8 | byte(2);
        for digit in 0..4 {
            let value = bits >> (18 - 6 * digit) & 63;
            text.push(if digit <= group.len() { DIGITS[value as usize] as char } else { '=' });
        }
    }
}

/// Decodes pieces as they are requested.
pub(super) struct Decoder<'a> {
    text: &'a [u8],
    /// Decoded but not yet requested, from `next` on.
    ready: Vec<u8>,
    next: usize,
}

impl<'a> Decoder<'a> {
    pub(crate) fn new(text: &'a [u8]) -> Self {
        Self { text, ready: Vec::new(), next: 0 }
    }

    /// The next `count` bytes, if there are so many.
    pub(crate) fn take(&mut self, count: usize) -> Option<Vec<u8>> {
        if count > self.text.len() + self.ready.len() {
            return None;
        }
        self.ready.drain(..self.next);
        self.next = 0;
        while self.ready.len() < count {
            self.group()?;
        }
        self.next = count;
        Some(self.ready[..count].to_vec())
    }

    /// Decodes four digits.
    fn group(&mut self) -> Option<()> {
        let (mut bits, mut digits, mut padding) = (0u32, 0, 0);
        while digits < 4 {
            let (&digit, rest) = self.text.split_first()?;
            self.text = rest;
            let value = match digit {
                b'A'..=b'Z' => digit - b'A',
                b'a'..=b'z' => digit - b'a' + 26,
                b'0'..=b'9' => digit - b'0' + 52,
                b'+' => 62,
                b'/' => 63,
                b'=' => 0,
                _ if digit.is_ascii_whitespace() => continue,
                _ => return None,
            };
            padding += usize::from(digit == b'=');
            bits = bits << 6 | u32::from(value);
            digits += 1;
        }
        let bytes = bits.to_be_bytes();
        self.ready.extend(&bytes[1..4 - padding.min(2)]);
        Some(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_encoded_is_decoded_and_pieces_may_follow_each_other() {
        let mut text = String::new();
        encode(b"any carnal pleas", &mut text);
        assert_eq!(text, "YW55IGNhcm5hbCBwbGVhcw==");
        encode(b"ure.", &mut text);
        let mut decoder = Decoder::new(text.as_bytes());
        assert_eq!(decoder.take(3).unwrap(), b"any");
        assert_eq!(decoder.take(17).unwrap(), b" carnal pleasure.");
        assert_eq!(decoder.take(1), None);
    }
}
