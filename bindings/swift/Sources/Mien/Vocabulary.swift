import CMien

/// Names of controls in another standard.
public enum Vocabulary: Int32, CaseIterable {
  case arkit = 0, mediaPipe, roblox, vrm0, vrm1, visemes

  /// The names in order, spelled as in the standard.
  public var names: [String] {
    (0..<mien_vocabulary_size(rawValue)).map { String(cString: mien_vocabulary_name(rawValue, $0)) }
  }
}

/// Controls in the order of `Controls.names`: `mien_control` of `mien.h`.
public enum Control: Int, CaseIterable {
  case eyeBlinkLeft, eyeLookDownLeft, eyeLookInLeft, eyeLookOutLeft, eyeLookUpLeft, eyeSquintLeft, eyeWideLeft, eyeBlinkRight
  case eyeLookDownRight, eyeLookInRight, eyeLookOutRight, eyeLookUpRight, eyeSquintRight, eyeWideRight, jawForward, jawLeft, jawRight
  case jawOpen, mouthClose, mouthFunnel, mouthPucker, mouthLeft, mouthRight, mouthSmileLeft, mouthSmileRight, mouthFrownLeft
  case mouthFrownRight, mouthDimpleLeft, mouthDimpleRight, mouthStretchLeft, mouthStretchRight, mouthRollLower, mouthRollUpper
  case mouthShrugLower, mouthShrugUpper, mouthPressLeft, mouthPressRight, mouthLowerDownLeft, mouthLowerDownRight, mouthUpperUpLeft
  case mouthUpperUpRight, browDownLeft, browDownRight, browInnerUp, browOuterUpLeft, browOuterUpRight, cheekPuff, cheekSquintLeft
  case cheekSquintRight, noseSneerLeft, noseSneerRight, tongueOut

  /// ARKit's name.
  public var name: String { String(cString: mien_control_name(Int32(rawValue))) }
}

/// Groups of landmarks: `mien_landmark_group` of `mien.h`, which describes them.
public enum LandmarkGroup: Int32, CaseIterable {
  case rightEyeLower, leftEyeLower, rightEyeUpper, leftEyeUpper, rightIris, leftIris, rightBrowUpper, leftBrowUpper, rightBrowLower
  case leftBrowLower, rightNoseSide, leftNoseSide, rightCheek, leftCheek, noseBridge, midline, lipsOuterUpper, lipsOuterLower
  case lipsInnerUpper, lipsInnerLower, faceOval

  /// Indices of its landmarks.
  public var range: Range<Int> {
    var first: Int32 = 0
    let count = mien_landmark_group_range(rawValue, &first)
    return Int(first)..<Int(first + count)
  }
}

/// 52 animation weights, 0...1: `controls["jawOpen"]` and `controls[.jawOpen]` return one of them.
public struct Controls {
  public static let names = Vocabulary.arkit.names

  /// In the order of `names`.
  public let array: [Float]
  let supportedBits: UInt64

  public subscript(control: Control) -> Float { array[control.rawValue] }

  /// Nil for an unknown name.
  public subscript(name: String) -> Float? {
    Controls.names.firstIndex(of: name).map { array[$0] }
  }

  /// The controls that this level of detail predicts; the others are 0.
  public var supported: Set<String> {
    Set(Controls.names.enumerated().filter { supportedBits >> UInt64($0.offset) & 1 != 0 }.map { $0.element })
  }

  /// The controls in another vocabulary, 0...1, in the order of its names.
  public func to(_ vocabulary: Vocabulary) throws -> [Float] {
    var values = [Float](repeating: 0, count: Int(mien_vocabulary_size(vocabulary.rawValue)))
    try check(mien_vocabulary_values(vocabulary.rawValue, array, &values, Int32(values.count)))
    return values
  }
}
