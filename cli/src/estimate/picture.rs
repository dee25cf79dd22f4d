//! The picture of an estimate: the record's response spectra, the demand term by term, the frequency of rocking.
use crate::picture::{
    Area, Picture, SMALL, TITLE, axes, chart, colour, dot, line, px, range, rounded, stroke, titled, words, words_about,
};
use crate::quantities::in_readable_unit;
use crate::record::picture::spectrum;
use plotters::prelude::*;
use rocking::Structure;
use rocking::estimates::demand::Demand;
use rocking::estimates::effective_frequency::effective_frequency;
use rocking::estimates::response_spectrum::spectral_acceleration;
use rocking::run::record::Record;
use std::f64::consts::TAU;

const WIDTH: u32 = 880;
const PANEL: u32 = 290;
const BELOW: f64 = 46.0;

/// Width of the demand's panel, pixels.
const BARS: f64 = 300.0;

/// Points of a line over an axis.
const POINTS: u32 = 400;

/// Draws what `demand` consists of and, if there is a `record`, its spectra with both periods of the structure, and the
/// effective frequency with marks at these `amplitudes`.
pub fn draw(
    picture: Picture,
    structure: &Structure,
    record: Option<&Record>,
    demand: &Demand,
    amplitudes: &[f64],
) -> anyhow::Result<()> {
    let rows = if record.is_some() { 2 } else { 1 };
    let about = format!(
        "base shear {}, overturning moment {} while rocking",
        in_readable_unit(demand.V_t, "N", rounded),
        in_readable_unit(demand.M_t, "N.m", rounded)
    );
    let title = record.map_or("Demand while rocking, the ground at rest", Record::title);
    picture.draw((WIDTH, TITLE + rows * PANEL), |area| {
        let below = titled(area, title, &about)?;
        let (upper, lower) = below.split_vertically(px(f64::from(PANEL)));
        let (wide, bars) = upper.split_horizontally(px(f64::from(WIDTH) - BARS));
        draw_demand(&bars, structure, record, demand)?;
        match record {
            Some(record) => {
                draw_spectra(&wide, structure, record)?;
                draw_frequency(&lower, structure, amplitudes)
            }
            None => draw_frequency(&wide, structure, amplitudes),
        }
    })
}

fn draw_spectra(area: &Area, structure: &Structure, record: &Record) -> anyhow::Result<()> {
    let g = structure.parameters().g;
    let S_a = |T: f64, zeta: f64| spectral_acceleration(record, T, zeta) / g;
    let of_mode = [
        ("fixed base", "T_fc", TAU / structure.omega_fc, structure.parameters().zeta_fc, colour::GREY),
        ("vibration while rocking", "T_u", TAU / structure.omega_u, structure.zeta_u, colour::BLUE),
    ];
    let (shortest, longest) = (0.2 * of_mode[1].2, 10.0 * of_mode[0].2);
    let spectra = of_mode.map(|(.., zeta, _)| spectrum(record, (shortest, longest), zeta, g));
    let highest = range(spectra.iter().flatten().map(|point| point.1));
    let mut chart = chart(area, BELOW).build_cartesian_2d((shortest..longest).log_scale(), highest.clone())?;
    axes(&mut chart, ["period T (s)", "spectral acceleration S_a (g)"], [6, 6])?;
    for (i, (spectrum, (name, symbol, T, zeta, colour))) in spectra.into_iter().zip(of_mode).enumerate() {
        chart.draw_series([PathElement::new(spectrum, line(colour))])?;
        let mark = PathElement::new([(T, 0.0), (T, S_a(T, zeta))], stroke(colour, 0.8));
        chart.draw_series([mark])?;
        let label = EmptyElement::at((T, S_a(T, zeta)))
            + dot((0, 0), 3.0, colour)
            + Text::new(symbol, (px(7.0), px(-8.0)), words(SMALL, colour::INK));
        chart.draw_series([label])?;
        let legend = format!("{name}, damping {:.3}", zeta);
        let (x, y) = (px(94.0), px(22.0 + 16.0 * i as f64));
        area.draw(&PathElement::new([(x, y), (x + px(18.0), y)], line(colour)))?;
        area.draw(&Text::new(legend, (x + px(24.0), y), words(SMALL, colour::INK)))?;
    }
    Ok(())
}

