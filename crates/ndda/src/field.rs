//! Quantities that blocks can be coloured by: every array of a frame that is a number or a vector, and von Mises stress.

use ndda_fem::stress::von_mises_pa;
use ndda_io::results::{Array, FieldFrame};

use crate::numbers::split_unit;
use crate::run::fields::PRESENT;
use crate::surface::{BLOCK_ID, Surface};

/// Arrays that the page shows otherwise: displacement is known from where blocks are.
const SHOWN_OTHERWISE: [&str; 3] = [BLOCK_ID, PRESENT, "displacement_m"];

/// Entities that a field has one value for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// A node of the surface.
    Node,
    /// A triangle of it.
    Triangle,
}

/// How a number is made of an entry.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Measure {
    Value,
    Length,
    VonMises,
}

/// A field to colour by.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// Name of the array in the frames.
    pub array: String,
    /// Name for people.
    pub label: String,
    /// Unit; empty where it has none.
    pub unit: &'static str,
    /// Entities that it has values for.
    pub place: Place,
    measure: Measure,
}

/// The fields that a frame has.
pub fn fields(frame: &FieldFrame) -> Vec<Field> {
    let has_von_mises = frame.cell_data.contains_key("von_mises_pa");
    let points = frame.point_data.iter().map(|(name, array)| (name, array, Place::Node));
    let cells = frame.cell_data.iter().map(|(name, array)| (name, array, Place::Triangle));
    let wanted = points.chain(cells).filter(|(name, ..)| !SHOWN_OTHERWISE.contains(&name.as_str()));
    wanted
        .filter_map(|(name, array, place)| {
            let measure = match array.components {
                1 => Measure::Value,
                3 => Measure::Length,
                6 if name == "stress_pa" && !has_von_mises => Measure::VonMises,
                _ => return None,
            };
            let (label, unit) = label(name, measure);
            Some(Field { array: name.clone(), label, unit, place, measure })
        })
        .collect()
}

/// A name for people, and the unit: `contact_force_n` is contact force in N.
fn label(name: &str, measure: Measure) -> (String, &'static str) {
    let (words, unit) = split_unit(name);
    match (words, measure) {
        ("velocity", Measure::Length) => ("speed".into(), unit),
        (_, Measure::VonMises) | ("von_mises", _) => ("von Mises stress".into(), unit),
        _ => (words.replace('_', " "), unit),
    }
}

impl Field {
    /// The array of a frame, if it has one.
    pub fn array_of<'a>(&self, frame: &'a FieldFrame) -> Option<&'a Array> {
        match self.place {
            Place::Node => frame.point_data.get(&self.array),
            Place::Triangle => frame.cell_data.get(&self.array),
        }
    }

    /// One value per node or triangle of the surface, of an array as long as the frame.
    pub fn values(&self, array: &Array, surface: &Surface) -> Vec<f32> {
        let entries = match self.place {
            Place::Node => &surface.nodes,
            Place::Triangle => &surface.tets,
        };
        let entry = |&i: &u32| &array.values[i as usize * array.components..][..array.components];
        entries.iter().map(|i| self.value(entry(i)) as f32).collect()
    }

    fn value(&self, entry: &[f64]) -> f64 {
        match (self.measure, entry) {
            (Measure::Length, components) => components.iter().map(|c| c * c).sum::<f64>().sqrt(),
            (Measure::VonMises, &[xx, yy, zz, xy, yz, zx]) => von_mises_pa(&[xx, yy, zz, xy, yz, zx]),
            (_, components) => components.first().copied().unwrap_or(0.0),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame(arrays: [(&str, usize); 5]) -> FieldFrame {
        let array = |components| Array { components, values: vec![1.0; 2 * components] };
        let mut frame = FieldFrame::default();
        for (name, components) in arrays {
            let data = if name.starts_with("cell_") || name == "stress_pa" {
                &mut frame.cell_data
            } else {
                &mut frame.point_data
            };
            data.insert(name.into(), array(components));
        }
        frame
    }

    #[test]
    fn every_number_and_vector_is_a_choice_and_named_for_people() {
        let frame = frame([
            ("velocity_m_s", 3),
            ("displacement_m", 3),
            ("acceleration_m_s2", 3),
            ("stress_pa", 6),
            ("cell_tensor", 9),
        ]);
        let found: Vec<_> = fields(&frame).into_iter().map(|f| (f.label, f.unit)).collect();
        let expected = [("acceleration", "m/s²"), ("speed", "m/s"), ("von Mises stress", "Pa")];
        assert_eq!(found, expected.map(|(label, unit)| (label.to_string(), unit)));
    }

    #[test]
    fn vectors_count_by_their_length_and_cells_by_the_triangles_before_them() {
        let mut frame = frame([
            ("velocity_m_s", 3),
            ("cell_damage", 1),
            ("stress_pa", 6),
            ("displacement_m", 3),
            ("cell_x", 1),
        ]);
        frame.cell_data.get_mut("cell_damage").unwrap().values = vec![0.5, 0.25];
        frame.point_data.get_mut("velocity_m_s").unwrap().values = vec![0.0, 3.0, -4.0, 1.0, 0.0, 0.0];
        let surface = Surface { nodes: vec![1, 0], tets: vec![1, 1, 0], ..Surface::default() };
        let of = |label: &str| {
            let field = fields(&frame).into_iter().find(|f| f.label == label).unwrap();
            field.values(field.array_of(&frame).unwrap(), &surface)
        };
        assert_eq!(of("speed"), [1.0, 5.0]);
        assert_eq!(of("cell damage"), [0.25, 0.25, 0.5]);
        // Six ones: no differences of normal stresses, √(3 · 3) from shear.
        assert_eq!(of("von Mises stress"), [3.0; 3]);
    }
}
