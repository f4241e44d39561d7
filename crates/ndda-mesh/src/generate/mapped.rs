//! Boxes bent into other shapes: hexahedra by eight corners, voussoirs of an arch.

use super::{BoxPattern, GenerateError, box_block, check_length};
use crate::cut::plane::sin_cos;
use crate::geometry::tet_volume;
use crate::{BlockMesh, Vec3};

/// A hexahedron by its corners, four below counter-clockwise seen from above, then the four above them.
///
/// Cells follow the trilinear map of a unit box whose x runs from corner 0 to 1, y from 0 to 3, z from 0 to 4.
/// Node sets: `x_min x_max y_min y_max z_min z_max`, as of that box. Sides that are not flat become facets.
///
/// # Errors
/// [`GenerateError`] when a corner is not finite, the shape folds or is inside out, or the cells are none or too many.
pub fn hexahedron(
    corners_m: [Vec3; 8],
    cells: [u32; 3],
    pattern: BoxPattern,
) -> Result<BlockMesh, GenerateError> {
    for (corner, at) in corners_m.iter().enumerate() {
        if !at.iter().all(|x| x.abs() <= *super::LENGTHS_M.end()) {
            return Err(GenerateError::Place { corner, at_m: (*at).into() });
        }
    }
    mapped(cells, pattern, |x| {
        let weights = [x.x, x.y, x.z].map(|t| [1.0 - t, t]);
        let mut at = Vec3::zeros();
        for (corner, place) in corners_m.iter().enumerate() {
            // Corners 2 and 3 lie at y = 1, but 1 and 2 at x = 1.
            let (i, j, k) = (usize::from(matches!(corner % 4, 1 | 2)), corner % 4 / 2, corner / 4);
            at += place * (weights[0][i] * weights[1][j] * weights[2][k]);
        }
        at
    })
}

/// A stone of a circular arch about the y axis: a segment of a ring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Voussoir {
    /// Radius of the intrados, the lower side [m].
    pub inner_radius_m: f64,
    /// Radius of the extrados [m].
    pub outer_radius_m: f64,
    /// Angle of the first joint from x towards z [°].
    pub start_deg: f64,
    /// Angle of the second joint, less than 360° later [°].
    pub end_deg: f64,
    /// Extent along y, from 0 [m].
    pub width_m: f64,
}

/// Meshes a [`Voussoir`] with `cells` along the radius, the width and the arc; curved sides become facets.
///
/// Node sets: `intrados extrados front back start end`. Stones that share an angle share the plane of their joint.
///
/// # Errors
/// [`GenerateError`] when a length or angle is out of range, or the cells are none, too coarse for the arc or too many.
pub fn voussoir(stone: &Voussoir, cells: [u32; 3], pattern: BoxPattern) -> Result<BlockMesh, GenerateError> {
    check_length("inner radius", stone.inner_radius_m)?;
    check_length("outer radius", stone.outer_radius_m)?;
    check_length("width", stone.width_m)?;
    check_length("outer less inner radius", stone.outer_radius_m - stone.inner_radius_m)?;
    let opening_deg = stone.end_deg - stone.start_deg;
    for (what, value_deg, least, most) in [
        ("start of the arc", stone.start_deg, -360.0, 360.0),
        ("opening of the arc", opening_deg, 1e-3, 359.999),
    ] {
        if !(least..=most).contains(&value_deg) {
            return Err(GenerateError::Angle { what, value_deg, least, most });
        }
    }
    let between = |a: f64, b: f64, t: f64| if t == 1.0 { b } else { a + (b - a) * t };
    let mut mesh = mapped(cells, pattern, |x| {
        let radius_m = between(stone.inner_radius_m, stone.outer_radius_m, x.x);
        let (sin, cos) = sin_cos(between(stone.start_deg, stone.end_deg, x.z));
        Vec3::new(radius_m * cos, stone.width_m * x.y, radius_m * sin)
    })?;
    let names = [
        ("x_min", "intrados"),
        ("x_max", "extrados"),
        ("y_min", "front"),
        ("y_max", "back"),
        ("z_min", "start"),
        ("z_max", "end"),
    ];
    for (old, new) in names {
        if let Some(set) = mesh.node_sets.remove(old) {
            mesh.node_sets.insert(new.into(), set);
        }
    }
    Ok(mesh)
}

