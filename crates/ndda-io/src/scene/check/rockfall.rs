//! Checks of rockfall. Whether it fits its terrain is found when that is read.

use std::path::Path;

use super::{Check, LIGHT_M_S};
use crate::scene::code::Code;
use crate::scene::{
    BoulderShape, BoulderSize, Ground, Integrator, Release, ReleasePlace, Rockfall, Scatter, Solver, Step,
    Zone,
};
use crate::scene::{ContactAt, Mass};

/// More boulders than this are a slip of the keyboard.
const MOST_BOULDERS: u32 = 1_000_000;
/// More zones than this have no numbers.
const MOST_ZONES: usize = 10_000;
/// Fewest and most faces of a random polyhedron.
const FACES: std::ops::RangeInclusive<u32> = 6..=24;
/// Diameter that boulders hardly have [m].
const LARGEST_M: f64 = 30.0;
/// Most that one axis of a boulder may be longer than another.
const MOST_SLENDER: f64 = 10.0;

impl Check<'_> {
    pub(super) fn rockfall(&mut self, folder: Option<&Path>) {
        let Some(rockfall) = &self.scene.rockfall else { return };
        self.nothing_else();
        self.ground(&rockfall.terrain, folder);
        self.ground_law("rockfall.ground", &rockfall.ground.restitution, &rockfall.ground.friction_deg);
        self.names("rockfall.zones", &rockfall.zones.iter().map(|z| z.name.as_str()).collect::<Vec<_>>());
        for (i, zone) in rockfall.zones.iter().enumerate() {
            let path = format!("rockfall.zones[{i}]");
            self.extent_of_zone(&path, zone, rockfall.class_grid.is_some());
            self.ground_law(&path, &zone.restitution, &zone.friction_deg);
        }
        if let Some(file) = &rockfall.class_grid {
            self.file("rockfall.class_grid".into(), file, folder);
            if rockfall.zones.iter().all(|zone| zone.classes.is_empty()) {
                let help = "write zones: [(name: \"talus\", classes: [2], restitution: …, friction_deg: …)], or leave it out";
                self.misfit("rockfall.class_grid", "no zone names a class of it", help);
            }
        }
        self.boulders(rockfall);
        self.names(
            "rockfall.releases",
            &rockfall.releases.iter().map(|r| r.name.as_str()).collect::<Vec<_>>(),
        );
        if rockfall.releases.is_empty() {
            self.misfit(
                "rockfall.releases",
                "nothing is released",
                "give at least one place where boulders start",
            );
        }
        for (i, release) in rockfall.releases.iter().enumerate() {
            self.release(&format!("rockfall.releases[{i}]"), release);
        }
        self.names("rockfall.lines", &rockfall.lines.iter().map(|l| l.name.as_str()).collect::<Vec<_>>());
        for (i, line) in rockfall.lines.iter().enumerate() {
            self.corners_apart(&format!("rockfall.lines[{i}].points_m"), &line.points_m);
        }
        if !rockfall.profile_m.is_empty() {
            self.corners_apart("rockfall.profile_m", &rockfall.profile_m);
        }
        if rockfall.zones.len() > MOST_ZONES {
            let message = format!("{} zones are more than {MOST_ZONES}", rockfall.zones.len());
            self.error("rockfall.zones", message, "join those of the same ground");
        }
        if rockfall.count == 0 || rockfall.count > MOST_BOULDERS {
            self.error("rockfall.count", format!("{} boulders", rockfall.count), "give 1 to 1e6");
        }
        self.positive("rockfall.rest.speed_m_s".into(), rockfall.rest.speed_m_s, "m/s");
        self.positive("rockfall.rest.over_s".into(), rockfall.rest.over_s, "s");
        let detail = &rockfall.detail;
        self.positive("rockfall.detail.impact_m_s".into(), detail.impact_m_s, "m/s");
        for (field, value) in
            [("path_m", detail.path_m), ("cell_m", detail.cell_m), ("part_m", detail.part_m)]
        {
            value.into_iter().for_each(|v| self.positive(format!("rockfall.detail.{field}"), v, "m"));
        }
    }

    /// Corners of a line that has a length.
    fn corners_apart(&mut self, path: &str, corners: &[[f64; 2]]) {
        self.corners(path, corners, 2);
        if corners.len() > 1 && corners.iter().all(|corner| *corner == corners[0]) {
            self.error(path, "has no length", "give corners that are apart");
        }
    }

    /// What a scene with boulders cannot have beside them.
    fn nothing_else(&mut self) {
        let scene = self.scene;
        let lists = [
            ("blocks", scene.blocks.is_empty()),
            ("rock", scene.rock.is_empty()),
            ("supports", scene.supports.is_empty()),
            ("tractions", scene.tractions.is_empty()),
            ("water", scene.water.is_empty()),
            ("quiet", scene.quiet.is_empty()),
            ("ties", scene.ties.is_empty()),
            ("blasts", scene.blasts.is_empty()),
            ("bolts", scene.bolts.is_empty()),
            ("forces", scene.forces.is_empty()),
            ("stages", scene.stages.is_empty()),
            ("monitors", scene.monitors.is_empty()),
            ("contact", scene.contact.is_none()),
            ("settle", scene.settle.is_none()),
            ("in_situ", scene.in_situ.is_none()),
            ("reference", scene.reference.is_none()),
        ];
        for (field, _) in lists.into_iter().filter(|(_, is_left_out)| !is_left_out) {
            let message = "a scene with `rockfall` has boulders and terrain, and nothing else";
            self.misfit(field, message, "leave it out, or leave out `rockfall`");
        }
        let [x, y, z] = scene.gravity_m_s2;
        if !(z < 0.0 && x == 0.0 && y == 0.0) || scene.gravity_ramp_s != 0.0 {
            let help = "write gravity_m_s2: (0, 0, -9.81), without gravity_ramp_s";
            self.misfit("gravity_m_s2", "boulders fall down, along −z", help);
        }
        let time = &scene.time;
        let is_plain = time.integrator == Integrator::default()
            && time.contact_at == ContactAt::default()
            && time.mass == Mass::default()
            && time.solver == Solver::default()
            && time.step == Step::default();
        if !is_plain {
            let help = "leave out all but end_s and step_s: boulders move by Midpoint(), in steps that are divided as contact requires";
            self.misfit("time", "how a boulder moves is not chosen", help);
        }
    }

    fn ground(&mut self, ground: &Ground, folder: Option<&Path>) {
        match ground {
            Ground::File { file, origin_m, sample_m } => {
                self.file("rockfall.terrain.file".into(), file, folder);
                self.numbers("rockfall.terrain.origin_m", origin_m);
                if let Some(sample_m) = sample_m {
                    self.positive("rockfall.terrain.sample_m".into(), *sample_m, "m");
                }
            }
            Ground::Heights { origin_m, step_m, heights_m } => {
                self.numbers("rockfall.terrain.origin_m", origin_m);
                self.positive("rockfall.terrain.step_m[0]".into(), step_m[0], "m");
                self.positive("rockfall.terrain.step_m[1]".into(), step_m[1], "m");
                heights_m.iter().for_each(|row| self.numbers("rockfall.terrain.heights_m", row));
                let columns = heights_m.first().map_or(0, Vec::len);
                if columns < 2 || heights_m.len() < 2 || heights_m.iter().any(|row| row.len() != columns) {
                    let message = "is not a grid of heights";
                    let help = "give at least two rows, all of the same length of at least two";
                    self.misfit("rockfall.terrain.heights_m", message, help);
                }
            }
        }
    }

    /// Where a zone is: within an outline, or of classes.
    fn extent_of_zone(&mut self, path: &str, zone: &Zone, has_grid: bool) {
        match (zone.outline_m.is_empty(), zone.classes.is_empty()) {
            (false, true) => self.corners(&format!("{path}.outline_m"), &zone.outline_m, 3),
            (true, false) if has_grid => {}
            (true, false) => {
                let help = "give rockfall.class_grid, the file of a grid that has them";
                self.misfit(format!("{path}.classes"), "there is no grid of classes", help);
            }
            (true, true) => self.misfit(path, "is nowhere", "give outline_m, or classes of a class_grid"),
            (false, false) => {
                self.misfit(path, "has both an outline and classes", "make two zones of it");
            }
        }
    }

    fn ground_law(&mut self, path: &str, restitution: &Scatter, friction_deg: &Scatter) {
        let restitution_path = format!("{path}.restitution");
        match restitution.middle() {
            percent if (2.0..=100.0).contains(&percent) => {
                let message = format!("{restitution:?}: must lie between 0 and 1");
                self.error(restitution_path, message, format!("{percent} % is {}", 0.01 * percent));
            }
            _ => self.scattered(&restitution_path, restitution, (0.0, 1.0)),
        }
        let friction_path = format!("{path}.friction_deg");
        self.scattered(&friction_path, friction_deg, (0.0, 89.0));
        self.coefficient(friction_path, friction_deg.middle());
    }

    fn boulders(&mut self, rockfall: &Rockfall) {
        let boulders = &rockfall.boulders;
        let materials: Vec<&str> = self.scene.materials.iter().map(|m| m.name.as_str()).collect();
        self.known("rockfall.boulders.material".into(), "material", &boulders.material, &materials);
        let (field, size) = match &boulders.size {
            BoulderSize::Diameter { diameter_m } => ("diameter_m", diameter_m),
            BoulderSize::Volume { volume_m3 } => ("volume_m3", volume_m3),
            BoulderSize::Mass { mass_kg } => ("mass_kg", mass_kg),
        };
        let path = format!("rockfall.boulders.size.{field}");
        let (least, most) = boulders.within.unwrap_or((0.0, f64::INFINITY));
        if !(0.0 <= least && least < most) {
            let message =
                format!("({least}, {most}): the least size comes first, and is less than the largest");
            self.error("rockfall.boulders.within", message, "exchange the two");
        }
        self.scattered(&path, size, (0.0, f64::INFINITY));
        let lowest = size.ends().0;
        if lowest <= 0.0 && least <= 0.0 {
            let message = format!("{size:?} has boulders without size");
            self.error(path, message, "give `within`, with a least size above 0, or another distribution");
        }
        self.likely_size(&format!("rockfall.boulders.size.{field}"), &boulders.size, (least, most));
        if boulders.shapes.is_empty() {
            self.misfit("rockfall.boulders.shapes", "there is no shape", "leave it out, or give one");
        }
        for (i, shape) in boulders.shapes.iter().enumerate() {
            let path = format!("rockfall.boulders.shapes[{i}]");
            let axes = match shape {
                BoulderShape::Cuboid { axes } | BoulderShape::Ellipsoid { axes } => axes,
                BoulderShape::Polyhedron { faces, axes } => {
                    if !FACES.contains(faces) {
                        let message = format!("{faces} faces");
                        self.error(format!("{path}.faces"), message, "give 6 to 24");
                    }
                    axes
                }
            };
            let (least, most) = axes.iter().fold((f64::INFINITY, 0.0f64), |(a, b), v| (a.min(*v), b.max(*v)));
            if !(least > 0.0 && most <= MOST_SLENDER * least) {
                let message = format!("{axes:?} cannot be the axes of a boulder");
                self.error(format!("{path}.axes"), message, "give three above 0, none ten times another");
            }
        }
    }

    /// Warns of sizes most of which are cut off, and of those that no boulder has.
    fn likely_size(&mut self, path: &str, size: &BoulderSize, (least, most): (f64, f64)) {
        let (scatter, unit, largest, likely) = match size {
            BoulderSize::Diameter { diameter_m } => (diameter_m, "m", LARGEST_M, "1000 mm are 1 m"),
            BoulderSize::Volume { volume_m3 } => (volume_m3, "m³", LARGEST_M.powi(3), "1000 l are 1 m³"),
            BoulderSize::Mass { mass_kg } => (mass_kg, "kg", 5e3 * LARGEST_M.powi(3), "1 t is 1000 kg"),
        };
        let median = scatter.median();
        if least < most && !(least..=most).contains(&median) {
            let message = format!(
                "the median, {median:.4} {unit}, is outside of `within` ({least}, {most}): more than half of the sizes are cut off"
            );
            let help = format!("the unit is {unit}: {likely}; else change `within`");
            self.warn(Code::UnitSlip, path, message, help);
        } else if median > largest {
            let message = format!("the median is {median:.4} {unit}: no boulder is as large");
            self.warn(Code::UnitSlip, path, message, format!("the unit is {unit}: {likely}"));
        }
    }

    fn release(&mut self, path: &str, release: &Release) {
        let at = |field: &str| format!("{path}.{field}");
        match &release.place {
            ReleasePlace::Points(points) => self.corners(&at("place"), points, 1),
            ReleasePlace::Line(points) => self.corners(&at("place"), points, 2),
            ReleasePlace::Area(points) => self.corners(&at("place"), points, 3),
        }
        self.positive(at("share"), release.share, "");
        let limits = [
            ("height_m", &release.height_m, (0.0, f64::INFINITY)),
            ("speed_m_s", &release.speed_m_s, (0.0, LIGHT_M_S)),
            ("azimuth_deg", &release.azimuth_deg, (-360.0, 720.0)),
            ("dip_deg", &release.dip_deg, (-90.0, 90.0)),
            ("spin_rad_s", &release.spin_rad_s, (f64::NEG_INFINITY, f64::INFINITY)),
        ];
        for (field, value, limits) in limits {
            value.iter().for_each(|value| self.scattered(&at(field), value, limits));
        }
    }

    /// Corners on the map, at least so many.
    fn corners(&mut self, path: &str, corners: &[[f64; 2]], least: usize) {
        self.numbers(path, corners.as_flattened());
        if corners.len() < least {
            let message = format!("{} point(s)", corners.len());
            self.error(path, message, format!("give at least {least}"));
        }
    }

    /// A number that scatters: its parameters make sense, and what it may be of bounded distributions lies within limits. Others are cut off there.
    fn scattered(&mut self, path: &str, scatter: &Scatter, (least, most): (f64, f64)) {
        if let Err(reason) = scatter.check() {
            return self.error(path, reason, "see Scatter in docs/reference/scene.md");
        }
        let (low, high) = scatter.ends();
        let middle = scatter.middle();
        let is_bounded = !matches!(scatter, Scatter::Normal(..) | Scatter::LogNormal(..));
        if (is_bounded && (low < least || high > most)) || !(least..=most).contains(&middle) {
            let message = format!("{scatter:?}: must lie between {least} and {most}");
            self.error(path, message, "the unit is that of the field's name");
        }
    }
}

