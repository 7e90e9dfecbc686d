import CMien
import Foundation

/// Opened weight files. Any number of trackers may share them.
public final class Weights {
  let handle: OpaquePointer

  /// Copies files: each is a weight file, a packed one, or a bundle of several, in any order.
  public convenience init(_ files: [Data]) throws {
    try self.init(files, names: files.indices.map { "weights[\($0)]" })
  }

  /// A file, or a folder: its basenet.mien and proposal.mien, and hifinet.mien and audionet.mien if present.
  public convenience init(contentsOf url: URL) throws {
    var isFolder: ObjCBool = false
    let exists = FileManager.default.fileExists(atPath: url.path, isDirectory: &isFolder)
    var urls = [url]
    if exists && isFolder.boolValue {
      let optional = ["hifinet", "audionet"].map { url.appendingPathComponent("\($0).mien") }
      urls = ["basenet", "proposal"].map { url.appendingPathComponent("\($0).mien") }
      urls += optional.filter { FileManager.default.fileExists(atPath: $0.path) }
    }
    try self.init(try urls.map { try Data(contentsOf: $0) }, names: urls.map(\.path))
  }

  private init(_ files: [Data], names: [String]) throws {
    guard files.count <= Int(MIEN_MAX_WEIGHT_FILES) else { throw MienError.input("files: too many (got \(files.count), expected 8 at most)") }
    var config = mien_weights_config()
    mien_weights_config_default(&config)
    config.copy = 1
    let copies = files.map { file -> UnsafeMutableRawBufferPointer in
      let copy = UnsafeMutableRawBufferPointer.allocate(byteCount: max(file.count, 1), alignment: 1)
      file.copyBytes(to: copy)
      return copy
    }
    defer { copies.forEach { $0.deallocate() } }
    withUnsafeMutableBytes(of: &config.files) { places in
      for (i, copy) in copies.enumerated() { places.bindMemory(to: UnsafeRawPointer?.self)[i] = UnsafeRawPointer(copy.baseAddress) }
    }
    withUnsafeMutableBytes(of: &config.file_bytes) { sizes in
      for (i, file) in files.enumerated() { sizes.bindMemory(to: Int.self)[i] = file.count }
    }
    var made: OpaquePointer?
    var detail = newDetail()
    try check(mien_weights_create(&config, &made, &detail), detail, names)
    handle = made!
  }

  /// Trackers keep the weights that they use.
  deinit { mien_weights_destroy(handle) }
}
