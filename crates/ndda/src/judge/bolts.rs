//! How bolts fared, in words.

use crate::numbers::{counted, length};
use crate::summary::BoltEnd;

/// How bolts fared, in a line; nothing where there are none.
pub(super) fn bolts(all: &[(String, BoltEnd)]) -> String {
    if all.is_empty() {
        return String::new();
    }
    let count = counted(all.len(), "bolt", "bolts");
    let told = |(state, fared): (&str, &str)| {
        let found: Vec<_> = all.iter().filter(|(_, end)| end.state == state).collect();
        let (first, _) = found.first()?;
        let others = if found.len() > 1 { ", …" } else { "" };
        Some(format!("{} of {count} {fared} (`{first}`{others})", found.len()))
    };
    let states = [("broken", "broke"), ("yielding", "yielded")];
    let mut told: Vec<_> = states.into_iter().filter_map(told).collect();
    told.extend(most(all, |end| end.plate_yielded_m).map(|(many, name, m)| {
        format!("{many} of {count} pulled a plate at its strength, by at most {} (`{name}`)", length(m))
    }));
    told.extend(most(all, |end| end.dowel_yielded_m).map(|(many, name, m)| {
        format!("{many} of {count} sheared a dowel at its capacity, by at most {} (`{name}`)", length(m))
    }));
    let debonded = |end: &BoltEnd| if end.state == "debonded" { end.debonded } else { 0.0 };
    told.extend(most(all, debonded).map(|(many, name, part)| {
        format!(
            "{many} of {count} slipped in the grout, over at most {:.0} % of the bonded length (`{name}`)",
            100.0 * part
        )
    }));
    if told.is_empty() { format!("{count} held, {}\n", load(all)) } else { format!("{}\n", told.join("; ")) }
}

/// How many bolts have something above zero, and which has most of it, and how much; nothing where none has.
fn most(all: &[(String, BoltEnd)], of: impl Fn(&BoltEnd) -> f64) -> Option<(usize, &str, f64)> {
    let some = || all.iter().map(|(name, end)| (name.as_str(), of(end))).filter(|(_, value)| *value > 0.0);
    let (name, value) = some().max_by(|a, b| a.1.total_cmp(&b.1))?;
    Some((some().count(), name, value))
}

/// What bolts bear that have held.
fn load(all: &[(String, BoltEnd)]) -> String {
    let largest = |of: fn(&BoltEnd) -> f64| all.iter().map(|(_, end)| of(end)).fold(0.0, f64::max);
    let used = largest(|end| end.utilisation);
    if used > 0.0 {
        return format!("with at most {:.0} % of the yield force", 100.0 * used);
    }
    let [tension_n, shear_n] = [largest(|end| end.axial_n), largest(|end| end.shear_n)];
    let shear =
        if shear_n > 0.0 { format!(" and a shear force of {:.1} kN", 1e-3 * shear_n) } else { String::new() };
    format!("with a tension of at most {:.1} kN{shear}", 1e-3 * tension_n)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bolts_that_broke_yielded_or_slipped_are_named_and_others_are_counted() {
        let end = |state: &str, utilisation: f64| BoltEnd {
            state: state.into(),
            utilisation,
            ..BoltEnd::default()
        };
        let mut all = vec![("a".to_string(), end("elastic", 0.2)), ("b".to_string(), end("elastic", 0.343))];
        assert_eq!(bolts(&[]), "");
        assert_eq!(bolts(&all), "2 bolts held, with at most 34 % of the yield force\n");
        all.extend([("c".into(), end("broken", 1.1)), ("d".into(), end("broken", 1.0))]);
        all.push(("e".into(), BoltEnd { debonded: 0.12, ..end("debonded", 0.1) }));
        let slipped = "1 of 5 bolts slipped in the grout, over at most 12 % of the bonded length (`e`)";
        assert_eq!(bolts(&all), format!("2 of 5 bolts broke (`c`, …); {slipped}\n"));
        let plate = BoltEnd { plate_yielded_m: 0.286, ..end("plate yielding", 0.15) };
        let dowel = BoltEnd { dowel_yielded_m: 0.0273, ..end("dowel yielding", 0.0) };
        let two = [("p".to_string(), plate), ("d".to_string(), dowel)];
        let pulled = "1 of 2 bolts pulled a plate at its strength, by at most 286 mm (`p`)";
        let sheared = "1 of 2 bolts sheared a dowel at its capacity, by at most 27.3 mm (`d`)";
        assert_eq!(bolts(&two), format!("{pulled}; {sheared}\n"));
    }

    #[test]
    fn bolts_without_a_yield_force_are_told_by_what_they_bear() {
        let end = BoltEnd { axial_n: 30e3, shear_n: 2e3, state: "elastic".into(), ..BoltEnd::default() };
        let all = [("a".to_string(), end)];
        assert_eq!(
            bolts(&all),
            "1 bolt held, with a tension of at most 30.0 kN and a shear force of 2.0 kN\n"
        );
    }
}
