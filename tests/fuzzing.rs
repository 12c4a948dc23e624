//! The corpus of the fuzz targets, and random requests, held to what the fuzz targets ask (`reentry_tests::fuzzed`).

use proptest::prelude::*;
use reentry_tests::fuzzed;
use reentry_tests::mutation::{LETTERS, Mutator, corpus};

use crate::flights::config;

#[test]
fn the_parser_holds_on_its_corpus() {
    for input in corpus("parser") {
        fuzzed::parser(&input);
    }
}

#[test]
fn flights_hold_on_their_corpus() {
    for input in corpus("simulate") {
        fuzzed::simulate(&input);
    }
}

#[test]
fn conversions_hold_on_their_corpus() {
    for input in corpus("convert") {
        fuzzed::convert(&input);
    }
}

#[test]
fn random_requests_are_answered_or_refused() {
    let (flights, conversions) = (Mutator::new("/simulate", "simulate"), Mutator::new("/convert", "convert"));
    proptest!(config(1000), |(seed: u64)| {
        let flight = flights.request(seed).to_string().into_bytes();
        fuzzed::parser(&flight);
        fuzzed::simulate(&flight);
        let letter = LETTERS[usize::from(flight[flight.len() / 2]) % LETTERS.len()];
        fuzzed::simulate(&[&[letter], &flight[..]].concat());
        fuzzed::convert(conversions.request(seed).to_string().as_bytes());
    });
}