/// The demand as a pile of its terms (Eq 22), beside the acceleration on a fixed base (Eq 4).
fn draw_demand(area: &Area, structure: &Structure, record: Option<&Record>, demand: &Demand) -> anyhow::Result<()> {
    let g = structure.parameters().g;
    let fixed_base = record
        .map(|record| spectral_acceleration(record, TAU / structure.omega_fc, structure.parameters().zeta_fc) / g);
    let terms = [
        ("ground", demand.ground / g, colour::BLUE),
        ("rocking", demand.rocking / g, colour::SKY),
        ("impact", demand.impact / g, colour::ORANGE),
    ];
    let a_t = demand.a_t / g;
    let heights = range([a_t, fixed_base.unwrap_or(0.0)]);
    let row = 0.06 * heights.end; // of words
    let mut chart = chart(area, BELOW).build_cartesian_2d(0.0..2.0, heights)?;
    axes(&mut chart, ["", "lateral acceleration (g)"], [0, 6])?;
    let mut pile = |at: f64, name: &str, parts: &[(&str, f64, RGBColor)]| -> anyhow::Result<()> {
        let (mut from, mut free) = (0.0, 0.5 * row);
        for (of, height, colour) in parts {
            let bar = Rectangle::new([(at - 0.28, from), (at + 0.28, from + height)], colour.filled());
            chart.draw_series([bar])?;
            if !of.is_empty() && *height > 0.0 {
                let label = Text::new((*of).to_owned(), (px(6.0), 0), words(SMALL, colour::INK));
                let beside = free.max(from + 0.5 * height);
                chart.draw_series([EmptyElement::at((at + 0.28, beside)) + label])?;
                free = beside + row;
            }
            from += height;
        }
        let above = Text::new(format!("{} g", rounded(from)), (0, px(-9.0)), words_about(SMALL, colour::INK));
        chart.draw_series([EmptyElement::at((at, from)) + above])?;
        let below = Text::new(name.to_owned(), (0, px(14.0)), words_about(SMALL, colour::INK));
        chart.draw_series([EmptyElement::at((at, 0.0)) + below])?;
        Ok(())
    };
    if let Some(S_a) = fixed_base {
        pile(0.45, "fixed base", &[("", S_a, colour::GREY)])?;
    }
    pile(1.25, "rocking", &terms)
}

fn draw_frequency(area: &Area, structure: &Structure, amplitudes: &[f64]) -> anyhow::Result<()> {
    let f_r = |part: f64| effective_frequency(structure, part * structure.tan_alpha_cg);
    let part = |i: u32| f64::from(i) / f64::from(POINTS);
    let least = amplitudes.iter().copied().fold(0.05, f64::min);
    let highest = 1.1 * f_r(least);
    let curve = (1..POINTS).map(|i| (part(i), f_r(part(i)))).skip_while(|point| point.1 > highest);
    let mut chart = chart(area, BELOW).build_cartesian_2d(0.0..1.0, 0.0..highest)?;
    axes(&mut chart, ["amplitude θ / tan α_cg", "effective frequency f_r (Hz)"], [10, 6])?;
    chart.draw_series([PathElement::new(curve.collect::<Vec<_>>(), line(colour::BLUE))])?;
    for amplitude in amplitudes {
        let label = EmptyElement::at((*amplitude, f_r(*amplitude)))
            + dot((0, 0), 3.0, colour::INK)
            + Text::new(format!("{} Hz", rounded(f_r(*amplitude))), (px(6.0), px(-10.0)), words(SMALL, colour::INK));
        chart.draw_series([label])?;
    }
    Ok(())
}
