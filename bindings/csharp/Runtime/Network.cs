using System;
using System.Linq;
using System.Runtime.InteropServices;

namespace Mien
{
    /// <summary>A map of a network, [channels][height][width].</summary>
    public sealed class Map
    {
        public int Channels { get; internal set; }
        public int Height { get; internal set; }
        public int Width { get; internal set; }
        public float[] Values { get; internal set; }
    }

    /// <summary>A custom network of a weight file, for example converted from ONNX. One thread at a time may use it.</summary>
    public sealed class Network : IDisposable
    {
        const int Block = 8;       // channels stored together
        const int Interleaved = 4; // an input of up to this number of channels is stored as an image

        readonly NetworkHandle handle;

        /// <summary>name: of a network of the weights; null: the first. height, width: for networks that accept several; 0: the declared size.</summary>
        public Network(Weights weights, string name = null, int height = 0, int width = 0)
        {
            if (weights == null) throw new ArgumentNullException("weights");
            Native.mien_network_config config;
            Native.mien_network_config_default(out config);
            config.weights = weights.Place();
            config.height = height;
            config.width = width;
            config.name = name == null ? IntPtr.Zero : Marshal.StringToHGlobalAnsi(name);
            Native.mien_error_detail detail = Native.NewDetail();
            try
            {
                Native.Check(Native.mien_network_create(ref config, out handle, ref detail), detail, weights.Names);
            }
            finally
            {
                Marshal.FreeHGlobal(config.name);
            }
            GC.KeepAlive(weights);
            Native.mien_shape shape;
            Native.mien_network_input(handle, out shape);
            InputShape = Of(shape);
        }

        /// <summary>Shape of the input, without values.</summary>
        public Map InputShape { get; private set; }

        /// <summary>Runs the network once, one step of a temporal network. Input and outputs are [channels][height][width].</summary>
        public Map[] Run(float[] input)
        {
            int pixels = InputShape.Height * InputShape.Width;
            if (input == null || input.Length != pixels * InputShape.Channels)
                throw new ArgumentException("input: wrong length (expected " + InputShape.Channels + " x " + InputShape.Height + " x " + InputShape.Width + ")");
            bool interleaved = InputShape.Channels <= Interleaved && pixels > 1;
            int step = interleaved ? InputShape.Channels : Block;
            var laidOut = new float[interleaved ? input.Length : Blocks(InputShape) * pixels * Block];
            for (int channel = 0; channel < InputShape.Channels; ++channel)
                for (int pixel = 0; pixel < pixels; ++pixel)
                    laidOut[(channel / step * pixels + pixel) * step + channel % step] = input[channel * pixels + pixel];
            Native.mien_shape ignored;
            Marshal.Copy(laidOut, 0, Native.mien_network_input(handle, out ignored), laidOut.Length);
            Native.Check(Native.mien_network_run(handle));
            return Enumerable.Range(0, Native.mien_network_output_count(handle)).Select(Output).ToArray();
        }

        /// <summary>Resets the state of temporal layers to the start of a stream.</summary>
        public void Reset()
        {
            Native.mien_network_reset(handle);
        }

        public void Dispose()
        {
            handle.Dispose();
        }

        Map Output(int index)
        {
            Native.mien_shape shape;
            IntPtr place = Native.mien_network_output(handle, index, out shape);
            Map map = Of(shape);
            int pixels = map.Height * map.Width;
            var blocks = new float[Blocks(map) * pixels * Block];
            Marshal.Copy(place, blocks, 0, blocks.Length);
            GC.KeepAlive(handle); // otherwise the collector could release the memory that is copied here
            map.Values = new float[map.Channels * pixels];
            for (int channel = 0; channel < map.Channels; ++channel)
                for (int pixel = 0; pixel < pixels; ++pixel)
                    map.Values[channel * pixels + pixel] = blocks[(channel / Block * pixels + pixel) * Block + channel % Block];
            return map;
        }

        static Map Of(Native.mien_shape shape)
        {
            return new Map { Channels = shape.channels, Height = shape.height, Width = shape.width };
        }

        static int Blocks(Map map)
        {
            return (map.Channels + Block - 1) / Block;
        }
    }
}
