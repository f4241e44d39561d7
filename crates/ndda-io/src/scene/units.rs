//! Values with a unit: `Megapascal(20)` in a field `…_pa` is 20e6.
//!
//! The unit of a field is the end of its name. A value in another unit of the same dimension is turned into it in the text,
//! before types are read, expressions into their values, and former names of fields into current ones; what is found wrong later
//! is mapped back to the text as it was written.

mod dimensions;
mod symbols;

use std::ops::Range;

use crate::scene::code::Code;
use crate::scene::diagnostic::Diagnostic;
use crate::scene::locate::Node;
use crate::scene::parameters::{self, Parameters, number};
use crate::scene::suggest::nearest;

pub(crate) use dimensions::{DIMENSIONS, Dimension, Unit, dimension_of};
pub(crate) use symbols::{NOT_BEHIND, advice, may_be_unit};

/// A choice whose value is a place [m], though its name does not end in it.
const PLACE: &str = "Point";
/// Field of a scene, or of a file of materials, that names files.
pub(crate) const INCLUDE: &str = "include";
/// Numbers that scatter, whose parameters are in the unit of the field.
const SCATTER: [&str; 5] = ["Always", "Normal", "LogNormal", "Uniform", "Triangular"];
/// An expression: `Calc(90 - dip_deg)`.
const CALC: &str = "Calc";

/// A text in which every value is in the unit of its field.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Resolved {
    /// The text.
    pub text: String,
    /// Errors of units.
    pub errors: Vec<Diagnostic>,
    /// Bytes of the source in whose place stands a value that is only supposed.
    pub supposed: Vec<Range<usize>>,
    edits: Vec<Edit>,
}

/// Bytes of the source, and what stands in their place.
#[derive(Clone, Debug, PartialEq)]
struct Edit {
    at: Range<usize>,
    with: String,
}

/// Turns every value of a text into a number in the unit of its field.
pub(crate) fn resolve(text: &str, tree: &Node, parameters: &Parameters) -> Resolved {
    let mut resolver = Resolver::new(text, tree, parameters);
    resolver.visit_fields();
    let Resolver { edits, errors, supposed, .. } = resolver;
    Resolved { text: edited(text, &edits, 0..text.len()), errors, supposed, edits }
}

/// One value in the unit of its field, and whether it follows from one that is only supposed.
///
/// # Errors
/// Errors of its units and expressions.
pub(crate) fn resolve_value(
    text: &str,
    tree: &Node,
    node: &Node,
    parameters: &Parameters,
) -> Result<(String, bool), Vec<Diagnostic>> {
    let mut resolver = Resolver::new(text, tree, parameters);
    resolver.visit(node, None);
    match resolver.errors.is_empty() {
        true => {
            let value = edited(text, &resolver.edits, node.span.clone());
            Ok((value, !resolver.supposed.is_empty()))
        }
        false => Err(resolver.errors),
    }
}

/// Part of a text with edits in it.
fn edited(text: &str, edits: &[Edit], part: Range<usize>) -> String {
    let mut out = String::with_capacity(part.len());
    let mut from = part.start;
    for edit in edits {
        out.push_str(&text[from..edit.at.start]);
        out.push_str(&edit.with);
        from = edit.at.end;
    }
    out.push_str(&text[from..part.end]);
    out
}

impl Resolved {
    /// A text as it is written.
    pub(crate) fn unchanged(text: &str) -> Self {
        Self { text: text.to_string(), ..Self::default() }
    }

    /// Byte of the source that a byte of the text comes from.
    pub(crate) fn source(&self, offset: usize) -> usize {
        let (mut in_source, mut in_text) = (0, 0);
        for edit in &self.edits {
            let begins = in_text + (edit.at.start - in_source);
            if offset < begins {
                break;
            }
            if offset < begins + edit.with.len() {
                return edit.at.start;
            }
            (in_source, in_text) = (edit.at.end, begins + edit.with.len());
        }
        in_source + (offset - in_text)
    }
}

struct Resolver<'a> {
    text: &'a str,
    tree: &'a Node,
    parameters: &'a Parameters,
    edits: Vec<Edit>,
    errors: Vec<Diagnostic>,
    supposed: Vec<Range<usize>>,
}

impl<'a> Resolver<'a> {
    fn new(text: &'a str, tree: &'a Node, parameters: &'a Parameters) -> Self {
        Self { text, tree, parameters, edits: Vec::new(), errors: Vec::new(), supposed: Vec::new() }
    }

    /// Looks through the fields of a scene or of an included file.
    fn visit_fields(&mut self) {
        let tree = self.tree;
        let is = |child: &Node, field: &str| child.key.as_deref() == Some(field);
        let has_materials = tree.children.iter().any(|child| is(child, "materials"));
        for child in &tree.children {
            if is(child, parameters::FIELD) {
                self.edit(child.span.clone(), self.parameters.as_map());
            } else if is(child, INCLUDE) {
                if !has_materials {
                    self.edit(child.key_span.start..child.key_span.start, "materials: [], ".into());
                }
                // One file may stand without the brackets of a list.
                let alone = child.opening.is_none();
                let mut bracket =
                    |at: usize, with: &str| self.edit(at..at, if alone { with } else { "" }.into());
                bracket(child.span.start, "[");
                bracket(child.span.end, "]");
            } else {
                self.visit(child, None);
            }
        }
    }

