use std::marker::PhantomData;

use crate::image::number;
use crate::Error;

/// An audio block of any length in the caller's memory.
#[derive(Clone, Copy)]
pub struct Audio<'a> {
    raw: mien_sys::mien_audio,
    owner: PhantomData<&'a [f32]>,
}

impl<'a> Audio<'a> {
    /// -1..1, interleaved; the tracker uses the mean of the `channels`.
    pub fn float(samples: &'a [f32], channels: usize, sample_rate: u32) -> Result<Self, Error> {
        Self::of(0, samples.as_ptr().cast(), samples.len(), channels, sample_rate)
    }

    /// The same, -32768..32767.
    pub fn int16(samples: &'a [i16], channels: usize, sample_rate: u32) -> Result<Self, Error> {
        Self::of(1, samples.as_ptr().cast(), samples.len(), channels, sample_rate)
    }

    fn of(format: i32, place: *const std::ffi::c_void, samples: usize, channels: usize, sample_rate: u32) -> Result<Self, Error> {
        // Safety: plain numbers and pointers, which the library initializes.
        let mut raw: mien_sys::mien_audio = unsafe { std::mem::zeroed() };
        unsafe { mien_sys::mien_audio_default(&mut raw) };
        raw.format = format;
        raw.channels = number(channels)?;
        raw.sample_rate = number(sample_rate as usize)?;
        raw.frames = samples / channels.max(1);
        raw.samples[0] = place;
        Ok(Audio { raw, owner: PhantomData })
    }

    pub(crate) fn raw(&self) -> &mien_sys::mien_audio {
        &self.raw
    }
}
