//! What `simulate` prints at the end of a run.
use crate::talk::say;
use fmu_export::significant::significant;
use rocking::run::{Ending, Finish, LONGEST_REST, peaks::Peaks};
use rocking::{Parameters, Phase, Side, Structure, Transition, TransitionKind, Watch};

/// First transitions of a run.
pub struct Summary {
    structure: Structure,
    first_uplift: Option<f64>,
    first_impact: Option<f64>,
}

impl Watch for Summary {
    const SEES_PIECES: bool = false;

    fn transition(&mut self, transition: &Transition) {
        let first = match transition.kind {
            TransitionKind::Uplift(_) => &mut self.first_uplift,
            TransitionKind::Impact(_) | TransitionKind::Landing | TransitionKind::Settling => &mut self.first_impact,
            TransitionKind::Overturning(_) => return,
        };
        first.get_or_insert(transition.time);
    }
}

impl Summary {
    /// Of a run of `structure`, nothing seen yet.
    pub fn new(structure: &Structure) -> Summary {
        Summary { structure: *structure, first_uplift: None, first_impact: None }
    }

    /// Prints it all, with the `peaks` and what the run counted and came to, on standard error.
    pub fn print(&self, peaks: &Peaks, &Finish { ending, motion }: &Finish) {
        let &Parameters { g, .. } = self.structure.parameters();
        for (name, peak, unit, per_unit) in [
            ("a_g", peaks.a_g(), "g", g),
            ("theta", peaks.theta(), "rad", 1.0),
            ("u", peaks.u(), "mm", 1e-3),
            ("delta_t", peaks.delta_t(), "mm", 1e-3),
            ("uplift", peaks.uplift(), "mm", 1e-3),
            ("a_t", peaks.a_t(), "g", g),
            ("V_t", peaks.V_t(), "N", 1.0),
            ("M_t", peaks.M_t(), "N.m", 1.0),
        ] {
            let [magnitude, time] = [peak.magnitude / per_unit, peak.time].map(significant);
            say!("{:<14} {magnitude:>12} {unit:<4} at {time} s", format!("peak |{name}|"));
        }
        let instant = |time: Option<f64>| time.map_or("none".into(), |time| format!("at {} s", significant(time)));
        say!("first uplift   {}", instant(self.first_uplift));
        say!("first impact   {}", instant(self.first_impact));
        say!("transitions    {}", motion.transitions);
        let overturned = match motion.phase {
            Phase::Overturned(Side::Left) => format!("to the left at {} s", significant(motion.time)),
            Phase::Overturned(Side::Right) => format!("to the right at {} s", significant(motion.time)),
            Phase::FullContact | Phase::Rocking(_) => match ending {
                Ending::StillRocking => {
                    let limit = significant(LONGEST_REST / self.structure.p_l);
                    format!("not known: it still rocks {limit} s after the record; see --duration")
                }
                Ending::AtTime => "not by then".into(),
                Ending::AtRest | Ending::Overturned => "no".into(),
            },
        };
        say!("overturned     {overturned}");
        let (work, of_peaks) = (motion.work, peaks.evaluations());
        say!("work           {} steps, {} evaluations; {of_peaks} more for peaks", work.steps, work.evaluations);
    }
}
