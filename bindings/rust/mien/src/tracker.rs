use std::cell::Cell;
use std::ffi::c_void;
use std::marker::PhantomData;
use std::sync::Arc;
use std::time::Instant;

use crate::error::{check, check_detail, new_detail};
use crate::vocabulary::control_number;
use crate::{nanoseconds, Audio, Error, FaceResult, Image, Weights};

/// Level of detail.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Lod {
    /// Automatic: the highest level within `Options::budget_ms` per frame.
    #[default]
    Auto,
    /// 1 (fastest) to 4 (most accurate).
    Level(u8),
}

impl Lod {
    fn number(self) -> i32 {
        match self {
            Lod::Auto => 0,
            Lod::Level(0) => -1, // an invalid level
            Lod::Level(level) => level.into(),
        }
    }
}

/// Options of a tracker.
#[derive(Clone, Debug)]
pub struct Options {
    /// Level of detail.
    pub lod: Lod,
    /// Maximum number of faces, 1..8.
    pub max_faces: i32,
    /// Accepts audio, if the weights have AudioNet.
    pub audio: bool,
    /// Smooths controls, landmarks and pose while they hardly move.
    pub smoothing: bool,
    /// Average time budget of a frame with a face for [`Lod::Auto`], ms, 0.01..1e6.
    pub budget_ms: f32,
    /// Horizontal field of view of the upright image, for images without a focal length, in radians, 0.01..3.1; `None`: 60 degrees.
    pub horizontal_fov: Option<f32>,
    /// Capacity of the audio queue ([`Tracker::audio_queue`]), in samples of one channel, 0..2^22; 0: no queue.
    pub audio_queue_samples: i32,
    /// Factor of the controls predicted from audio, 0..4.
    pub voice_strength: f32,
}

impl Default for Options {
    fn default() -> Options {
        Options {
            lod: Lod::Auto,
            max_faces: 1,
            audio: true,
            smoothing: true,
            budget_ms: 10.0,
            horizontal_fov: None,
            audio_queue_samples: 0,
            voice_strength: 1.0,
        }
    }
}

/// The library's tracker. Destroyed when both tracker and queue are dropped.
struct Handle {
    raw: *mut mien_sys::mien_tracker,
}

// Safety: the library allows queue_audio on one thread while another uses the tracker.
unsafe impl Send for Handle {}
unsafe impl Sync for Handle {}

impl Drop for Handle {
    fn drop(&mut self) {
        // Safety: created by mien_tracker_create, without another owner.
        unsafe { mien_sys::mien_tracker_destroy(self.raw) }
    }
}

/// Tracks faces in a stream of images and audio. May move between threads.
pub struct Tracker {
    handle: Arc<Handle>,
    queue_taken: bool,
    _one_thread: PhantomData<Cell<()>>,
}

extern "C" fn clock_ns(_: *mut c_void) -> u64 {
    thread_local!(static START: Instant = Instant::now());
    START.with(|start| start.elapsed().as_nanos() as u64)
}

impl Tracker {
    /// A tracker, of the best that the weights allow.
    pub fn new(weights: &Weights, options: Options) -> Result<Tracker, Error> {
        // Safety: plain numbers and pointers, which the library initializes.
        let mut config: mien_sys::mien_tracker_config = unsafe { std::mem::zeroed() };
        unsafe { mien_sys::mien_tracker_config_default(&mut config) };
        config.weights = weights.raw();
        config.lod = options.lod.number();
        config.max_lod = if options.lod == Lod::Level(1) { 1 } else { 4 };
        config.audio = options.audio.into();
        config.max_faces = options.max_faces;
        config.smoothing = options.smoothing.into();
        config.budget_ms = options.budget_ms;
        config.audio_queue_samples = options.audio_queue_samples;
        config.voice_strength = options.voice_strength;
        config.horizontal_fov = options.horizontal_fov.unwrap_or(config.horizontal_fov);
        config.clock_ns = Some(clock_ns);
        let mut raw = std::ptr::null_mut();
        let mut detail = new_detail();
        // Safety: the tracker keeps the weights.
        check_detail(unsafe { mien_sys::mien_tracker_create(&config, &mut raw, &mut detail) }, &detail, weights.names())?;
        let handle = Arc::new(Handle { raw });
        Ok(Tracker { handle, queue_taken: false, _one_thread: PhantomData })
    }

    /// Tracks one image and returns the result of the face with the lowest id. `time_s`: timestamp of the image in seconds, on any clock.
    pub fn track(&mut self, image: &Image, time_s: f64) -> Result<FaceResult, Error> {
        // Safety: the constructors checked the sizes of the borrowed planes.
        check(unsafe { mien_sys::mien_tracker_push_video(self.handle.raw, image.raw(), nanoseconds(time_s)?) })?;
        self.result()
    }

