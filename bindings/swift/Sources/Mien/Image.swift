import CMien

/// A picture that somebody else owns: it is read where it lies, never copied.
public struct Image {
  var raw = mien_image()

  /// Planes as `mien_image` of `mien.h` wants them, which have to stay during `Tracker.track`.
  public init(
    format: mien_image_format, width: Int, height: Int, planes: [UnsafeRawPointer?], rowBytes: [Int], chromaPixelStride: Int = 0
  ) {
    mien_image_default(&raw)
    raw.format = Int32(bitPattern: format.rawValue)
    // What does not fit becomes a number that the library refuses, not another one.
    let refused: Int32 = -1
    (raw.width, raw.height) = (Int32(exactly: width) ?? refused, Int32(exactly: height) ?? refused)
    raw.planes = (planes[0], planes.count > 1 ? planes[1] : nil, planes.count > 2 ? planes[2] : nil)
    let strides = (rowBytes + [0, 0]).map { Int32(exactly: $0) ?? 0 }
    raw.row_stride_bytes = (strides[0], strides[1], strides[2])
    raw.chroma_pixel_stride_bytes = Int32(exactly: chromaPixelStride) ?? refused
  }

  /// Degrees clockwise that make it upright: 0, 90, 180, 270.
  public var rotation: Int32 {
    get { raw.rotation }
    set { raw.rotation = newValue }
  }

  /// A mirror image of the scene, a selfie.
  public var mirrored: Bool {
    get { raw.mirrored != 0 }
    set { raw.mirrored = newValue ? 1 : 0 }
  }

  /// Of grey and YUV: luma is 0...255; else 16...235.
  public var fullRange: Bool {
    get { raw.full_range != 0 }
    set { raw.full_range = newValue ? 1 : 0 }
  }

  /// YUV is that of BT.709; else BT.601.
  public var bt709: Bool {
    get { raw.yuv_matrix != 0 }
    set { raw.yuv_matrix = newValue ? 1 : 0 }
  }

  /// x, y, width, height in its pixels: nothing else is looked at.
  public mutating func setRegion(x: Int32, y: Int32, width: Int32, height: Int32) {
    raw.region = (x, y, width, height)
  }

  /// Width of a pixel / its height, 0.1...10. Results are in square pixels: the upright picture keeps its height.
  public var pixelAspect: Float {
    get { raw.pixel_aspect == 0 ? 1 : raw.pixel_aspect }
    set { raw.pixel_aspect = newValue }
  }

  /// In pixels of the upright picture; 0: not known.
  public var focalLength: Float {
    get { raw.focal_length_px }
    set { raw.focal_length_px = newValue }
  }
}
