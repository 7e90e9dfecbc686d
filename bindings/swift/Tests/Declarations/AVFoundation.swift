// What Examples/CameraFace.swift uses of Apple's AVFoundation, CoreMedia and CoreVideo, so that other systems check its types.
import Foundation

public enum AVMediaType { case video }

public class AVCaptureDevice: NSObject {
  public enum DeviceType { case builtInWideAngleCamera }
  public enum Position { case front }
  public class func `default`(_ type: DeviceType, for media: AVMediaType?, position: Position) -> AVCaptureDevice? { nil }
  public class func requestAccess(for media: AVMediaType, completionHandler: @escaping (Bool) -> Void) {}
}

public class AVCaptureInput: NSObject {}
public class AVCaptureDeviceInput: AVCaptureInput {
  public init(device: AVCaptureDevice) throws {}
}

public class AVCaptureOutput: NSObject {
  public func connection(with media: AVMediaType) -> AVCaptureConnection? { nil }
}
public class AVCaptureVideoDataOutput: AVCaptureOutput {
  public var videoSettings: [String: Any]! = [:]
  public var alwaysDiscardsLateVideoFrames = true
  public func setSampleBufferDelegate(_ delegate: AVCaptureVideoDataOutputSampleBufferDelegate?, queue: DispatchQueue?) {}
}

public class AVCaptureSession: NSObject {
  public var inputs: [AVCaptureInput] { [] }
  public func addInput(_ input: AVCaptureInput) {}
  public func addOutput(_ output: AVCaptureOutput) {}
  public func startRunning() {}
  public func stopRunning() {}
}

public enum AVCaptureVideoOrientation { case portrait }
public class AVCaptureConnection: NSObject {
  public var isVideoOrientationSupported: Bool { false }
  public var videoOrientation = AVCaptureVideoOrientation.portrait
}
public protocol AVCaptureVideoDataOutputSampleBufferDelegate: NSObjectProtocol {
  func captureOutput(_ output: AVCaptureOutput, didOutput sampleBuffer: CMSampleBuffer, from connection: AVCaptureConnection)
}

public class CMSampleBuffer {}
public struct CMTime { public var seconds = 0.0 }
public func CMSampleBufferGetImageBuffer(_ buffer: CMSampleBuffer) -> CVPixelBuffer? { nil }
public func CMSampleBufferGetPresentationTimeStamp(_ buffer: CMSampleBuffer) -> CMTime { CMTime() }

public class CVPixelBuffer {}
public struct CVPixelBufferLockFlags: OptionSet {
  public static let readOnly = CVPixelBufferLockFlags(rawValue: 1)
  public let rawValue: UInt64
  public init(rawValue: UInt64) { self.rawValue = rawValue }
}
public let kCVPixelBufferPixelFormatTypeKey = "PixelFormatType"
public let kCVPixelFormatType_420YpCbCr8BiPlanarFullRange: UInt32 = 0x3432_3066
@discardableResult public func CVPixelBufferLockBaseAddress(_ buffer: CVPixelBuffer, _ flags: CVPixelBufferLockFlags) -> Int32 { 0 }
@discardableResult public func CVPixelBufferUnlockBaseAddress(_ buffer: CVPixelBuffer, _ flags: CVPixelBufferLockFlags) -> Int32 { 0 }
public func CVPixelBufferGetWidth(_ buffer: CVPixelBuffer) -> Int { 0 }
public func CVPixelBufferGetHeight(_ buffer: CVPixelBuffer) -> Int { 0 }
public func CVPixelBufferGetBaseAddressOfPlane(_ buffer: CVPixelBuffer, _ plane: Int) -> UnsafeMutableRawPointer? { nil }
public func CVPixelBufferGetBytesPerRowOfPlane(_ buffer: CVPixelBuffer, _ plane: Int) -> Int { 0 }
