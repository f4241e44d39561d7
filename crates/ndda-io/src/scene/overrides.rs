//! `--set path=value`: the scene's text with other values in it.

use std::ops::Range;

use crate::scene::code::Code;
use crate::scene::diagnostic::Diagnostic;
use crate::scene::locate::{self, Node, current_segments, segments};
use crate::scene::parameters;
use crate::scene::suggest::{is_with_unit, suggest};
use crate::scene::units;

/// Keys whose value is a choice: what is inside cannot be written without saying which.
const CHOICES: [&str; 6] = ["integrator", "contact", "reference", "shape", "on", "hold"];

/// Replaces values in the text of a scene, one after the other; a field that is not written yet is added to its
/// struct.
///
/// # Errors
/// A diagnostic for each override that has no `=` or whose path leads nowhere.
pub(crate) fn apply(text: &str, overrides: &[String]) -> Result<String, Vec<Diagnostic>> {
    let (mut text, mut refused) = (text.to_string(), Vec::new());
    let mut lost: Vec<&str> = Vec::new();
    for one in overrides {
        let path = one.split('=').next().unwrap_or_default().trim();
        match apply_one(&text, one) {
            Ok(changed) => text = changed,
            // What is inside a value that could not be set cannot be set either.
            Err(_) if lost.iter().any(|outer| is_inside(path, outer)) => {}
            Err(found) => {
                refused.push(found);
                lost.push(path);
            }
        }
    }
    if refused.is_empty() { Ok(text) } else { Err(refused) }
}

/// Whether a path leads to something inside the value at another one.
fn is_inside(path: &str, outer: &str) -> bool {
    let (path, outer) = (current_segments(path), current_segments(outer));
    path.len() > outer.len() && path.starts_with(&outer)
}

fn apply_one(text: &str, one: &str) -> Result<String, Diagnostic> {
    let refuse = |message: String| Diagnostic::error(Code::Override, format!("--set {one}"), message, None);
    let Some((path, value)) = one.split_once('=') else {
        return Err(refuse("has no `=`; write --set time.step_s=1e-3".into()));
    };
    let (path, value) = (path.trim(), value.trim());
    let names = current_segments(path);
    if names.is_empty() || value.is_empty() {
        return Err(refuse("needs a path and a value; write --set time.step_s=1e-3".into()));
    }
    if let Some((number, unit)) = value.split_once(char::is_whitespace)
        && number.parse::<f64>().is_ok()
        && units::may_be_unit(unit.trim())
    {
        let field = names.iter().rev().find(|name| name.parse::<usize>().is_err()).unwrap_or(&"");
        let help = units::advice(number, unit.trim(), field);
        return Err(refuse(format!("`{value}`: {}", units::NOT_BEHIND)).with_help(help));
    }
    locate::one_value(value).map_err(|reason| {
        refuse(format!("`{value}` {reason}")).with_help("write one value, and --set again for the next")
    })?;
    put(text, path, value).map_err(|reason| {
        let elsewhere = elsewhere(&Node::of(text), text, path, value);
        Diagnostic { help: elsewhere, ..refuse(reason) }
    })
}

/// Places of a scene that are often set and need not be written in it, by their last name.
const OFTEN: [&str; 6] =
    ["time.step_s", "time.end_s", "time.integrator", "contact.penalty_pa", "output.frames", "gravity_ramp_s"];
/// Paths that are listed.
const MOST_LISTED: usize = 5;

/// Advice for a path that the scene does not have: its paths that end in the same name.
fn elsewhere(tree: &Node, text: &str, path: &str, value: &str) -> Option<String> {
    let leaf = *current_segments(path).last()?;
    let is_it = |key: &str| key == leaf || is_with_unit(key, leaf);
    let mut found = Vec::new();
    paths_of(tree, text, &is_it, "", &mut found);
    // A name that is no parameter is said to be like one that is.
    let of_parameters = |path: &str| path.starts_with(parameters::FIELD);
    found.retain(|known| segments(known) != segments(path) && (!of_parameters(path) || of_parameters(known)));
    if found.is_empty() && !of_parameters(path) {
        let often = OFTEN.iter().filter(|often| segments(often).last().is_some_and(|key| is_it(key)));
        found.extend(often.map(ToString::to_string));
        found.retain(|known| segments(known) != segments(path));
    }
    // A parameter comes first: setting it changes all values that are computed from it.
    found.sort_by_key(|path| !path.starts_with(parameters::FIELD));
    match found.as_slice() {
        [] => like_parameters(tree, text, leaf),
        [one] => Some(format!("did you mean --set {one}={value}?")),
        [first, ..] if first.starts_with(parameters::FIELD) => {
            Some(format!("did you mean --set {first}={value}?"))
        }
        many if many.len() <= MOST_LISTED => Some(format!("`{leaf}` is at {}", many.join(", "))),
        many => {
            let listed = many[..MOST_LISTED].join(", ");
            Some(format!("`{leaf}` is at {} places, such as {listed}", many.len()))
        }
    }
}

