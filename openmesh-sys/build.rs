//! Compiles the shim over OpenMesh's headers where they are installed, and says so with `cfg(openmesh)`.
//! Where they are not, the crate builds without, unless the environment demands it.

use std::env;
use std::path::Path;
use std::process::exit;

const SHIM: &str = "shim/openmesh.cpp";

/// Set by whoever will not have the comparisons skipped, such as CI.
const REQUIRE: &str = "DECIMESH_REQUIRE_OPENMESH";

/// Changes whenever a Debian package is installed.
const INSTALLED_PACKAGES: &str = "/var/lib/dpkg/status";

fn main() {
    println!("cargo::rustc-check-cfg=cfg(openmesh)");
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed=shim");
    println!("cargo::rerun-if-env-changed={REQUIRE}");

    if let Err(error) = shim().cargo_metadata(false).cargo_warnings(false).try_expand() {
        absent(&error);
        return;
    }
    if let Err(error) = shim().try_compile("openmesh_shim") {
        println!("cargo::error=OpenMesh is installed, but {SHIM} does not compile with it: {error}");
        exit(1);
    }
    println!("cargo::rustc-link-lib=OpenMeshTools");
    println!("cargo::rustc-link-lib=OpenMeshCore");
    println!("cargo::rustc-cfg=openmesh");
}

/// Optimized in every profile, as a peer's own package would be: its templates are compiled here.
fn shim() -> cc::Build {
    let mut build = cc::Build::new();
    build.cpp(true).std("c++17").file(SHIM).opt_level(3).define("NDEBUG", None).extra_warnings(true);
    build
}

fn absent(error: &cc::Error) {
    if env::var_os(REQUIRE).is_some_and(|value| !value.is_empty() && value != "0") {
        println!(
            "cargo::error={REQUIRE} is set, but the C++ compiler cannot read OpenMesh's headers: install \
             Debian's packages libopenmesh-dev and g++, or unset it"
        );
        println!("cargo::error={}", error.to_string().replace('\n', " "));
        exit(1);
    }
    println!(
        "cargo::warning=OpenMesh is not installed: comparisons with it are skipped (on Debian, the packages \
         libopenmesh-dev and g++ bring it)"
    );
    // So that installing them is noticed. A path that does not exist would rebuild this crate each time.
    if Path::new(INSTALLED_PACKAGES).exists() {
        println!("cargo::rerun-if-changed={INSTALLED_PACKAGES}");
    }
}