    /// Outputs a frame without an image, for audio without video. `time_s`: seconds, on the clock of the images.
    pub fn advance(&mut self, time_s: f64) -> Result<FaceResult, Error> {
        check(unsafe { mien_sys::mien_tracker_advance(self.handle.raw, nanoseconds(time_s)?) })?;
        self.result()
    }

    /// The result of the latest frame, of the face with the lowest id.
    pub fn result(&self) -> Result<FaceResult, Error> {
        let mut result = FaceResult::empty();
        check(unsafe { mien_sys::mien_tracker_get_result(self.handle.raw, &mut result.0) })?;
        Ok(result)
    }

    /// The results of all known faces on the latest frame.
    pub fn faces(&self) -> Result<Vec<FaceResult>, Error> {
        let count = unsafe { mien_sys::mien_tracker_face_count(self.handle.raw) };
        let face = |i| {
            let mut result = FaceResult::empty();
            check(unsafe { mien_sys::mien_tracker_get_face(self.handle.raw, i, &mut result.0) })?;
            Ok(result)
        };
        (0..count).map(face).collect()
    }

    /// Processes an audio block. `time_s`: timestamp of its first sample in seconds, on the clock of the images.
    pub fn push_audio(&mut self, audio: &Audio, time_s: f64) -> Result<(), Error> {
        check(unsafe { mien_sys::mien_tracker_push_audio(self.handle.raw, audio.raw(), nanoseconds(time_s)?) })
    }

    /// The writing end of the audio queue, for a microphone's thread; available once, if `Options::audio_queue_samples` is not 0.
    pub fn audio_queue(&mut self) -> Option<AudioQueue> {
        let first = !std::mem::replace(&mut self.queue_taken, true);
        first.then(|| AudioQueue { handle: Arc::clone(&self.handle), _one_thread: PhantomData })
    }

    /// Delays audio relative to the images, for audio pushed from now on.
    pub fn set_audio_offset(&mut self, seconds: f64) -> Result<(), Error> {
        check(unsafe { mien_sys::mien_tracker_set_audio_offset(self.handle.raw, nanoseconds(seconds)?) })
    }

    /// Weights of audio and video for a control during speech, each 0..1.
    pub fn set_mix(&mut self, control: &str, audio: f32, video: f32) -> Result<(), Error> {
        let number = control_number(control).ok_or_else(|| Error::Input(format!("control: unknown (got {control:?})")))?;
        check(unsafe { mien_sys::mien_tracker_set_mix(self.handle.raw, number as i32, audio, video) })
    }

    /// Sets the level of detail from the next image on.
    pub fn set_lod(&mut self, lod: Lod) -> Result<(), Error> {
        check(unsafe { mien_sys::mien_tracker_set_lod(self.handle.raw, lod.number()) })
    }

    /// Captures a person's neutral controls over the next 55 frames with a face, and removes them from later frames.
    pub fn calibrate(&mut self) -> Result<(), Error> {
        check(unsafe { mien_sys::mien_tracker_capture_neutral(self.handle.raw) })
    }

    /// The captured neutral values as a file of 448 bytes.
    pub fn save_neutral(&self) -> Result<Vec<u8>, Error> {
        let mut file = vec![0; mien_sys::MIEN_NEUTRAL_BYTES];
        let place = file.as_mut_ptr().cast();
        check(unsafe { mien_sys::mien_tracker_save_neutral(self.handle.raw, place, file.len(), std::ptr::null_mut()) })?;
        Ok(file)
    }

    /// Restores saved neutral values.
    pub fn load_neutral(&mut self, file: &[u8]) -> Result<(), Error> {
        check(unsafe { mien_sys::mien_tracker_load_neutral(self.handle.raw, file.as_ptr().cast(), file.len()) })
    }

    /// Resets the tracker to its state after creation.
    pub fn reset(&mut self) -> Result<(), Error> {
        check(unsafe { mien_sys::mien_tracker_reset(self.handle.raw) })
    }
}

/// The audio queue for a microphone's real-time thread: neither waits nor allocates. The tracker processes the audio with its next frame.
pub struct AudioQueue {
    handle: Arc<Handle>,
    _one_thread: PhantomData<Cell<()>>,
}

impl AudioQueue {
    /// Like [`Tracker::push_audio`]. [`Status::AudioQueueFull`](crate::Status::AudioQueueFull) if the queue is full; then nothing is queued.
    pub fn push(&mut self, audio: &Audio, time_s: f64) -> Result<(), Error> {
        check(unsafe { mien_sys::mien_tracker_queue_audio(self.handle.raw, audio.raw(), nanoseconds(time_s)?) })
    }
}
