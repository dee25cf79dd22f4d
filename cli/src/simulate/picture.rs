//! The picture of a run: ground, rotation, displacements and acceleration over time, marks at the transitions.
use crate::picture::{
    Picture, TITLE, colour,
    histories::{Histories, Panel},
    rounded, titled,
};
use crate::significant::short;
use anyhow::Context;
use rocking::{
    Parameters, Run, Structure,
    run::{
        Ending,
        curve::{Curve, Point},
        fall::Found,
    },
};
use rocking_report::{quantities::in_readable_unit, summary::instant};

/// Part of a peak by which a line may miss the motion: less than its width.
const PART: f64 = 1e-3;

const WIDTH: u32 = 860;

/// Runs `run` once more, for its curve, and draws it with its peaks.
pub fn draw(picture: Picture, run: &Run) -> anyhow::Result<()> {
    let curve = run.curve(PART)?;
    let first = curve.points.first().context("a run has a start")?;
    let histories = Histories {
        panels: panels(run, &curve),
        transitions: curve.transitions.iter().map(|at| (at.time, at.kind)).collect(),
        time: first.time..curve.found.finish.motion.time,
        fall: curve.found.fall,
    };
    picture.draw((WIDTH, TITLE + histories.height()), |area| {
        histories.draw(&titled(area, run.ground.title(), &about(&run.structure, &curve))?)
    })
}

fn panels(run: &Run, curve: &Curve) -> Vec<Panel> {
    let Found { ground, peaks, .. } = &curve.found;
    let g = run.structure.parameters().g;
    let over_time = |value: fn(&Point) -> f64| curve.points.iter().map(|at| (at.time, value(at))).collect();
    let panel = |name, unit, value, peak| Panel::of(name, unit, colour::BLUE, over_time(value), peak);
    let uplift = rounded(1e3 * peaks.uplift().magnitude);
    let V_t = in_readable_unit(peaks.V_t().magnitude, "N", rounded);
    vec![
        Panel::of("ground acceleration", (g, "g"), colour::GREY, over_time(|at| at.a_g), *ground),
        panel("rotation θ", (1.0, "rad"), |at| at.outputs.theta, peaks.theta()).with(format!("uplift {uplift} mm")),
        panel("displacement u", (1e-3, "mm"), |at| at.outputs.u, peaks.u()),
        panel("displacement δ_t", (1e-3, "mm"), |at| at.outputs.delta_t, peaks.delta_t()),
        panel("acceleration a_t", (g, "g"), |at| at.outputs.a_t, peaks.a_t()).with(format!("V_t {V_t}")),
    ]
}

/// The structure and what became of it, in a line.
fn about(structure: &Structure, curve: &Curve) -> String {
    let &Parameters { m, H, B, f_fc, .. } = structure.parameters();
    let [m, H, base, f_fc] = [m, H, 2.0 * B, f_fc].map(short);
    let end = match (curve.found.finish.ending, curve.found.fall) {
        (_, Some(fall)) => format!(", falls from {} s on, peaks until then", instant(fall)),
        (Ending::Overturned, None) => ", overturned".into(),
        (Ending::StillRocking, None) => ", still rocking".into(),
        (Ending::AtRest | Ending::AtTime, None) => String::new(),
    };
    let count = curve.transitions.len();
    format!("{m} kg at {H} m on a base {base} m wide, {f_fc} Hz in full contact; {count} transitions{end}")
}
