//! A certificate in words and columns.

use std::fmt::Write as _;

use super::certificate::{Certificate, Certified};
use super::extrapolate::Behaviour;
use super::quantities::{BLOCK, named};
use crate::columns::columns;
use crate::numbers::counted;
use crate::summary::LabelWord;

/// Blocks that are shown, those of the largest relative errors, unless others are asked for.
const MOST_BLOCKS: usize = 3;
/// Place of the run of the shortest step, after those of the scene's own step and of half of it.
const SHORTEST: usize = 2;
/// Rows that are shown.
pub const MOST_ROWS: usize = 60;

/// The certificate as text.
pub fn text(certificate: &Certificate, of: &[String]) -> String {
    let mut text = format!("{}: {}\n", certificate.scene, certificate.title);
    for (place, run) in certificate.runs.iter().enumerate() {
        let time = run.processor_s.map_or(String::new(), |s| format!(", {s:.2} s of processor time"));
        let (name, steps, step_s) = (&run.name, run.steps, run.step_s);
        let _ = writeln!(
            text,
            "{name}: {steps} steps of {step_s:e} s in {:.2} s{time}; {}",
            run.wall_s,
            label(certificate, place)
        );
    }
    let (shown, left_out) = shown(certificate, of);
    let header = ["quantity", "value ± error", "largest error", "error at scene's step", "behaviour"];
    let rows = shown.iter().map(|quantity| row(quantity)).collect();
    let _ = writeln!(text, "{}", columns(header.map(String::from).to_vec(), rows));
    if left_out > 0 {
        let _ = writeln!(
            text,
            "{} in certificate.json; --of NAME shows those whose names begin so",
            counted(left_out, "more quantity is", "more quantities are")
        );
    }
    let _ = writeln!(text, "estimated: {}", certificate.estimates);
    if let Some(exact) = &certificate.closed_form {
        let (kind, end, max) = (&exact.kind, exact.error_end, exact.error_max);
        let _ = writeln!(text, "against the closed form {kind}: {end:.2e} at the end, {max:.2e} at most");
    }
    certificate.remarks.iter().for_each(|remark| {
        let _ = writeln!(text, "note: {remark}");
    });
    let _ = writeln!(text, "time spent: {:.2} s in {} runs", certificate.wall_s, certificate.runs.len());
    text
}

/// The label of a run; where it is accurate and error bars of the run say that it may not be, with their number.
fn label(certificate: &Certificate, place: usize) -> String {
    let label = &certificate.runs[place].label;
    // The runs of finer meshes, of stiffer contact and of the twin have no bars of their own.
    let is_wide = |quantity: &&Certified| quantity.is_wide(place < SHORTEST);
    let wide = certificate.quantities.iter().filter(is_wide).count();
    if place > SHORTEST || wide == 0 || *label != LabelWord::Accurate.as_str() {
        return label.clone();
    }
    let (all, bars) =
        (certificate.quantities.len(), if wide == 1 { "error bar is" } else { "error bars are" });
    format!("{label} by its checks, but {wide} of {all} {bars} larger than 1 % of the largest value")
}

/// The quantities that are shown, and how many are not.
pub fn shown<'a>(certificate: &'a Certificate, of: &[String]) -> (Vec<&'a Certified>, usize) {
    let all = &certificate.quantities;
    let worst = worst_blocks(all);
    let is_shown = |quantity: &&Certified| match block_of(&quantity.name) {
        _ if of.iter().any(|wanted| named(&quantity.name, wanted)) => true,
        _ if vanishes(certificate, quantity) => false,
        Some(block) => worst.contains(&block),
        None => true,
    };
    let shown: Vec<&Certified> = all.iter().filter(is_shown).take(MOST_ROWS).collect();
    let left_out = all.len() - shown.len();
    (shown, left_out)
}

/// Whether a quantity is a component of a vector that vanishes beside the others: what is left of it is rounding.
pub fn vanishes(certificate: &Certificate, quantity: &Certified) -> bool {
    /// A component below this part of the largest of its vector vanishes.
    const NOTHING: f64 = 1e-8;
    if quantity.value.abs() > quantity.error {
        return false;
    }
    if quantity.behaviour == Behaviour::Rounding {
        return true;
    }
    let Some((vector, _)) = ["_x_", "_y_", "_z_"].iter().find_map(|axis| quantity.name.split_once(axis))
    else {
        return false;
    };
    let others = certificate.quantities.iter().filter(|other| other.name.starts_with(vector));
    let largest = others.map(|other| other.value.abs() + other.largest_error).fold(0.0, f64::max);
    quantity.largest_error < NOTHING * largest
}

/// The block that a quantity belongs to.
fn block_of(name: &str) -> Option<&str> {
    name.rsplit_once('.')?.0.strip_prefix(BLOCK)
}

/// Blocks of the largest errors, all if they are few.
fn worst_blocks(all: &[Certified]) -> Vec<&str> {
    let mut blocks: Vec<(&str, f64)> = Vec::new();
    for quantity in all.iter().filter(|quantity| quantity.unit == "m") {
        let Some(block) = block_of(&quantity.name) else { continue };
        match blocks.iter_mut().find(|(name, _)| *name == block) {
            Some((_, error)) => *error = error.max(quantity.error),
            None => blocks.push((block, quantity.error)),
        }
    }
    blocks.sort_by(|a, b| b.1.total_cmp(&a.1));
    blocks.into_iter().take(MOST_BLOCKS).map(|(name, _)| name).collect()
}

fn row(quantity: &Certified) -> Vec<String> {
    let order = quantity.order.map_or(String::new(), |order| format!(", order {order:.1}"));
    let behaviour = format!("{}{order}", quantity.behaviour.word());
    let errors = [quantity.largest_error, quantity.own_error].map(|error| format!("{error:.1e}"));
    let [largest, own] = errors;
    let value = format!("{} {}", with_error(quantity.value, quantity.error), quantity.unit);
    vec![quantity.name.clone(), value, largest, own, behaviour]
}

/// A value with as many digits as its error lets it have: `0.86621 ± 1.2e-5`.
pub fn with_error(value: f64, error: f64) -> String {
    let bar = format!("{error:.1e}");
    if error <= 0.0 {
        return format!("{value} ± 0");
    }
    // Digits up to the second of the error, of which a double has 17.
    let power = |x: f64| x.abs().max(f64::MIN_POSITIVE).log10().floor();
    let digits = (power(value) - power(error) + 1.0).clamp(0.0, 16.0) as usize;
    if (1e-3..1e6).contains(&value.abs()) {
        let decimals = (1.0 - power(error)).clamp(0.0, 16.0) as usize;
        format!("{value:.decimals$} ± {bar}")
    } else {
        format!("{value:.digits$e} ± {bar}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_have_the_digits_that_their_error_leaves() {
        for (value, error, text) in [
            (0.866_208_9, 1.2e-5, "0.866209 ± 1.2e-5"),
            (-3.25e-5, 1e-7, "-3.250e-5 ± 1.0e-7"),
            (1234.5, 20.0, "1234 ± 2.0e1"),
            (0.0, 1e-9, "0e0 ± 1.0e-9"),
            (2.0, 0.0, "2 ± 0"),
            (1e-12, 1e-3, "1e-12 ± 1.0e-3"),
        ] {
            assert_eq!(with_error(value, error), text);
        }
    }

    #[test]
    fn quantities_are_asked_for_by_their_beginnings() {
        assert!(named("block cube.displacement_x_m", "cube") && named("kinetic_j", "kin"));
        assert!(!named("block cube.displacement_x_m", "displacement"));
    }
}
