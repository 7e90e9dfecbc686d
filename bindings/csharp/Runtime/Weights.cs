using System;
using System.IO;
using System.Runtime.InteropServices;

namespace Mien
{
    /// <summary>A weight file in aligned memory. Trackers and networks may share one and keep it alive.</summary>
    public sealed class Model
    {
        // Native memory, because the collector moves managed arrays; released by the finalizer.
        readonly IntPtr memory;
        internal readonly IntPtr Place;
        internal readonly UIntPtr Bytes;

        public Model(byte[] data)
        {
            if (data == null) throw new ArgumentNullException("data");
            memory = Marshal.AllocHGlobal(data.Length + Native.Alignment);
            Place = new IntPtr((memory.ToInt64() + Native.Alignment - 1) / Native.Alignment * Native.Alignment);
            Bytes = new UIntPtr((uint)data.Length);
            Marshal.Copy(data, 0, Place, data.Length);
        }

        public static Model Open(string path)
        {
            return new Model(File.ReadAllBytes(path));
        }

        ~Model()
        {
            Marshal.FreeHGlobal(memory);
        }
    }

    /// <summary>The weights of trackers. Several trackers may share them.</summary>
    public sealed class Weights
    {
        /// <summary>For tracking and level of detail 1.</summary>
        public Model BaseNet;
        /// <summary>For detection.</summary>
        public Model Proposal;
        /// <summary>Levels of detail 2 to 4; may be null.</summary>
        public Model HiFiNet;
        /// <summary>For audio; may be null.</summary>
        public Model AudioNet;

        /// <summary>The files of a folder: basenet.mien and proposal.mien, and hifinet.mien and audionet.mien if present.</summary>
        public static Weights Open(string folder)
        {
            Func<string, Model> optional = name => File.Exists(Path.Combine(folder, name)) ? Model.Open(Path.Combine(folder, name)) : null;
            return new Weights
            {
                BaseNet = Model.Open(Path.Combine(folder, "basenet.mien")),
                Proposal = Model.Open(Path.Combine(folder, "proposal.mien")),
                HiFiNet = optional("hifinet.mien"),
                AudioNet = optional("audionet.mien"),
            };
        }
    }
}
