//! Writes the page: `pack ENGINE.wasm PAGE.html [LIBRARIES]`. The page contains the engine, compressed, and the shared libraries
//! if their file is given.

use anyhow::Context;
use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use flate2::{Compression, write::GzEncoder};
use std::io::Write;
use std::{env, fs};
use wasm_bindgen_cli_support::Bindgen;

fn main() -> anyhow::Result<()> {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let [engine, page, libraries @ ..] = arguments.as_slice() else {
        anyhow::bail!("usage: pack ENGINE.wasm PAGE.html [LIBRARIES]");
    };
    let mut bound = Bindgen::new().input_path(engine).no_modules(true)?.typescript(false).generate_output()?;
    let glue = bound.js().to_owned();
    let packed = |bytes: &[u8]| -> anyhow::Result<String> {
        let mut gzip = GzEncoder::new(Vec::new(), Compression::best());
        gzip.write_all(bytes)?;
        Ok(BASE64_STANDARD.encode(gzip.finish()?))
    };
    let libraries = libraries.iter().map(fs::read).collect::<Result<Vec<_>, _>>().context("the shared libraries")?;
    let html = include_str!("../../src/explore.html")
        .replacen("/*style*/", rocking_view::STYLE, 1)
        .replacen("/*explore.css*/", include_str!("../../src/explore.css"), 1)
        .replacen("/*motion*/", rocking_view::MOTION, 1)
        .replacen("/*engine.js*/", &glue, 1)
        .replacen("/*worker.js*/", include_str!("../../src/worker.js"), 1)
        .replacen("/*motion.js*/", rocking_view::SCRIPT, 1)
        .replacen("/*explore.js*/", include_str!("../../src/explore.js"), 1)
        .replacen("/*libraries*/", &libraries.first().map_or(Ok(String::new()), |bytes| packed(bytes))?, 1)
        .replacen("/*engine*/", &packed(&bound.wasm_mut().emit_wasm())?, 1);
    fs::write(page, &html)?;
    println!("{page}: {} kB", html.len() / 1000);
    Ok(())
}
