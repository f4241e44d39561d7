//! Scenes damaged in values, words and bytes: each is read and checked, or refused with a message; none panics.
//!
//! `NDDA_SCENES=1000000 cargo test --release -p ndda-io --test damaged_scenes` tries a million.

use std::fs;
use std::ops::Range;
use std::sync::LazyLock;

use ndda_io::locate::Node;
use ndda_io::read::load_text;
use proptest::prelude::*;
use proptest::sample::Index;

/// A unit of each kind of quantity, and a second one of some.
const UNITS: [&str; 20] = [
    "TonnePerCubicMetre",
    "KilojoulePerSquareMetre",
    "MeganewtonPerSquareMetre",
    "SquareCentimetre",
    "StandardGravity",
    "RevolutionsPerMinute",
    "DegreesPerSecond",
    "PerMinute",
    "KilometrePerHour",
    "KilopascalPerMetre",
    "GiganewtonPerMetre",
    "CubicDecimetre",
    "Degrees",
    "Radians",
    "Gigapascal",
    "Millimetre",
    "Kilometre",
    "Kilonewton",
    "Millisecond",
    "Hour",
];

/// Sound scenes with the places of their values.
static SCENES: LazyLock<Vec<(String, Vec<Range<usize>>)>> = LazyLock::new(|| {
    let folders = ["../../scenes", "../ndda/templates", "tests"];
    let entries = folders.iter().flat_map(|folder| fs::read_dir(folder).unwrap());
    let mut files: Vec<_> = entries.map(|entry| entry.unwrap().path()).collect();
    files.retain(|file| file.extension().is_some_and(|extension| extension == "ron"));
    files.sort();
    let read = |file| {
        let text = fs::read_to_string(file).unwrap();
        let mut places = Vec::new();
        Node::of(&text).for_each_leaf(&mut |leaf| places.push(leaf.span.clone()));
        (text, places)
    };
    files.iter().map(read).collect()
});

/// Values that scenes do not expect.
const VALUES: [&str; 26] = [
    "NaN",
    "-NaN",
    "inf",
    "-inf",
    "1e400",
    "-1e400",
    "-0",
    "0",
    "-1",
    "1e308",
    "-1e308",
    "1e-320",
    "1.5",
    "4294967296",
    "18446744073709551616",
    "0x10",
    "1_000",
    "\"\"",
    "\"*\"",
    "\"../é\"",
    "()",
    "[]",
    "None",
    "Some(1)",
    "true",
    "'x'",
];

#[derive(Clone, Debug)]
enum Damage {
    /// Another value in place of one.
    Value(Index, Index),
    /// A value of the scene in place of another.
    Moved(Index, Index),
    /// A value in a unit, of its own or of another quantity.
    Unit(Index, Index),
    /// A value left out.
    Left(Index),
    /// A byte replaced, inserted or removed.
    Byte(Index, u8, u8),
    /// The rest cut off.
    Cut(Index),
}

fn damage() -> impl Strategy<Value = Damage> {
    prop_oneof![
        4 => any::<(Index, Index)>().prop_map(|(at, with)| Damage::Value(at, with)),
        3 => any::<(Index, Index)>().prop_map(|(at, with)| Damage::Moved(at, with)),
        2 => any::<(Index, Index)>().prop_map(|(at, unit)| Damage::Unit(at, unit)),
        1 => any::<Index>().prop_map(Damage::Left),
        4 => (any::<Index>(), any::<u8>(), 0u8..3).prop_map(|(at, byte, how)| Damage::Byte(at, byte, how)),
        1 => any::<Index>().prop_map(Damage::Cut),
    ]
}

/// One value replaced where the text still has that place.
fn put(text: &mut String, place: &Range<usize>, value: &str) {
    if text.is_char_boundary(place.start) && text.is_char_boundary(place.end) && place.end <= text.len() {
        text.replace_range(place.clone(), value);
    }
}

fn damaged(scene: &str, places: &[Range<usize>], damages: &[Damage]) -> String {
    let mut text = scene.to_string();
    for damage in damages {
        match damage {
            Damage::Value(at, with) => put(&mut text, at.get(places), with.get::<&str>(&VALUES)),
            Damage::Moved(at, from) => put(&mut text, at.get(places), &scene[from.get(places).clone()]),
            Damage::Unit(at, unit) => {
                let place = at.get(places);
                let name = unit.get(&UNITS);
                put(&mut text, place, &format!("{name}({})", &scene[place.clone()]));
            }
            Damage::Left(at) => put(&mut text, at.get(places), ""),
            Damage::Byte(at, byte, how) => {
                let mut bytes = std::mem::take(&mut text).into_bytes();
                let at = at.index(bytes.len().max(1));
                match how {
                    0 if at < bytes.len() => bytes[at] = *byte,
                    1 if at < bytes.len() => drop(bytes.remove(at)),
                    _ => bytes.insert(at.min(bytes.len()), *byte),
                }
                text = String::from_utf8_lossy(&bytes).into_owned();
            }
            Damage::Cut(at) => {
                let mut end = at.index(text.len() + 1);
                while !text.is_char_boundary(end) {
                    end -= 1;
                }
                text.truncate(end);
            }
        }
    }
    text
}

fn cases() -> u32 {
    std::env::var("NDDA_SCENES").map_or(500, |number| number.parse().expect("NDDA_SCENES is a number"))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(), failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_damaged_scene_is_read_or_refused_with_a_message(
        scene in any::<Index>(),
        damages in prop::collection::vec(damage(), 1..5),
    ) {
        let (scene, places) = scene.get(&SCENES);
        let text = damaged(scene, places, &damages);
        match load_text("s.ron", &text, &[], None) {
            Ok(loaded) => loaded.errors(loaded.warnings.clone()).to_string(),
            Err(errors) => {
                prop_assert!(!errors.diagnostics.is_empty());
                errors.to_string()
            }
        };
    }
}

#[test]
fn there_are_scenes_to_damage() {
    assert!(SCENES.len() > 20);
    for (text, _) in SCENES.iter() {
        load_text("s.ron", text, &[], None).unwrap_or_else(|errors| panic!("{errors}"));
    }
}
