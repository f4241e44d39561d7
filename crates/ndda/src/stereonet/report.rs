//! A stereonet in words.

use std::fmt;

use super::kinematics::{Checks, Count};
use super::orientation::Orientation;
use super::{Set, Stereonet, Wedge};
use crate::columns::columns;

/// Most intersections that are listed.
const MOST_WEDGES: usize = 15;
/// Most sets that are named beside a count.
const MOST_NAMED: usize = 12;

impl fmt::Display for Orientation {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{:02.0}/{:03.0}", self.dip_deg, self.dip_direction_deg.rem_euclid(360.0))
    }
}

impl Count {
    /// How many of all are critical: `3 of 10 planes (30 %)`.
    pub(super) fn of_all(&self, what: &str) -> String {
        let Self { critical, of } = self;
        let part = 100.0 * *critical as f64 / (*of).max(1) as f64;
        format!("{critical} of {of} {what} ({part:.0} %)")
    }
}

impl fmt::Display for Stereonet {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        self.warnings.iter().try_for_each(|warning| writeln!(f, "warning: {warning}"))?;
        let listed = self.listed();
        let header =
            ["set", "planes", "mean dip/direction", "Fisher K", "95 % confidence cone [°]"].map(String::from);
        let rows = listed.iter().map(|&set| row(&self.sets[set])).collect();
        writeln!(f, "{}", columns(header.to_vec(), rows))?;
        if self.sets.len() > listed.len() {
            let more = self.sets.len() - listed.len();
            writeln!(f, "and {more} more sets with no more planes than these; --json lists all")?;
        }
        if !self.borders.is_empty() {
            let names = self.borders.join(", ");
            writeln!(
                f,
                "not counted among the joints, as borders of rock that is removed or fixed: {names}"
            )?;
        }
        self.wedges_in_words(f)?;
        if let (Some(slope), Some(checks)) = (&self.slope, &self.checks) {
            let friction = match self.has_friction {
                true => format!("friction {}°", slope.friction_deg),
                false => "friction not considered (--friction is not given)".into(),
            };
            writeln!(f, "slope {}, {friction}; kinematically possible:", slope.face)?;
            let (sliding, toppling) = (checks.plane_sliding, checks.flexural_toppling);
            let of_sets = |count: &dyn Fn(&Checks) -> Count| self.critical_sets(count);
            writeln!(
                f,
                "  plane sliding      on {}{}",
                sliding.of_all("planes"),
                of_sets(&|c| c.plane_sliding)
            )?;
            writeln!(f, "  wedge sliding      along {}", checks.wedge_sliding.of_all("intersections"))?;
            writeln!(
                f,
                "  flexural toppling  on {}{}",
                toppling.of_all("planes"),
                of_sets(&|c| c.flexural_toppling)
            )?;
        }
        match &self.picture {
            Some(file) => write!(f, "{}", file.display()),
            None => write!(f, "no picture: this program was built without the feature `plots`"),
        }
    }
}

impl Stereonet {
    /// The sets with planes that meet a criterion, and how many of several do: `: J1, bedding (12)`.
    fn critical_sets(&self, count: &dyn Fn(&Checks) -> Count) -> String {
        let name = |set: &Set| {
            let Count { critical, of } = count(set.checks.as_ref()?);
            let name = &set.name;
            (critical > 0).then(|| if of > 1 { format!("{name} ({critical})") } else { name.clone() })
        };
        let names: Vec<String> = self.sets.iter().filter_map(name).collect();
        match names.len() {
            0 => String::new(),
            count if count > MOST_NAMED => {
                format!(": {} and {} more sets", names[..MOST_NAMED].join(", "), count - MOST_NAMED)
            }
            _ => format!(": {}", names.join(", ")),
        }
    }

    /// Intersections of mean planes, where they are many those along which wedges may slide first.
    fn wedges_in_words(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let mut wedges: Vec<&Wedge> = self.wedges.iter().collect();
        if wedges.len() > MOST_WEDGES {
            wedges.sort_by_key(|wedge| wedge.critical != Some(true));
            wedges.truncate(MOST_WEDGES);
        }
        for wedge in &wedges {
            let word = match wedge.critical {
                Some(true) => ": a wedge may slide along it".to_string(),
                Some(false) => {
                    let why = self.slope.and_then(|slope| slope.holds_wedge(&wedge.line));
                    format!(": no wedge slides along it ({})", why.unwrap_or_default())
                }
                None => String::new(),
            };
            let [a, b] = &wedge.sets;
            let (trend, plunge) = (wedge.line.trend_deg, wedge.line.plunge_deg);
            writeln!(f, "{a} and {b} meet in a line of trend {trend:.1}°, plunge {plunge:.1}°{word}")?;
        }
        match self.wedges.len() - wedges.len() {
            0 => Ok(()),
            more => writeln!(f, "and {more} more intersections; --json lists all"),
        }
    }
}

/// A set as a row of the table.
fn row(set: &Set) -> Vec<String> {
    let fisher = &set.fisher;
    let alike = fisher.planes > 1 && fisher.k.is_none();
    let or = |value: Option<f64>, other: &str| value.map_or(other.to_string(), |v| format!("{v:.1}"));
    vec![
        set.name.clone(),
        fisher.planes.to_string(),
        fisher.mean.to_string(),
        or(fisher.k, if alike { "all alike" } else { "–" }),
        or(fisher.confidence_95_deg, if alike { "0" } else { "–" }),
    ]
}
