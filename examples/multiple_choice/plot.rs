//! Error over the number of triangles, as the paper's Figures 5 and 6.

use std::error::Error;
use std::path::Path;

use plotters::prelude::*;

use crate::measure::Level;

/// A method's name and its levels.
type Curve<'a> = (&'a str, Vec<Level>);

/// One colour a cost, thin where the heap is lazy; in the order of the methods.
const LINES: [(RGBColor, u32); 7] = [
    (RGBColor(214, 39, 40), 2),
    (RGBColor(31, 119, 180), 2),
    (RGBColor(44, 160, 44), 2),
    (RGBColor(255, 152, 150), 1),
    (RGBColor(174, 199, 232), 1),
    (RGBColor(152, 223, 138), 1),
    (RGBColor(40, 40, 40), 2),
];

/// Draws the largest distance and the RMS side by side, both axes logarithmic, into an SVG file.
pub(crate) fn draw(path: &Path, name: &str, curves: &[Curve]) -> Result<(), Box<dyn Error>> {
    let area = SVGBackend::new(path, (1200, 520)).into_drawing_area();
    area.fill(&WHITE)?;
    let panels = area.split_evenly((1, 2));
    panel(&panels[0], &format!("{name}: Hausdorff distance"), curves, |level| level.hausdorff)?;
    panel(&panels[1], &format!("{name}: RMS distance"), curves, |level| level.rms)?;
    Ok(area.present()?)
}

fn panel(
    area: &DrawingArea<SVGBackend, plotters::coord::Shift>,
    caption: &str,
    curves: &[Curve],
    error: fn(&Level) -> f64,
) -> Result<(), Box<dyn Error>> {
    // No error at all has no place on a logarithmic axis.
    let points = |levels: &[Level]| -> Vec<(f64, f64)> {
        let points = levels.iter().map(|level| (level.triangles as f64, error(level)));
        points.filter(|point| point.0 > 0.0 && point.1 > 0.0).collect()
    };
    let all: Vec<(f64, f64)> = curves.iter().flat_map(|(_, levels)| points(levels)).collect();
    let span = |axis: fn(&(f64, f64)) -> f64| {
        let values = all.iter().map(axis);
        values.fold((f64::INFINITY, 0f64), |(low, high), value| (low.min(value), high.max(value)))
    };
    let ((left, right), (bottom, top)) = (span(|point| point.0), span(|point| point.1));
    let mut chart = ChartBuilder::on(area)
        .caption(caption, ("sans-serif", 20))
        .margin(12)
        .x_label_area_size(40)
        .y_label_area_size(64)
        .build_cartesian_2d((0.9 * left..1.1 * right).log_scale(), (0.8 * bottom..1.25 * top).log_scale())?;
    chart
        .configure_mesh()
        .x_desc("triangles")
        .y_desc("share of the diagonal")
        .x_label_formatter(&|x| format!("{x:.0}"))
        .y_label_formatter(&|y| format!("{y:.0e}"))
        .light_line_style(WHITE)
        .draw()?;
    for ((name, levels), (colour, width)) in curves.iter().zip(LINES) {
        let style = colour.stroke_width(width);
        chart
            .draw_series(LineSeries::new(points(levels), style))?
            .label(*name)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], style));
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperRight)
        .background_style(WHITE)
        .border_style(BLACK)
        .draw()?;
    Ok(())
}
