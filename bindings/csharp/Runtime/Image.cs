using System;
using System.Runtime.InteropServices;

namespace Mien
{
    public enum PixelFormat
    {
        Gray8 = 0,
        Rgb = 1,
        Bgr = 2,
        Rgba = 3,
        Bgra = 4,
        Nv12 = 5,
        Nv21 = 6,
        I420 = 7,
    }

    /// <summary>An image in the caller's memory, read without a copy.</summary>
    public sealed class Image
    {
        public PixelFormat Format;
        public int Width, Height;
        /// <summary>Clockwise rotation to upright: 0, 90, 180, 270 degrees.</summary>
        public int Rotation;
        /// <summary>The image mirrors the scene (selfie camera).</summary>
        public bool Mirrored;
        /// <summary>Grey and YUV: luma 0..255; otherwise video range, 16..235.</summary>
        public bool FullRange = true;
        /// <summary>YUV uses BT.709; otherwise BT.601.</summary>
        public bool Bt709;
        /// <summary>Region of interest: x, y, width, height in pixels of the buffer before rotation; null: the whole image.</summary>
        public int[] Region;
        /// <summary>Focal length in pixels of the upright image; 0: unknown.</summary>
        public float FocalLengthPx;
        /// <summary>Principal point in pixels of the upright image; both 0: its centre.</summary>
        public float PrincipalX, PrincipalY;
        /// <summary>Width of a pixel / its height, 0.1 to 10. Results are in square pixels: the upright image keeps its height.</summary>
        public float PixelAspect = 1f;
        /// <summary>I420: bytes from one sample of U or V to the next; 0 means 1.</summary>
        public int ChromaPixelStrideBytes;
        /// <summary>The bottom row comes first in memory, as in Unity's textures; one plane only. Native planes start with that row as well.</summary>
        public bool BottomUp;

        byte[] array;
        IntPtr[] planes;
        int[] strides;

        /// <summary>Rows without padding, planes one after another.</summary>
        public Image(PixelFormat format, int width, int height, byte[] pixels)
        {
            if (pixels == null) throw new ArgumentNullException("pixels");
            Format = format;
            Width = width;
            Height = height;
            array = pixels;
        }

        /// <summary>Planes in native memory, as from cameras and textures; must stay valid during Tracker.Track.</summary>
        public Image(PixelFormat format, int width, int height, IntPtr[] planes, int[] rowStrideBytes)
        {
            if (planes == null) throw new ArgumentNullException("planes");
            if (rowStrideBytes == null) throw new ArgumentNullException("rowStrideBytes");
            if (planes.Length > 3 || rowStrideBytes.Length > 3) throw new ArgumentException("planes: too many (expected at most 3)");
            Format = format;
            Width = width;
            Height = height;
            this.planes = planes;
            strides = rowStrideBytes;
        }

        /// <summary>Calls `use` with the layout of the pixels, which are pinned meanwhile.</summary>
        internal void Use(Action<Native.mien_image> use)
        {
            Native.mien_image raw;
            Native.mien_image_default(out raw);
            raw.format = (int)Format;
            raw.width = Width;
            raw.height = Height;
            raw.rotation = Rotation;
            raw.mirrored = Mirrored ? 1 : 0;
            raw.full_range = FullRange ? 1 : 0;
            raw.yuv_matrix = Bt709 ? 1 : 0;
            raw.focal_length_px = FocalLengthPx;
            raw.principal_x = PrincipalX;
            raw.principal_y = PrincipalY;
            raw.pixel_aspect = PixelAspect;
            raw.chroma_pixel_stride_bytes = ChromaPixelStrideBytes;
            if (Region != null && Region.Length != 4) throw new ArgumentException("Region: wrong length (got " + Region.Length + ", expected 4)");
            if (Region != null) Region.CopyTo(raw.region, 0);
            if (array == null)
            {
                planes.CopyTo(raw.planes, 0);
                strides.CopyTo(raw.row_stride_bytes, 0);
                if (BottomUp) FlipRows(ref raw);
                use(raw);
                return;
            }
            var pin = GCHandle.Alloc(array, GCHandleType.Pinned);
            try
            {
                SetContiguousPlanes(ref raw, pin.AddrOfPinnedObject());
                if (BottomUp) FlipRows(ref raw);
                use(raw);
            }
            finally
            {
                pin.Free();
            }
        }

        void SetContiguousPlanes(ref Native.mien_image raw, IntPtr place)
        {
            long chromaWidth = ((long)Width + 1) / 2, chromaHeight = ((long)Height + 1) / 2;
            long chromaRow = Format == PixelFormat.I420 ? (chromaWidth - 1) * Math.Max(ChromaPixelStrideBytes, 1) + 1 : 2 * chromaWidth;
            long[] rows = Format < PixelFormat.Nv12 ? new[] { (long)Height } : Format == PixelFormat.I420
                ? new[] { Height, chromaHeight, chromaHeight } : new[] { Height, chromaHeight };
            long first = 0;
            for (int i = 0; i < rows.Length; ++i)
            {
                long stride = i == 0 ? (long)Width * PixelBytes() : chromaRow;
                raw.planes[i] = new IntPtr(place.ToInt64() + first);
                raw.row_stride_bytes[i] = (int)stride;
                first += stride * rows[i];
            }
            if (array.Length < first)
                throw new ArgumentException("pixels: too short for " + Width + " x " + Height + " " + Format + " (got " + array.Length + " bytes, expected " + first + ")");
        }

        /// <summary>mien.h expects the first byte of the top row, and a negative stride.</summary>
        void FlipRows(ref Native.mien_image raw)
        {
            if (Format >= PixelFormat.Nv12) throw new ArgumentException("BottomUp: not supported for YUV");
            raw.planes[0] = new IntPtr(raw.planes[0].ToInt64() + (Height - 1L) * raw.row_stride_bytes[0]);
            raw.row_stride_bytes[0] = -raw.row_stride_bytes[0];
        }

        int PixelBytes()
        {
            switch (Format)
            {
                case PixelFormat.Rgb:
                case PixelFormat.Bgr:
                    return 3;
                case PixelFormat.Rgba:
                case PixelFormat.Bgra:
                    return 4;
                default:
                    return 1;
            }
        }
    }
}