    /// Looks for units in a value; items and components of a quantity are of its dimension.
    fn visit(&mut self, node: &Node, outer: Option<&'static Dimension>) {
        if let Some(key) = node.key.as_deref().filter(|key| **key != self.text[node.key_span.clone()]) {
            self.edit(node.key_span.clone(), key.to_string());
        }
        let own = node.key.as_deref().and_then(dimension_of).or(outer);
        let word = node.word(self.text);
        if word == CALC {
            let value = self.calculate(node);
            return self.edit(node.span.clone(), number(value));
        }
        if DIMENSIONS.iter().any(|d| d.unit(word).is_some()) {
            return self.convert(node, word, own);
        }
        let places = node.children.iter().all(|child| child.key.is_none());
        match own {
            Some(dimension) if !word.is_empty() && places && !SCATTER.contains(&word) => {
                let close = nearest(word, &dimension.unit_names());
                let help =
                    close.map_or_else(|| units_of(dimension), |name| format!("did you mean `{name}`?"));
                self.refuse(node, format!("`{word}` is not a unit of {}", dimension.name), help);
            }
            _ => {
                let inside = if word == PLACE { dimension_of("_m") } else { own };
                node.children.iter().for_each(|child| self.visit(child, inside));
            }
        }
    }

    fn convert(&mut self, node: &Node, word: &str, dimension: Option<&'static Dimension>) {
        let Some(dimension) = dimension else {
            return self.refuse(node, format!("`{word}` in a field without a unit"), "write a plain number");
        };
        let Some(unit) = dimension.unit(word) else {
            let message = format!("`{word}` is not a unit of {}", dimension.name);
            return self.refuse(node, message, units_of(dimension));
        };
        let (Some(first), Some(last)) = (node.children.first(), node.children.last()) else {
            return self.refuse(
                node,
                format!("`{word}` of nothing"),
                format!("write {word}(1), or any number"),
            );
        };
        // One value stands without the brackets; several keep them, as a vector does.
        let alone = node.children.len() == 1 && first.key.is_none();
        let bracket = node.span.start + word.len();
        let begins = if alone { first.span.start } else { bracket };
        self.edit(node.span.start..begins, String::new());
        node.children.iter().for_each(|child| self.convert_numbers(child, unit));
        if alone {
            self.edit(last.span.end..node.span.end, String::new());
        }
    }

    fn convert_numbers(&mut self, node: &Node, unit: &Unit) {
        let calculated = match node.word(self.text) {
            CALC => Some(number(self.calculate(node))),
            _ => None,
        };
        if node.opening.is_none() || calculated.is_some() {
            match unit.in_field(calculated.as_deref().unwrap_or(&self.text[node.span.clone()])) {
                Some(number) => self.edit(node.span.clone(), number),
                None => self.refuse(
                    node,
                    "is not a number that has a unit",
                    "write a plain number in the brackets",
                ),
            }
        } else if !node.word(self.text).is_empty() {
            let inner = node.word(self.text);
            if DIMENSIONS.iter().any(|d| d.unit(inner).is_some()) {
                self.refuse(node, "a unit inside a unit", "leave out one of the two");
            } else {
                self.refuse(
                    node,
                    format!("`{inner}` inside a unit"),
                    format!("write the unit inside of `{inner}`, around each number"),
                );
            }
        } else {
            node.children.iter().for_each(|child| self.convert_numbers(child, unit));
        }
    }

    /// Value of `Calc(…)`, whose brackets are part of the expression; 1 where it has none.
    fn calculate(&mut self, node: &Node) -> f64 {
        let value = self.parameters.calculate(self.text, self.tree, node, node.span.start + CALC.len());
        let is_supposed = self.parameters.take_supposed();
        if is_supposed || value.is_err() {
            self.supposed.push(node.span.clone());
        }
        value.unwrap_or_else(|refused| {
            // A mistake may follow from a value that is only supposed.
            self.errors.extend((!is_supposed).then_some(refused));
            1.0
        })
    }

    fn edit(&mut self, at: Range<usize>, with: String) {
        self.edits.push(Edit { at, with });
    }

    fn refuse(&mut self, node: &Node, message: impl Into<String>, help: impl Into<String>) {
        let path = self.tree.path_at(node.span.start);
        let found = Diagnostic::error(Code::Unit, path, message, Some(node.span.clone()));
        self.errors.push(found.with_help(help));
        self.supposed.push(node.span.clone());
        // Several values keep their brackets.
        let word = node.span.start..node.span.start + node.word(self.text).len();
        match node.children.len() {
            0 | 1 => self.edit(node.span.clone(), "1".into()),
            _ => self.edit(word, String::new()),
        }
    }
}

