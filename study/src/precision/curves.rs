//! The methods that are compared, each with its settings from coarse to fine.

use crate::engine;
use crate::fixed_step::TEXTBOOK;
use crate::guards::uplift_excess;
use crate::hybrid::{self, Grid, Integrator, Transitions};
use crate::libraries::differential_equations::DifferentialEquations;
use crate::libraries::diffsol::{self, Diffsol};
use crate::libraries::ode_solvers::{OdeSolvers, Pair};
use crate::response::Response;
use crate::scene::StudyScene;
use rocking::Detail;

type RunScene<'a> = Box<dyn Fn() -> Response + 'a>;

pub struct MethodSweep<'a> {
    pub name: String,                       // name on charts
    pub setting: &'static str,              // what its setting is, with unit
    pub settings: Vec<(f64, RunScene<'a>)>, // step in s or tolerance, from coarse to fine
}

/// Steps per sample: 1, 2, 4, …
const HALVINGS: u32 = 14;

/// Every method on `scene`.
pub fn methods(scene: &StudyScene) -> Vec<MethodSweep<'_>> {
    let ours = Detail::ALL.into_iter().map(|detail| MethodSweep {
        name: format!("this project, {}", detail.name()),
        setting: "tolerance",
        settings: tolerances(move |tolerance| Box::new(move || engine::run(scene, detail, tolerance, &mut ()))),
    });
    let mut methods: Vec<_> = ours.collect();
    for (transitions, addition) in [(Transitions::Located, ""), (Transitions::AtStepEnds, ", transitions at step ends")]
    {
        methods.extend(TEXTBOOK.iter().map(|textbook| MethodSweep {
            name: format!("{}{addition}", textbook.name),
            setting: "step, s",
            settings: cuts(scene, |cuts| {
                let h = scene.dt() / cuts as f64;
                hybrid(scene, Grid { method: textbook.method, h }, transitions)
            }),
        }));
    }
    methods.extend(libraries(scene));
    methods.push(MethodSweep {
        name: "this project, input held".into(),
        setting: "communication step, s",
        settings: cuts(scene, |cuts| Box::new(move || engine::held(scene, cuts))),
    });
    methods
}

fn hybrid<'a>(scene: &'a StudyScene, integrator: impl Integrator + 'a, transitions: Transitions) -> RunScene<'a> {
    Box::new(move || hybrid::run(scene, &integrator, transitions, uplift_excess, &mut |_, _| ()))
}

/// A setting for each tolerance, decade by decade.
fn tolerances<'a>(run: impl Fn(f64) -> RunScene<'a>) -> Vec<(f64, RunScene<'a>)> {
    (1..=13).map(|k| 10f64.powi(-k)).map(|tolerance| (tolerance, run(tolerance))).collect()
}

/// A setting for each number of steps to a sample.
fn cuts<'a>(scene: &StudyScene, run: impl Fn(usize) -> RunScene<'a>) -> Vec<(f64, RunScene<'a>)> {
    (0..HALVINGS).map(|k| 1 << k).map(|cuts| (scene.dt() / cuts as f64, run(cuts))).collect()
}

fn libraries(scene: &StudyScene) -> [MethodSweep<'_>; 6] {
    use Transitions::{AtStepEnds, Located};
    let method = |name: &str, settings| MethodSweep { name: name.into(), setting: "tolerance", settings };
    let pair = |pair| tolerances(move |tolerance| hybrid(scene, OdeSolvers { pair, tolerance }, Located));
    let diffsol = |method| tolerances(move |tolerance| hybrid(scene, Diffsol { method, tolerance }, AtStepEnds));
    let with_events = |own_events, transitions| {
        tolerances(move |tolerance| hybrid(scene, DifferentialEquations { tolerance, own_events }, transitions))
    };
    [
        method("ode_solvers Dopri5", pair(Pair::Dopri5)),
        method("ode_solvers Dop853", pair(Pair::Dop853)),
        method("diffsol BDF, its root finding", diffsol(diffsol::DiffsolMethod::Bdf)),
        method("diffsol ESDIRK34, its root finding", diffsol(diffsol::DiffsolMethod::Esdirk34)),
        method("differential-equations DOP853, its events", with_events(true, AtStepEnds)),
        method("differential-equations DOP853", with_events(false, Located)),
    ]
}
