//! Memory: the most that this process has used, what is free on this machine, and whether a run fits.

use std::fs::read_to_string;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use rustix::process::{Resource, getrlimit};

use super::format::bytes;
use crate::prepare::MemoryNeed;

/// A run whose estimated need, divided by this, is not free is refused: the estimate may be too large by
/// as much.
const TOO_LARGE: f64 = 1.5;

/// What the run of this process needs (bytes); 0 before it is known.
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
    /// What the run needs.
    pub need: MemoryNeed,
    /// Bytes that are free.
    pub free: u64,
}

/// Checks that a run fits into the memory that is free; always where the system does not tell. What it
/// needs is kept for [`memory_need`].
pub fn check_memory(need: MemoryNeed) -> Result<(), MemoryError> {
    NEED.store(need.total(), Ordering::Relaxed);
    match free_memory() {
        Some(free) if need.total() as f64 / TOO_LARGE > free as f64 => {
            Err(MemoryError { need, free })
        }
        _ => Ok(()),
    }
}

/// Bytes that the run of this process needs, once they are estimated.
pub fn memory_need() -> Option<u64> {
    Some(NEED.load(Ordering::Relaxed)).filter(|&need| need > 0)
}

/// Most bytes resident at a time in this process so far; none where the system does not tell.
pub(crate) fn peak_memory() -> Option<u64> {
    kilobytes(&read_to_string("/proc/self/status").ok()?, "VmHWM:")
}

/// Bytes that are free: on the machine, with what swaps, in the groups of this process that have a
/// limit, and below the limits of the process itself (`ulimit -v`, `ulimit -d`).
fn free_memory() -> Option<u64> {
    let machine = read_to_string("/proc/meminfo").ok()?;
    let swap = kilobytes(&machine, "SwapFree:").unwrap_or(0);
    let free = kilobytes(&machine, "MemAvailable:")? + swap;
    let groups = read_to_string("/proc/self/cgroup").unwrap_or_default();
    let folders = groups.lines().flat_map(group_folders);
    let limits = folders.filter_map(|folder| free_in_group(&folder));
    Some(limits.chain(free_in_process()).fold(free, u64::min))
}

/// Bytes free below the limits of this process: of its addresses and of its data.
fn free_in_process() -> impl Iterator<Item = u64> {
    let status = read_to_string("/proc/self/status").unwrap_or_default();
    let limits = [(Resource::As, "VmSize:"), (Resource::Data, "VmData:")];
    limits.into_iter().filter_map(move |(resource, used)| {
        let limit = getrlimit(resource).current?;
        Some(limit.saturating_sub(kilobytes(&status, used)?))
    })
}

/// Folders of the control group of a line of /proc/self/cgroup (of version 2) and of those around it.
fn group_folders(line: &str) -> Vec<PathBuf> {
    let path = line.strip_prefix("0::/").map(Path::new);
    let root = Path::new("/sys/fs/cgroup");
    path.map_or(Vec::new(), |path| {
        path.ancestors().map(|path| root.join(path)).collect()
    })
}

/// Bytes free below the limit of a control group, where it has one; cached files count as free.
fn free_in_group(folder: &Path) -> Option<u64> {
    let number = |name: &str| read_to_string(folder.join(name)).ok()?.trim().parse().ok();
    let limit: u64 = number("memory.max")?;
    let used: u64 = number("memory.current")?;
    let statistics = read_to_string(folder.join("memory.stat")).unwrap_or_default();
    let cached = statistics
        .lines()
        .find_map(|line| line.strip_prefix("file "));
    let cached: u64 = cached.and_then(|text| text.parse().ok()).unwrap_or(0);
    Some(limit.saturating_sub(used.saturating_sub(cached)))
}

/// Bytes of a line `NAME   123 kB`.
fn kilobytes(text: &str, name: &str) -> Option<u64> {
    let value = text.lines().find_map(|line| line.strip_prefix(name))?;
    let number: u64 = value.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(1024 * number)
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

    #[test]
    fn lines_of_the_system_are_read() {
        let text = "Name:\tstickslip\nVmHWM:\t   44800 kB\nVmRSS:\t  100 kB\n";
        assert_eq!(kilobytes(text, "VmHWM:"), Some(44_800 * 1024));
        assert_eq!(kilobytes(text, "VmSwap:"), None);
        let folders = group_folders("0::/a/b");
        assert_eq!(folders[0], Path::new("/sys/fs/cgroup/a/b"));
        assert_eq!(folders.len(), 3);
        assert!(group_folders("4:memory:/a").is_empty());
    }
}
