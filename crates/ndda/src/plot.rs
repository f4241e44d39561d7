//! Columns of histories over time, or over each other.

use std::path::{Path, PathBuf};

use ndda_io::table::{Table, TableError};
use ndda_io::{OutputFolder, WriteError};
use plotters::coord::ranged1d::{AsRangedCoord, Ranged, ValueFormatter};
use plotters::prelude::*;
use serde::Serialize;

use crate::numbers::split_unit;
use crate::picture::{self, Area, Drawn, colour, log_axis, log_range, range, short};

/// Width and height of the picture [px].
pub(crate) const SIZE: (u32, u32) = (1160, 600);
/// Width of the part of it that shows colours [px].
const KEY: u32 = 230;

/// One line of a picture.
pub(crate) struct Line {
    /// Name in the legend.
    pub(crate) name: String,
    /// Its points.
    pub(crate) points: Vec<(f64, f64)>,
}

/// Why nothing is drawn.
#[derive(Debug, thiserror::Error)]
pub enum PlotError {
    /// A history cannot be read.
    #[error("{0}")]
    Table(#[from] TableError),
    /// No such column, or several of them.
    #[error("{}: {reason}; choose one of {}", file.display(), names.join(", "))]
    Column {
        /// The history.
        file: PathBuf,
        /// The problem.
        reason: String,
        /// The columns that it has, or those of them that are meant.
        names: Vec<String>,
    },
    /// There is no curve to draw.
    #[error("nothing to draw: no value is finite{0}")]
    Empty(&'static str),
    /// The picture cannot be written.
    #[error("{0}")]
    Write(#[from] WriteError),
}

impl PlotError {
    /// Why the picture cannot be written, if that is it.
    pub fn of_file(&self) -> Option<&WriteError> {
        if let Self::Write(error) = self { Some(error) } else { None }
    }
}

/// A picture to draw.
#[derive(Clone, Debug)]
pub struct Plot {
    /// Output folders of runs, or history files; several are drawn over each other.
    pub inputs: Vec<PathBuf>,
    /// Columns, by name or its beginning.
    pub columns: Vec<String>,
    /// Column to draw against.
    pub against: String,
    /// Logarithms of values; what is not above zero is left out.
    pub log: bool,
}

/// The columns of a history.
#[derive(Debug, Serialize)]
pub struct Columns {
    /// The history.
    pub file: PathBuf,
    /// Names.
    pub columns: Vec<String>,
}

/// The columns that there are to draw in the histories of runs.
///
/// # Errors
/// [`PlotError::Table`] when one cannot be read.
pub fn columns(inputs: &[PathBuf]) -> Result<Vec<Columns>, PlotError> {
    let columns = |input: &PathBuf| -> Result<Columns, PlotError> {
        let file = history(input);
        Ok(Columns { columns: Table::read(&file)?.names, file })
    };
    inputs.iter().map(columns).collect()
}

/// Draws columns to an SVG or PNG file.
///
/// # Errors
/// [`PlotError`].
pub fn plot(plot: &Plot, out: &Path) -> Result<(), PlotError> {
    let files: Vec<PathBuf> = plot.inputs.iter().map(|input| history(input)).collect();
    let tables = files.iter().map(|file| Table::read(file)).collect::<Result<Vec<_>, _>>()?;
    let mut lines = Vec::new();
    let (mut names, mut against) = (Vec::new(), String::new());
    for ((file, table), input) in files.iter().zip(&tables).zip(&plot.inputs) {
        let place = |name: &str| {
            let lost = |(reason, names)| PlotError::Column { file: file.clone(), reason, names };
            find(table, name).map_err(lost)
        };
        let x = place(&plot.against)?;
        against.clone_from(&table.names[x]);
        for column in &plot.columns {
            let y = place(column)?;
            names.push(table.names[y].clone());
            let run = if tables.len() > 1 { format!("{}: ", label(input)) } else { String::new() };
            let points = table.columns[x].iter().copied().zip(table.columns[y].iter().copied());
            lines.push(Line { name: format!("{run}{}", table.names[y]), points: points.collect() });
        }
    }
    if !lines.iter().flat_map(|line| &line.points).any(|(x, y)| drawable(*x, *y, plot.log)) {
        return Err(PlotError::Empty(if plot.log { " and above zero" } else { "" }));
    }
    let axes = [axis_title(&[against]), axis_title(&names)];
    Ok(picture::write(out, SIZE, |root| draw(root, &lines, &axes, plot.log))?)
}

/// The history of a run's folder, or the file itself.
fn history(input: &Path) -> PathBuf {
    if !input.is_dir() {
        return input.to_path_buf();
    }
    OutputFolder::history_in(input).unwrap_or_else(|| input.join(OutputFolder::HISTORY))
}

/// Name of a run in the legend.
fn label(input: &Path) -> String {
    let named = if input.is_dir() { input } else { input.parent().unwrap_or(input) };
    named.file_name().unwrap_or(named.as_os_str()).to_string_lossy().into_owned()
}

/// The column called `name`, or the only one whose name begins so.
fn find(table: &Table, name: &str) -> Result<usize, (String, Vec<String>)> {
    if let Some(exact) = table.names.iter().position(|known| known == name) {
        return Ok(exact);
    }
    let begins: Vec<usize> = (0..table.names.len()).filter(|i| table.names[*i].starts_with(name)).collect();
    match begins[..] {
        [only] => Ok(only),
        [] => Err((format!("no column begins with `{name}`"), table.names.clone())),
        _ => {
            let those = begins.iter().map(|&i| table.names[i].clone()).collect();
            Err((format!("more than one column begins with `{name}`"), those))
        }
    }
}

/// Title of an axis: the one name that all share, and the unit that all share.
fn axis_title(names: &[String]) -> String {
    let (bare, first) = split_unit(&names[0]);
    let is_shared = !first.is_empty() && names.iter().all(|name| split_unit(name).1 == first);
    let name = if names.iter().all(|name| *name == names[0]) { bare } else { "" };
    let unit = if is_shared { format!("[{first}]") } else { String::new() };
    format!("{} {unit}", name.replace('_', " ")).trim().to_string()
}

/// Lines in one frame with titles of its axes, and a key beside it.
pub(crate) fn draw(root: &Area, lines: &[Line], axes: &[String; 2], log: bool) -> Drawn {
    let (frame, key) = root.split_horizontally(SIZE.0 - KEY);
    let entry = |(i, line): (usize, &Line)| (line.name.clone(), colour(i), 2);
    picture::key(&key, &lines.iter().enumerate().map(entry).collect::<Vec<_>>())?;
    let points = || lines.iter().flat_map(|line| line.points.iter().copied());
    let (x, y) = (range(points().map(|p| p.0)), || points().map(|p| p.1));
    match log {
        true => chart(&frame, lines, axes, x, log_axis(log_range(y())), log),
        false => chart(&frame, lines, axes, x, range(y()), log),
    }
}

/// Lines in one frame; the vertical axis is plain or logarithmic.
fn chart<Y>(
    root: &Area,
    lines: &[Line],
    [x_title, y_title]: &[String; 2],
    x: std::ops::Range<f64>,
    y: Y,
    log: bool,
) -> Drawn
where
    Y: AsRangedCoord<Value = f64>,
    Y::CoordDescType: Ranged<ValueType = f64> + ValueFormatter<f64>,
{
    // Labels of zero are what rounding leaves of it.
    let small = 1e-9 * lines.iter().flat_map(|line| &line.points).map(|p| p.1.abs()).fold(0.0, f64::max);
    let mut chart = ChartBuilder::on(root)
        .margin(16)
        .x_label_area_size(46)
        .y_label_area_size(84)
        .build_cartesian_2d(x, y)?;
    chart
        .configure_mesh()
        .light_line_style(WHITE)
        .bold_line_style(RGBColor(225, 225, 225))
        .x_labels(8)
        .y_labels(8)
        .x_desc(x_title.as_str())
        .y_desc(y_title.as_str())
        .label_style(("sans-serif", 14))
        .axis_desc_style(("sans-serif", 16))
        .x_label_formatter(&|x| short(*x))
        .y_label_formatter(&|y| short(if !log && y.abs() < small { 0.0 } else { *y }))
        .draw()?;
    for (i, line) in lines.iter().enumerate() {
        // Values without a logarithm leave a gap.
        for part in line.points.split(|(x, y)| !drawable(*x, *y, log)) {
            chart.draw_series(LineSeries::new(part.iter().copied(), colour(i).stroke_width(2)))?;
        }
    }
    Ok(())
}

fn drawable(x: f64, y: f64, log: bool) -> bool {
    x.is_finite() && y.is_finite() && (!log || y > 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_go_by_their_beginning_if_only_one_begins_so() {
        let names = ["time_s", "kinetic_j", "momentum_x_kg_m_s", "momentum_y_kg_m_s", "h"].map(String::from);
        let table = Table { names: names.to_vec(), columns: vec![Vec::new(); 5] };
        assert_eq!(find(&table, "t"), Ok(0));
        assert_eq!(find(&table, "kinetic"), Ok(1));
        assert!(find(&table, "momentum").unwrap_err().0.contains("more than one"));
        assert!(find(&table, "x").unwrap_err().0.contains("no column"));
    }

    #[test]
    fn axes_are_titled_by_what_their_columns_share() {
        let title =
            |names: &[&str]| axis_title(&names.iter().map(|name| name.to_string()).collect::<Vec<_>>());
        assert_eq!(title(&["kinetic_j", "strain_j"]), "[J]");
        assert_eq!(title(&["momentum_x_kg_m_s", "momentum_x_kg_m_s"]), "momentum x [kg m/s]");
        assert_eq!(title(&["time_s"]), "time [s]");
        assert_eq!(title(&["h", "kinetic_j"]), "");
        assert_eq!(title(&["reference_error"]), "reference error");
    }
}