/// All units that would be allowed.
fn units_of(dimension: &Dimension) -> String {
    format!("{} is a plain number, or one in {}", dimension.name, dimension.unit_names().join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn resolved(text: &str) -> Resolved {
        resolve(text, &Node::of(text), &Parameters::default())
    }

    fn number(field: &str, value: &str) -> f64 {
        let text = format!("({field}: {value})");
        let resolved = resolved(&text);
        assert!(resolved.errors.is_empty(), "{text}: {:?}", resolved.errors);
        let inside = resolved.text.trim_start_matches('(').trim_end_matches(')');
        inside.split_once(": ").unwrap().1.trim().parse().unwrap_or_else(|_| panic!("{}", resolved.text))
    }

    #[test]
    fn powers_of_ten_have_the_bits_of_the_number_in_the_fields_unit() {
        assert_eq!(number("young_pa", "Gigapascal(20.7)"), 20.7e9);
        assert_eq!(number("cohesion_pa", "Kilopascal( 5 )"), 5e3);
        assert_eq!(number("step_s", "Millisecond(0.1)"), 1e-4);
        assert_eq!(number("radius_m", "Millimetre(-1_2.5e1,)"), -0.125);
        assert_eq!(number("density_kg_m3", "GramPerCubicCentimetre(2.65)"), 2650.0);
        assert_eq!(number("reference_m3", "CubicCentimetre(7)"), 7e-6);
    }

    #[test]
    fn other_units_are_converted_to_rounding() {
        let close = |field: &str, value: &str, expected: f64| {
            let found = number(field, value);
            assert!((found / expected - 1.0).abs() < 4e-16, "{field}: {value} is {found}, not {expected}");
        };
        close("friction_deg", "Radians(0.6)", 0.6f64.to_degrees());
        close("spin_rad_s", "RevolutionsPerMinute(30)", std::f64::consts::PI);
        close("velocity_m_s", "KilometrePerHour(36)", 10.0);
        close("gravity_m_s2", "StandardGravity(1)", 9.80665);
        close("end_s", "Minute(2)", 120.0);
    }

    #[test]
    fn vectors_and_tensors_take_units_as_a_whole_and_by_components() {
        for (source, plain) in [
            ("(size_m: Millimetre((1, 20, 300)))", "(size_m: (1e-3, 2e-2, 3e-1))"),
            ("(size_m: Millimetre(1, 20, 300))", "(size_m: (1e-3, 2e-2, 3e-1))"),
            ("(size_m: (Metre(1), 2, Centimetre(3)))", "(size_m: (1e0, 2, 3e-2))"),
            ("(stress_pa: (xx: Megapascal(-5), yy: 1))", "(stress_pa: (xx: -5e6, yy: 1))"),
            ("(stress_pa: Megapascal((xx: -5, yy: 1)))", "(stress_pa: (xx: -5e6, yy: 1e6))"),
            ("(at: Point(Millimetre(1, 2, 3)))", "(at: Point((1e-3, 2e-3, 3e-3)))"),
            ("(origin_m: Some(Metre(3)))", "(origin_m: Some(3e0))"),
            ("(diameter_m: Normal(Centimetre(80), 0.2))", "(diameter_m: Normal(8e-1, 0.2))"),
        ] {
            assert_eq!(resolved(source).errors, []);
            assert_eq!(resolved(source).text, plain);
        }
    }

    #[test]
    fn what_is_no_unit_of_a_field_is_refused_with_those_that_are() {
        for (source, path, word) in [
            ("(young_pa: Millimetre(3))", "young_pa", "Gigapascal"),
            ("(young_pa: Megapascals(3))", "young_pa", "did you mean `Megapascal`"),
            ("(poisson: Degrees(3))", "poisson", "plain number"),
            ("(a: [(young_pa: Pascal(Pascal(3)))])", "a[0].young_pa[0]", "one of the two"),
            ("(young_pa: Pascal())", "young_pa", "any number"),
            ("(young_pa: Pascal(x))", "young_pa[0]", "plain number"),
            ("(young_pa: Gigapascal(1e300))", "young_pa[0]", "plain number"),
        ] {
            let errors = resolved(source).errors;
            assert_eq!(errors.len(), 1, "{source}");
            assert_eq!(errors[0].path, path);
            assert!(errors[0].help.as_ref().unwrap().contains(word), "{source}: {errors:?}");
        }
    }

    #[test]
    fn places_in_the_text_map_back_to_the_source() {
        let source = "(young_pa: Gigapascal(20), size_m: Millimetre(1, 2), title: x)";
        let resolved = resolved(source);
        for word in ["young_pa", "size_m", "title", "x)"] {
            let offset = resolved.text.find(word).unwrap();
            assert_eq!(resolved.source(offset), source.find(word).unwrap(), "{word}");
        }
        assert_eq!(resolved.source(resolved.text.len()), source.len());
        assert_eq!(resolved.source(resolved.text.find("2e10").unwrap()), source.find("20").unwrap());
    }

    #[test]
    fn a_suffix_is_not_hidden_by_a_shorter_one() {
        for (i, dimension) in DIMENSIONS.iter().enumerate() {
            assert_eq!(dimension_of(dimension.suffix), Some(&DIMENSIONS[i]));
        }
    }
}
