use std::path::Path;
use std::sync::Arc;
use std::{fs, io::Read};

use crate::Error;

#[repr(C, align(64))]
#[derive(Clone, Copy)]
struct Line([u8; mien_sys::MIEN_ALIGNMENT]);

/// A weight file in aligned memory. Cheap to clone: clones share the bytes.
#[derive(Clone)]
pub struct Model {
    lines: Arc<[Line]>,
    bytes: usize,
}

impl Model {
    /// Reads a file.
    pub fn open(path: impl AsRef<Path>) -> Result<Model, Error> {
        let path = path.as_ref();
        let read = || {
            let mut file = fs::File::open(path)?;
            let bytes = usize::try_from(file.metadata()?.len()).map_err(|_| std::io::ErrorKind::OutOfMemory)?;
            let mut model = Model::zeroed(bytes);
            file.read_exact(model.bytes_mut())?;
            Ok(model)
        };
        read().map_err(|error| Error::file(path, error))
    }

    /// Copies bytes of any alignment.
    pub fn from_bytes(data: &[u8]) -> Model {
        let mut model = Model::zeroed(data.len());
        model.bytes_mut().copy_from_slice(data);
        model
    }

    fn zeroed(bytes: usize) -> Model {
        let lines = vec![Line([0; mien_sys::MIEN_ALIGNMENT]); bytes / mien_sys::MIEN_ALIGNMENT + 1];
        Model { lines: lines.into(), bytes }
    }

    fn bytes_mut(&mut self) -> &mut [u8] {
        let bytes = self.bytes;
        let lines = Arc::get_mut(&mut self.lines).expect("a new model has one owner");
        // Safety: lines are bytes without padding, and their size suffices.
        unsafe { std::slice::from_raw_parts_mut(lines.as_mut_ptr().cast(), bytes) }
    }

    pub(crate) fn place(&self) -> *const std::ffi::c_void {
        self.lines.as_ptr().cast()
    }

    pub(crate) fn bytes(&self) -> usize {
        self.bytes
    }
}

/// The weights of trackers. Cheap to clone: trackers share the bytes.
#[derive(Clone)]
pub struct Weights {
    /// For tracking and level of detail 1.
    pub basenet: Model,
    /// For detection.
    pub proposal: Model,
    /// Levels of detail 2 to 4.
    pub hifinet: Option<Model>,
    /// For audio.
    pub audionet: Option<Model>,
}

impl Weights {
    /// The files of a folder, `models/` of the repository: basenet.mien and proposal.mien, and hifinet.mien and audionet.mien if present.
    pub fn open(folder: impl AsRef<Path>) -> Result<Weights, Error> {
        let folder = folder.as_ref();
        let wanted = |name: &str| Model::open(folder.join(name));
        let optional = |name: &str| folder.join(name).exists().then(|| wanted(name)).transpose();
        Ok(Weights {
            basenet: wanted("basenet.mien")?,
            proposal: wanted("proposal.mien")?,
            hifinet: optional("hifinet.mien")?,
            audionet: optional("audionet.mien")?,
        })
    }
}
