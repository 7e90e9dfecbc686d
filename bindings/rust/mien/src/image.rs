use std::ffi::c_void;

use crate::Error;

/// Clockwise rotation of an image to upright.
#[allow(missing_docs)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Rotation {
    #[default]
    None,
    Clockwise90,
    HalfTurn,
    Clockwise270,
}

/// A region of an image, in pixels of the buffer before rotation.
#[allow(missing_docs)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Region {
    pub x: i32,
    pub y: i32,
    pub width: i32,
    pub height: i32,
}

/// An image in the caller's memory, read without a copy.
///
/// Constructors take width and height, and for each plane its bytes and its row stride in bytes. They reject planes that are too short.
#[derive(Clone, Copy)]
pub struct Image<'a> {
    raw: mien_sys::mien_image,
    owner: std::marker::PhantomData<&'a [u8]>,
}

/// A plane: its bytes, bytes per row, and bytes of a row that are read.
type Plane<'a> = (&'a [u8], usize, usize);

impl<'a> Image<'a> {
    /// 1 byte per pixel.
    pub fn gray(width: usize, height: usize, bytes: &'a [u8], row_bytes: usize) -> Result<Self, Error> {
        Self::of(0, width, height, &[(bytes, row_bytes, width)])
    }

    /// 3 bytes per pixel.
    pub fn rgb(width: usize, height: usize, bytes: &'a [u8], row_bytes: usize) -> Result<Self, Error> {
        Self::of(1, width, height, &[(bytes, row_bytes, width.saturating_mul(3))])
    }

    /// 3 bytes per pixel.
    pub fn bgr(width: usize, height: usize, bytes: &'a [u8], row_bytes: usize) -> Result<Self, Error> {
        Self::of(2, width, height, &[(bytes, row_bytes, width.saturating_mul(3))])
    }

    /// 4 bytes per pixel; the last is ignored.
    pub fn rgba(width: usize, height: usize, bytes: &'a [u8], row_bytes: usize) -> Result<Self, Error> {
        Self::of(3, width, height, &[(bytes, row_bytes, width.saturating_mul(4))])
    }

    /// 4 bytes per pixel; the last is ignored.
    pub fn bgra(width: usize, height: usize, bytes: &'a [u8], row_bytes: usize) -> Result<Self, Error> {
        Self::of(4, width, height, &[(bytes, row_bytes, width.saturating_mul(4))])
    }

    /// Luma, then U and V interleaved.
    pub fn nv12(width: usize, height: usize, y: (&'a [u8], usize), uv: (&'a [u8], usize)) -> Result<Self, Error> {
        Self::of(5, width, height, &[(y.0, y.1, width), (uv.0, uv.1, chroma(width).saturating_mul(2))])
    }

    /// Luma, then V and U interleaved.
    pub fn nv21(width: usize, height: usize, y: (&'a [u8], usize), vu: (&'a [u8], usize)) -> Result<Self, Error> {
        Self::of(6, width, height, &[(y.0, y.1, width), (vu.0, vu.1, chroma(width).saturating_mul(2))])
    }

    /// Three planes; `chroma_step`: bytes between samples of U or V: 1 for I420, the pixel stride of Android's YUV_420_888;
    /// 0 means 1.
    pub fn i420(
        width: usize,
        height: usize,
        y: (&'a [u8], usize),
        u: (&'a [u8], usize),
        v: (&'a [u8], usize),
        chroma_step: usize,
    ) -> Result<Self, Error> {
        let chroma_step = chroma_step.max(1);
        let samples = chroma(width).saturating_sub(1).saturating_mul(chroma_step).saturating_add(1);
        let mut image = Self::of(7, width, height, &[(y.0, y.1, width), (u.0, u.1, samples), (v.0, v.1, samples)])?;
        image.raw.chroma_pixel_stride_bytes = number(chroma_step)?;
        Ok(image)
    }

    fn of(format: i32, width: usize, height: usize, planes: &[Plane<'a>]) -> Result<Self, Error> {
        // Safety: plain numbers and pointers, which the library initializes.
        let mut raw: mien_sys::mien_image = unsafe { std::mem::zeroed() };
        unsafe { mien_sys::mien_image_default(&mut raw) };
        raw.format = format;
        raw.width = number(width)?;
        raw.height = number(height)?;
        for (i, &(bytes, row_bytes, read)) in planes.iter().enumerate() {
            let rows = if i == 0 { height } else { chroma(height) };
            let need = rows.saturating_sub(1).saturating_mul(row_bytes).saturating_add(read);
            if rows > 0 && bytes.len() < need {
                return Err(Error::Input(format!("plane {i}: too short (got {} bytes, expected {need})", bytes.len())));
            }
            raw.planes[i] = bytes.as_ptr().cast::<c_void>();
            raw.row_stride_bytes[i] = number(row_bytes)?;
        }
        Ok(Image { raw, owner: std::marker::PhantomData })
    }

    /// Sets the rotation to upright.
    #[must_use]
    pub fn rotated(mut self, rotation: Rotation) -> Self {
        self.raw.rotation = 90 * rotation as i32;
        self
    }

    /// The image mirrors the scene (selfie camera).
    #[must_use]
    pub fn mirrored(mut self) -> Self {
        self.raw.mirrored = 1;
        self
    }

    /// Grey and YUV: video range, luma 16..235; otherwise 0..255.
    #[must_use]
    pub fn video_range(mut self) -> Self {
        self.raw.full_range = 0;
        self
    }

    /// YUV uses BT.709; otherwise BT.601.
    #[must_use]
    pub fn bt709(mut self) -> Self {
        self.raw.yuv_matrix = 1;
        self
    }

    /// Sets the region of interest; nothing outside it is read.
    #[must_use]
    pub fn region(mut self, region: Region) -> Self {
        self.raw.region = [region.x, region.y, region.width, region.height];
        self
    }

    /// Focal length and principal point in pixels of the upright image; a principal point of 0, 0 means the centre.
    #[must_use]
    pub fn camera(mut self, focal_length_px: f32, principal_point: (f32, f32)) -> Self {
        self.raw.focal_length_px = focal_length_px;
        (self.raw.principal_x, self.raw.principal_y) = principal_point;
        self
    }

    /// Width of a pixel / its height, 0.1 to 10. Results are in square pixels: the upright image keeps its height.
    #[must_use]
    pub fn pixel_aspect(mut self, aspect: f32) -> Self {
        self.raw.pixel_aspect = aspect;
        self
    }

    pub(crate) fn raw(&self) -> &mien_sys::mien_image {
        &self.raw
    }
}

/// Sets the size in pixels.
fn chroma(side: usize) -> usize {
    side / 2 + side % 2
}

pub(crate) fn number(size: usize) -> Result<i32, Error> {
    i32::try_from(size).map_err(|_| Error::Input(format!("{size} is too large a size")))
}
