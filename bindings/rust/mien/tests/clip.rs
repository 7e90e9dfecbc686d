//! The tracker on the clip that ships, read by ffmpeg.
use std::process::Command;
use std::sync::Mutex;

use mien::*;

const REPOSITORY: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../..");
const WIDTH: usize = 640;
const HEIGHT: usize = 480;
const RATE: f64 = 30.0;

fn weights() -> Weights {
    Weights::open(format!("{REPOSITORY}/models")).unwrap()
}

fn decoded(format: &str, frame_bytes: usize) -> Vec<Vec<u8>> {
    let clip = format!("{REPOSITORY}/tests/data/demo.mp4");
    let arguments = ["-nostdin", "-v", "error", "-i", &clip, "-frames:v", "60", "-s", "640x480", "-pix_fmt", format, "-f", "rawvideo", "-"];
    let output = Command::new("ffmpeg").args(arguments).output().expect("the tests need ffmpeg");
    output.stdout.chunks_exact(frame_bytes).map(<[u8]>::to_vec).collect()
}

fn frames() -> &'static [Vec<u8>] {
    static FRAMES: Mutex<Option<&[Vec<u8>]>> = Mutex::new(None);
    FRAMES.lock().unwrap().get_or_insert_with(|| Box::leak(decoded("rgb24", WIDTH * HEIGHT * 3).into_boxed_slice()))
}

fn rgb(frame: &[u8]) -> Image<'_> {
    Image::rgb(WIDTH, HEIGHT, frame, WIDTH * 3).unwrap()
}

fn level(level: u8) -> Options {
    Options { lod: Lod::Level(level), ..Options::default() }
}

fn tracked<'a>(options: Options, images: impl Iterator<Item = Image<'a>>) -> Vec<FaceResult> {
    let mut tracker = Tracker::new(&weights(), options).unwrap();
    images.enumerate().map(|(i, image)| tracker.track(&image, i as f64 / RATE).unwrap()).collect()
}

fn near(a: &FaceResult, b: &FaceResult, pixels: f32, share: f32) {
    for (p, q) in a.landmarks().iter().flatten().zip(b.landmarks().iter().flatten()) {
        assert!((p - q).abs() <= pixels, "{p} {q}");
    }
    for ((name, p), (_, q)) in a.controls().iter().zip(b.controls().iter()) {
        assert!((p - q).abs() <= share, "{name} {p} {q}");
    }
}

#[test]
fn tracks_a_face_and_converts_to_every_vocabulary() {
    let results = tracked(level(1), frames()[..20].iter().map(|frame| rgb(frame)));
    let last = results.last().unwrap();
    assert!(last.has_face() && last.status() == FaceStatus::Tracking);
    assert_eq!((last.face_id(), last.lod()), (1, 1));
    assert!((last.time_s() - 19.0 / RATE).abs() < 1e-6 && last.face_probability() > 0.9);
    let [x, y, width, height] = last.bounds();
    assert!(x > 0.0 && x + width < 640.0 && y > 0.0 && y + height < 480.0 && width > 50.0);
    assert!(last.landmarks().iter().all(|[x, y]| *x > 0.0 && *y > 0.0));
    assert!(last.pose().translation[2] < 0.0 && last.pose().yaw.abs() < 1.0);
    let controls = last.controls();
    assert_eq!(control_names().nth(17), Some("jawOpen"));
    assert_eq!(Some(controls["jawOpen"]), controls.get("jawOpen"));
    assert_eq!(controls.get("nothing"), None);
    assert!(controls.supported().any(|name| name == "jawOpen") && !controls.supported().any(|name| name == "eyeLookUpLeft"));
    assert_eq!(controls.to(Vocabulary::Arkit), controls.array);
    assert_eq!(Vocabulary::ALL.map(|vocabulary| vocabulary.names().len()), [52, 52, 50, 11, 11, 15]);
    let jaw = Vocabulary::Roblox.names().position(|name| name == "JawDrop").unwrap();
    assert_eq!(controls.to(Vocabulary::Roblox)[jaw], controls["jawOpen"]);
    assert_ne!(results[3].landmarks(), results[13].landmarks());
}

