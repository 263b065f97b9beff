//! The numbers of an array of VTK's XML formats from its bytes.
//!
//! A header of whole numbers stands before the data. Not compressed it is the number of bytes; compressed it is the number of
//! blocks, the bytes of a block before and of the last block, then the compressed bytes of each block.

use std::io::Read;

/// How a file stores its arrays.
#[derive(Debug, Clone, Copy, Default)]
pub struct Coding {
    big_endian: bool,
    /// Whether a number of a header has 8 bytes, and not 4.
    wide: bool,
    packing: Option<Packing>,
}

/// Bytes that a compressed byte may give: deflate gives 1032 at most. LZMA could give more, and in the blocks of 32 KiB that programs
/// write it does not.
const LARGEST_RATIO: u64 = 1100;

/// How arrays are compressed.
#[derive(Debug, Clone, Copy)]
enum Packing {
    Zlib,
    /// In the container of xz.
    Lzma,
}

/// What the decoder of LZMA may take, KiB: the dictionary of the highest level has 64 MiB.
const DICTIONARY: u32 = 66 << 10;

/// The type of the numbers of an array.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Number {
    /// Whole numbers, by their bytes.
    Signed(usize),
    /// Whole numbers from 0, by their bytes.
    Unsigned(usize),
    /// Real numbers, by their bytes.
    Real(usize),
}

impl Number {
    /// A type by its name in a file.
    pub fn of(name: &str) -> Option<Self> {
        Some(match name {
            "Int8" => Number::Signed(1),
            "Int16" => Number::Signed(2),
            "Int32" => Number::Signed(4),
            "Int64" => Number::Signed(8),
            "UInt8" => Number::Unsigned(1),
            "UInt16" => Number::Unsigned(2),
            "UInt32" => Number::Unsigned(4),
            "UInt64" => Number::Unsigned(8),
            "Float32" => Number::Real(4),
            "Float64" => Number::Real(8),
            _ => return None,
        })
    }

    /// Whether its values are whole.
    pub fn is_whole(self) -> bool {
        !matches!(self, Number::Real(_))
    }

    fn bytes(self) -> usize {
        match self {
            Number::Signed(n) | Number::Unsigned(n) | Number::Real(n) => n,
        }
    }

    /// A number from its bytes, the lowest first.
    fn value(self, bytes: &[u8]) -> f64 {
        let mut wide = [0; 8];
        wide[..bytes.len()].copy_from_slice(bytes);
        let whole = u64::from_le_bytes(wide);
        match self {
            Number::Unsigned(_) => whole as f64,
            Number::Signed(n) => {
                let unused = 64 - 8 * n as u32;
                ((whole << unused) as i64 >> unused) as f64
            }
            Number::Real(4) => f64::from(f32::from_bits(whole as u32)),
            Number::Real(_) => f64::from_bits(whole),
        }
    }
}

impl Coding {
    /// From the attributes of a file.
    ///
    /// # Errors
    /// A value that is not known.
    pub fn of(order: Option<&str>, header: Option<&str>, compressor: Option<&str>) -> Result<Self, String> {
        let big_endian = match order {
            None | Some("LittleEndian") => false,
            Some("BigEndian") => true,
            Some(other) => return Err(format!("the byte order `{other}` is not known")),
        };
        let wide = match header {
            None | Some("UInt32") => false,
            Some("UInt64") => true,
            Some(other) => return Err(format!("the type `{other}` of headers is not known")),
        };
        let packing = match compressor {
            None | Some("") => None,
            Some("vtkZLibDataCompressor") => Some(Packing::Zlib),
            Some("vtkLZMADataCompressor") => Some(Packing::Lzma),
            Some(other) => {
                return Err(format!("it is compressed by `{other}`; zlib, LZMA or no compression can be read"));
            }
        };
        Ok(Self { big_endian, wide, packing })
    }

    /// Numbers that stand as text.
    ///
    /// # Errors
    /// A word that is no number, more or fewer than `count`.
    pub fn text(&self, text: &[u8], count: usize) -> Result<Vec<f64>, String> {
        let text = std::str::from_utf8(text).map_err(|_| "it is not text".to_owned())?;
        let mut values = Vec::new();
        for word in text.split_ascii_whitespace() {
            values.push(word.parse().map_err(|_| format!("`{}` is not a number", shortened(word)))?);
        }
        self.counted(values, count)
    }

    /// Numbers in base64, each part of which may end in `=`.
    ///
    /// # Errors
    /// A character that is not of base64; another count than `count`.
    pub fn base64(&self, text: &[u8], number: Number, count: usize) -> Result<Vec<f64>, String> {
        let decode = |most: usize| base64(text, most);
        self.numbers(&decode, number, count)
    }

    /// Numbers as bytes.
    ///
    /// # Errors
    /// Another count than `count`.
    pub fn raw(&self, bytes: &[u8], number: Number, count: usize) -> Result<Vec<f64>, String> {
        let decode = |most: usize| Ok(bytes[..bytes.len().min(most)].to_vec());
        self.numbers(&decode, number, count)
    }

