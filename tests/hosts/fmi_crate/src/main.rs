//! Drives an FMU through the import crate `fmi`: `fmi-crate-host FMU RECORD.csv OUTPUT,... [NAME=VALUE ...]`.
//!
//! Prints the outputs at every sample of the record (time, a_g), which is held from sample to sample. Every step is
//! taken twice with a wrong input and rolled back before it is taken as it should be, the second time through the
//! serialized state.

use fmi::fmi2::Fmi2Error;
use fmi::fmi2::import::Fmi2Import;
use fmi::fmi2::instance::{CoSimulation, Common};
use fmi::import;
use fmi::traits::{FmiImport, FmiStatus};
use std::error::Error;
use std::{env, fs};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<_> = env::args().skip(1).collect();
    let [fmu, record, outputs, start_values @ ..] = &arguments[..] else {
        return Err("usage: fmi-crate-host FMU RECORD.csv OUTPUT,... [NAME=VALUE ...]".into());
    };
    let fmu: Fmi2Import = import::from_path(fmu)?;
    let reference = |name: &str| fmu.model_description().model_variable_by_name(name).map(|v| v.value_reference);
    let outputs = outputs.split(',').map(reference).collect::<Result<Vec<_>, _>>()?;
    let a_g = [reference("a_g")?];
    let record = fs::read_to_string(record)?;
    let number = |text: Option<&str>| Ok::<f64, Box<dyn Error>>(text.ok_or("a number is missing")?.parse()?);
    let samples = record
        .lines()
        .skip(1)
        .map(|line| line.split(','))
        .map(|mut line| Ok::<_, Box<dyn Error>>((number(line.next())?, number(line.next())?)));
    let samples = samples.collect::<Result<Vec<_>, _>>()?;

    let mut instance = fmu.instantiate_cs("fmi", false, false)?;
    for start_value in start_values {
        let (name, value) = start_value.split_once('=').ok_or("a start value is NAME=VALUE")?;
        instance.set_real(&[reference(name)?], &[value.parse()?])?;
    }
    instance.setup_experiment(None, samples[0].0, None)?;
    instance.enter_initialization_mode()?;
    instance.exit_initialization_mode()?;
    let mut values = vec![0.0; outputs.len()];
    let mut show = |instance: &mut fmi::fmi2::instance::InstanceCS, time: f64| {
        instance.get_real(&outputs, &mut values)?;
        println!("{time:?},{}", values.iter().map(f64::to_string).collect::<Vec<_>>().join(","));
        Ok::<_, Fmi2Error>(())
    };
    show(&mut instance, samples[0].0)?;
    let state = instance.get_fmu_state()?;
    for pair in samples.windows(2) {
        let [(time, value), (next, _)] = *pair else { unreachable!() };
        instance.update_fmu_state(&state).ok()?;
        let bytes = instance.serialize_fmu_state(&state)?;
        for back in [&state, &instance.deserialize_fmu_state(&bytes)?] {
            instance.set_real(&a_g, &[-2.0 * value])?;
            let _taken_back = instance.do_step(time, next - time, false);
            instance.set_fmu_state(back).ok()?;
        }
        instance.set_real(&a_g, &[value])?;
        match instance.do_step(time, next - time, true) {
            Err(Fmi2Error::Discard) if instance.terminated()? => {
                let end = instance.last_successful_time()?;
                return Ok(show(&mut instance, end)?);
            }
            result => _ = result?,
        }
        show(&mut instance, next)?;
    }
    instance.terminate()?;
    Ok(())
}
