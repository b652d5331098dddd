//! Memory as reported by the system in `/proc`: the peak of this process, and the free memory.

use std::fs::read_to_string;
use std::path::{Path, PathBuf};

#[cfg(not(unix))]
use super::portable::memory_limits;
#[cfg(unix)]
use super::unix::memory_limits;

/// Largest number of bytes of this process that were resident so far; `None` if the system does not report this number.
pub fn peak_memory() -> Option<u64> {
    kilobytes(&read_to_string("/proc/self/status").ok()?, "VmHWM:")
}

/// Number of free bytes: on the machine (with swap), in the control groups of this process with a limit, or below the
/// limits of the process itself (`ulimit -v`, `ulimit -d`), whichever number is smallest. `None` if the system does not
/// report the free memory.
pub fn free_memory() -> Option<u64> {
    let machine = read_to_string("/proc/meminfo").ok()?;
    let swap = kilobytes(&machine, "SwapFree:").unwrap_or(0);
    let free = kilobytes(&machine, "MemAvailable:")? + swap;
    let groups = read_to_string("/proc/self/cgroup").unwrap_or_default();
    let folders = groups.lines().flat_map(group_folders);
    let limits = folders.filter_map(|folder| free_in_group(&folder));
    Some(limits.chain(free_in_process()).fold(free, u64::min))
}

/// Numbers of bytes free below the limits of this process: for its addresses and for its data.
fn free_in_process() -> impl Iterator<Item = u64> {
    let status = read_to_string("/proc/self/status").unwrap_or_default();
    let limits = memory_limits().into_iter().zip(["VmSize:", "VmData:"]);
    limits.filter_map(move |(limit, used)| Some(limit?.saturating_sub(kilobytes(&status, used)?)))
}

/// Folders of the control group in a line of /proc/self/cgroup (version 2), and of the groups around this group.
fn group_folders(line: &str) -> Vec<PathBuf> {
    let path = line.strip_prefix("0::/").map(Path::new);
    let root = Path::new("/sys/fs/cgroup");
    path.map_or(Vec::new(), |path| {
        path.ancestors().map(|path| root.join(path)).collect()
    })
}

/// Number of bytes free below the limit of a control group, if it has a limit; cached files count as free.
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

/// Number of bytes in a line `NAME 123 kB`.
fn kilobytes(text: &str, name: &str) -> Option<u64> {
    let value = text.lines().find_map(|line| line.strip_prefix(name))?;
    let number: u64 = value.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(1024 * number)
}

#[cfg(test)]
mod tests {
    use super::*;

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
