//! Validity of a run: the limits of the model, in words and for programs.

use crate::quantities::PrintedNumber;
use crate::run::RunSetup;
use rocking::digits::significant;
use rocking::run::validity::{ASSUMPTIONS, Assumption, Findings, Limits, WEIGHT, Worst, of_structure};
use serde::Serialize;

/// Label of each of [`ASSUMPTIONS`].
const LABELS: [&str; ASSUMPTIONS.len()] = [
    "tension at base, fraction of W",
    "load of the edge, R_v/W",
    "friction, |R_h|/R_v",
    "friction of impacts, |I_h|/I_v",
    "impact tension, fraction of I_v",
    "energy gain, fraction of T",
    "weight, (g + a_v)/g",
];

/// The worst value in a run of one of the [`ASSUMPTIONS`], and its instant (s), for programs.
#[derive(Serialize)]
pub struct Beyond {
    pub name: &'static str,
    pub value: PrintedNumber,
    pub time: f64,
    pub limit: f64,
    /// When the limit was passed first, s.
    pub first_beyond: Option<f64>,
    /// For how long, s, or at how many impacts.
    pub beyond: f64,
}

/// Results for all assumptions, in a run in which this was `found`.
pub fn rows(found: &Findings, limits: &Limits) -> Vec<Beyond> {
    let row = |(assumption, worst): (&Assumption, &Worst)| {
        let Worst { value, time, first_beyond, beyond } = *worst;
        let (name, value, limit) = (assumption.name, PrintedNumber(value), (assumption.limit)(limits));
        Beyond { name, value, time, limit, first_beyond, beyond }
    };
    ASSUMPTIONS.iter().zip(&found.worst).map(row).collect()
}

impl RunSetup {
    /// The limits of the model in this run, in which this was `found`, line by line.
    pub fn section(&self, found: &Findings, limits: &Limits) -> Vec<String> {
        let mut lines = vec!["limits of the model".to_owned()];
        let warnings = of_structure(&self.structure, self.conditions.detail);
        lines.extend(warnings.into_iter().map(|warning| format!("  {warning}")));
        let is_level = found.worst[WEIGHT].value == 1.0;
        let shown = (0..ASSUMPTIONS.len()).filter(|which| *which != WEIGHT || !is_level);
        lines.extend(shown.map(|which| line(which, found, limits)));
        if self.structure.foundation().is_none() {
            lines.push(format!("  {:<34} {}", "energy gained at", of_impacts(found.gains, found.impacts)));
        }
        let held = match found.settlings {
            0 => "0".to_owned(),
            bursts => format!(
                "{bursts}, for {} in all, after too many transitions within one vibration period. Otherwise the model could \
                 switch between full contact and rocking without end, mostly if c_ratio is not 1",
                share(found.held, found.duration)
            ),
        };
        lines.push(format!("  {:<34} {held}", "contact held by the engine, times"));
        lines
    }
}

fn line(which: usize, found: &Findings, limits: &Limits) -> String {
    let Worst { value, time, first_beyond, beyond } = found.worst[which];
    let &Assumption { is_of_impacts, passing, limit, start, .. } = &ASSUMPTIONS[which];
    let limit = limit(limits);
    let passed = match first_beyond {
        None => format!("never {passing} {limit}"),
        Some(first) => {
            let amount =
                if is_of_impacts { of_impacts(beyond as u64, found.impacts) } else { share(beyond, found.duration) };
            format!("{passing} {limit} for {amount}, first at {} s", significant(first))
        }
    };
    if value == start && (is_of_impacts || start.is_infinite()) {
        return format!("  {:<34} {:>12}", LABELS[which], "none");
    }
    let (value, time) = (significant(value), significant(time));
    format!("  {:<34} {value:>12} at {time:>9} s; {passed}", LABELS[which])
}

fn of_impacts(count: u64, impacts: u64) -> String {
    format!("{count} of {impacts} impacts")
}

/// A part of the time, in percent to two digits.
fn share(time: f64, duration: f64) -> String {
    let percent = 100.0 * time / duration;
    let decimals = (1.0 - percent.log10().floor()).clamp(0.0, 9.0) as usize;
    format!("{percent:.decimals$} % of the time")
}
