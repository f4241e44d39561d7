//! Where a boulder starts, and how it moves then.

use ndda_io::scene::{Release, ReleasePlace, Rockfall, Scatter};
use ndda_mesh::{Mat3, Vec3};

use super::boulder::Boulder;
use super::draw::{DIPS_DEG, Draw, FROM_ZERO, Of};
use super::passage::{length_m, point_at};
use super::terrain::{Terrain, is_inside};
use super::window::{Cells, Motion};

/// Points that are tried until one is within an area.
const TRIES: usize = 1000;

/// The release that the boulder with this number has: shares are dealt out so that each first boulders have them as nearly as whole numbers can.
pub(super) fn release_of(rockfall: &Rockfall, boulder: u32) -> usize {
    let total: f64 = rockfall.releases.iter().map(|release| release.share).sum();
    // The golden ratio spreads its multiples evenly, whatever their number (Weyl's sequence).
    let at = (f64::from(boulder) * 0.618_033_988_749_894_9 + 0.5).fract() * total;
    let mut sum = 0.0;
    let reached = rockfall.releases.iter().position(|release| {
        sum += release.share;
        at < sum
    });
    reached.unwrap_or(rockfall.releases.len() - 1)
}

/// A place on the map [m].
fn place_on_map(from: &ReleasePlace, boulder: u32, draw: &Draw) -> Option<[f64; 2]> {
    let mut stream = draw.stream(Of::Place, 0);
    match from {
        ReleasePlace::Points(points) => points.get(boulder as usize % points.len()).copied(),
        ReleasePlace::Line(corners) => Some(point_at(corners, stream.uniform() * length_m(corners))),
        ReleasePlace::Area(corners) => {
            let ends = [0, 1].map(|axis| {
                let along = corners.iter().map(|corner| corner[axis]);
                along.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)))
            });
            let mut candidate = || ends.map(|(a, b)| stream.between(a, b));
            (0..TRIES).map(|_| candidate()).find(|at| is_inside(corners, *at))
        }
    }
}

/// The boulder as it is released.
///
/// # Errors
/// Why it cannot be there.
pub(super) fn start(
    (release, boulder): (&Release, &Boulder),
    number: u32,
    terrain: &Terrain,
    draw: &Draw,
) -> Result<Motion, String> {
    let at = place_on_map(&release.place, number, draw)
        .ok_or("no place was found in the release area, which is almost zero: move its corners apart")?;
    let on_map = || format!("({}, {})", at[0], at[1]);
    let (ground_m, slope) = terrain
        .at(at)
        .ok_or_else(|| {
            let [[x0, y0], [x1, y1]] = terrain.bounds_m();
            format!(
                "the terrain, x from {x0} to {x1} m and y from {y0} to {y1} m, has no height at {}: move the release onto it, or check the terrain's coordinates",
                on_map()
            )
        })?;
    let flat = Vec3::new(at[0], at[1], ground_m);
    if Cells::below(terrain, &flat, boulder.radius_m).is_none() {
        let radius_m = boulder.radius_m;
        return Err(format!(
            "a boulder of radius {radius_m:.2} m at {} reaches the end of the terrain: release it farther inside",
            on_map()
        ));
    }
    let value =
        |of, scatter: &Option<Scatter>, limits| scatter.as_ref().map(|s| draw.value(of, 0, s, limits));
    let all = (f64::NEG_INFINITY, f64::INFINITY);
    let height_m = value(Of::Height, &release.height_m, FROM_ZERO).unwrap_or(0.0);
    let speed = value(Of::Speed, &release.speed_m_s, FROM_ZERO).unwrap_or(0.0);
    let azimuth_deg = value(Of::Azimuth, &release.azimuth_deg, all);
    let forward = azimuth_deg.map_or_else(|| downhill(slope), heading);
    let fall = -(slope[0] * forward.x + slope[1] * forward.y);
    let dip = match value(Of::Dip, &release.dip_deg, DIPS_DEG) {
        Some(dip_deg) => dip_deg.to_radians(),
        None if azimuth_deg.is_none() => fall.atan(),
        None => 0.0,
    };
    let spin = value(Of::Spin, &release.spin_rad_s, all).unwrap_or(0.0);
    let turned = turned(boulder, &draw.turn());
    let center = flat + Vec3::z() * (clearance_m(terrain, &flat, &turned) + height_m);
    Ok(Motion {
        arms: turned,
        center,
        velocity_m_s: speed * (dip.cos() * forward - dip.sin() * Vec3::z()),
        // Forward rotation is about z × forward: the top moves ahead.
        spin_rad_s: spin * Vec3::z().cross(&forward),
    })
}

fn turned(boulder: &Boulder, turn: &Mat3) -> Vec<Vec3> {
    boulder.mesh.nodes.iter().map(|x| turn * x).collect()
}

/// Direction of the steepest descent on the map; north on level ground.
fn downhill([x, y]: [f64; 2]) -> Vec3 {
    let steepness = x.hypot(y);
    if steepness > 0.0 { -Vec3::new(x, y, 0.0) / steepness } else { Vec3::y() }
}

/// Direction of an azimuth, clockwise from north [°].
fn heading(azimuth_deg: f64) -> Vec3 {
    let (sin, cos) = azimuth_deg.to_radians().sin_cos();
    Vec3::new(sin, cos, 0.0)
}

/// Height of the mass centre above the ground at which a boulder touches it [m]: no corner of it is below the ground, nor a corner of the ground in its plan
/// above its lowest point.
fn clearance_m(terrain: &Terrain, flat: &Vec3, arms: &[Vec3]) -> f64 {
    let below = |arm: &Vec3| {
        let ground = terrain.at([flat.x + arm.x, flat.y + arm.y]).map_or(flat.z, |(z, _)| z);
        ground - flat.z - arm.z
    };
    let lift = arms.iter().map(below).fold(f64::NEG_INFINITY, f64::max);
    // Ridges of the ground between the corners of the boulder: its lowest point is held above them.
    let lowest = arms.iter().map(|arm| arm.z).fold(f64::INFINITY, f64::min);
    let radius_m = arms.iter().map(|arm| arm.norm()).fold(0.0, f64::max);
    let Some(cells) = Cells::below(terrain, flat, radius_m) else { return lift };
    let mut highest = f64::NEG_INFINITY;
    for j in cells.from[1]..=cells.to[1] {
        for i in cells.from[0]..=cells.to[0] {
            let corner = terrain.corner_m(i, j) - flat;
            if corner.xy().norm() < radius_m {
                highest = highest.max(corner.z + support(arms, lowest, &corner));
            }
        }
    }
    lift.max(highest)
}

/// How far the underside of a boulder is below its mass centre at a place in plan, at most [m]: at most its lowest point, and no more than a ball around it has
/// there.
fn support(arms: &[Vec3], lowest: f64, at: &Vec3) -> f64 {
    let radius2 = arms.iter().map(|arm| arm.norm_squared()).fold(0.0, f64::max);
    (radius2 - at.xy().norm_squared()).max(0.0).sqrt().min(-lowest)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_are_those_of_a_map() {
        assert!((heading(90.0) - Vec3::x()).norm() < 1e-15);
        assert!((downhill([0.0, -2.0]) - Vec3::y()).norm() < 1e-15);
    }
}
