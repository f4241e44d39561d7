//! The numbers of an image: pieces, strips or tiles, which are unpacked one by one.

use super::bytes::{Bytes, Ifd};
use super::{
    BITS, COMPRESSION, FORMAT, PREDICTOR, ROWS_PER_STRIP, SAMPLES, STRIP_BYTES, STRIP_OFFSETS, TILE_BYTES,
    TILE_HEIGHT, TILE_OFFSETS, TILE_WIDTH, not_read,
};
use crate::mesh::error::Fault;

/// Most bytes of a piece once it is unpacked.
const MOST_BYTES: u64 = 1 << 28;

/// How numbers are written.
#[derive(Clone, Copy)]
enum Kind {
    Unsigned(usize),
    Signed(usize),
    Float(usize),
}

impl Kind {
    fn size(self) -> usize {
        match self {
            Self::Unsigned(size) | Self::Signed(size) | Self::Float(size) => size,
        }
    }

    fn number(self, bytes: &Bytes, part: &[u8]) -> f64 {
        let whole = bytes.whole(part);
        match self {
            Self::Unsigned(_) => whole as f64,
            Self::Signed(1) => f64::from(whole as u8 as i8),
            Self::Signed(2) => f64::from(whole as u16 as i16),
            Self::Signed(_) => f64::from(whole as u32 as i32),
            Self::Float(4) => f64::from(f32::from_bits(whole as u32)),
            Self::Float(_) => f64::from_bits(whole),
        }
    }
}

/// All numbers of the image, row by row from the north.
pub(super) fn read(ifd: &Ifd, [width, height]: [usize; 2]) -> Result<Vec<f64>, Fault> {
    if ifd.number_or(SAMPLES, Some(1))? != 1 {
        return Err(not_read("an image of several bands", "save one band, as with gdal_translate -b 1"));
    }
    let kind = match (ifd.number_or(FORMAT, Some(1))?, ifd.number(BITS)?) {
        (1, bits @ (8 | 16 | 32)) => Kind::Unsigned(bits as usize / 8),
        (2, bits @ (8 | 16 | 32)) => Kind::Signed(bits as usize / 8),
        (3, bits @ (32 | 64)) => Kind::Float(bits as usize / 8),
        (_, bits) => {
            let what = format!("an image of numbers of {bits} bits of this format");
            return Err(not_read(what, "save it as Float32, as with gdal_translate -ot Float32"));
        }
    };
    let is_tiled = ifd.get(TILE_OFFSETS).is_some();
    let [columns, rows] = match is_tiled {
        true => [ifd.number(TILE_WIDTH)?, ifd.number(TILE_HEIGHT)?],
        false => [width as u64, ifd.number_or(ROWS_PER_STRIP, Some(height as u64))?.min(height as u64)],
    };
    let needed = columns.saturating_mul(rows).saturating_mul(kind.size() as u64);
    if needed == 0 || needed > MOST_BYTES {
        return Err(not_read(
            format!("an image in pieces of {columns} × {rows}"),
            "save it again, as with gdal_translate",
        ));
    }
    let [columns, rows] = [columns, rows].map(|n| n as usize);
    let tags = if is_tiled { (TILE_OFFSETS, TILE_BYTES) } else { (STRIP_OFFSETS, STRIP_BYTES) };
    let list = |tag| {
        let entry = ifd.get(tag).ok_or_else(|| Fault::truncated(format!("the tag {tag} of a TIFF")))?;
        entry.whole_numbers()
    };
    let (offsets, lengths) = (list(tags.0)?, list(tags.1)?);
    let across = width.div_ceil(columns);
    let pieces = across * height.div_ceil(rows);
    if offsets.len() < pieces || lengths.len() < pieces {
        return Err(Fault::truncated(format!("piece {} of {pieces}", offsets.len().min(lengths.len()) + 1)));
    }
    // Every piece must be there before memory is taken for all of them.
    let packed: Vec<&[u8]> = offsets
        .iter()
        .zip(&lengths)
        .take(pieces)
        .map(|(at, length)| ifd.bytes.part(*at, *length))
        .collect::<Result<_, _>>()?;
    let (compression, predictor) = (ifd.number_or(COMPRESSION, Some(1))?, ifd.number_or(PREDICTOR, Some(1))?);
    let mut numbers = vec![f64::NAN; width * height];
    for (k, packed) in packed.into_iter().enumerate() {
        let (left, top) = (k % across * columns, k / across * rows);
        let own_rows = if is_tiled { rows } else { rows.min(height - top) };
        let mut piece = unpacked(packed, compression, own_rows * columns * kind.size())?;
        undo(&mut piece, predictor, kind, columns, ifd.bytes.is_little)?;
        // Bytes of the third predictor are the highest first.
        let order = Bytes { is_little: ifd.bytes.is_little && predictor != 3, ..ifd.bytes };
        for (j, row) in piece.chunks_exact(columns * kind.size()).enumerate().take(height - top) {
            for (i, part) in row.chunks_exact(kind.size()).enumerate().take(width - left) {
                numbers[(top + j) * width + left + i] = kind.number(&order, part);
            }
        }
    }
    Ok(numbers)
}