#[test]
fn every_layout_gives_the_same_result() {
    let some = &frames()[..10];
    let reference = tracked(level(1), some.iter().map(|frame| rgb(frame))).pop().unwrap();
    let bgra: Vec<Vec<u8>> = some.iter().map(|frame| frame.chunks_exact(3).flat_map(|p| [p[2], p[1], p[0], 9]).collect()).collect();
    let images = bgra.iter().map(|frame| Image::bgra(WIDTH, HEIGHT, frame, WIDTH * 4).unwrap());
    near(&tracked(level(1), images).pop().unwrap(), &reference, 1e-3, 1e-4);
    let apart: Vec<Vec<u8>> =
        some.iter().map(|frame| frame.chunks_exact(WIDTH * 3).flat_map(|row| [row, &[5; 48]].concat()).collect()).collect();
    let images = apart.iter().map(|frame| Image::rgb(WIDTH, HEIGHT, frame, WIDTH * 3 + 48).unwrap());
    near(&tracked(level(1), images).pop().unwrap(), &reference, 0.0, 0.0);
    let turned = |frame: &Vec<u8>| -> Vec<u8> { frame.chunks_exact(3).rev().flatten().copied().collect() };
    let turned: Vec<Vec<u8>> = some.iter().map(turned).collect();
    near(&tracked(level(1), turned.iter().map(|frame| rgb(frame).rotated(Rotation::HalfTurn))).pop().unwrap(), &reference, 0.5, 0.01);
    let (luma, chroma) = (WIDTH * HEIGHT, WIDTH * HEIGHT / 4);
    let nv12 = decoded("nv12", luma * 3 / 2);
    let images = nv12[..10].iter().map(|f| Image::nv12(WIDTH, HEIGHT, (&f[..luma], WIDTH), (&f[luma..], WIDTH)).unwrap().video_range());
    near(&tracked(level(1), images).pop().unwrap(), &reference, 1.0, 0.05);
    let i420 = decoded("yuv420p", luma * 3 / 2);
    let images = i420[..10].iter().map(|f| {
        let (u, v) = f[luma..].split_at(chroma);
        Image::i420(WIDTH, HEIGHT, (&f[..luma], WIDTH), (u, WIDTH / 2), (v, WIDTH / 2), 1).unwrap().video_range()
    });
    near(&tracked(level(1), images).pop().unwrap(), &reference, 1.0, 0.05);
    let [x, y, width, height] = reference.bounds().map(|side| side as i32);
    let region = Region { x: x - 40, y: y - 40, width: width + 80, height: height + 80 };
    near(&tracked(level(1), some.iter().map(|frame| rgb(frame).region(region))).pop().unwrap(), &reference, 4.0, 0.2);
}

#[test]
fn reports_errors() {
    let frame = &frames()[0];
    let weights = weights();
    assert!(Image::rgb(WIDTH, HEIGHT, &frame[1..], WIDTH * 3).is_err(), "bytes beyond the slice are not read");
    assert!(Image::rgb(usize::MAX, 1, frame, 3).is_err());
    let i420 = |chroma: &[u8], step| Image::i420(8, 2, (&frame[..16], 8), (chroma, 4), (chroma, 4), step).is_ok();
    for (step, need) in [(0, 4), (1, 4), (2, 7)] {
        assert!(i420(&frame[..need], step) && !i420(&frame[..need - 1], step), "step {step} reads {need} bytes");
    }
    let mut tracker = Tracker::new(&weights, level(1)).unwrap();
    let refused = |tracker: &mut Tracker, image: Image| tracker.track(&image, 0.0).err().and_then(|error| error.status());
    assert_eq!(refused(&mut tracker, Image::gray(0, 0, &[], 0).unwrap()), Some(Status::ImageSize));
    let outside = Region { x: 600, y: 0, width: 80, height: 80 };
    assert_eq!(refused(&mut tracker, rgb(frame).region(outside)), Some(Status::ImageRegion));
    assert_eq!(tracker.result().unwrap().status(), FaceStatus::Searching);
    for bad in [5, 0] {
        assert_eq!(Tracker::new(&weights, level(bad)).err().unwrap().status(), Some(Status::UnsupportedLod));
    }
    let broken = Weights::from_bytes(&[&[7; 640]]).err().unwrap();
    assert_eq!(broken.status(), Some(Status::WeightsNotMien));
    assert_eq!(broken.to_string(), "weights[0]: byte 0, magic: the weights are not a .mien file (got 7, expected 137)");
    let many = Tracker::new(&weights, Options { max_faces: 9, ..level(1) }).err().unwrap();
    assert_eq!(many.to_string(), "max_faces: a value is out of range (got 9, expected 1..8)");
    assert!(Weights::open("/nowhere").err().unwrap().to_string().contains("/nowhere/basenet.mien"));
    let mut deaf = Tracker::new(&weights, Options { audio: false, ..level(1) }).unwrap();
    let silence = [0.0f32; 100];
    let error = deaf.push_audio(&Audio::float(&silence, 1, 16000).unwrap(), 0.0).unwrap_err();
    assert_eq!(error.status(), Some(Status::NoAudionet));
    assert!(!error.to_string().is_empty() && error.to_string() != "unknown status");
    assert_eq!(tracker.push_audio(&Audio::float(&silence, 1, 100).unwrap(), 0.0).unwrap_err().status(), Some(Status::AudioRate));
    assert!(tracker.set_mix("nothing", 1.0, 1.0).is_err());
    assert_eq!(tracker.load_neutral(&[0; 448]).unwrap_err().status(), Some(Status::NeutralFormat));
}

