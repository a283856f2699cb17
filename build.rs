//! What the linker is told about the shared library.
//!
//! Its soname, the name that linked programs ask the loader for, carries the major version, so that a library
//! with another ABI never takes the place of the one a program was built for. And once loaded it stays,
//! whatever `dlclose` is told, since the threads of its pool stay and run its code.

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    let major = env!("CARGO_PKG_VERSION_MAJOR");
    let system = std::env::var("CARGO_CFG_TARGET_OS").expect("cargo sets it for build scripts");
    match system.as_str() {
        "linux" | "freebsd" | "netbsd" | "openbsd" => {
            println!("cargo::rustc-cdylib-link-arg=-Wl,-soname,libdecimesh.so.{major}");
            println!("cargo::rustc-cdylib-link-arg=-Wl,-z,nodelete");
        }
        "macos" => {
            println!("cargo::rustc-cdylib-link-arg=-Wl,-install_name,@rpath/libdecimesh.{major}.dylib")
        }
        _ => {}
    }
}
