//! The cost of a step of the FMU under a record. A host sets an input, steps by 1 ms, and reads five outputs. Prints, as CSV, the share of
//! the steps that take so many microseconds or more, and so many steps of the engine. Every run does the same work, so that the
//! shortest time of a step counts. `make measure WHAT=steps` runs it on El Centro 1940.

use FlexibleRocking::resources::Archive;
use FlexibleRocking::rocking_model::{Condition, RockingModel};
use FlexibleRocking::variables::VariableTable;
use fmi_unit::interface::{Interface, Stepping};
use fmi_unit::snapshot::read_state;
use fmi_unit::variables::position;
use fmi_unit::{Logger, Model, StepEnd, StepRequest, Value};
use rocking::run::Runs;
use rocking::structure::description::{Damping, Storey};
use rocking::structure::natural_quantities::Numbers;
use rocking::{Ground, Modes, Parameters, Structure};
use std::{collections::HashMap, env, time::Instant};

const STEP: f64 = 1e-3;
const STEPS: usize = 20_000;
const RUNS: usize = 9;

fn main() {
    let pier = Structure::new(Parameters::MCMANUS).unwrap();
    let base = Numbers::of(&[("m0", 4e4), ("J0", 2e5), ("B", 5.0)]).unwrap();
    let storeys = Vec::from_iter((1..=10).map(|i| Storey { m: 4e4, h: 3.5 * f64::from(i), k: 6e7 }));
    let ten = Structure::from_storeys(&base, &Damping::All(0.02), &storeys).unwrap();
    let yields = Ground { f_v: Some(40.0), mu_c: Some(0.1), fs: Some(3.0), n_points: Some(5.0), ..Ground::default() };
    println!("scene,of,value,share");
    measure::<f64>("pier on rigid ground", &pier);
    measure::<Modes>("pier that slides on ground that yields", &pier.on(&yields).unwrap());
    measure::<Modes>("ten storeys", &ten);
}

fn measure<Q: Runs>(scene: &str, structure: &Structure) {
    let record = env::var("RECORD").expect("RECORD must name a file; `make measure WHAT=steps` takes El Centro 1940");
    let archive = Archive { folder: "".into(), contents: structure.clone().into(), files: HashMap::new() };
    let variables = VariableTable::new(&archive.contents).variables;
    let [file, a_g, theta] = ["record", "a_g", "theta"].map(|name| position(&variables, name) as u32);
    let (outputs, logger) = (Vec::from_iter(theta..theta + 5), Logger::new(None));
    let (mut microseconds, mut steps) = (vec![f64::INFINITY; STEPS], vec![0.0; STEPS]);
    for _ in 0..RUNS {
        let (mut model, mut values, mut before) = (RockingModel::<Q>::new(archive.clone()), [0.0; 5], 0);
        model.set(file, Value::String(record.clone()));
        model.start(Interface::CoSimulation(Stepping::default()), &logger).unwrap();
        for i in 0..STEPS {
            let step = StepRequest { start: STEP * i as f64, duration: STEP, stops_at_events: false };
            let begin = Instant::now();
            model.set_inputs(&[a_g], &[0.0]).unwrap();
            assert_eq!(model.advance(step, &logger).unwrap(), StepEnd::Complete, "{scene} overturns");
            model.get_reals(&outputs, &mut values).unwrap();
            microseconds[i] = microseconds[i].min(1e6 * begin.elapsed().as_secs_f64());
            let mut bytes = Vec::new();
            model.state(&mut bytes);
            let (.., course) = read_state::<Condition<Q>>(&bytes).unwrap();
            let now = course.expect("it has started").motion.work.steps;
            (steps[i], before) = ((now - before) as f64, now);
        }
    }
    for (of, mut values) in [("microseconds", microseconds), ("engine steps", steps)] {
        values.sort_by(|a, b| b.total_cmp(a));
        let more = |rank: &usize| Some((rank * 5 / 4).max(rank + 1)).filter(|rank| *rank <= STEPS);
        for rank in std::iter::successors(Some(1), more) {
            println!("{scene},{of},{:.4},{:e}", values[rank - 1], rank as f64 / STEPS as f64);
        }
    }
}
