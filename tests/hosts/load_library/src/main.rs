//! The smallest host: loads the shared library of an unpacked FMU, takes it through a ground motion that is linear
//! between samples, and prints the time and some outputs at every sample.
//!
//! `load-library LIBRARY GUID RESOURCES RECORD.csv INPUT OUTPUT,...`: the input and the outputs are value references;
//! RECORD.csv has a time and a ground acceleration on every line after the first.

use libloading::Library;
use std::error::Error;
use std::ffi::{CString, c_char, c_double, c_int, c_uint, c_void};
use std::path::Path;
use std::{env, fs, ptr};

/// `fmi2CallbackFunctions`, all of them null.
#[repr(C)]
struct CallbackFunctions([*const c_void; 5]);

type Instantiate = unsafe extern "C" fn(
    *const c_char,
    c_int,
    *const c_char,
    *const c_char,
    *const CallbackFunctions,
    c_int,
    c_int,
) -> *mut c_void;
type Call = unsafe extern "C" fn(*mut c_void) -> c_int;
type Free = unsafe extern "C" fn(*mut c_void);
type SetupExperiment = unsafe extern "C" fn(*mut c_void, c_int, c_double, c_double, c_int, c_double) -> c_int;
type GetReal = unsafe extern "C" fn(*mut c_void, *const c_uint, usize, *mut c_double) -> c_int;
type SetReal = unsafe extern "C" fn(*mut c_void, *const c_uint, usize, *const c_double) -> c_int;
type SetDerivatives = unsafe extern "C" fn(*mut c_void, *const c_uint, usize, *const c_int, *const c_double) -> c_int;
type DoStep = unsafe extern "C" fn(*mut c_void, c_double, c_double, c_int) -> c_int;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<_> = env::args().skip(1).collect();
    let [library, guid, resources, record, input, outputs] = &arguments[..] else {
        return Err("usage: load-library LIBRARY GUID RESOURCES RECORD.csv INPUT OUTPUT,...".into());
    };
    let (guid, location) = (CString::new(guid.as_str())?, CString::new(uri(Path::new(resources))?)?);
    let input: c_uint = input.parse()?;
    let outputs = outputs.split(',').map(str::parse).collect::<Result<Vec<c_uint>, _>>()?;
    let samples = samples(&fs::read_to_string(record)?)?;
    let mut values = vec![0.0; outputs.len()];
    unsafe {
        let library = Library::new(library)?;
        let callbacks = CallbackFunctions([ptr::null(); 5]);
        let instantiate = library.get::<Instantiate>(c"fmi2Instantiate")?;
        let c = instantiate(c"load-library".as_ptr(), 1, guid.as_ptr(), location.as_ptr(), &callbacks, 0, 0);
        if c.is_null() {
            return Err("fmi2Instantiate returns null".into());
        }
        let setup = library.get::<SetupExperiment>(c"fmi2SetupExperiment")?;
        check("fmi2SetupExperiment", setup(c, 0, 0.0, samples[0].0, 0, 0.0))?;
        check("fmi2EnterInitializationMode", library.get::<Call>(c"fmi2EnterInitializationMode")?(c))?;
        check("fmi2ExitInitializationMode", library.get::<Call>(c"fmi2ExitInitializationMode")?(c))?;
        let get = library.get::<GetReal>(c"fmi2GetReal")?;
        let set = library.get::<SetReal>(c"fmi2SetReal")?;
        let set_slope = library.get::<SetDerivatives>(c"fmi2SetRealInputDerivatives")?;
        let step = library.get::<DoStep>(c"fmi2DoStep")?;
        for (at, &(time, a_g)) in samples.iter().enumerate() {
            check("fmi2GetReal", get(c, outputs.as_ptr(), outputs.len(), values.as_mut_ptr()))?;
            println!("{time:?},{}", values.iter().map(|value| format!("{value:?}")).collect::<Vec<_>>().join(","));
            if let Some((next, a_next)) = samples.get(at + 1) {
                let slope = (a_next - a_g) / (next - time);
                check("fmi2SetReal", set(c, &input, 1, &a_g))?;
                check("fmi2SetRealInputDerivatives", set_slope(c, &input, 1, &1, &slope))?;
                check("fmi2DoStep", step(c, time, next - time, 1))?;
            }
        }
        check("fmi2Terminate", library.get::<Call>(c"fmi2Terminate")?(c))?;
        library.get::<Free>(c"fmi2FreeInstance")?(c);
    }
    Ok(())
}

fn samples(record: &str) -> Result<Vec<(f64, f64)>, Box<dyn Error>> {
    let sample = |line: &str| -> Result<_, Box<dyn Error>> {
        let (time, a_g) = line.split_once(',').ok_or_else(|| format!("{line:?} is not a time and an acceleration"))?;
        Ok((time.parse()?, a_g.parse()?))
    };
    record.lines().skip(1).map(sample).collect()
}

/// The URI of a folder, on Windows with its drive.
fn uri(folder: &Path) -> Result<String, Box<dyn Error>> {
    let folder = std::path::absolute(folder)?.to_string_lossy().replace('\\', "/");
    Ok(format!("file:///{}", folder.trim_start_matches('/')))
}

fn check(function: &str, status: c_int) -> Result<(), String> {
    if status == 0 { Ok(()) } else { Err(format!("{function} returns {status}")) }
}
