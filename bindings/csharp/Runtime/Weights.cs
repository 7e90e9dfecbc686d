using System;
using System.IO;
using System.Runtime.InteropServices;

namespace Mien
{
    /// <summary>A weight file in memory, where the library wants it. Trackers and networks may share one, and keep it as long as they need.</summary>
    public sealed class Model
    {
        // Memory of its own, since the collector moves managed arrays; given back when no object knows it any more.
        readonly IntPtr room;
        internal readonly IntPtr Place;
        internal readonly UIntPtr Bytes;

        public Model(byte[] data)
        {
            if (data == null) throw new ArgumentNullException("data");
            room = Marshal.AllocHGlobal(data.Length + Native.Alignment);
            Place = new IntPtr((room.ToInt64() + Native.Alignment - 1) / Native.Alignment * Native.Alignment);
            Bytes = new UIntPtr((uint)data.Length);
            Marshal.Copy(data, 0, Place, data.Length);
        }

        public static Model Open(string path)
        {
            return new Model(File.ReadAllBytes(path));
        }

        ~Model()
        {
            Marshal.FreeHGlobal(room);
        }
    }

    /// <summary>What trackers know. They may share one.</summary>
    public sealed class Weights
    {
        /// <summary>Landmarks, and level of detail 1.</summary>
        public Model BaseNet;
        /// <summary>Finds faces.</summary>
        public Model Proposal;
        /// <summary>Levels of detail 2 to 4; may be null.</summary>
        public Model HiFiNet;
        /// <summary>Hears; may be null.</summary>
        public Model AudioNet;

        /// <summary>The files of a folder: basenet.mien and proposal.mien, and the others where they are.</summary>
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