/// The bytes of a piece, of which so many are needed.
fn unpacked(packed: &[u8], compression: u64, needed: usize) -> Result<Vec<u8>, Fault> {
    let bytes = match compression {
        1 => packed.to_vec(),
        5 => lzw(packed, needed),
        8 | 32946 => miniz_oxide::inflate::decompress_to_vec_zlib_with_limit(packed, needed)
            .unwrap_or_else(|failed| failed.output),
        other => {
            let what = format!("the compression {other} of a TIFF");
            return Err(not_read(what, "save it again, as with gdal_translate -co COMPRESS=DEFLATE"));
        }
    };
    match bytes.get(..needed) {
        Some(whole) => Ok(whole.to_vec()),
        None => Err(Fault::truncated("the rest of a piece of the image")),
    }
}

/// LZW as TIFF has it: codes of 9 to 12 bits, the highest first, longer by one before the table is full.
fn lzw(packed: &[u8], most: usize) -> Vec<u8> {
    const CLEAR: usize = 256;
    const END: usize = 257;
    let mut out: Vec<u8> = Vec::new();
    // The place and length in the output of what codes from 258 on stand for.
    let mut table: Vec<(usize, usize)> = Vec::new();
    let (mut held, mut bits, mut width) = (0u32, 0, 9);
    let mut last: Option<(usize, usize)> = None;
    for byte in packed {
        held = held << 8 | u32::from(*byte);
        bits += 8;
        if bits < width {
            continue;
        }
        bits -= width;
        let code = (held >> bits) as usize & ((1 << width) - 1);
        held &= (1 << bits) - 1;
        match code {
            CLEAR => {
                table.clear();
                (width, last) = (9, None);
                continue;
            }
            END => break,
            _ => {}
        }
        let begins = out.len();
        if code < CLEAR {
            out.push(code as u8);
        } else if let Some(&(at, length)) = table.get(code - 258) {
            (at..at + length).for_each(|k| out.push(out[k]));
        } else if let Some((at, length)) = last.filter(|_| code - 258 == table.len()) {
            // What is just being added: the last one and its first byte.
            (at..at + length).chain([at]).for_each(|k| out.push(out[k]));
        } else {
            break;
        }
        // Each code but the first adds the one before it and the first byte of its own.
        if let Some((at, length)) = last {
            table.push((at, length + 1));
        }
        last = Some((begins, out.len() - begins));
        width = match table.len() + 258 + 1 {
            0..512 => 9,
            512..1024 => 10,
            1024..2048 => 11,
            _ => 12,
        };
        if out.len() >= most {
            break;
        }
    }
    out
}

/// Turns differences of neighbours in each row back into numbers.
fn undo(piece: &mut [u8], predictor: u64, kind: Kind, columns: usize, is_little: bool) -> Result<(), Fault> {
    let size = kind.size();
    match predictor {
        1 => {}
        2 if !matches!(kind, Kind::Float(_)) => {
            for row in piece.chunks_exact_mut(columns * size) {
                for k in 1..columns {
                    let mut carry = 0;
                    for byte in 0..size {
                        // The lowest byte first, whatever the order in the file.
                        let place = if is_little { byte } else { size - 1 - byte };
                        let sum =
                            u16::from(row[k * size + place]) + u16::from(row[(k - 1) * size + place]) + carry;
                        row[k * size + place] = sum as u8;
                        carry = sum >> 8;
                    }
                }
            }
        }
        3 if matches!(kind, Kind::Float(_)) => {
            for row in piece.chunks_exact_mut(columns * size) {
                for k in 1..row.len() {
                    row[k] = row[k].wrapping_add(row[k - 1]);
                }
                // All highest bytes come first, then all second ones, and so on.
                let planes = row.to_vec();
                for (k, byte) in row.iter_mut().enumerate() {
                    *byte = planes[k % size * columns + k / size];
                }
            }
        }
        other => {
            let what = format!("the predictor {other} of a TIFF");
            return Err(not_read(what, "save it again, as with gdal_translate -co PREDICTOR=1"));
        }
    }
    Ok(())
}
