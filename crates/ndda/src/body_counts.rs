//! How the blocks of a scene may move, in counts and words.

use std::fmt;

use ndda_solver::{BodyKind, Simulation};
use serde::Serialize;

use crate::numbers::counted;

/// Blocks by how they may move, and what is solved for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct BodyCounts {
    /// Blocks that do not move, or as prescribed.
    #[serde(skip)]
    pub fixed: usize,
    /// Blocks that move without deformation.
    #[serde(skip)]
    pub rigid: usize,
    /// Blocks that deform uniformly.
    #[serde(skip)]
    pub affine: usize,
    /// Blocks that deform by their tetrahedra.
    #[serde(skip)]
    pub elastic: usize,
    /// Unknowns that are solved for by matrices: those of blocks that deform.
    pub unknowns: usize,
    /// Distinct factors of these matrices.
    pub factors: usize,
}

impl BodyCounts {
    /// Of a simulation.
    pub fn of(simulation: &Simulation) -> Self {
        let mut bodies =
            Self { unknowns: simulation.unknowns(), factors: simulation.factors(), ..Self::default() };
        for block in simulation.blocks().ids() {
            *match simulation.shape(block).kind {
                BodyKind::Fixed => &mut bodies.fixed,
                BodyKind::Rigid => &mut bodies.rigid,
                BodyKind::Affine => &mut bodies.affine,
                BodyKind::Elastic => &mut bodies.elastic,
            } += 1;
        }
        bodies
    }
}

impl fmt::Display for BodyCounts {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self { fixed, rigid, affine, elastic, unknowns, factors } = *self;
        let each = |count: usize| if count > 1 { " each" } else { "" };
        let kinds = [
            (fixed, "fixed".to_string()),
            (rigid, format!("rigid, six degrees of freedom{}", each(rigid))),
            (affine, format!("uniformly deforming, twelve degrees of freedom{}", each(affine))),
            (elastic, "deforming by tetrahedra".into()),
        ];
        let said =
            kinds.into_iter().filter(|(count, _)| *count > 0).map(|(count, kind)| format!("{count} {kind}"));
        f.write_str(&said.collect::<Vec<_>>().join("; "))?;
        if elastic + affine > 0 && unknowns > 0 {
            let unknowns = counted(unknowns, "unknown", "unknowns");
            write!(f, "; {unknowns} in {}", counted(factors, "factored matrix", "factored matrices"))?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rigid_blocks_have_six_degrees_of_freedom_and_nothing_is_said_of_matrices() {
        let bodies = BodyCounts { fixed: 3, rigid: 1, ..BodyCounts::default() };
        assert_eq!(bodies.to_string(), "3 fixed; 1 rigid, six degrees of freedom");
        let bodies = BodyCounts { rigid: 2, elastic: 1, unknowns: 24, factors: 1, ..BodyCounts::default() };
        assert_eq!(
            bodies.to_string(),
            "2 rigid, six degrees of freedom each; 1 deforming by tetrahedra; 24 unknowns in 1 factored matrix"
        );
    }
}
