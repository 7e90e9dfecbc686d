use std::ops::Index;

use crate::vocabulary::{control_names, control_number, Control, LandmarkGroup, Vocabulary};

/// Whether there is a face.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FaceStatus {
    /// No face since the start or reset.
    Searching,
    /// The face is tracked.
    Tracking,
    /// The face is lost: it keeps its last position, and its controls fade.
    Lost,
}

/// 52 animation weights, 0..1. `controls["jawOpen"]` and `controls[Control::JawOpen]` return one of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Controls {
    /// In the order of [`control_names`].
    pub array: [f32; mien_sys::MIEN_CONTROL_COUNT],
    supported: u64,
}

impl Controls {
    /// By ARKit name; `None` for an unknown name.
    pub fn get(&self, name: &str) -> Option<f32> {
        control_number(name).map(|i| self.array[i])
    }

    /// All with their names.
    pub fn iter(&self) -> impl Iterator<Item = (&'static str, f32)> + '_ {
        control_names().zip(self.array.iter().copied())
    }

    /// Names of the controls that this level of detail predicts; the others are 0.
    pub fn supported(&self) -> impl Iterator<Item = &'static str> + '_ {
        control_names().enumerate().filter(|(i, _)| self.supported >> i & 1 != 0).map(|(_, name)| name)
    }

    /// The controls in another vocabulary, in the order of [`Vocabulary::names`].
    pub fn to(&self, vocabulary: Vocabulary) -> Vec<f32> {
        let mut values = vec![0.0; vocabulary.names().len()];
        let count = values.len() as i32;
        // Safety: both arrays have the lengths that the library expects.
        let status = unsafe { mien_sys::mien_vocabulary_values(vocabulary as i32, self.array.as_ptr(), values.as_mut_ptr(), count) };
        debug_assert_eq!(status, mien_sys::MIEN_OK);
        values
    }
}

impl Index<&str> for Controls {
    type Output = f32;
    fn index(&self, name: &str) -> &f32 {
        &self.array[control_number(name).unwrap_or_else(|| panic!("control: unknown (got {name:?})"))]
    }
}

impl Index<Control> for Controls {
    type Output = f32;
    fn index(&self, control: Control) -> &f32 {
        &self.array[control as usize]
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
        // Safety: plain numbers, which the library initializes.
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

    /// Whether the face is tracked.
    pub fn has_face(&self) -> bool {
        self.status() == FaceStatus::Tracking
    }

    /// Timestamp of the frame, seconds.
    pub fn time_s(&self) -> f64 {
        self.0.pts_ns as f64 / 1e9
    }

    /// Number of the face, from 1 in the order of detection; 0 before the first.
    pub fn face_id(&self) -> u32 {
        self.0.face_id
    }

    /// The level of detail of this frame, 1..4.
    pub fn lod(&self) -> i32 {
        self.0.lod
    }

    /// 0..1, of the latest crop.
    pub fn face_probability(&self) -> f32 {
        self.0.face_probability
    }

    /// 0..1: voice activity; 0 without audio.
    pub fn voice_activity(&self) -> f32 {
        self.0.voice_activity
    }

    /// Whether this frame contributes to [`Tracker::calibrate`](crate::Tracker::calibrate).
    pub fn is_capturing_neutral(&self) -> bool {
        self.0.flags & mien_sys::MIEN_RESULT_CAPTURING_NEUTRAL != 0
    }

    /// x, y, width, height in pixels of the upright image.
    pub fn bounds(&self) -> [f32; 4] {
        self.0.r#box
    }

    /// The animation weights.
    pub fn controls(&self) -> Controls {
        Controls { array: self.0.controls, supported: self.0.supported_controls }
    }

    /// The landmarks of a group, x, y in pixels of the upright image.
    pub fn landmarks_of(&self, group: LandmarkGroup) -> &[[f32; 2]] {
        &self.0.landmarks[group.range()]
    }

    /// x, y in pixels of the upright image.
    pub fn landmarks(&self) -> &[[f32; 2]; mien_sys::MIEN_LANDMARK_COUNT] {
        &self.0.landmarks
    }

    /// The head pose.
    pub fn pose(&self) -> Pose {
        let raw = &self.0;
        Pose { rotation: raw.rotation, translation: raw.translation, pitch: raw.pitch, yaw: raw.yaw, roll: raw.roll }
    }
}
