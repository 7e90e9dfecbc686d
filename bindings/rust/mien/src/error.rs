use std::path::{Path, PathBuf};
use std::{fmt, io};

macro_rules! statuses {
    ($($name:ident = $number:literal),* $(,)?) => {
        /// Errors of the library: `MIEN_ERROR_*` of `mien.h`.
        #[allow(missing_docs)] // their messages describe them
        #[non_exhaustive]
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum Status { $($name),*, Unknown(i32) }

        impl Status {
            /// All statuses of this version.
            pub const ALL: &'static [Status] = &[$(Status::$name),*];

            /// As in `mien.h`.
            pub fn number(self) -> i32 {
                match self { $(Status::$name => $number),*, Status::Unknown(number) => number }
            }

            fn of(number: i32) -> Status {
                match number { $($number => Status::$name),*, other => Status::Unknown(other) }
            }
        }
    };
}

statuses! {
    NullArgument = -1, StructSize = -2, OutOfRange = -3, Alignment = -4, MemoryTooSmall = -5, OutOfMemory = -6, UnsupportedLod = -7,
    SeveralFaces = -8, NoAudionet = -9, WeightsNotMien = -20, WeightsVersion = -21, WeightsTruncated = -22, WeightsChecksum = -23,
    WeightsIncomplete = -25, WeightsShape = -26, WeightsValue = -27, WeightsTrailingBytes = -100, WeightsByteOrder = -101,
    WeightsLimit = -102, WeightsReserved = -103, WeightsGap = -104, WeightsPadding = -105, WeightsName = -106, WeightsDuplicateName = -107,
    WeightsMetadata = -108, WeightsTensorType = -110, WeightsTensorDims = -111, WeightsTensorBytes = -112, WeightsTensorValue = -113,
    WeightsTensorUnused = -114, WeightsNetwork = -120, WeightsLayerOp = -121, WeightsLayerActivation = -122, WeightsLayerInput = -123,
    WeightsLayerShape = -124, WeightsLayerWindow = -125, WeightsLayerTensors = -126, WeightsPackedSize = -130, WeightsPackedBlock = -131,
    WeightsPackedTable = -132, WeightsPackedState = -133, WeightsPackedTruncated = -134, WeightsPackedTrailing = -135, UnsupportedCpu = -40,
    UnsupportedLayer = -41, Internal = -42, LeftOut = -43, UnsupportedLayout = -44, TooLarge = -45, ImageFormat = -60, ImageSize = -61,
    ImageStride = -62, ImagePlane = -63, ImageRotation = -64, ImageCamera = -65, AudioFormat = -66, AudioRate = -67, AudioChannels = -68,
    AudioSamples = -69, ImageRegion = -70, AudioQueueFull = -71, NeutralFormat = -80, NeutralVersion = -81, NeutralDamaged = -82,
}

impl fmt::Display for Status {
    fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        // Safety: a static string of ASCII, never null.
        formatter.write_str(unsafe { crate::vocabulary::text(mien_sys::mien_status_string(self.number())) }.unwrap_or_default())
    }
}

/// Errors of this crate.
#[non_exhaustive]
#[derive(Debug)]
pub enum Error {
    /// An error of the library.
    Status(Status),
    /// An error of the library, with a line that names the cause: field, file, layer or byte.
    Detail(Status, String),
    /// Invalid input that this crate detects before it calls the library.
    Input(String),
    /// A weight file could not be read.
    File(PathBuf, io::Error),
}

impl Error {
    /// The status of the library, if the error comes from it.
    pub fn status(&self) -> Option<Status> {
        match self {
            Error::Status(status) | Error::Detail(status, _) => Some(*status),
            _ => None,
        }
    }

    pub(crate) fn file(path: &Path, error: io::Error) -> Error {
        Error::File(path.to_owned(), error)
    }
}

impl fmt::Display for Error {
    fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Error::Status(status) => status.fmt(formatter),
            Error::Detail(_, line) => formatter.write_str(line),
            Error::Input(what) => formatter.write_str(what),
            Error::File(path, error) => write!(formatter, "{}: {error}", path.display()),
        }
    }
}

impl std::error::Error for Error {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Error::File(_, error) => Some(error),
            _ => None,
        }
    }
}

pub(crate) fn check(status: mien_sys::mien_status) -> Result<(), Error> {
    match status {
        mien_sys::MIEN_OK => Ok(()),
        number => Err(Error::Status(Status::of(number))),
    }
}

pub(crate) fn new_detail() -> mien_sys::mien_error_detail {
    // Safety: plain numbers and pointers, which the library initializes.
    let mut detail: mien_sys::mien_error_detail = unsafe { std::mem::zeroed() };
    unsafe { mien_sys::mien_error_detail_default(&mut detail) };
    detail
}

/// Like [`check`], with the line of a detail. `names`: of the weight files.
pub(crate) fn check_detail(status: mien_sys::mien_status, detail: &mien_sys::mien_error_detail, names: &[String]) -> Result<(), Error> {
    if status == mien_sys::MIEN_OK {
        return Ok(());
    }
    let mut text = [0u8; 256];
    // Safety: the library writes at most this number of bytes.
    let length = unsafe { mien_sys::mien_error_message(detail, text.as_mut_ptr().cast(), text.len()) }.min(text.len() - 1);
    let line = String::from_utf8_lossy(&text[..length]);
    let file = usize::try_from(detail.file).ok().and_then(|file| names.get(file));
    Err(Error::Detail(Status::of(status), file.map_or_else(|| line.to_string(), |name| format!("{name}: {line}"))))
}
