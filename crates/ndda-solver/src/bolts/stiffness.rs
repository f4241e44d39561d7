//! How stiff bolts are beside the masses that they move: a bound, since steps take their forces explicitly.

use crate::bodies::kind::BodyKind;
use crate::bolts::bolt::{Bolt, Span};
use crate::bolts::embedding::Anchor;

impl Bolt {
    /// Stiffness of each span [N/m]: how fast its tension grows as the rock parts there, both sides of the bolt in series. Nothing has yielded: later
    /// it is softer.
    fn span_stiffness_n_m(&self) -> Vec<f64> {
        let sides = |k: usize| {
            let mut held = vec![[0.0; 2]; self.nodes_m.len()];
            for (holder, point) in self.holders.iter().zip(&self.held_at) {
                held[holder.node as usize][usize::from(*point as usize > k)] += holder.law.stiffness_n_m;
            }
            held
        };
        (0..self.spans.len()).map(|k| self.parted(&sides(k))).collect()
    }

    /// Force per relative displacement of two groups of springs that the bar joins [N/m].
    fn parted(&self, held: &[[f64; 2]]) -> f64 {
        let series = |a: f64, b: f64| if a + b > 0.0 { a * b / (a + b) } else { 0.0 };
        let last_left = held.iter().rposition(|[left, _]| *left > 0.0).unwrap_or(0);
        let first_right = held.iter().position(|[_, right]| *right > 0.0).unwrap_or(held.len() - 1);
        let (mut left, mut right) = (0.0, 0.0);
        for (i, [here, _]) in held.iter().enumerate().take(last_left + 1) {
            let carried = if i > 0 { series(left, self.steel[i - 1].stiffness_n_m) } else { 0.0 };
            left = here + carried;
        }
        for (i, [_, here]) in held.iter().enumerate().skip(first_right).rev() {
            let carried = self.steel.get(i).map_or(0.0, |law| series(right, law.stiffness_n_m));
            right = here + carried;
        }
        let between = &self.steel[last_left..first_right.max(last_left)];
        let slack: f64 = between.iter().map(|law| 1.0 / law.stiffness_n_m).sum();
        let both = series(left, right);
        both / (1.0 + both * slack)
    }

    /// Adds bounds of Σ|k| of the nodes that it acts on.
    pub(crate) fn add_row_sums(&self, kinds: &[BodyKind], out: &mut Vec<(u32, f64)>) {
        for (k, (span, stiffness_n_m)) in self.spans.iter().zip(self.span_stiffness_n_m()).enumerate() {
            let (a, b) = (self.point_block[k], self.point_block[k + 1]);
            let stays_whole = matches!(kinds[a.index()], BodyKind::Rigid | BodyKind::Fixed);
            if a == b && stays_whole {
                continue;
            }
            let (first, second) = (&self.points[k], &self.points[k + 1]);
            let shear_n_m = match (span, &self.dowel) {
                (Span::Crossing { .. }, Some(dowel)) => dowel.stiffness_n_m,
                _ => 0.0,
            };
            add_pair(first, second, stiffness_n_m.max(shear_n_m), out);
        }
    }
}

/// Row sums of a spring between two points.
fn add_pair(a: &Anchor, b: &Anchor, stiffness_n_m: f64, out: &mut Vec<(u32, f64)>) {
    let mut weights: Vec<(u32, f64)> = a.nodes.into_iter().zip(a.weights).collect();
    for (node, weight) in b.nodes.into_iter().zip(b.weights) {
        match weights.iter_mut().find(|(known, _)| *known == node) {
            Some((_, sum)) => *sum -= weight,
            None => weights.push((node, -weight)),
        }
    }
    let size: f64 = weights.iter().map(|(_, weight)| weight.abs()).sum();
    out.extend(weights.into_iter().map(|(node, weight)| (node, stiffness_n_m * weight.abs() * size)));
}
