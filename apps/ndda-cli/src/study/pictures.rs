//! The three pictures of a study: error against time with the front, error against unknowns, where the time goes.

use std::path::Path;

use ndda_io::WriteError;
use plotters::coord::combinators::{LogCoord, WithKeyPoints};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::front::{Point, front};
use super::result::{CasePoint, Figures, Results};
use super::table::WHICH;
use crate::picture::{self, Area, Drawn, colour, log_axis, log_range, short};

/// Width and height of the pictures with two frames [px].
const SIZE: (u32, u32) = (1280, 560);
/// Errors of exactly zero are drawn here.
const ZERO: f64 = 1e-17;
/// Height of a bar with its room, width of the picture of stages, room for names beside the bars [px].
const BAR: u32 = 24;
const WIDE: u32 = 1100;
const NAMES: u32 = 330;
/// End of the axis of shares [%]; beyond 100 is room for the legend.
const FULL: f64 = 118.0;

/// Draws and writes all of them.
///
/// # Errors
/// [`WriteError`] when one cannot be drawn or written.
pub fn all(out: &Path, results: &Results) -> Result<(), WriteError> {
    if results.points.iter().all(|point| point.figures.is_none()) {
        return Ok(());
    }
    let bars = results.points.iter().filter(|point| point.figures.is_some()).count() as u32;
    for ending in picture::ENDINGS {
        let file = |name: &str| out.join(format!("{name}.{ending}"));
        picture::write(&file("error_time"), SIZE, |root| pair(root, results, &Across::Time))?;
        picture::write(&file("error_dofs"), SIZE, |root| pair(root, results, &Across::Dofs))?;
        picture::write(&file("stages"), (WIDE, 130 + BAR * bars), |root| stages(root, results))?;
    }
    Ok(())
}

/// What errors are drawn against.
enum Across {
    Time,
    Dofs,
}

impl Across {
    fn of(&self, figures: &Figures) -> f64 {
        match self {
            Self::Time => figures.wall_s,
            Self::Dofs => figures.run.counts.dofs as f64,
        }
    }

    fn title(&self) -> &'static str {
        match self {
            Self::Time => "wall time [s]",
            Self::Dofs => "unknowns",
        }
    }
}

/// Both errors side by side.
fn pair(root: &Area, results: &Results, across: &Across) -> Drawn {
    let root = root.titled(&results.title, ("sans-serif", 20))?;
    for (which, area) in root.split_evenly((1, 2)).iter().enumerate() {
        frame(area, results, across, which)?;
    }
    Ok(())
}

/// A frame whose axes are both logarithmic.
type Frame<'a, 'b> =
    ChartContext<'a, SVGBackend<'b>, Cartesian2d<WithKeyPoints<LogCoord<f64>>, WithKeyPoints<LogCoord<f64>>>>;

/// Errors of one kind, one colour per curve; the front is a grey band.
fn frame(area: &Area, results: &Results, across: &Across, which: usize) -> Drawn {
    let floor = results.reference.floors()[which];
    let place = |f: &Figures| (across.of(f), f.point(which, floor.max(ZERO)).error);
    let all: Vec<(f64, f64)> = results.points.iter().filter_map(|p| p.figures.as_ref()).map(place).collect();
    let (x, y) = (log_range(all.iter().map(|p| p.0)), log_range(all.iter().map(|p| p.1)));
    let (ends, seen) = ([(x.start, floor), (x.end, floor)], y.contains(&floor));
    let mut chart = ChartBuilder::on(area)
        .margin(14)
        .x_label_area_size(46)
        .y_label_area_size(72)
        .build_cartesian_2d(log_axis(x), log_axis(y))?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(RGBColor(215, 215, 215))
        .x_desc(across.title())
        .y_desc(format!("{} [-]", WHICH[which]))
        .label_style(("sans-serif", 14))
        .axis_desc_style(("sans-serif", 16))
        .x_label_formatter(&|v| short(*v))
        .y_label_formatter(&|v| short(*v))
        .draw()?;
    if matches!(across, Across::Time) {
        let points: Vec<Point> = all.iter().map(|&(time_s, error)| Point { time_s, error }).collect();
        let best = front(&points).into_iter().map(|i| all[i]).collect::<Vec<_>>();
        line(&mut chart, best, RGBColor(190, 190, 190).stroke_width(7), "front")?;
    }
    if seen {
        line(&mut chart, ends.to_vec(), BLACK.stroke_width(1), "as exact as the references")?;
    }
    curves(&mut chart, results, &place)?;
    picture::legend(&mut chart, SeriesLabelPosition::LowerLeft)
}

