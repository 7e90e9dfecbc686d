//! Declarations of `mien.h`, which documents them. `tests/header.rs` of the crate `mien` compares both.
#![allow(non_camel_case_types)]

use std::os::raw::{c_char, c_void};

pub const MIEN_CONTROL_COUNT: usize = 52;
pub const MIEN_LANDMARK_COUNT: usize = 175;
pub const MIEN_MAX_STAGES: usize = 16;
pub const MIEN_MAX_AUDIO_CHANNELS: usize = 8;
pub const MIEN_ALIGNMENT: usize = 64;
pub const MIEN_MAX_WEIGHT_FILES: usize = 8;
pub const MIEN_MAX_NAME_BYTES: usize = 63;
pub const MIEN_NEUTRAL_BYTES: usize = 448;
pub const MIEN_RESULT_CAPTURING_NEUTRAL: u32 = 0x10;

pub const MIEN_OK: mien_status = 0;
/// A number, since a newer library may know more of them than an enum of Rust would.
pub type mien_status = i32;

#[repr(C)]
pub struct mien_tracker {
    _private: [u8; 0],
}

#[repr(C)]
pub struct mien_weights {
    _private: [u8; 0],
}

#[repr(C)]
pub struct mien_network {
    _private: [u8; 0],
}

#[repr(C)]
#[derive(Clone, Copy)]
pub struct mien_image {
    pub struct_size: u32,
    pub format: i32,
    pub width: i32,
    pub height: i32,
    pub planes: [*const c_void; 3],
    pub row_stride_bytes: [i32; 3],
    pub chroma_pixel_stride_bytes: i32,
    pub rotation: i32,
    pub mirrored: i32,
    pub full_range: i32,
    pub focal_length_px: f32,
    pub principal_x: f32,
    pub principal_y: f32,
    pub yuv_matrix: i32,
    pub region: [i32; 4],
    pub pixel_aspect: f32,
    pub reserved: [u32; 2],
}

#[repr(C)]
#[derive(Clone, Copy)]
pub struct mien_audio {
    pub struct_size: u32,
    pub format: i32,
    pub sample_rate: i32,
    pub channels: i32,
    pub planar: i32,
    pub frames: usize,
    pub samples: [*const c_void; MIEN_MAX_AUDIO_CHANNELS],
    pub reserved: [u32; 8],
}

#[repr(C)]
#[derive(Clone, Copy)]
pub struct mien_allocator {
    pub allocate: Option<extern "C" fn(*mut c_void, usize, usize) -> *mut c_void>,
    pub release: Option<extern "C" fn(*mut c_void, *mut c_void)>,
    pub user: *mut c_void,
}

#[repr(C)]
#[derive(Clone, Copy)]
pub struct mien_error_detail {
    pub struct_size: u32,
    pub status: i32,
    pub known: u32,
    pub file: i32,
    pub network: i32,
    pub layer: i32,
    pub field: *const c_char,
    pub offset: u64,
    pub got: f64,
    pub expected_min: f64,
    pub expected_max: f64,
    pub name: [c_char; MIEN_MAX_NAME_BYTES + 1],
    pub reserved: [u32; 8],
}

#[repr(C)]
#[derive(Clone, Copy)]
pub struct mien_weights_config {
    pub struct_size: u32,
    pub copy: i32,
    pub files: [*const c_void; MIEN_MAX_WEIGHT_FILES],
    pub file_bytes: [usize; MIEN_MAX_WEIGHT_FILES],
    pub allocator: mien_allocator,
    pub reserved: [u32; 8],
}

#[repr(C)]
#[derive(Clone, Copy)]
pub struct mien_tracker_config {
    pub struct_size: u32,
    pub cpu_mask: u32,
    pub weights: *const mien_weights,
    pub allocator: mien_allocator,
    pub clock_ns: Option<extern "C" fn(*mut c_void) -> u64>,
    pub clock_user: *mut c_void,
    pub lod: i32,
    pub max_lod: i32,
    pub horizontal_fov: f32,
    pub accept_probability: f32,
    pub lose_probability: f32,
    pub lose_after_frames: i32,
    pub proposal_size: i32,
    pub proposal_threshold: f32,
    pub refine_threshold: f32,
    pub search_interval: i32,
    pub budget_ms: f32,
    pub smoothing: i32,
    pub max_faces: i32,
    pub audio: i32,
    pub voice_attack_ms: f32,
    pub voice_release_ms: f32,
    pub audio_queue_samples: i32,
    pub voice_strength: f32,
    pub reserved: [u32; 8],
}