fn voice() -> Vec<f32> {
    let sample = |i: i32| {
        let t = i as f32 / 16000.0;
        let buzz: f32 = (1..25).map(|k| (std::f32::consts::TAU * 120.0 * k as f32 * t).sin() / k as f32).sum();
        0.25 * buzz * (std::f32::consts::TAU * 4.0 * t).sin().max(0.0)
    };
    (0..32000).map(sample).collect()
}

#[test]
fn accepts_audio_from_another_thread() {
    let sound = voice();
    let options = || Options { audio_queue_samples: 48000, ..level(1) };
    let mut pushed = Tracker::new(&weights(), options()).unwrap();
    let mut queued = Tracker::new(&weights(), options()).unwrap();
    pushed.push_audio(&Audio::float(&sound, 1, 16000).unwrap(), 0.0).unwrap();
    let mut queue = queued.audio_queue().unwrap();
    assert!(queued.audio_queue().is_none(), "only one queue");
    let block = sound.clone();
    let queue = std::thread::spawn(move || {
        for (i, samples) in block.chunks(1600).enumerate() {
            queue.push(&Audio::float(samples, 1, 16000).unwrap(), i as f64 / 10.0).unwrap();
        }
        queue
    });
    let mut queue = queue.join().unwrap();
    let frames = |tracker: &mut Tracker| -> Vec<FaceResult> { (0..60).map(|i| tracker.advance(f64::from(i) / RATE).unwrap()).collect() };
    let (a, b) = (frames(&mut pushed), frames(&mut queued));
    assert!(a.iter().zip(&b).all(|(a, b)| a.controls() == b.controls()));
    assert!(a.iter().any(|result| result.voice_activity() > 0.2));
    drop(queued);
    let long = vec![0.0; 100_000];
    let error = queue.push(&Audio::float(&long, 1, 16000).unwrap(), 9.0).unwrap_err();
    assert_eq!(error.status(), Some(Status::AudioQueueFull), "a queue outlives its tracker");
}

#[test]
fn calibration_reset_and_threads() {
    let mut tracker = Tracker::new(&weights(), level(1)).unwrap();
    tracker.calibrate().unwrap();
    let twice = frames().iter().chain(frames());
    let capturing: Vec<bool> =
        twice.enumerate().map(|(i, frame)| tracker.track(&rgb(frame), i as f64 / RATE).unwrap().is_capturing_neutral()).collect();
    assert!(capturing.contains(&true) && !capturing[capturing.len() - 1]);
    let neutral = tracker.save_neutral().unwrap();
    tracker.reset().unwrap();
    tracker.load_neutral(&neutral).unwrap();
    assert_eq!(tracker.save_neutral().unwrap(), neutral);
    let moved = std::thread::spawn(move || tracker.track(&rgb(&frames()[0]), 0.0).unwrap().has_face());
    assert!(moved.join().unwrap(), "a tracker may go to another thread");
    let several = Options { max_faces: 2, ..level(4) };
    let mut several = Tracker::new(&weights(), several).unwrap();
    assert!(several.track(&rgb(&frames()[0]), 0.0).unwrap().has_face());
    assert_eq!(several.faces().unwrap().len(), 1);
    assert_eq!(several.calibrate().unwrap_err().status(), Some(Status::SeveralFaces));
}

#[test]
fn rejects_times_out_of_range() {
    let mut tracker = Tracker::new(&weights(), Options { audio_queue_samples: 16000, ..level(1) }).unwrap();
    let sound = [0.0; 160];
    let sound = Audio::float(&sound, 1, 16000).unwrap();
    let mut queue = tracker.audio_queue().unwrap();
    for time in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e10, -1e10] {
        let answers = [
            tracker.track(&rgb(&frames()[0]), time).err(),
            tracker.advance(time).err(),
            tracker.push_audio(&sound, time).err(),
            queue.push(&sound, time).err(),
            tracker.set_audio_offset(time).err(),
        ];
        for error in answers {
            assert!(error.unwrap().to_string().contains("number out of range (got "), "{time}");
        }
    }
    tracker.advance(9e9).unwrap();
}

#[test]
fn runs_custom_networks() {
    let model = Weights::open(format!("{REPOSITORY}/models/proposal.mien")).unwrap();
    let mut network = Network::new(&model, Some("rnet"), None).unwrap();
    let shape = network.input_shape();
    assert_eq!((shape.channels, shape.height, shape.width), (3, 24, 24));
    let input: Vec<f32> = (0..shape.size()).map(|i| (i % 17) as f32 / 17.0).collect();
    let outputs = network.run(&input).unwrap();
    assert!(outputs.iter().all(|(shape, values)| shape.size() == values.len()));
    assert_eq!(network.run(&input).unwrap(), outputs);
    let mut other = input.clone();
    other.reverse();
    assert_ne!(network.run(&other).unwrap(), outputs);
    assert!(network.run(&input[1..]).is_err());
    assert_eq!(Network::new(&model, Some("nothing"), None).err().unwrap().status(), Some(Status::WeightsIncomplete));
    network.reset();
    assert_eq!(version(), env!("CARGO_PKG_VERSION"));
}
