use std::ffi::CString;

use crate::error::{check, check_detail, new_detail};
use crate::image::number;
use crate::{Error, Weights};

const BLOCK: usize = 8; // channels stored together
const INTERLEAVED: usize = 4; // an input of up to this number of channels is stored as an image

/// The shape of a map.
#[allow(missing_docs)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shape {
    pub channels: usize,
    pub height: usize,
    pub width: usize,
}

impl Shape {
    /// Numbers in it.
    pub fn size(self) -> usize {
        self.channels * self.height * self.width
    }

    fn of(raw: mien_sys::mien_shape) -> Shape {
        Shape { channels: raw.channels as usize, height: raw.height as usize, width: raw.width as usize }
    }

    fn blocks(self) -> usize {
        (self.channels + BLOCK - 1) / BLOCK
    }
}

/// A custom network of a weight file, for example converted from ONNX.
pub struct Network {
    raw: *mut mien_sys::mien_network,
    input_shape: Shape,
}

// Safety: any thread may use it, one at a time.
unsafe impl Send for Network {}

impl Network {
    /// `name`: of a network of the weights; the first where `None`. `size`: height and width, for networks that accept several.
    pub fn new(weights: &Weights, name: Option<&str>, size: Option<(usize, usize)>) -> Result<Network, Error> {
        let name = name.map(CString::new).transpose().map_err(|_| Error::Input("a name with a zero in it".into()))?;
        // Safety: plain numbers and pointers, which the library initializes.
        let mut config: mien_sys::mien_network_config = unsafe { std::mem::zeroed() };
        unsafe { mien_sys::mien_network_config_default(&mut config) };
        config.weights = weights.raw();
        config.name = name.as_ref().map_or(std::ptr::null(), |name| name.as_ptr());
        if let Some((height, width)) = size {
            (config.height, config.width) = (number(height)?, number(width)?);
        }
        let mut raw = std::ptr::null_mut();
        let mut detail = new_detail();
        check_detail(unsafe { mien_sys::mien_network_create(&config, &mut raw, &mut detail) }, &detail, weights.names())?;
        let mut shape = mien_sys::mien_shape { height: 0, width: 0, channels: 0 };
        unsafe { mien_sys::mien_network_input(raw, &mut shape) };
        Ok(Network { raw, input_shape: Shape::of(shape) })
    }

    /// Shape of the input of [`run`](Network::run).
    pub fn input_shape(&self) -> Shape {
        self.input_shape
    }

    /// Runs the network once, one step of a temporal network. Input and outputs are `[channels][height][width]`; outputs come with their shapes.
    pub fn run(&mut self, input: &[f32]) -> Result<Vec<(Shape, Vec<f32>)>, Error> {
        let shape = self.input_shape;
        if input.len() != shape.size() {
            return Err(Error::Input(format!("{} numbers for an input of {shape:?}", input.len())));
        }
        let pixels = shape.height * shape.width;
        let interleaved = shape.channels <= INTERLEAVED && pixels > 1;
        let step = if interleaved { shape.channels } else { BLOCK };
        let elements = if interleaved { shape.size() } else { shape.blocks() * pixels * BLOCK };
        // Safety: the buffer has this size (mien_network in mien.h) and no other reference.
        let to = unsafe { std::slice::from_raw_parts_mut(mien_sys::mien_network_input(self.raw, std::ptr::null_mut()), elements) };
        for (channel, plane) in input.chunks_exact(pixels).enumerate() {
            let first = channel / step * pixels * step + channel % step;
            plane.iter().enumerate().for_each(|(pixel, value)| to[first + pixel * step] = *value);
        }
        check(unsafe { mien_sys::mien_network_run(self.raw) })?;
        let count = unsafe { mien_sys::mien_network_output_count(self.raw) };
        Ok((0..count).map(|index| self.output(index)).collect())
    }

    fn output(&self, index: i32) -> (Shape, Vec<f32>) {
        let mut raw = mien_sys::mien_shape { height: 0, width: 0, channels: 0 };
        let place = unsafe { mien_sys::mien_network_output(self.raw, index, &mut raw) };
        let shape = Shape::of(raw);
        let pixels = shape.height * shape.width;
        // Safety: the buffer has this size and is valid until the next run.
        let from = unsafe { std::slice::from_raw_parts(place, shape.blocks() * pixels * BLOCK) };
        let of_channel = |channel| (0..pixels).map(move |pixel| from[(channel / BLOCK * pixels + pixel) * BLOCK + channel % BLOCK]);
        (shape, (0..shape.channels).flat_map(of_channel).collect())
    }

    /// Resets the state of temporal layers to the start of a stream.
    pub fn reset(&mut self) {
        unsafe { mien_sys::mien_network_reset(self.raw) }
    }
}

impl Drop for Network {
    fn drop(&mut self) {
        // Safety: created by mien_network_create, without another owner.
        unsafe { mien_sys::mien_network_destroy(self.raw) }
    }
}