/// Parameters whose name has this one in it.
fn like_parameters(tree: &Node, text: &str, leaf: &str) -> Option<String> {
    let all = tree.child(text, parameters::FIELD)?.children.iter().filter_map(|child| child.key.as_deref());
    let like: Vec<String> =
        all.filter(|key| key.contains(leaf)).map(|key| format!("{}.{key}", parameters::FIELD)).collect();
    (!like.is_empty()).then(|| format!("did you mean {}?", like.join(", ")))
}

/// Paths of all fields whose name is one of those wanted; items of lists go by their own `name`, or else by number.
fn paths_of(node: &Node, text: &str, wanted: &dyn Fn(&str) -> bool, path: &str, found: &mut Vec<String>) {
    for (i, child) in node.children.iter().enumerate() {
        let own = match (&child.key, child.child(text, "name").map(|name| &text[name.span.clone()])) {
            (Some(key), _) if path.is_empty() => key.clone(),
            (Some(key), _) => format!("{path}.{key}"),
            (None, Some(name)) if is_plain(name) => format!("{path}.{}", name.trim_matches('"')),
            (None, _) => format!("{path}[{i}]"),
        };
        if child.key.as_deref().is_some_and(wanted) {
            found.push(own.clone());
        }
        paths_of(child, text, wanted, &own, found);
    }
}

/// Whether a quoted name can be a part of a path, and needs no quotes in a shell.
fn is_plain(name: &str) -> bool {
    let inner = name.trim_matches('"');
    !inner.is_empty()
        && inner.parse::<usize>().is_err()
        && inner.chars().all(|c| c.is_alphanumeric() || "_-".contains(c))
}

/// Puts a value, which may have a comment, at a path.
///
/// # Errors
/// Why the path leads nowhere.
pub(crate) fn put(text: &str, path: &str, value: &str) -> Result<String, String> {
    let names = current_segments(path);
    let tree = Node::of(text);
    // The longest part of the path that is there.
    let mut node = &tree;
    let mut known = 0;
    while let Some(next) = names.get(known).and_then(|name| node.child(text, name)) {
        node = next;
        known += 1;
    }
    if known == names.len() {
        let mut out = text.to_string();
        out.replace_range(node.span.clone(), value);
        return Ok(out);
    }
    let missing = &names[known..];
    if names[0] == parameters::FIELD && names.len() > 1 {
        return Err(no_parameter(node, known, missing[0]));
    }
    if node.opening != Some('(') || missing.iter().any(|name| name.parse::<usize>().is_ok()) {
        return Err(lost(text, node, missing[0]));
    }
    if let Some(choice) = missing[..missing.len() - 1].iter().find(|name| CHOICES.contains(name)) {
        return Err(format!(
            "the scene leaves out `{choice}`: set the choice itself together with its fields"
        ));
    }
    Ok(insert(text, node, missing, value))
}

/// Says of each message about a value that an override has put there which one it was.
pub(crate) fn blame(found: &mut [Diagnostic], text: &str, overrides: &[String]) {
    let tree = Node::of(text);
    for diagnostic in found {
        let blamed = to_blame(diagnostic, (&tree, text), overrides);
        if blamed.is_empty() {
            continue;
        }
        let sets: Vec<String> = blamed.iter().map(|one| format!("--set {one}")).collect();
        diagnostic.message = format!("{} (set by {})", diagnostic.message, sets.join(", "));
        if let Some((path, value)) = blamed[0].split_once('=')
            && diagnostic.code == Code::UnknownField
            && segments(&diagnostic.path) == current_segments(path.trim())
        {
            let found = elsewhere(&tree, text, path.trim(), value.trim());
            diagnostic.help = found.or(diagnostic.help.take());
        }
    }
}

