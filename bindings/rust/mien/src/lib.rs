#![doc = include_str!("../../README.md")]
#![warn(missing_docs)]

mod audio;
mod error;
mod image;
mod network;
mod result;
mod tracker;
mod vocabulary;
mod weights;

pub use audio::Audio;
pub use error::{Error, Status};
pub use image::{Image, Region, Rotation};
pub use network::{Network, Shape};
pub use result::{Controls, FaceResult, FaceStatus, Pose};
pub use tracker::{AudioQueue, Lod, Options, Tracker};
pub use vocabulary::{control_names, Control, LandmarkGroup, Vocabulary};
pub use weights::Weights;

/// Landmarks of a face, two numbers each.
pub const LANDMARK_COUNT: usize = mien_sys::MIEN_LANDMARK_COUNT;

/// Of the library: "major.minor.patch".
pub fn version() -> &'static str {
    // Safety: a static string of ASCII.
    unsafe { vocabulary::text(mien_sys::mien_version()) }.unwrap_or_default()
}

/// `as` would saturate out-of-range numbers and convert NaN to 0.
fn nanoseconds(seconds: f64) -> Result<i64, Error> {
    const END: f64 = 9_223_372_036_854_775_808.0; // 2^63
    let ns = (seconds * 1e9).round();
    if (-END..END).contains(&ns) {
        return Ok(ns as i64);
    }
    Err(Error::Input(format!("time: number out of range (got {seconds} s, expected {} s to {} s)", -END / 1e9, END / 1e9)))
}