fn line(chart: &mut Frame, points: Vec<(f64, f64)>, style: ShapeStyle, label: &str) -> Drawn {
    let sample = move |(x, y): (i32, i32)| PathElement::new([(x, y), (x + 18, y)], style);
    chart.draw_series(LineSeries::new(points, style))?.label(label).legend(sample);
    Ok(())
}

/// The points of each curve, joined in the order of the cases.
fn curves(chart: &mut Frame, results: &Results, place: &dyn Fn(&Figures) -> (f64, f64)) -> Drawn {
    for (i, name) in results.curve_names().into_iter().enumerate() {
        let on = results.points.iter().filter(|point| point.curve(&results.curves) == name);
        let places: Vec<(f64, f64)> = on.filter_map(|point| point.figures.as_ref()).map(place).collect();
        let (fill, thin) = (colour(i).filled(), colour(i).stroke_width(1));
        chart.draw_series(LineSeries::new(places.iter().copied(), thin))?;
        let label = if name.is_empty() { "all cases".to_string() } else { name };
        chart
            .draw_series(places.into_iter().map(|place| Circle::new(place, 5, fill)))?
            .label(label)
            .legend(move |(x, y)| Circle::new((x + 9, y), 5, fill));
    }
    Ok(())
}

/// One bar per case: the seconds of each stage.
fn stages(root: &Area, results: &Results) -> Drawn {
    let done: Vec<(&CasePoint, &Figures)> =
        results.points.iter().filter_map(|point| Some((point, point.figures.as_ref()?))).collect();
    let names: Vec<&String> = done[0].1.run.stages_s.keys().collect();
    let share =
        |f: &Figures, name: &str| f.run.stages_s.get(name).and_then(|s| s.as_f64()).unwrap_or(0.0) / f.wall_s;
    let count = done.len() as f64;
    let root = root.titled(&format!("{}: where the time goes", results.title), ("sans-serif", 20))?;
    let mut chart = ChartBuilder::on(&root)
        .margin(14)
        .x_label_area_size(46)
        .y_label_area_size(NAMES)
        .build_cartesian_2d(0.0..FULL, count..0.0)?;
    chart
        .configure_mesh()
        .disable_mesh()
        .disable_y_axis()
        .x_labels(12)
        .x_desc("share of the wall time [%]")
        .label_style(("sans-serif", 14))
        .axis_desc_style(("sans-serif", 16))
        .x_label_formatter(&|v| if *v > 100.0 { String::new() } else { format!("{v:.0}") })
        .draw()?;
    for (k, name) in names.iter().enumerate() {
        let fill = colour(k).filled();
        let bar = |(i, (_, f)): (usize, &(&CasePoint, &Figures))| {
            let before: f64 = names[..k].iter().map(|earlier| share(f, earlier)).sum();
            let (left, right) = (100.0 * before, 100.0 * (before + share(f, name)));
            Rectangle::new([(left, i as f64 + 0.12), (right, i as f64 + 0.88)], fill)
        };
        chart
            .draw_series(done.iter().enumerate().map(bar))?
            .label(name.as_str())
            .legend(move |(x, y)| Rectangle::new([(x, y - 5), (x + 12, y + 5)], fill));
    }
    let font = TextStyle::from(("sans-serif", 13).into_font()).pos(Pos::new(HPos::Right, VPos::Center));
    chart.draw_series(done.iter().enumerate().map(|(i, (point, f))| {
        let words = format!("{}: {:.3} s", point.choices(), f.wall_s);
        EmptyElement::at((0.0, i as f64 + 0.5)) + Text::new(words, (-8, 0), font.clone())
    }))?;
    picture::legend(&mut chart, SeriesLabelPosition::UpperRight)
}
