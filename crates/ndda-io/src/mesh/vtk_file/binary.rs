//! Numbers as bytes.

/// A type of numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    F32,
    F64,
    I8,
    I16,
    I32,
    I64,
    U8,
    U16,
    U32,
    U64,
}

impl Kind {
    /// By its name in XML or in the legacy format, in small letters.
    pub(crate) fn find(name: &str) -> Option<Self> {
        Some(match name {
            "float32" | "float" => Self::F32,
            "float64" | "double" => Self::F64,
            "int8" | "char" | "signed_char" => Self::I8,
            "int16" | "short" => Self::I16,
            "int32" | "int" | "vtkidtype" => Self::I32,
            "int64" | "long" | "vtktypeint64" => Self::I64,
            "uint8" | "unsigned_char" => Self::U8,
            "uint16" | "unsigned_short" => Self::U16,
            "uint32" | "unsigned_int" => Self::U32,
            "uint64" | "unsigned_long" | "vtktypeuint64" => Self::U64,
            _ => return None,
        })
    }

    /// Bytes of a number.
    pub(crate) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::F32 | Self::I32 | Self::U32 => 4,
            Self::F64 | Self::I64 | Self::U64 => 8,
        }
    }

    /// Numbers from bytes, the lowest first or last; bytes that make no whole number are left out.
    pub(crate) fn numbers(self, bytes: &[u8], is_big: bool) -> Vec<f64> {
        let raw = |chunk: &[u8]| {
            let digit = |value: u64, byte: &u8| value << 8 | u64::from(*byte);
            if is_big { chunk.iter().fold(0, digit) } else { chunk.iter().rev().fold(0, digit) }
        };
        let number = |bits: u64| match self {
            Self::F32 => f64::from(f32::from_bits(bits as u32)),
            Self::F64 => f64::from_bits(bits),
            Self::I8 => f64::from(bits as i8),
            Self::I16 => f64::from(bits as i16),
            Self::I32 => f64::from(bits as i32),
            Self::I64 => bits as i64 as f64,
            _ => bits as f64,
        };
        bytes.chunks_exact(self.size()).map(|chunk| number(raw(chunk))).collect()
    }
}
