//! Reading the parameters of a scene.

use crate::scene::code::Code;
use crate::scene::diagnostic::Diagnostic;
use crate::scene::locate::Node;
use crate::scene::parameters::{FIELD, Parameters};
use crate::scene::units;

/// That a unit stands behind the number of a parameter: `height_m: 8 m`.
fn unit_behind(node: &Node, text: &str) -> Option<Diagnostic> {
    node.children.windows(2).find_map(|pair| {
        let [number, unit] = pair else { return None };
        let (name, value) = (number.key.as_ref()?, &text[number.span.clone()]);
        let symbol = &text[unit.span.clone()];
        let is_behind = unit.key.is_none() && text[number.span.end..unit.span.start].trim().is_empty();
        if !is_behind || value.parse::<f64>().is_err() || !units::may_be_unit(symbol) {
            return None;
        }
        let message = format!("`{value} {symbol}`: {}", units::NOT_BEHIND);
        let refused =
            Diagnostic::error(Code::Syntax, format!("{FIELD}.{name}"), message, Some(unit.span.clone()));
        Some(refused.with_help(units::advice(value, symbol, name)))
    })
}

/// That commas are missing between parameters.
fn commas_missing(node: &Node, text: &str) -> Vec<Diagnostic> {
    let missing = |pair: &&[Node]| !text[pair[0].span.end..pair[1].key_span.start].contains(',');
    let refuse = |pair: &[Node]| {
        let name = pair[1].key.as_deref().unwrap_or_default();
        let (path, at) = (format!("{FIELD}.{name}"), Some(pair[1].key_span.clone()));
        let refused = Diagnostic::error(Code::Syntax, path, "expected a comma before this", at);
        refused.with_help("write a comma after each parameter")
    };
    node.children.windows(2).filter(missing).map(refuse).collect()
}

/// Reads the parameters of a scene; each may be computed from those before it. A value that is wrong is taken for 1, and said to be wrong.
///
/// # Errors
/// Why they cannot be read at all.
pub(crate) fn read(text: &str, tree: &Node) -> Result<(Parameters, Vec<Diagnostic>), Vec<Diagnostic>> {
    let mut read = Parameters::default();
    let Some(node) = tree.children.iter().find(|child| child.key.as_deref() == Some(FIELD)) else {
        return Ok((read, Vec::new()));
    };
    if node.opening != Some('(') || node.children.iter().any(|child| child.key.is_none()) {
        if let Some(refused) = unit_behind(node, text) {
            return Err(vec![refused]);
        }
        let refused = Diagnostic::error(
            Code::WrongType,
            FIELD,
            "parameters must be names with values",
            Some(node.span.clone()),
        );
        return Err(vec![refused.with_help("write parameters: (height_m: 10, dip_deg: 35)")]);
    }
    let mut found = commas_missing(node, text);
    for child in &node.children {
        let name = child.key.clone().unwrap_or_default();
        let refused = read.refuse_name(&name, child.key_span.clone());
        // Another of the same name, or one that no expression can have, is no parameter.
        let is_named = refused.is_none();
        found.extend(refused);
        match value(text, tree, child, &read) {
            Ok((value, false)) if is_named => read.add(name, value, child.key_span.clone()),
            Ok(_) if is_named => read.suppose(name, child.key_span.clone()),
            Ok(_) => {}
            Err(mistakes) => {
                found.extend(mistakes);
                if is_named {
                    read.suppose(name, child.key_span.clone());
                }
            }
        }
    }
    Ok((read, found))
}

/// Value of one parameter, a number, one with a unit, or one that is computed, and whether it follows from one that is only supposed.
fn value(text: &str, tree: &Node, node: &Node, earlier: &Parameters) -> Result<(f64, bool), Vec<Diagnostic>> {
    let (plain, is_supposed) = units::resolve_value(text, tree, node, earlier)?;
    let number = plain.replace('_', "").trim().parse::<f64>().ok().filter(|number| number.is_finite());
    number.map(|number| (number, is_supposed)).ok_or_else(|| {
        let path = tree.path_at(node.span.start);
        let message = "a parameter is one finite number";
        let refused = Diagnostic::error(Code::WrongType, path, message, Some(node.span.clone()));
        vec![refused.with_help("write a number, one with its unit, or Calc(…) of the parameters before it")]
    })
}

#[cfg(test)]
mod tests {
    use crate::scene::read::load_text;

