using System;
using System.IO;
using System.Linq;
using System.Runtime.InteropServices;
using System.Threading;
using Mien;

/// <summary>The tracker on the clip that ships. MIEN_CLIP: 60 frames of it, 640x480, RGB; MIEN_MODELS: the weights.</summary>
class ClipTest
{
    const int Width = 640, Height = 480, FrameBytes = Width * Height * 3;
    const double Rate = 30;

    static readonly string models = Environment.GetEnvironmentVariable("MIEN_MODELS");
    readonly Weights weights = Weights.Open(models);
    readonly byte[][] frames;
    readonly FaceResult reference;

    public ClipTest()
    {
        byte[] clip = File.ReadAllBytes(Environment.GetEnvironmentVariable("MIEN_CLIP"));
        frames = Enumerable.Range(0, clip.Length / FrameBytes).Select(i => clip.Skip(i * FrameBytes).Take(FrameBytes).ToArray()).ToArray();
        reference = Tracked(Rgb).Last();
    }

    static Image Rgb(byte[] frame)
    {
        return new Image(PixelFormat.Rgb, Width, Height, frame);
    }

    FaceResult[] Tracked(Func<byte[], Image> image, int lod = 1)
    {
        using (var tracker = new Tracker(weights, new TrackerOptions { Lod = lod, Sound = false }))
            return frames.Take(10).Select((frame, i) => tracker.Track(image(frame), i / Rate)).ToArray();
    }

    public void TracksAFace()
    {
        Assert.That(reference.HasFace && reference.FaceProbability > 0.9f, "a face");
        Assert.Equal(FaceStatus.Tracking, reference.Status);
        Assert.Equal(1, reference.FaceId);
        Assert.Equal(1, reference.Lod);
        Assert.That(Math.Abs(reference.Time - 9 / Rate) < 1e-6, "its time");
        Assert.That(reference.Box[0] > 0 && reference.Box[0] + reference.Box[2] < Width && reference.Box[2] > 50, "its box");
        Assert.Equal(350, reference.Landmarks.Length);
        Assert.That(reference.Landmarks.All(x => x > 0), "landmarks");
        Assert.That(reference.Pose.Translation[2] < 0 && Math.Abs(reference.Pose.Yaw) < 1 && reference.Pose.Rotation.Length == 4, "a pose");
        Assert.Equal(4, Tracked(Rgb, 4).Last().Lod);
    }

    public void ConvertsControlsToEveryVocabulary()
    {
        Controls controls = reference.Controls;
        Assert.Equal("jawOpen", Controls.Names[(int)Control.JawOpen]);
        Assert.Equal(controls[Control.JawOpen], controls["jawOpen"]);
        Assert.That(controls.Supported.Contains("jawOpen") && !controls.Supported.Contains("eyeLookUpLeft"), "supported controls");
        Assert.Near(controls.ToArray(), controls.To(Vocabulary.Arkit), 0);
        Assert.Equal(controls["jawOpen"], controls.To(Vocabulary.Roblox)[Vocabulary.Roblox.Names().IndexOf("JawDrop")]);
        Assert.Equal("52 52 50 11 11 15",
            string.Join(" ", Enum.GetValues(typeof(Vocabulary)).Cast<Vocabulary>().Select(vocabulary => vocabulary.Names().Count)));
        Assert.Throws<System.Collections.Generic.KeyNotFoundException>(() => controls["nothing"].ToString());
    }

    void Same(Func<byte[], Image> image, float pixels, float share)
    {
        FaceResult last = Tracked(image).Last();
        Assert.Near(reference.Landmarks, last.Landmarks, pixels);
        Assert.Near(reference.Controls.ToArray(), last.Controls.ToArray(), share);
    }

    public void EveryLayoutGivesTheSameResult()
    {
        Same(frame => new Image(PixelFormat.Bgra, Width, Height,
            Enumerable.Range(0, Width * Height * 4).Select(i => i % 4 == 3 ? (byte)7 : frame[i / 4 * 3 + 2 - i % 4]).ToArray()), 1e-3f, 1e-4f);
        Same(frame => new Image(PixelFormat.Rgb, Width, Height,
            Enumerable.Range(0, FrameBytes).Select(i => frame[(Height - 1 - i / (3 * Width)) * 3 * Width + i % (3 * Width)]).ToArray())
            { BottomUp = true }, 0, 0);
        Same(frame => new Image(PixelFormat.Rgb, Width, Height,
            Enumerable.Range(0, FrameBytes).Select(i => frame[FrameBytes - 3 - i / 3 * 3 + i % 3]).ToArray()) { Rotation = 180 }, 0.5f, 0.01f);
        Same(frame => new Image(PixelFormat.Rgb, Width, Height, frame)
            { Region = new[] { (int)reference.Box[0] - 40, (int)reference.Box[1] - 40, (int)reference.Box[2] + 80, (int)reference.Box[3] + 80 } }, 4, 0.2f);
    }

