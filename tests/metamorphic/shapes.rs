//! Random shapes and turns.

use crate::generator::Wanted;
use crate::random::{Random, few_digits};

/// Cells of a box along its edges.
pub fn cells(random: &mut Random, wanted: &Wanted) -> [u32; 3] {
    let most = if wanted.large { 7 } else { 2 };
    [0; 3].map(|_| if wanted.large { random.whole(5, most) } else { random.whole(1, most) })
}

/// A box.
pub fn boxed(random: &mut Random, wanted: &Wanted, size_m: [f64; 3], cells: [u32; 3]) -> String {
    let pattern = if wanted.symmetric || random.happens(0.2) { "TwentyFour" } else { "Six" };
    format!(
        "Box(size_m: ({}, {}, {}), cells: ({}, {}, {}), pattern: {pattern})",
        size_m[0], size_m[1], size_m[2], cells[0], cells[1], cells[2]
    )
}

/// Any shape of about a size [m].
pub fn any(random: &mut Random, wanted: &Wanted, size_m: f64) -> String {
    let mut length = |low, high| few_digits(size_m * random.between(low, high));
    let (a, b, c) = (length(0.5, 1.5), length(0.5, 1.5), length(0.5, 1.5));
    let kinds = if wanted.symmetric || wanted.large { 0 } else { 6 };
    match random.whole(0, kinds) {
        0..3 => {
            let cells = cells(random, wanted);
            boxed(random, wanted, [a, b, c], cells)
        }
        3 => format!(
            "Prism(outline_m: ((0, 0), ({a}, 0), ({}, {b})), height_m: {c}, cells: ({}, 1))",
            random.between(0.0, 1.0) * a,
            random.whole(1, 2)
        ),
        4 => format!("Cylinder(radius_m: {}, height_m: {b}, cells: (1, {}))", 0.5 * a, random.whole(1, 2)),
        5 => format!("Sphere(radius_m: {}, levels: {})", 0.5 * a, random.whole(0, 1)),
        _ => format!(
            "Polyhedron(corners_m: [(0, 0, 0), ({a}, 0, 0), (0, {b}, 0), (0, 0, {c})], \
             faces: [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]], fill: Centre)"
        ),
    }
}

/// No turn, or one about any axis.
pub fn turn(random: &mut Random) -> String {
    if random.happens(0.25) {
        return String::new();
    }
    let [x, y, z] = random.vector(1.0);
    format!("(axis: ({x}, {y}, {z}), angle_deg: {})", random.between(5.0, 180.0))
}