/// A unit box with its nodes moved by `map`, if no tetrahedron folds.
fn mapped(
    cells: [u32; 3],
    pattern: BoxPattern,
    map: impl Fn(&Vec3) -> Vec3,
) -> Result<BlockMesh, GenerateError> {
    let mut mesh = box_block([1.0; 3], cells, pattern)?;
    mesh.nodes.iter_mut().for_each(|x| *x = map(x));
    for (tet, nodes) in mesh.tets.iter().enumerate() {
        let volume_m3 = tet_volume(&nodes.map(|n| mesh.nodes[n as usize]));
        if volume_m3.is_nan() || volume_m3 <= 0.0 {
            return Err(GenerateError::Folded { tet, volume_m3 });
        }
    }
    Ok(mesh)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::testing::{check_closed_conforming, volume};
    use super::*;

    fn unit_corners() -> [Vec3; 8] {
        let ring = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        std::array::from_fn(|i| Vec3::new(ring[i % 4][0], ring[i % 4][1], (i / 4) as f64))
    }

    fn stone() -> Voussoir {
        let (inner_radius_m, outer_radius_m, width_m) = (5.0, 6.0, 2.0);
        Voussoir { inner_radius_m, outer_radius_m, start_deg: 90.0, end_deg: 105.0, width_m }
    }

    #[test]
    fn a_hexahedron_of_a_unit_box_is_that_box() {
        for pattern in [BoxPattern::Six, BoxPattern::TwentyFour] {
            // Halves and quarters are exact.
            let mesh = hexahedron(unit_corners(), [2, 1, 4], pattern).unwrap();
            assert_eq!(mesh, box_block([1.0; 3], [2, 1, 4], pattern).unwrap());
        }
    }

    #[test]
    fn a_voussoir_tends_to_the_volume_of_its_segment() {
        let exact = 15f64.to_radians() / 2.0 * 11.0 * 2.0;
        let mesh = voussoir(&stone(), [2, 2, 40], BoxPattern::TwentyFour).unwrap();
        check_closed_conforming(&mesh);
        assert_eq!(crate::validate::problems(&mesh), vec![]);
        assert!((volume(&mesh) / exact - 1.0).abs() < 1e-4);
        assert!(mesh.node_sets["start"].iter().all(|&n| mesh.nodes[n as usize].x == 0.0));
        assert_eq!(mesh.node_sets.len(), 6);
    }

    #[test]
    fn folded_and_extreme_shapes_are_named() {
        let mut swapped = unit_corners();
        swapped.swap(0, 1);
        let fold = |corners| hexahedron(corners, [1; 3], BoxPattern::Six);
        assert!(matches!(fold(swapped), Err(GenerateError::Folded { .. })));
        let mut lost = unit_corners();
        lost[3].x = f64::NAN;
        assert!(matches!(fold(lost), Err(GenerateError::Place { corner: 3, .. })));
        let bad = |change: fn(&mut Voussoir)| {
            let mut stone = stone();
            change(&mut stone);
            voussoir(&stone, [1; 3], BoxPattern::Six).unwrap_err()
        };
        assert!(matches!(bad(|s| s.inner_radius_m = 7.0), GenerateError::Length { .. }));
        assert!(matches!(bad(|s| s.end_deg = 90.0), GenerateError::Angle { .. }));
        assert!(matches!(bad(|s| s.start_deg = f64::NAN), GenerateError::Angle { .. }));
        assert!(matches!(bad(|s| s.end_deg = 400.0), GenerateError::Folded { .. }));
    }

    proptest! {
        #[test]
        fn no_corners_panic(
            corners in prop::array::uniform8(prop::array::uniform3(prop_oneof![-2.0..2.0f64, any::<f64>()])),
        ) {
            let _ = hexahedron(corners.map(Vec3::from), [2; 3], BoxPattern::TwentyFour);
        }
    }
}
