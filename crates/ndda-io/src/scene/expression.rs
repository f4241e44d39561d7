//! Arithmetic in a scene: `Calc(90 - dip_deg)`.
//!
//! A parser of operator precedence (Pratt 1973, "Top down operator precedence", POPL '73) that computes as it reads, so that
//! every mistake, a division by zero too, has the place of the part of the expression that makes it.

use std::ops::Range;

use ndda_mesh::cut::sin_cos;

use crate::scene::suggest::suggest;

/// Brackets, signs and powers inside one another; more than this is no expression that a person writes.
const DEEPEST: usize = 50;

/// The functions; angles are in degrees.
pub(crate) const FUNCTIONS: [&str; 11] =
    ["sin", "cos", "tan", "asin", "acos", "atan", "atan2", "sqrt", "abs", "min", "max"];

/// Why an expression has no value.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Mistake {
    /// Bytes of the expression that it is about.
    pub at: Range<usize>,
    /// The problem.
    pub message: String,
    /// The remedy.
    pub help: String,
}

/// Value of an expression with the parameters that `value_of` knows; `names` are theirs.
///
/// # Errors
/// [`Mistake`] of the first thing that cannot be read or computed.
pub(crate) fn evaluate(
    text: &str,
    names: &[&str],
    value_of: &dyn Fn(&str) -> Option<f64>,
) -> Result<f64, Mistake> {
    let mut parser = Parser { text, at: 0, depth: 0, names, value_of };
    let value = parser.expression(0)?;
    parser.skip_blank();
    match parser.rest().chars().next() {
        None => Ok(value),
        Some(c) => {
            let at = parser.at..parser.at + c.len_utf8();
            Err(mistake(at, format!("`{c}` is not an operator"), "the operators are + - * / ^"))
        }
    }
}

fn mistake(at: Range<usize>, message: impl Into<String>, help: impl Into<String>) -> Mistake {
    Mistake { at, message: message.into(), help: help.into() }
}

struct Parser<'a> {
    text: &'a str,
    at: usize,
    depth: usize,
    names: &'a [&'a str],
    value_of: &'a dyn Fn(&str) -> Option<f64>,
}

