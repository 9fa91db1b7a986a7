//! What a run cost: time and memory.

use super::bytes::shown;
use std::fmt;
use std::time::{Duration, Instant};

/// Runs that are shorter say nothing of what they cost.
const WORTH_TELLING: Duration = Duration::from_millis(500);

/// A run that is being timed. `Display` says the time since its start, and the largest amount of memory that the
/// process has held, where the system tells it.
pub struct Cost(Instant);

impl Cost {
    /// The run begins.
    pub fn start() -> Self {
        Self(Instant::now())
    }

    /// Whether the run took long enough to ask what it cost.
    pub fn is_worth_telling(&self) -> bool {
        self.0.elapsed() >= WORTH_TELLING
    }
}

impl fmt::Display for Cost {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", time(self.0.elapsed()))?;
        match peak_memory() {
            Some(bytes) => write!(f, ", {} at most", shown(bytes)),
            None => Ok(()),
        }
    }
}

/// A time in words.
pub fn time(spent: Duration) -> String {
    let seconds = spent.as_secs();
    match seconds {
        0..60 => format!("{:.1} s", spent.as_secs_f64()),
        60..3600 => format!("{} min {} s", seconds / 60, seconds % 60),
        _ => format!("{} h {} min", seconds / 3600, seconds / 60 % 60),
    }
}

/// The most memory that this process has held: its high water mark as Linux writes it.
fn peak_memory() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let row = status.lines().find_map(|l| l.strip_prefix("VmHWM:"))?;
    let kibibytes: u64 = row.split_whitespace().next()?.parse().ok()?;
    Some(kibibytes * 1024)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn time_in_fitting_units() {
        assert_eq!(time(Duration::from_millis(1_234)), "1.2 s");
        assert_eq!(time(Duration::from_secs(125)), "2 min 5 s");
        assert_eq!(time(Duration::from_secs(7_260)), "2 h 1 min");
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn memory_grows_with_what_is_held() {
        let held = vec![1_u8; 64 << 20];
        let peak = peak_memory().unwrap();
        let sum: u64 = held.iter().map(|&b| u64::from(b)).sum();
        assert!(peak > sum);
    }
}
