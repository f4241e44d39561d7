//! Histograms of a mesh as a picture.

use plotters::prelude::*;

use ndda_mesh::quality::Histogram;

use crate::mesh_report::MeshReport;
use crate::picture::{Area, Drawn};

/// Width and height of the picture [px].
pub const SIZE: (u32, u32) = (1000, 700);
/// Most labels of counts: of few, each has its own.
const MOST_LABELS: usize = 8;
const BAR: RGBColor = RGBColor(70, 110, 160);

/// Four histograms.
pub fn draw(report: &MeshReport, root: &Area) -> Drawn {
    let panels = [
        ("volume of blocks [m³]", "blocks", &report.block_size.volume_m3),
        ("smallest dihedral angle [°]", "tetrahedra", &report.quality.dihedral_deg),
        ("longest edge over smallest height", "tetrahedra", &report.quality.aspect),
        ("smallest height [m]", "tetrahedra", &report.quality.height_m),
    ];
    for (area, (title, counted, bars)) in root.split_evenly((2, 2)).iter().zip(panels) {
        panel(area, (title, counted), bars)?;
    }
    Ok(())
}

/// One histogram; empty bars at its ends are left out.
fn panel(area: &Area, (title, counted): (&str, &str), bars: &Histogram) -> Drawn {
    let used = |i: &usize| bars.counts[*i] > 0;
    let first = (0..bars.counts.len()).find(used).unwrap_or(0);
    let last = (0..bars.counts.len()).rev().find(used).unwrap_or(0);
    let most = bars.counts.iter().copied().max().unwrap_or(0).max(1);
    let mut chart = ChartBuilder::on(area)
        .caption(title, ("sans-serif", 18))
        .margin(12)
        .margin_right(28)
        .x_label_area_size(28)
        .y_label_area_size(72)
        .build_cartesian_2d(first as f64..(last + 1) as f64, 0.0..1.05 * most as f64)?;
    let border = |x: &f64| bars.borders.get(x.round() as usize).map_or(String::new(), |b| number(*b));
    chart
        .configure_mesh()
        .disable_x_mesh()
        .max_light_lines(0)
        .y_desc(counted)
        .y_labels((most + 1).min(MOST_LABELS))
        .x_labels((last - first + 2).min(10))
        .x_label_formatter(&border)
        .y_label_formatter(&|count| format!("{count:.0}"))
        .draw()?;
    chart.draw_series((first..=last).filter(|i| *i < bars.counts.len()).map(|i| {
        let (left, right) = (i as f64 + 0.04, i as f64 + 0.96);
        Rectangle::new([(left, 0.0), (right, bars.counts[i] as f64)], BAR.filled())
    }))?;
    Ok(())
}

/// Three digits, without zeros at the end.
fn number(value: f64) -> String {
    if value == 0.0 || !(0.01..1e4).contains(&value.abs()) {
        return if value == 0.0 { "0".into() } else { format!("{value:.1e}") };
    }
    let decimals = (2 - value.abs().log10().floor() as i32).max(0) as usize;
    let text = format!("{value:.decimals$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').into() } else { text }
}
