//! Warnings of former keys, which are read for one more version.

use crate::scene::code::Code;
use crate::scene::diagnostic::{Diagnostic, Severity};
use crate::scene::locate::{Node, current_segments, segments};

/// A warning for each old key in a scene or in its overrides.
pub(super) fn warnings(text: &str, tree: &Node, overrides: &[String]) -> Vec<Diagnostic> {
    let mut found = Vec::new();
    for parent in &tree.children {
        for field in &parent.children {
            let (Some(outer), Some(new)) = (&parent.key, &field.key) else { continue };
            let old = &text[field.key_span.clone()];
            if old != new {
                let mut warning = warning(&format!("{outer}.{new}"), old, new);
                warning.span = Some(field.key_span.clone());
                found.push(warning);
            }
        }
    }
    for one in overrides {
        let path = one.split('=').next().unwrap_or(one).trim();
        let changed = segments(path).into_iter().zip(current_segments(path)).find(|(old, new)| old != new);
        found.extend(changed.map(|(old, new)| warning(&format!("--set {one}"), old, new)));
    }
    found
}

fn warning(path: &str, old: &str, new: &str) -> Diagnostic {
    let message = format!("`{old}` is now called `{new}`");
    let warning =
        Diagnostic { severity: Severity::Warning, ..Diagnostic::error(Code::Renamed, path, message, None) };
    warning.with_help(format!("write `{new}`; the next version no longer reads `{old}`"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Contact;
    use crate::scene::read::load_text;

    fn scene(key: &str, entry: &str) -> String {
        format!(
            "(title: \"t\", time: (step_s: 1e-3, end_s: 1),
              materials: [(name: \"rock\", density_kg_m3: 2700, young_pa: 1e10, poisson: 0.25)],
              blocks: [
                (name: \"a\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1))),
                (name: \"b\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), at_m: (0, 0, 2)),
              ],
              contact: Potential(penalty_pa: 1e9, {key}: [{entry}]))"
        )
    }

    const PAIR: &str = "(between: (\"rock\", \"rock\"), friction: (friction_deg: 30))";

    #[test]
    fn an_old_key_is_read_as_the_new_one_with_a_warning_at_its_place() {
        let (old, new) = (scene("joints", PAIR), scene("material_pairs", PAIR));
        let [old, new] = [old, new].map(|text| load_text("s.ron", &text, &[], None).unwrap());
        assert_eq!(old.scene, new.scene);
        assert!(new.warnings.iter().all(|w| w.code != Code::Renamed), "{:?}", new.warnings);
        let warning = old.warnings.iter().find(|w| w.code == Code::Renamed).expect("a warning");
        assert_eq!(&old.text[warning.span.clone().unwrap()], "joints");
        let Some(Contact::Potential { material_pairs, .. }) = &old.scene.contact else {
            panic!("no contact")
        };
        assert_eq!(material_pairs[0].friction.as_ref().unwrap().friction_deg, 30.0);
    }

    #[test]
    fn a_path_of_an_override_takes_the_old_and_the_new_key_of_a_scene_with_either() {
        for written in ["joints", "material_pairs"] {
            for named in ["joints", "material_pairs"] {
                let set = format!("contact.{named}[0].friction.friction_deg=20");
                let loaded = load_text("s.ron", &scene(written, PAIR), &[set], None).unwrap();
                let Some(Contact::Potential { material_pairs, .. }) = &loaded.scene.contact else { panic!() };
                assert_eq!(material_pairs[0].friction.as_ref().unwrap().friction_deg, 20.0);
                let warnings = loaded.warnings.iter().filter(|w| w.code == Code::Renamed).count();
                assert_eq!(warnings, usize::from(written == "joints") + usize::from(named == "joints"));
            }
        }
    }

    #[test]
    fn errors_below_an_old_key_are_at_their_place() {
        let text = scene("joints", &PAIR.replace("30", "95"));
        let errors = load_text("s.ron", &text, &[], None).unwrap_err();
        let error =
            errors.diagnostics.iter().find(|d| d.code == Code::OutOfRange).expect("an angle out of range");
        assert_eq!(&text[error.span.clone().unwrap()], "95");
    }

    #[test]
    fn a_field_of_another_struct_keeps_its_key() {
        let text = "(rock: [(joints: [])], contact: Off, joints: 1)";
        let tree = Node::of(text);
        assert_eq!(warnings(text, &tree, &[]), []);
        assert_eq!(current_segments("rock[0].joints[1].dip_deg"), ["rock", "0", "joints", "1", "dip_deg"]);
    }
}