impl<'a> Parser<'a> {
    fn rest(&self) -> &'a str {
        &self.text[self.at..]
    }

    /// Skips white space and comments.
    fn skip_blank(&mut self) {
        loop {
            let rest = self.rest().trim_start();
            self.at = self.text.len() - rest.len();
            if rest.starts_with("//") {
                self.at += rest.find('\n').unwrap_or(rest.len());
            } else if rest.starts_with("/*") {
                self.at += rest.find("*/").map_or(rest.len(), |end| end + 2);
            } else {
                return;
            }
        }
    }

    /// Passes a character if it is next.
    fn take(&mut self, c: char) -> bool {
        self.skip_blank();
        let there = self.rest().starts_with(c);
        self.at += if there { c.len_utf8() } else { 0 };
        there
    }

    /// An expression of operators that bind more than `least`: 1 for + and −, 2 for * and /, 3 for a sign, 4 for ^.
    fn expression(&mut self, least: u8) -> Result<f64, Mistake> {
        self.skip_blank();
        let start = self.at;
        self.depth += 1;
        if self.depth > DEEPEST {
            let help = "name a part of it as a parameter of its own";
            return Err(mistake(start..self.text.len(), format!("is nested deeper than {DEEPEST}"), help));
        }
        let mut left = self.operand()?;
        loop {
            self.skip_blank();
            let (operator, binds) = match self.rest().chars().next() {
                Some(c @ ('+' | '-')) => (c, 1),
                Some(c @ ('*' | '/')) => (c, 2),
                Some('^') => ('^', 4),
                _ => break,
            };
            if binds <= least {
                break;
            }
            self.at += 1;
            // Powers are taken from the right, 2^3^2 = 2^9; the rest from the left.
            let right = self.expression(if operator == '^' { binds - 1 } else { binds })?;
            left = self.apply(left, operator, right, start)?;
        }
        self.depth -= 1;
        Ok(left)
    }

    fn apply(&self, left: f64, operator: char, right: f64, start: usize) -> Result<f64, Mistake> {
        if operator == '/' && right == 0.0 {
            let message = format!("`{}` divides by zero", &self.text[start..self.at]);
            return Err(mistake(start..self.at, message, "change the value of what it is divided by"));
        }
        let value = match operator {
            '+' => left + right,
            '-' => left - right,
            '*' => left * right,
            '/' => left / right,
            _ => left.powf(right),
        };
        self.finite(value, start)
    }

    fn finite(&self, value: f64, start: usize) -> Result<f64, Mistake> {
        if value.is_finite() {
            return Ok(value);
        }
        let message = format!("`{}` is not a finite number", &self.text[start..self.at]);
        Err(mistake(start..self.at, message, "numbers are real, and at most 1.8e308 in size"))
    }

    /// A number, a name, a call, a bracket, or one of these with a sign.
    fn operand(&mut self) -> Result<f64, Mistake> {
        self.skip_blank();
        let start = self.at;
        match self.rest().chars().next() {
            Some('-') => {
                self.at += 1;
                Ok(-self.expression(3)?)
            }
            Some('+') => {
                self.at += 1;
                self.expression(3)
            }
            Some('(') => {
                self.at += 1;
                let value = self.expression(0)?;
                self.close(start)?;
                Ok(value)
            }
            Some(c) if c.is_ascii_digit() || c == '.' => self.number(),
            Some(c) if c.is_alphabetic() || c == '_' => self.name(),
            other => {
                let end = start + other.map_or(0, char::len_utf8);
                let found = other.map_or("the end".to_string(), |c| format!("`{c}`"));
                let help = "write a number, the name of a parameter, or a bracket";
                Err(mistake(start..end, format!("expected a number, found {found}"), help))
            }
        }
    }

    fn close(&mut self, start: usize) -> Result<(), Mistake> {
        match self.take(')') {
            true => Ok(()),
            false => {
                let found = self.rest().chars().next().map_or("the end".into(), |c| format!("`{c}`"));
                let message = format!("expected an operator or `)`, found {found}");
                Err(mistake(start.max(self.at)..self.at, message, "the operators are + - * / ^"))
            }
        }
    }

    fn number(&mut self) -> Result<f64, Mistake> {
        let (start, bytes) = (self.at, self.text.as_bytes());
        let is_digit = |i: usize| bytes.get(i).is_some_and(|b| b.is_ascii_digit() || b"._".contains(b));
        let mut end = start;
        while is_digit(end) {
            end += 1;
        }
        let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
        if matches!(bytes.get(end), Some(b'e' | b'E')) && is_digit(end + 1 + sign) {
            end += 1 + sign;
            while is_digit(end) {
                end += 1;
            }
        }
        self.at = end;
        let digits = self.text[start..end].replace('_', "");
        let value = digits.parse().map_err(|_| {
            mistake(start..end, format!("`{digits}` is not a number"), "write it as 1.5 or 20e9")
        })?;
        self.finite(value, start)
    }

    /// π, a parameter, or the call of a function.
    fn name(&mut self) -> Result<f64, Mistake> {
        let start = self.at;
        let rest = self.rest();
        self.at += rest.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(rest.len());
        let (name, at) = (&self.text[start..self.at], start..self.at);
        if self.take('(') {
            return self.call(name, at);
        }
        if let Some(value) = (self.value_of)(name) {
            return Ok(value);
        }
        if name == "pi" {
            return Ok(std::f64::consts::PI);
        }
        if FUNCTIONS.contains(&name) {
            return Err(mistake(at, format!("`{name}` is a function"), format!("write {name}(…)")));
        }
        let known = [self.names, &["pi"]].concat();
        Err(mistake(at, format!("there is no parameter `{name}`"), suggest(name, &known)))
    }

    fn call(&mut self, name: &str, at: Range<usize>) -> Result<f64, Mistake> {
        if !FUNCTIONS.contains(&name) {
            return Err(mistake(at, format!("there is no function `{name}`"), suggest(name, &FUNCTIONS)));
        }
        let mut values = vec![self.expression(0)?];
        while self.take(',') {
            values.push(self.expression(0)?);
        }
        self.close(at.start)?;
        let (takes, is_right) = match name {
            "min" | "max" => ("at least two values", values.len() > 1),
            "atan2" => ("two values, y and x", values.len() == 2),
            _ => ("one value", values.len() == 1),
        };
        if !is_right {
            return Err(mistake(
                at.start..self.at,
                format!("`{name}` takes {takes}"),
                format!("there are {}", values.len()),
            ));
        }
        let x = values[0];
        let value = match name {
            "sin" => sin_cos(x).0,
            "cos" => sin_cos(x).1,
            "tan" => sin_cos(x).0 / sin_cos(x).1,
            "asin" => x.asin().to_degrees(),
            "acos" => x.acos().to_degrees(),
            "atan" => x.atan().to_degrees(),
            "atan2" => x.atan2(values[1]).to_degrees(),
            "sqrt" => x.sqrt(),
            "abs" => x.abs(),
            "min" => values.iter().copied().fold(f64::INFINITY, f64::min),
            _ => values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        };
        self.finite(value, at.start)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn value(text: &str) -> Result<f64, Mistake> {
        let value_of = |name: &str| match name {
            "dip_deg" => Some(30.0),
            "height_m" => Some(10.0),
            "zero" => Some(0.0),
            _ => None,
        };
        evaluate(text, &["dip_deg", "height_m", "zero"], &value_of)
    }

    #[test]
    fn operators_bind_as_in_mathematics() {
        for (text, expected) in [
            ("90 - dip_deg", 60.0),
            ("1 + 2 * 3 - 4 / 8", 6.5),
            ("8 - 4 - 2", 2.0),
            ("16 / 4 / 2", 2.0),
            ("2 ^ 3 ^ 2", 512.0),
            ("-2 ^ 2", -4.0),
            ("2 ^ -1", 0.5),
            ("2 * -3", -6.0),
            ("-(height_m + 1) * 2", -22.0),
            ("2e3 + 1_000 + .5", 3000.5),
            ("1e-3*1E3", 1.0),
            ("(1 + /* a comment */ 2) // another\n * 3", 9.0),
        ] {
            assert_eq!(value(text), Ok(expected), "{text}");
        }
    }

    #[test]
    fn functions_take_degrees_and_are_exact_at_right_angles() {
        for (text, expected) in [
            ("sin(180)", 0.0),
            ("cos(90)", 0.0),
            ("cos(-180)", -1.0),
            ("sin(450)", 1.0),
            ("max(1, height_m, 3)", 10.0),
            ("min(2, -abs(-3))", -3.0),
            ("sqrt(height_m * 10)", 10.0),
        ] {
            assert_eq!(value(text), Ok(expected), "{text}");
        }
        for angle in (-720..720).step_by(7).map(f64::from) {
            let [sin, cos] = ["sin", "cos"].map(|f| value(&format!("{f}({angle})")).unwrap());
            assert!((sin - angle.to_radians().sin()).abs() < 1e-14, "{angle}");
            assert!((cos - angle.to_radians().cos()).abs() < 1e-14, "{angle}");
        }
        for (text, expected) in [
            ("atan(tan(dip_deg))", 30.0),
            ("asin(0.5) + acos(0.5)", 90.0),
            ("atan2(-1, -1)", -135.0),
            ("tan(45)", 1.0),
            ("pi", std::f64::consts::PI),
        ] {
            assert!((value(text).unwrap() - expected).abs() < 1e-13, "{text}");
        }
    }

    #[test]
    fn mistakes_have_their_place_and_a_remedy() {
        for (text, at, message, help) in [
            ("90 - dpi_deg", 5..12, "no parameter `dpi_deg`", "did you mean `dip_deg`"),
            ("1 / (zero * 2)", 0..14, "divides by zero", "change"),
            ("2 + sqrt(-1)", 4..12, "not a finite number", "real"),
            ("tan(90)", 0..7, "not a finite number", "real"),
            ("sine(3)", 0..4, "no function `sine`", "did you mean `sin`"),
            ("2 * sin", 4..7, "is a function", "sin(…)"),
            ("max(1)", 0..6, "at least two", "there are 1"),
            ("sin(1, 2)", 0..9, "one value", "there are 2"),
            ("atan2(1)", 0..8, "two values, y and x", "there are 1"),
            ("(1 + 2", 6..6, "found the end", "operators"),
            ("1 2", 2..3, "`2` is not an operator", "+ - * / ^"),
            ("1 +", 3..3, "found the end", "number"),
            ("1.2.3", 0..5, "is not a number", "1.5"),
            ("10 ^ 400", 0..8, "not a finite number", "1.8e308"),
        ] {
            let found = value(text).expect_err(text);
            assert_eq!(found.at, at, "{text}: {found:?}");
            assert!(found.message.contains(message) && found.help.contains(help), "{text}: {found:?}");
        }
        let deep = "-".repeat(100_000) + "1";
        assert!(value(&deep).unwrap_err().message.contains("nested"));
    }

    proptest! {
        #[test]
        fn no_text_panics(text in "\\PC{0,40}", sums in "[-+*/^()0-9a-z., e]{0,40}") {
            let _ = value(&text);
            let _ = value(&sums);
        }
    }
}
