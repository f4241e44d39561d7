//! The three pictures of a study: error against time with the front, error against unknowns, where the time goes.

use std::path::Path;

use ndda_io::WriteError;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::front::{Point, front};
use super::result::{CasePoint, Figures, Results};
use super::table::WHICH;
use crate::picture::{self, Area, Drawn, colour, count_axis, log_axis, log_range, short};

/// Width and height of the pictures with two frames [px].
const SIZE: (u32, u32) = (1480, 560);
/// Width of the part of it that shows colours [px].
const KEY: u32 = 290;
/// Colour of the front.
const FRONT: RGBColor = RGBColor(190, 190, 190);
/// Errors of exactly zero are drawn here.
const ZERO: f64 = 1e-17;
/// Errors beyond this are drawn here: how wrong a useless run is does not matter, and axes of 300 decades cannot be drawn.
const MOST: f64 = 1e6;
/// Height of a bar with its room, width of the picture of stages, room for names beside the bars [px].
const BAR: u32 = 24;
const WIDE: u32 = 1100;
const NAMES: u32 = 330;
/// Bars beyond which those of cases on no front are left out.
const MOST_BARS: usize = 40;

/// Draws and writes all of them.
///
/// # Errors
/// [`WriteError`] when one cannot be drawn or written.
pub fn all(out: &Path, results: &Results) -> Result<(), WriteError> {
    if results.points.iter().all(|point| point.figures.is_none()) {
        return Ok(());
    }
    let bars = barred(results).len() as u32;
    for ending in picture::ENDINGS {
        let file = |name: &str| out.join(format!("{name}.{ending}"));
        picture::write(&file("error_time"), SIZE, |root| pair(root, results, &Across::Time))?;
        picture::write(&file("error_dofs"), SIZE, |root| pair(root, results, &Across::Dofs))?;
        picture::write(&file("stages"), (WIDE, 130 + BAR * bars), |root| stages(root, results))?;
    }
    Ok(())
}

/// Abscissa of pictures of errors.
enum Across {
    Time,
    Dofs,
}

impl Across {
    fn of(&self, figures: &Figures) -> f64 {
        match self {
            Self::Time => figures.time_s,
            Self::Dofs => figures.run.counts.dofs as f64,
        }
    }

    fn title(&self, clock: &str) -> String {
        match self {
            Self::Time => format!("{clock} time [s]"),
            Self::Dofs => "unknowns".into(),
        }
    }
}

/// Both errors side by side, and what colours stand for.
fn pair(root: &Area, results: &Results, across: &Across) -> Drawn {
    let root = root.titled(&results.title, ("sans-serif", 20))?;
    let (frames, key) = root.split_horizontally(SIZE.0 - KEY);
    for (which, area) in frames.split_evenly((1, 2)).iter().enumerate() {
        frame(area, results, across, which)?;
    }
    let name = |name: String| if name.is_empty() { "all cases".into() } else { name };
    let curves = results.curve_names().into_iter().enumerate();
    let mut entries: Vec<_> = curves.map(|(i, curve)| (name(curve), colour(i), 10)).collect();
    if matches!(across, Across::Time) {
        entries.push(("front".into(), FRONT, 7));
    }
    if results.reference.floors().iter().any(|floor| *floor > 0.0) {
        entries.push(("as exact as references".into(), BLACK, 1));
    }
    picture::key(&key, &entries)
}

