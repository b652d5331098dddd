//! Memory for the entries of factors, in large pages where the system has them: substitutions read the entries from
//! one end to the other, and a processor reads ahead within a page only. Section 5 of docs/theory.md, One solve.

use std::ops::{Deref, DerefMut};

use bytemuck::{cast_slice, cast_slice_mut};
use memmap2::MmapMut;

/// Entries in a line of the cache.
pub const LINE: usize = 64 / size_of::<f64>();

/// Entries that begin a line of the cache; zero at first.
#[derive(Debug, Default)]
pub struct Entries {
    memory: Option<MmapMut>,
    /// Those for which the system gives no memory of whole pages; their length says so.
    plain: Vec<f64>,
}

impl Entries {
    /// So many zeros.
    pub fn zeros(count: usize) -> Self {
        match MmapMut::map_anon(count * size_of::<f64>()) {
            Ok(memory) if count > 0 => Entries {
                memory: Some(in_large_pages(memory)),
                plain: Vec::new(),
            },
            _ => Entries {
                memory: None,
                plain: vec![0.0; count],
            },
        }
    }
}

/// Part of the entries asked for by which there is more room, so that a few more do not take other memory: the
/// system gives memory for what is written only.
const SPARE: usize = 8;

impl Entries {
    /// Room for so many entries at least, in the memory at hand where it is enough; of any value.
    pub fn make_room(&mut self, count: usize) {
        if self.len() < count {
            *self = Entries::default();
            *self = Entries::zeros(count + count / SPARE);
        }
    }
}

/// Asks for large pages: without them all is as it was.
#[cfg(target_os = "linux")]
fn in_large_pages(memory: MmapMut) -> MmapMut {
    let _ = memory.advise(memmap2::Advice::HugePage);
    memory
}

#[cfg(not(target_os = "linux"))]
fn in_large_pages(memory: MmapMut) -> MmapMut {
    memory
}

impl Deref for Entries {
    type Target = [f64];

    fn deref(&self) -> &[f64] {
        match &self.memory {
            Some(memory) => cast_slice(memory),
            None => &self.plain,
        }
    }
}

impl DerefMut for Entries {
    fn deref_mut(&mut self) -> &mut [f64] {
        match &mut self.memory {
            Some(memory) => cast_slice_mut(memory),
            None => &mut self.plain,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_number_of_entries_is_zero_and_can_be_written() {
        for count in [0, 1, 7, 1000, 600_000] {
            let mut entries = Entries::zeros(count);
            assert!(entries.len() == count && entries.iter().all(|&entry| entry == 0.0));
            entries
                .iter_mut()
                .zip(1..)
                .for_each(|(entry, k)| *entry = f64::from(k));
            assert_eq!(
                entries.iter().sum::<f64>(),
                (count * (count + 1) / 2) as f64
            );
        }
    }
}
