//! Every stage, and all of them together, against exact rationals.
//!
//! `PELLICLE_CASES` sets the number of cases of each property.

mod bounds;
mod coverage;
mod distance;
mod implicit;
mod inputs;
mod lanes;
mod oracle;
mod permutation;
mod power;
mod schemes;
mod signs;
mod stages;

use proptest::test_runner::Config;

/// The configuration of all properties; the default keeps `cargo test` short.
fn config() -> Config {
    let cases = std::env::var("PELLICLE_CASES").ok();
    let cases = cases.and_then(|cases| cases.parse().ok()).unwrap_or(1000);
    Config {
        failure_persistence: None,
        rng_seed: proptest::test_runner::RngSeed::Fixed(0x9e37_79b9_7f4a_7c15),
        ..Config::with_cases(cases)
    }
}
