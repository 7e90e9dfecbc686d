import CMien

/// Errors of this package.
public enum MienError: Error, CustomStringConvertible {
  /// An error of the library; `status` is `mien_status` of `mien.h`.
  case status(Int32)
  /// An error of the library, with a line that names the cause: field, file, layer or byte.
  case detail(Int32, String)
  /// Invalid input that this package detects before it calls the library.
  case input(String)

  public var description: String {
    switch self {
    case .status(let number): return String(cString: mien_status_string(mien_status(rawValue: number)))
    case .detail(_, let line): return line
    case .input(let what): return what
    }
  }
}

func check(_ status: mien_status) throws {
  if status != MIEN_OK { throw MienError.status(status.rawValue) }
}

func newDetail() -> mien_error_detail {
  var detail = mien_error_detail()
  mien_error_detail_default(&detail)
  return detail
}

/// `names`: of the weight files.
func check(_ status: mien_status, _ detail: mien_error_detail, _ names: [String] = []) throws {
  if status == MIEN_OK { return }
  var text = [CChar](repeating: 0, count: 256)
  var detail = detail
  mien_error_message(&detail, &text, text.count)
  let line = String(cString: text), file = Int(detail.file)
  throw MienError.detail(status.rawValue, names.indices.contains(file) ? "\(names[file]): \(line)" : line)
}