/// Errors of one kind, one colour per curve; the front is a grey band.
fn frame(area: &Area, results: &Results, across: &Across, which: usize) -> Drawn {
    let floor = results.reference.floors()[which];
    let place = |f: &Figures| (across.of(f), f.point(which, floor.max(ZERO)).error.min(MOST));
    let all: Vec<(f64, f64)> = results.points.iter().filter_map(|p| p.figures.as_ref()).map(place).collect();
    let (x, y) = (log_range(all.iter().map(|p| p.0)), log_range(all.iter().map(|p| p.1)));
    let (ends, seen) = ([(x.start, floor), (x.end, floor)], y.contains(&floor));
    let x = match across {
        Across::Time => log_axis(x),
        Across::Dofs => count_axis(x, all.iter().map(|p| p.0).collect()),
    };
    let mut chart = ChartBuilder::on(area)
        .margin(14)
        .x_label_area_size(46)
        .y_label_area_size(72)
        .build_cartesian_2d(x, log_axis(y))?;
    chart
        .configure_mesh()
        .bold_line_style(RGBColor(215, 215, 215))
        .x_desc(across.title(results.clock))
        .y_desc(format!("{} [-]", WHICH[which]))
        .label_style(("sans-serif", 14))
        .axis_desc_style(("sans-serif", 16))
        .x_label_formatter(&|v| short(*v))
        .y_label_formatter(&|v| short(*v))
        .draw()?;
    if matches!(across, Across::Time) {
        let points: Vec<Point> = all.iter().map(|&(time_s, error)| Point { time_s, error }).collect();
        chart.draw_series(LineSeries::new(
            front(&points).into_iter().map(|i| all[i]),
            FRONT.stroke_width(7),
        ))?;
    }
    if seen {
        chart.draw_series(LineSeries::new(ends, BLACK.stroke_width(1)))?;
    }
    for (i, places) in curves(results, &place).into_iter().enumerate() {
        // Through the best of each curve: meshes, steps and penalties beside each other would be a zigzag.
        let points: Vec<Point> = places.iter().map(|&(time_s, error)| Point { time_s, error }).collect();
        let best = front(&points).into_iter().map(|k| places[k]);
        chart.draw_series(LineSeries::new(best, colour(i).stroke_width(1)))?;
        chart.draw_series(places.into_iter().map(|place| Circle::new(place, 5, colour(i).filled())))?;
    }
    Ok(())
}

/// The places of each curve's points.
fn curves(results: &Results, place: &dyn Fn(&Figures) -> (f64, f64)) -> Vec<Vec<(f64, f64)>> {
    let curve = |name: String| {
        let on = results.points.iter().filter(|point| point.curve(&results.curves) == name);
        on.filter_map(|point| point.figures.as_ref()).map(place).collect()
    };
    results.curve_names().into_iter().map(curve).collect()
}

/// Cases that get a bar.
fn barred(results: &Results) -> Vec<(&CasePoint, &Figures)> {
    let done = results.points.iter().filter_map(|point| Some((point, point.figures.as_ref()?)));
    let done: Vec<_> = done.collect();
    if done.len() <= MOST_BARS {
        return done;
    }
    done.into_iter().filter(|(_, figures)| figures.on_front.contains(&true)).collect()
}

/// One bar per case: the seconds of each stage.
fn stages(root: &Area, results: &Results) -> Drawn {
    let done = barred(results);
    let names: Vec<&String> = done[0].1.run.stages_s.keys().collect();
    let share =
        |f: &Figures, name: &str| f.run.stages_s.get(name).and_then(|s| s.as_f64()).unwrap_or(0.0) / f.wall_s;
    let count = done.len() as f64;
    let root = root.titled(&format!("{}: where the time goes", results.title), ("sans-serif", 20))?;
    let (frame, key) = root.split_horizontally(WIDE - KEY / 2);
    let mut chart = ChartBuilder::on(&frame)
        .margin(14)
        .x_label_area_size(46)
        .y_label_area_size(NAMES)
        .build_cartesian_2d(0.0..100.0, count..0.0)?;
    chart
        .configure_mesh()
        .disable_mesh()
        .disable_y_axis()
        .x_labels(12)
        .x_desc("fraction of the wall time [%]")
        .label_style(("sans-serif", 14))
        .axis_desc_style(("sans-serif", 16))
        .x_label_formatter(&|v| format!("{v:.0}"))
        .draw()?;
    for (k, name) in names.iter().enumerate() {
        let bar = |(i, (_, f)): (usize, &(&CasePoint, &Figures))| {
            let before: f64 = names[..k].iter().map(|earlier| share(f, earlier)).sum();
            let (left, right) = (100.0 * before, 100.0 * (before + share(f, name)));
            Rectangle::new([(left, i as f64 + 0.12), (right, i as f64 + 0.88)], colour(k).filled())
        };
        chart.draw_series(done.iter().enumerate().map(bar))?;
    }
    let font = TextStyle::from(("sans-serif", 13).into_font()).pos(Pos::new(HPos::Right, VPos::Center));
    chart.draw_series(done.iter().enumerate().map(|(i, (point, f))| {
        let words = format!("{}: {:.3} s", point.choices(), f.wall_s);
        EmptyElement::at((0.0, i as f64 + 0.5)) + Text::new(words, (-8, 0), font.clone())
    }))?;
    let entry = |(k, name): (usize, &&String)| (name.to_string(), colour(k), 10);
    picture::key(&key, &names.iter().enumerate().map(entry).collect::<Vec<_>>())
}
