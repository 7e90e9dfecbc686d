using System;
using System.Collections.Generic;
using System.Linq;

namespace Mien
{
    public enum FaceStatus
    {
        /// <summary>No face since the start or reset.</summary>
        Searching = 0,
        Tracking = 1,
        /// <summary>The face is lost: it keeps its last position, and its controls fade.</summary>
        Lost = 2,
    }

    /// <summary>52 animation weights, 0..1, by ARKit name.</summary>
    public sealed class Controls
    {
        readonly float[] array;
        readonly ulong supported;

        internal Controls(float[] array, ulong supported)
        {
            this.array = array;
            this.supported = supported;
        }

        public static IList<string> Names { get { return Vocabulary.Arkit.Names(); } }

        /// <summary>In the order of Names.</summary>
        public float this[int control] { get { return array[control]; } }

        public float this[Control control] { get { return array[(int)control]; } }

        public float this[string name] { get { return array[Number(name)]; } }

        /// <summary>Names of the controls that this level of detail predicts; the others are 0.</summary>
        public IEnumerable<string> Supported { get { return Names.Where((name, i) => (supported >> i & 1) != 0); } }

        /// <summary>A copy, in the order of Names.</summary>
        public float[] ToArray()
        {
            return (float[])array.Clone();
        }

        /// <summary>The controls in another vocabulary, in the order of its names.</summary>
        public float[] To(Vocabulary vocabulary)
        {
            var values = new float[vocabulary.Names().Count];
            Native.Check(Native.mien_vocabulary_values((int)vocabulary, array, values, values.Length));
            return values;
        }

        internal static int Number(string name)
        {
            int number = Names.IndexOf(name);
            if (number < 0) throw new KeyNotFoundException("control: unknown (got '" + name + "')");
            return number;
        }
    }

    /// <summary>The head in camera space: x to the right, y up, z towards the viewer.</summary>
    public sealed class Pose
    {
        /// <summary>Unit quaternion x, y, z, w.</summary>
        public float[] Rotation { get; internal set; }
        /// <summary>Metres.</summary>
        public float[] Translation { get; internal set; }
        /// <summary>Radians, positive: looks down.</summary>
        public float Pitch { get; internal set; }
        /// <summary>Radians, positive: turns to the subject's left.</summary>
        public float Yaw { get; internal set; }
        /// <summary>Radians, about z by the right-hand rule.</summary>
        public float Roll { get; internal set; }
    }

    /// <summary>One face on one frame. Owns its data.</summary>
    public sealed class FaceResult
    {
        readonly Native.mien_result raw;

        internal FaceResult(Native.mien_result raw)
        {
            this.raw = raw;
        }

        public FaceStatus Status { get { return (FaceStatus)raw.status; } }
        public bool HasFace { get { return Status == FaceStatus.Tracking; } }
        /// <summary>Timestamp of the frame, seconds.</summary>
        public double Time { get { return raw.pts_ns / 1e9; } }
        /// <summary>Number of the face, from 1 in the order of detection; 0 before the first.</summary>
        public int FaceId { get { return (int)raw.face_id; } }
        /// <summary>The level of detail of this frame, 1..4.</summary>
        public int Lod { get { return raw.lod; } }
        public float FaceProbability { get { return raw.face_probability; } }
        /// <summary>0..1: voice activity; 0 without audio.</summary>
        public float VoiceActivity { get { return raw.voice_activity; } }
        /// <summary>Whether this frame contributes to Tracker.Calibrate.</summary>
        public bool IsCapturingNeutral { get { return (raw.flags & Native.CapturingNeutral) != 0; } }
        /// <summary>x, y, width, height in pixels of the upright image.</summary>
        public float[] Box { get { return (float[])raw.box.Clone(); } }
        public Controls Controls { get { return new Controls(raw.controls, raw.supported_controls); } }
        /// <summary>175 points x, y in pixels of the upright image.</summary>
        public float[] Landmarks { get { return (float[])raw.landmarks.Clone(); } }

        /// <summary>The landmarks of a group, x, y in pixels of the upright image.</summary>
        public float[] LandmarksOf(LandmarkGroup group)
        {
            int first, count = Native.mien_landmark_group_range((int)group, out first);
            var points = new float[2 * count];
            Array.Copy(raw.landmarks, 2 * first, points, 0, points.Length);
            return points;
        }

        public Pose Pose
        {
            get
            {
                return new Pose
                {
                    Rotation = (float[])raw.rotation.Clone(),
                    Translation = (float[])raw.translation.Clone(),
                    Pitch = raw.pitch,
                    Yaw = raw.yaw,
                    Roll = raw.roll,
                };
            }
        }
    }
}
