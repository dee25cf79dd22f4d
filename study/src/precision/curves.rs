//! The methods that are compared, each with its settings from coarse to fine.

use super::Family;
use crate::engine;
use crate::fixed_step::TEXTBOOK;
use crate::fmu::Fmu;
use crate::guards::uplift_excess;
use crate::hybrid::{self, Grid, Integrator, Transitions};
use crate::libraries::differential_equations::DifferentialEquations;
use crate::libraries::diffsol::{self, Diffsol};
use crate::libraries::ode_solvers::{OdeSolvers, Pair};
use crate::response::Response;
use crate::scene::{Input, Scene};
use anyhow::Result;
use rocking::Detail;
use rocking::engine::DEFAULT_TOLERANCE;
use std::rc::Rc;

/// One method.
pub struct Method<'a> {
    pub name: String, // name on charts
    pub family: Family,
    pub setting: &'static str,      // what its setting is, with unit
    pub settings: Vec<Setting<'a>>, // from coarse to fine
}

/// One setting of a method.
pub struct Setting<'a> {
    pub value: f64,                          // step in s, or tolerance
    pub run: Box<dyn Fn() -> Response + 'a>, // A run of the whole scene
    /// Counts the evaluations, where the run itself does not.
    pub evaluations: Option<Box<dyn Fn() -> u64 + 'a>>,
}

/// Steps per sample: 1, 2, 4, …
const HALVINGS: u32 = 14;

/// Every method on `scene`.
pub fn methods(scene: &Scene) -> Result<Vec<Method<'_>>> {
    let ours = Detail::ALL.into_iter().map(|detail| Method {
        name: format!("this project, {}", detail.name()),
        family: if detail == Detail::Auto { Family::Ours } else { Family::Level },
        setting: "tolerance",
        settings: tolerances(move |tolerance| Box::new(move || engine::run(scene, detail, tolerance, &mut ()))),
    });
    let mut methods: Vec<_> = ours.collect();
    for (family, transitions) in
        [(Family::Located, Transitions::Located), (Family::AtStepEnds, Transitions::AtStepEnds)]
    {
        methods.extend(TEXTBOOK.iter().map(|textbook| {
            Method {
                name: textbook.name.into(),
                family,
                setting: "step, s",
                settings: (0..HALVINGS)
                    .map(|k| {
                        let h = scene.dt() / f64::from(1 << k);
                        let grid = Grid { method: textbook.method, h };
                        Setting { value: h, run: hybrid(scene, grid, transitions), evaluations: None }
                    })
                    .collect(),
            }
        }));
    }
    methods.extend(libraries(scene));
    methods.extend(fmu(scene)?);
    Ok(methods)
}

fn hybrid<'a>(
    scene: &'a Scene,
    integrator: impl Integrator + 'a,
    transitions: Transitions,
) -> Box<dyn Fn() -> Response + 'a> {
    Box::new(move || hybrid::run(scene, &integrator, transitions, uplift_excess, &mut |_, _| ()))
}

/// A setting for each tolerance, decade by decade.
fn tolerances<'a>(run: impl Fn(f64) -> Box<dyn Fn() -> Response + 'a>) -> Vec<Setting<'a>> {
    let tolerance = |k: i32| 10f64.powi(-k);
    (1..=13).map(|k| Setting { value: tolerance(k), run: run(tolerance(k)), evaluations: None }).collect()
}

fn libraries(scene: &Scene) -> [Method<'_>; 6] {
    use Transitions::{AtStepEnds, Located};
    let method =
        |name: &str, settings| Method { name: name.into(), family: Family::Library, setting: "tolerance", settings };
    let pair = |pair| tolerances(move |tolerance| hybrid(scene, OdeSolvers { pair, tolerance }, Located));
    let diffsol = |method| tolerances(move |tolerance| hybrid(scene, Diffsol { method, tolerance }, AtStepEnds));
    let with_events = |own_events, transitions| {
        tolerances(move |tolerance| hybrid(scene, DifferentialEquations { tolerance, own_events }, transitions))
    };
    [
        method("ode_solvers Dopri5", pair(Pair::Dopri5)),
        method("ode_solvers Dop853", pair(Pair::Dop853)),
        method("diffsol BDF, its root finding", diffsol(diffsol::Method::Bdf)),
        method("diffsol ESDIRK34, its root finding", diffsol(diffsol::Method::Esdirk34)),
        method("differential-equations DOP853, its events", with_events(true, AtStepEnds)),
        method("differential-equations DOP853", with_events(false, Located)),
    ]
}

fn fmu(scene: &Scene) -> Result<Vec<Method<'_>>> {
    let fmu = Rc::new(Fmu::new(scene, DEFAULT_TOLERANCE)?);
    let inputs = [
        ("FMU, input held", Input::Constant),
        ("FMU, input with slope", Input::Linear),
        ("FMU, record inside", Input::Inside),
    ];
    let method = |(name, input): (&str, Input)| Method {
        name: name.into(),
        family: Family::Fmu,
        setting: "communication step, s",
        settings: (0..HALVINGS)
            .map(|k| {
                let cuts = 1 << k;
                let evaluations = move || engine::evaluations(scene, DEFAULT_TOLERANCE, input, cuts);
                let fmu = Rc::clone(&fmu);
                Setting {
                    value: scene.dt() / cuts as f64,
                    run: Box::new(move || fmu.run(input, cuts)),
                    evaluations: Some(Box::new(evaluations)),
                }
            })
            .collect(),
    };
    Ok(inputs.into_iter().map(method).collect())
}
