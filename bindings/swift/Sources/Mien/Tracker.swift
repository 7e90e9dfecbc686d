import CMien
import Foundation

/// Options of a tracker.
public struct TrackerOptions {
  /// Level of detail, 1 (fastest) to 4 (most accurate); 0: automatic, the highest within `budgetMs` per frame.
  public var lod: Int32 = 0
  /// Maximum number of faces, 1...8.
  public var maxFaces: Int32 = 1
  /// Whether to use audio, if the weights have AudioNet.
  public var sound = true
  /// Smooths controls, landmarks and pose while they hardly move.
  public var smoothing = true
  /// Average time budget of a frame with a face for `lod` 0, ms, 0.01...1e6.
  public var budgetMs: Float = 10
  /// Horizontal field of view of the upright image, for images without a focal length, in radians, 0.01...3.1; nil: 60 degrees.
  public var horizontalFov: Float?
  /// Capacity of the audio queue (`Tracker.queueAudio`), in samples of one channel, 0...2^22; 0: no queue.
  public var audioQueueSamples: Int32 = 0
  /// Factor of the controls predicted from audio, 0...4.
  public var voiceStrength: Float = 1

  public init() {}
}

/// Tracks faces in a stream of images and audio. One thread at a time may use it, except for `queueAudio`.
public final class Tracker {
  private let handle: OpaquePointer

  public init(weights: Weights, options: TrackerOptions = TrackerOptions()) throws {
    var config = mien_tracker_config()
    mien_tracker_config_default(&config)
    config.weights = weights.handle
    config.max_lod = options.lod == 1 ? 1 : 4
    config.audio = options.sound ? 1 : 0
    config.lod = options.lod
    config.max_faces = options.maxFaces
    config.smoothing = options.smoothing ? 1 : 0
    config.budget_ms = options.budgetMs
    config.audio_queue_samples = options.audioQueueSamples
    config.voice_strength = options.voiceStrength
    if let fov = options.horizontalFov { config.horizontal_fov = fov }
    config.clock_ns = { _ in DispatchTime.now().uptimeNanoseconds }
    var made: OpaquePointer?
    var detail = newDetail()
    try check(mien_tracker_create(&config, &made, &detail), detail)
    handle = made!
  }

  deinit { mien_tracker_destroy(handle) }

  /// Tracks one image and returns the result of the face with the lowest id. `time`: timestamp of the image in seconds, on any clock.
  public func track(_ image: Image, at time: Double) throws -> FaceResult {
    var raw = image.raw
    try check(mien_tracker_push_video(handle, &raw, nanoseconds(time)))
    return try result()
  }

  /// Outputs a frame without an image, for audio without video. `time`: seconds, on the clock of the images.
  public func advance(to time: Double) throws -> FaceResult {
    try check(mien_tracker_advance(handle, nanoseconds(time)))
    return try result()
  }

  /// The result of the latest frame, of the face with the lowest id.
  public func result() throws -> FaceResult {
    var raw = mien_result()
    mien_result_default(&raw)
    try check(mien_tracker_get_result(handle, &raw))
    return FaceResult(raw: raw)
  }

  /// The results of all known faces on the latest frame.
  public func faces() throws -> [FaceResult] {
    try (0..<mien_tracker_face_count(handle)).map { index in
      var raw = mien_result()
      mien_result_default(&raw)
      try check(mien_tracker_get_face(handle, index, &raw))
      return FaceResult(raw: raw)
    }
  }

  /// Processes interleaved samples of -1...1; `time` is the timestamp of the first, in seconds. `channels`: 1...8; `sampleRate`: 8000...192000 Hz.
  public func pushAudio(_ samples: UnsafeBufferPointer<Float>, channels: Int32 = 1, sampleRate: Int32 = 48000, at time: Double) throws {
    var audio = described(samples, channels, sampleRate)
    try check(mien_tracker_push_audio(handle, &audio, nanoseconds(time)))
  }

  /// Queues audio, as for `pushAudio`, from a real-time thread for the next frame. Neither waits nor allocates, except to throw if the queue is full.
  public func queueAudio(_ samples: UnsafeBufferPointer<Float>, channels: Int32 = 1, sampleRate: Int32 = 48000, at time: Double) throws {
    var audio = described(samples, channels, sampleRate)
    try check(mien_tracker_queue_audio(handle, &audio, nanoseconds(time)))
  }

  /// Delays audio relative to the images by `seconds`, for audio pushed from now on.
  public func setAudioOffset(_ seconds: Double) throws {
    try check(mien_tracker_set_audio_offset(handle, nanoseconds(seconds)))
  }

  /// Weights of audio and video for a control during speech, each 0...1.
  public func setMix(_ control: String, audio: Float, video: Float) throws {
    guard let number = Controls.names.firstIndex(of: control) else { throw MienError.input("control: unknown (got '\(control)')") }
    try check(mien_tracker_set_mix(handle, Int32(number), audio, video))
  }

  /// Sets the level of detail, 0...4, from the next image on.
  public func setLod(_ lod: Int32) throws { try check(mien_tracker_set_lod(handle, lod)) }

  /// Captures a person's neutral controls over the next 55 frames with a face, and removes them from later frames.
  public func calibrate() throws { try check(mien_tracker_capture_neutral(handle)) }

  /// The captured neutral values as a file of 448 bytes.
  public func saveNeutral() throws -> Data {
    var file = [UInt8](repeating: 0, count: Int(MIEN_NEUTRAL_BYTES))
    try check(mien_tracker_save_neutral(handle, &file, file.count, nil))
    return Data(file)
  }

  /// Restores saved neutral values.
  public func loadNeutral(_ file: Data) throws {
    let bytes = [UInt8](file)
    try check(mien_tracker_load_neutral(handle, bytes, bytes.count))
  }

  /// Resets the tracker to its state after creation.
  public func reset() throws { try check(mien_tracker_reset(handle)) }
}

private func nanoseconds(_ seconds: Double) throws -> Int64 {
  guard let ns = Int64(exactly: (seconds * 1e9).rounded()) else {
    throw MienError.input("time: number out of range (got \(seconds) s, expected a whole number of nanoseconds in 64 bits)")
  }
  return ns
}

private func described(_ samples: UnsafeBufferPointer<Float>, _ channels: Int32, _ sampleRate: Int32) -> mien_audio {
  var audio = mien_audio()
  mien_audio_default(&audio)
  audio.channels = channels
  audio.sample_rate = sampleRate
  audio.frames = samples.count / max(Int(channels), 1)
  audio.samples.0 = UnsafeRawPointer(samples.baseAddress)
  return audio
}
