//! A campaign: all predicates against exact arithmetic, on random, near-degenerate and degenerate points at all
//! scales. `cargo xtask campaign` runs it in full.
//!
//! ```text
//! cargo run --release -p pellicle-predicates --features statistics --example campaign -- [CASES] [SEED]
//! ```
//!
//! A case is a set of points with weights, all of one family of degeneracy, and one group of predicates; each
//! predicate of the group is called with the points in some order. The same cases and seed give the same calls.

mod calls;
mod inputs;
mod oracle;
mod random;
mod tally;

use random::Random;
use std::process::ExitCode;
use tally::Tally;

/// Runs `cases` cases.
fn campaign(cases: u64, seed: u64) -> Tally {
    let mut random = Random::new(seed);
    let mut tally = Tally::default();
    for _ in 0..cases {
        let (family, case) = inputs::case(&mut random);
        tally.begin(family, case);
        calls::check(&case, &mut random, &mut tally);
    }
    tally
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let number = |position: usize, default: u64| match arguments.get(position) {
        None => Some(default),
        Some(word) => word.replace('_', "").parse().ok(),
    };
    let (Some(cases), Some(seed)) = (number(0, 10_000), number(1, 1)) else {
        eprintln!("usage: campaign [CASES] [SEED]");
        return ExitCode::from(2);
    };
    let tally = campaign(cases, seed);
    print!("{}", tally.summary(cases, seed));
    ExitCode::from(u8::from(tally.wrong_calls() > 0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ten_thousand_cases_without_a_wrong_sign() {
        let tally = campaign(10_000, 7);
        assert_eq!(tally.wrong_calls(), 0, "{}", tally.summary(10_000, 7));
        // Every predicate was called often, and every one of them met ties.
        for (name, counts) in tally.predicates() {
            assert!(counts.calls >= 100, "{name}: {counts:?}");
            assert!(counts.ties >= 10, "{name}: {counts:?}");
        }
    }

    #[test]
    fn the_same_seed_makes_the_same_calls() {
        let summary = |seed| campaign(500, seed).summary(500, 0);
        assert_eq!(summary(3), summary(3));
    }
}
