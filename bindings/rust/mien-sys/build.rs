//! Links the library in the folder MIEN_LIBRARY_DIR, or builds it with CMake from the repository that contains this crate.
use std::env;
use std::path::{Path, PathBuf};
use std::process::Command;

fn run(command: &mut Command) {
    let status = command.status().unwrap_or_else(|error| panic!("{command:?}: {error}"));
    assert!(status.success(), "{command:?} ended with {status}");
}

fn built() -> PathBuf {
    let repository = Path::new(&env::var("CARGO_MANIFEST_DIR").unwrap()).join("../../..");
    let folder = PathBuf::from(env::var("OUT_DIR").unwrap()).join("library");
    for part in ["kernels", "formats", "engine", "audio", "tracker", "include", "CMakeLists.txt"] {
        println!("cargo:rerun-if-changed={}", repository.join(part).display());
    }
    let off = ["TESTS", "APPS", "CONFORMANCE"].map(|what| format!("-DMIEN_BUILD_{what}=OFF"));
    run(Command::new("cmake")
        .arg("-S")
        .arg(&repository)
        .arg("-B")
        .arg(&folder)
        .args(off)
        .args(["-DMIEN_INSTALL=OFF", "-DCMAKE_BUILD_TYPE=Release"]));
    run(Command::new("cmake").arg("--build").arg(&folder).args(["--target", "mien_static", "--parallel", &env::var("NUM_JOBS").unwrap()]));
    folder.join("tracker")
}

fn main() {
    println!("cargo:rerun-if-env-changed=MIEN_LIBRARY_DIR");
    let folder = env::var_os("MIEN_LIBRARY_DIR").map_or_else(built, PathBuf::from);
    println!("cargo:rustc-link-search=native={}", folder.display());
    println!("cargo:rustc-link-lib=static=mien");
    let runtime = if cfg!(target_vendor = "apple") { "c++" } else { "stdc++" };
    println!("cargo:rustc-link-lib={runtime}");
}
