//! Integrals over a polyhedron: volume, moment, linear functions, the smallest of several, and any function.

use ndda_mesh::Vec3;

use crate::integration::capacity::MOST_CUTS;
use crate::integration::linear::Linear;
use crate::integration::polyhedron::{MOST_CORNERS, Polyhedron};
use crate::integration::quadrature::Quadrature;

impl Polyhedron {
    /// Volume [m³] and ∫ x dV [m⁴], from a fan of triangles over each face and a corner of the polyhedron.
    ///
    /// Not numbers if the polyhedron outgrew its room.
    pub fn volume_and_moment(&self) -> (f64, Vec3) {
        if self.outgrown {
            return (f64::NAN, Vec3::repeat(f64::NAN));
        }
        if self.len == 0 {
            return (0.0, Vec3::zeros());
        }
        let base = self.position[0];
        let (mut six_volumes, mut moment) = (0.0, Vec3::zeros());
        self.for_each_triangle(|corners| {
            let [a, b, c] = corners.map(|x| x - base);
            let six = a.dot(&b.cross(&c));
            six_volumes += six;
            moment += six * (a + b + c);
        });
        let volume = six_volumes / 6.0;
        (volume, moment / 24.0 + volume * base)
    }

    fn for_each_triangle(&self, mut triangle: impl FnMut([Vec3; 3])) {
        // A bit for each of the three ways from a corner.
        let mut seen = [0u8; MOST_CORNERS];
        for start in 0..self.len {
            for first in 0..3 {
                if seen[start] >> first & 1 == 1 {
                    continue;
                }
                seen[start] |= 1 << first;
                let (mut here, mut next) = (start, self.neighbours[start][first] as usize);
                loop {
                    let turned = self.turn(next, here);
                    let k = self.neighbours[next].iter().position(|&n| n as usize == turned).unwrap_or(0);
                    (here, next) = (next, turned);
                    seen[here] |= 1 << k;
                    if next == start {
                        break;
                    }
                    triangle([self.position[start], self.position[next], self.position[here]]);
                }
            }
        }
    }

    /// ∫ f dV [m³ of f's unit].
    pub(crate) fn integral(&self, f: &Linear) -> f64 {
        let (volume, moment) = self.volume_and_moment();
        f.value * volume + f.gradient.dot(&moment)
    }

    /// ∫ min f dV over linear functions: each over the part where it is the smallest, for which `part` is room.
    pub(crate) fn integral_of_smallest(&self, functions: &[Linear], part: &mut Self) -> f64 {
        self.sum_where_smallest(functions, part, |k, part| part.integral(&functions[k]))
    }

    /// ∫ f dV of any function by quadrature: over the tetrahedra of the surface's triangles and a corner.
    pub(crate) fn integral_of(&self, rule: &Quadrature, f: &impl Fn(&Vec3) -> f64) -> f64 {
        if self.outgrown {
            return f64::NAN;
        }
        if self.len == 0 {
            return 0.0;
        }
        let (base, mut sum) = (self.position[0], 0.0);
        self.for_each_triangle(|[x, y, z]| {
            let [a, b, c] = [x - base, y - base, z - base];
            let volume_m3 = a.dot(&b.cross(&c)) / 6.0;
            let at = |l: &[f64; 4]| base + l[1] * a + l[2] * b + l[3] * c;
            sum += volume_m3 * rule.tetrahedron().iter().map(|(l, w)| w * f(&at(l))).sum::<f64>();
        });
        sum
    }

    /// The sum of what each of the functions has over the part where it is the smallest, for which `part` is room.
    pub(crate) fn sum_where_smallest(
        &self,
        functions: &[Linear],
        part: &mut Self,
        over: impl Fn(usize, &Self) -> f64,
    ) -> f64 {
        // A function that exceeds another's largest value everywhere is nowhere the smallest.
        let mut least = [0.0; MOST_CUTS];
        let mut enough = f64::INFINITY;
        for (least, f) in least.iter_mut().zip(functions) {
            let range = self.range_of(f);
            *least = range.0;
            enough = enough.min(range.1);
        }
        // One that is not a number has no range, and counts.
        let counts = |k: &usize| least[*k] <= enough || !least[*k].is_finite();
        let over_part = |k: usize| {
            let f = &functions[k];
            let mut rivals = (0..functions.len()).filter(|j| *j != k).filter(counts).peekable();
            if rivals.peek().is_none() {
                return over(k, self);
            }
            part.set(self);
            for rival in rivals {
                if part.is_empty() {
                    return 0.0;
                }
                part.cut(&functions[rival].minus(f));
            }
            over(k, part)
        };
        (0..functions.len()).filter(counts).map(over_part).sum()
    }
}
