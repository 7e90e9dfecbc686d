using System;
using System.Collections.ObjectModel;
using System.Linq;

namespace Mien
{
    /// <summary>Names of controls in another standard.</summary>
    public enum Vocabulary
    {
        Arkit = 0,
        MediaPipe = 1,
        Roblox = 2,
        Vrm0 = 3,
        Vrm1 = 4,
        Visemes = 5,
    }

    /// <summary>Controls in the order of Controls.Names.</summary>
    public enum Control
    {
        EyeBlinkLeft = 0, EyeLookDownLeft = 1, EyeLookInLeft = 2, EyeLookOutLeft = 3, EyeLookUpLeft = 4, EyeSquintLeft = 5, EyeWideLeft = 6,
        EyeBlinkRight = 7, EyeLookDownRight = 8, EyeLookInRight = 9, EyeLookOutRight = 10, EyeLookUpRight = 11, EyeSquintRight = 12,
        EyeWideRight = 13, JawForward = 14, JawLeft = 15, JawRight = 16, JawOpen = 17, MouthClose = 18, MouthFunnel = 19, MouthPucker = 20,
        MouthLeft = 21, MouthRight = 22, MouthSmileLeft = 23, MouthSmileRight = 24, MouthFrownLeft = 25, MouthFrownRight = 26,
        MouthDimpleLeft = 27, MouthDimpleRight = 28, MouthStretchLeft = 29, MouthStretchRight = 30, MouthRollLower = 31, MouthRollUpper = 32,
        MouthShrugLower = 33, MouthShrugUpper = 34, MouthPressLeft = 35, MouthPressRight = 36, MouthLowerDownLeft = 37,
        MouthLowerDownRight = 38, MouthUpperUpLeft = 39, MouthUpperUpRight = 40, BrowDownLeft = 41, BrowDownRight = 42, BrowInnerUp = 43,
        BrowOuterUpLeft = 44, BrowOuterUpRight = 45, CheekPuff = 46, CheekSquintLeft = 47, CheekSquintRight = 48, NoseSneerLeft = 49,
        NoseSneerRight = 50, TongueOut = 51,
    }

    /// <summary>Groups of landmarks; mien.h describes them.</summary>
    public enum LandmarkGroup
    {
        RightEyeLower = 0, LeftEyeLower = 1, RightEyeUpper = 2, LeftEyeUpper = 3, RightIris = 4, LeftIris = 5, RightBrowUpper = 6,
        LeftBrowUpper = 7, RightBrowLower = 8, LeftBrowLower = 9, RightNoseSide = 10, LeftNoseSide = 11, RightCheek = 12, LeftCheek = 13,
        NoseBridge = 14, Midline = 15, LipsOuterUpper = 16, LipsOuterLower = 17, LipsInnerUpper = 18, LipsInnerLower = 19, FaceOval = 20,
    }

    public static class Vocabularies
    {
        static readonly ReadOnlyCollection<string>[] names =
            Enum.GetValues(typeof(Vocabulary)).Cast<int>().Select(vocabulary => new ReadOnlyCollection<string>(
                Enumerable.Range(0, Native.mien_vocabulary_size(vocabulary))
                    .Select(i => Native.Text(Native.mien_vocabulary_name(vocabulary, i))).ToArray())).ToArray();

        /// <summary>The names in order, spelled as in the standard.</summary>
        public static ReadOnlyCollection<string> Names(this Vocabulary vocabulary)
        {
            return names[(int)vocabulary];
        }

        /// <summary>Of the library: "major.minor.patch".</summary>
        public static string LibraryVersion { get { return Native.Text(Native.mien_version()); } }
    }
}
