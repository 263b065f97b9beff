//! Numbers of what lives on from step to step, in the order in which they are taken back: what a checkpoint holds of an observer,
//! a rule, a report. Reals keep their bits.

use crate::error::{Error, Result};
use crate::lane::F8;

/// Numbers that are being saved.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Words(pub Vec<u64>);

/// Numbers that were saved, to be taken in the same order.
#[derive(Debug, Clone)]
pub struct Saved<'a> {
    words: &'a [u64],
}

impl Words {
    /// Adds a real number.
    pub fn real(&mut self, value: f64) -> &mut Self {
        self.0.push(value.to_bits());
        self
    }

    /// Adds a count.
    pub fn count(&mut self, value: usize) -> &mut Self {
        self.0.push(value as u64);
        self
    }

    /// Adds a yes or no.
    pub fn flag(&mut self, value: bool) -> &mut Self {
        self.count(usize::from(value))
    }

    /// Adds real numbers, with their count.
    pub fn reals(&mut self, values: &[f64]) -> &mut Self {
        self.count(values.len());
        self.0.extend(values.iter().map(|value| value.to_bits()));
        self
    }

    /// Adds numbers of blocks, with their count.
    pub fn blocks(&mut self, values: &[F8]) -> &mut Self {
        self.count(values.len());
        self.0.extend(values.iter().flat_map(|value| value.0).map(f64::to_bits));
        self
    }

    /// Adds a text.
    pub fn text(&mut self, text: &str) -> &mut Self {
        self.count(text.len());
        self.0.extend(text.bytes().map(u64::from));
        self
    }

    /// The numbers, to be taken from the first on.
    pub fn saved(&self) -> Saved<'_> {
        Saved { words: &self.0 }
    }
}

impl Saved<'_> {
    /// Takes a real number.
    ///
    /// # Errors
    /// There is none left: it was saved by something else.
    pub fn real(&mut self) -> Result<f64> {
        self.word().map(f64::from_bits)
    }

    /// Takes a count.
    ///
    /// # Errors
    /// As for [`Saved::real`].
    pub fn count(&mut self) -> Result<usize> {
        usize::try_from(self.word()?).map_err(|_| misfit())
    }

    /// Takes a yes or no.
    ///
    /// # Errors
    /// As for [`Saved::real`].
    pub fn flag(&mut self) -> Result<bool> {
        match self.word()? {
            0 => Ok(false),
            1 => Ok(true),
            _ => Err(misfit()),
        }
    }

    /// Takes so many real numbers.
    ///
    /// # Errors
    /// As for [`Saved::real`].
    pub fn array<const N: usize>(&mut self) -> Result<[f64; N]> {
        let mut out = [0.0; N];
        out.iter_mut().try_for_each(|out| self.real().map(|value| *out = value))?;
        Ok(out)
    }

    /// Takes real numbers with their count.
    ///
    /// # Errors
    /// As for [`Saved::real`].
    pub fn reals(&mut self) -> Result<Vec<f64>> {
        let count = self.count()?;
        Ok(self.many(count)?.iter().copied().map(f64::from_bits).collect())
    }

    /// Takes numbers of blocks with their count.
    ///
    /// # Errors
    /// As for [`Saved::real`].
    pub fn blocks(&mut self) -> Result<Vec<F8>> {
        let count = self.count()?.checked_mul(crate::lane::LANES).ok_or_else(misfit)?;
        let words = self.many(count)?.as_chunks().0;
        Ok(words.iter().map(|lanes| F8(lanes.map(f64::from_bits))).collect())
    }

    /// Takes a text.
    ///
    /// # Errors
    /// As for [`Saved::real`].
    pub fn text(&mut self) -> Result<String> {
        let count = self.count()?;
        let bytes: Option<Vec<u8>> = self.many(count)?.iter().map(|&word| u8::try_from(word).ok()).collect();
        bytes.and_then(|bytes| String::from_utf8(bytes).ok()).ok_or_else(misfit)
    }

    /// Takes all that are left, for nobody.
    pub fn skip(&mut self) {
        self.words = &[];
    }

    /// Whether all have been taken.
    ///
    /// # Errors
    /// Some are left: they were saved by something else.
    pub fn end(&self) -> Result<()> {
        if self.words.is_empty() { Ok(()) } else { Err(misfit()) }
    }

    fn word(&mut self) -> Result<u64> {
        Ok(self.many(1)?[0])
    }

    fn many(&mut self, count: usize) -> Result<&[u64]> {
        let (taken, rest) = self.words.split_at_checked(count).ok_or_else(misfit)?;
        self.words = rest;
        Ok(taken)
    }
}

fn misfit() -> Error {
    let what = "the checkpoint was saved by a run with other outputs or by another version of the program";
    Error::input(what, "resume the run by the program that wrote it, or run the scene again with --force")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_saved_is_taken_back_to_the_bit_and_nothing_more() {
        let mut words = Words::default();
        words.real(f64::NAN).count(7).flag(true).reals(&[-0.0, 0.1]).text("grad é").blocks(&[F8([0.3; 8]); 2]);
        let mut saved = words.saved();
        assert!(saved.real().unwrap().is_nan());
        assert_eq!((saved.count().unwrap(), saved.flag().unwrap()), (7, true));
        let reals = saved.reals().unwrap();
        assert!(reals[0].is_sign_negative() && reals == [0.0, 0.1]);
        assert_eq!(saved.text().unwrap(), "grad é");
        assert!(saved.end().is_err());
        assert_eq!(saved.blocks().unwrap(), [F8([0.3; 8]); 2]);
        assert!(saved.end().is_ok() && saved.real().is_err());
    }

    #[test]
    fn a_count_of_more_than_there_is_is_an_error() {
        let words = Words(vec![u64::MAX, 1]);
        assert!(words.saved().reals().is_err() && words.saved().blocks().is_err() && words.saved().text().is_err());
    }
}
