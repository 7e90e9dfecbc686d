import AVFoundation
import CMien
import Mien

/// The front camera moves a face: give it a session's AVCaptureVideoDataOutput with 420YpCbCr8BiPlanarFullRange.
final class CameraFace: NSObject, AVCaptureVideoDataOutputSampleBufferDelegate {
  private let tracker: Tracker
  private let show: (FaceResult) -> Void

  init(weights: Weights, show: @escaping (FaceResult) -> Void) throws {
    tracker = try Tracker(weights: weights)
    self.show = show
  }

  func captureOutput(_ output: AVCaptureOutput, didOutput buffer: CMSampleBuffer, from connection: AVCaptureConnection) {
    guard let pixels = CMSampleBufferGetImageBuffer(buffer) else { return }
    CVPixelBufferLockBaseAddress(pixels, .readOnly)
    defer { CVPixelBufferUnlockBaseAddress(pixels, .readOnly) }
    let image = Image(
      format: MIEN_IMAGE_NV12, width: CVPixelBufferGetWidth(pixels), height: CVPixelBufferGetHeight(pixels),
      planes: (0..<2).map { UnsafeRawPointer(CVPixelBufferGetBaseAddressOfPlane(pixels, $0)) },
      rowBytes: (0..<2).map { CVPixelBufferGetBytesPerRowOfPlane(pixels, $0) })
    let time = CMSampleBufferGetPresentationTimeStamp(buffer).seconds
    if let result = try? tracker.track(image, at: time) { show(result) }
  }
}
