use std::ops::Index;

use crate::vocabulary::{control_names, control_number, Vocabulary};

/// Whether there is a face.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FaceStatus {
    /// None since the beginning.
    Searching,
    /// It is followed.
    Tracking,
    /// It is gone: its last place stays, its controls fade.
    Lost,
}

/// 52 animation weights, 0..1. `controls["jawOpen"]` asks by ARKit name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Controls {
    /// In the order of [`control_names`].
    pub array: [f32; mien_sys::MIEN_CONTROL_COUNT],
    supported: u64,
}

impl Controls {
    /// By ARKit name; `None` where there is no such control.
    pub fn get(&self, name: &str) -> Option<f32> {
        control_number(name).map(|i| self.array[i])
    }

    /// All with their names.
    pub fn iter(&self) -> impl Iterator<Item = (&'static str, f32)> + '_ {
        control_names().zip(self.array.iter().copied())
    }

    /// Names of those that are driven at this level of detail; the others are always 0.
    pub fn supported(&self) -> impl Iterator<Item = &'static str> + '_ {
        control_names().enumerate().filter(|(i, _)| self.supported >> i & 1 != 0).map(|(_, name)| name)
    }

    /// The same face in other words, in the order of [`Vocabulary::names`].
    pub fn to(&self, vocabulary: Vocabulary) -> Vec<f32> {
        let mut values = vec![0.0; vocabulary.names().len()];
        let count = values.len() as i32;
        // Safety: both arrays are as long as the library has to have them.
        let status = unsafe { mien_sys::mien_vocabulary_values(vocabulary as i32, self.array.as_ptr(), values.as_mut_ptr(), count) };
        debug_assert_eq!(status, mien_sys::MIEN_OK);
        values
    }
}

impl Index<&str> for Controls {
    type Output = f32;
    fn index(&self, name: &str) -> &f32 {
        &self.array[control_number(name).unwrap_or_else(|| panic!("no control {name:?}"))]
    }
}

/// The head in camera space: x to the right, y up, z towards the viewer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Unit quaternion x, y, z, w.
    pub rotation: [f32; 4],
    /// Metres.
    pub translation: [f32; 3],
    /// Radians, positive: looks down.
    pub pitch: f32,
    /// Radians, positive: turns to the subject's left.
    pub yaw: f32,
    /// Radians, about z by the right-hand rule.
    pub roll: f32,
}

/// One face on one frame.
#[derive(Clone, Copy)]
pub struct FaceResult(pub(crate) mien_sys::mien_result);

impl FaceResult {
    pub(crate) fn empty() -> FaceResult {
        // Safety: plain numbers, which the library fills in.
        let mut raw: mien_sys::mien_result = unsafe { std::mem::zeroed() };
        unsafe { mien_sys::mien_result_default(&mut raw) };
        FaceResult(raw)
    }

    /// Whether there is a face.
    pub fn status(&self) -> FaceStatus {
        match self.0.status {
            1 => FaceStatus::Tracking,
            2 => FaceStatus::Lost,
            _ => FaceStatus::Searching,
        }
    }

    /// Whether it is followed.
    pub fn has_face(&self) -> bool {
        self.status() == FaceStatus::Tracking
    }

    /// Of the picture, seconds.
    pub fn time_s(&self) -> f64 {
        self.0.pts_ns as f64 / 1e9
    }

    /// Counts the faces found, from 1; 0 before any.
    pub fn face_id(&self) -> u32 {
        self.0.face_id
    }

    /// The level of detail of this frame, 1..4.
    pub fn lod(&self) -> i32 {
        self.0.lod
    }

    /// 0..1, of the crop judged last.
    pub fn face_probability(&self) -> f32 {
        self.0.face_probability
    }

    /// 0..1: how much somebody speaks; 0 without sound.
    pub fn voice_activity(&self) -> f32 {
        self.0.voice_activity
    }

    /// Whether this frame counts for [`Tracker::calibrate`](crate::Tracker::calibrate).
    pub fn is_capturing_neutral(&self) -> bool {
        self.0.flags & mien_sys::MIEN_RESULT_CAPTURING_NEUTRAL != 0
    }

    /// x, y, width, height in pixels of the upright picture.
    pub fn bounds(&self) -> [f32; 4] {
        self.0.r#box
    }

    /// The animation weights.
    pub fn controls(&self) -> Controls {
        Controls { array: self.0.controls, supported: self.0.supported_controls }
    }

    /// x, y in pixels of the upright picture.
    pub fn landmarks(&self) -> &[[f32; 2]; mien_sys::MIEN_LANDMARK_COUNT] {
        &self.0.landmarks
    }

    /// Where the head is.
    pub fn pose(&self) -> Pose {
        let raw = &self.0;
        Pose { rotation: raw.rotation, translation: raw.translation, pitch: raw.pitch, yaw: raw.yaw, roll: raw.roll }
    }
}
