//! The outcome in words and columns.

use std::fmt::{self, Write as _};

use super::Model;
use super::result::{Ends, Outcome};
use super::spread::Spread;
use crate::columns::columns;
use crate::numbers::counted;

/// Classes listed at most.
const LISTED: usize = 8;

impl fmt::Display for Outcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&text(self))
    }
}

impl fmt::Display for Model {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (rockfall, terrain) = (&self.rockfall, &self.terrain);
        let (low, high) = terrain.heights_m();
        write!(
            f,
            "{} boulders over {} triangles, {:.2} to {:.2} m high; {}, {}; steps of at most {:.1e} s",
            rockfall.count,
            terrain.triangles(),
            low,
            high,
            counted(rockfall.zones.len(), "zone", "zones"),
            counted(rockfall.lines.len(), "line", "lines"),
            self.step_s()
        )?;
        for (class, cells) in self.unnamed.iter().take(LISTED) {
            let cells = counted(*cells, "cell", "cells");
            write!(f, "\nclass {class}, of {cells}, belongs to no zone: it has `ground`")?;
        }
        if self.unnamed.len() > LISTED {
            write!(f, "\nand {} more", self.unnamed.len() - LISTED)
        } else {
            Ok(())
        }
    }
}

/// The outcome as text.
fn text(outcome: &Outcome) -> String {
    let Outcome { scene, title, count, ends, .. } = outcome;
    let mut text = format!("{scene}: {title}\n");
    let _ = writeln!(text, "{count} boulders over {} triangles: {}", outcome.triangles, ends_in_words(ends));
    if let Some(runout) = &outcome.runout_m {
        let _ = writeln!(
            text,
            "runout of those at rest: median {:.1} m, 95 % within {:.1} m, farthest {:.1} m",
            runout.median, runout.percentile_95, runout.largest
        );
    }
    if !outcome.lines.is_empty() {
        let header = [
            "line",
            "reached",
            "probability (95 % confidence)",
            "height [m]",
            "top [m]",
            "speed [m/s]",
            "energy [kJ]",
        ];
        let rows = outcome.lines.iter().map(|line| {
            let [low, high] = line.confidence_95;
            let spread = |of: Option<Spread>, unit: f64| {
                of.map_or_else(
                    || "–".into(),
                    |s| format!("{} · {}", number(s.median / unit), number(s.percentile_95 / unit)),
                )
            };
            let first = line.first.as_ref();
            vec![
                line.name.clone(),
                line.reached.to_string(),
                format!("{:.1} % ({:.1} to {:.1} %)", 100.0 * line.probability, 100.0 * low, 100.0 * high),
                spread(first.map(|f| f.height_m), 1.0),
                spread(first.map(|f| f.top_m), 1.0),
                spread(first.map(|f| f.speed_m_s), 1.0),
                spread(first.map(|f| f.energy_j), 1e3),
            ]
        });
        let _ = writeln!(text, "{}", columns(header.map(String::from).to_vec(), rows.collect()));
        let _ = writeln!(
            text,
            "median · 95th percentile at the first passage; height of the centre of mass and of the highest point above the ground"
        );
    }
    let accuracy = &outcome.accuracy;
    if accuracy.inaccurate > 0 {
        let _ = writeln!(text, "note: {} of {count} falls are inaccurate:", accuracy.inaccurate);
        for reason in &accuracy.reasons {
            let _ = writeln!(text, "  {reason}");
        }
    } else {
        let _ = writeln!(
            text,
            "all accurate: energy error within {:.1e} of the largest kinetic energy, penetration within {:.1} % of a boulder's width",
            accuracy.worst.energy,
            100.0 * accuracy.worst.depth
        );
    }
    let _ = writeln!(text, "time spent: {:.1} s for {} steps", outcome.wall_s, outcome.steps);
    text
}

/// A number to three digits.
fn number(value: f64) -> String {
    match value.abs() {
        size if size >= 100.0 => format!("{value:.0}"),
        size if size >= 10.0 => format!("{value:.1}"),
        _ => format!("{value:.2}"),
    }
}

fn ends_in_words(ends: &Ends) -> String {
    let parts = [
        (ends.rest, "came to rest"),
        (ends.left_terrain, "left the terrain"),
        (ends.still_moving, "still moved at the end"),
        (ends.stopped, "could not be computed to the end"),
    ];
    let said: Vec<String> =
        parts.iter().filter(|(count, _)| *count > 0).map(|(count, what)| format!("{count} {what}")).collect();
    said.join(", ")
}
