//! Anderson acceleration of the sweeps over patches.
//!
//! Sweeps take friction forces x to g(x), and end where r = g(x) − x is nothing. In a packing where many patches stick, each sweep hands a force on by one block
//! only, and r falls slowly. From the last m of them the next x is
//!
//! ```text
//! x ← g_k − Σ_j γ_j (g_k − g_j),     γ the least squares of r_k − Σ_j γ_j (r_k − r_j)
//! ```
//!
//! (Anderson 1965; Walker & Ni 2011, eq. 2.1), which for linear sweeps is the method of generalised minimal residuals. Where they end does not change.

use ndda_mesh::Vec3;

/// How many earlier sweeps count.
const WINDOW: usize = 6;
/// Part of the largest diagonal entry below which a direction is left out: it depends on the others.
const DEPENDENT: f64 = 1e-12;
/// Growth of r at which earlier sweeps are forgotten.
const MOST_GROWTH: f64 = 2.0;

/// Forces before and after earlier sweeps, in units of what does not matter of each.
#[derive(Default)]
pub(super) struct Mixing {
    /// Forces that the next sweeps begin with.
    before: Vec<Vec3>,
    /// g and r, the last first.
    found: Vec<[Vec<Vec3>; 2]>,
    known: usize,
    last_norm: f64,
}

impl Mixing {
    /// Forgets all sweeps, and begins with these forces.
    pub(super) fn begin(&mut self, forces: impl Iterator<Item = Vec3>) {
        self.before.clear();
        self.before.extend(forces);
        self.known = 0;
        self.last_norm = f64::INFINITY;
        self.found.resize_with(WINDOW + 1, Default::default);
    }

    /// Takes the forces that sweeps have found, each with the change of it that does not matter; gives those to go on with.
    pub(super) fn mix(&mut self, forces: impl Iterator<Item = (Vec3, f64)>) -> &[Vec3] {
        self.found.rotate_right(1);
        let (latest, earlier) = self.found.split_at_mut(1);
        let [found, gap] = &mut latest[0];
        found.clear();
        gap.clear();
        for ((force, unit), before) in forces.zip(&self.before) {
            found.push(force);
            gap.push((force - before) / unit);
        }
        let norm = gap.iter().map(Vec3::norm_squared).sum::<f64>().sqrt();
        if !(norm <= MOST_GROWTH * self.last_norm) {
            self.known = 0;
        }
        self.last_norm = norm;
        let earlier = &earlier[..self.known];
        let parts = least_squares(gap, earlier);
        self.before.clear();
        self.before.extend_from_slice(found);
        for ([other, _], part) in earlier.iter().zip(parts) {
            for ((x, g), old) in self.before.iter_mut().zip(&*found).zip(other) {
                *x -= part * (g - old);
            }
        }
        self.known = (self.known + 1).min(WINDOW);
        &self.before
    }
}

/// γ by Cholesky's method of the normal equations.
fn least_squares(gap: &[Vec3], earlier: &[[Vec<Vec3>; 2]]) -> [f64; WINDOW] {
    let n = earlier.len();
    let dot = |i: usize, j: Option<usize>| -> f64 {
        let of = |k: usize, at: usize| gap[at] - earlier[k][1][at];
        (0..gap.len()).map(|at| of(i, at).dot(&j.map_or(gap[at], |j| of(j, at)))).sum()
    };
    let mut matrix = [[0.0; WINDOW]; WINDOW];
    let mut parts = [0.0; WINDOW];
    for i in 0..n {
        parts[i] = dot(i, None);
        for j in 0..=i {
            matrix[i][j] = dot(i, Some(j));
        }
    }
    let largest = (0..n).map(|i| matrix[i][i]).fold(0.0, f64::max);
    for i in 0..n {
        for j in 0..=i {
            let known: f64 = (0..j).map(|k| matrix[i][k] * matrix[j][k]).sum();
            let left = matrix[i][j] - known;
            matrix[i][j] = if j < i {
                if matrix[j][j] > 0.0 { left / matrix[j][j] } else { 0.0 }
            } else {
                if left > DEPENDENT * largest { left.sqrt() } else { 0.0 }
            };
        }
        let known: f64 = (0..i).map(|k| matrix[i][k] * parts[k]).sum();
        parts[i] = if matrix[i][i] > 0.0 { (parts[i] - known) / matrix[i][i] } else { 0.0 };
    }
    for i in (0..n).rev() {
        let known: f64 = (i + 1..n).map(|k| matrix[k][i] * parts[k]).sum();
        parts[i] = if matrix[i][i] > 0.0 { (parts[i] - known) / matrix[i][i] } else { 0.0 };
    }
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Gauss–Seidel over a chain of springs, whose middle hears of its ends only after as many sweeps as there are springs between.
    #[test]
    fn a_chain_is_found_in_a_tenth_of_the_sweeps() {
        let sweep = |x: &mut [Vec3]| {
            let n = x.len();
            for i in (0..n).chain((0..n).rev()) {
                let left = if i > 0 { x[i - 1] } else { Vec3::repeat(1.0) };
                let right = if i + 1 < n { x[i + 1] } else { Vec3::zeros() };
                x[i] = 0.5 * (left + right);
            }
        };
        let off = |x: &[Vec3]| {
            let exact = |i: usize| 1.0 - (i + 1) as f64 / (x.len() + 1) as f64;
            x.iter().enumerate().map(|(i, x)| (x.x - exact(i)).abs()).fold(0.0, f64::max)
        };
        let mut plain = vec![Vec3::zeros(); 40];
        let sweeps = (1..).find(|_| {
            sweep(&mut plain);
            off(&plain) < 1e-9
        });
        let mut mixed = vec![Vec3::zeros(); 40];
        let mut mixing = Mixing::default();
        mixing.begin(mixed.iter().copied());
        let mixed_sweeps = (1..).find(|_| {
            sweep(&mut mixed);
            let found = off(&mixed) < 1e-9;
            let next = mixing.mix(mixed.clone().iter().map(|x| (*x, 1.0))).to_vec();
            mixed = next;
            found
        });
        let (plain, mixed) = (sweeps.unwrap(), mixed_sweeps.unwrap());
        assert!(10 * mixed < plain, "{mixed} sweeps, {plain} without");
    }
}
