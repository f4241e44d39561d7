//! Text to types: grammar, units, expressions and types, with every message at its place.

mod choices;
mod types;
mod words;

use std::ops::Range;
use std::path::{Path, PathBuf};

use serde::de::DeserializeOwned;

use crate::limited;
use crate::scene::code::Code;
use crate::scene::diagnostic::{Diagnostic, SceneErrors};
use crate::scene::locate::{self, Node};
use crate::scene::parameters::Parameters;
use crate::scene::units::{self, Resolved};
pub(crate) use types::Mistakes;
use types::Reader;

/// Name of standard input in messages.
const STANDARD_INPUT: &str = "standard input";

/// Whether a path names standard input: `-`.
pub fn is_standard_input(path: &Path) -> bool {
    path == Path::new("-")
}

/// Name of a file in messages.
pub(crate) fn label_of(path: &Path) -> String {
    if is_standard_input(path) { STANDARD_INPUT.into() } else { path.display().to_string() }
}

/// The text of a scene or study file, or of standard input for `-`.
///
/// # Errors
/// It cannot be read, or is no text.
pub fn text_of(path: &Path) -> Result<String, SceneErrors> {
    let file = label_of(path);
    let unreadable = |message: String, help: &str| SceneErrors {
        file: file.clone(),
        text: String::new(),
        diagnostics: vec![Diagnostic::error(Code::Unreadable, "", message, None).with_help(help)],
    };
    if path.is_dir() {
        return Err(unreadable("is a folder".into(), "name a scene file, such as scenes/sliding_45.ron"));
    }
    let read = if is_standard_input(path) { limited::standard_input() } else { limited::stream(path) };
    let with_ending = PathBuf::from(format!("{}.ron", path.display()));
    let help = match with_ending.is_file() {
        true => format!("did you mean {}?", with_ending.display()),
        false => "check the path of the scene file".into(),
    };
    let bytes = read.map_err(|e| match e.kind() {
        std::io::ErrorKind::NotFound => unreadable("cannot be read: there is no such file".into(), &help),
        _ => unreadable(format!("cannot be read: {e}"), &help),
    })?;
    String::from_utf8(bytes).map_err(|e| {
        let at = e.utf8_error().valid_up_to();
        let line = e.as_bytes()[..at].iter().filter(|&&b| b == b'\n').count() + 1;
        let message = format!("is not UTF-8 text (byte {at}, line {line})");
        unreadable(message, "save the file as UTF-8")
    })
}

/// Refuses a text that begins with a byte order mark, or is empty; returns the text to show with it.
pub(crate) fn refuse_blank(text: &str) -> Result<(), (&str, Diagnostic)> {
    if let Some(rest) = text.strip_prefix('\u{feff}') {
        let begins =
            Diagnostic::error(Code::Syntax, "", "the file begins with a byte order mark", Some(0..0));
        return Err((rest, begins.with_help("save it as UTF-8 without BOM")));
    }
    if text.trim().is_empty() {
        let empty = Diagnostic::error(Code::Truncated, "", "the file is empty", Some(0..0));
        return Err((text, empty.with_help("begin with one that runs: `ndda new` writes it")));
    }
    Ok(())
}

/// Text of a scene, or of a file that it includes, to types: values in the units of their fields, expressions as numbers.
/// Numbers that are none, fields that do not exist, commas that are missing and values of another type are found all at once, other mistakes of
/// grammar one at a time.
pub(crate) fn parse_with<T: DeserializeOwned>(
    text: &str,
    tree: &Node,
    parameters: &Parameters,
) -> Result<T, Mistakes<T>> {
    let mut plain = units::resolve(text, tree, parameters);
    let infinite = not_finite(tree, text);
    plain.supposed.extend(infinite.iter().filter_map(|found| found.span.clone()));
    plain.errors.extend(infinite);
    Reader::new(plain, text, tree).read()
}