    /// Numbers of an array whose first bytes `decode` gives, up to so many.
    fn numbers(
        &self,
        decode: &dyn Fn(usize) -> Result<Vec<u8>, String>,
        number: Number,
        count: usize,
    ) -> Result<Vec<f64>, String> {
        let wanted = count.checked_mul(number.bytes()).ok_or("it claims more numbers than a file can have")?;
        let data = match self.packing {
            Some(packing) => self.unpacked(decode, wanted, packing)?,
            None => self.plain(decode, wanted)?,
        };
        let value = |bytes: &[u8]| {
            let mut own = [0; 8];
            let own = &mut own[..bytes.len()];
            own.copy_from_slice(bytes);
            if self.big_endian {
                own.reverse();
            }
            number.value(own)
        };
        self.counted(data.chunks_exact(number.bytes()).map(value).collect(), count)
    }

    fn plain(&self, decode: &dyn Fn(usize) -> Result<Vec<u8>, String>, wanted: usize) -> Result<Vec<u8>, String> {
        let size = self.size();
        let mut bytes = decode(wanted.saturating_add(size))?;
        let said = self.head(&bytes, 0).ok_or("it ends within its header")?;
        if said != wanted as u64 {
            return Err(format!("its header says {said} bytes, and its points need {wanted}"));
        }
        bytes.drain(..size);
        Ok(bytes)
    }

    fn unpacked(
        &self,
        decode: &dyn Fn(usize) -> Result<Vec<u8>, String>,
        wanted: usize,
        packing: Packing,
    ) -> Result<Vec<u8>, String> {
        let size = self.size();
        let short = || "it ends within its header".to_owned();
        let blocks = self.head(&decode(size)?, 0).ok_or_else(short)?;
        let header = usize::try_from(blocks).ok().and_then(|blocks| blocks.checked_add(3)?.checked_mul(size));
        let header = header.ok_or_else(short)?;
        let head = decode(header)?;
        let mut lengths = Vec::new();
        for block in 3..header / size {
            // `head` is no longer than the file: a count of blocks that is too large ends here.
            let length = self.head(&head, block).and_then(|length| usize::try_from(length).ok());
            lengths.push(length.ok_or_else(short)?);
        }
        let all = lengths.iter().try_fold(header, |sum, length| sum.checked_add(*length)).ok_or_else(short)?;
        let bytes = decode(all)?;
        let (mut out, mut at) = (Vec::new(), header);
        for length in lengths {
            let block = bytes.get(at..at + length).ok_or("it ends within a compressed block")?;
            at += length;
            let most = ((wanted - out.len()) as u64 + 1).min(LARGEST_RATIO.saturating_mul(length as u64));
            let read = packing.reader(block).take(most).read_to_end(&mut out);
            read.map_err(|why| format!("a compressed block is damaged: {why}"))?;
            if out.len() > wanted {
                return Err(format!("it has more than the {wanted} bytes that its points need"));
            }
        }
        Ok(out)
    }

    /// Bytes of a number of a header.
    fn size(&self) -> usize {
        if self.wide { 8 } else { 4 }
    }

    /// The number of this place in a header.
    fn head(&self, bytes: &[u8], place: usize) -> Option<u64> {
        let own = bytes.get(place * self.size()..)?.get(..self.size())?;
        let sum = |own: &mut dyn Iterator<Item = &u8>| own.fold(0, |sum, byte| sum << 8 | u64::from(*byte));
        Some(if self.big_endian { sum(&mut own.iter()) } else { sum(&mut own.iter().rev()) })
    }

    fn counted(&self, values: Vec<f64>, count: usize) -> Result<Vec<f64>, String> {
        match values.len() == count {
            true => Ok(values),
            false => Err(format!("it has {} numbers, and its points need {count}", values.len())),
        }
    }
}

impl Packing {
    /// The bytes of a compressed block.
    fn reader(self, block: &[u8]) -> Box<dyn Read + '_> {
        match self {
            Packing::Zlib => Box::new(flate2::read::ZlibDecoder::new(block)),
            Packing::Lzma => Box::new(lzma_rust2::XzReader::new_mem_limit(block, false, DICTIONARY)),
        }
    }
}

