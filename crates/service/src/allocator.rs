//! What the C library does with memory that is free.

use std::env;
use std::os::unix::process::CommandExt;
use std::process::Command;

/// The variable by which the GNU C library is told, before a program begins, from which size on memory is returned to the system as soon
/// as it is free.
const THRESHOLD: &str = "MALLOC_MMAP_THRESHOLD_";

/// 1 MiB. Without the variable the library raises its threshold to the size of what was last freed, and after a flood of large answers
/// keeps hundreds of megabytes. A lower one costs the answers of 1000 rows a fifth of their rate.
const BYTES: &str = "1048576";

/// The variable for how many heaps the threads share; each keeps what is free between what is not. By default there are eight a processor.
const HEAPS: (&str, &str) = ("MALLOC_ARENA_MAX", "4");

/// Begins the program anew with the variables, unless it has the first. Where that fails, it goes on as it is: it then takes more memory.
pub fn tune() {
    if cfg!(not(target_env = "gnu")) || env::var_os(THRESHOLD).is_some() {
        return;
    }
    let mut arguments = env::args_os();
    if let (Ok(program), Some(name)) = (env::current_exe(), arguments.next()) {
        // It returns where it fails, alone.
        let _ = Command::new(program).arg0(name).args(arguments).env(THRESHOLD, BYTES).env(HEAPS.0, HEAPS.1).exec();
    }
}
