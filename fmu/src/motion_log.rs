//! The messages to the host about the motion: its transitions, and the limits of the model that it passes.

use fmi_unit::Logger;
use rocking::run::Runs;
use rocking::run::validity::{ASSUMPTIONS, Findings, Limits};
use rocking::{Friction, Side, Transition, TransitionKind};

/// Warns of the limits that `found` is beyond and `known`, found before, was not.
pub(crate) fn warn(logger: &Logger, known: &Findings, found: &Findings) {
    let is_new =
        |which: &usize| found.worst[*which].first_beyond.is_some() && known.worst[*which].first_beyond.is_none();
    (0..ASSUMPTIONS.len())
        .filter(is_new)
        .filter_map(|which| found.warning(which, &Limits::default()))
        .for_each(|warning| logger.warning(|| warning));
}

/// An event; where contact is held by force, which is not the model's, a warning.
pub(crate) fn log<Q: Runs>(logger: &Logger, shows_u: bool, transition: &Transition<Q>) {
    match transition.kind {
        TransitionKind::Settling => logger.warning(|| {
            format!(
                "{}; too many transitions within one vibration period: contact is held for the rest of it",
                describe(shows_u, transition)
            )
        }),
        _ => logger.event(|| describe(shows_u, transition)),
    }
}

/// Warns that a ground acceleration, of which values alone are set, is held over each step up to `time` (s).
#[cold]
pub(crate) fn warn_of_stairs(logger: &Logger, time: f64) {
    logger.warning(|| {
        format!(
            "t = {time} s: the host sets new values of the ground acceleration (a_g, a_v) at every step without their \
             slopes, and each value is held over its step: the peaks of such a stepped motion can be tens of per cent off. \
             Give the ground motion as the parameter record, or set a_g_late = true, or set the slope (the time \
             derivative) with each value"
        )
    });
}

fn describe<Q: Runs>(shows_u: bool, transition: &Transition<Q>) -> String {
    let Transition { time, kind, before, after } = transition;
    let side = |side| if side == Side::Left { "left" } else { "right" };
    let what = match *kind {
        TransitionKind::Uplift(pivot) => format!("uplift, rocking about the {} edge", side(pivot)),
        TransitionKind::Impact(pivot) => format!("impact, rocking on about the {} edge", side(pivot)),
        TransitionKind::Landing | TransitionKind::Settling => "landing in full contact".to_owned(),
        TransitionKind::Overturning(pivot) => format!("overturning about the {} edge", side(pivot)),
        TransitionKind::Touch(point) | TransitionKind::Release(point) => {
            format!("{} of contact point {}", kind.name(), point + 1)
        }
        TransitionKind::Settles(point) => {
            format!("contact point {} yields: the ground settles there for good", point + 1)
        }
        TransitionKind::Holds(point) => format!("contact point {} yields no more", point + 1),
        TransitionKind::Friction(Friction::Sticks) => "the base sticks to the ground".to_owned(),
        TransitionKind::Friction(Friction::Slides(way)) => format!("the base slides to the {}", side(way)),
        TransitionKind::Friction(Friction::Free) => "the base leaves the ground".to_owned(),
        kind => kind.name().to_owned(),
    };
    let of_one = shows_u.then(|| {
        let [u, u_dot, u_dot_before] = [after.u, after.u_dot, before.u_dot].map(|of| of.of(0));
        format!("u = {u} m, u_dot = {u_dot} m/s (before: {u_dot_before}), ")
    });
    let [turning, turning_before] = [after, before].map(|state| state.theta_dot);
    format!(
        "t = {time} s: {what}; {}theta_dot = {turning} rad/s (before: {turning_before})",
        of_one.unwrap_or_default()
    )
}
