//! The differences between structures of one mass and structures of many masses.

use crate::advance::{Told, Watching};
use crate::inputs::Inputs;
use crate::resources::Contents;
use crate::shown::Shown;
use crate::variables::Source;
use rocking::mechanics::load::{LOADS, VERTICAL};
use rocking::run::peak_watch::Peaked;
use rocking::run::peaks::Peak;
use rocking::run::validity::Judged;
use rocking::{Engine, FrameOutput, LinearLoad, Load, Modes, Outputs, Reactions, State, Structure, Transition, Watch};
use serde::Serialize;
use serde::de::DeserializeOwned;

/// The place of F_t in [`LOADS`].
const FORCE: usize = 1;

/// Lateral coordinates of the structures that a unit can move.
pub trait Masses:
    Judged + Peaked<Peaks: Serialize + DeserializeOwned> + Default + Serialize + DeserializeOwned
{
    /// The outputs that are computed together.
    type Outputs: Copy;

    /// Inputs that are 0.
    fn inputs(contents: &Contents) -> Inputs;

    /// The load on `structure`, given the value of each input by its place.
    fn load(structure: &Structure, input: impl Fn(usize) -> f64) -> Load<Self>;

    /// The state at the start.
    fn initial(initial: &State) -> State<Self>;

    /// The outputs now under `load`.
    fn outputs(engine: &Engine<Self>, load: Load<Self>) -> Self::Outputs;

    /// The value of `source` if it is one of the `outputs`.
    fn output(source: &Source, outputs: &Self::Outputs) -> Option<f64>;

    /// The value of `source` if it is shown of these structures alone.
    fn own(source: Source, shown: &Shown<Self>) -> Option<f64>;

    /// The numbers of a state with so many lateral coordinates, in the order of the table.
    fn components(state: &State<Self>, lateral: usize) -> Vec<f64>;

    /// The state of `structure` with these `components`.
    fn state(components: &[f64], structure: &Structure) -> State<Self>;

    /// The motion of a `transition` in words.
    fn told(transition: &Transition<Self>) -> String;

    /// The watcher of a motion of which nothing but transitions is `told`.
    fn listener(told: &mut Told<'_, Self>) -> impl Watch<Self>;

    /// The rates of outputs and of the reactions under `load`.
    fn rates(engine: &Engine<Self>, load: LinearLoad<Self>) -> (impl Fn(Source) -> Option<f64>, Reactions);
}

impl Masses for f64 {
    type Outputs = Outputs;

    fn inputs(_: &Contents) -> Inputs {
        Inputs::new(0..LOADS.len())
    }

    #[inline(always)]
    fn load(_: &Structure, input: impl Fn(usize) -> f64) -> Load {
        Load { a_g: input(0), F_t: input(1), a_v: input(VERTICAL) }
    }

    fn initial(initial: &State) -> State {
        *initial
    }

    #[inline(always)]
    fn outputs(engine: &Engine, load: Load) -> Outputs {
        engine.outputs(load)
    }

    #[inline(always)]
    fn output(source: &Source, outputs: &Outputs) -> Option<f64> {
        if let Source::Output(of) = source { Some(of(outputs)) } else { None }
    }

    fn own(source: Source, shown: &Shown) -> Option<f64> {
        let &Shown { scene, setup, load, .. } = shown;
        Some(match source {
            Source::Output(of) => of(&shown.outputs),
            Source::StateRate(which) => shown.state_rates().components()[which],
            Source::Peak(_) if !setup.peaks || scene.is_integrated_outside() => f64::NAN,
            Source::Peak(of) => of(scene.peaks(load).peaks()),
            Source::Derived(derived) => (derived.value)(scene.engine.structure().one()?),
            _ => return None,
        })
    }

    fn components(state: &State, _: usize) -> Vec<f64> {
        state.components().into()
    }

    fn state(components: &[f64], _: &Structure) -> State {
        State::of(std::array::from_fn(|at| components[at]))
    }

    fn told(Transition { before, after, .. }: &Transition) -> String {
        format!(
            "u = {} m, u_dot = {} m/s (before: {}), theta_dot = {} rad/s (before: {})",
            after.u, after.u_dot, before.u_dot, after.theta_dot, before.theta_dot
        )
    }

    #[inline(always)]
    fn listener(told: &mut Told<'_, f64>) -> impl Watch {
        told
    }

    fn rates(engine: &Engine, load: LinearLoad) -> (impl Fn(Source) -> Option<f64>, Reactions) {
        let (outputs, reactions) = engine.rates(load);
        (move |source| f64::output(&source, &outputs), reactions)
    }
}

impl Masses for Modes {
    type Outputs = ();

    /// a_g and a_v, then a force on each floor.
    fn inputs(contents: &Contents) -> Inputs {
        Inputs::new([0, VERTICAL].into_iter().chain(contents.structure.floors().iter().map(|_| FORCE)))
    }

    fn load(frame: &Structure, input: impl Fn(usize) -> f64) -> Load<Modes> {
        let forces: Vec<_> = (2..).map(&input).take(frame.floors().len()).collect();
        frame.load(input(0), input(1), &forces).expect("each floor has a force")
    }

    fn initial(&State { theta, theta_dot, .. }: &State) -> State<Modes> {
        State { theta, theta_dot, ..State::default() }
    }

    fn outputs(_: &Engine<Modes>, _: Load<Modes>) {}

    fn output(_: &Source, (): &()) -> Option<f64> {
        None
    }

    fn own(source: Source, shown: &Shown<Modes>) -> Option<f64> {
        let &Shown { scene, setup, load, .. } = shown;
        let peak = |place| {
            if !setup.peaks || scene.is_integrated_outside() {
                return Peak { magnitude: f64::NAN, time: f64::NAN };
            }
            scene.peaks(load).peaks().peaks().nth(place).expect("the table is of this structure").1
        };
        let component = |state, which: usize| Modes::components(state, scene.lateral)[which];
        Some(match source {
            Source::Floor(place) => shown.sample().output(output(&scene.engine, place)),
            Source::Coordinate(which) => component(&scene.engine.motion().state, which),
            Source::StateRate(which) => component(shown.state_rates(), which),
            Source::FloorPeak(place) => peak(place).magnitude,
            Source::FloorPeakInstant(place) => peak(place).time,
            Source::Known(value) => value,
            _ => return None,
        })
    }

    fn components(State { u, u_dot, theta, theta_dot }: &State<Modes>, lateral: usize) -> Vec<f64> {
        let mut components = vec![0.0; 2 * lateral]; // the level rigid has none
        components[..u.numbers().len()].copy_from_slice(u.numbers());
        components[lateral..][..u_dot.numbers().len()].copy_from_slice(u_dot.numbers());
        components.extend([*theta, *theta_dot]);
        components
    }

    fn state(components: &[f64], frame: &Structure) -> State<Modes> {
        let (lateral, turning) = components.split_at(components.len() - 2);
        let (u, u_dot) = lateral.split_at(lateral.len() / 2);
        let [u, u_dot] = [u, u_dot].map(|numbers| Modes::new(&numbers[..frame.modes().len()]));
        State { u, u_dot, theta: turning[0], theta_dot: turning[1] }
    }

    fn told(Transition { before, after, .. }: &Transition<Modes>) -> String {
        format!("theta_dot = {} rad/s (before: {})", after.theta_dot, before.theta_dot)
    }

    /// One type for all cases keeps the library small.
    fn listener(told: &mut Told<'_, Modes>) -> impl Watch<Modes> {
        Watching { peaks: None, validity: None, told }
    }

    fn rates(engine: &Engine<Modes>, load: LinearLoad<Modes>) -> (impl Fn(Source) -> Option<f64>, Reactions) {
        let found = engine.rates(load);
        let reactions = found.reactions();
        let rate = move |source| match source {
            Source::Floor(place) => Some(found.of(output(engine, place))),
            _ => None,
        };
        (rate, reactions)
    }
}

/// The output at a place of the table.
fn output(engine: &Engine<Modes>, place: usize) -> FrameOutput {
    FrameOutput::all(engine.structure()).nth(place).expect("the table is of this structure")
}
