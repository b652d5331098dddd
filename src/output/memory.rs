//! Check whether a run fits into the free memory.

use std::sync::atomic::{AtomicU64, Ordering};

use super::format::bytes;
use crate::prepare::MemoryNeed;
use crate::system::free_memory;

/// Factor by which the estimate of memory may be too large: a run is refused if the estimate divided by this factor
/// exceeds the free memory.
const TOO_LARGE: f64 = 1.5;

/// Memory need of the run of this process (bytes); 0 before it is known.
static NEED: AtomicU64 = AtomicU64::new(0);

/// A run that does not fit into the free memory.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "the run needs about {} of memory (mesh {}, matrices {}, factors {}, contact {}), {} are free: use a \
     coarser mesh, end other programs, raise the limit (ulimit -v), or run on a machine with more memory",
    bytes(need.total()), bytes(need.mesh), bytes(need.matrices), bytes(need.factors), bytes(need.contact),
    bytes(*free)
)]
pub struct MemoryError {
    /// Memory need of the run.
    pub need: MemoryNeed,
    /// Number of free bytes.
    pub free: u64,
}

/// Checks that a run fits into the free memory; if the system does not report free memory, the check holds. The memory
/// need is kept for [`memory_need`].
pub fn check_memory(need: MemoryNeed) -> Result<(), MemoryError> {
    NEED.store(need.total(), Ordering::Relaxed);
    match free_memory() {
        Some(free) if need.total() as f64 / TOO_LARGE > free as f64 => {
            Err(MemoryError { need, free })
        }
        _ => Ok(()),
    }
}

/// Memory need of the run of this process (bytes), after it has been estimated.
pub fn memory_need() -> Option<u64> {
    Some(NEED.load(Ordering::Relaxed)).filter(|&need| need > 0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn need(total: u64) -> MemoryNeed {
        MemoryNeed {
            mesh: 1 << 20,
            matrices: total - (1 << 20),
            factors: 0,
            contact: 0,
        }
    }

    #[test]
    fn a_run_that_does_not_fit_is_refused_with_figures() {
        let error = MemoryError {
            need: need(3 << 40),
            free: 1 << 33,
        };
        let text = error.to_string();
        let told = ["3.3 TB of memory", "8.59 GB are free", "coarser mesh"];
        assert!(told.iter().all(|part| text.contains(part)), "{text}");
        if free_memory().is_some() {
            assert!(check_memory(need(1 << 60)).is_err());
        }
        assert_eq!(check_memory(need(1 << 21)), Ok(()));
    }
}
