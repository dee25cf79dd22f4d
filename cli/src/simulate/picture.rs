//! The picture of a run, as Fig 9: ground, uplift, acceleration and base shear over time, marks at the transitions.
use crate::picture::{
    Picture, TITLE, colour,
    histories::{Histories, Marks, Panel},
    mass, rounded, titled,
};
use anyhow::Context;
use rocking::{
    Parameters, Run, Structure,
    run::{
        Ending,
        curve::{Curve, Point},
    },
};

/// Part of a peak by which a line may miss the motion: less than its width.
const PART: f64 = 1e-3;

const WIDTH: u32 = 860;

/// Runs `run` once more, for its curve, and draws it.
pub fn draw(picture: Picture, run: &Run) -> anyhow::Result<()> {
    let curve = run.curve(PART)?;
    let first = curve.points.first().context("a run has a start")?;
    let histories = Histories {
        panels: panels(run, &curve),
        marks: Marks::of(&curve.transitions.iter().map(|at| (at.time, at.kind)).collect::<Vec<_>>()),
        time: first.time..curve.finish.motion.time,
    };
    picture.draw((WIDTH, TITLE + histories.height()), |area| {
        histories.draw(&titled(area, run.ground.title(), &about(&run.structure, &curve))?)
    })
}

fn panels(run: &Run, curve: &Curve) -> Vec<Panel> {
    let g = run.structure.parameters().g;
    let over_time = |value: fn(&Point) -> f64| curve.points.iter().map(|at| (at.time, value(at))).collect();
    let peaks = &curve.peaks;
    let ground = Panel::of("ground acceleration", (g, "g"), colour::GREY, over_time(|at| at.a_g), peaks.a_g());
    let structure = [
        Panel::of("uplift", (1e-3, "mm"), colour::BLUE, over_time(|at| at.outputs.uplift), peaks.uplift()),
        Panel::of("acceleration a_t", (g, "g"), colour::BLUE, over_time(|at| at.outputs.a_t), peaks.a_t()),
        Panel::of("base shear V_t", (1e3, "kN"), colour::BLUE, over_time(|at| at.outputs.V_t), peaks.V_t()),
    ];
    // free vibration needs no panel of a ground at rest
    (peaks.a_g().magnitude > 0.0).then_some(ground).into_iter().chain(structure).collect()
}

/// The structure and what became of it, in a line.
fn about(structure: &Structure, curve: &Curve) -> String {
    let &Parameters { m, H, B, f_fc, .. } = structure.parameters();
    let (m, [H, base, f_fc]) = (mass(m), [H, 2.0 * B, f_fc].map(rounded));
    let end = match curve.finish.ending {
        Ending::Overturned => ", overturned",
        Ending::StillRocking => ", still rocking",
        Ending::AtRest | Ending::AtTime => "",
    };
    let count = curve.transitions.len();
    format!("{m} at {H} m on a base {base} m wide, {f_fc} Hz in full contact; {count} transitions{end}")
}
