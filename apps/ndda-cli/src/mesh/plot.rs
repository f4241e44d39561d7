//! Histograms of a mesh as a picture.

use plotters::prelude::*;

use super::report::{Bars, MeshReport};
use crate::picture::{Area, Drawn};

/// Width and height of the picture [px].
pub const SIZE: (u32, u32) = (1000, 700);
const BAR: RGBColor = RGBColor(70, 110, 160);

/// Four histograms.
pub fn draw(report: &MeshReport, root: &Area) -> Drawn {
    let panels = [
        ("volume of blocks [m³]", &report.block_size.volume_m3),
        ("smallest dihedral angle of tetrahedra [°]", &report.dihedral_deg),
        ("longest edge over smallest height", &report.aspect),
        ("smallest height of tetrahedra [m]", &report.height_m),
    ];
    for (area, (title, bars)) in root.split_evenly((2, 2)).iter().zip(panels) {
        panel(area, title, bars)?;
    }
    Ok(())
}

/// One histogram; empty bars at its ends are left out.
fn panel(area: &Area, title: &str, bars: &Bars) -> Drawn {
    let used = |i: &usize| bars.counts[*i] > 0;
    let first = (0..bars.counts.len()).find(used).unwrap_or(0);
    let last = (0..bars.counts.len()).rev().find(used).unwrap_or(0);
    let most = bars.counts.iter().copied().max().unwrap_or(0).max(1);
    let mut chart = ChartBuilder::on(area)
        .caption(title, ("sans-serif", 18))
        .margin(12)
        .x_label_area_size(28)
        .y_label_area_size(56)
        .build_cartesian_2d(first as f64..(last + 1) as f64, 0.0..1.05 * most as f64)?;
    let border = |x: &f64| bars.from.get(x.round() as usize).map_or(String::new(), |b| number(*b));
    chart
        .configure_mesh()
        .disable_x_mesh()
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

fn number(value: f64) -> String {
    if value == 0.0 || (0.01..1e4).contains(&value.abs()) {
        format!("{value:.3}")
    } else {
        format!("{value:.1e}")
    }
}
