//! The stabilised biconjugate gradients of van der Vorst 1992, preconditioned from the right.
//!
//! Notation, as there: r the residual, r̂ the shadow residual, p the search direction, v = A M⁻¹ p, t = A M⁻¹ s with s
//! the residual half-way; ρ = r̂·r, α = ρ / (r̂·v), ω = (t·s) / (t·t), β = (ρ / ρ_old)(α / ω). M⁻¹ is the preconditioner.

use super::columns::{update, update_two};
use super::iterative::{Process, System, drive, is_finite, square_root};
use super::{
    Columns, Convergence, CsrMatrix, IterativeOptions, LinearError, Preconditioner, Workspace,
};

/// Cosines below this count as zero: ρ, r̂·v and t·s are then rounding, and the process breaks down.
const BREAKDOWN: f64 = 1e-12;

/// ω‖t‖ / ‖s‖ where t is orthogonal to s (Sleijpen and van der Vorst 1995).
const ANGLE: f64 = 0.7;

/// Solves A x = b by BiCGStab (van der Vorst 1992) with a right preconditioner, starting at what `solution` holds.
///
/// Three right-hand sides ([`DVec3`](glam::DVec3)) are three independent processes that share each pass over the matrix;
/// a column that has converged stays as it is. Each column has the bits that it would have alone.
///
/// 1. The residual b − A x, computed; done if it is small in each column.
/// 2. The process, until its own residual is small. A breakdown restarts a column from where it stands, with a
///    pseudo-random shadow residual; where t is orthogonal to s, ω takes the length that Sleijpen and
///    van der Vorst 1995 give it.
/// 3. Back to 1, which finds out whether the recursion drifted off the truth: then the process starts anew from there.
///
/// Each iteration takes two products with the matrix and two with the preconditioner. A column of `right` that is zero
/// gives zero. Same bits for any number of threads; parallel from 16 384 rows on.
///
/// # Errors
///
/// [`LinearError::NotConverged`] at the limit of iterations, at once where a value is not finite, and where the true
/// residual no longer falls because rounding forbids it. `solution` then holds the last iterate.
/// [`LinearError::WrongLength`].
pub fn bicgstab<V: Columns, P: Preconditioner>(
    matrix: &CsrMatrix,
    right: &[V],
    solution: &mut [V],
    preconditioner: &mut P,
    options: &IterativeOptions,
    workspace: &mut Workspace<V>,
) -> Result<Convergence, LinearError> {
    let system = System::new(matrix, right, solution, options)?;
    let [residual, shadow, direction, image, search, second_image] =
        workspace.vectors(matrix.rows());
    let mut process = BiCgStab {
        system: &system,
        preconditioner,
        residual,
        shadow,
        direction,
        image,
        search,
        second_image,
        scalars: Scalars::default(),
        iterations: 0,
    };
    drive(&system, solution, &mut process)
}

struct BiCgStab<'a, V, P> {
    system: &'a System<'a, V>,
    preconditioner: &'a mut P,
    /// r, and s.
    residual: &'a mut [V],
    /// r̂.
    shadow: &'a mut [V],
    /// p.
    direction: &'a mut [V],
    /// v.
    image: &'a mut [V],
    /// M⁻¹ p, and M⁻¹ s.
    search: &'a mut [V],
    /// t.
    second_image: &'a mut [V],
    scalars: Scalars<V>,
    iterations: usize,
}

/// What the process knows of each column.
#[derive(Default)]
struct Scalars<V> {
    rho: V,
    alpha: V,
    omega: V,
    /// ‖r̂‖.
    shadow_norm: V,
    /// Converged: nothing moves any more.
    done: [bool; 3],
    /// To be restarted with another shadow residual.
    broken: [bool; 3],
    restarts: [u64; 3],
}

impl<V: Columns, P: Preconditioner> Process<V> for BiCgStab<'_, V, P> {
    fn residual(&mut self) -> &mut [V] {
        self.residual
    }

    fn iterations(&self) -> usize {
        self.iterations
    }

    /// r̂ = p = r.
    fn start(&mut self, relative: V) {
        self.shadow.copy_from_slice(self.residual);
        self.direction.copy_from_slice(self.residual);
        let [rho] = update(self.shadow, |_, rows| {
            let mut sum = V::ZERO;
            for &value in rows.iter() {
                sum += value * value;
            }
            [sum]
        });
        self.scalars.rho = rho;
        self.scalars.shadow_norm = square_root(rho);
        self.scalars.broken = [false; 3];
        for column in 0..V::COUNT {
            self.scalars.done[column] = self.system.is_met(relative.column(column));
        }
    }

    fn run(&mut self, solution: &mut [V]) -> bool {
        while self.iterations < self.system.options.max_iterations
            && !self.scalars.done[..V::COUNT].iter().all(|&done| done)
        {
            self.iterations += 1;
            let half_way = self.biconjugate_step(solution);
            match half_way.and_then(|squares| self.stabilising_step(squares, solution)) {
                Some(products) => self.turn(products),
                None => return false,
            }
        }
        true
    }
}

