//! Writes the page: `pack ENGINE.wasm RECORD.AT2 LIBRARIES PAGE.html`. The page contains the engine, the record that the page
//! shows when it opens, and the shared libraries of its FMUs, all compressed.

use anyhow::Context;
use std::path::Path;
use std::{env, fs};
use wasm_bindgen_cli_support::Bindgen;
use zopfli::{Format, Options};

fn main() -> anyhow::Result<()> {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let [engine, record, libraries, page] = arguments.as_slice() else {
        anyhow::bail!("usage: pack ENGINE.wasm RECORD.AT2 LIBRARIES PAGE.html");
    };
    let mut bound = Bindgen::new().input_path(engine).no_modules(true)?.typescript(false).generate_output()?;
    let glue = bound.js().to_owned();
    let packed = |bytes: &[u8]| -> anyhow::Result<String> {
        let (mut gzip, options) = (Vec::new(), Options { iteration_count: 5.try_into()?, ..Options::default() });
        zopfli::compress(options, Format::Gzip, bytes, &mut gzip)?;
        Ok(letters(&gzip))
    };
    let file = |path: &String| packed(&fs::read(path).with_context(|| path.clone())?);
    let name = Path::new(record).file_name().and_then(|name| name.to_str()).context("the record has no name")?;
    let html = include_str!("../../src/explore.html")
        .replacen("/*style*/", rocking_view::STYLE, 1)
        .replacen("/*explore.css*/", include_str!("../../src/explore.css"), 1)
        .replacen("/*motion*/", rocking_view::MOTION, 1)
        .replacen("/*engine.js*/", &glue, 1)
        .replacen("/*worker.js*/", include_str!("../../src/worker.js"), 1)
        .replacen("/*motion.js*/", rocking_view::SCRIPT, 1)
        .replacen("/*picture.js*/", include_str!("../../src/picture.js"), 1)
        .replacen("/*explore.js*/", include_str!("../../src/explore.js"), 1)
        .replacen("/*record name*/", name, 1)
        .replacen("/*record*/", &file(record)?, 1)
        .replacen("/*libraries*/", &file(libraries)?, 1)
        .replacen("/*engine*/", &packed(&bound.wasm_mut().emit_wasm())?, 1);
    fs::write(page, &html)?;
    println!("{page}: {} kB", html.len() / 1000);
    Ok(())
}

/// Five letters for each four `bytes`, after the number of zeros that make the last four whole. The 85 letters go from # to x,
/// without <, which could end the element that holds them.
fn letters(bytes: &[u8]) -> String {
    let letter = |digit: u32| char::from(if digit == 25 { b'x' } else { b'#' + digit as u8 });
    let five = |bytes: &[u8]| {
        let number = (0..4).fold(0, |number, i| number << 8 | u32::from(bytes.get(i).copied().unwrap_or(0)));
        (0..5).rev().map(move |power| letter(number / 85_u32.pow(power) % 85))
    };
    let zeros = bytes.len().next_multiple_of(4) - bytes.len();
    zeros.to_string() + &bytes.chunks(4).flat_map(five).collect::<String>()
}