    public void ReadsNativeMemoryWithoutACopy()
    {
        NativeMemoryIsRead(false);
    }

    public void NativeMemoryMayBeBottomUp()
    {
        NativeMemoryIsRead(true);
    }

    void NativeMemoryIsRead(bool bottomUp)
    {
        const int stride = Width * 3 + 32;
        IntPtr memory = Marshal.AllocHGlobal(stride * Height);
        Same(frame =>
        {
            for (int row = 0; row < Height; ++row)
                Marshal.Copy(frame, (bottomUp ? Height - 1 - row : row) * Width * 3, new IntPtr(memory.ToInt64() + row * stride), Width * 3);
            return new Image(PixelFormat.Rgb, Width, Height, new[] { memory }, new[] { stride }) { BottomUp = bottomUp };
        }, 0, 0);
        Marshal.FreeHGlobal(memory);
    }

    public void ReportsErrors()
    {
        using (var tracker = new Tracker(weights, new TrackerOptions { Lod = 1, Sound = false }))
        {
            Assert.Throws<ArgumentException>(() => tracker.Track(new Image(PixelFormat.Rgb, Width, Height, new byte[FrameBytes - 1]), 0));
            Assert.Throws<ArgumentException>(() => tracker.Track(new Image(PixelFormat.I420, 3, 3, new byte[16]), 0));
            Func<int, Image> apart = bytes => new Image(PixelFormat.I420, 8, 2, new byte[bytes]) { ChromaPixelStrideBytes = 4 };
            Assert.Throws<ArgumentException>(() => tracker.Track(apart(16 + 2 * 13 - 1), 0));
            tracker.Track(apart(16 + 2 * 13), 0);
            var yuv = new Image(PixelFormat.Nv12, 8, 2, new[] { IntPtr.Zero, IntPtr.Zero }, new[] { 8, 8 }) { BottomUp = true };
            Assert.Throws<ArgumentException>(() => tracker.Track(yuv, 0));
            foreach (double time in new[] { double.NaN, double.PositiveInfinity, 1e10, -1e10 })
                Assert.Throws<ArgumentOutOfRangeException>(() => tracker.Advance(time));
            Assert.Throws<ArgumentNullException>(() => new Image(PixelFormat.Rgb, 8, 2, null, new[] { 24 }));
            Assert.Throws<ArgumentException>(() => tracker.Track(new Image(PixelFormat.Rgb, Width, Height, frames[0]) { Region = new[] { 0 } }, 0));
            Assert.Refuses(Status.ImageSize, () => tracker.Track(new Image(PixelFormat.Gray8, 0, 0, new byte[0]), 0));
            Assert.Refuses(Status.ImageRotation, () => tracker.Track(new Image(PixelFormat.Rgb, Width, Height, frames[0]) { Rotation = 45 }, 0));
            Assert.Refuses(Status.NoAudionet, () => tracker.PushAudio(new float[10], 0));
            Assert.Refuses(Status.NoAudionet, () => tracker.SetMix("jawOpen", 1, 1));
            Assert.Refuses(Status.NeutralFormat, () => tracker.LoadNeutral(new byte[448]));
            Assert.Equal(FaceStatus.Searching, tracker.Result().Status);
        }
        Assert.Refuses(Status.UnsupportedLod, () => new Tracker(weights, new TrackerOptions { Lod = 5 }));
        Assert.Refuses(Status.WeightsNotMien, () => new Weights(new byte[640]));
        Assert.Refuses(Status.WeightsIncomplete, () => new Tracker(new Weights(File.ReadAllBytes(Path.Combine(models, "proposal.mien")))));
        try
        {
            new Tracker(weights, new TrackerOptions { MaxFaces = 9 });
            Assert.That(false, "refused");
        }
        catch (MienException error)
        {
            Assert.Equal("max_faces: a value is out of range (got 9, expected 1..8)", error.Message);
        }
        Assert.Throws<DirectoryNotFoundException>(() => Weights.Open("/nowhere"));
        var closed = new Tracker(weights);
        closed.Dispose();
        closed.Dispose();
        Assert.Throws<ObjectDisposedException>(() => closed.Track(Rgb(frames[0]), 0));
    }

