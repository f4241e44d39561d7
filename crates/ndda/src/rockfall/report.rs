//! The outcome in words and columns.

use std::fmt::{self, Write as _};

use super::Model;
use super::draw::LITTLE;
use super::result::{Ends, Outcome};
use super::spread::{Runout, Spread};
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
            write!(f, "\nand {} more", self.unnamed.len() - LISTED)?;
        }
        self.bare.iter().chain(&self.holes).try_for_each(|lack| write!(f, "\n{lack}"))
    }
}

/// The outcome as text.
fn text(outcome: &Outcome) -> String {
    let Outcome { scene, title, count, ends, .. } = outcome;
    let mut text = format!("{scene}: {title}\n");
    let _ = writeln!(text, "{count} boulders over {} triangles: {}", outcome.triangles, ends_in_words(ends));
    for warning in &outcome.warnings {
        let _ = writeln!(text, "warning: {warning}");
    }
    if outcome.sizes_cut_off > LITTLE {
        let percent = number(100.0 * outcome.sizes_cut_off);
        let _ =
            writeln!(text, "sizes: {percent} % of their distribution lies beyond `within` and is cut off");
    }
    let _ = writeln!(text, "runout: {}", runout(&outcome.runout_m, ends));
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
                format!(
                    "{}{:.1} % ({:.1} to {:.1} %)",
                    if line.might > 0 { "at least " } else { "" },
                    100.0 * line.probability,
                    100.0 * low,
                    100.0 * high
                ),
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
        let is = if accuracy.inaccurate == 1 { "is" } else { "are" };
        let _ = writeln!(text, "note: {} of {count} falls {is} inaccurate:", accuracy.inaccurate);
        for reason in &accuracy.reasons {
            let _ = writeln!(text, "  {reason}");
        }
    } else {
        let _ = writeln!(
            text,
            "accurately computed: energy error within {:.1e} of the largest kinetic energy, penetration within {:.1} % of a boulder's width",
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
        size if size > 0.0 && size < 0.01 => format!("{value:.1e}"),
        _ => format!("{value:.2}"),
    }
}

/// Median and 95th percentile, or why there are none, and the farthest boulder at rest.
fn runout(runout: &Runout, ends: &Ends) -> String {
    let Ends { left_terrain, still_moving, stopped, .. } = *ends;
    let on_their_way = ends_in_words(&Ends { rest: 0, left_terrain, still_moving, stopped });
    let count = ends.rest + left_terrain + still_moving + stopped;
    let (mut known, mut unknown) = (Vec::new(), Vec::new());
    for (name, value, words) in
        [("median", runout.median, "median"), ("95 % value", runout.percentile_95, "95 % within")]
    {
        match value {
            Some(value) => known.push(format!("{words} {value:.1} m")),
            None => unknown.push(name),
        }
    }
    let farthest = if on_their_way.is_empty() { "farthest" } else { "farthest at rest" };
    known.extend(runout.largest.map(|largest| format!("{farthest} {largest:.1} m")));
    if !unknown.is_empty() {
        let unknown = unknown.join(" or ");
        known.push(format!("no {unknown} can be given: of {count} boulders {on_their_way}"));
    }
    known.join(", ")
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runout_says_what_cannot_be_given_and_why() {
        let all = Runout { median: Some(212.4), percentile_95: Some(263.84), largest: Some(266.9) };
        let ends = Ends { rest: 40, ..Ends::default() };
        assert_eq!(runout(&all, &ends), "median 212.4 m, 95 % within 263.8 m, farthest 266.9 m");
        let cut_off = Runout { percentile_95: None, ..all };
        let ends = Ends { rest: 33, left_terrain: 7, ..Ends::default() };
        assert_eq!(
            runout(&cut_off, &ends),
            "median 212.4 m, farthest at rest 266.9 m, no 95 % value can be given: of 40 boulders 7 left the terrain"
        );
        let none = Runout { median: None, percentile_95: None, largest: None };
        let ends = Ends { still_moving: 8, ..Ends::default() };
        assert_eq!(
            runout(&none, &ends),
            "no median or 95 % value can be given: of 8 boulders 8 still moved at the end"
        );
    }
}
