//! A stereonet in words.

use std::fmt;

use super::kinematics::Count;
use super::orientation::Orientation;
use super::{Set, Stereonet};
use crate::columns::columns;

impl fmt::Display for Orientation {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{:02.0}/{:03.0}", self.dip_deg, self.dip_direction_deg.rem_euclid(360.0))
    }
}

impl fmt::Display for Count {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self { critical, of } = self;
        let part = 100.0 * *critical as f64 / (*of).max(1) as f64;
        write!(f, "{critical} of {of} ({part:.0} %)")
    }
}

impl fmt::Display for Stereonet {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let optional =
            |value: Option<f64>, digits: usize| value.map_or("–".into(), |v| format!("{v:.digits$}"));
        let header = ["set", "planes", "mean dip/direction", "K", "95 % cone [°]"].map(String::from);
        let row = |set: &Set| {
            vec![
                set.name.clone(),
                set.fisher.planes.to_string(),
                set.fisher.mean.to_string(),
                optional(set.fisher.k, 1),
                optional(set.fisher.confidence_95_deg, 1),
            ]
        };
        writeln!(f, "{}", columns(header.to_vec(), self.sets.iter().map(row).collect()))?;
        for wedge in &self.wedges {
            let word = match wedge.critical {
                Some(true) => ": a wedge may slide along it",
                Some(false) => ": no wedge slides along it",
                None => "",
            };
            let [a, b] = &wedge.sets;
            let (trend, plunge) = (wedge.line.trend_deg, wedge.line.plunge_deg);
            writeln!(f, "{a} and {b} meet in a line of trend {trend:.1}°, plunge {plunge:.1}°{word}")?;
        }
        if let (Some(slope), Some(checks)) = (&self.slope, &self.checks) {
            let face = slope.face;
            writeln!(f, "slope {face}, friction {}°: directions that allow", slope.friction_deg)?;
            writeln!(f, "  plane sliding      {} planes", checks.plane_sliding)?;
            writeln!(f, "  wedge sliding      {} intersections", checks.wedge_sliding)?;
            writeln!(f, "  flexural toppling  {} planes", checks.flexural_toppling)?;
        }
        match &self.picture {
            Some(file) => write!(f, "{}", file.display()),
            None => write!(f, "no picture: this program was built without the feature `plots`"),
        }
    }
}
