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
