//! Numbers and words from the bytes of a file, text or binary alike.

use std::str::FromStr;

use super::error::{At, Error};

/// The bytes of a file and a place in them.
pub struct Source<'a> {
    bytes: &'a [u8],
    at: usize,
    /// The start of the last number or word that was read, for messages.
    mark: usize,
    /// Whether numbers are binary (little-endian) from here on.
    pub binary: bool,
}

impl<'a> Source<'a> {
    pub fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, at: 0, mark: 0, binary: false }
    }

    /// Whether nothing but blanks is left.
    pub fn at_end(&mut self) -> bool {
        self.skip_blanks();
        self.at == self.bytes.len()
    }

    fn rest(&self) -> &'a [u8] {
        &self.bytes[self.at..]
    }

    fn skip_blanks(&mut self) {
        self.at += self.rest().iter().take_while(|b| b.is_ascii_whitespace()).count();
    }

    /// The next word of text; empty at the end.
    pub fn word(&mut self) -> &'a [u8] {
        self.skip_blanks();
        self.mark = self.at;
        let word = self.rest();
        let word = &word[..word.iter().take_while(|b| !b.is_ascii_whitespace()).count()];
        self.at += word.len();
        word
    }

    /// Returns the rest of the line, and moves to the next line.
    pub fn line(&mut self) -> &'a [u8] {
        self.mark = self.at;
        let rest = self.rest();
        let length = rest.iter().position(|&b| b == b'\n').unwrap_or(rest.len());
        self.at += (length + 1).min(rest.len());
        rest[..length].trim_ascii()
    }

    /// Moves to the line after the next `$End` with this name: skips a section that is not read.
    pub fn skip_section(&mut self, name: &str) -> Result<(), Error> {
        let end = format!("\n$End{name}").into_bytes();
        self.mark = self.at;
        // One back, for a section that is empty.
        self.at = self.at.saturating_sub(1);
        match self.rest().windows(end.len()).position(|w| w == end) {
            Some(length) => {
                self.at += length + end.len();
                self.line();
                Ok(())
            }
            None => Err(self.wrong(format!("`$End{name}`"))),
        }
    }

    /// A number that is written as text, in text and binary files.
    pub fn number<T: FromStr>(&mut self, what: &str) -> Result<T, Error> {
        let text = std::str::from_utf8(self.word()).ok();
        text.and_then(|text| text.parse().ok()).ok_or_else(|| self.wrong(what))
    }

    fn take<const N: usize>(&mut self, what: &str) -> Result<[u8; N], Error> {
        self.mark = self.at;
        let bytes = self.rest().first_chunk().copied().ok_or_else(|| self.wrong(what))?;
        self.at += N;
        Ok(bytes)
    }

    /// A C `int`.
    pub fn int(&mut self, what: &str) -> Result<i32, Error> {
        if self.binary { Ok(i32::from_le_bytes(self.take(what)?)) } else { self.number(what) }
    }

    /// A C `size_t` of 8 bytes.
    pub fn size(&mut self, what: &str) -> Result<u64, Error> {
        if self.binary { Ok(u64::from_le_bytes(self.take(what)?)) } else { self.number(what) }
    }

    /// A C `double`.
    pub fn double(&mut self, what: &str) -> Result<f64, Error> {
        if self.binary { Ok(f64::from_le_bytes(self.take(what)?)) } else { self.number(what) }
    }

    /// A `count` of items that was just read, if the rest of the file is long enough for so many items. `bytes` is the
    /// size of an item in a binary file; in a text file each number of an item takes 2 bytes or more.
    pub fn fits(&self, count: u64, numbers: usize, bytes: usize, what: &str) -> Result<usize, Error> {
        let each = if self.binary { bytes } else { 2 * numbers };
        // One more: the last number of a text file may stand without a blank behind it.
        let room = (self.rest().len() + 1) / each.max(1);
        match usize::try_from(count) {
            Ok(count) if count <= room => Ok(count),
            _ => {
                let expected = format!("a number of {what} that the rest of the file can hold");
                Err(Error::Syntax { at: self.place(), expected, found: format!("it says {count}") })
            }
        }
    }

    /// The error: at the place of the last number or word, the format has something else.
    pub fn wrong(&self, expected: impl Into<String>) -> Error {
        let rest = &self.bytes[self.mark..];
        let shown = &rest[..rest.iter().take(30).take_while(|&&b| b != b'\n').count()];
        let found = if rest.is_empty() {
            "the file ends".to_owned()
        } else if self.binary {
            "found other bytes".to_owned()
        } else {
            format!("found `{}`", String::from_utf8_lossy(shown).trim())
        };
        Error::Syntax { at: self.place(), expected: expected.into(), found }
    }

    fn place(&self) -> At {
        if self.binary {
            return At::Byte(self.mark);
        }
        let before = &self.bytes[..self.mark];
        let line = before.iter().filter(|&&b| b == b'\n').count() + 1;
        let column = before.iter().rev().take_while(|&&b| b != b'\n').count() + 1;
        At::Line(line, column)
    }
}
