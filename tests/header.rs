//! `include/decimesh.h` is what `src/capi/` says: it is generated anew in memory and compared.

#![cfg(feature = "capi")]

use std::collections::BTreeSet;
use std::ffi::CStr;
use std::fs;
use std::path::{Path, PathBuf};

use decimesh::capi::decimesh_status_name;

/// In the order in which a reader wants them.
const SOURCES: [&str; 17] = [
    "version",
    "status",
    "progress",
    "buffers",
    "mesh",
    "statistics",
    "simplify",
    "engine",
    "multiple_choice",
    "levels",
    "deviation",
    "bound",
    "certified",
    "nested",
    "progressive",
    "player",
    "hierarchy",
];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn header_path() -> PathBuf {
    root().join("include/decimesh.h")
}

fn generated() -> String {
    let config = cbindgen::Config::from_file(root().join("cbindgen.toml")).expect("cbindgen.toml is good");
    let mut builder = cbindgen::Builder::new().with_config(config);
    for source in SOURCES {
        builder = builder.with_src(root().join(format!("src/capi/{source}.rs")));
    }
    let mut text = Vec::new();
    builder.generate().expect("src/capi/ has a C header").write(&mut text);
    String::from_utf8(text).expect("a header is UTF-8")
}

#[test]
fn the_header_is_up_to_date() {
    let generated = generated();
    if std::env::var_os("UPDATE_HEADER").is_some() {
        fs::write(header_path(), &generated).expect("the header can be written");
    }
    let committed = fs::read_to_string(header_path()).unwrap_or_default();
    let differs = generated.lines().zip(committed.lines()).position(|(new, old)| new != old);
    assert!(
        generated == committed,
        "include/decimesh.h is not what src/capi/ says (first at line {}): run \
         `UPDATE_HEADER=1 cargo test --test header` and commit it",
        differs.unwrap_or(generated.lines().count().min(committed.lines().count())) + 1,
    );
}

/// No source that exports something is left out of the list above.
#[test]
fn the_header_has_every_exported_function() {
    let header = generated();
    let sources = fs::read_dir(root().join("src/capi")).expect("src/capi is a directory");
    let mut functions = 0;
    for source in sources {
        let text = fs::read_to_string(source.expect("it can be listed").path()).expect("sources are text");
        for line in text.lines() {
            let Some((_, declaration)) = line.split_once("extern \"C\" fn decimesh_") else { continue };
            let name = declaration.split('(').next().unwrap_or_default();
            assert!(header.contains(&format!("decimesh_{name}(")), "decimesh_{name} is not in the header");
            functions += 1;
        }
    }
    assert!(functions > 20, "only {functions} functions were found: the search is broken");
}

/// Every function and struct has a comment, and every field.
#[test]
fn everything_in_the_header_is_documented() {
    let header = generated();
    let body = header.split_once("*/").expect("a comment is at the top").1;
    let mut documented = false;
    let mut inside_struct = false;
    for line in body.lines() {
        let code = line.trim();
        let opens_struct = code.starts_with("typedef struct") && code.ends_with('{');
        let is_alias = code.starts_with("typedef int32_t");
        let is_constant = code.starts_with("#define DECIMESH_") && code != "#define DECIMESH_H";
        let is_field = inside_struct && code.ends_with(';') && !code.starts_with('}');
        let is_function =
            !inside_struct && code.contains("decimesh_") && code.contains('(') && !is_comment(code);
        if opens_struct || is_alias || is_constant || is_field || is_function {
            assert!(documented, "{code} has no comment");
        }
        inside_struct = opens_struct || inside_struct && !code.starts_with('}');
        documented = code.ends_with("*/");
    }
}

fn is_comment(code: &str) -> bool {
    code.starts_with('*') || code.starts_with("/*")
}

/// Every status has a name, a value of its own, and is known to `decimesh_status_name`.
#[test]
fn statuses_are_named_and_unique() {
    let header = generated();
    let mut values = BTreeSet::new();
    for line in header.lines() {
        let mut words = line.split_whitespace();
        let (Some("#define"), Some(name), Some(value)) = (words.next(), words.next(), words.next()) else {
            continue;
        };
        if name == "DECIMESH_OK" || name.starts_with("DECIMESH_ERROR_") {
            let value: i32 = value.parse().expect("a status is a number");
            assert!(values.insert(value), "{name} has the value of another status, {value}");
            // SAFETY: the name is static and ends with a NUL.
            let known = unsafe { CStr::from_ptr(decimesh_status_name(value)) };
            assert_eq!(known.to_str(), Ok(name));
        }
    }
    assert!(values.len() > 15, "only {values:?} were found: the search is broken");
    // SAFETY: as above.
    let unknown = unsafe { CStr::from_ptr(decimesh_status_name(-1)) };
    assert_eq!(unknown.to_str(), Ok("unknown status"));
}
