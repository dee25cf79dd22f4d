//! A record is read and run, the levels of detail are compared on it, and piers of four stiffnesses are swept.

use rocking::estimates::intensity::IntensityMeasure::Pga;
use rocking::{Output, Parameters, Run, Structure};
use rocking_records::Reading;
use rocking_sweep::fragility::{FragilityCurve, Trials};
use rocking_sweep::outcome::Limit;
use rocking_sweep::plan::{Case, Conditions, NamedRecord, Plan, Population};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (ground, source) = rocking_records::read("examples/pulse.csv".as_ref(), &Reading::default(), 9.81)?;
    println!("{}: {}", ground.title(), source.unit);
    let run = Run::new(Structure::new(Parameters::MCMANUS)?, &ground);
    let (peaks, finish) = run.peaks()?;
    let show = |of: &Output| println!("{} in {}: {:?}", of.symbol(), of.unit(), peaks.of(*of));
    Output::with_peak(&run.structure).iter().for_each(show);
    println!("{:?} at {} s", finish.ending, finish.motion.time);
    let verdicts = run.compare()?.verdicts;
    verdicts.iter().for_each(|level| println!("{:?}: {:?}", level.response.choice.detail, level.errors));
    let piers = Population::new("piers", run.structure).vary("f_fc", vec![3.0, 4.0, 5.0, 6.0])?;
    let (pulse, scales) = (NamedRecord::new("pulse", ground, 1.0)?, vec![1.1, 1.15, 1.2, 1.25, 1.3]);
    let plan = Plan::new(vec![piers], vec![pulse], scales, Conditions::default())?;
    let overturns = |case: Case| (case.group, case.intensity(Pga), case.outcome().exceeds(&Limit::Overturning, 9.81));
    println!("{:?}", FragilityCurve::fit(&Trials::count(plan.cases().map(overturns)))?);
    Ok(())
}
