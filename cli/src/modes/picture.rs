//! The picture of a split response: rotations and accelerations of both modes over time, where the structure rocks.
use crate::{
    picture::{
        Picture, TITLE, colour,
        histories::{Histories, Line, Panel},
        range, titled,
    },
    talk::say,
};
use plotters::style::RGBColor;
use rocking::estimates::modal_split::{ModalAccelerations, Modes};

const WIDTH: u32 = 860;

/// The modes at an instant, s.
pub type Split = (f64, Modes, ModalAccelerations);

/// Draws the modes of a response in its `stretches` of rocking about one pivot; `about` is the response that they are of.
pub fn draw(picture: Picture, g: f64, stretches: &[Vec<Split>], about: &str) -> anyhow::Result<()> {
    let times = || stretches.iter().flatten().map(|at| at.0);
    let Some((first, last)) = times().next().zip(times().next_back()) else {
        say!("no picture: it does not rock");
        return Ok(());
    };
    let line = |name, colour: RGBColor, value: &dyn Fn(&Split) -> f64| {
        let parts = stretches.iter().map(|stretch| stretch.iter().map(|at| (at.0, value(at))).collect());
        Line { name, colour, parts: parts.collect() }
    };
    let panel = |name: &str, lines: Vec<Line>| {
        let values = lines.iter().flat_map(|line| line.parts.iter().flatten()).map(|point| point.1);
        Panel { name: name.into(), range: range(values), peak: None, lines }
    };
    let rotations = vec![
        line("rocking mode q_r", colour::BLUE, &|(_, modes, _)| modes.q_r),
        line("vibration mode q_u", colour::VERMILLION, &|(_, modes, _)| modes.q_u),
    ];
    let accelerations = vec![
        line("rocking mode a_r", colour::BLUE, &|(_, _, accelerations)| accelerations.a_r / g),
        line("vibration mode a_u", colour::VERMILLION, &|(_, _, accelerations)| accelerations.a_u / g),
    ];
    let sum = vec![line("", colour::INK, &|(_, _, accelerations)| accelerations.a_t() / g)];
    let panels = vec![
        panel("rotation (rad)", rotations),
        panel("acceleration (g)", accelerations),
        panel("their sum a_t (g)", sum),
    ];
    let histories = Histories { panels, marks: Vec::new(), time: first..last };
    picture.draw((WIDTH, TITLE + histories.height()), |area| {
        histories.draw(&titled(area, "Rocking and vibration mode", about)?)
    })
}
