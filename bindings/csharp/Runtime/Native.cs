using System;
using System.Runtime.InteropServices;

namespace Mien
{
    /// <summary>P/Invoke declarations of mien.h, which documents them. Tests/HeaderTest.cs compares both.</summary>
    internal static class Native
    {
#if UNITY_IOS && !UNITY_EDITOR
        const string Library = "__Internal";
#elif UNITY_ANDROID && !UNITY_EDITOR
        const string Library = "mien_jni";  // the library in the AAR, which exports the C API as well
#else
        const string Library = "mien";
#endif
        internal const int ControlCount = 52, LandmarkCount = 175, MaxStages = 16, MaxWeightFiles = 8, NeutralBytes = 448;
        internal const uint CapturingNeutral = 0x10;

        [StructLayout(LayoutKind.Sequential)]
        internal struct mien_image
        {
            public uint struct_size;
            public int format, width, height;
            [MarshalAs(UnmanagedType.ByValArray, SizeConst = 3)] public IntPtr[] planes;
            [MarshalAs(UnmanagedType.ByValArray, SizeConst = 3)] public int[] row_stride_bytes;
            public int chroma_pixel_stride_bytes, rotation, mirrored, full_range;
            public float focal_length_px, principal_x, principal_y;
            public int yuv_matrix;
            [MarshalAs(UnmanagedType.ByValArray, SizeConst = 4)] public int[] region;
            public float pixel_aspect;
            [MarshalAs(UnmanagedType.ByValArray, SizeConst = 2)] public uint[] reserved;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct mien_audio
        {
            public uint struct_size;
            public int format, sample_rate, channels, planar;
            public UIntPtr frames;
            [MarshalAs(UnmanagedType.ByValArray, SizeConst = 8)] public IntPtr[] samples;
            [MarshalAs(UnmanagedType.ByValArray, SizeConst = 8)] public uint[] reserved;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct mien_allocator
        {
            public IntPtr allocate, release, user;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct mien_error_detail
        {
            public uint struct_size;
            public int status;
            public uint known;
            public int file, network, layer;
            public IntPtr field;
            public ulong offset;
            public double got, expected_min, expected_max;
            [MarshalAs(UnmanagedType.ByValArray, SizeConst = 64)] public byte[] name;
            [MarshalAs(UnmanagedType.ByValArray, SizeConst = 8)] public uint[] reserved;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct mien_weights_config
        {
            public uint struct_size;
            public int copy;
            [MarshalAs(UnmanagedType.ByValArray, SizeConst = MaxWeightFiles)] public IntPtr[] files;
            [MarshalAs(UnmanagedType.ByValArray, SizeConst = MaxWeightFiles)] public UIntPtr[] file_bytes;
            public mien_allocator allocator;
            [MarshalAs(UnmanagedType.ByValArray, SizeConst = 8)] public uint[] reserved;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct mien_tracker_config
        {
            public uint struct_size, cpu_mask;
            public IntPtr weights;
            public mien_allocator allocator;
            public IntPtr clock_ns, clock_user;
            public int lod, max_lod;
            public float horizontal_fov, accept_probability, lose_probability;
            public int lose_after_frames, proposal_size;
            public float proposal_threshold, refine_threshold;
            public int search_interval;
            public float budget_ms;
            public int smoothing, max_faces, audio;
            public float voice_attack_ms, voice_release_ms;
            public int audio_queue_samples;
            public float voice_strength;
            [MarshalAs(UnmanagedType.ByValArray, SizeConst = 8)] public uint[] reserved;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct mien_result
        {
            public uint struct_size;
            public int status;
            public long pts_ns;
            public ulong supported_controls;
            public float face_probability, voice_activity;
            public int lod;
            public uint flags;
            [MarshalAs(UnmanagedType.ByValArray, SizeConst = 4)] public float[] box;
            [MarshalAs(UnmanagedType.ByValArray, SizeConst = 4)] public float[] rotation;
            public float pitch, yaw, roll;
            [MarshalAs(UnmanagedType.ByValArray, SizeConst = 3)] public float[] translation;
            [MarshalAs(UnmanagedType.ByValArray, SizeConst = ControlCount)] public float[] controls;
            [MarshalAs(UnmanagedType.ByValArray, SizeConst = 2 * LandmarkCount)] public float[] landmarks;
            public ulong frames, face_frames, proposal_runs, encoder_runs;
            [MarshalAs(UnmanagedType.ByValArray, SizeConst = MaxStages)] public ulong[] stage_ns;
            public uint face_id;
            [MarshalAs(UnmanagedType.ByValArray, SizeConst = 15)] public uint[] reserved;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct mien_shape
        {
            public int height, width, channels;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct mien_network_config
        {
            public uint struct_size, cpu_mask;
            public IntPtr weights, name;
            public int height, width;
            public mien_allocator allocator;
            [MarshalAs(UnmanagedType.ByValArray, SizeConst = 8)] public uint[] reserved;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct mien_network_info
        {
            public uint struct_size;
            public int file;
            [MarshalAs(UnmanagedType.ByValArray, SizeConst = 64)] public byte[] name;
            public mien_shape input;
            public int any_size, layers, outputs;
            public ulong parameters, macs, weight_bytes, session_bytes, arena_bytes;
            [MarshalAs(UnmanagedType.ByValArray, SizeConst = 8)] public uint[] reserved;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct mien_layer_info
        {
            public uint struct_size;
            public int input, second_input;
            public mien_shape output;
            public IntPtr op, activation;
            [MarshalAs(UnmanagedType.ByValArray, SizeConst = 2)] public int[] kernel;
            [MarshalAs(UnmanagedType.ByValArray, SizeConst = 2)] public int[] stride;
            [MarshalAs(UnmanagedType.ByValArray, SizeConst = 4)] public int[] padding;
            public int first_channel;
            public float input_bound;
            public ulong parameters, macs;
            [MarshalAs(UnmanagedType.ByValArray, SizeConst = 8)] public uint[] reserved;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct mien_metadata_info
        {
            public uint struct_size;
            public int file;
            [MarshalAs(UnmanagedType.ByValArray, SizeConst = 64)] public byte[] key;
            public IntPtr value;
            public UIntPtr value_bytes;
            [MarshalAs(UnmanagedType.ByValArray, SizeConst = 8)] public uint[] reserved;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct mien_constant_info
        {
            public uint struct_size;
            public int file;
            [MarshalAs(UnmanagedType.ByValArray, SizeConst = 64)] public byte[] name;
            public IntPtr type;
            public int rank;
            [MarshalAs(UnmanagedType.ByValArray, SizeConst = 4)] public uint[] dims;
            [MarshalAs(UnmanagedType.ByValArray, SizeConst = 8)] public uint[] reserved;
        }

        [DllImport(Library)] internal static extern void mien_error_detail_default(out mien_error_detail detail);
        [DllImport(Library)] internal static extern UIntPtr mien_error_message([In] ref mien_error_detail detail, [Out] byte[] text, UIntPtr text_bytes);
        [DllImport(Library)] internal static extern void mien_weights_config_default(out mien_weights_config config);
        [DllImport(Library)] internal static extern int mien_weights_create([In] ref mien_weights_config config, out WeightsHandle weights, ref mien_error_detail error);
        [DllImport(Library)] internal static extern void mien_weights_destroy(IntPtr weights);
        [DllImport(Library)] internal static extern IntPtr mien_status_string(int status);
        [DllImport(Library)] internal static extern IntPtr mien_version();
        [DllImport(Library)] internal static extern int mien_landmark_group_range(int group, out int first);
        [DllImport(Library)] internal static extern int mien_vocabulary_size(int vocabulary);
        [DllImport(Library)] internal static extern IntPtr mien_vocabulary_name(int vocabulary, int index);
        [DllImport(Library)] internal static extern int mien_vocabulary_values(int vocabulary, [In] float[] controls, [Out] float[] values, int count);
        [DllImport(Library)] internal static extern int mien_vocabulary_match([In] string[] names, int count, [Out] int[] vocabularies, [Out] int[] indices);
        [DllImport(Library)] internal static extern void mien_image_default(out mien_image image);
        [DllImport(Library)] internal static extern void mien_audio_default(out mien_audio audio);
        [DllImport(Library)] internal static extern void mien_tracker_config_default(out mien_tracker_config config);
        [DllImport(Library)] internal static extern int mien_tracker_create([In] ref mien_tracker_config config, out TrackerHandle tracker, ref mien_error_detail error);
        [DllImport(Library)] internal static extern void mien_tracker_destroy(IntPtr tracker);
        [DllImport(Library)] internal static extern int mien_tracker_reset(TrackerHandle tracker);
        [DllImport(Library)] internal static extern int mien_tracker_set_lod(TrackerHandle tracker, int lod);
        [DllImport(Library)] internal static extern int mien_tracker_push_video(TrackerHandle tracker, [In] ref mien_image image, long pts_ns);
        [DllImport(Library)] internal static extern int mien_tracker_advance(TrackerHandle tracker, long pts_ns);
        [DllImport(Library)] internal static extern int mien_tracker_push_audio(TrackerHandle tracker, [In] ref mien_audio audio, long pts_ns);
        [DllImport(Library)] internal static extern int mien_tracker_queue_audio(TrackerHandle tracker, [In] ref mien_audio audio, long pts_ns);
        [DllImport(Library)] internal static extern int mien_tracker_set_audio_offset(TrackerHandle tracker, long offset_ns);
        [DllImport(Library)] internal static extern int mien_tracker_set_mix(TrackerHandle tracker, int control, float audio_weight, float video_weight);
        [DllImport(Library)] internal static extern int mien_tracker_get_result(TrackerHandle tracker, ref mien_result result);
        [DllImport(Library)] internal static extern int mien_tracker_face_count(TrackerHandle tracker);
        [DllImport(Library)] internal static extern int mien_tracker_get_face(TrackerHandle tracker, int index, ref mien_result result);
        [DllImport(Library)] internal static extern void mien_result_default(out mien_result result);
        [DllImport(Library)] internal static extern int mien_tracker_capture_neutral(TrackerHandle tracker);
        [DllImport(Library)] internal static extern int mien_tracker_save_neutral(TrackerHandle tracker, [Out] byte[] file, UIntPtr file_bytes, out uint captured);
        [DllImport(Library)] internal static extern int mien_tracker_load_neutral(TrackerHandle tracker, [In] byte[] file, UIntPtr file_bytes);
        [DllImport(Library)] internal static extern void mien_network_config_default(out mien_network_config config);
        [DllImport(Library)] internal static extern int mien_network_create([In] ref mien_network_config config, out NetworkHandle network, ref mien_error_detail error);
        [DllImport(Library)] internal static extern void mien_network_destroy(IntPtr network);
        [DllImport(Library)] internal static extern IntPtr mien_network_input(NetworkHandle network, out mien_shape shape);
        [DllImport(Library)] internal static extern int mien_network_run(NetworkHandle network);
        [DllImport(Library)] internal static extern int mien_network_output_count(NetworkHandle network);
        [DllImport(Library)] internal static extern IntPtr mien_network_output(NetworkHandle network, int index, out mien_shape shape);
        [DllImport(Library)] internal static extern void mien_network_reset(NetworkHandle network);

        internal static string Text(IntPtr text)
        {
            return text == IntPtr.Zero ? null : Marshal.PtrToStringAnsi(text);
        }

        internal static long Nanoseconds(double seconds)
        {
            const double end = 9223372036854775808.0; // 2^63
            double ns = Math.Round(seconds * 1e9);
            if (!(ns >= -end && ns < end)) throw new ArgumentOutOfRangeException("seconds", seconds, "a time that fits into 64 bits of nanoseconds is taken");
            return (long)ns;
        }

        internal static void Check(int status)
        {
            if (status != 0) throw new MienException((Status)status);
        }

        internal static mien_error_detail NewDetail()
        {
            mien_error_detail detail;
            mien_error_detail_default(out detail);
            return detail;
        }

        /// <summary>names: of the weight files.</summary>
        internal static void Check(int status, mien_error_detail detail, string[] names)
        {
            if (status == 0) return;
            var text = new byte[256];
            var length = Math.Min((int)mien_error_message(ref detail, text, new UIntPtr((uint)text.Length)).ToUInt32(), text.Length - 1);
            string message = System.Text.Encoding.ASCII.GetString(text, 0, length);
            bool named = detail.file >= 0 && detail.file < names.Length;
            throw new MienException((Status)status, named ? names[detail.file] + ": " + message : message);
        }
    }

    internal sealed class WeightsHandle : SafeHandle
    {
        WeightsHandle() : base(IntPtr.Zero, true) { }
        public override bool IsInvalid { get { return handle == IntPtr.Zero; } }
        protected override bool ReleaseHandle()
        {
            Native.mien_weights_destroy(handle);
            return true;
        }
    }

    /// <summary>The library's tracker, destroyed when it is no longer used, never during a call of another thread.</summary>
    internal sealed class TrackerHandle : SafeHandle
    {
        TrackerHandle() : base(IntPtr.Zero, true) { }
        public override bool IsInvalid { get { return handle == IntPtr.Zero; } }
        protected override bool ReleaseHandle()
        {
            Native.mien_tracker_destroy(handle);
            return true;
        }
    }

    internal sealed class NetworkHandle : SafeHandle
    {
        NetworkHandle() : base(IntPtr.Zero, true) { }
        public override bool IsInvalid { get { return handle == IntPtr.Zero; } }
        protected override bool ReleaseHandle()
        {
            Native.mien_network_destroy(handle);
            return true;
        }
    }
}
