//! `mien-sys` declares the same struct layouts, functions and statuses as `mien.h`. MIEN_C_API names the output of bindings/c_api.py.
use std::collections::BTreeSet;
use std::mem::{size_of, MaybeUninit};

use mien_sys::*;

macro_rules! layout {
    ($said:ident, $($name:ident { $($field:ident $(as $label:literal)?),* $(,)? })*) => {$(
        $said.insert(format!(concat!("struct ", stringify!($name), " {}"), size_of::<$name>()));
        $({
            let place = MaybeUninit::<$name>::uninit();
            let field = unsafe { std::ptr::addr_of!((*place.as_ptr()).$field) } as usize - place.as_ptr() as usize;
            let label = stringify!($field).trim_start_matches("r#");
            $said.insert(format!(concat!("field ", stringify!($name), ".{} {}"), label, field));
        })*
    )*};
}

fn upper_snake_case(name: &str) -> String {
    let mut upper = String::new();
    for (i, c) in name.chars().enumerate() {
        if c.is_uppercase() && i > 0 {
            upper.push('_');
        }
        upper.extend(c.to_uppercase());
    }
    upper
}

#[test]
fn landmark_groups_cover_all_landmarks() {
    let indices: Vec<usize> = mien::LandmarkGroup::ALL.iter().flat_map(|group| group.range()).collect();
    assert_eq!(indices, (0..mien::LANDMARK_COUNT).collect::<Vec<_>>());
}

fn header() -> String {
    let path = std::env::var("MIEN_C_API").expect("MIEN_C_API must name the output of bindings/c_api.py");
    std::fs::read_to_string(path).unwrap()
}

#[test]
fn layouts_match_the_header() {
    let mut said = BTreeSet::new();
    layout! { said,
        mien_image { struct_size, format, width, height, planes, row_stride_bytes, chroma_pixel_stride_bytes, rotation, mirrored, full_range,
            focal_length_px, principal_x, principal_y, yuv_matrix, region, pixel_aspect, reserved }
        mien_audio { struct_size, format, sample_rate, channels, planar, frames, samples, reserved }
        mien_allocator { allocate, release, user }
        mien_error_detail { struct_size, status, known, file, network, layer, field, offset, got, expected_min, expected_max, name, reserved }
        mien_weights_config { struct_size, copy, files, file_bytes, allocator, reserved }
        mien_tracker_config { struct_size, cpu_mask, weights, allocator, clock_ns, clock_user, lod, max_lod, horizontal_fov, accept_probability, lose_probability, lose_after_frames, proposal_size, proposal_threshold, refine_threshold,
            search_interval, budget_ms, smoothing, max_faces, audio, voice_attack_ms,
            voice_release_ms, audio_queue_samples, voice_strength, reserved }
        mien_result { struct_size, status, pts_ns, supported_controls, face_probability, voice_activity, lod, flags, r#box, rotation, pitch, yaw,
            roll, translation, controls, landmarks, frames, face_frames, proposal_runs, encoder_runs, stage_ns, face_id, reserved }
        mien_shape { height, width, channels }
        mien_network_config { struct_size, cpu_mask, weights, name, height, width, allocator, reserved }
        mien_network_info { struct_size, file, name, input, any_size, layers, outputs, parameters, macs, weight_bytes, session_bytes,
            arena_bytes, reserved }
        mien_layer_info { struct_size, input, second_input, output, op, activation, kernel, stride, padding, first_channel, input_bound, parameters, macs,
            reserved }
        mien_metadata_info { struct_size, file, key, value, value_bytes, reserved }
        mien_constant_info { struct_size, file, name, r#type, rank, dims, reserved }
    }
    let layouts: BTreeSet<String> =
        header().lines().filter(|line| line.starts_with("struct ") || line.starts_with("field ")).map(String::from).collect();
    assert_eq!(said, layouts);
}

#[test]
fn functions_constants_and_names_match_the_header() {
    let declared = include_str!("../../mien-sys/src/lib.rs").replace("\n        ", " ").replace(",\n    )", ")");
    for line in header().lines() {
        let words: Vec<&str> = line.split(' ').collect();
        match words[..] {
            ["function", name, arguments] => {
                let from = declared.find(&format!("pub fn {name}(")).unwrap_or_else(|| panic!("{name} is not declared"));
                let end = declared[from..].find(')').unwrap();
                assert_eq!(declared[from..from + end].matches(": ").count().to_string(), arguments, "{name}");
            }
            ["constant", name, value] => {
                if let Some(from) = declared.find(&format!("pub const {name}: usize = ")) {
                    assert!(declared[from..].contains(&format!("= {value};")), "{line}");
                }
            }
            ["enum", name, number] if name.starts_with("MIEN_CONTROL_") => {
                let control = mien::Control::ALL[number.parse::<usize>().unwrap()];
                assert_eq!(upper_snake_case(&format!("{control:?}")), &name["MIEN_CONTROL_".len()..]);
                assert_eq!(upper_snake_case(control.name()), &name["MIEN_CONTROL_".len()..]);
            }
            ["enum", name, number] if name.starts_with("MIEN_LANDMARKS_") => {
                let group = mien::LandmarkGroup::ALL[number.parse::<usize>().unwrap()];
                assert_eq!(upper_snake_case(&format!("{group:?}")), &name["MIEN_LANDMARKS_".len()..]);
                assert_eq!(group.name().to_uppercase(), &name["MIEN_LANDMARKS_".len()..]);
            }
            ["status", _, number] => {
                let known = mien::Status::ALL.iter().any(|status| status.number().to_string() == number);
                assert!(known || number == "0", "{line}");
            }
            _ => {}
        }
    }
}
