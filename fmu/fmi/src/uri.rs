//! URIs of local files.

use percent_encoding::percent_decode_str;
use std::path::{Path, PathBuf};

/// The local path of a file URI (RFC 8089): `file:/path`, `file:///path`, `file://localhost/path`; `file://server/path` is
/// `//server/path`, on Windows `file:///C:/path` is `C:/path`. A path that exists only as it stands was not encoded.
pub fn path(uri: &str) -> Option<PathBuf> {
    let (scheme, rest) = uri.split_once(':')?;
    if !scheme.eq_ignore_ascii_case("file") || !rest.starts_with('/') {
        return None;
    }
    let rest = rest.strip_prefix("//localhost").filter(|path| path.starts_with('/')).unwrap_or(rest);
    let path = rest.strip_prefix("//").filter(|path| path.starts_with('/')).unwrap_or(rest);
    let drive = path.trim_start_matches('/');
    let path = if cfg!(windows) && drive.get(1..2) == Some(":") { drive } else { path };
    let decoded = percent_decode_str(path).decode_utf8().map(|path| PathBuf::from(&*path));
    Some(decoded.ok().filter(|decoded| decoded.exists() || !Path::new(path).exists()).unwrap_or_else(|| path.into()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn file_uris_become_paths() {
        for uri in ["file:/a/b%20c/%C3%BC%25", "file:///a/b%20c/ü%25", "FILE://localhost/a/b c/%c3%bc%25"] {
            assert_eq!(path(uri).as_deref(), Some(Path::new("/a/b c/ü%")), "{uri}");
        }
        assert_eq!(path("file://server/share/a%20b").as_deref(), Some(Path::new("//server/share/a b")));
        assert_eq!(path("file:///%ff/100%").as_deref(), Some(Path::new("/%ff/100%")));
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("a%20b");
        std::fs::write(&file, "").unwrap();
        let uri = format!("file://{}", file.display());
        assert_eq!((path(&uri), path(&uri.replace('%', "%25"))), (Some(file.clone()), Some(file)));
        for uri in ["/a/b", "a/b", "file:a", "http://localhost/a", ""] {
            assert_eq!(path(uri), None, "{uri}");
        }
    }
}
