import CMien

/// An image in the caller's memory, read without a copy.
public struct Image {
  var raw = mien_image()

  /// Width and height in pixels, 1...16384; for each plane its address and bytes per row, as in `mien_image` of `mien.h`;
  /// `chromaPixelStride`: I420: bytes between samples of U or V, 0 means 1. Planes must stay valid during `Tracker.track`.
  public init(
    format: mien_image_format, width: Int, height: Int, planes: [UnsafeRawPointer?], rowBytes: [Int], chromaPixelStride: Int = 0
  ) {
    mien_image_default(&raw)
    raw.format = Int32(bitPattern: format.rawValue)
    // A value outside the range of Int32 becomes one that the library rejects.
    let refused: Int32 = -1
    (raw.width, raw.height) = (Int32(exactly: width) ?? refused, Int32(exactly: height) ?? refused)
    raw.planes = (planes[0], planes.count > 1 ? planes[1] : nil, planes.count > 2 ? planes[2] : nil)
    let strides = (rowBytes + [0, 0]).map { Int32(exactly: $0) ?? 0 }
    raw.row_stride_bytes = (strides[0], strides[1], strides[2])
    raw.chroma_pixel_stride_bytes = Int32(exactly: chromaPixelStride) ?? refused
  }

  /// Clockwise rotation to upright: 0, 90, 180, 270 degrees.
  public var rotation: Int32 {
    get { raw.rotation }
    set { raw.rotation = newValue }
  }

  /// The image mirrors the scene (selfie camera).
  public var mirrored: Bool {
    get { raw.mirrored != 0 }
    set { raw.mirrored = newValue ? 1 : 0 }
  }

  /// Grey and YUV: luma 0...255; otherwise video range, 16...235.
  public var fullRange: Bool {
    get { raw.full_range != 0 }
    set { raw.full_range = newValue ? 1 : 0 }
  }

  /// YUV uses BT.709; otherwise BT.601.
  public var bt709: Bool {
    get { raw.yuv_matrix != 0 }
    set { raw.yuv_matrix = newValue ? 1 : 0 }
  }

  /// Region of interest: x, y, width, height in pixels of the buffer before rotation; nothing outside it is read.
  public mutating func setRegion(x: Int32, y: Int32, width: Int32, height: Int32) {
    raw.region = (x, y, width, height)
  }

  /// Width of a pixel / its height, 0.1...10. Results are in square pixels: the upright image keeps its height.
  public var pixelAspect: Float {
    get { raw.pixel_aspect == 0 ? 1 : raw.pixel_aspect }
    set { raw.pixel_aspect = newValue }
  }

  /// Focal length in pixels of the upright image; 0: unknown.
  public var focalLength: Float {
    get { raw.focal_length_px }
    set { raw.focal_length_px = newValue }
  }
}
