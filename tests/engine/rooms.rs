//! The rooms of `src/` by its imports: those of unit tests count like all others.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// The text of every file of `src/` by its module: `run::validity` of `run/validity.rs`.
fn files() -> BTreeMap<String, String> {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let (mut folders, mut files) = (vec![src.clone()], BTreeMap::new());
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            let module = path.strip_prefix(&src).unwrap().with_extension("");
            let module = module.to_str().unwrap().replace(std::path::MAIN_SEPARATOR, "::");
            files.insert(module, fs::read_to_string(path).unwrap());
        }
    }
    files
}

/// The paths that `text` begins with: `a::{b, c::d}` is `a::b` and `a::c::d`.
fn paths(text: &str) -> Vec<String> {
    let is_of_path = |c: char| c.is_alphanumeric() || c == '_' || c == ':';
    let (stem, rest) = text.split_at(text.find(|c| !is_of_path(c)).unwrap_or(text.len()));
    if !(stem.ends_with("::") && rest.starts_with('{')) {
        return vec![stem.into()];
    }
    let (mut paths_of_stem, mut depth, mut start) = (Vec::new(), 0, 1);
    for (i, c) in rest.char_indices() {
        depth += i32::from(c == '{') - i32::from(c == '}');
        if depth == 0 || depth == 1 && c == ',' {
            let branches = paths(rest[start..i].trim()).into_iter().filter(|branch| !branch.is_empty());
            paths_of_stem.extend(branches.map(|branch| format!("{stem}{branch}")));
            start = i + 1;
        }
        if depth == 0 {
            break;
        }
    }
    paths_of_stem
}

/// The files that each file imports from.
fn imports(files: &BTreeMap<String, String>) -> BTreeMap<&str, BTreeSet<&str>> {
    let exports = files["lib"].split("pub use ").skip(1).flat_map(paths);
    let exports: BTreeMap<_, _> = exports.map(|path| (path.rsplit("::").next().unwrap().to_owned(), path)).collect();
    let of = |module: &str, text: &str| {
        let code: String = text.lines().map(|line| line.split("//").next().unwrap().to_owned() + "\n").collect();
        let tests = code.find("mod tests {").unwrap_or(code.len());
        let children = files.keys().filter_map(|file| file.strip_prefix(module)?.strip_prefix("::"));
        let mut found = BTreeSet::new();
        for start in ["crate", "super"].into_iter().chain(children) {
            for (at, _) in code.match_indices(&format!("{start}::")) {
                if code[..at].ends_with(|c: char| c.is_alphanumeric() || "_:$".contains(c)) {
                    continue;
                }
                for path in paths(&code[at..]) {
                    let mut whole = if at < tests { module.to_owned() } else { format!("{module}::tests") };
                    for part in path.split("::") {
                        match part {
                            "crate" => whole.clear(),
                            "super" => whole.truncate(whole.rfind("::").unwrap_or(0)),
                            part => whole += &format!("::{part}"),
                        }
                    }
                    let whole = whole.trim_start_matches("::");
                    let (first, rest) = whole.split_once("::").unwrap_or((whole, ""));
                    let whole = exports.get(first).map_or(whole.to_owned(), |path| format!("{path}::{rest}"));
                    let is_in = |file: &&String| {
                        whole.strip_prefix(*file).is_some_and(|rest| rest.is_empty() || rest.starts_with("::"))
                    };
                    found.extend(files.keys().filter(is_in).max_by_key(|file| file.len()).map(String::as_str));
                }
            }
        }
        found.remove(module);
        found
    };
    files
        .iter()
        .filter(|(module, _)| *module != "lib")
        .map(|(module, text)| (module.as_str(), of(module, text)))
        .collect()
}

/// `lib.rs` lists the rooms in their order.
#[test]
fn each_room_imports_from_those_above_it_alone() {
    let files = files();
    let cells = files["lib"].lines().filter_map(|line| line.strip_prefix("//! | ")?.split(" |").next());
    let rooms: Vec<_> =
        cells.map(|cell| cell.trim_matches(['[', ']', '`'])).filter(|cell| files.contains_key(*cell)).collect();
    let room = |module: &str| rooms.iter().position(|room| *room == module.split("::").next().unwrap());
    let imports = imports(&files);
    assert!(imports["engine"].contains("levels::level") && imports["run"].contains("run::fall"), "{imports:?}");
    for (module, from) in imports {
        let own = room(module).unwrap_or_else(|| panic!("{module} is in no room of lib.rs"));
        let below: Vec<_> = from.into_iter().filter(|from| room(from) > Some(own)).collect();
        assert!(below.is_empty(), "{module} imports from {below:?}, which lib.rs lists below it");
    }
}

#[test]
fn no_files_import_from_each_other_in_a_circle() {
    let files = files();
    let mut left = imports(&files);
    loop {
        let (count, imported) = (left.len(), left.values().flatten().copied().collect::<BTreeSet<_>>());
        left.retain(|file, from| !from.is_empty() && imported.contains(file));
        let stay: BTreeSet<_> = left.keys().copied().collect();
        left.values_mut().for_each(|from| from.retain(|file| stay.contains(file)));
        if left.len() == count {
            break;
        }
    }
    assert!(left.is_empty(), "{left:#?}");
}
