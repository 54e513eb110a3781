//! Random numbers that are the same on every machine.

use pellicle::prelude::DVec3;
use std::f64::consts::TAU;

/// SplitMix64 (Steele et al. 2014). The logarithm and the cosine come from `libm`, not from the machine.
///
/// ```
/// use pellicle_figures::Random;
/// let mut one = Random::new(7, 0);
/// let mut other = Random::new(7, 0);
/// assert_eq!(one.unit().to_bits(), other.unit().to_bits());
/// ```
#[derive(Clone, Debug)]
pub struct Random(u64);

impl Random {
    /// Distinct streams of one seed start far apart.
    pub fn new(seed: u64, stream: u64) -> Self {
        Self(Self(Self(seed).bits() ^ stream).bits())
    }

    /// 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// Uniform in [0, 1).
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Normal with mean 0 and variance 1 (Box and Muller's transform).
    pub fn normal(&mut self) -> f64 {
        let radius = (-2.0 * libm::log(1.0 - self.unit())).sqrt();
        radius * libm::cos(TAU * self.unit())
    }

    /// Three independent numbers.
    pub fn vector(&mut self, of: impl Fn(&mut Self) -> f64) -> DVec3 {
        DVec3::new(of(self), of(self), of(self))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bits_are_those_of_splitmix64() {
        // The published sequence from state 0.
        let mut random = Random(0);
        let first = [random.bits(), random.bits(), random.bits()];
        assert_eq!(
            first,
            [
                0xE220_A839_7B1D_CDAF,
                0x6E78_9E6A_A1B9_65F4,
                0x06C4_5D18_8009_454F
            ]
        );
    }

    #[test]
    fn normal_numbers_have_the_moments_and_the_middle_of_the_normal_distribution() {
        let mut random = Random::new(11, 0);
        let numbers: Vec<f64> = (0..100_000).map(|_| random.normal()).collect();
        let mean =
            |of: fn(f64) -> f64| numbers.iter().map(|&x| of(x)).sum::<f64>() / numbers.len() as f64;
        // Each within four deviations of its estimate.
        let bound = |deviation: f64| 4.0 * deviation / (numbers.len() as f64).sqrt();
        assert!(mean(|x| x).abs() < bound(1.0));
        assert!((mean(|x| x * x) - 1.0).abs() < bound(2.0_f64.sqrt()));
        assert!(mean(|x| x * x * x).abs() < bound(15.0_f64.sqrt()));
        let within = mean(|x| f64::from(u8::from(x.abs() < 1.0)));
        assert!((within - 0.682_689_5).abs() < bound(0.466));
    }
}
