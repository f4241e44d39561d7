//! The line of names above a table of points, which says in which columns x, y and the height are.

use crate::mesh::error::{Fault, FileProblem};
use crate::mesh::lines::{Line, Lines, parse, real};

/// Names of the columns of x, y and the height.
const NAMES: [&[&str]; 3] = [
    &["x", "e", "east", "easting", "rechtswert"],
    &["y", "n", "north", "northing", "hochwert"],
    &["z", "h", "height", "elev", "elevation", "alt", "altitude"],
];
/// Names of coordinates in degrees.
const DEGREES: [&str; 5] = ["lat", "latitude", "lon", "long", "longitude"];
/// Units after a name that are metres, and others that are known.
const METRES: [&str; 5] = ["m", "metre", "metres", "meter", "meters"];
const OTHERS: [&str; 10] = ["ft", "foot", "feet", "us-ft", "ftus", "mm", "cm", "km", "deg", "°"];
/// Advice of the error for names of columns that are not understood.
const CURE: &str = "name them x, y and z, or east(ing), north(ing) and h, height, elevation or altitude, with other names for other columns; \
                    of exactly three columns without such a name the order is x, y, z";

/// Where in a line x, y and the height are.
#[derive(Clone, Copy)]
pub(super) struct Columns {
    places: [usize; 3],
    count: usize,
    separator: Separator,
    /// Whether there are no others.
    are_all_known: bool,
}

/// Separator of columns.
#[derive(Clone, Copy, PartialEq)]
enum Separator {
    Byte(u8),
    /// White space or commas, any number of them.
    Any,
}

impl Columns {
    /// The columns of a table, and the number of the line that names them, before which there are only comments; none where no line does.
    pub(super) fn of(bytes: &[u8]) -> Result<Option<(Self, usize)>, Fault> {
        // A comment may hold names, too.
        for line in Lines::new(bytes, b'\n') {
            let Some(comment) = line.text.strip_prefix(b"#") else {
                let text = line.text.split(|byte| *byte == b'#').next().unwrap_or_default();
                let named = Self::named(text).map_err(|problem| Fault::at(line.number, problem))?;
                return Ok(named.map(|columns| (columns, line.number)));
            };
            let text = comment.rsplit(|byte| *byte == b':').next().unwrap_or_default();
            if let Ok(Some(columns)) = Self::named(text.trim_ascii())
                && columns.are_all_known
            {
                return Ok(Some((columns, line.number)));
            }
        }
        Ok(None)
    }

    /// The columns that a text names; none if it has numbers.
    fn named(text: &[u8]) -> Result<Option<Self>, FileProblem> {
        let separator = [b';', b',', b'\t'].into_iter().find(|byte| text.contains(byte));
        let separator = separator.map_or(Separator::Any, Separator::Byte);
        let names = split(text, separator);
        if names.iter().any(|name| parse::<f64>(name).is_some()) {
            return Ok(None);
        }
        let names: Vec<String> = names.into_iter().map(|name| String::from_utf8_lossy(name).into()).collect();
        let are_all_known = names.iter().all(|name| axis_of(name).is_some());
        Ok(Some(Self { places: places(&names)?, count: names.len(), separator, are_all_known }))
    }

    /// The point in a line of the table.
    pub(super) fn point(&self, line: &Line) -> Result<[f64; 3], Fault> {
        // Of three columns any separator is plain; of more, an empty one must keep its place.
        let mut fields = split(line.text, if self.count == 3 { Separator::Any } else { self.separator });
        while fields.len() > self.count && fields.last().is_some_and(|field| field.is_empty()) {
            fields.pop();
        }
        if fields.len() != self.count {
            let expected = format!("as many columns as the first line names, {}", self.count);
            return Err(Fault::unexpected(line.number, expected, fields.len().to_string().as_bytes()));
        }
        let mut point = [0.0; 3];
        for (value, place) in point.iter_mut().zip(self.places) {
            let field = fields[place];
            *value =
                real(field).ok_or_else(|| Fault::unexpected(line.number, "a coordinate, finite", field))?;
        }
        Ok(point)
    }
}

