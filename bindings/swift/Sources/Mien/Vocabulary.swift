import CMien

/// Names of controls in another standard.
public enum Vocabulary: Int32, CaseIterable {
  case arkit = 0, mediaPipe, roblox, vrm0, vrm1, visemes

  /// The names in order, spelled as in the standard.
  public var names: [String] {
    (0..<mien_vocabulary_size(rawValue)).map { String(cString: mien_vocabulary_name(rawValue, $0)) }
  }
}

/// 52 animation weights, 0..1: `controls["jawOpen"]` asks by ARKit name.
public struct Controls {
  public static let names = Vocabulary.arkit.names

  /// In the order of `names`.
  public let array: [Float]
  let supportedBits: UInt64

  /// Nil for an unknown name.
  public subscript(name: String) -> Float? {
    Controls.names.firstIndex(of: name).map { array[$0] }
  }

  /// The controls that this level of detail predicts; the others are 0.
  public var supported: Set<String> {
    Set(Controls.names.enumerated().filter { supportedBits >> UInt64($0.offset) & 1 != 0 }.map { $0.element })
  }

  /// The controls in another vocabulary, in the order of its names.
  public func to(_ vocabulary: Vocabulary) throws -> [Float] {
    var values = [Float](repeating: 0, count: Int(mien_vocabulary_size(vocabulary.rawValue)))
    try check(mien_vocabulary_values(vocabulary.rawValue, array, &values, Int32(values.count)))
    return values
  }
}