/// Text of a study to types; the values that it sets stay as they are written, and are read with the scene.
pub(crate) fn parse<T: DeserializeOwned>(text: &str, tree: &Node) -> Result<T, Vec<Diagnostic>> {
    let mut plain = Resolved::unchanged(text);
    plain.errors = not_finite(tree, text);
    Reader::new(plain, text, tree).read().map_err(|mistakes| mistakes.found)
}

/// Gives each message its place, and puts them in the order of the text.
pub(crate) fn locate_all(found: &mut [Diagnostic], text: &str, tree: &Node) {
    for diagnostic in found.iter_mut() {
        diagnostic.span = place(tree, text, &diagnostic.path);
    }
    sort(found);
}

pub(crate) fn sort(found: &mut [Diagnostic]) {
    found.sort_by_key(|d| d.span.as_ref().map_or(0, |span| span.start));
}

/// Place of the value at a path, or of the nearest value around it that is written.
pub(crate) fn place(tree: &Node, text: &str, path: &str) -> Option<Range<usize>> {
    let mut node = tree;
    for segment in locate::segments(path) {
        match node.child(text, segment) {
            Some(child) => node = child,
            None => break,
        }
    }
    Some(node.span.clone())
}

/// Numbers that RON accepts and nothing can be computed with: NaN, infinities, and 1e400.
fn not_finite(tree: &Node, text: &str) -> Vec<Diagnostic> {
    let mut found = Vec::new();
    tree.for_each_leaf(&mut |leaf| {
        let word = &text[leaf.span.clone()];
        let digits = word.replace('_', "");
        let looks_like_number = digits.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c))
            || ["NaN", "inf"].contains(&digits.as_str());
        if looks_like_number && digits.parse::<f64>().is_ok_and(|number| !number.is_finite()) {
            let path = tree.path_at(leaf.span.start);
            let message = format!("{word} is not a number that one can compute with");
            let place = Some(leaf.span.clone());
            let help = "numbers are finite, at most 1.8e308 in size";
            found.push(Diagnostic::error(Code::NotFinite, path, message, place).with_help(help));
        }
    });
    found
}

#[cfg(test)]
mod tests {
    use crate::scene::read::load_text;

