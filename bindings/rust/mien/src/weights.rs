use std::ffi::c_void;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::error::{check_detail, new_detail};
use crate::Error;

struct Handle {
    raw: *mut mien_sys::mien_weights,
    names: Vec<String>,
}

// Safety: the library never changes weights, and counts their users atomically.
unsafe impl Send for Handle {}
unsafe impl Sync for Handle {}

impl Drop for Handle {
    fn drop(&mut self) {
        // Safety: created by mien_weights_create; trackers and networks keep references of their own.
        unsafe { mien_sys::mien_weights_destroy(self.raw) }
    }
}

/// Opened weight files. Cheap to clone: clones, trackers and networks share them.
#[derive(Clone)]
pub struct Weights(Arc<Handle>);

impl Weights {
    /// A weight file, a packed one or a bundle; or a folder, `models/` of the repository: its basenet.mien and proposal.mien, and
    /// hifinet.mien and audionet.mien if present.
    pub fn open(path: impl AsRef<Path>) -> Result<Weights, Error> {
        let path = path.as_ref();
        let paths: Vec<PathBuf> = if path.is_file() {
            vec![path.to_owned()]
        } else {
            let names = ["basenet.mien", "proposal.mien", "hifinet.mien", "audionet.mien"];
            let all = names.iter().enumerate().map(|(i, name)| (i, path.join(name)));
            all.filter(|(i, file)| *i < 2 || file.exists()).map(|(_, file)| file).collect()
        };
        let read = |path: &PathBuf| fs::read(path).map_err(|error| Error::file(path, error));
        let contents = paths.iter().map(read).collect::<Result<Vec<_>, _>>()?;
        let files: Vec<&[u8]> = contents.iter().map(Vec::as_slice).collect();
        Weights::new(&files, paths.iter().map(|path| path.display().to_string()).collect())
    }

    /// Copies files: each is the content of a weight file, a packed one, or a bundle of several, in any order.
    pub fn from_bytes(files: &[&[u8]]) -> Result<Weights, Error> {
        Weights::new(files, (0..files.len()).map(|i| format!("weights[{i}]")).collect())
    }

    fn new(files: &[&[u8]], names: Vec<String>) -> Result<Weights, Error> {
        if files.len() > mien_sys::MIEN_MAX_WEIGHT_FILES {
            return Err(Error::Input(format!("files: too many (got {}, expected 8 at most)", files.len())));
        }
        // Safety: plain numbers and pointers, which the library initializes.
        let mut config: mien_sys::mien_weights_config = unsafe { std::mem::zeroed() };
        unsafe { mien_sys::mien_weights_config_default(&mut config) };
        config.copy = 1;
        for (i, file) in files.iter().enumerate() {
            config.files[i] = file.as_ptr().cast::<c_void>();
            config.file_bytes[i] = file.len();
        }
        let mut raw = std::ptr::null_mut();
        let mut detail = new_detail();
        // Safety: the files are there during the call, which copies them.
        check_detail(unsafe { mien_sys::mien_weights_create(&config, &mut raw, &mut detail) }, &detail, &names)?;
        Ok(Weights(Arc::new(Handle { raw, names })))
    }

    pub(crate) fn raw(&self) -> *const mien_sys::mien_weights {
        self.0.raw
    }

    pub(crate) fn names(&self) -> &[String] {
        &self.0.names
    }
}