/// Overrides that a message is about: the last one of the value itself, those of parameters that it is computed from, and those of
/// values beside it that the message names.
fn to_blame<'a>(
    diagnostic: &Diagnostic,
    (tree, text): (&Node, &str),
    overrides: &'a [String],
) -> Vec<&'a String> {
    if diagnostic.path.starts_with("--set ") {
        return Vec::new();
    }
    let names = segments(&diagnostic.path);
    let path_of = |one: &'a String| current_segments(one.split('=').next().unwrap_or_default().trim());
    let is_own = |one: &&'a String| {
        let own = path_of(one);
        let node = own.iter().try_fold(tree, |node, name| node.child(text, name));
        let is_within = |at: &Range<usize>| {
            node.is_some_and(|node| node.span.start <= at.start && at.end <= node.span.end)
        };
        names.starts_with(&own) || diagnostic.span.as_ref().is_some_and(is_within)
    };
    let value = diagnostic.span.clone().map_or("", |span| &text[span]);
    // An expression, and no struct that has some in it.
    let used = if value.contains("Calc(") && !value.contains(':') { value } else { "" };
    let used = parameters_of(used, tree, text);
    let is_beside = |one: &&'a String| match path_of(one).as_slice() {
        [parameters::FIELD, name] => used.contains(name),
        [around @ .., last] => {
            names.split_last().is_some_and(|(_, parent)| parent == around)
                && words(&diagnostic.message).any(|word| word == *last)
        }
        [] => false,
    };
    let own = overrides.iter().rev().find(is_own);
    let beside = overrides.iter().filter(is_beside).filter(|one| own != Some(one));
    own.into_iter().chain(beside).collect()
}

/// Names in a text.
fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| !c.is_alphanumeric() && c != '_').filter(|word| !word.is_empty())
}

/// Parameters that an expression is computed from, directly or by others.
fn parameters_of<'a>(expression: &'a str, tree: &Node, text: &'a str) -> Vec<&'a str> {
    let mut found: Vec<&str> = words(expression).collect();
    let mut next = 0;
    while let Some(name) = found.get(next) {
        if let Some(node) = tree.child(text, parameters::FIELD).and_then(|all| all.child(text, name)) {
            let more: Vec<&str> =
                words(&text[node.span.clone()]).filter(|word| !found.contains(word)).collect();
            found.extend(more);
        }
        next += 1;
    }
    found
}

/// That there is no such parameter: one that nothing is computed from would be of no use.
fn no_parameter(node: &Node, known: usize, name: &str) -> String {
    if known == 0 {
        return "the scene has no parameters".into();
    }
    let names: Vec<&str> = node.children.iter().filter_map(|child| child.key.as_deref()).collect();
    format!("there is no parameter `{name}`; {}", suggest(name, &names))
}

/// Why a path leads nowhere.
fn lost(text: &str, node: &Node, name: &str) -> String {
    let here = node.children.iter().enumerate().map(|(i, child)| match &child.key {
        Some(key) => key.clone(),
        None => child.child(text, "name").map_or(format!("[{i}]"), |n| text[n.span.clone()].replace('"', "")),
    });
    let here = here.collect::<Vec<_>>().join(", ");
    if here.is_empty() {
        format!("`{name}`: this is a single value without fields")
    } else {
        format!("there is no `{name}` here; choose one of {here}")
    }
}