    /// Paths and codes of what is wrong with a scene.
    fn mistakes(time: &str, material: &str, block: &str) -> Vec<String> {
        let text = format!(
            "(title: \"t\", time: ({time}),
              materials: [(name: \"rock\", density_kg_m3: 2700, young_pa: 2e10, {material})],
              blocks: [(name: \"a\", material: \"rock\", shape: Box(size_m: (1, 1, 1), {block}))])"
        );
        let refused = load_text("s.ron", &text, &[], None).unwrap_err();
        refused.diagnostics.iter().map(|found| format!("{} {}", found.path, found.code)).collect()
    }

    #[test]
    fn mistakes_of_fields_and_values_are_told_at_once_and_what_follows_from_them_is_not() {
        assert_eq!(
            mistakes("stp_s: 1e-3, end: 1", "poison: 0.2", "cells: (1, 1, 1), foo: [1, (2)]"),
            [
                "time.stp_s unknown-field",
                "time.end unknown-field",
                "materials[0].poison unknown-field",
                "blocks[0].shape.foo unknown-field"
            ]
        );
        assert_eq!(
            mistakes("step_s: 1e-3, end_s: 1", "poisson: \"0.2\"", ""),
            ["materials[0].poisson wrong-type", "blocks[0].shape missing-field"]
        );
    }

    #[test]
    fn values_out_of_range_are_told_beside_fields_that_do_not_exist() {
        assert_eq!(
            mistakes("step_s: -1e-3, end_s: 1", "poison: 0.2, poisson: 0.7", "cells: (1, 1, 1)"),
            [
                "time.step_s out-of-range",
                "materials[0].poison unknown-field",
                "materials[0].poisson out-of-range"
            ]
        );
    }

    #[test]
    fn commas_numbers_and_names_that_are_wrong_are_told_at_once() {
        assert_eq!(
            mistakes("step_s: 1e-3 end_s: 1", "poison: 0.2, poisson: 0,25", "cells: (1, 1, 1)"),
            ["time.end_s syntax", "materials[0].poison unknown-field", "materials[0].poisson syntax"]
        );
        assert_eq!(
            mistakes("step_s: -1e-3 end_s: 1", "poisson: 0.7", "cells: (1, 1.5, -2)"),
            [
                "time.step_s out-of-range",
                "time.end_s syntax",
                "materials[0].poisson out-of-range",
                "blocks[0].shape.cells[1] wrong-type",
                "blocks[0].shape.cells[2] wrong-type"
            ]
        );
    }

    #[test]
    fn what_may_follow_from_an_expression_that_is_wrong_is_not_told() {
        let scene = |parameters: &str, step: &str, size: &str, frames: &str| {
            let text = format!(
                "(title: \"t\", parameters: ({parameters}), time: (step_s: {step}, end_s: 1),
                  materials: [(name: \"rock\", density_kg_m3: -2700, young_pa: 2e10, poisson: 0.2)],
                  blocks: [(name: \"a\", material: \"rok\", shape: Box(size_m: ({size}, 1, 1), cells: (1, 1, 1)))],
                  output: (frames: {frames}))"
            );
            let refused = load_text("s.ron", &text, &[], None).unwrap_err();
            let told = |found: &crate::diagnostic::Diagnostic| format!("{} {}", found.path, found.code);
            refused.diagnostics.iter().map(told).collect::<Vec<_>>()
        };
        let others = ["materials[0].density_kg_m3 out-of-range", "blocks[0].material unknown-name"];
        // A size of 1 − 2 m would be out of range, as would one that is computed from what a parameter should be.
        for (parameters, size, own) in [
            ("", "Calc(width_m - 2)", "blocks[0].shape.size_m[0] expression"),
            ("width_m: Calc(wide_m)", "Calc(width_m - 2)", "parameters.width_m expression"),
        ] {
            let mut expected = vec![own];
            expected.extend(others);
            let mut found = scene(parameters, "1e-3", size, "1");
            expected.sort_unstable();
            found.sort_unstable();
            assert_eq!(found, expected);
        }
        let all = scene("a_m: 1 b_m: 2", "1e-3", "Calc(a_m + b_m)", "1.5");
        assert_eq!(all, ["parameters.b_m syntax", others[0], others[1], "output.frames wrong-type"]);
    }

    #[test]
    fn a_bracket_a_decimal_point_and_calc_that_are_missing_are_named() {
        let told = |rock: &str, dip: &str| {
            let text = format!(
                "(title: \"t\", parameters: (dip_1: 30), time: (step_s: 1e-3, end_s: 1),
                  materials: [(name: \"rock\", density_kg_m3: 2700, young_pa: 2e10, poisson: 0.2)],
                  rock: [(material: \"rock\", domain: Box(min_m: (0, 0, 0), max_m: (1, 1, 1)), joints: [
                      Plane(name: \"a\", dip_deg: {dip}, dip_direction_deg: 0, point_m: (0, 0, 0){rock},
                      Plane(name: \"b\", dip_deg: 9, dip_direction_deg: Calc(dip_1), point_m: (0, 0, 0))])])"
            );
            load_text("s.ron", &text, &[], None).unwrap_err().diagnostics
        };
        let [bracket, point, calc] =
            [told("", "30"), told(")", "30,5"), told(")", "dip_1")].map(|found| found[0].clone());
        assert_eq!(bracket.message, "a closing bracket is missing before `Plane`");
        assert_eq!(point.help.unwrap(), "write a decimal point: 30.5");
        assert_eq!(calc.help.unwrap(), "write Calc(dip_1)");
        let cut_off = "(title: \"t\", parameters: (dip_1: 30), time: (step_s: 1e-3, end_s: Calc(dip_";
        let found = load_text("s.ron", cut_off, &[], None).unwrap_err().diagnostics;
        assert!(found.iter().all(|found| found.code.to_string() == "truncated"), "{found:?}");
    }
}
