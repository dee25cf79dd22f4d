//! The picture of a record: acceleration, velocity and displacement of the ground over time, and the response spectrum.
use crate::picture::{
    Area, Picture, TITLE, axes, chart, colour,
    histories::{Histories, Panel},
    line, px, range, titled,
};
use plotters::prelude::*;
use rocking::estimates::response_spectrum::spectral_acceleration;
use rocking::run::peaks::Peak;
use rocking::run::record::Record;

const WIDTH: u32 = 860;
const SPECTRUM: u32 = 290;
const BELOW: f64 = 46.0;

/// Damping ratio of the spectrum, and its periods, s.
const DAMPING: f64 = 0.05;
const PERIODS: (f64, f64) = (0.02, 10.0);

/// Points of the spectrum.
const POINTS: u32 = 400;

/// Draws `record`; `g` in m/s².
pub fn draw(picture: Picture, record: &Record, g: f64) -> anyhow::Result<()> {
    let histories = histories(record, g);
    let height = TITLE + histories.height();
    let about = "the ground's acceleration and its integrals, at rest before the start";
    picture.draw((WIDTH, height + SPECTRUM), |area| {
        let (upper, lower) = titled(area, record.title(), about)?.split_vertically(px(f64::from(histories.height())));
        histories.draw(&upper)?;
        draw_spectrum(&lower, record, g)
    })
}

/// The acceleration of `record` and its integrals over time; `g` in m/s².
fn histories(record: &Record, g: f64) -> Histories {
    let none = Peak::default();
    let samples = || record.times().iter().copied().zip(record.velocities_and_displacements());
    let accelerations = record.times().iter().copied().zip(record.acceleration().iter().copied()).collect();
    let of = |i: usize| samples().map(|(time, integrals)| (time, integrals[i])).collect();
    let panels = vec![
        Panel::of("acceleration", (g, "g"), colour::BLUE, accelerations, none),
        Panel::of("velocity", (1.0, "m/s"), colour::VERMILLION, of(0), none),
        Panel::of("displacement", (1.0, "m"), colour::INK, of(1), none),
    ];
    Histories { panels, marks: Vec::new(), time: record.start()..record.end() }
}

/// S_a/g over periods evenly in their logarithms.
fn draw_spectrum(area: &Area, record: &Record, g: f64) -> anyhow::Result<()> {
    let (shortest, longest) = PERIODS;
    let period = |i: u32| shortest * (longest / shortest).powf(f64::from(i) / f64::from(POINTS));
    let of_period = |T| (T, spectral_acceleration(record, T, DAMPING) / g);
    let points: Vec<_> = (0..=POINTS).map(period).map(of_period).collect();
    let highest = range(points.iter().map(|point| point.1));
    let mut chart = chart(area, BELOW).build_cartesian_2d((shortest..longest).log_scale(), highest)?;
    axes(&mut chart, ["period T (s)", "S_a (g), damping 5 %"], [6, 6])?;
    chart.draw_series([PathElement::new(points, line(colour::BLUE))])?;
    Ok(())
}
