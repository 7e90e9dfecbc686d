import CMien
import Foundation
import XCTest

@testable import Mien

/// On the clip that ships. MIEN_CLIP: 60 frames of it, 640x480, RGB; MIEN_MODELS: the weights.
final class TrackerTests: XCTestCase {
  private func path(_ name: String) throws -> URL {
    URL(fileURLWithPath: try XCTUnwrap(ProcessInfo.processInfo.environment[name], "\(name) is not set"))
  }

  func testTracksAFace() throws {
    var options = TrackerOptions()
    options.lod = 1
    let tracker = try Tracker(weights: try Weights(contentsOf: path("MIEN_MODELS")), options: options)
    let clip = try Data(contentsOf: path("MIEN_CLIP"))
    let bytes = 640 * 480 * 3
    for i in 0..<20 {
      try clip[i * bytes..<(i + 1) * bytes].withUnsafeBytes {
        let image = Image(format: MIEN_IMAGE_RGB, width: 640, height: 480, planes: [$0.baseAddress], rowBytes: [640 * 3])
        _ = try tracker.track(image, at: Double(i) / 30)
      }
    }
    let result = try tracker.result()
    XCTAssertTrue(result.hasFace)
    XCTAssertEqual(result.landmarks.count, 175)
    XCTAssertEqual(Control.allCases.map(\.name), Controls.names)
    XCTAssertEqual(Control.allCases.map { "\($0)" }, Controls.names)
    XCTAssertEqual(result.controls["jawOpen"], result.controls[.jawOpen])
    XCTAssertEqual(LandmarkGroup.allCases.flatMap(\.range), Array(0..<175))
    XCTAssertEqual(result.landmarks(of: .leftIris).count, 5)
    XCTAssertEqual(Vocabulary.allCases.map { $0.names.count }, [52, 52, 50, 11, 11, 15])
  }

  func testReportsErrors() throws {
    XCTAssertThrowsError(try Weights([Data(count: 640)])) {
      XCTAssertEqual("\($0)", "weights[0]: byte 0, magic: the weights are not a .mien file (got 0, expected 137)")
    }
  }
}