    public void AcceptsAudioFromAnotherThread()
    {
        float[] sound = Enumerable.Range(0, 32000).Select(i => i / 16000.0).Select(t => (float)(
            0.25 * Enumerable.Range(1, 24).Sum(k => Math.Sin(2 * Math.PI * 120 * k * t) / k) * Math.Max(Math.Sin(2 * Math.PI * 4 * t), 0))).ToArray();
        var options = new TrackerOptions { Lod = 1, AudioQueueSamples = 48000 };
        using (Tracker pushed = new Tracker(weights, options), queued = new Tracker(weights, options))
        {
            pushed.PushAudio(sound, 0, 16000);
            var thread = new Thread(() =>
            {
                for (int i = 0; i < 20; ++i) queued.QueueAudio(sound.Skip(1600 * i).Take(1600).ToArray(), i / 10.0, 16000);
            });
            thread.Start();
            thread.Join();
            float most = 0;
            for (int i = 0; i < 60; ++i)
            {
                FaceResult a = pushed.Advance(i / Rate), b = queued.Advance(i / Rate);
                Assert.Near(a.Controls.ToArray(), b.Controls.ToArray(), 0);
                most = Math.Max(most, a.VoiceActivity);
            }
            Assert.That(most > 0.2f, "somebody speaks");
            Assert.Refuses(Status.OutOfRange, () => pushed.SetMix("jawOpen", 2, 1));
            Assert.Refuses(Status.AudioQueueFull, () => queued.QueueAudio(new float[100000], 9));
        }
    }

    public void CalibrationAndReset()
    {
        using (var tracker = new Tracker(weights, new TrackerOptions { Lod = 1, Sound = false }))
        {
            tracker.Calibrate();
            FaceResult last = null;
            int capturing = 0;
            foreach (byte[] frame in frames.Concat(frames.Take(10)))
            {
                last = tracker.Track(Rgb(frame), (last == null ? 0 : last.Time) + 1 / Rate);
                capturing += last.IsCapturingNeutral ? 1 : 0;
            }
            Assert.That(capturing >= 45 && !last.IsCapturingNeutral, "captured " + capturing);
            byte[] neutral = tracker.SaveNeutral();
            tracker.Reset();
            tracker.LoadNeutral(neutral);
            Assert.That(neutral.SequenceEqual(tracker.SaveNeutral()), "kept");
        }
        using (var several = new Tracker(weights, new TrackerOptions { Lod = 1, MaxFaces = 2, Sound = false }))
        {
            several.Track(Rgb(frames[0]), 0);
            Assert.Equal(1, several.Faces().Length);
            Assert.Refuses(Status.SeveralFaces, several.Calibrate);
        }
    }

    public void RunsCustomNetworks()
    {
        Weights model = Weights.Open(Path.Combine(models, "proposal.mien"));
        using (var network = new Network(model, "rnet"))
        {
            Assert.Equal("3 24 24", network.InputShape.Channels + " " + network.InputShape.Height + " " + network.InputShape.Width);
            float[] input = Enumerable.Range(0, 3 * 24 * 24).Select(i => i % 17 / 17f).ToArray();
            Map[] outputs = network.Run(input);
            Assert.That(outputs.Length > 0 && outputs.All(map => map.Values.Length == map.Channels * map.Height * map.Width), "outputs");
            Assert.Near(outputs[0].Values, network.Run(input)[0].Values, 0);
            Assert.That(!outputs[0].Values.SequenceEqual(network.Run(input.Reverse().ToArray())[0].Values), "they depend on the input");
            Assert.Throws<ArgumentException>(() => network.Run(new float[1]));
            network.Reset();
        }
        Assert.Refuses(Status.WeightsIncomplete, () => new Network(model, "nothing"));
    }

    public void NobodyDisposes()
    {
        for (int i = 0; i < 20; ++i) new Tracker(Weights.Open(models), new TrackerOptions { Lod = 1 }).Track(Rgb(frames[0]), 0);
        GC.Collect();
        GC.WaitForPendingFinalizers();
    }
}
