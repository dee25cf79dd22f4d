//! Names the build: a GUID over what enters the shared library, and nothing else.
//!
//! It also binds `modelDescription.xml` to the library, and covers nothing of the exporter for that. All that the two must
//! agree on (value references, names, types, causalities, limits, dependencies) is a table of the library; the exporter
//! contains that table, and packs no library of another build. How the exporter words the table in XML may be put
//! right, and is then as right of a library that was built before.
//!
//! Compiler and target are left out: the libraries in one archive have one GUID. So is how the system that builds writes
//! paths and ends lines.

use serde::Deserialize;
use std::collections::BTreeSet;
use std::error::Error;
use std::path::{Path, PathBuf};
use std::{fs, io};
use toml::{Table, Value};
use uuid::Uuid;

/// Folders with the sources of the library, from the workspace.
pub const SOURCES: [&str; 4] = ["src", "records/src", "fmu/fmi/src", "fmu/src"];

/// Manifests of the packages with these sources; the first is the workspace's as well.
pub const MANIFESTS: [&str; 4] = ["Cargo.toml", "records/Cargo.toml", "fmu/fmi/Cargo.toml", "fmu/Cargo.toml"];

/// Versions of all dependencies.
pub const LOCK: &str = "Cargo.lock";

/// The parts of a manifest that decide the compilation.
const SETTINGS: [&str; 5] = ["dependencies", "features", "lib", "profile", "target"];

/// Cargo.lock.
#[derive(Deserialize)]
struct Lock {
    #[serde(rename = "package")]
    packages: Vec<Package>,
}

#[derive(Deserialize, PartialEq, Eq, PartialOrd, Ord)]
struct Package {
    name: String,
    version: String,
    source: Option<String>,
    checksum: Option<String>,
    #[serde(default)]
    dependencies: Vec<String>,
}

impl Package {
    /// Whether it is of this workspace.
    fn is_member(&self) -> bool {
        self.source.is_none()
    }
}

/// The GUID of the library that is built from `workspace`.
pub fn build_id(workspace: &Path) -> Result<String, Box<dyn Error>> {
    let mut content = Vec::new();
    let mut add = |name: &str, bytes: &[u8]| {
        content.extend(format!("{name} {}\n", bytes.len()).into_bytes());
        content.extend(bytes);
    };
    let mut sources = Vec::new();
    for source in SOURCES {
        collect(workspace, Path::new(source), &mut sources)?;
    }
    sources.sort();
    for source in sources {
        let text = fs::read_to_string(workspace.join(&source))?.replace("\r\n", "\n");
        add(&source.to_string_lossy().replace('\\', "/"), text.as_bytes());
    }
    let lock: Lock = toml::from_str(&fs::read_to_string(workspace.join(LOCK))?)?;
    let mut packages = BTreeSet::new();
    for name in MANIFESTS {
        let mut manifest: Table = fs::read_to_string(workspace.join(name))?.parse()?;
        let member = manifest.get("package").and_then(|package| package.get("name")).and_then(Value::as_str);
        let member = lock.packages.iter().find(|package| Some(package.name.as_str()) == member && package.is_member());
        let member = member.ok_or_else(|| format!("{LOCK} lacks the package of {name}"))?;
        let edition = manifest.get("workspace").and_then(|workspace| workspace.get("package")?.get("edition"));
        add("edition", edition.map(Value::to_string).unwrap_or_default().as_bytes());
        manifest.retain(|key, _| SETTINGS.contains(&key));
        add(name, manifest.to_string().as_bytes());
        let dependencies = manifest.get("dependencies").and_then(Value::as_table);
        let is_linked = |name: &str| dependencies.is_some_and(|dependencies| dependencies.contains_key(name));
        add_dependencies(&lock, member, &is_linked, &mut packages);
    }
    for package in packages {
        let Package { name, version, checksum, .. } = package;
        add(name, format!("{version} {}", checksum.as_deref().unwrap_or_default()).as_bytes());
    }
    Ok(Uuid::new_v5(&Uuid::NAMESPACE_OID, &content).braced().to_string())
}

/// Appends `path` (relative to `workspace`), or all files under it.
fn collect(workspace: &Path, path: &Path, files: &mut Vec<PathBuf>) -> io::Result<()> {
    if !workspace.join(path).is_dir() {
        files.push(path.to_owned());
        return Ok(());
    }
    for entry in fs::read_dir(workspace.join(path))? {
        collect(workspace, &path.join(entry?.file_name()), files)?;
    }
    Ok(())
}

/// Adds the packages of `lock` that `package` depends on by a name that `is_linked`, and all that these depend on. All that
/// a member of the workspace depends on for its tests, too, is in its entry; other entries have no such dependencies.
/// Macros and build scripts count: what they write is compiled. Members do not: their sources do. An entry also names
/// optional dependencies that another member has switched on, or may have: the few of these count without need.
fn add_dependencies<'a>(
    lock: &'a Lock,
    package: &Package,
    is_linked: &dyn Fn(&str) -> bool,
    packages: &mut BTreeSet<&'a Package>,
) {
    for dependency in &package.dependencies {
        // A name; with a version if there are several of the name.
        let mut words = dependency.split(' ');
        let (name, version) = (words.next().unwrap_or_default(), words.next());
        let is_meant = |found: &&Package| found.name == name && version.is_none_or(|version| found.version == version);
        let found = lock.packages.iter().find(|found| is_linked(name) && is_meant(found) && !found.is_member());
        if let Some(found) = found.filter(|found| packages.insert(found)) {
            add_dependencies(lock, found, &|_| true, packages);
        }
    }
}
