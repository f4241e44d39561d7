//! Linear functions of place.

use ndda_mesh::Vec3;

use crate::integration::tet_frame::TetFrame;

/// A linear function of place, value + gradient · x.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Linear {
    /// Value at the origin.
    pub value: f64,
    /// Gradient [1/m].
    pub gradient: Vec3,
}

impl Linear {
    /// The function with these values at the corners of a tetrahedron, seen from `origin`.
    pub(crate) fn of_corners(frame: &TetFrame, values: &[f64; 4], origin: &Vec3) -> Self {
        let gradient: Vec3 = (0..4).map(|b| values[b] * frame.gradient(b)).sum();
        // λ₀ is 1 at the frame's own corner, the others 0.
        Self { value: values[0] + gradient.dot(&(origin - frame.origin())), gradient }
    }

    /// Its value at x.
    pub(crate) fn at(&self, x: &Vec3) -> f64 {
        self.value + self.gradient.dot(x)
    }

    /// The function times a factor.
    pub(crate) fn times(&self, factor: f64) -> Self {
        Self { value: factor * self.value, gradient: factor * self.gradient }
    }

    /// The difference of two functions.
    pub(crate) fn minus(&self, other: &Self) -> Self {
        Self { value: self.value - other.value, gradient: self.gradient - other.gradient }
    }
}
