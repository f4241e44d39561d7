//! A table of numbers as Parquet: written, and read back.

use std::fs::File;
use std::io;
use std::path::Path;
use std::sync::Arc;

use parquet::basic::{Compression, Repetition, Type as Physical};
use parquet::column::reader::ColumnReader;
use parquet::data_type::DoubleType;
use parquet::errors::ParquetError;
use parquet::file::properties::WriterProperties;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;

use crate::atomic;
use crate::results::table::{Table, TableError};
use crate::write_error::WriteError;

/// Rows that are put into columns together.
const GROUP_ROWS: usize = 1 << 17;

/// Copies a table of numbers; each column is of doubles and has the name of the table's.
///
/// # Errors
/// [`WriteError::NotThatTable`] when the text is no table of numbers; [`WriteError::Io`] when it cannot be read or the
/// file not be written.
pub(crate) fn from_csv(csv: &Path, parquet: &Path) -> Result<(), WriteError> {
    let unread = |e: csv::Error| WriteError::io("read", csv)(io::Error::other(e));
    let mut table = csv::Reader::from_path(csv).map_err(unread)?;
    let names: Vec<String> = table.headers().map_err(unread)?.iter().map(String::from).collect();
    let encode = |e: ParquetError| WriteError::Encode { path: parquet.to_path_buf(), reason: e.to_string() };
    let mut file = Vec::new();
    let mut writer = SerializedFileWriter::new(&mut file, schema(&names).map_err(encode)?, properties())
        .map_err(encode)?;
    let mut columns = vec![Vec::new(); names.len()];
    for record in table.records() {
        for (column, text) in columns.iter_mut().zip(&record.map_err(unread)?) {
            let mismatch = |_| WriteError::NotThatTable {
                path: csv.to_path_buf(),
                what: format!("`{text}`, not a number"),
            };
            column.push(text.parse::<f64>().map_err(mismatch)?);
        }
        if columns[0].len() == GROUP_ROWS {
            add_group(&mut writer, &mut columns).map_err(encode)?;
        }
    }
    add_group(&mut writer, &mut columns).map_err(encode)?;
    writer.close().map_err(encode)?;
    atomic::write(parquet, &file)
}

/// Reads a table of numbers.
///
/// # Errors
/// [`TableError::Unreadable`] when the file cannot be read, or has a column that is not of doubles.
pub(crate) fn read(file: &Path) -> Result<Table, TableError> {
    let refuse = |reason: String| TableError::Unreadable { file: file.to_path_buf(), reason };
    let opened = File::open(file).map_err(|e| refuse(e.to_string()))?;
    read_columns(opened).map_err(|e| refuse(e.to_string()))
}

fn read_columns(file: File) -> Result<Table, ParquetError> {
    let reader = SerializedFileReader::new(file)?;
    let described = reader.metadata().file_metadata().schema_descr_ptr();
    let names: Vec<String> = described.columns().iter().map(|c| c.name().to_owned()).collect();
    let mut columns = vec![Vec::new(); names.len()];
    for group in 0..reader.num_row_groups() {
        let group = reader.get_row_group(group)?;
        let rows = usize::try_from(group.metadata().num_rows())?;
        for (k, column) in columns.iter_mut().enumerate() {
            let ColumnReader::DoubleColumnReader(mut numbers) = group.get_column_reader(k)? else {
                return Err(ParquetError::General(format!("column `{}` is not of doubles", names[k])));
            };
            numbers.read_records(rows, None, None, column)?;
        }
    }
    Ok(Table { names, columns })
}

fn schema(names: &[String]) -> Result<Arc<Type>, ParquetError> {
    let column = |name: &String| {
        let column =
            Type::primitive_type_builder(name, Physical::DOUBLE).with_repetition(Repetition::REQUIRED);
        column.build().map(Arc::new)
    };
    let columns = names.iter().map(column).collect::<Result<_, _>>()?;
    Type::group_type_builder("table").with_fields(columns).build().map(Arc::new)
}

fn properties() -> Arc<WriterProperties> {
    let made_by = concat!("ndda ", env!("CARGO_PKG_VERSION")).to_string();
    let plain = WriterProperties::builder().set_compression(Compression::UNCOMPRESSED);
    Arc::new(plain.set_created_by(made_by).build())
}

/// Writes rows as a group of their own, and makes room for more.
fn add_group(
    writer: &mut SerializedFileWriter<&mut Vec<u8>>,
    columns: &mut [Vec<f64>],
) -> Result<(), ParquetError> {
    let mut group = writer.next_row_group()?;
    for numbers in columns {
        let mut column =
            group.next_column()?.ok_or_else(|| ParquetError::General("too few columns".into()))?;
        column.typed::<DoubleType>().write_batch(numbers, None, None)?;
        column.close()?;
        numbers.clear();
    }
    group.close().map(drop)
}

#[cfg(test)]
mod tests {
    use std::fs;

    use parquet::record::Field;

    use super::*;

    #[test]
    fn a_table_has_the_same_names_and_bits_in_columns() {
        let folder = tempfile::tempdir().unwrap();
        let (csv, parquet) = (folder.path().join("a.csv"), folder.path().join("a.parquet"));
        let rows = [[0.0, 0.1 + 0.2], [1.0, -1e-300], [2.0, f64::MAX]];
        let lines: String = rows.iter().map(|[a, b]| format!("{a:?},{b:?}\n")).collect();
        fs::write(&csv, format!("time_s,\"block, left\"\n{lines}")).unwrap();
        from_csv(&csv, &parquet).unwrap();
        let columns = [0, 1].map(|k| rows.map(|row| row[k]).to_vec()).to_vec();
        let names = ["time_s", "block, left"].map(String::from).to_vec();
        assert_eq!(read(&parquet).unwrap(), Table { names, columns });
        let reader = SerializedFileReader::new(fs::File::open(&parquet).unwrap()).unwrap();
        let found: Vec<Vec<(String, Field)>> =
            reader.get_row_iter(None).unwrap().map(|row| row.unwrap().into_columns()).collect();
        let expected = rows.map(|[a, b]| {
            vec![("time_s".to_string(), Field::Double(a)), ("block, left".to_string(), Field::Double(b))]
        });
        assert_eq!(found, expected);
    }

    #[test]
    fn a_table_of_words_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let csv = folder.path().join("a.csv");
        fs::write(&csv, "time_s\nsoon\n").unwrap();
        let error = from_csv(&csv, &folder.path().join("a.parquet")).unwrap_err().to_string();
        assert!(error.contains("`soon`"), "{error}");
    }
}
