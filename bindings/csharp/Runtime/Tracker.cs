using System;
using System.Diagnostics;
using System.Runtime.InteropServices;

namespace Mien
{
    /// <summary>What a tracker is asked for.</summary>
    public sealed class TrackerOptions
    {
        /// <summary>Level of detail, 1 (cheapest) to 4; 0: as high as BudgetMs a frame allows.</summary>
        public int Lod;
        /// <summary>Faces followed at once, 1..8.</summary>
        public int MaxFaces = 1;
        /// <summary>Whether it can hear.</summary>
        public bool Sound = true;
        /// <summary>Of what hardly moves.</summary>
        public bool Smoothing = true;
        public float BudgetMs = 10;
        /// <summary>Of the upright picture, radians, where pictures do not say a focal length; 0: 60 degrees.</summary>
        public float HorizontalFov;
        /// <summary>Room for sound that another thread brings (Tracker.QueueAudio).</summary>
        public int AudioQueueSamples;
        /// <summary>What the sound says of the mouth, times this, 0..4.</summary>
        public float VoiceStrength = 1;
    }

    /// <summary>Follows faces through a stream of pictures, and hears a voice. Used by one thread at a time, but for QueueAudio.</summary>
    public sealed class Tracker : IDisposable
    {
        delegate ulong Clock(IntPtr user);
        static readonly Clock clock = ReadClock; // kept, since the library keeps what is made of it
        static readonly IntPtr clockPlace = Marshal.GetFunctionPointerForDelegate(clock);

        readonly TrackerHandle handle;

        public Tracker(Weights weights, TrackerOptions options = null)
        {
            if (weights == null) throw new ArgumentNullException("weights");
            options = options ?? new TrackerOptions();
            var kept = new[] { weights.BaseNet, weights.Proposal, weights.HiFiNet, options.Sound ? weights.AudioNet : null };
            Native.mien_tracker_config config;
            Native.mien_tracker_config_default(out config);
            Put(kept[0], out config.basenet, out config.basenet_bytes);
            Put(kept[1], out config.proposal, out config.proposal_bytes);
            Put(kept[2], out config.hifinet, out config.hifinet_bytes);
            Put(kept[3], out config.audionet, out config.audionet_bytes);
            config.lod = options.Lod;
            config.max_faces = options.MaxFaces;
            config.smoothing = options.Smoothing ? 1 : 0;
            config.budget_ms = options.BudgetMs;
            config.audio_queue_samples = options.AudioQueueSamples;
            config.voice_strength = options.VoiceStrength;
            if (options.HorizontalFov != 0) config.horizontal_fov = options.HorizontalFov;
            if (options.Lod == 0) config.clock_ns = clockPlace; // it has to know what a frame takes
            Native.Check(Native.mien_tracker_create(ref config, out handle));
            handle.Keeps = kept;
        }

        /// <summary>Tracks one picture and tells of the face known longest. time: of the picture, seconds, on any clock.</summary>
        public FaceResult Track(Image image, double time)
        {
            if (image == null) throw new ArgumentNullException("image");
            image.Described(raw => Native.Check(Native.mien_tracker_push_video(handle, ref raw, Native.Nanoseconds(time))));
            return Result();
        }

        /// <summary>A frame of output without a picture: for sound alone.</summary>
        public FaceResult Advance(double time)
        {
            Native.Check(Native.mien_tracker_advance(handle, Native.Nanoseconds(time)));
            return Result();
        }

        /// <summary>Of the last picture, of the face known longest.</summary>
        public FaceResult Result()
        {
            Native.mien_result raw;
            Native.mien_result_default(out raw);
            Native.Check(Native.mien_tracker_get_result(handle, ref raw));
            return new FaceResult(raw);
        }

        /// <summary>Of the last picture, every face known.</summary>
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

        /// <summary>Hears samples of -1..1, channels in turns; time is that of the first.</summary>
        public void PushAudio(float[] samples, double time, int sampleRate = 48000, int channels = 1)
        {
            Described(samples, sampleRate, channels, raw =>
                Native.Check(Native.mien_tracker_push_audio(handle, ref raw, Native.Nanoseconds(time))));
        }

        /// <summary>The same from another thread, for the next frame; Status.AudioQueueFull when there is no room.</summary>
        public void QueueAudio(float[] samples, double time, int sampleRate = 48000, int channels = 1)
        {
            Described(samples, sampleRate, channels, raw =>
                Native.Check(Native.mien_tracker_queue_audio(handle, ref raw, Native.Nanoseconds(time))));
        }

        /// <summary>Sound pushed from now on belongs to pictures that much later.</summary>
        public void SetAudioOffset(double seconds)
        {
            Native.Check(Native.mien_tracker_set_audio_offset(handle, Native.Nanoseconds(seconds)));
        }

        /// <summary>How much sound and picture count for a control while somebody speaks, each 0..1.</summary>
        public void SetMix(string control, float audio, float video)
        {
            Native.Check(Native.mien_tracker_set_mix(handle, Controls.Number(control), audio, video));
        }

        public void SetLod(int lod)
        {
            Native.Check(Native.mien_tracker_set_lod(handle, lod));
        }

        /// <summary>Captures, over the next 55 frames with a face, what it shows when it is neutral, to be taken out from then on.</summary>
        public void Calibrate()
        {
            Native.Check(Native.mien_tracker_capture_neutral(handle));
        }

        /// <summary>What was captured, to be kept.</summary>
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

        /// <summary>Forgets everything seen and heard.</summary>
        public void Reset()
        {
            Native.Check(Native.mien_tracker_reset(handle));
        }

        public void Dispose()
        {
            handle.Dispose();
        }

        static void Put(Model model, out IntPtr place, out UIntPtr bytes)
        {
            place = model == null ? IntPtr.Zero : model.Place;
            bytes = model == null ? UIntPtr.Zero : model.Bytes;
        }

        static void Described(float[] samples, int sampleRate, int channels, Action<Native.mien_audio> hear)
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
                hear(raw);
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
