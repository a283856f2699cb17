//! Rate-distortion curves, drawn.

use std::path::Path;

use decimesh::Monitor;
use decimesh::rate_distortion::{Baseline, Criterion, Decomposition, RatePoint};
use plotters::prelude::*;
use plotters::style::{FontStyle, register_font};

use super::report::psnr;
use crate::failure::Failure;
use crate::report::write_atomically;

const SIZE: (u32, u32) = (1200, 800);
/// Meshes on each curve.
const POINTS: usize = 60;
const FONT: &str = "sans-serif";

/// The methods beside ours, and how they are called and coloured.
const BASELINES: [(Baseline, &str, RGBColor); 2] = [
    (Baseline::Insertion(Criterion::Local), "greedy insertion", RGBColor(213, 94, 0)),
    (Baseline::Decimation(Criterion::Local), "one vertex at a time", RGBColor(0, 114, 178)),
];
const OURS: RGBColor = RGBColor(0, 158, 115);

struct Curve {
    name: &'static str,
    color: RGBColor,
    /// The part of the samples that is left, in percent, and decibels.
    points: Vec<(f64, f64)>,
}

/// Draws the curve of a decomposition, and those of simpler methods on the same heights, to a PNG at `path`.
pub(super) fn write(
    decomposition: &Decomposition,
    title: &str,
    path: &Path,
    monitor: &mut Monitor,
) -> Result<(), Failure> {
    let mut curves = vec![curve("rate-distortion (decimesh)", OURS, decomposition)];
    for (baseline, name, color) in BASELINES {
        let other = Decomposition::by_baseline(decomposition.field().clone(), baseline, monitor)?;
        curves.push(curve(name, color, &other));
    }
    let pixels = draw(title, &curves).map_err(|error| Failure::Unexpected(error.to_string()))?;
    let png = png(&pixels).map_err(|error| Failure::Unexpected(error.to_string()))?;
    write_atomically(path, &png)
}

fn curve(name: &'static str, color: RGBColor, decomposition: &Decomposition) -> Curve {
    let (field, samples) = (decomposition.field(), decomposition.samples() as f64);
    let point =
        |RatePoint { vertices, rms }: RatePoint| (100.0 * vertices as f64 / samples, psnr(field, rms));
    // What has no error, or no range of heights, has no place on the scale.
    let points = decomposition.curve(POINTS).into_iter().map(point).filter(|(_, db)| db.is_finite());
    Curve { name, color, points: points.collect() }
}

/// The picture's pixels, red, green and blue.
fn draw(title: &str, curves: &[Curve]) -> Result<Vec<u8>, Box<dyn std::error::Error>> {
    // Only fails where the font does, which is compiled in.
    register_font(FONT, FontStyle::Normal, epaint_default_fonts::UBUNTU_LIGHT)
        .map_err(|_| "the font cannot be read")?;
    let points = || curves.iter().flat_map(|curve| &curve.points);
    let least = |values: &mut dyn Iterator<Item = f64>| values.fold(f64::INFINITY, f64::min);
    let most = |values: &mut dyn Iterator<Item = f64>| values.fold(f64::NEG_INFINITY, f64::max);
    // Flat ground has no curve; the axes are there all the same.
    let (left, right) = match points().next() {
        Some(_) => (least(&mut points().map(|point| point.0)), most(&mut points().map(|point| point.0))),
        None => (0.1, 100.0),
    };
    let (low, high) = match points().next() {
        Some(_) => (least(&mut points().map(|point| point.1)), most(&mut points().map(|point| point.1))),
        None => (0.0, 100.0),
    };
    let mut pixels = vec![0; (SIZE.0 * SIZE.1 * 3) as usize];
    {
        let area = BitMapBackend::with_buffer(&mut pixels, SIZE).into_drawing_area();
        area.fill(&WHITE)?;
        let mut chart = ChartBuilder::on(&area)
            .caption(title, (FONT, 32))
            .margin(24)
            .x_label_area_size(56)
            .y_label_area_size(72)
            .build_cartesian_2d((left..right.max(left * 1.01)).log_scale(), low..high.max(low + 1.0))?;
        chart
            .configure_mesh()
            .x_desc("vertices, % of the samples")
            .y_desc("peak signal-to-noise ratio, dB")
            .label_style((FONT, 20))
            .light_line_style(WHITE)
            .draw()?;
        for Curve { name, color, points } in curves {
            let style = color.stroke_width(3);
            chart
                .draw_series(LineSeries::new(points.iter().copied(), style))?
                .label(*name)
                .legend(move |(x, y)| PathElement::new([(x, y), (x + 30, y)], style));
        }
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::UpperLeft)
            .margin(16)
            .legend_area_size(40)
            .border_style(BLACK.mix(0.3))
            .background_style(WHITE)
            .label_font((FONT, 22))
            .draw()?;
        area.present()?;
    }
    Ok(pixels)
}

fn png(pixels: &[u8]) -> Result<Vec<u8>, png::EncodingError> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, SIZE.0, SIZE.1);
    encoder.set_color(png::ColorType::Rgb);
    encoder.write_header()?.write_image_data(pixels)?;
    Ok(bytes)
}
