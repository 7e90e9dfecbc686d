import CMien

/// Errors of this package.
public enum MienError: Error, CustomStringConvertible {
  /// An error of the library; `status` is `mien_status` of `mien.h`.
  case status(Int32)
  /// Invalid input that this package detects before it calls the library.
  case input(String)

  public var description: String {
    switch self {
    case .status(let number): return String(cString: mien_status_string(mien_status(rawValue: number)))
    case .input(let what): return what
    }
  }
}

func check(_ status: mien_status) throws {
  if status != MIEN_OK { throw MienError.status(status.rawValue) }
}
