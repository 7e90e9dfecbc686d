use std::ffi::CStr;
use std::os::raw::c_char;

/// Names of controls in other standards.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Vocabulary {
    /// 52: the controls unchanged.
    Arkit,
    /// 52: _neutral (always 0), then 51 alphabetically.
    MediaPipe,
    /// 50: FACS of Roblox's FaceControls.
    Roblox,
    /// 11 of VRM 0.
    Vrm0,
    /// 11 of VRM 1.
    Vrm1,
    /// 15 of OVR LipSync.
    Visemes,
}

impl Vocabulary {
    /// All vocabularies.
    pub const ALL: [Vocabulary; 6] =
        [Vocabulary::Arkit, Vocabulary::MediaPipe, Vocabulary::Roblox, Vocabulary::Vrm0, Vocabulary::Vrm1, Vocabulary::Visemes];

    /// The names in order, spelled as in the standard.
    pub fn names(self) -> impl ExactSizeIterator<Item = &'static str> {
        // Safety: static strings of ASCII.
        let size = unsafe { mien_sys::mien_vocabulary_size(self as i32) };
        (0..size).map(move |i| unsafe { text(mien_sys::mien_vocabulary_name(self as i32, i)) }.unwrap_or_default())
    }
}

/// Controls in the order of [`control_names`].
#[allow(missing_docs)] // `mien.h` describes them
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Control {
    EyeBlinkLeft, EyeLookDownLeft, EyeLookInLeft, EyeLookOutLeft, EyeLookUpLeft, EyeSquintLeft, EyeWideLeft, EyeBlinkRight, EyeLookDownRight,
    EyeLookInRight, EyeLookOutRight, EyeLookUpRight, EyeSquintRight, EyeWideRight, JawForward, JawLeft, JawRight, JawOpen, MouthClose,
    MouthFunnel, MouthPucker, MouthLeft, MouthRight, MouthSmileLeft, MouthSmileRight, MouthFrownLeft, MouthFrownRight, MouthDimpleLeft,
    MouthDimpleRight, MouthStretchLeft, MouthStretchRight, MouthRollLower, MouthRollUpper, MouthShrugLower, MouthShrugUpper, MouthPressLeft,
    MouthPressRight, MouthLowerDownLeft, MouthLowerDownRight, MouthUpperUpLeft, MouthUpperUpRight, BrowDownLeft, BrowDownRight, BrowInnerUp,
    BrowOuterUpLeft, BrowOuterUpRight, CheekPuff, CheekSquintLeft, CheekSquintRight, NoseSneerLeft, NoseSneerRight, TongueOut,
}

impl Control {
    /// All of them, in order.
    pub const ALL: [Control; 52] = {
        use Control::*;
        [
            EyeBlinkLeft, EyeLookDownLeft, EyeLookInLeft, EyeLookOutLeft, EyeLookUpLeft, EyeSquintLeft, EyeWideLeft, EyeBlinkRight,
            EyeLookDownRight, EyeLookInRight, EyeLookOutRight, EyeLookUpRight, EyeSquintRight, EyeWideRight, JawForward, JawLeft, JawRight,
            JawOpen, MouthClose, MouthFunnel, MouthPucker, MouthLeft, MouthRight, MouthSmileLeft, MouthSmileRight, MouthFrownLeft,
            MouthFrownRight, MouthDimpleLeft, MouthDimpleRight, MouthStretchLeft, MouthStretchRight, MouthRollLower, MouthRollUpper,
            MouthShrugLower, MouthShrugUpper, MouthPressLeft, MouthPressRight, MouthLowerDownLeft, MouthLowerDownRight, MouthUpperUpLeft,
            MouthUpperUpRight, BrowDownLeft, BrowDownRight, BrowInnerUp, BrowOuterUpLeft, BrowOuterUpRight, CheekPuff, CheekSquintLeft,
            CheekSquintRight, NoseSneerLeft, NoseSneerRight, TongueOut,
        ]
    };

    /// ARKit's name.
    pub fn name(self) -> &'static str {
        // Safety: a static string of ASCII.
        unsafe { text(mien_sys::mien_control_name(self as i32)) }.unwrap_or_default()
    }
}

/// Groups of landmarks.
#[allow(missing_docs)] // `mien.h` describes them
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum LandmarkGroup {
    RightEyeLower, LeftEyeLower, RightEyeUpper, LeftEyeUpper, RightIris, LeftIris, RightBrowUpper, LeftBrowUpper, RightBrowLower,
    LeftBrowLower, RightNoseSide, LeftNoseSide, RightCheek, LeftCheek, NoseBridge, Midline, LipsOuterUpper, LipsOuterLower, LipsInnerUpper,
    LipsInnerLower, FaceOval,
}

impl LandmarkGroup {
    /// All of them, in order.
    pub const ALL: [LandmarkGroup; 21] = {
        use LandmarkGroup::*;
        [
            RightEyeLower, LeftEyeLower, RightEyeUpper, LeftEyeUpper, RightIris, LeftIris, RightBrowUpper, LeftBrowUpper, RightBrowLower,
            LeftBrowLower, RightNoseSide, LeftNoseSide, RightCheek, LeftCheek, NoseBridge, Midline, LipsOuterUpper, LipsOuterLower,
            LipsInnerUpper, LipsInnerLower, FaceOval,
        ]
    };

    /// The name in `models/landmarks.json`.
    pub fn name(self) -> &'static str {
        // Safety: a static string of ASCII.
        unsafe { text(mien_sys::mien_landmark_group_name(self as i32)) }.unwrap_or_default()
    }

    /// Indices of its landmarks.
    pub fn range(self) -> std::ops::Range<usize> {
        let mut first = 0;
        // Safety: `first` is a local variable.
        let count = unsafe { mien_sys::mien_landmark_group_range(self as i32, &mut first) };
        first as usize..(first + count) as usize
    }
}

/// ARKit's names of the 52 controls, in their order.
pub fn control_names() -> impl ExactSizeIterator<Item = &'static str> {
    Vocabulary::Arkit.names()
}

pub(crate) fn control_number(name: &str) -> Option<usize> {
    control_names().position(|known| known == name)
}

/// # Safety
/// Null, or a static string.
pub(crate) unsafe fn text(place: *const c_char) -> Option<&'static str> {
    if place.is_null() {
        return None;
    }
    CStr::from_ptr(place).to_str().ok()
}
