using System;
using System.Diagnostics;
using System.Runtime.InteropServices;

namespace Mien
{
    /// <summary>Options of a tracker.</summary>
    public sealed class TrackerOptions
    {
        /// <summary>Level of detail, 1 (fastest) to 4 (most accurate); 0: automatic, the highest within BudgetMs per frame.</summary>
        public int Lod;
        /// <summary>Maximum number of faces, 1..8.</summary>
        public int MaxFaces = 1;
        /// <summary>Whether to use audio.</summary>
        public bool Sound = true;
        /// <summary>Smooths controls, landmarks and pose while they hardly move.</summary>
        public bool Smoothing = true;
        /// <summary>Average time budget of a frame with a face for Lod 0, ms, 0.01..1e6.</summary>
        public float BudgetMs = 10;
        /// <summary>Horizontal field of view of the upright image, for images without a focal length, in radians, 0.01..3.1; 0: 60 degrees.</summary>
        public float HorizontalFov;
        /// <summary>Capacity of the audio queue (Tracker.QueueAudio), in samples of one channel, 0..2^22; 0: no queue.</summary>
        public int AudioQueueSamples;
        /// <summary>Factor of the controls predicted from audio, 0..4.</summary>
        public float VoiceStrength = 1;
    }

    /// <summary>Tracks faces in a stream of images and audio. One thread at a time may use it, except for QueueAudio.</summary>
    public sealed class Tracker : IDisposable
    {
        delegate ulong Clock(IntPtr user);
        static readonly Clock clock = ReadClock; // kept alive, because the library keeps a pointer to it
        static readonly IntPtr clockPlace = Marshal.GetFunctionPointerForDelegate(clock);

        readonly TrackerHandle handle;

        public Tracker(Weights weights, TrackerOptions options = null)
        {
            if (weights == null) throw new ArgumentNullException("weights");
            options = options ?? new TrackerOptions();
            Native.mien_tracker_config config;
            Native.mien_tracker_config_default(out config);
            config.weights = weights.Place();
            config.lod = options.Lod;
            config.max_lod = options.Lod == 1 ? 1 : 4;
            config.audio = options.Sound ? 1 : 0;
            config.max_faces = options.MaxFaces;
            config.smoothing = options.Smoothing ? 1 : 0;
            config.budget_ms = options.BudgetMs;
            config.audio_queue_samples = options.AudioQueueSamples;
            config.voice_strength = options.VoiceStrength;
            if (options.HorizontalFov != 0) config.horizontal_fov = options.HorizontalFov;
            if (options.Lod == 0) config.clock_ns = clockPlace; // needs a clock to measure frames
            Native.mien_error_detail detail = Native.NewDetail();
            Native.Check(Native.mien_tracker_create(ref config, out handle, ref detail), detail, weights.Names);
            GC.KeepAlive(weights);
        }

        /// <summary>Tracks one image and returns the result of the face with the lowest id. time: timestamp of the image in seconds, on any clock.</summary>
        public FaceResult Track(Image image, double time)
        {
            if (image == null) throw new ArgumentNullException("image");
            image.Use(raw => Native.Check(Native.mien_tracker_push_video(handle, ref raw, Native.Nanoseconds(time))));
            return Result();
        }

        /// <summary>Outputs a frame without an image, for audio without video. time: seconds, on the clock of the images.</summary>
        public FaceResult Advance(double time)
        {
            Native.Check(Native.mien_tracker_advance(handle, Native.Nanoseconds(time)));
            return Result();
        }

        /// <summary>The result of the latest frame, of the face with the lowest id.</summary>
        public FaceResult Result()
        {
            Native.mien_result raw;
            Native.mien_result_default(out raw);
            Native.Check(Native.mien_tracker_get_result(handle, ref raw));
            return new FaceResult(raw);
        }

