use std::cell::Cell;
use std::ffi::c_void;
use std::marker::PhantomData;
use std::sync::Arc;
use std::time::Instant;

use crate::error::check;
use crate::vocabulary::control_number;
use crate::{nanoseconds, Audio, Error, FaceResult, Image, Weights};

/// Level of detail.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Lod {
    /// As high as `Options::budget_ms` a frame allows.
    #[default]
    Auto,
    /// 1, the cheapest, to 4.
    Level(u8),
}

impl Lod {
    fn number(self) -> i32 {
        match self {
            Lod::Auto => 0,
            Lod::Level(0) => -1, // which is none
            Lod::Level(level) => level.into(),
        }
    }
}

/// What a tracker is asked for.
#[derive(Clone, Debug)]
pub struct Options {
    /// Level of detail.
    pub lod: Lod,
    /// Faces followed at once, 1..8.
    pub max_faces: i32,
    /// Of what hardly moves.
    pub smoothing: bool,
    /// For [`Lod::Auto`].
    pub budget_ms: f32,
    /// Of the upright picture, radians, where pictures do not say a focal length; 60 degrees where `None`.
    pub horizontal_fov: Option<f32>,
    /// Room for sound that another thread brings ([`Tracker::audio_queue`]), in samples.
    pub audio_queue_samples: i32,
    /// What the sound says of the mouth, times this, 0..4.
    pub voice_strength: f32,
}

impl Default for Options {
    fn default() -> Options {
        Options {
            lod: Lod::Auto,
            max_faces: 1,
            smoothing: true,
            budget_ms: 10.0,
            horizontal_fov: None,
            audio_queue_samples: 0,
            voice_strength: 1.0,
        }
    }
}

/// The library's tracker. Ends when neither tracker nor queue is left.
struct Handle {
    raw: *mut mien_sys::mien_tracker,
    _weights: Weights, // which have to stay as long
}

// Safety: Tracker and AudioQueue call as the library lets two threads call: all else from one at a time, queue_audio from another.
unsafe impl Send for Handle {}
unsafe impl Sync for Handle {}

impl Drop for Handle {
    fn drop(&mut self) {
        // Safety: made by mien_tracker_create, and nobody else has it.
        unsafe { mien_sys::mien_tracker_destroy(self.raw) }
    }
}

