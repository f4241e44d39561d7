//! Points of a plane: turns, convex hulls, and what two convex polygons share.

/// Twice the area of a triangle, positive where its corners are counter-clockwise.
#[inline]
pub fn turn(a: &[f64; 2], b: &[f64; 2], c: &[f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// The convex hull, counter-clockwise, of points in the order of their first coordinates, and of their second ones where these are equal
/// (Andrew 1979); a corner that turns by no more than `straight` is left out. `at` is where a point is.
pub fn hull_of_sorted<T: Copy>(points: &[T], at: impl Fn(&T) -> [f64; 2], straight: f64) -> Vec<T> {
    let chain = |points: &mut dyn Iterator<Item = &T>| {
        let mut chain: Vec<T> = Vec::new();
        for point in points {
            while let [.., before, last] = &chain[..] {
                if turn(&at(before), &at(last), &at(point)) > straight {
                    break;
                }
                chain.pop();
            }
            chain.push(*point);
        }
        chain.pop();
        chain
    };
    let mut hull = chain(&mut points.iter());
    hull.extend(chain(&mut points.iter().rev()));
    hull
}

/// The part of a polygon within a convex, counter-clockwise one (Sutherland & Hodgman 1974).
pub fn clipped(mut polygon: Vec<[f64; 2]>, outline: &[[f64; 2]]) -> Vec<[f64; 2]> {
    for (i, a) in outline.iter().enumerate() {
        let b = &outline[(i + 1) % outline.len()];
        let mut kept = Vec::with_capacity(polygon.len() + 1);
        for (j, p) in polygon.iter().enumerate() {
            let q = &polygon[(j + 1) % polygon.len()];
            let (at_p, at_q) = (turn(a, b, p), turn(a, b, q));
            if at_p >= 0.0 {
                kept.push(*p);
            }
            if at_p * at_q < 0.0 {
                let t = at_p / (at_p - at_q);
                kept.push([p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1])]);
            }
        }
        polygon = kept;
    }
    polygon
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hull_leaves_out_what_is_inside_or_on_an_edge() {
        let points = [[0.0, 0.0], [0.0, 1.0], [0.5, 0.0], [0.5, 0.5], [1.0, 0.0], [1.0, 1.0]];
        let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        assert_eq!(hull_of_sorted(&points, |x| *x, 0.0), square);
        assert_eq!(hull_of_sorted(&[[0.0, 0.0], [1.0, 1.0]], |x| *x, 0.0).len(), 2);
    }

    #[test]
    fn a_polygon_is_cut_along_the_edges_of_the_other() {
        let square = |x: f64| vec![[x, x], [x + 1.0, x], [x + 1.0, x + 1.0], [x, x + 1.0]];
        assert_eq!(clipped(square(0.5), &square(0.0)), [[0.5, 0.5], [1.0, 0.5], [1.0, 1.0], [0.5, 1.0]]);
        assert!(clipped(square(2.0), &square(0.0)).is_empty());
    }
}
