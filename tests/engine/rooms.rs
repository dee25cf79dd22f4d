//! The rooms of `src/` and their order, by the imports of its files. Those of unit tests count, too.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// The text of every file in `folder` by its module, which begins with `stem`: `run::validity` of `run/validity.rs`.
fn files(folder: &Path, stem: &str) -> BTreeMap<String, String> {
    let mut files = BTreeMap::new();
    for path in fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
        let module = format!("{stem}{}", path.file_stem().unwrap().to_str().unwrap());
        match path.is_dir() {
            true => files.extend(self::files(&path, &format!("{module}::"))),
            false => drop(files.insert(module, fs::read_to_string(path).unwrap())),
        }
    }
    files
}

fn of_src() -> BTreeMap<String, String> {
    files(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src"), "")
}

/// The paths that `text` begins with: `a::{b, c::d}` is `a::b` and `a::c::d`.
fn paths(text: &str) -> Vec<String> {
    let (mut stems, mut path, mut paths) = (vec![String::new()], String::new(), Vec::new());
    for c in text.chars() {
        match c {
            '{' if path.ends_with("::") => stems.push(std::mem::take(&mut path)),
            ',' | '}' if stems.len() > 1 => {
                paths.extend((!path.is_empty()).then(|| stems.concat() + &std::mem::take(&mut path)));
                stems.truncate(stems.len() - usize::from(c == '}'));
            }
            c if c.is_alphanumeric() || c == '_' || c == ':' => path.push(c),
            c if stems.len() > 1 && c.is_whitespace() => {}
            _ => break,
        }
        if stems.len() == 1 && !paths.is_empty() {
            return paths;
        }
    }
    vec![path]
}

/// The files that each file imports from.
fn imports(files: &BTreeMap<String, String>) -> BTreeMap<&str, BTreeSet<&str>> {
    let exports = files["lib"].split("pub use ").skip(1).flat_map(paths);
    let exports: BTreeMap<_, _> = exports.map(|path| (path.rsplit("::").next().unwrap().to_owned(), path)).collect();
    let of = |module: &str, text: &str| {
        let code = text.lines().map(|line| line.split("//").next().unwrap()).collect::<Vec<_>>().join("\n");
        let tests = code.find("mod tests {").unwrap_or(code.len());
        let children = files.keys().filter_map(|file| file.strip_prefix(module)?.strip_prefix("::"));
        let begins = ["crate", "super"].into_iter().chain(children).flat_map(|of| code.match_indices(of));
        let is_path = |at: usize, begin: &str| {
            let is_more = code[..at].ends_with(|c: char| c.is_alphanumeric() || "_:$".contains(c));
            !is_more && code[at + begin.len()..].starts_with("::")
        };
        let mut from = BTreeSet::new();
        for (at, _) in begins.filter(|(at, begin)| is_path(*at, begin)) {
            for path in paths(&code[at..]) {
                let mut whole = Vec::from_iter(module.split("::").chain((at > tests).then_some("tests")));
                for part in path.split("::") {
                    match part {
                        "crate" => whole.clear(),
                        "super" => drop(whole.pop()),
                        part => whole.push(part),
                    }
                }
                let exported = whole.first().and_then(|first| exports.get(*first));
                let whole =
                    exported.map_or(whole.clone(), |path| path.split("::").chain(whole[1..].iter().copied()).collect());
                let file = (1..=whole.len()).rev().find_map(|n| files.get_key_value(&whole[..n].join("::")));
                from.extend(file.map(|(file, _)| file.as_str()).filter(|file| *file != module));
            }
        }
        from
    };
    files
        .iter()
        .filter(|(module, _)| *module != "lib")
        .map(|(module, text)| (module.as_str(), of(module, text)))
        .collect()
}

/// The table of `lib.rs` has the rooms in their order.
#[test]
fn each_room_imports_from_those_above_it_alone() {
    let files = of_src();
    let row =
        |line: &str| Some(line.strip_prefix("//! | ")?.split_once(" |")?.0.trim_matches(['[', ']', '`']).to_owned());
    let rooms = Vec::from_iter(files["lib"].lines().filter_map(row));
    let place = |module: &str| rooms.iter().position(|room| *room == module.split("::").next().unwrap());
    let imports = imports(&files);
    assert!(imports["engine"].contains("levels::level") && imports["run"].contains("run::fall"), "{imports:?}");
    for (module, from) in imports {
        let own = place(module).unwrap_or_else(|| panic!("{module} is in no room of the table in lib.rs"));
        let below = Vec::from_iter(from.into_iter().filter(|from| place(from) > Some(own)));
        assert!(below.is_empty(), "{module} imports from {below:?}, below it in the table of lib.rs");
    }
}

#[test]
fn no_files_import_from_each_other_in_a_circle() {
    let files = of_src();
    let mut left = imports(&files);
    while let Some(module) =
        left.iter().find(|(_, from)| from.is_disjoint(&left.keys().copied().collect())).map(|(module, _)| *module)
    {
        left.remove(module);
    }
    assert!(left.is_empty(), "in circles, or above one: {left:#?}");
}

/// Of all crates that are shipped.
#[test]
fn no_two_types_share_a_name() {
    let crates = ". records sweep report modelDescription fmu fmu/fmi fmu/export cli python web view";
    let mut homes = BTreeMap::<String, Vec<String>>::new();
    for part in crates.split(' ') {
        for (module, text) in files(&Path::new(env!("CARGO_MANIFEST_DIR")).join(part).join("src"), "") {
            for line in text.lines() {
                let mut words = line.split(' ').skip_while(|word| word.starts_with("pub"));
                let keyword = words.next().unwrap_or_default();
                if ["struct", "enum", "trait", "type"].contains(&keyword) {
                    let name = words.next().unwrap().split(['<', '(', ';', ':']).next().unwrap();
                    homes.entry(name.to_owned()).or_default().push(format!("{part}: {module}"));
                }
            }
        }
    }
    assert!(homes.len() > 300, "{}", homes.len());
    homes.retain(|_, homes| homes.len() > 1);
    assert!(homes.is_empty(), "{homes:#?}");
}
