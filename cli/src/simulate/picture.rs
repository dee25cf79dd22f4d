//! The picture of a run: ground, rotation, displacements and acceleration over time, marks at the transitions.
use crate::picture::{
    Picture, TITLE, colour,
    histories::{Histories, Panel},
    rounded, titled,
};
use anyhow::Context;
use rocking::digits::short;
use rocking::structure::any::OF_MODE;
use rocking::{
    Frame, FrameOutput, Modes, Parameters, Run, Structure, Transition,
    run::{
        Ending,
        curve::{Curve, Point},
        fall::{Found, Peaked},
    },
};
use rocking_report::{quantities::in_readable_unit, shown::Shown, summary::instant};

/// Part of a peak by which a line may miss the motion: less than its width.
const PART: f64 = 1e-3;

const WIDTH: u32 = 860;

/// Samples of a run of many masses for each pixel of the width.
const SAMPLES: usize = 20;

/// Structures whose runs are drawn.
pub trait Pictured: Shown {
    /// Runs `run` once more and draws it with its peaks.
    fn draw(picture: Picture, run: &Run<Self>) -> anyhow::Result<()>;
}

impl Pictured for f64 {
    fn draw(picture: Picture, run: &Run) -> anyhow::Result<()> {
        let curve = run.curve(PART)?;
        let first = curve.points.first().context("a run has a start")?;
        let histories = Histories {
            panels: panels(run, &curve),
            transitions: curve.transitions.iter().map(|at| (at.time, at.kind)).collect(),
            time: first.time..curve.found.finish.motion.time,
            fall: curve.found.fall,
        };
        let about = about(&run.structure, &curve.found, curve.transitions.len());
        picture.draw((WIDTH, TITLE + histories.height()), |area| {
            histories.draw(&titled(area, run.ground.title(), &about)?)
        })
    }
}

impl Pictured for Modes {
    fn draw(picture: Picture, run: &Run<Modes>) -> anyhow::Result<()> {
        let mut transitions = Vec::new();
        let found = run.found(&mut |at: &Transition<Modes>| transitions.push((at.time, at.kind)))?;
        let (start, end) = (found.start, found.finish.motion.time);
        let parts = WIDTH as usize * SAMPLES;
        let even = (0..parts).map(|i| start + (end - start) * i as f64 / parts as f64);
        let mut times: Vec<f64> = even.chain(found.peaks.peaks().map(|(_, peak)| peak.time)).collect();
        times.extend(transitions.iter().map(|(time, _)| *time));
        times.sort_by(f64::total_cmp);
        let floors = run.structure.floors().len();
        let top: Vec<_> =
            [FrameOutput::u, FrameOutput::a_t].into_iter().map(|of| floors.checked_sub(1).map(of)).collect();
        let shown: Vec<_> = [Some(FrameOutput::theta)].into_iter().chain(top).flatten().collect();
        let mut points = vec![Vec::new(); 1 + shown.len()];
        let see = |sample: &rocking::engine::piece::Sample<Modes>| {
            let values = [sample.load.a_g].into_iter().chain(shown.iter().map(|of| sample.output(*of)));
            points.iter_mut().zip(values).for_each(|(points, value)| points.push((sample.motion.time, value)));
        };
        run.sample(times, see, &mut ())?;
        let g = run.structure.base().g;
        let peaks = shown.iter().map(|of| found.peaks.of(*of).unwrap_or_default());
        let mut panels = Vec::new();
        for (i, (points, peak)) in points.into_iter().zip([found.ground].into_iter().chain(peaks)).enumerate() {
            let (name, unit, colour) = match i {
                0 => ("ground a_g".to_owned(), (g, "g"), colour::GREY),
                1 => ("rotation θ".to_owned(), (1.0, "rad"), colour::BLUE),
                2 => (format!("u[{floors}]"), (1e-3, "mm"), colour::BLUE),
                _ => (format!("a_t[{floors}]"), (g, "g"), colour::BLUE),
            };
            panels.push(Panel::of(&name, unit, colour, points, peak));
        }
        let about = about_many(&run.structure, &found, transitions.len());
        let histories = Histories { panels, transitions, time: start..end, fall: found.fall };
        picture.draw((WIDTH, TITLE + histories.height()), |area| {
            histories.draw(&titled(area, run.ground.title(), &about)?)
        })
    }
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
fn about(structure: &Structure, found: &Found, transitions: usize) -> String {
    let &Parameters { m, H, B, f_fc, .. } = structure.parameters();
    let [m, H, base, f_fc] = [m, H, 2.0 * B, f_fc].map(short);
    let end = ended(found, transitions);
    format!("{m} kg at {H} m on a base {base} m wide, {f_fc} Hz in full contact; {end}")
}

/// The structure of many masses and what became of it, in a line.
pub fn about_many(frame: &Frame, found: &Found<Modes>, transitions: usize) -> String {
    let f = frame.mode_table().next().map_or(f64::NAN, |mode| (OF_MODE[0].value)(&mode));
    let [mass, base, f] = [1e-3 * frame.body().m_s, 2.0 * frame.base().B, f].map(short);
    let (floors, end) = (frame.floors().len(), ended(found, transitions));
    format!("{floors} floors, {mass} t on a base {base} m wide, {f} Hz in full contact; {end}")
}

/// The transitions and the end of a run.
fn ended<Q: Peaked>(found: &Found<Q>, transitions: usize) -> String {
    let end = match (found.finish.ending, found.fall) {
        (_, Some(fall)) => format!(", falls from {} s on, peaks until then", instant(fall)),
        (Ending::Overturned, None) => ", overturned".into(),
        (Ending::StillRocking, None) => ", still rocking".into(),
        (Ending::AtRest | Ending::AtTime, None) => String::new(),
    };
    format!("{transitions} transitions{end}")
}
