//! Any text, to the parser of requests.
#![no_main]

libfuzzer_sys::fuzz_target!(|text: &[u8]| reentry_tests::fuzzed::parser(text));
