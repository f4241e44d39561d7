//! The grammar of scenes, from its types and their documentation: as a JSON Schema and in words.

mod reference;

use serde_json::{Value, json};

use crate::scene::Scene;
use crate::scene::units::dimension_of;

pub use reference::reference;

/// The JSON Schema of a scene. RON's structs are its objects, choices with fields are objects of one key, vectors are arrays; a
/// field that takes units names them under `units`.
pub fn schema() -> Value {
    let mut schema = schemars::schema_for!(Scene).to_value();
    name_units(&mut schema);
    schema
}

/// Adds the units that each field may be written in.
fn name_units(schema: &mut Value) {
    match schema {
        Value::Array(items) => items.iter_mut().for_each(name_units),
        Value::Object(object) => {
            object.values_mut().for_each(name_units);
            let Some(Value::Object(properties)) = object.get_mut("properties") else { return };
            for (field, property) in properties {
                if let (Some(dimension), Value::Object(property)) = (dimension_of(field), property) {
                    property.insert("units".into(), json!(dimension.unit_names()));
                }
            }
        }
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_name_their_units_and_what_is_required() {
        let schema = schema();
        assert_eq!(schema["title"], "Scene");
        let material = &schema["$defs"]["Material"];
        let units = material["properties"]["young_pa"]["units"].as_array().unwrap();
        assert!(units.contains(&json!("Gigapascal")));
        assert_eq!(material["properties"]["poisson"]["units"], Value::Null);
        assert!(material["required"].as_array().unwrap().contains(&json!("density_kg_m3")));
        assert_eq!(material["additionalProperties"], json!(false));
    }

    #[test]
    fn every_field_and_choice_has_a_meaning() {
        let schema = schema();
        let types = schema["$defs"].as_object().unwrap();
        for (name, definition) in types.iter().map(|(n, d)| (n.as_str(), d)).chain([("Scene", &schema)]) {
            let fields = definition["properties"].as_object().into_iter().flatten();
            for (field, property) in fields {
                assert!(property["description"].is_string(), "{name}.{field}");
            }
            for choice in definition["oneOf"].as_array().into_iter().flatten() {
                assert!(choice["description"].is_string(), "{name}: {choice}");
            }
        }
    }
}
