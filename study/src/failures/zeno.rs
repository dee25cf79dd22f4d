//! Zeno at rest in the rigid limit.

use super::*;

/// Evison's specimen with a coefficient of restitution low enough to come to rest soon.
pub const STRUCTURE: Parameters = Parameters { r: 0.9, ..Parameters::EVISON };

const FREQUENCIES: [f64; 4] = [11.0, 50.0, 200.0, 1000.0];

/// Times (s) between successive impacts before the first landing, by number.
pub fn intervals(transitions: &[Transition]) -> Vec<(f64, f64)> {
    let impacts: Vec<_> = transitions.iter().take_while(|transition| is_impact(transition)).collect();
    impacts.windows(2).enumerate().map(|(k, pair)| ((k + 1) as f64, pair[1].time - pair[0].time)).collect()
}

/// A rigid block that comes to rest, and flexible structures ever stiffer.
pub fn show() -> Result<Exhibit> {
    let released = |parameters: Parameters, detail| {
        let initial = State { theta: 0.04, u: structure(parameters).u_cr, ..State::default() };
        Ok::<_, anyhow::Error>(exact(&at_rest(parameters, initial, 4.0), detail, [])?.transitions)
    };
    let rigid = released(STRUCTURE, Detail::Rigid)?;
    let impacts: Vec<_> = rigid.iter().filter(|transition| is_impact(transition)).collect();
    let (number, last) = (impacts.len(), impacts.last().map_or(0.0, |impact| impact.time));
    let (mut curves, mut counts) = (vec![series("rigid: without end", intervals(&rigid))], Vec::new());
    for f_fc in FREQUENCIES {
        let gaps = intervals(&released(Parameters { f_fc, ..STRUCTURE }, Detail::Nonlinear)?);
        counts.push(format!("{} at {f_fc} Hz", gaps.len() + 1));
        curves.push(series(format!("{f_fc} Hz lands here"), gaps.last().copied()));
    }
    Ok(Exhibit {
        key: "zeno",
        values: values([("number", &number), ("last", &last), ("counts", &counts.join(", "))]),
        series: curves,
    })
}
