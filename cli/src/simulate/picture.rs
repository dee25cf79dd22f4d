//! The picture of a run: ground, rotation, displacements and acceleration over time, marks at the transitions.
use crate::picture::{
    Picture, TITLE, colour,
    histories::{Histories, Panel},
    rounded, titled,
};
use rocking::Structure;
use rocking::digits::short;
use rocking::run::{Ending, RunError};
use rocking_report::page::{Sizes, sizes};
use rocking_report::quantities::in_readable_unit;
use rocking_report::run::{Curve, Found, Run};
use rocking_report::summary::instant;

/// Part of a peak by which a line may miss the motion: less than its width, or than three times its width if the run takes too many
/// points.
const PARTS: [f64; 2] = [1e-3, 1e-2];

const WIDTH: u32 = 860;

/// Runs `run` once more and draws it with its peaks.
pub fn draw(picture: Picture, run: &Run) -> anyhow::Result<()> {
    let curve = match run.curve(PARTS[0]) {
        Err(RunError::TooManyPoints { .. }) => run.curve(PARTS[1])?,
        curve => curve?,
    };
    let found = &curve.found;
    let histories = Histories {
        panels: panels(run, &curve),
        transitions: found.events.iter().map(|at| (at.time, at.kind)).collect(),
        time: found.start..found.end,
        fall: found.fall,
    };
    picture.draw((WIDTH, TITLE + histories.height()), |area| {
        histories.draw(&titled(area, run.ground.title(), &about(&run.structure, found))?)
    })
}

/// Ground acceleration, rotation, displacements and acceleration; of many masses those of the top floor.
fn panels(run: &Run, curve: &Curve) -> Vec<Panel> {
    let g = run.structure.base().g;
    let peak = |name: &str| curve.found.peak(name).unwrap_or_default();
    let panel = |(label, unit, name, more): (&str, _, &str, Option<String>)| {
        let (_, values) = curve.columns.iter().find(|(of, _)| of == name)?;
        let points = curve.times.iter().copied().zip(values.iter().copied()).collect();
        let colour = if name == "a_g" { colour::GREY } else { colour::BLUE };
        let panel = Panel::of(label, unit, colour, points, peak(name));
        Some(more.into_iter().fold(panel, Panel::with))
    };
    let (mm, rad, in_g) = ((1e-3, "mm"), (1.0, "rad"), (g, "g"));
    if run.structure.one().is_none() {
        let [u, a_t] = ["u", "a_t"].map(|of| format!("{of}[{}]", run.structure.floors().len()));
        let base = [("ground a_g", in_g, "a_g", None), ("rotation θ", rad, "theta", None)];
        return base.into_iter().chain([(&*u, mm, &*u, None), (&*a_t, in_g, &*a_t, None)]).filter_map(panel).collect();
    }
    let uplift = format!("uplift {} mm", rounded(1e3 * peak("uplift").magnitude));
    let V_t = format!("V_t {}", in_readable_unit(peak("V_t").magnitude, "N", rounded));
    let shown = [
        ("ground acceleration", in_g, "a_g", None),
        ("rotation θ", rad, "theta", Some(uplift)),
        ("displacement u", mm, "u", None),
        ("displacement δ_t", mm, "delta_t", None),
        ("acceleration a_t", in_g, "a_t", Some(V_t)),
    ];
    shown.into_iter().filter_map(panel).collect()
}

/// The structure and what became of it, in a line.
fn about(structure: &Structure, found: &Found) -> String {
    let Sizes { m, H, B, f_fc, floors, .. } = sizes(structure);
    let [kg, t, H, base, f_fc] = [m, 1e-3 * m, H, 2.0 * B, f_fc].map(short);
    let masses = match floors {
        None => format!("{kg} kg at {H} m"),
        Some(floors) => format!("{} floors, {t} t", floors.len()),
    };
    let end = match (found.ending, found.fall) {
        (_, Some(fall)) => format!(", falls from {} s on, peaks until then", instant(fall)),
        (Ending::Overturned, None) => ", overturned".into(),
        (Ending::StillRocking, None) => ", still rocking".into(),
        (Ending::AtRest | Ending::AtTime, None) => String::new(),
    };
    format!("{masses} on a base {base} m wide, {f_fc} Hz in full contact; {} transitions{end}", found.transitions)
}
