//! What `ndda check` says of bolts: how many there are, in which blocks they are bonded, and which leave the rock.

use std::fmt;

use ndda_solver::Simulation;
use serde::Serialize;

use crate::numbers::counted;

/// Names of bolts listed at most.
const LISTED: usize = 8;

/// One bolt.
#[derive(Clone, Debug, Serialize)]
pub struct BoltReport {
    /// Its name.
    pub name: String,
    /// Bonded length in blocks [m].
    pub bonded_m: f64,
    /// Blocks along it, from its head.
    pub blocks: Vec<String>,
    /// Length that lies in no block, between its head and its end [m].
    pub outside_m: f64,
}

/// All bolts of a scene.
#[derive(Clone, Debug, Serialize)]
#[serde(transparent)]
pub struct BoltReports(pub Vec<BoltReport>);

impl BoltReports {
    /// The bolts of a simulation.
    pub fn new(simulation: &Simulation) -> Self {
        let report = |index: usize| {
            let (name, portions) = simulation.bolt(index)?;
            let gaps = portions.windows(2).map(|pair| pair[1].from_m - pair[0].to_m);
            Some(BoltReport {
                name: name.to_string(),
                bonded_m: simulation.bonded_m(index),
                blocks: portions.iter().map(|p| simulation.blocks().names[p.block.index()].clone()).collect(),
                outside_m: gaps.sum::<f64>() + (simulation.bolt_length_m(index) - portions.last()?.to_m),
            })
        };
        Self((0..simulation.bolt_count()).filter_map(report).collect())
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

impl fmt::Display for BoltReports {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        if self.is_empty() {
            return Ok(());
        }
        let bonded = self.0.iter().map(|bolt| bolt.bonded_m);
        let (least_m, most_m) =
            bonded.fold((f64::INFINITY, 0.0f64), |(least, most), m| (least.min(m), most.max(m)));
        let bolts = counted(self.0.len(), "bolt", "bolts");
        write!(f, "\n{bolts}, each bonded over {least_m:.3} to {most_m:.3} m")?;
        for bolt in self.0.iter().take(LISTED) {
            write!(f, "\n  {}: {:.3} m in {}", bolt.name, bolt.bonded_m, bolt.blocks.join(", "))?;
            if bolt.outside_m > 1e-6 * bolt.bonded_m {
                write!(f, "; {:.3} m in no block", bolt.outside_m)?;
            }
        }
        if self.0.len() > LISTED { write!(f, "\n  and {} more", self.0.len() - LISTED) } else { Ok(()) }
    }
}