/// The first bytes of a text in base64, up to so many; blanks are skipped, and parts that end in `=` follow each other. It ends at
/// `<`, where an element does.
fn base64(text: &[u8], most: usize) -> Result<Vec<u8>, String> {
    let (mut out, mut bits, mut digits) = (Vec::new(), 0_u32, 0);
    for &character in text {
        let digit = match character {
            b'A'..=b'Z' => character - b'A',
            b'a'..=b'z' => character - b'a' + 26,
            b'0'..=b'9' => character - b'0' + 52,
            b'+' => 62,
            b'/' => 63,
            b'=' => {
                // What is left of the last character are bits of no byte.
                (bits, digits) = (0, 0);
                continue;
            }
            b'<' => break,
            _ if character.is_ascii_whitespace() => continue,
            _ => return Err("it has a character that is not of base64".to_owned()),
        };
        (bits, digits) = ((bits << 6 | u32::from(digit)) & 0xfff, digits + 1);
        if digits > 1 {
            // 2, 3, 4 digits have 4, 2, 0 bits beyond the byte that they complete.
            let beyond = 8 - 2 * digits;
            out.push((bits >> beyond) as u8);
            if out.len() >= most {
                break;
            }
        }
        digits %= 4;
    }
    Ok(out)
}

fn shortened(word: &str) -> String {
    word.chars().take(20).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_is_that_of_the_standard_and_its_parts_follow_each_other() {
        // RFC 4648, section 10.
        for (text, bytes) in
            [("", ""), ("Zg==", "f"), ("Zm8=", "fo"), ("Zm9v", "foo"), ("Zm9vYg==", "foob"), ("Zm9vYmE=", "fooba")]
        {
            assert_eq!(base64(text.as_bytes(), 99).unwrap(), bytes.as_bytes(), "{text}");
        }
        assert_eq!(base64(b" Zg==\nZm9v<", 99).unwrap(), b"ffoo");
        assert_eq!(base64(b"Zm9vYmFy", 4).unwrap(), b"foob");
        assert!(base64(b"Zm9*", 9).is_err());
    }

    #[test]
    fn numbers_of_each_type_and_order_have_their_value() {
        let big = Coding { big_endian: true, ..Coding::default() };
        let raw = |coding: &Coding, bytes: &[u8], name, count| coding.raw(bytes, Number::of(name).unwrap(), count);
        let little = Coding::default();
        assert_eq!(raw(&little, &[2, 0, 0, 0, 0xfe, 0xff], "Int16", 1).unwrap(), [-2.0]);
        assert_eq!(raw(&big, &[0, 0, 0, 2, 0xff, 0xfe], "Int16", 1).unwrap(), [-2.0]);
        assert_eq!(raw(&little, &[1, 0, 0, 0, 200], "UInt8", 1).unwrap(), [200.0]);
        assert_eq!(raw(&little, &[4, 0, 0, 0, 0, 0, 0xc0, 0x3f], "Float32", 1).unwrap(), [1.5]);
        assert!(raw(&little, &[4, 0, 0, 0, 0, 0], "Float32", 1).unwrap_err().contains("0 numbers"));
        assert!(raw(&little, &[9, 0, 0, 0, 0, 0], "Float32", 1).unwrap_err().contains("its header says 9 bytes"));
    }

    #[test]
    fn blocks_of_zlib_follow_each_other_and_their_header_may_be_encoded_apart() {
        use base64::{Engine, engine::general_purpose::STANDARD};
        use std::io::Write;
        let values = [1.5, -2.25, 3.0, 1e300, 0.1];
        let bytes: Vec<u8> = values.iter().flat_map(|x: &f64| x.to_le_bytes()).collect();
        let packed = |part: &[u8]| {
            let mut encoder = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::default());
            encoder.write_all(part).unwrap();
            encoder.finish().unwrap()
        };
        // Blocks of 16 bytes, the last of 8.
        let blocks: Vec<Vec<u8>> = bytes.chunks(16).map(packed).collect();
        let lengths = blocks.iter().map(|block| block.len() as u32);
        let header: Vec<u8> = [3, 16, 8].into_iter().chain(lengths).flat_map(u32::to_le_bytes).collect();
        let zlib = Coding { packing: Some(Packing::Zlib), ..Coding::default() };
        let all = [header.clone(), blocks.concat()].concat();
        assert_eq!(zlib.raw(&all, Number::Real(8), 5).unwrap(), values);
        // As VTK and meshio do.
        let text = STANDARD.encode(header) + &STANDARD.encode(blocks.concat());
        assert_eq!(zlib.base64(text.as_bytes(), Number::Real(8), 5).unwrap(), values);
        assert!(zlib.base64(text.as_bytes(), Number::Real(8), 4).unwrap_err().contains("more than the 32 bytes"));
    }

    #[test]
    fn a_compressed_array_that_claims_too_much_is_refused_without_the_memory() {
        let zlib = Coding { packing: Some(Packing::Zlib), ..Coding::default() };
        let bytes = [u32::MAX, 1 << 15, 0, 7].map(u32::to_le_bytes).concat();
        assert!(zlib.raw(&bytes, Number::Real(8), 3).unwrap_err().contains("ends within its header"));
        let bytes = [1, 8, 8, u32::MAX].map(u32::to_le_bytes).concat();
        assert!(zlib.raw(&bytes, Number::Real(8), 3).unwrap_err().contains("ends within a compressed block"));
    }
}
