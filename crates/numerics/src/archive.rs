//! Archive of the values that a run hands on from increment to increment, one after the other and exact to the bit. One
//! function `transfer` of each structure lists the values of the archive, both for writing and for reading, so that the
//! order of reading cannot differ from the order of writing. See docs/restart.md.

use serde::Serialize;
use serde::de::DeserializeOwned;

/// Values that are written, or read in the same order.
pub enum Archive<'a> {
    /// The bytes that have been written.
    Writing(Vec<u8>),
    /// The bytes that are left to read.
    Reading(&'a [u8]),
}

/// Reason why an archive cannot be read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum ArchiveError {
    /// The archive ends early, or a value does not have its type.
    #[error("its content is not that of a checkpoint")]
    Content,
    /// The archive belongs to a model of another size.
    #[error("it is of another model")]
    Size,
    /// The matrix in the archive cannot be factorised.
    #[error("its matrix has no factors")]
    Factors,
}

/// Transfers the fields of a structure: fields in brackets by their own functions `transfer`; fields behind the
/// semicolon are left out. A field that is not named gives a compiler error.
#[macro_export]
macro_rules! transfer_fields {
    ($archive:ident, $of:expr => $type:ident {
        $([$($part:ident),*])? $($field:ident),* $(; $($left:ident),*)?
    }) => {{
        let $type { $($($part,)*)? $($field,)* $($($left: _,)*)? } = $of;
        $($($part.transfer($archive)?;)*)?
        $($archive.transfer($field)?;)*
        Ok::<(), $crate::archive::ArchiveError>(())
    }};
}
pub use transfer_fields;

impl Archive<'_> {
    /// An empty archive for writing.
    pub fn new() -> Self {
        Archive::Writing(Vec::new())
    }

    /// The bytes that have been written.
    pub fn into_bytes(self) -> Vec<u8> {
        match self {
            Archive::Writing(bytes) => bytes,
            Archive::Reading(_) => Vec::new(),
        }
    }

    /// Whether values are read.
    pub fn is_reading(&self) -> bool {
        matches!(self, Archive::Reading(_))
    }

    /// Writes a value, or replaces it by the value that is read.
    ///
    /// # Errors
    /// The archive holds a value of another type.
    pub fn transfer<T: Serialize + DeserializeOwned>(
        &mut self,
        value: &mut T,
    ) -> Result<(), ArchiveError> {
        match self {
            Archive::Writing(bytes) => {
                let written = postcard::to_extend(value, std::mem::take(bytes));
                *bytes = written.map_err(|_| ArchiveError::Content)?;
            }
            Archive::Reading(bytes) => {
                let read = postcard::take_from_bytes(bytes);
                (*value, *bytes) = read.map_err(|_| ArchiveError::Content)?;
            }
        }
        Ok(())
    }

    /// Writes values, or replaces them by values that are read.
    ///
    /// # Errors
    /// The archive holds values of another type, or another number of them.
    pub fn transfer_values<T: Serialize + DeserializeOwned + Clone>(
        &mut self,
        values: &mut [T],
    ) -> Result<(), ArchiveError> {
        let mut all = values.to_vec();
        self.transfer(&mut all)?;
        if all.len() != values.len() {
            return Err(ArchiveError::Size);
        }
        values.clone_from_slice(&all);
        Ok(())
    }
}

impl Default for Archive<'_> {
    fn default() -> Self {
        Archive::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_come_back_bit_by_bit() {
        let numbers = [0.1, -0.0, f64::NAN, f64::INFINITY, 5e-324, 1e300];
        let mut archive = Archive::new();
        let (mut values, mut more) = (numbers, Some(vec![(3_usize, "text".to_owned())]));
        archive.transfer_values(&mut values).expect("written");
        archive.transfer(&mut more).expect("written");
        let bytes = archive.into_bytes();
        let mut archive = Archive::Reading(&bytes);
        (values, more) = ([0.0; 6], None);
        archive.transfer_values(&mut values).expect("read");
        archive.transfer(&mut more).expect("read");
        assert_eq!(values.map(f64::to_bits), numbers.map(f64::to_bits));
        assert_eq!(more, Some(vec![(3, "text".to_owned())]));
        let mut values = [0.0; 5];
        let other = Archive::Reading(&bytes).transfer_values(&mut values);
        assert_eq!(other, Err(ArchiveError::Size));
        let cut = Archive::Reading(&bytes[..20]).transfer_values(&mut values);
        assert_eq!(cut, Err(ArchiveError::Content));
    }
}
