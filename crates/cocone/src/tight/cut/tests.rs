//! Cuts of small random networks against all cuts there are.

use super::*;

/// A random network: up to four arcs a node, in pairs with capacities of their own.
fn random(seed: u64, count: usize) -> (Vec<[u32; 4]>, Vec<[i64; 4]>, Vec<i64>) {
    let mut state = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
    let mut draw = |below: u64| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 20) % below
    };
    let mut twins = vec![[NO_ARC; 4]; count];
    let mut capacities = vec![[0; 4]; count];
    for _ in 0..4 * count {
        let [a, b] = [draw(4 * count as u64), draw(4 * count as u64)].map(|arc| arc as usize);
        if a / 4 != b / 4 && twins[a / 4][a % 4] == NO_ARC && twins[b / 4][b % 4] == NO_ARC {
            twins[a / 4][a % 4] = b as u32;
            twins[b / 4][b % 4] = a as u32;
            capacities[a / 4][a % 4] = draw(6) as i64;
            capacities[b / 4][b % 4] = draw(6) as i64;
        }
    }
    let terminals = (0..count).map(|_| draw(15) as i64 - 7).collect();
    (twins, capacities, terminals)
}

fn cost(twins: &[[u32; 4]], capacities: &[[i64; 4]], terminals: &[i64], source: u32) -> i64 {
    let on_source = |node: usize| source >> node & 1 == 1;
    let mut cost = 0;
    for node in 0..twins.len() {
        cost += match on_source(node) {
            true => (-terminals[node]).max(0),
            false => terminals[node].max(0),
        };
        for corner in 0..4 {
            let twin = twins[node][corner];
            if twin != NO_ARC && on_source(node) && !on_source(twin as usize / 4) {
                cost += capacities[node][corner];
            }
        }
    }
    cost
}

#[test]
fn the_cut_is_the_least_and_of_those_the_smallest() {
    for seed in 1..3000 {
        let count = 1 + seed as usize % 11;
        let (twins, capacities, terminals) = random(seed, count);
        let cost = |source| cost(&twins, &capacities, &terminals, source);
        let best = (0..1_u32 << count)
            .map(|s| (cost(s), s.count_ones(), s))
            .min();
        let (twins, capacities) = (twins.clone(), capacities.clone());
        let found = Network::new(twins, capacities, terminals.clone()).source_side();
        let found = (0..count)
            .filter(|&node| found[node])
            .fold(0, |set, node| set | 1 << node);
        assert_eq!(
            Some((cost(found), found.count_ones(), found)),
            best,
            "seed {seed}"
        );
    }
}
