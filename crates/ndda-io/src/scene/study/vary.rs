//! `--vary path=a,b,c` and `--vary "path=Normal(30, 2)"`: axes from a command line.

use ron::value::RawValue;

use super::{Axis, Distribution};
use crate::scene::code::Code;
use crate::scene::diagnostic::{Diagnostic, SceneErrors};
use crate::scene::locate;

impl Axis {
    /// The axes that a command line names; one whose last part of the path is that of another goes by its whole path.
    ///
    /// # Errors
    /// A text that is none of the two.
    pub fn from_words(texts: &[String]) -> Result<Vec<Self>, SceneErrors> {
        let mut axes = texts.iter().map(|text| axis(text)).collect::<Result<Vec<_>, _>>()?;
        let names: Vec<String> = axes.iter().map(|axis| axis.name().to_string()).collect();
        for axis in &mut axes {
            let shared = names.iter().filter(|name| *name == axis.name()).count() > 1;
            if let (true, Axis::Vary { path, name, .. } | Axis::Random { path, name, .. }) = (shared, axis) {
                *name = Some(path.clone());
            }
        }
        Ok(axes)
    }
}

fn axis(text: &str) -> Result<Axis, SceneErrors> {
    let refuse = |message: String, help: &str| SceneErrors {
        file: format!("--vary {text}"),
        text: String::new(),
        diagnostics: vec![Diagnostic::error(Code::Override, "", message, None).with_help(help)],
    };
    let help = "write --vary time.step_s=1e-3,5e-4 or --vary \"contact.friction.friction_deg=Normal(30, 2)\"";
    let (path, values) = text.split_once('=').ok_or_else(|| refuse("has no `=`".into(), help))?;
    let (path, values) = (path.trim().to_string(), values.trim());
    if locate::segments(&path).is_empty() || values.is_empty() {
        return Err(refuse("needs a path and values".into(), help));
    }
    if let Some(read) = Distribution::parse(values) {
        let distribution = read.map_err(|reason| {
            let form = Distribution::form_of(values).unwrap_or_default();
            refuse(reason, &format!("write --vary \"{path}={form}\", with numbers in place of the words"))
        })?;
        return Ok(Axis::Random { path, distribution, name: None });
    }
    if let Some(reason) = Distribution::misspelt(values) {
        return Err(refuse(reason, help));
    }
    let raw = |value: &str| {
        if value.trim().parse().is_ok_and(|number: f64| !number.is_finite()) {
            return Err(refuse(format!("`{}` is not a finite number", value.trim()), help));
        }
        locate::one_value(value.trim())
            .map_err(|reason| refuse(format!("`{}` {reason}", value.trim()), help))?;
        RawValue::from_boxed_ron(value.trim().into())
            .map_err(|error| refuse(format!("`{}` is not a value: {error}", value.trim()), help))
    };
    let values = split(values).into_iter().map(raw).collect::<Result<_, _>>()?;
    Ok(Axis::Vary { path, values, name: None })
}

/// Parts between commas that are in no bracket and no quotes.
fn split(text: &str) -> Vec<&str> {
    let (mut depth, mut quoted, mut from) = (0i64, false, 0);
    let mut parts = Vec::new();
    for (i, c) in text.char_indices() {
        match c {
            '"' => quoted = !quoted,
            _ if quoted => {}
            '(' | '[' | '{' => depth += 1,
            ')' | ']' | '}' => depth -= 1,
            ',' if depth == 0 => {
                parts.push(&text[from..i]);
                from = i + 1;
            }
            _ => {}
        }
    }
    parts.push(&text[from..]);
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(texts: &[&str]) -> Result<Vec<Axis>, String> {
        let texts: Vec<String> = texts.iter().map(|text| text.to_string()).collect();
        Axis::from_words(&texts).map_err(|errors| errors.render(false))
    }

    #[test]
    fn a_distribution_with_wrong_numbers_is_told_how_it_is_written() {
        let told = read(&["parameters.phi=Uniform(40,30)"]).unwrap_err();
        assert!(told.contains("the least value comes first"), "{told}");
        assert!(told.contains("--vary \"parameters.phi=Uniform(least, largest)\""), "{told}");
        assert!(!told.contains("time.step_s"), "{told}");
    }

    #[test]
    fn lists_and_distributions_become_axes() {
        let axes =
            read(&["time.integrator=Newmark(alpha: 0.5, delta: 1), Midpoint()", "a.phi=Normal(30, 2)"])
                .unwrap();
        let labels: Vec<String> = axes[0].choices().into_iter().map(|(label, _)| label).collect();
        assert_eq!(labels, ["Newmark(alpha: 0.5, delta: 1)", "Midpoint()"]);
        assert_eq!(axes[0].name(), "integrator");
        let random =
            Axis::Random { path: "a.phi".into(), distribution: Distribution::Normal(30.0, 2.0), name: None };
        assert_eq!(axes[1], random);
    }

    #[test]
    fn units_and_choices_are_values() {
        for text in ["a_m=Millimetre(1, 2, 3)", "a=Degrees(30),Degrees(2)", "a=Newmark(alpha: 0.5, delta: 1)"]
        {
            assert!(matches!(read(&[text]).unwrap()[0], Axis::Vary { .. }), "{text}");
        }
    }

    #[test]
    fn axes_of_one_name_go_by_their_paths() {
        let axes = read(&["a.phi=1,2", "b.phi=3"]).unwrap();
        assert_eq!([axes[0].name(), axes[1].name()], ["a.phi", "b.phi"]);
    }

    #[test]
    fn what_is_no_axis_is_refused_with_an_example() {
        for (text, word) in [
            ("time.step_s", "no `=`"),
            ("=3", "needs a path"),
            ("a=1,,2", "not a value"),
            ("a=Normal(3)", "Normal(mean"),
            ("a=(1", "`(` is not closed"),
            ("a=Norml(30, 2)", "did you mean `Normal`?"),
            ("a=normal(30, 2)", "did you mean `Normal`?"),
            ("a=Trianglar(1, 2, 3)", "did you mean `Triangular`?"),
            ("a=Gauss(30, 2)", "`Gauss` is not a distribution"),
        ] {
            let said = read(&[text]).unwrap_err();
            assert!(said.contains(word) && said.contains("--vary"), "{said}");
        }
    }
}