#[repr(C)]
#[derive(Clone, Copy)]
pub struct mien_result {
    pub struct_size: u32,
    pub status: i32,
    pub pts_ns: i64,
    pub supported_controls: u64,
    pub face_probability: f32,
    pub voice_activity: f32,
    pub lod: i32,
    pub flags: u32,
    pub r#box: [f32; 4],
    pub rotation: [f32; 4],
    pub pitch: f32,
    pub yaw: f32,
    pub roll: f32,
    pub translation: [f32; 3],
    pub controls: [f32; MIEN_CONTROL_COUNT],
    pub landmarks: [[f32; 2]; MIEN_LANDMARK_COUNT],
    pub frames: u64,
    pub face_frames: u64,
    pub proposal_runs: u64,
    pub encoder_runs: u64,
    pub stage_ns: [u64; MIEN_MAX_STAGES],
    pub face_id: u32,
    pub reserved: [u32; 15],
}

#[repr(C)]
#[derive(Clone, Copy)]
pub struct mien_shape {
    pub height: i32,
    pub width: i32,
    pub channels: i32,
}

#[repr(C)]
#[derive(Clone, Copy)]
pub struct mien_network_config {
    pub struct_size: u32,
    pub cpu_mask: u32,
    pub weights: *const mien_weights,
    pub name: *const c_char,
    pub height: i32,
    pub width: i32,
    pub allocator: mien_allocator,
    pub reserved: [u32; 8],
}

#[repr(C)]
#[derive(Clone, Copy)]
pub struct mien_network_info {
    pub struct_size: u32,
    pub file: i32,
    pub name: [c_char; MIEN_MAX_NAME_BYTES + 1],
    pub input: mien_shape,
    pub any_size: i32,
    pub layers: i32,
    pub outputs: i32,
    pub parameters: u64,
    pub macs: u64,
    pub weight_bytes: u64,
    pub session_bytes: u64,
    pub arena_bytes: u64,
    pub reserved: [u32; 8],
}

#[repr(C)]
#[derive(Clone, Copy)]
pub struct mien_layer_info {
    pub struct_size: u32,
    pub input: i32,
    pub second_input: i32,
    pub output: mien_shape,
    pub op: *const c_char,
    pub activation: *const c_char,
    pub kernel: [i32; 2],
    pub stride: [i32; 2],
    pub padding: [i32; 4],
    pub first_channel: i32,
    pub input_bound: f32,
    pub parameters: u64,
    pub macs: u64,
    pub reserved: [u32; 8],
}

#[repr(C)]
#[derive(Clone, Copy)]
pub struct mien_metadata_info {
    pub struct_size: u32,
    pub file: i32,
    pub key: [c_char; MIEN_MAX_NAME_BYTES + 1],
    pub value: *const c_char,
    pub value_bytes: usize,
    pub reserved: [u32; 8],
}

#[repr(C)]
#[derive(Clone, Copy)]
pub struct mien_constant_info {
    pub struct_size: u32,
    pub file: i32,
    pub name: [c_char; MIEN_MAX_NAME_BYTES + 1],
    pub r#type: *const c_char,
    pub rank: i32,
    pub dims: [u32; 4],
    pub reserved: [u32; 8],
}

