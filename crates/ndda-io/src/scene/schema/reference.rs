//! `docs/reference/scene.md` from the schema.

use std::fmt::Write;

use serde_json::{Map, Value};

use super::schema;
use crate::scene::units::DIMENSIONS;

/// The reference of the scene file, in Markdown.
pub fn reference() -> String {
    let schema = schema();
    let mut writer = Writer { schema: &schema, told: Vec::new(), out: include_str!("intro.md").to_string() };
    writer.section("Scene", &schema);
    writer.units();
    writer.out.push_str(include_str!("outro.md"));
    writer.out
}

struct Writer<'a> {
    schema: &'a Value,
    told: Vec<String>,
    out: String,
}

impl Writer<'_> {
    /// A type, and then those that it refers to.
    fn section(&mut self, name: &str, definition: &Value) {
        self.told.push(name.into());
        let meaning = definition["description"].as_str().unwrap_or_default();
        self.line(&format!("## {name}\n\n{meaning}\n"));
        if let Some(choices) = definition["oneOf"].as_array() {
            self.line("| choice | value | meaning |\n|---|---|---|");
            choices.iter().for_each(|choice| self.choice(choice));
        } else if let Some(fields) = definition["properties"].as_object() {
            self.line("| field | value | meaning |\n|---|---|---|");
            fields.iter().for_each(|(field, property)| self.field("", field, property));
        }
        self.line("");
        let mut names = Vec::new();
        referred(definition, &mut names);
        for name in names {
            if !self.told.contains(&name) {
                self.section(&name, &self.schema["$defs"][&name]);
            }
        }
    }

    /// One choice, and its fields below it.
    fn choice(&mut self, choice: &Value) {
        let meaning = meaning(choice);
        let Some((name, inside)) = choice["properties"].as_object().and_then(|p| p.iter().next()) else {
            let name = choice["const"].as_str().unwrap_or_default();
            return self.line(&format!("| `{name}` |  | {meaning} |"));
        };
        match inside["properties"].as_object() {
            None => self.line(&format!("| `{name}({})` |  | {meaning} |", value(inside, false))),
            Some(fields) => {
                self.line(&format!("| `{name}(…)` |  | {meaning} |"));
                fields.iter().for_each(|(field, property)| self.field("&nbsp;&nbsp;", field, property));
            }
        }
    }

    fn field(&mut self, indent: &str, field: &str, property: &Value) {
        self.line(&format!("| {indent}`{field}` | {} | {} |", value(property, true), meaning(property)));
    }

    fn units(&mut self) {
        self.line(
            "## Units\n\nA number is in the unit that ends the field's name. It may also be written in another one, which is then named: \
             `young_pa: Gigapascal(20)`,\n`friction_deg: Radians(0.6)`, `size_m: Millimetre(200, 200, 60)`, \
             `at_m: (Metre(1), 0, Centimetre(5))`, `stress_pa: Megapascal((xx: -5, zz: -8))`,\n`at: Point(Millimetre(0, 0, 5))`. \
             Powers of ten give the very bits of the number in the field's own unit.\n\n| fields | units |\n|---|---|",
        );
        for dimension in &DIMENSIONS {
            let names: Vec<String> = dimension.unit_names().iter().map(|name| format!("`{name}`")).collect();
            self.line(&format!("| `…{}`, {} | {} |", dimension.suffix, dimension.name, names.join(", ")));
        }
        self.line("");
    }

    fn line(&mut self, text: &str) {
        writeln!(self.out, "{text}").expect("a string takes all");
    }
}

/// Meaning of a field or choice, in one line of a table.
fn meaning(schema: &Value) -> String {
    schema["description"].as_str().unwrap_or_default().replace('\n', " ").replace('|', "\\|")
}

/// Names of the types that a schema refers to, in order.
fn referred(schema: &Value, names: &mut Vec<String>) {
    match schema {
        Value::Array(items) => items.iter().for_each(|item| referred(item, names)),
        Value::Object(object) => {
            names.extend(target(object));
            let inside = object.iter().filter(|(key, _)| *key != "$defs");
            inside.for_each(|(_, value)| referred(value, names));
        }
        _ => {}
    }
}

fn target(object: &Map<String, Value>) -> Option<String> {
    let path = object.get("$ref")?.as_str()?;
    path.rsplit('/').next().map(String::from)
}

/// How a value is written; names of types are links where they can be.
fn value(schema: &Value, links: bool) -> String {
    if let Some(name) = schema.as_object().and_then(target) {
        return if links { format!("[{name}](#{})", name.to_lowercase()) } else { name };
    }
    if let Some(options) = schema["anyOf"].as_array() {
        return options.first().map_or_else(String::new, |option| value(option, links));
    }
    match kind(schema) {
        "string" => "\"text\"".into(),
        "integer" => "whole number".into(),
        "array" => list(schema, links),
        "object" => format!("(name: {}, …)", value(&schema["additionalProperties"], links)),
        other => other.into(),
    }
}

/// Its type; `null`, which an optional value may be, is not said.
fn kind(schema: &Value) -> &str {
    let first = schema["type"].as_array().and_then(|kinds| kinds.first());
    first.unwrap_or(&schema["type"]).as_str().unwrap_or_default()
}

/// A vector in round brackets, a list in square ones.
fn list(schema: &Value, links: bool) -> String {
    if let Some(items) = schema["prefixItems"].as_array() {
        let items: Vec<String> = items.iter().map(|item| value(item, links)).collect();
        return format!("({})", items.join(", "));
    }
    let item = match kind(&schema["items"]) {
        "integer" => "n".into(),
        _ => value(&schema["items"], links),
    };
    let length = schema["minItems"].as_u64().filter(|length| Some(*length) == schema["maxItems"].as_u64());
    match (length, item.as_str()) {
        (None, item) => format!("[{item}, …]"),
        (Some(2), "number") => "(x, y)".into(),
        (Some(3), "number") => "(x, y, z)".into(),
        (Some(length @ ..=3), item) => format!("({})", vec![item; length as usize].join(", ")),
        (Some(length), item) => format!("({item}, … {length} times)"),
    }
}
