package org.mien;

import java.nio.ByteBuffer;

/** An image in the caller's memory, read without a copy. */
public final class Image {
    /** Pixel format. */
    public enum Format { GRAY8, RGB, BGR, RGBA, BGRA, NV12, NV21, I420 }

    final ByteBuffer[] planes = new ByteBuffer[3];
    final byte[] array;
    private final Format format;
    private final int width, height, chromaPixelStride;
    private final int[] rowStrides = new int[3];
    private int rotation;
    private boolean mirrored, videoRange, bt709;
    private int[] region = new int[4];
    final float[] floats = {0, 0, 0, 1};  // focal length, principal point, pixel aspect

    private Image(Format format, int width, int height, byte[] array, int chromaPixelStride) {
        this.format = format;
        this.width = width;
        this.height = height;
        this.array = array;
        this.chromaPixelStride = chromaPixelStride;
    }

    /** Rows without padding, planes one after another: NV21 of Android's older camera, or bitmaps as bytes. */
    public static Image of(Format format, int width, int height, byte[] pixels) {
        Image image = new Image(format, width, height, pixels, 0);
        long bytes = 0;
        for (int i = 0; i < planesOf(format); ++i) {
            image.rowStrides[i] = (int) image.rowBytes(i);
            bytes += image.rowBytes(i) * image.rows(i);
        }
        if (pixels.length < bytes) {
            throw new IllegalArgumentException("pixels: too short for " + width + " x " + height + " " + format + " (got " + pixels.length + " bytes, expected " + bytes + ")");
        }
        return image;
    }

    /** Direct buffers, each starting at its position. */
    public static Image of(Format format, int width, int height, ByteBuffer[] planes, int[] rowStrides) {
        return of(format, width, height, planes, rowStrides, 0);
    }

    /** Android's YUV_420_888: the planes of android.media.Image or of CameraX' ImageProxy; chromaPixelStride is that of planes 1 and 2. */
    public static Image yuv420(int width, int height, ByteBuffer[] planes, int[] rowStrides, int chromaPixelStride) {
        return of(Format.I420, width, height, planes, rowStrides, chromaPixelStride);
    }

    private static Image of(Format format, int width, int height, ByteBuffer[] planes, int[] rowStrides, int chromaPixelStride) {
        Image image = new Image(format, width, height, null, chromaPixelStride);
        for (int i = 0; i < planesOf(format); ++i) {
            if (!planes[i].isDirect()) {
                throw new IllegalArgumentException("planes: plane " + i + " is not a direct buffer");
            }
            image.rowStrides[i] = rowStrides[i];
            long bytes = (image.rows(i) - 1) * rowStrides[i] + image.rowBytes(i);
            if (rowStrides[i] < 0 || image.rows(i) > 0 && planes[i].remaining() < bytes) {
                throw new IllegalArgumentException("planes: plane " + i + " is too short (got " + planes[i].remaining() + " bytes, expected " + bytes + ")");
            }
            image.planes[i] = planes[i].slice();
        }
        return image;
    }

    /** Clockwise rotation to upright: 0, 90, 180, 270 degrees. */
    public Image rotated(int degrees) {
        rotation = degrees;
        return this;
    }

    /** The image mirrors the scene (selfie camera). */
    public Image mirrored() {
        mirrored = true;
        return this;
    }

    /** Grey and YUV: video range, luma 16..235; otherwise 0..255. */
    public Image videoRange() {
        videoRange = true;
        return this;
    }

    /** YUV uses BT.709; otherwise BT.601. */
    public Image bt709() {
        bt709 = true;
        return this;
    }

    /** Region of interest, in pixels of the buffer before rotation; nothing outside it is read. */
    public Image region(int x, int y, int regionWidth, int regionHeight) {
        region = new int[] {x, y, regionWidth, regionHeight};
        return this;
    }

    /** Focal length and principal point in pixels of the upright image; a principal point of 0, 0 means the centre. */
    public Image camera(float focalLengthPx, float principalX, float principalY) {
        floats[0] = focalLengthPx;
        floats[1] = principalX;
        floats[2] = principalY;
        return this;
    }

    /** Width / height of a pixel of the buffer, 0.1 to 10: 4/3 for HDV of 1440 x 1080. Results are in square pixels: the upright image keeps its height. */
    public Image pixelAspect(float widthOverHeight) {
        floats[3] = widthOverHeight;
        return this;
    }

    int[] integers() {
        return new int[] {format.ordinal(), width, height, rowStrides[0], rowStrides[1], rowStrides[2], chromaPixelStride, rotation,
            mirrored ? 1 : 0, videoRange ? 0 : 1, bt709 ? 1 : 0, region[0], region[1], region[2], region[3],
            (int) (rowBytes(0) * rows(0)), (int) (rowBytes(1) * rows(1))};
    }

    private static int planesOf(Format format) {
        return format == Format.I420 ? 3 : format == Format.NV12 || format == Format.NV21 ? 2 : 1;
    }

    private long rows(int plane) {
        return plane == 0 ? height : (height + 1L) / 2;
    }

    /** Bytes of a row that are read. */
    private long rowBytes(int plane) {
        long chroma = (width + 1L) / 2;
        switch (format) {
            case RGB:
            case BGR:
                return 3L * width;
            case RGBA:
            case BGRA:
                return 4L * width;
            case NV12:
            case NV21:
                return plane == 0 ? width : 2 * chroma;
            case I420:
                return plane == 0 ? width : (chroma - 1) * Math.max(chromaPixelStride, 1) + 1;
            default:
                return width;
        }
    }
}
