//! `--set path=value`: the scene's text with other values in it.

use std::ops::Range;

use crate::scene::code::Code;
use crate::scene::diagnostic::Diagnostic;
use crate::scene::locate::{self, Node, current_segments};
use crate::scene::parameters;
use crate::scene::suggest::suggest;

/// Keys whose value is a choice: what is inside cannot be written without saying which.
const CHOICES: [&str; 6] = ["integrator", "contact", "reference", "shape", "on", "hold"];

/// Replaces values in the text of a scene, one after the other; a field that is not written yet is added to its
/// struct.
///
/// # Errors
/// A diagnostic when an override has no `=` or its path leads nowhere.
pub(crate) fn apply(text: &str, overrides: &[String]) -> Result<String, Diagnostic> {
    overrides.iter().try_fold(text.to_string(), |text, one| apply_one(&text, one))
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
    locate::one_value(value).map_err(|reason| {
        refuse(format!("`{value}` {reason}")).with_help("write one value, and --set again for the next")
    })?;
    put(text, path, value).map_err(refuse)
}

/// Puts a value, which may have a comment, at a path.
///
/// # Errors
/// Why the path leads nowhere.
pub(crate) fn put(text: &str, path: &str, value: &str) -> Result<String, String> {
    let names = current_segments(path);
    let tree = locate::tree(text);
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
        return Err(format!("`{choice}` is not written in the scene: write which one it is first"));
    }
    Ok(insert(text, node, missing, value))
}

/// Says of each message about a value that an override has put there which one it was.
pub(crate) fn blame(found: &mut [Diagnostic], text: &str, overrides: &[String]) {
    let tree = locate::tree(text);
    for diagnostic in found {
        let names = locate::segments(&diagnostic.path);
        let put = overrides.iter().rev().find(|one| {
            let path = one.split('=').next().unwrap_or_default();
            let own = current_segments(path.trim());
            let node = own.iter().try_fold(&tree, |node, name| node.child(text, name));
            let is_within = |at: &Range<usize>| {
                node.is_some_and(|node| node.span.start <= at.start && at.end <= node.span.end)
            };
            names.starts_with(&own) || diagnostic.span.as_ref().is_some_and(is_within)
        });
        if let Some(one) = put.filter(|one| diagnostic.path != format!("--set {one}")) {
            diagnostic.message = format!("{} (set by --set {one})", diagnostic.message);
        }
    }
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
        format!("`{name}`: there is nothing below this value")
    } else {
        format!("there is no `{name}` here; there is {here}")
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

    const TEXT: &str = "(time: (step_s: 1e-3,), blocks: [(name: \"A\", at_m: (1, 2, 3))])";

    fn set(one: &str) -> String {
        apply(TEXT, &[one.to_string()]).unwrap_or_else(|d| format!("{}: {}", d.path, d.message))
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
            (")", "is no value"),
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

    #[test]
    fn a_path_that_leads_nowhere_is_refused_with_what_is_there() {
        assert!(set("blocks.B.at_m=1").contains("there is no `B` here; there is A"));
        assert!(set("time.integrator.theta=1").contains("write which one it is first"));
        assert!(set("time.step_s").contains("has no `=`"));
        assert!(set("time.step_s.x=1").contains("nothing below"));
    }
}
