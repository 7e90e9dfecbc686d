import CMien

/// What goes wrong.
public enum MienError: Error, CustomStringConvertible {
  /// The library refused; `status` is `mien_status` of `mien.h`.
  case status(Int32)
  /// What was given does not fit together.
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