        /// <summary>The results of all known faces on the latest frame.</summary>
        public FaceResult[] Faces()
        {
            var faces = new FaceResult[Native.mien_tracker_face_count(handle)];
            for (int i = 0; i < faces.Length; ++i)
            {
                Native.mien_result raw;
                Native.mien_result_default(out raw);
                Native.Check(Native.mien_tracker_get_face(handle, i, ref raw));
                faces[i] = new FaceResult(raw);
            }
            return faces;
        }

        /// <summary>Processes interleaved samples of -1..1; time is the timestamp of the first, in seconds. sampleRate: 8000..192000 Hz;
        /// channels: 1..8.</summary>
        public void PushAudio(float[] samples, double time, int sampleRate = 48000, int channels = 1)
        {
            UseAudio(samples, sampleRate, channels, raw =>
                Native.Check(Native.mien_tracker_push_audio(handle, ref raw, Native.Nanoseconds(time))));
        }

        /// <summary>Queues audio, as for PushAudio, from another thread for the next frame; Status.AudioQueueFull if the queue is full.</summary>
        public void QueueAudio(float[] samples, double time, int sampleRate = 48000, int channels = 1)
        {
            UseAudio(samples, sampleRate, channels, raw =>
                Native.Check(Native.mien_tracker_queue_audio(handle, ref raw, Native.Nanoseconds(time))));
        }

        /// <summary>Delays audio relative to the images by seconds, for audio pushed from now on.</summary>
        public void SetAudioOffset(double seconds)
        {
            Native.Check(Native.mien_tracker_set_audio_offset(handle, Native.Nanoseconds(seconds)));
        }

        /// <summary>Weights of audio and video for a control during speech, each 0..1.</summary>
        public void SetMix(string control, float audio, float video)
        {
            Native.Check(Native.mien_tracker_set_mix(handle, Controls.Number(control), audio, video));
        }

        /// <summary>Sets the level of detail, 0..4, from the next image on.</summary>
        public void SetLod(int lod)
        {
            Native.Check(Native.mien_tracker_set_lod(handle, lod));
        }

        /// <summary>Captures a person's neutral controls over the next 55 frames with a face, and removes them from later frames.</summary>
        public void Calibrate()
        {
            Native.Check(Native.mien_tracker_capture_neutral(handle));
        }

        /// <summary>The captured neutral values as a file of 448 bytes.</summary>
        public byte[] SaveNeutral()
        {
            var file = new byte[Native.NeutralBytes];
            uint captured;
            Native.Check(Native.mien_tracker_save_neutral(handle, file, new UIntPtr((uint)file.Length), out captured));
            return file;
        }

        public void LoadNeutral(byte[] file)
        {
            if (file == null) throw new ArgumentNullException("file");
            Native.Check(Native.mien_tracker_load_neutral(handle, file, new UIntPtr((uint)file.Length)));
        }

        /// <summary>Resets the tracker to its state after creation.</summary>
        public void Reset()
        {
            Native.Check(Native.mien_tracker_reset(handle));
        }

        public void Dispose()
        {
            handle.Dispose();
        }

        static void UseAudio(float[] samples, int sampleRate, int channels, Action<Native.mien_audio> use)
        {
            if (samples == null) throw new ArgumentNullException("samples");
            Native.mien_audio raw;
            Native.mien_audio_default(out raw);
            raw.sample_rate = sampleRate;
            raw.channels = channels;
            raw.frames = new UIntPtr((uint)(samples.Length / Math.Max(channels, 1)));
            var pin = GCHandle.Alloc(samples, GCHandleType.Pinned);
            try
            {
                raw.samples[0] = pin.AddrOfPinnedObject();
                use(raw);
            }
            finally
            {
                pin.Free();
            }
        }

#if UNITY_5_3_OR_NEWER
        [AOT.MonoPInvokeCallback(typeof(Clock))]
#endif
        static ulong ReadClock(IntPtr user)
        {
            return (ulong)(Stopwatch.GetTimestamp() * (1e9 / Stopwatch.Frequency));
        }
    }
}