fn split(text: &[u8], separator: Separator) -> Vec<&[u8]> {
    match separator {
        Separator::Byte(byte) => text.split(|b| *b == byte).map(<[u8]>::trim_ascii).collect(),
        Separator::Any => {
            let separates = |b: &u8| b.is_ascii_whitespace() || matches!(*b, b',' | b';');
            text.split(separates).filter(|word| !word.is_empty()).collect()
        }
    }
}

/// Places of x, y and the height among names.
fn places(names: &[String]) -> Result<[usize; 3], FileProblem> {
    if let Some((name, unit)) = names.iter().find_map(|name| Some((name, wrong_unit(name)?))) {
        let what = format!("a column `{name}` in {unit}");
        return Err(FileProblem::NotRead { what, cure: "project or convert it to metres" });
    }
    let axes: Vec<Option<usize>> = names.iter().map(|name| axis_of(name)).collect();
    let mut places = [None; 3];
    for (place, axis) in axes.iter().enumerate() {
        let Some(axis) = *axis else { continue };
        if let Some(first) = places[axis].replace(place) {
            let what = format!("a table with both columns `{}` and `{}`", names[first], names[place]);
            return Err(FileProblem::NotRead { what, cure: "rename the one that is not meant" });
        }
    }
    if let [Some(x), Some(y), Some(z)] = places {
        return Ok([x, y, z]);
    }
    let in_order = axes.iter().enumerate().all(|(place, axis)| axis.is_none_or(|axis| axis == place));
    if names.len() == 3 && in_order {
        return Ok([0, 1, 2]);
    }
    let what = format!("a table of points whose columns are `{}`", names.join("`, `"));
    Err(FileProblem::NotRead { what, cure: CURE })
}

/// A name without quotes and the unit after it, both in small letters.
fn name_and_unit(name: &str) -> (String, String) {
    let name = name.trim_matches(['"', '\'', ' ']).to_lowercase();
    let end = name.find(|c: char| !c.is_alphabetic()).unwrap_or(name.len());
    let unit = name[end..].trim_matches(['_', ' ', '[', ']', '(', ')', '/']);
    (name[..end].into(), unit.into())
}

/// The axis that a name stands for: 0 for x, 1 for y, 2 for the height.
fn axis_of(name: &str) -> Option<usize> {
    let (name, unit) = name_and_unit(name);
    let is_known = unit.is_empty() || METRES.contains(&unit.as_str());
    NAMES.iter().position(|names| is_known && names.contains(&name.as_str()))
}

/// The unit of a coordinate that is not in metres.
fn wrong_unit(name: &str) -> Option<String> {
    let (name, unit) = name_and_unit(name);
    if DEGREES.contains(&name.as_str()) {
        return Some("degrees".into());
    }
    let is_axis = NAMES.iter().any(|names| names.contains(&name.as_str()));
    (is_axis && OTHERS.contains(&unit.as_str())).then_some(unit)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(text: &str) -> Result<[usize; 3], FileProblem> {
        places(&text.split(',').map(String::from).collect::<Vec<_>>())
    }

    #[test]
    fn names_of_any_case_with_quotes_and_metres_are_found_in_any_order() {
        for (text, places) in [
            ("north,east,height", [1, 0, 2]),
            ("Y,X,Z", [1, 0, 2]),
            ("id,\"Z [m]\",\"Easting\",\"Northing\",code", [2, 3, 1]),
            ("h_m,n_m,e_m", [2, 1, 0]),
            ("elevation (m),x,y,z_old", [1, 2, 0]),
            ("a,b,c", [0, 1, 2]),
            ("x,y,dsm", [0, 1, 2]),
        ] {
            assert_eq!(of(text), Ok(places), "{text}");
        }
    }

    #[test]
    fn names_that_leave_the_order_open_are_refused_with_a_cure() {
        for (text, part) in [
            ("y,x,dsm", "columns are `y`, `x`, `dsm` is not supported: name them x, y and z"),
            ("id,a,b,c", "name them"),
            ("x,y", "name them"),
            ("x,y,z,height", "both columns `z` and `height`"),
            ("lat,lon,height", "`lat` in degrees"),
            ("x,y,z [ft]", "`z [ft]` in ft"),
        ] {
            let message = of(text).unwrap_err().to_string();
            assert!(message.contains(part), "{text}: {message}");
        }
    }
}
