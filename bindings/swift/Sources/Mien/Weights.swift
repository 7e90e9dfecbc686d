import CMien
import Foundation

/// A weight file in aligned memory. Trackers may share one.
public final class Model {
  let bytes: UnsafeMutableRawBufferPointer

  public init(_ data: Data) {
    bytes = .allocate(byteCount: max(data.count, 1), alignment: Int(MIEN_ALIGNMENT))
    count = data.count
    data.copyBytes(to: bytes)
  }

  public convenience init(contentsOf url: URL) throws {
    self.init(try Data(contentsOf: url))
  }

  let count: Int

  deinit { bytes.deallocate() }
}

/// The weights of trackers. Several trackers may share them.
public struct Weights {
  /// Tracking and level of detail 1; detection; levels of detail 2 to 4; audio.
  public var basenet, proposal: Model
  public var hifinet, audionet: Model?

  public init(basenet: Model, proposal: Model, hifinet: Model? = nil, audionet: Model? = nil) {
    (self.basenet, self.proposal, self.hifinet, self.audionet) = (basenet, proposal, hifinet, audionet)
  }

  /// The files of a folder: basenet.mien and proposal.mien, and hifinet.mien and audionet.mien if present.
  public init(folder: URL) throws {
    let file = { (name: String) in folder.appendingPathComponent("\(name).mien") }
    let optional = { (name: String) -> Model? in
      FileManager.default.fileExists(atPath: file(name).path) ? try Model(contentsOf: file(name)) : nil
    }
    self.init(
      basenet: try Model(contentsOf: file("basenet")), proposal: try Model(contentsOf: file("proposal")),
      hifinet: try optional("hifinet"), audionet: try optional("audionet"))
  }
}
