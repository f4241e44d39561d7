//! Tables of somebody else as CSV: how they are read, and what is wrong with one in words.

use csv::{ErrorKind, StringRecord};

/// A reader that takes spaces off cells and leaves out lines that begin with `#`.
pub(crate) fn reader(bytes: &[u8]) -> csv::Reader<&[u8]> {
    // Excel begins its files with a mark of their encoding.
    let bytes = bytes.strip_prefix("\u{feff}".as_bytes()).unwrap_or(bytes);
    csv::ReaderBuilder::new().trim(csv::Trim::All).comment(Some(b'#')).from_reader(bytes)
}

/// The place and the cure of what the reader refuses.
pub(crate) fn in_words(error: &csv::Error) -> String {
    let line = |position: &Option<csv::Position>| match position {
        Some(position) => format!("line {} ", position.line()),
        None => "it ".into(),
    };
    match error.kind() {
        ErrorKind::UnequalLengths { pos, expected_len, len } => format!(
            "{}has {len} value{}, and the first line names {expected_len} columns: write one value for each, separated by commas",
            line(pos),
            if *len == 1 { "" } else { "s" }
        ),
        ErrorKind::Utf8 { pos, .. } => {
            format!("{}is not UTF-8 text: save the table as CSV in UTF-8", line(pos))
        }
        ErrorKind::Deserialize { pos, err } => match (err.field(), err.kind()) {
            (_, csv::DeserializeErrorKind::Message(said)) => {
                said.replace("missing field", "there is no column")
            }
            (Some(field), _) => format!("{}has no number in column {}", line(pos), field + 1),
            (None, _) => format!("{}has a value that is not a number", line(pos)),
        },
        _ => error.to_string(),
    }
}

/// What is wrong with the line that names the columns: another separator, or a name that comes twice.
pub(crate) fn fault_of_header(header: &StringRecord) -> Option<String> {
    if header.len() == 1
        && let Some(mark) = [';', '\t'].into_iter().find(|mark| header[0].contains(*mark))
    {
        let name = if mark == ';' { "semicolons" } else { "tabulators" };
        return Some(format!(
            "its columns are separated by {name}: separate them by commas, and write decimals with a point"
        ));
    }
    let twice = |(place, name): &(usize, &str)| header.iter().take(*place).any(|earlier| earlier == *name);
    let (_, name) = header.iter().enumerate().find(twice)?;
    Some(format!("its first line names the column `{name}` twice: leave one out"))
}

/// Advice for a table that lacks its column of times but has one with a similar name, as `time_ms`; empty where it has none.
pub(crate) fn time_cure(header: &StringRecord, column: &str) -> String {
    let named = header.iter().find(|name| name.to_ascii_lowercase().starts_with("time"));
    named.map_or(String::new(), |name| {
        format!(": give times in seconds in a column `{column}` in place of `{name}`")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(text: &str) -> String {
        let mut reader = reader(text.as_bytes());
        if let Some(fault) = fault_of_header(reader.headers().unwrap()) {
            return fault;
        }
        reader.records().find_map(|row| row.err().map(|error| in_words(&error))).unwrap_or_default()
    }

    #[test]
    fn mistakes_of_tables_are_said_with_their_line_and_cure() {
        assert_eq!(
            of("a,b,c\n1,2,3\n4,5\n"),
            "line 3 has 2 values, and the first line names 3 columns: write one value for each, separated by commas"
        );
        assert!(of("a;b\n1;2\n").contains("separated by semicolons"));
        assert!(of("a\tb\n1\t2\n").contains("separated by tabulators"));
        assert!(of("a,b,a\n").contains("names the column `a` twice"));
        assert_eq!(of("\u{feff}a,b\n1,2\n# said,by,whom\n"), "");
    }

    #[test]
    fn text_in_another_encoding_is_refused_with_its_line() {
        let error = reader(b"a,b\n1,2\n\xe4,3\n").records().find_map(Result::err).unwrap();
        assert_eq!(in_words(&error), "line 3 is not UTF-8 text: save the table as CSV in UTF-8");
    }
}
