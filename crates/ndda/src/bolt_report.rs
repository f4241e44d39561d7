//! What `ndda check` says of bolts: how many there are, in which blocks they are bonded, and which leave the rock.

use std::collections::BTreeSet;
use std::fmt;

use ndda_solver::{Portion, Simulation};
use serde::Serialize;

use crate::numbers::counted;

/// Names of bolts listed at most.
const LISTED: usize = 8;

/// Length outside of the rock over that bonded in it which is rounding.
const SHORT: f64 = 1e-6;

/// Length in front of the rock below which a head lies on its face [m].
const IN_FRONT_M: f64 = 5e-4;

fn lie(count: usize) -> String {
    format!("{} {}", counted(count, "bolt", "bolts"), if count == 1 { "lies" } else { "lie" })
}

/// One bolt.
#[derive(Clone, Debug, Serialize)]
pub struct BoltReport {
    /// Its name.
    pub name: String,
    /// Bonded length in blocks [m].
    pub bonded_m: f64,
    /// Blocks along it, from its head.
    pub blocks: Vec<String>,
    /// Those in which it is bonded, from its head.
    pub bonded_in: Vec<String>,
    /// Length from its head to the first block [m].
    pub in_front_m: f64,
    /// Length that lies in no block, between the first block and its end [m].
    pub outside_m: f64,
}

impl BoltReport {
    /// The blocks that its free length runs through, where nothing but a plate ties it to them.
    fn free_in(&self) -> Vec<&str> {
        let is_free = |block: &&String| !self.bonded_in.contains(block);
        self.blocks.iter().filter(is_free).map(String::as_str).collect()
    }