/// Adds `a: (b: value)` after the last field of a struct.
fn insert(text: &str, node: &Node, missing: &[&str], value: &str) -> String {
    let (innermost, outer) = missing.split_last().expect("something is missing");
    let innermost = format!("{innermost}: {value}");
    let nested = outer.iter().rev().fold(innermost, |inside, name| format!("{name}: ({inside})"));
    let (place, field) = match node.children.last() {
        Some(last) => (last.span.end, format!(", {nested}")),
        None => (node.span.end.saturating_sub(1), nested),
    };
    let mut out = text.to_string();
    out.insert_str(place, &field);
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::diagnostic::Severity;

    const TEXT: &str = "(time: (step_s: 1e-3,), blocks: [(name: \"A\", at_m: (1, 2, 3))])";

    fn set(one: &str) -> String {
        apply(TEXT, &[one.to_string()]).unwrap_or_else(|d| format!("{}: {}", d[0].path, d[0].message))
    }

    #[test]
    fn a_value_is_replaced_where_it_stands() {
        assert!(set("time.step_s = 1e-4").starts_with("(time: (step_s: 1e-4,)"));
        assert!(set("blocks.A.at_m[1]=7").contains("(1, 7, 3)"));
    }

    #[test]
    fn a_field_with_a_default_is_added() {
        assert!(set("blocks[0].velocity_m_s=(1,0,0)").contains("(1, 2, 3), velocity_m_s: (1,0,0))"));
        assert!(set("output.frames=5").ends_with("], output: (frames: 5))"));
    }

    #[test]
    fn what_is_not_one_value_is_refused_before_it_is_put_anywhere() {
        for (value, word) in [
            ("1e-3, end_s: 5", "`, end_s: 5` follows"),
            ("1 2", "`2` follows"),
            ("1)", "`)` follows"),
            ("(1, 2", "`(` is not closed"),
            ("(1, 2]", "`(` is not closed"),
            ("\"a", "`\"` is not closed"),
            ("Newmark(alpha: 0.5", "`(` is not closed"),
            (")", "is not a value"),
            ("1 // more", "`// more` follows"),
            ("(1 // )", "`(` is not closed"),
            ("1 /*", "`/*` follows"),
        ] {
            let said = set(&format!("time.step_s={value}"));
            assert!(said.starts_with("--set time.step_s=") && said.contains(word), "{value}: {said}");
        }
        for value in
            ["Newmark(alpha: 0.5, delta: 1)", "Calc(90 - (2 + dip_deg))", "\"a, (b\"", "[(1, 2), (3, 4)]"]
        {
            assert!(set(&format!("time.step_s={value}")).contains(&format!("step_s: {value}")), "{value}");
        }
    }

    /// Advice on an override of a scene with a parameter, two blocks and a material.
    fn advice(one: &str) -> String {
        let text = "(title: \"t\", parameters: (friction_deg: 30),
            time: (end_s: 1),
            materials: [(name: \"rock\", density_kg_m3: 2700, young_pa: 1e10, poisson: 0.25)],
            blocks: [
                (name: \"a\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1))),
                (name: \"b\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), at_m: (0, 0, 2)),
            ],
            contact: Potential(penalty_pa: 1e9, friction: (friction_deg: Calc(friction_deg))))";
        let errors = crate::scene::read::load_text("s.ron", text, &[one.to_string()], None).unwrap_err();
        errors.diagnostics[0].help.clone().unwrap_or_default()
    }

    #[test]
    fn a_name_without_its_path_is_answered_with_the_path() {
        for (one, said) in [
            ("friction_deg=20", "did you mean --set parameters.friction_deg=20?"),
            ("contact.friction_deg=20", "did you mean --set parameters.friction_deg=20?"),
            ("young_pa=2e10", "did you mean --set materials.rock.young_pa=2e10?"),
            ("end_s=2", "did you mean --set time.end_s=2?"),
            ("step_s=1e-3", "did you mean --set time.step_s=1e-3?"),
            ("step=1e-3", "did you mean --set time.step_s=1e-3?"),
            ("penalty_pa=1e8", "did you mean --set contact.penalty_pa=1e8?"),
            ("size_m=(1, 2, 3)", "`size_m` is at blocks.a.shape.size_m, blocks.b.shape.size_m"),
            ("materials.rock.young_pa=20 GPa", "write Gigapascal(20), or 2e10"),
            ("materials.rock.young_pa=20GPa", "write Gigapascal(20), or 2e10"),
        ] {
            assert_eq!(advice(one), said, "{one}");
        }
        assert_eq!(advice("time.stop_s=3"), "did you mean `step_s`?");
    }

    #[test]
    fn the_override_that_is_at_fault_is_named() {
        let text = "(title: \"t\", parameters: (friction_deg: 30, twice: Calc(2 * friction_deg)), time: (step_s: 1e-3, end_s: 1),
            materials: [(name: \"rock\", density_kg_m3: 2700, young_pa: 1e10, poisson: 0.25)],
            blocks: [(name: \"a\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)))],
            contact: Potential(penalty_pa: 1e9, friction: (friction_deg: Calc(twice))))";
        let message = |sets: &[&str]| {
            let sets: Vec<String> = sets.iter().map(ToString::to_string).collect();
            let errors = crate::scene::read::load_text("s.ron", text, &sets, None).unwrap_err();
            let error = errors.diagnostics.iter().find(|found| found.severity == Severity::Error);
            error.unwrap().message.clone()
        };
        let said = message(&["parameters.friction_deg=50", "time.end_s=2"]);
        assert!(said.ends_with("(set by --set parameters.friction_deg=50)"), "{said}");
        let said = message(&["time.end_s=1e-4"]);
        assert!(said.ends_with("(set by --set time.end_s=1e-4)"), "{said}");
        let said = message(&["time.step_s=1e-9", "time.end_s=1e6"]);
        assert!(said.ends_with("(set by --set time.end_s=1e6, --set time.step_s=1e-9)"), "{said}");
        let said = message(&["time.end_s=2", "materials.rock.young_pa=-1"]);
        assert!(said.ends_with("(set by --set materials.rock.young_pa=-1)"), "{said}");
    }

    #[test]
    fn a_path_that_leads_nowhere_is_refused_with_what_is_there() {
        assert!(set("blocks.B.at_m=1").contains("there is no `B` here; choose one of A"));
        assert!(set("time.integrator.theta=1").contains("set the choice itself"));
        assert!(set("time.step_s").contains("has no `=`"));
        assert!(set("time.step_s.x=1").contains("a single value"));
    }
}
