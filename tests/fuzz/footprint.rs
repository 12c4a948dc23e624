//! Requests for footprints, to `/footprint`.
#![no_main]

use std::sync::LazyLock;

use libfuzzer_sys::{fuzz_mutator, fuzz_target, fuzzer_mutate};
use reentry_tests::fuzzed;
use reentry_tests::mutation::Mutator;

static MUTATOR: LazyLock<Mutator> = LazyLock::new(|| Mutator::new("/footprint", "footprint"));

fuzz_target!(|input: &[u8]| {
    fuzzed::footprint(input);
});

// Mostly as trees, now and then as bytes.
fuzz_mutator!(|data: &mut [u8], size: usize, max_size: usize, seed: u32| {
    match MUTATOR.another(&data[..size], seed.into()) {
        Some(input) if seed % 8 > 0 && input.len() <= max_size => {
            data[..input.len()].copy_from_slice(&input);
            input.len()
        }
        _ => fuzzer_mutate(data, size, max_size),
    }
});