/// Follows faces through a stream of pictures, and hears a voice. May go from thread to thread.
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
        // Safety: plain numbers and pointers, which the library fills in.
        let mut config: mien_sys::mien_tracker_config = unsafe { std::mem::zeroed() };
        unsafe { mien_sys::mien_tracker_config_default(&mut config) };
        (config.basenet, config.basenet_bytes) = (weights.basenet.place(), weights.basenet.bytes());
        (config.proposal, config.proposal_bytes) = (weights.proposal.place(), weights.proposal.bytes());
        if let Some(hifinet) = &weights.hifinet {
            (config.hifinet, config.hifinet_bytes) = (hifinet.place(), hifinet.bytes());
        }
        if let Some(audionet) = &weights.audionet {
            (config.audionet, config.audionet_bytes) = (audionet.place(), audionet.bytes());
        }
        config.lod = options.lod.number();
        config.max_faces = options.max_faces;
        config.smoothing = options.smoothing.into();
        config.budget_ms = options.budget_ms;
        config.audio_queue_samples = options.audio_queue_samples;
        config.voice_strength = options.voice_strength;
        config.horizontal_fov = options.horizontal_fov.unwrap_or(config.horizontal_fov);
        config.clock_ns = Some(clock_ns);
        let mut raw = std::ptr::null_mut();
        // Safety: the weights stay with the handle.
        check(unsafe { mien_sys::mien_tracker_create(&config, &mut raw) })?;
        let handle = Arc::new(Handle { raw, _weights: weights.clone() });
        Ok(Tracker { handle, queue_taken: false, _one_thread: PhantomData })
    }

    /// Tracks one picture and tells of the face known longest. `time_s`: of the picture, on any clock.
    pub fn track(&mut self, image: &Image, time_s: f64) -> Result<FaceResult, Error> {
        // Safety: what the image describes was held against what it borrows.
        check(unsafe { mien_sys::mien_tracker_push_video(self.handle.raw, image.raw(), nanoseconds(time_s)?) })?;
        self.result()
    }

    /// A frame of output without a picture: for sound alone.
    pub fn advance(&mut self, time_s: f64) -> Result<FaceResult, Error> {
        check(unsafe { mien_sys::mien_tracker_advance(self.handle.raw, nanoseconds(time_s)?) })?;
        self.result()
    }

    /// Of the last picture, of the face known longest.
    pub fn result(&self) -> Result<FaceResult, Error> {
        let mut result = FaceResult::empty();
        check(unsafe { mien_sys::mien_tracker_get_result(self.handle.raw, &mut result.0) })?;
        Ok(result)
    }

    /// Of the last picture, every face known.
    pub fn faces(&self) -> Result<Vec<FaceResult>, Error> {
        let count = unsafe { mien_sys::mien_tracker_face_count(self.handle.raw) };
        let face = |i| {
            let mut result = FaceResult::empty();
            check(unsafe { mien_sys::mien_tracker_get_face(self.handle.raw, i, &mut result.0) })?;
            Ok(result)
        };
        (0..count).map(face).collect()
    }

    /// Hears a block of sound. `time_s`: of its first sample, on the clock of the pictures.
    pub fn push_audio(&mut self, audio: &Audio, time_s: f64) -> Result<(), Error> {
        check(unsafe { mien_sys::mien_tracker_push_audio(self.handle.raw, audio.raw(), nanoseconds(time_s)?) })
    }

    /// The end for the thread of a microphone; there is one, and only where `Options::audio_queue_samples` made room.
    pub fn audio_queue(&mut self) -> Option<AudioQueue> {
        let first = !std::mem::replace(&mut self.queue_taken, true);
        first.then(|| AudioQueue { handle: Arc::clone(&self.handle), _one_thread: PhantomData })
    }

    /// Sound pushed from now on belongs to pictures that much later.
    pub fn set_audio_offset(&mut self, seconds: f64) -> Result<(), Error> {
        check(unsafe { mien_sys::mien_tracker_set_audio_offset(self.handle.raw, nanoseconds(seconds)?) })
    }

    /// How much sound and picture count for a control while somebody speaks, each 0..1.
    pub fn set_mix(&mut self, control: &str, audio: f32, video: f32) -> Result<(), Error> {
        let number = control_number(control).ok_or_else(|| Error::Input(format!("no control {control:?}")))?;
        check(unsafe { mien_sys::mien_tracker_set_mix(self.handle.raw, number as i32, audio, video) })
    }

    /// From the next picture on.
    pub fn set_lod(&mut self, lod: Lod) -> Result<(), Error> {
        check(unsafe { mien_sys::mien_tracker_set_lod(self.handle.raw, lod.number()) })
    }

    /// Captures, over the next 55 frames with a face, what it shows when it is neutral, to be taken out from then on.
    pub fn calibrate(&mut self) -> Result<(), Error> {
        check(unsafe { mien_sys::mien_tracker_capture_neutral(self.handle.raw) })
    }

    /// What was captured, to be kept.
    pub fn save_neutral(&self) -> Result<Vec<u8>, Error> {
        let mut file = vec![0; mien_sys::MIEN_NEUTRAL_BYTES];
        let place = file.as_mut_ptr().cast();
        check(unsafe { mien_sys::mien_tracker_save_neutral(self.handle.raw, place, file.len(), std::ptr::null_mut()) })?;
        Ok(file)
    }

    /// Takes over what was saved.
    pub fn load_neutral(&mut self, file: &[u8]) -> Result<(), Error> {
        check(unsafe { mien_sys::mien_tracker_load_neutral(self.handle.raw, file.as_ptr().cast(), file.len()) })
    }

    /// Forgets everything seen and heard.
    pub fn reset(&mut self) -> Result<(), Error> {
        check(unsafe { mien_sys::mien_tracker_reset(self.handle.raw) })
    }
}

/// Where a microphone's real-time thread leaves its sound: neither waits nor allocates. The tracker hears it with its next frame.
pub struct AudioQueue {
    handle: Arc<Handle>,
    _one_thread: PhantomData<Cell<()>>,
}

impl AudioQueue {
    /// As [`Tracker::push_audio`]. [`Status::AudioQueueFull`](crate::Status::AudioQueueFull): there is no room, nothing was taken.
    pub fn push(&mut self, audio: &Audio, time_s: f64) -> Result<(), Error> {
        check(unsafe { mien_sys::mien_tracker_queue_audio(self.handle.raw, audio.raw(), nanoseconds(time_s)?) })
    }
}
