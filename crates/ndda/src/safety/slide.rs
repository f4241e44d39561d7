//! The way in which a block slides down its planes, and how steep it is.

use ndda_mesh::Vec3;

/// By how much a direction may point into a plane and still count as along it.
const ALONG: f64 = 1e-9;

/// The steepest way down for a block on planes: down one of them, or along the line of two.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slide {
    /// Its direction, of length 1.
    pub direction: Vec3,
    /// Its angle below the plane across gravity [rad]. Its tangent is the part of the weight that drives the block that way over the part that presses it on its planes.
    pub slope_rad: f64,
    /// Normals into the block of the two planes that it slides on; one plane is there twice.
    pub normals: [Vec3; 2],
}

impl Slide {
    /// The steepest way down under gravity of some direction; none where planes of these normals into the block leave none, or do not carry it.
    ///
    /// The weight is the sum of a part in the cone of all ways that leave the planes or go along them, and of a part across it, in the cone of pushes on them (Moreau). The first is
    /// the longest projection of the weight on one plane, or on the line of two, that points into no other.
    pub fn down(gravity: Vec3, normals: &[Vec3]) -> Option<Self> {
        let gravity = gravity.normalize();
        normals.iter().any(|normal| normal.dot(&gravity) < 0.0).then_some(())?;
        let on_one = normals.iter().map(|n| (gravity - gravity.dot(n) * n, [*n; 2]));
        let pairs = normals.iter().enumerate().flat_map(|(k, a)| normals[..k].iter().map(move |b| [*a, *b]));
        let on_two = pairs.filter_map(|[a, b]| {
            let line = a.cross(&b).try_normalize(ALONG)?;
            Some((gravity.dot(&line) * line, [a, b]))
        });
        let is_open = |(way, _): &(Vec3, _)| normals.iter().all(|n| n.dot(way) > -ALONG);
        let (way, normals) =
            on_one.chain(on_two).filter(is_open).max_by(|a, b| a.0.norm().total_cmp(&b.0.norm()))?;
        let direction = way.try_normalize(ALONG)?;
        Some(Self { direction, slope_rad: way.norm().atan2((gravity - way).norm()), normals })
    }
}

/// The angle whose tangent is the part of the weight that drives a block down its planes over the part that presses it on them [rad]; a right angle where it leaves them.
pub fn slope_rad(gravity: Vec3, normals: &[Vec3; 2]) -> f64 {
    if normals.iter().all(|normal| normal.dot(&gravity) >= 0.0) {
        return std::f64::consts::FRAC_PI_2;
    }
    Slide::down(gravity, normals).map_or(0.0, |slide| slide.slope_rad)
}

/// The angle by which gravity has to be turned towards a direction across it, so that this tangent is multiplied by a factor [rad]. Below 1 it is turned back,
/// which makes the slope level at most where the direction is that of the slide.
pub fn tilt_rad(gravity: Vec3, across: Vec3, normals: &[Vec3; 2], factor: f64) -> f64 {
    let slope = |tilt: f64| slope_rad(gravity * tilt.cos() + across * tilt.sin(), normals);
    let now = slope(0.0);
    let wanted = (factor * now.tan()).atan();
    // Pushes on planes are a cone: the angle to it grows on the way from gravity to its opposite, on which the block leaves its planes.
    let (mut less, mut more) = if factor >= 1.0 { (0.0, std::f64::consts::PI) } else { (-now, 0.0) };
    for _ in 0..=f64::MANTISSA_DIGITS + 8 {
        let middle = 0.5 * (less + more);
        *(if slope(middle) < wanted { &mut less } else { &mut more }) = middle;
    }
    0.5 * (less + more)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Upward normal of a plane.
    fn normal(dip_deg: f64, direction_deg: f64) -> Vec3 {
        let (dip, direction) = (dip_deg.to_radians(), direction_deg.to_radians());
        Vec3::new(dip.sin() * direction.sin(), dip.sin() * direction.cos(), dip.cos())
    }

    fn towards(azimuth_deg: f64) -> Vec3 {
        let azimuth = azimuth_deg.to_radians();
        Vec3::new(azimuth.sin(), azimuth.cos(), 0.0)
    }

    fn near(found: f64, exact: f64) {
        assert!((found - exact).abs() < 1e-12, "{found} instead of {exact}");
    }

    /// The angle A of gravity to the normal of a plane that dips by α fulfils cos A = cos α cos(δ + θ)/cos δ, where δ is the dip along the direction of a tilt by θ.
    #[test]
    fn on_a_plane_a_tilt_multiplies_the_ratio_of_shear_to_normal_force_in_any_direction() {
        let (alpha, factor) = (20f64.to_radians(), 1.9f64);
        for off_deg in [0f64, 60.0, -85.0] {
            let tilt = tilt_rad(-Vec3::z(), towards(90.0 + off_deg), &[normal(20.0, 90.0); 2], factor);
            let along = (alpha.tan() * off_deg.to_radians().cos()).atan();
            let angle = (factor * alpha.tan()).atan();
            near(tilt, (along.cos() * angle.cos() / alpha.cos()).acos() - along);
        }
    }

    #[test]
    fn a_wedge_slides_down_its_line_and_a_tilt_that_way_multiplies_the_tangent_of_its_plunge() {
        let planes = [normal(40.0, 130.0), normal(60.0, 220.0)];
        let slide = Slide::down(-Vec3::z(), &planes).unwrap();
        let line = planes[0].cross(&planes[1]).normalize();
        near(slide.direction.dot(&line).abs(), 1.0);
        let trend = slide.direction.x.atan2(slide.direction.y).to_degrees();
        assert!((trend - 155.8).abs() < 0.05, "{trend}");
        let tilt = tilt_rad(-Vec3::z(), towards(trend), &slide.normals, 1.2746);
        near((slide.slope_rad + tilt).tan(), 1.2746 * slide.slope_rad.tan());
        // Less steep.
        let tilt = tilt_rad(-Vec3::z(), towards(trend), &slide.normals, 0.5);
        near((slide.slope_rad + tilt).tan(), 0.5 * slide.slope_rad.tan());
    }

    #[test]
    fn a_block_slides_on_the_one_plane_that_takes_it_off_the_other() {
        let slide = Slide::down(-Vec3::z(), &[normal(30.0, 90.0), normal(80.0, 60.0)]).unwrap();
        near(slide.slope_rad, 30f64.to_radians());
        assert_eq!(slide.normals, [normal(30.0, 90.0); 2]);
        // A step below it holds it.
        assert_eq!(Slide::down(-Vec3::z(), &[normal(30.0, 90.0), -towards(90.0)]), None);
        assert_eq!(Slide::down(-Vec3::z(), &[Vec3::z()]), None);
    }
}
