import AVFoundation
import CMien
import Foundation
import Mien

/// The front camera moves a face. The app's Info.plist needs NSCameraUsageDescription.
final class CameraFace: NSObject, AVCaptureVideoDataOutputSampleBufferDelegate {
  enum Failure: Error { case noPermission, noCamera }

  private let tracker: Tracker
  private let show: (FaceResult) -> Void
  private let session = AVCaptureSession()
  private let queue = DispatchQueue(label: "mien")  // of the camera and the tracker

  /// `show` is called on the camera's queue; change views on the main one.
  init(weights: Weights, show: @escaping (FaceResult) -> Void) throws {
    tracker = try Tracker(weights: weights)
    self.show = show
  }

  /// Asks for permission the first time.
  func start(failed: @escaping (Error) -> Void) {
    AVCaptureDevice.requestAccess(for: .video) { granted in
      self.queue.async {
        do {
          guard granted else { throw Failure.noPermission }
          if self.session.inputs.isEmpty { try self.connect() }
          self.session.startRunning()
        } catch { failed(error) }
      }
    }
  }

  func stop() { queue.async { self.session.stopRunning() } }

  private func connect() throws {
    guard let camera = AVCaptureDevice.default(.builtInWideAngleCamera, for: .video, position: .front) else { throw Failure.noCamera }
    session.addInput(try AVCaptureDeviceInput(device: camera))
    let output = AVCaptureVideoDataOutput()
    output.videoSettings = [kCVPixelBufferPixelFormatTypeKey as String: kCVPixelFormatType_420YpCbCr8BiPlanarFullRange]
    output.alwaysDiscardsLateVideoFrames = true
    output.setSampleBufferDelegate(self, queue: queue)
    session.addOutput(output)
    if let connection = output.connection(with: .video), connection.isVideoOrientationSupported { connection.videoOrientation = .portrait }
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