    fn scene(parameters: &str, dip: &str) -> String {
        format!(
            "(title: \"t\", {parameters} time: (step_s: 1e-3, end_s: 1),
              materials: [(name: \"rock\", density_kg_m3: 2700, young_pa: Gigapascal(Calc(10 * 2)), poisson: 0.25)],
              blocks: [(name: \"a\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (1, Calc(1 + 1), 1)), 
                turns: [(axis: (0, 1, 0), angle_deg: {dip})])])"
        )
    }

    #[test]
    fn parameters_are_computed_from_earlier_ones_in_units_and_counts() {
        let text =
            scene("parameters: (dip_deg: Radians(0.5), rise_deg: Calc(90 - dip_deg)),", "Calc(-rise_deg)");
        let scene = load_text("s.ron", &text, &[], None).unwrap().scene;
        assert_eq!(scene.blocks[0].turns[0].angle_deg, -(90.0 - 0.5f64.to_degrees()));
        assert_eq!(scene.materials[0].young_pa, 20e9);
        assert_eq!(scene.parameters["rise_deg"], 90.0 - 0.5f64.to_degrees());
        assert!(matches!(&scene.blocks[0].shape, crate::scene::Shape::Box { cells: [1, 2, 1], .. }));
    }

    #[test]
    fn a_scene_with_an_expression_is_that_with_its_value() {
        let with = load_text("s.ron", &scene("parameters: (dip_deg: 35),", "Calc(90 - dip_deg)"), &[], None);
        let mut with = with.unwrap().scene;
        let plain = load_text("s.ron", &scene("", "55"), &[], None).unwrap().scene;
        with.parameters.clear();
        assert_eq!(with, plain);
    }

    #[test]
    fn a_parameter_is_set_by_its_name() {
        let text = scene("parameters: (dip_deg: 35),", "Calc(dip_deg)");
        let turned = |set: &str| load_text("s.ron", &text, &[set.to_string()], None);
        assert_eq!(turned("parameters.dip_deg=40").unwrap().scene.blocks[0].turns[0].angle_deg, 40.0);
        assert_eq!(
            turned("parameters.dip_deg=Calc(2 * 40)").unwrap().scene.blocks[0].turns[0].angle_deg,
            80.0
        );
        let refused = turned("parameters.dpi_deg=40").unwrap_err().render(false);
        assert!(refused.contains("did you mean `dip_deg`"), "{refused}");
        let bare = load_text("s.ron", &scene("", "1"), &["parameters.dip_deg=40".into()], None);
        assert!(bare.unwrap_err().render(false).contains("has no parameters"));
    }

    #[test]
    fn a_parameter_that_is_wrong_is_not_said_to_be_missing_in_others() {
        let text =
            scene("parameters: (a_deg: Calc(1 / 0), b_deg: Calc(2 * a_deg), c_deg: Calc(b_deg)),", "0");
        let refused = load_text("s.ron", &text, &[], None).unwrap_err();
        let paths: Vec<_> = refused.diagnostics.iter().map(|found| found.path.as_str()).collect();
        assert_eq!(paths, ["parameters.a_deg"]);
    }

    #[test]
    fn a_comma_that_is_missing_between_parameters_is_said() {
        let refused = load_text("s.ron", &scene("parameters: (a_m: 1 b_m: 2),", "0"), &[], None).unwrap_err();
        let found = &refused.diagnostics[0];
        assert_eq!((found.path.as_str(), found.code), ("parameters.b_m", super::Code::Syntax));
    }

    #[test]
    fn a_unit_behind_the_number_of_a_parameter_is_answered_with_how_it_is_written() {
        for (written, said) in [
            ("height_m: 8 m", "write 8, or Metre(8)"),
            ("young_pa: 20 GPa, height_m: 8", "write Gigapascal(20), or 2e10"),
        ] {
            let text = format!("(parameters: ({written}))");
            let found = super::read(&text, &crate::scene::locate::Node::of(&text)).unwrap_err();
            assert!(found[0].help.as_ref().unwrap().contains(said), "{found:?}");
        }
    }

    #[test]
    fn mistakes_come_with_file_line_column_and_expression() {
        for (parameters, dip, place, words) in [
            ("parameters: (dip_deg: 35),", "90 - Calc(dip_deg)", "s.ron:4:", ""),
            (
                "parameters: (dip_deg: 35),",
                "Calc(90 - dpi_deg)",
                "s.ron:4:64",
                "in `90 - dpi_deg`: there is no",
            ),
            ("parameters: (a: 0),", "Calc(1 / a)", "s.ron:4:59", "`1 / a` divides by zero"),
            ("parameters: (a: Calc(b), b: 1),", "Calc(a)", "s.ron:1:35", "no parameter `b`"),
            ("parameters: (pi: 3),", "1", "s.ron:1:27", "have already"),
            ("parameters: (a: 3, a: 4),", "1", "s.ron:1:33", "twice"),
            ("parameters: (a: (1, 2)),", "1", "s.ron:1:30", "one finite number"),
            ("parameters: (a: NaN),", "1", "s.ron:1:30", "one finite number"),
            ("parameters: (a: -1e400),", "1", "s.ron:1:30", "one finite number"),
            ("parameters: (a_m: Degrees(2)),", "1", "s.ron:1:32", "not a unit of a length"),
            ("parameters: [3],", "1", "s.ron:1:26", "height_m"),
            (
                "parameters: (dip_deg: 35),",
                "1",
                "s.ron:1:27: warning[no-effect]",
                "no number of the scene uses",
            ),
        ] {
            let said = match load_text("s.ron", &scene(parameters, dip), &[], None) {
                Ok(loaded) => loaded.errors(loaded.warnings.clone()).render(false),
                Err(errors) => errors.render(false),
            };
            assert!(said.contains(place) && said.contains(words), "{parameters} {dip}: {said}");
        }
    }
}
