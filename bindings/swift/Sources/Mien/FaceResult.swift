import CMien

/// Status of a face.
public enum FaceStatus: Int32 {
  /// No face since the start or reset.
  case searching = 0
  /// The face is tracked.
  case tracking
  /// The face is lost: it keeps its last position, and its controls fade.
  case lost
}

/// The head in camera space: x to the right, y up, z towards the viewer.
public struct Pose {
  /// Unit quaternion x, y, z, w.
  public let rotation: SIMD4<Float>
  /// Metres.
  public let translation: SIMD3<Float>
  /// Radians. Positive pitch looks down, positive yaw turns to the subject's left; roll is about z by the right-hand rule.
  public let pitch, yaw, roll: Float
}

/// One face on one frame.
public struct FaceResult {
  let raw: mien_result

  public var status: FaceStatus { FaceStatus(rawValue: raw.status) ?? .searching }
  public var hasFace: Bool { status == .tracking }
  /// Timestamp of the frame, seconds.
  public var time: Double { Double(raw.pts_ns) / 1e9 }
  /// Number of the face, from 1 in the order of detection; 0 before the first.
  public var faceId: UInt32 { raw.face_id }
  /// The level of detail of this frame, 1...4.
  public var lod: Int32 { raw.lod }
  /// 0...1, of the latest crop.
  public var faceProbability: Float { raw.face_probability }
  /// 0...1: voice activity; 0 without audio.
  public var voiceActivity: Float { raw.voice_activity }
  /// Whether this frame contributes to `Tracker.calibrate`.
  public var isCapturingNeutral: Bool { raw.flags & 0x10 != 0 }
  /// x, y, width, height in pixels of the upright image.
  public var box: SIMD4<Float> { SIMD4(raw.box.0, raw.box.1, raw.box.2, raw.box.3) }
  /// 52 animation weights, 0...1.
  public var controls: Controls { Controls(array: floats(of: raw.controls), supportedBits: raw.supported_controls) }

  /// 175 of them, in pixels of the upright image.
  public var landmarks: [SIMD2<Float>] {
    let all = floats(of: raw.landmarks)
    return stride(from: 0, to: all.count, by: 2).map { SIMD2(all[$0], all[$0 + 1]) }
  }

  /// The landmarks of a group, in pixels of the upright image.
  public func landmarks(of group: LandmarkGroup) -> [SIMD2<Float>] { Array(landmarks[group.range]) }

  /// The head in camera space.
  public var pose: Pose {
    let (r, t) = (raw.rotation, raw.translation)
    return Pose(
      rotation: SIMD4(r.0, r.1, r.2, r.3), translation: SIMD3(t.0, t.1, t.2), pitch: raw.pitch, yaw: raw.yaw, roll: raw.roll)
  }
}

/// C arrays are tuples in Swift.
private func floats<T>(of tuple: T) -> [Float] {
  withUnsafeBytes(of: tuple) { Array($0.bindMemory(to: Float.self)) }
}