extern "C" {
    pub fn mien_status_string(status: mien_status) -> *const c_char;
    pub fn mien_version() -> *const c_char;
    pub fn mien_version_api() -> u32;
    pub fn mien_cpu_tiers() -> u32;
    pub fn mien_cpu_tier_name(tier: u32) -> *const c_char;
    pub fn mien_cpu_multiply_adds(cpu_mask: u32, rounds: i64) -> i64;
    pub fn mien_control_name(control: i32) -> *const c_char;
    pub fn mien_landmark_group_name(group: i32) -> *const c_char;
    pub fn mien_landmark_group_range(group: i32, first: *mut i32) -> i32;
    pub fn mien_vocabulary_size(vocabulary: i32) -> i32;
    pub fn mien_vocabulary_name(vocabulary: i32, index: i32) -> *const c_char;
    pub fn mien_vocabulary_values(vocabulary: i32, controls: *const f32, values: *mut f32, count: i32) -> mien_status;
    pub fn mien_vocabulary_supported(vocabulary: i32, supported_controls: u64) -> u64;
    pub fn mien_vocabulary_match(names: *const *const c_char, count: i32, vocabularies: *mut i32, indices: *mut i32) -> mien_status;
    pub fn mien_control_count() -> i32;
    pub fn mien_landmark_count() -> i32;
    pub fn mien_image_default(image: *mut mien_image);
    pub fn mien_audio_default(audio: *mut mien_audio);
    pub fn mien_tracker_config_default(config: *mut mien_tracker_config);
    pub fn mien_error_detail_default(detail: *mut mien_error_detail);
    pub fn mien_error_message(detail: *const mien_error_detail, text: *mut c_char, text_bytes: usize) -> usize;
    pub fn mien_weights_config_default(config: *mut mien_weights_config);
    pub fn mien_weights_create(
        config: *const mien_weights_config,
        weights: *mut *mut mien_weights,
        error: *mut mien_error_detail,
    ) -> mien_status;
    pub fn mien_weights_destroy(weights: *mut mien_weights);
    pub fn mien_weights_network_count(weights: *const mien_weights) -> i32;
    pub fn mien_weights_network(weights: *const mien_weights, network: i32, info: *mut mien_network_info) -> mien_status;
    pub fn mien_weights_layer(weights: *const mien_weights, network: i32, layer: i32, info: *mut mien_layer_info) -> mien_status;
    pub fn mien_weights_metadata_count(weights: *const mien_weights) -> i32;
    pub fn mien_weights_metadata(weights: *const mien_weights, index: i32, info: *mut mien_metadata_info) -> mien_status;
    pub fn mien_weights_constant_count(weights: *const mien_weights) -> i32;
    pub fn mien_weights_constant(weights: *const mien_weights, index: i32, info: *mut mien_constant_info) -> mien_status;
    pub fn mien_tracker_required_bytes(
        config: *const mien_tracker_config,
        bytes: *mut usize,
        error: *mut mien_error_detail,
    ) -> mien_status;
    pub fn mien_tracker_create(
        config: *const mien_tracker_config,
        tracker: *mut *mut mien_tracker,
        error: *mut mien_error_detail,
    ) -> mien_status;
    pub fn mien_tracker_create_in(
        config: *const mien_tracker_config,
        memory: *mut c_void,
        memory_bytes: usize,
        tracker: *mut *mut mien_tracker,
        error: *mut mien_error_detail,
    ) -> mien_status;
    pub fn mien_tracker_destroy(tracker: *mut mien_tracker);
    pub fn mien_tracker_reset(tracker: *mut mien_tracker) -> mien_status;
    pub fn mien_tracker_set_lod(tracker: *mut mien_tracker, lod: i32) -> mien_status;
    pub fn mien_tracker_push_video(tracker: *mut mien_tracker, image: *const mien_image, pts_ns: i64) -> mien_status;
    pub fn mien_tracker_advance(tracker: *mut mien_tracker, pts_ns: i64) -> mien_status;
    pub fn mien_tracker_push_audio(tracker: *mut mien_tracker, audio: *const mien_audio, pts_ns: i64) -> mien_status;
    pub fn mien_tracker_queue_audio(tracker: *mut mien_tracker, audio: *const mien_audio, pts_ns: i64) -> mien_status;
    pub fn mien_tracker_set_audio_offset(tracker: *mut mien_tracker, offset_ns: i64) -> mien_status;
    pub fn mien_tracker_set_mix(tracker: *mut mien_tracker, control: i32, audio_weight: f32, video_weight: f32) -> mien_status;
    pub fn mien_face_status_name(status: i32) -> *const c_char;
    pub fn mien_stage_name(stage: i32) -> *const c_char;
    pub fn mien_tracker_get_result(tracker: *const mien_tracker, result: *mut mien_result) -> mien_status;
    pub fn mien_tracker_face_count(tracker: *const mien_tracker) -> i32;
    pub fn mien_tracker_get_face(tracker: *const mien_tracker, index: i32, result: *mut mien_result) -> mien_status;
    pub fn mien_result_default(result: *mut mien_result);
    pub fn mien_tracker_capture_neutral(tracker: *mut mien_tracker) -> mien_status;
    pub fn mien_tracker_save_neutral(tracker: *const mien_tracker, file: *mut c_void, file_bytes: usize, captured: *mut u32)
        -> mien_status;
    pub fn mien_tracker_load_neutral(tracker: *mut mien_tracker, file: *const c_void, file_bytes: usize) -> mien_status;
    pub fn mien_network_config_default(config: *mut mien_network_config);
    pub fn mien_network_create(
        config: *const mien_network_config,
        network: *mut *mut mien_network,
        error: *mut mien_error_detail,
    ) -> mien_status;
    pub fn mien_network_required_bytes(
        config: *const mien_network_config,
        bytes: *mut usize,
        error: *mut mien_error_detail,
    ) -> mien_status;
    pub fn mien_network_create_in(
        config: *const mien_network_config,
        memory: *mut c_void,
        memory_bytes: usize,
        network: *mut *mut mien_network,
        error: *mut mien_error_detail,
    ) -> mien_status;
    pub fn mien_network_step_count(network: *const mien_network) -> i32;
    pub fn mien_network_step_layers(network: *const mien_network, step: i32, first: *mut i32) -> i32;
    pub fn mien_network_run_step(network: *mut mien_network, step: i32) -> mien_status;
    pub fn mien_network_destroy(network: *mut mien_network);
    pub fn mien_network_input(network: *mut mien_network, shape: *mut mien_shape) -> *mut f32;
    pub fn mien_network_run(network: *mut mien_network) -> mien_status;
    pub fn mien_network_output_count(network: *const mien_network) -> i32;
    pub fn mien_network_output(network: *const mien_network, index: i32, shape: *mut mien_shape) -> *const f32;
    pub fn mien_network_reset(network: *mut mien_network);
}
