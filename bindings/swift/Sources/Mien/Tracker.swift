import CMien
import Foundation

/// What a tracker is asked for.
public struct TrackerOptions {
  /// Level of detail, 1 (cheapest) to 4; 0: as high as `budgetMs` a frame allows.
  public var lod: Int32 = 0
  /// Faces followed at once, 1...8.
  public var maxFaces: Int32 = 1
  /// Of what hardly moves.
  public var smoothing = true
  public var budgetMs: Float = 10
  /// Of the upright picture, radians, where pictures do not say a focal length; nil: 60 degrees.
  public var horizontalFov: Float?
  /// Room for sound that another thread brings (`Tracker.queueAudio`).
  public var audioQueueSamples: Int32 = 0
  /// What the sound says of the mouth, times this, 0...4.
  public var voiceStrength: Float = 1

  public init() {}
}

/// Follows faces through a stream of pictures, and hears a voice. Used by one thread at a time, but for `queueAudio`.
public final class Tracker {
  private let handle: OpaquePointer
  private let weights: Weights  // which have to stay as long

  public init(weights: Weights, options: TrackerOptions = TrackerOptions()) throws {
    var config = mien_tracker_config()
    mien_tracker_config_default(&config)
    (config.basenet, config.basenet_bytes) = (UnsafeRawPointer(weights.basenet.bytes.baseAddress), weights.basenet.count)
    (config.proposal, config.proposal_bytes) = (UnsafeRawPointer(weights.proposal.bytes.baseAddress), weights.proposal.count)
    if let hifinet = weights.hifinet {
      (config.hifinet, config.hifinet_bytes) = (UnsafeRawPointer(hifinet.bytes.baseAddress), hifinet.count)
    }
    if let audionet = weights.audionet {
      (config.audionet, config.audionet_bytes) = (UnsafeRawPointer(audionet.bytes.baseAddress), audionet.count)
    }
    config.lod = options.lod
    config.max_faces = options.maxFaces
    config.smoothing = options.smoothing ? 1 : 0
    config.budget_ms = options.budgetMs
    config.audio_queue_samples = options.audioQueueSamples
    config.voice_strength = options.voiceStrength
    if let fov = options.horizontalFov { config.horizontal_fov = fov }
    config.clock_ns = { _ in DispatchTime.now().uptimeNanoseconds }
    var made: OpaquePointer?
    try check(mien_tracker_create(&config, &made))
    handle = made!
    self.weights = weights
  }

  deinit { mien_tracker_destroy(handle) }

  /// Tracks one picture and tells of the face known longest. `time`: of the picture, seconds, on any clock.
  public func track(_ image: Image, at time: Double) throws -> FaceResult {
    var raw = image.raw
    try check(mien_tracker_push_video(handle, &raw, nanoseconds(time)))
    return try result()
  }

  /// A frame of output without a picture: for sound alone.
  public func advance(to time: Double) throws -> FaceResult {
    try check(mien_tracker_advance(handle, nanoseconds(time)))
    return try result()
  }

  /// Of the last picture, of the face known longest.
  public func result() throws -> FaceResult {
    var raw = mien_result()
    mien_result_default(&raw)
    try check(mien_tracker_get_result(handle, &raw))
    return FaceResult(raw: raw)
  }

  /// Of the last picture, every face known.
  public func faces() throws -> [FaceResult] {
    try (0..<mien_tracker_face_count(handle)).map { index in
      var raw = mien_result()
      mien_result_default(&raw)
      try check(mien_tracker_get_face(handle, index, &raw))
      return FaceResult(raw: raw)
    }
  }

  /// Hears samples of -1...1, channels in turns; `time` is that of the first.
  public func pushAudio(_ samples: UnsafeBufferPointer<Float>, channels: Int32 = 1, sampleRate: Int32 = 48000, at time: Double) throws {
    var audio = described(samples, channels, sampleRate)
    try check(mien_tracker_push_audio(handle, &audio, nanoseconds(time)))
  }

  /// The same from a real-time thread, for the next frame. It neither waits nor allocates, unless there is no room and it throws.
  public func queueAudio(_ samples: UnsafeBufferPointer<Float>, channels: Int32 = 1, sampleRate: Int32 = 48000, at time: Double) throws {
    var audio = described(samples, channels, sampleRate)
    try check(mien_tracker_queue_audio(handle, &audio, nanoseconds(time)))
  }

  /// Sound pushed from now on belongs to pictures that much later.
  public func setAudioOffset(_ seconds: Double) throws {
    try check(mien_tracker_set_audio_offset(handle, nanoseconds(seconds)))
  }

  /// How much sound and picture count for a control while somebody speaks, each 0...1.
  public func setMix(_ control: String, audio: Float, video: Float) throws {
    guard let number = Controls.names.firstIndex(of: control) else { throw MienError.input("no control '\(control)'") }
    try check(mien_tracker_set_mix(handle, Int32(number), audio, video))
  }

  public func setLod(_ lod: Int32) throws { try check(mien_tracker_set_lod(handle, lod)) }

  /// Captures, over the next 55 frames with a face, what it shows when it is neutral, to be taken out from then on.
  public func calibrate() throws { try check(mien_tracker_capture_neutral(handle)) }

  /// What was captured, to be kept.
  public func saveNeutral() throws -> Data {
    var file = [UInt8](repeating: 0, count: Int(MIEN_NEUTRAL_BYTES))
    try check(mien_tracker_save_neutral(handle, &file, file.count, nil))
    return Data(file)
  }

  public func loadNeutral(_ file: Data) throws {
    let bytes = [UInt8](file)
    try check(mien_tracker_load_neutral(handle, bytes, bytes.count))
  }

  /// Forgets everything seen and heard.
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
