//! URIs of local files.

use percent_encoding::percent_decode_str;
use std::path::{Path, PathBuf};

/// The local path of a file URI (RFC 8089): `file:/path`, `file:///path`, `file://localhost/path`; on Windows
/// `file:///C:/path` is `C:/path`.
pub fn path(uri: &str) -> Option<PathBuf> {
    let (scheme, rest) = uri.split_once(':')?;
    if !scheme.eq_ignore_ascii_case("file") {
        return None;
    }
    let path = match rest.strip_prefix("//") {
        Some(authority) => authority.strip_prefix("localhost").unwrap_or(authority),
        None => rest,
    };
    if !path.starts_with('/') {
        return None;
    }
    let path = percent_decode_str(path).decode_utf8().ok()?;
    let drive = path.strip_prefix('/').filter(|path| cfg!(windows) && path.get(1..2) == Some(":"));
    Some(Path::new(drive.unwrap_or(&path)).to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn file_uris_become_paths() {
        for uri in ["file:/a/b%20c/%C3%BC%25", "file:///a/b%20c/ü%25", "FILE://localhost/a/b c/%c3%bc%25"] {
            assert_eq!(path(uri).as_deref(), Some(Path::new("/a/b c/ü%")), "{uri}");
        }
        for uri in ["/a/b", "a/b", "file:a", "file://elsewhere/a", "http://localhost/a", "file:///%ff", ""] {
            assert_eq!(path(uri), None, "{uri}");
        }
    }
}
