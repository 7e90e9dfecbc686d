using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Runtime.InteropServices;

namespace Mien
{
    /// <summary>Opened weight files. Any number of trackers and networks may share them, and keep what they use after Dispose.</summary>
    public sealed class Weights : IDisposable
    {
        internal readonly WeightsHandle Handle;
        internal readonly string[] Names;

        /// <summary>Each is the content of a weight file, a packed one, or a bundle of several, in any order; it is copied.</summary>
        public Weights(params byte[][] files) : this(files, files.Select((file, i) => "weights[" + i + "]").ToArray())
        {
        }

        Weights(byte[][] files, string[] names)
        {
            if (files.Length > Native.MaxWeightFiles) throw new ArgumentException("files: too many (expected 8 at most)");
            Names = names;
            Native.mien_weights_config config;
            Native.mien_weights_config_default(out config);
            config.copy = 1;
            var pinned = new List<GCHandle>();
            Native.mien_error_detail detail = Native.NewDetail();
            int status;
            try
            {
                for (int i = 0; i < files.Length; ++i)
                {
                    if (files[i] == null) throw new ArgumentNullException("files");
                    if (files[i].Length == 0) throw new MienException(Status.WeightsTruncated);
                    pinned.Add(GCHandle.Alloc(files[i], GCHandleType.Pinned));
                    config.files[i] = pinned[i].AddrOfPinnedObject();
                    config.file_bytes[i] = new UIntPtr((uint)files[i].Length);
                }
                status = Native.mien_weights_create(ref config, out Handle, ref detail);
            }
            finally
            {
                pinned.ForEach(handle => handle.Free());
            }
            Native.Check(status, detail, names);
        }

        /// <summary>A file, or a folder: its basenet.mien and proposal.mien, and hifinet.mien and audionet.mien if present.</summary>
        public static Weights Open(string path)
        {
            string[] paths = { path };
            if (!File.Exists(path))
            {
                var names = new[] { "basenet.mien", "proposal.mien", "hifinet.mien", "audionet.mien" };
                paths = names.Select(name => Path.Combine(path, name)).Where((file, i) => i < 2 || File.Exists(file)).ToArray();
            }
            return new Weights(paths.Select(File.ReadAllBytes).ToArray(), paths);
        }

        public void Dispose()
        {
            Handle.Dispose();
        }

        /// <summary>The address for a call before GC.KeepAlive(this).</summary>
        internal IntPtr Place()
        {
            if (Handle.IsClosed) throw new ObjectDisposedException("Weights");
            return Handle.DangerousGetHandle();
        }
    }
}
