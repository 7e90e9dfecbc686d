using System;

namespace Mien
{
    /// <summary>Statuses of the library: mien_status of mien.h.</summary>
    public enum Status
    {
        Ok = 0,
        NullArgument = -1,
        StructSize = -2,
        OutOfRange = -3,
        Alignment = -4,
        MemoryTooSmall = -5,
        OutOfMemory = -6,
        UnsupportedLod = -7,
        SeveralFaces = -8,
        NoAudionet = -9,
        WeightsNotMien = -20,
        WeightsVersion = -21,
        WeightsTruncated = -22,
        WeightsChecksum = -23,
        WeightsIncomplete = -25,
        WeightsShape = -26,
        WeightsValue = -27,
        WeightsTrailingBytes = -100,
        WeightsByteOrder = -101,
        WeightsLimit = -102,
        WeightsReserved = -103,
        WeightsGap = -104,
        WeightsPadding = -105,
        WeightsName = -106,
        WeightsDuplicateName = -107,
        WeightsMetadata = -108,
        WeightsTensorType = -110,
        WeightsTensorDims = -111,
        WeightsTensorBytes = -112,
        WeightsTensorValue = -113,
        WeightsTensorUnused = -114,
        WeightsNetwork = -120,
        WeightsLayerOp = -121,
        WeightsLayerActivation = -122,
        WeightsLayerInput = -123,
        WeightsLayerShape = -124,
        WeightsLayerWindow = -125,
        WeightsLayerTensors = -126,
        WeightsPackedSize = -130,
        WeightsPackedBlock = -131,
        WeightsPackedTable = -132,
        WeightsPackedState = -133,
        WeightsPackedTruncated = -134,
        WeightsPackedTrailing = -135,
        UnsupportedCpu = -40,
        UnsupportedLayer = -41,
        Internal = -42,
        LeftOut = -43,
        UnsupportedLayout = -44,
        TooLarge = -45,
        ImageFormat = -60,
        ImageSize = -61,
        ImageStride = -62,
        ImagePlane = -63,
        ImageRotation = -64,
        ImageCamera = -65,
        AudioFormat = -66,
        AudioRate = -67,
        AudioChannels = -68,
        AudioSamples = -69,
        ImageRegion = -70,
        AudioQueueFull = -71,
        NeutralFormat = -80,
        NeutralVersion = -81,
        NeutralDamaged = -82,
    }

    /// <summary>An error of the library, with its message.</summary>
    public sealed class MienException : Exception
    {
        public Status Status { get; private set; }

        public MienException(Status status) : this(status, Native.Text(Native.mien_status_string((int)status)))
        {
        }

        internal MienException(Status status, string message) : base(message)
        {
            Status = status;
        }
    }
}