impl<V: Columns, P: Preconditioner> BiCgStab<'_, V, P> {
    /// x += α M⁻¹ p, s = r − α v. Returns s·s, or `None` where a value is not finite.
    fn biconjugate_step(&mut self, solution: &mut [V]) -> Option<V> {
        self.preconditioner.apply(self.direction, self.search);
        let shadow = &*self.shadow;
        let matrix = self.system.matrix;
        let [sigma, squares] =
            matrix.multiply_and_sum(self.search, self.image, |row, v| [shadow[row] * v, v * v]);
        if !is_finite(sigma) || !is_finite(squares) {
            return None;
        }
        let scalars = &mut self.scalars;
        scalars.alpha = V::from_columns(|column| {
            let sigma = sigma.column(column);
            let product = scalars.shadow_norm.column(column) * squares.column(column).sqrt();
            if scalars.done[column] {
                0.0
            } else if sigma.abs() <= BREAKDOWN * product {
                scalars.broken[column] = true;
                0.0
            } else {
                scalars.rho.column(column) / sigma
            }
        });
        let (alpha, step) = (scalars.alpha, scalars.alpha * self.system.scale);
        let (search, image) = (&*self.search, &*self.image);
        let [squares] = update_two(solution, self.residual, |first, x, r| {
            let (search, image) = (&search[first..], &image[first..]);
            let mut sum = V::ZERO;
            for (((x, r), &search), &image) in x.iter_mut().zip(r).zip(search).zip(image) {
                *x += search * step;
                *r -= image * alpha;
                sum += *r * *r;
            }
            [sum]
        });
        self.freeze(squares).then_some(squares)
    }

    /// x += ω M⁻¹ s, r = s − ω t, given s·s. Returns r·r and r̂·r, or `None` where a value is not finite.
    fn stabilising_step(&mut self, squares: V, solution: &mut [V]) -> Option<[V; 2]> {
        self.preconditioner.apply(self.residual, self.search);
        let residual = &*self.residual;
        let matrix = self.system.matrix;
        let [products, images] =
            matrix.multiply_and_sum(self.search, self.second_image, |row, t| {
                let s = residual[row];
                [t * s, t * t]
            });
        if !is_finite(products) || !is_finite(images) {
            return None;
        }
        let scalars = &mut self.scalars;
        scalars.omega = V::from_columns(|column| {
            let (product, image) = (products.column(column), images.column(column));
            let norms = (image * squares.column(column)).sqrt();
            if scalars.done[column] {
                0.0
            } else if image == 0.0 {
                scalars.broken[column] = true;
                0.0
            } else if product.abs() <= BREAKDOWN * norms {
                (ANGLE * norms / image).copysign(product)
            } else {
                product / image
            }
        });
        let (omega, step) = (scalars.omega, scalars.omega * self.system.scale);
        let (search, image, shadow) = (&*self.search, &*self.second_image, &*self.shadow);
        let [squares, rho] = update_two(solution, self.residual, |first, x, r| {
            let (search, image) = (&search[first..], &image[first..]);
            let shadow = &shadow[first..];
            let (mut squares, mut rho) = (V::ZERO, V::ZERO);
            let rows = x.iter_mut().zip(r).zip(search).zip(image).zip(shadow);
            for ((((x, r), &search), &image), &shadow) in rows {
                *x += search * step;
                *r -= image * omega;
                squares += *r * *r;
                rho += *r * shadow;
            }
            [squares, rho]
        });
        let is_sound = self.freeze(squares) && is_finite(rho);
        is_sound.then_some([squares, rho])
    }

    /// Notes which columns have converged; `false` where the square of a residual is not finite.
    fn freeze(&mut self, squares: V) -> bool {
        let relative = self.system.relative(squares);
        for column in 0..V::COUNT {
            self.scalars.done[column] |= self.system.may_be_met(relative.column(column));
        }
        is_finite(squares)
    }

    /// p = r + β (p − ω v).
    fn turn(&mut self, [squares, rho]: [V; 2]) {
        let scalars = &mut self.scalars;
        let beta = V::from_columns(|column| {
            let rho = rho.column(column);
            let product = scalars.shadow_norm.column(column) * squares.column(column).sqrt();
            let ratio = (rho / scalars.rho.column(column))
                * (scalars.alpha.column(column) / scalars.omega.column(column));
            scalars.broken[column] |= rho.abs() <= BREAKDOWN * product || !ratio.is_finite();
            if scalars.done[column] || scalars.broken[column] {
                0.0
            } else {
                ratio
            }
        });
        scalars.rho = rho;
        let omega = scalars.omega;
        let (residual, image) = (&*self.residual, &*self.image);
        update(self.direction, |first, rows| {
            let (residual, image) = (&residual[first..], &image[first..]);
            for ((p, &r), &v) in rows.iter_mut().zip(residual).zip(image) {
                *p = r + (*p - v * omega) * beta;
            }
            []
        });
        for column in 0..V::COUNT {
            if self.scalars.broken[column] && !self.scalars.done[column] {
                self.restart(column);
            }
        }
    }

    /// Takes a pseudo-random shadow residual of signs; the direction is the residual already.
    fn restart(&mut self, column: usize) {
        let scalars = &mut self.scalars;
        scalars.broken[column] = false;
        scalars.restarts[column] += 1;
        let seed = scalars.restarts[column] << 32;
        let mut rho = 0.0;
        for (row, (shadow, residual)) in self.shadow.iter_mut().zip(&*self.residual).enumerate() {
            let sign = if mix(seed + row as u64) & 1 == 0 {
                1.0
            } else {
                -1.0
            };
            shadow.set_column(column, sign);
            rho += sign * residual.column(column);
        }
        scalars.rho.set_column(column, rho);
        let norm = (self.shadow.len() as f64).sqrt();
        scalars.shadow_norm.set_column(column, norm);
    }
}

/// The output function of SplitMix64 (Steele et al. 2014).
fn mix(counter: u64) -> u64 {
    let z = counter.wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}