    /// Whether a joint or a gap lies along it.
    fn crosses_a_joint(&self) -> bool {
        self.blocks.len() > 1 || self.outside_m > SHORT * self.bonded_m
    }
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
            let name_of = |part: &Portion| simulation.blocks().names[part.block.index()].clone();
            let mut bonded_in: Vec<String> = simulation.bonded_parts(index).iter().map(name_of).collect();
            bonded_in.dedup();
            Some(BoltReport {
                name: name.to_string(),
                bonded_m: simulation.bonded_m(index),
                blocks: portions.iter().map(name_of).collect(),
                bonded_in,
                in_front_m: portions.first()?.from_m,
                outside_m: gaps.sum::<f64>() + (simulation.bolt_length_m(index) - portions.last()?.to_m),
            })
        };
        Self((0..simulation.bolt_count()).filter_map(report).collect())
    }

    /// Bolts that hold nothing together, and those that leave the rock, each with what to change. Of rows, some bolts may lie within one block, not all:
    /// `entry` gives the same number for bolts of the same rows.
    pub fn doubts(&self, entry: impl Fn(&str) -> usize) -> Vec<String> {
        let crossing: BTreeSet<usize> =
            self.0.iter().filter(|bolt| bolt.crosses_a_joint()).map(|bolt| entry(&bolt.name)).collect();
        let alone = self.0.iter().filter(|bolt| !crossing.contains(&entry(&bolt.name)));
        let outside = self.0.iter().filter(|bolt| bolt.outside_m > SHORT * bolt.bonded_m);
        let (alone, outside): (Vec<&BoltReport>, Vec<&BoltReport>) = (alone.collect(), outside.collect());
        let mut doubts = Vec::new();
        if let Some(first) = alone.first() {
            doubts.push(format!(
                "{} within one block and {} no joint: `{}` in `{}`; take longer bolts or another direction, unless they are to stiffen a block that deforms",
                lie(alone.len()),
                if alone.len() == 1 { "crosses" } else { "cross" },
                first.name,
                first.blocks[0]
            ));
        }
        if let Some(first) = outside.iter().max_by(|a, b| a.outside_m.total_cmp(&b.outside_m)) {
            doubts.push(format!(
                "{} partly outside all blocks: `{}` over {:.3} m, where nothing holds it; shorten or move them",
                lie(outside.len()),
                first.name,
                first.outside_m
            ));
        }
        doubts
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
        let (least, most) = (format!("{least_m:.3}"), format!("{most_m:.3}"));
        let each = if self.0.len() > 1 { "each " } else { "" };
        match least == most {
            true => write!(f, "\n{bolts}, {each}bonded over {most} m")?,
            false => write!(f, "\n{bolts}, each bonded over {least} to {most} m")?,
        }
        let crossing = self.0.iter().filter(|bolt| bolt.crosses_a_joint()).count();
        match self.0.len() - crossing {
            0 => {}
            _ if crossing == 0 => f.write_str(", within one block")?,
            alone => write!(f, "; {alone} of them within one block, where they cross no joint")?,
        }
        for bolt in self.0.iter().take(LISTED) {
            write!(f, "\n  {}: {:.3} m in {}", bolt.name, bolt.bonded_m, bolt.bonded_in.join(", "))?;
            let free_in = bolt.free_in();
            if !free_in.is_empty() {
                write!(f, "; free in {}", free_in.join(", "))?;
            }
            if bolt.outside_m > SHORT * bolt.bonded_m {
                write!(f, "; {:.3} m in no block", bolt.outside_m)?;
            }
            if bolt.in_front_m > IN_FRONT_M {
                let (m, first) = (bolt.in_front_m, &bolt.blocks[0]);
                write!(
                    f,
                    "; its head is {m:.3} m in front of {first}, and from_m and to_m of its grout count from there"
                )?;
            }
        }
        if self.0.len() > LISTED { write!(f, "\n  and {} more", self.0.len() - LISTED) } else { Ok(()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn reports(to_m: &str, grouted: &str) -> BoltReports {
        reports_from(1.9, to_m, grouted)
    }

    /// Of a bolt whose head is so high [m].
    fn reports_from(head_m: f64, to_m: &str, grouted: &str) -> BoltReports {
        let text = format!(
            r#"(
                title: "A bolt through two blocks", time: (step_s: 1e-4, end_s: 1e-3),
                materials: [(name: "rock", density_kg_m3: 2600, young_pa: 20e9, poisson: 0.25)],
                blocks: [
                    (name: "foot", material: "rock", body: Fixed, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1))),
                    (name: "top", material: "rock", body: Rigid, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), at_m: (0, 0, 1)),
                ],
                contact: Potential(penalty_pa: 1e9, friction: (friction_deg: 30)),
                bolts: [(
                    name: "anchor", at: Line(from_m: (0.4, 0.45, {head_m}), to_m: {to_m}),
                    steel: (young_pa: 200e9, area_m2: 5e-4), grout: (stiffness_n_m2: 1e9, strength_n_m: 2e5{grouted}),
                )],
            )"#
        );
        BoltReports::new(&crate::Model::from_text(&text).unwrap().simulation)
    }

    fn doubts(to_m: &str) -> Vec<String> {
        reports(to_m, "").doubts(|_| 0)
    }

    #[test]
    fn a_bolt_is_bonded_where_its_grout_is_and_free_in_the_blocks_before() {
        // The joint is 0.9 m from the head.
        let to_m = "(0.4, 0.45, 0.2)";
        for (grouted, said) in [
            ("", "anchor: 1.700 m in top, foot"),
            (", from_m: 1", "anchor: 0.700 m in foot; free in top"),
            (", from_m: 0.5", "anchor: 1.200 m in top, foot"),
            (", to_m: 0.8", "anchor: 0.800 m in top; free in foot"),
        ] {
            let told = reports(to_m, grouted).to_string();
            assert_eq!(told.lines().last().unwrap().trim(), said);
        }
    }

    #[test]
    fn a_head_in_front_of_the_rock_is_told_with_what_counts_from_it() {
        let told = reports_from(2.5, "(0.4, 0.45, 0.2)", ", from_m: 1").to_string();
        let expected = "anchor: 1.300 m in top, foot; its head is 0.500 m in front of top, and from_m and to_m of its grout count from there";
        assert_eq!(told.lines().last().unwrap().trim(), expected);
        assert!(!reports_from(2.0, "(0.4, 0.45, 0.2)", "").to_string().contains("in front"));
    }

    #[test]
    fn bolts_that_hold_nothing_together_or_leave_the_rock_are_doubted() {
        assert_eq!(doubts("(0.4, 0.45, 0.2)"), Vec::<String>::new());
        let within = doubts("(0.4, 0.45, 1.2)");
        assert!(
            matches!(&within[..], [one] if one.contains("crosses no joint") && one.contains("`top`")),
            "{within:?}"
        );
        let outside = doubts("(0.4, 0.45, -0.5)");
        assert!(matches!(&outside[..], [one] if one.contains("0.500 m")), "{outside:?}");
    }
}