impl Scatter {
    /// Whether its parameters make sense.
    ///
    /// # Errors
    /// The one that does not, and what to write.
    pub fn check(&self) -> Result<(), String> {
        match self.as_distribution() {
            Some(distribution) => distribution.check(),
            None if self.middle().is_finite() => Ok(()),
            None => Err(format!("{self:?}: must be a finite number")),
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::scene::Scatter;
    use crate::scene::code::Code;
    use crate::scene::read::load_text;

    /// What is taken for a slip in the units of a rockfall with boulders of this density, size and ground.
    fn slips(density_kg_m3: &str, size: &str, friction_deg: &str) -> Vec<String> {
        let text = format!(
            "(title: \"t\", time: (end_s: 9), gravity_m_s2: (0, 0, -9.81),
              materials: [(name: \"rock\", density_kg_m3: {density_kg_m3}, young_pa: 2e10, poisson: 0.2)],
              rockfall: (
                  terrain: Heights(origin_m: (0, 0), step_m: (1, 1), heights_m: [[0, 0], [0, 0]]),
                  ground: (restitution: Always(0.3), friction_deg: {friction_deg}), boulders: (material: \"rock\", {size}),
                  releases: [(name: \"edge\", place: Points([(0.5, 0.5)]))],
              ))"
        );
        let loaded =
            load_text("s.ron", &text, &[], None).unwrap_or_else(|errors| panic!("{}", errors.render(false)));
        let slips = loaded.warnings.into_iter().filter(|found| found.code == Code::UnitSlip);
        slips.map(|found| format!("{}: {}", found.path, found.message)).collect()
    }

    #[test]
    fn numbers_in_other_units_are_warned_of() {
        let metres = "size: Diameter(diameter_m: LogNormal(1, 0.3)), within: (0.4, 2.5)";
        assert_eq!(slips("2700", metres, "Normal(34, 2)"), Vec::<String>::new());
        let found = slips("2.7", metres, "Normal(0.6, 0.05)");
        assert!(
            found.len() == 2 && found[0].contains("density") && found[1].contains("friction"),
            "{found:?}"
        );
        // The median is the mean over √(1 + 0.3²).
        let found = slips("2700", &metres.replace("(1, 0.3)", "(1000, 300)"), "Normal(34, 2)");
        assert!(
            found.len() == 1 && found[0].contains("957.8263 m, is outside of `within` (0.4, 2.5)"),
            "{found:?}"
        );
        let found = slips("2700", "size: Diameter(diameter_m: Always(800))", "Normal(34, 2)");
        assert!(found.len() == 1 && found[0].contains("no boulder is as large"), "{found:?}");
    }

    #[test]
    fn half_of_a_triangular_distribution_is_below_its_median() {
        // The cumulative distribution of Triangular(a, c, b) is (x − a)²/((b − a)(c − a)) up to c.
        for (a, c, b) in [(1.0, 4.0, 5.0), (1.0, 2.0, 5.0), (0.0, 1.0, 1.0)] {
            let x = Scatter::Triangular(a, c, b).median();
            let below = match x <= c {
                true => (x - a) * (x - a) / ((b - a) * (c - a)),
                false => 1.0 - (b - x) * (b - x) / ((b - a) * (b - c)),
            };
            assert!((below - 0.5f64).abs() < 1e-15, "{a} {c} {b}: {x}");
        }
    }
}
