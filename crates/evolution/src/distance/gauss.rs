//! The regularisation d = G_σ ∗ d₀ (Daniel 2015, section 3.2), one axis after the other.

/// Weights of the Gauss kernel at whole voxels, cut off at 4 σ and divided by their sum; the first is the middle one,
/// the others count twice.
pub(super) struct Kernel {
    weights: Vec<f32>,
}

impl Kernel {
    /// The kernel of a standard deviation in voxels; zero leaves everything as it is.
    pub fn new(sigma: f64) -> Self {
        if sigma == 0.0 {
            return Self { weights: vec![1.0] };
        }
        if sigma < 0.5 {
            // Samples of so narrow a kernel miss it; these three weights have its variance.
            let side = 0.5 * sigma * sigma;
            return Self {
                weights: vec![(1.0 - 2.0 * side) as f32, side as f32],
            };
        }
        let radius = (4.0 * sigma).ceil() as u32;
        let raw: Vec<f64> = (0..=radius)
            .map(|i| (-0.5 * (f64::from(i) / sigma).powi(2)).exp())
            .collect();
        let sum = 2.0 * raw.iter().skip(1).sum::<f64>() + raw[0];
        Self {
            weights: raw.iter().map(|w| (w / sum) as f32).collect(),
        }
    }

    /// How many voxels it reaches to each side.
    pub fn radius(&self) -> usize {
        self.weights.len() - 1
    }

    /// Convolves a row: `source` is longer than `target` by the radius on each side.
    pub fn along(&self, source: &[f32], target: &mut [f32]) {
        self.across(|t| &source[t..], target);
    }

    /// The weighted sum of rows: `source(t)` is the row t − radius beside the one that `target` belongs to.
    pub fn across<'a>(&self, source: impl Fn(usize) -> &'a [f32], target: &mut [f32]) {
        let radius = self.radius();
        let n = target.len();
        let middle = &source(radius)[..n];
        let w = self.weights[0];
        for (sum, &value) in target.iter_mut().zip(middle) {
            *sum = w * value;
        }
        // Two pairs at once: the target is read and written half as often.
        let mut t = 1;
        while t <= radius {
            let (a, b) = (&source(radius - t)[..n], &source(radius + t)[..n]);
            let w = self.weights[t];
            if t < radius {
                let (c, d) = (&source(radius - t - 1)[..n], &source(radius + t + 1)[..n]);
                let v = self.weights[t + 1];
                for i in 0..n {
                    target[i] += w * (a[i] + b[i]) + v * (c[i] + d[i]);
                }
                t += 2;
            } else {
                for i in 0..n {
                    target[i] += w * (a[i] + b[i]);
                }
                t += 1;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_weights_sum_to_one_and_have_the_variance() {
        for sigma in [0.0, 0.1, 0.25, 0.4, 0.75, 1.0, 1.5, 2.0, 5.0, 16.0] {
            let kernel = Kernel::new(sigma);
            let moment = |power: i32| -> f64 {
                let both: f64 = kernel
                    .weights
                    .iter()
                    .enumerate()
                    .skip(1)
                    .map(|(i, &w)| 2.0 * f64::from(w) * (i as f64).powi(power))
                    .sum();
                both + if power == 0 {
                    f64::from(kernel.weights[0])
                } else {
                    0.0
                }
            };
            assert!(
                (moment(0) - 1.0).abs() < 1e-6,
                "sigma {sigma}: {}",
                moment(0)
            );
            // Cut off at 4 σ, the kernel lacks about a thousandth of its variance.
            let square = sigma * sigma;
            assert!(
                (moment(2) - square).abs() <= 2e-3 * square + 1e-12,
                "sigma {sigma}: {}",
                moment(2)
            );
        }
    }

    /// Against a plain sum, for radii that are even, odd and zero.
    #[test]
    fn convolution_is_the_weighted_sum() {
        for sigma in [0.0, 0.3, 0.6, 0.75, 1.0, 1.2, 3.0] {
            let kernel = Kernel::new(sigma);
            let radius = kernel.radius();
            let source: Vec<f32> = (0..20 + 2 * radius as u32)
                .map(|i| (i * i * 7 % 23) as f32)
                .collect();
            let mut target = [0.0; 20];
            kernel.along(&source, &mut target);
            for (i, &value) in target.iter().enumerate() {
                let plain: f64 = (0..=2 * radius)
                    .map(|t| {
                        f64::from(kernel.weights[t.abs_diff(radius)]) * f64::from(source[i + t])
                    })
                    .sum();
                assert!(
                    (f64::from(value) - plain).abs() < 1e-5,
                    "sigma {sigma}: {value} {plain}"
                );
            }
        }
    }
}
