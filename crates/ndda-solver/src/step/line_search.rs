//! The search for the minimum of a function along a direction, by its slope.

/// Part of the slope at the start that may be left at the end of a stride.
const SLOPE_LEFT: f64 = 0.5;
/// Evaluations along one direction.
const MOST_STRIDES: u32 = 30;
/// Part of a stride that is tried instead of one that went too far.
const SHORTER: f64 = 0.25;

/// False position, in which each stride halves the slope that counts at the other end, whichever end moves. By the Illinois rule that happens only where
/// the same end moves twice in a row; a slope that is only to be halved is found sooner so.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Search {
    start: f64,
    /// Stride and slope on this side of the minimum, and beyond it.
    near: (f64, f64),
    far: Option<(f64, f64)>,
    strides: u32,
    /// Where strides end that are doubled as long as the minimum is beyond.
    longest: f64,
}

impl Search {
    /// A search from a slope, with strides of at most `longest`, or of one.
    pub(crate) fn new(slope: f64, longest: f64) -> Self {
        Self { start: slope, near: (0.0, slope), far: None, strides: 0, longest }
    }

    /// Where to look next, if this stride is not good enough.
    pub(crate) fn next_stride(&mut self, stride: f64, slope: f64) -> Option<f64> {
        self.strides += 1;
        if slope.abs() <= SLOPE_LEFT * self.start.abs() || self.strides >= MOST_STRIDES {
            return None;
        }
        if slope > 0.0 {
            self.far = Some((stride, slope));
            self.near.1 *= 0.5;
        } else {
            self.near = (stride, slope);
            let Some(far) = &mut self.far else {
                return (2.0 * stride <= self.longest).then_some(2.0 * stride);
            };
            far.1 *= 0.5;
        }
        let (near, far) = (self.near, self.far?);
        Some(near.0 + (far.0 - near.0) * near.1.abs() / (near.1.abs() + far.1))
    }

    /// Where to look instead of at a stride that went too far to evaluate anything there.
    pub(crate) fn shorter(&mut self, stride: f64) -> Option<f64> {
        self.strides += 1;
        self.longest = self.near.0 + SHORTER * (stride - self.near.0);
        (self.strides < MOST_STRIDES).then_some(self.longest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The stride with which a search ends, and how many it took.
    fn searched(slope: impl Fn(f64) -> f64, longest: f64) -> (f64, u32) {
        let mut search = Search::new(slope(0.0), longest);
        let mut stride = 1.0;
        while let Some(next) = search.next_stride(stride, slope(stride)) {
            stride = next;
        }
        (stride, search.strides)
    }

    #[test]
    fn it_finds_where_the_slope_is_half_of_that_at_the_start_or_less() {
        // The minimum of each is at a tenth and at 30 strides.
        let (near, far) = (|s: f64| 10.0 * s - 1.0, |s: f64| s / 30.0 - 1.0);
        for (slope, longest) in [(&near as &dyn Fn(f64) -> f64, 1.0), (&far, 64.0)] {
            let (stride, strides) = searched(slope, longest);
            assert!(slope(stride).abs() <= 0.5 && strides <= 6, "{stride} after {strides}");
        }
    }

    #[test]
    fn a_stride_that_is_not_far_enough_is_doubled_only_where_it_may_be() {
        assert_eq!(searched(|s| s / 30.0 - 1.0, 1.0), (1.0, 1));
        let mut search = Search::new(-1.0, 64.0);
        assert_eq!(search.shorter(1.0), Some(0.25));
        assert_eq!(search.next_stride(0.25, -0.9), None, "no way back to where it went too far");
    }
}
