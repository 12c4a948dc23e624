//! The corpus of the fuzz targets, and random requests, held to what the fuzz targets ask (`reentry_tests::fuzzed`).

use std::cell::Cell;

use proptest::prelude::*;
use reentry_tests::fuzzed;
use reentry_tests::mutation::{LETTERS, Mutator, corpus};

use crate::core::flights::config;

#[test]
fn the_parser_holds_on_its_corpus() {
    for input in corpus("parser") {
        fuzzed::parser(&input);
    }
}

#[test]
fn flights_hold_on_their_corpus() {
    let corpus = corpus("simulate");
    many(corpus.iter().filter(|input| fuzzed::simulate(input)).count(), corpus.len());
}

#[test]
fn conversions_hold_on_their_corpus() {
    let corpus = corpus("convert");
    many(corpus.iter().filter(|input| fuzzed::convert(input)).count(), corpus.len());
}

#[test]
fn targets_hold_on_their_corpus() {
    let corpus = corpus("target");
    many(corpus.iter().filter(|input| fuzzed::target(input)).count(), corpus.len());
}

#[test]
fn corridors_hold_on_their_corpus() {
    let corpus = corpus("corridor");
    many(corpus.iter().filter(|input| fuzzed::corridor(input)).count(), corpus.len());
}

#[test]
fn footprints_hold_on_their_corpus() {
    let corpus = corpus("footprint");
    many(corpus.iter().filter(|input| fuzzed::footprint(input)).count(), corpus.len());
}

#[test]
fn random_searches_are_answered_or_refused() {
    const CASES: u32 = 300;
    let [targets, corridors, footprints] =
        ["target", "corridor", "footprint"].map(|name| Mutator::new(&format!("/{name}"), name));
    let answered = Cell::new(0);
    proptest!(config(CASES), |(seed: u64)| {
        let asked = [
            fuzzed::target(targets.request(seed).to_string().as_bytes()),
            fuzzed::corridor(corridors.request(seed).to_string().as_bytes()),
            fuzzed::footprint(footprints.request(seed).to_string().as_bytes()),
        ];
        answered.set(answered.get() + asked.iter().filter(|answered| **answered).count());
    });
    many(answered.get(), 3 * CASES as usize);
}

#[test]
fn random_requests_are_answered_or_refused() {
    const CASES: u32 = 1000;
    let (flights, conversions) = (Mutator::new("/simulate", "simulate"), Mutator::new("/convert", "convert"));
    let answered = Cell::new(0);
    proptest!(config(CASES), |(seed: u64)| {
        let flight = flights.request(seed).to_string().into_bytes();
        fuzzed::parser(&flight);
        let letter = LETTERS[usize::from(flight[flight.len() / 2]) % LETTERS.len()];
        let conversion = conversions.request(seed).to_string().into_bytes();
        let asked = [
            fuzzed::simulate(&flight),
            fuzzed::simulate(&[&[letter], &flight[..]].concat()),
            fuzzed::convert(&conversion),
        ];
        answered.set(answered.get() + asked.iter().filter(|answered| **answered).count());
    });
    many(answered.get(), 3 * CASES as usize);
}

/// A refusal is held to less than an answer. Of random requests one in eleven is answered, of the corpora every other.
#[track_caller]
fn many(answered: usize, asked: usize) {
    assert!(answered * 20 > asked, "{answered} of {asked} requests are answered");
}
