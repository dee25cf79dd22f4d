//! The picture of a sweep: probabilities as points, fragility curves as lines.
use super::fragilities::{Fragility, Population};
use plotters::prelude::*;

const SIZE: (u32, u32) = (1200, 720);
const FONT: (&str, u32) = ("sans-serif", 20);
const POINTS_OF_A_CURVE: u32 = 300;

/// Told apart by all eyes (Okabe and Ito).
const COLORS: [RGBColor; 7] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    RGBColor(0, 0, 0),
];

/// Draws `populations` as SVG.
pub fn draw(populations: &[Population]) -> anyhow::Result<String> {
    let mut svg = String::new();
    let highest =
        populations.iter().flat_map(|population| &population.stripes).fold(0.0, |most: f64, at| most.max(at.pga));
    let area = SVGBackend::with_string(&mut svg, SIZE).into_drawing_area();
    area.fill(&WHITE)?;
    let mut chart = ChartBuilder::on(&area)
        .margin(16)
        .x_label_area_size(60)
        .y_label_area_size(72)
        .build_cartesian_2d(0.0..highest, 0.0..1.0)?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(BLACK.mix(0.1))
        .x_desc("peak ground acceleration (g)")
        .y_desc("probability")
        .label_style(FONT)
        .draw()?;
    let fragilities =
        populations.iter().flat_map(|population| population.fragilities.iter().map(move |f| (population, f)));
    for (i, (population, Fragility { limit, probabilities, curve })) in fragilities.enumerate() {
        let color = COLORS[i % COLORS.len()];
        let points = population.stripes.iter().zip(probabilities).map(|(stripe, part)| (stripe.pga, *part));
        let points = points.filter_map(|(pga, part)| Some((pga, part?)));
        let circles = points.map(|point| Circle::new(point, 3, color.filled()));
        chart
            .draw_series(circles)?
            .label(format!("{}: {limit}", population.name))
            .legend(move |(x, y)| Circle::new((x + 10, y), 5, color.filled()));
        if let Ok(curve) = curve {
            let pga = (1..=POINTS_OF_A_CURVE).map(|j| highest * f64::from(j) / f64::from(POINTS_OF_A_CURVE));
            let line = pga.map(|pga| (pga, curve.probability(pga)));
            chart.draw_series(LineSeries::new(line, color.stroke_width(2)))?;
        }
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::LowerRight)
        .label_font(FONT)
        .background_style(WHITE.mix(0.8))
        .border_style(BLACK.mix(0.2))
        .draw()?;
    area.present()?;
    drop((chart, area));
    Ok(svg)
}
