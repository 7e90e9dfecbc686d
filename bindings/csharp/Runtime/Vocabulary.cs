using System;
using System.Collections.ObjectModel;
using System.Linq;

namespace Mien
{
    /// <summary>The words of a house for a face.</summary>
    public enum Vocabulary
    {
        Arkit = 0,
        MediaPipe = 1,
        Roblox = 2,
        Vrm0 = 3,
        Vrm1 = 4,
        Visemes = 5,
    }

    public static class Vocabularies
    {
        static readonly ReadOnlyCollection<string>[] names =
            Enum.GetValues(typeof(Vocabulary)).Cast<int>().Select(vocabulary => new ReadOnlyCollection<string>(
                Enumerable.Range(0, Native.mien_vocabulary_size(vocabulary))
                    .Select(i => Native.Text(Native.mien_vocabulary_name(vocabulary, i))).ToArray())).ToArray();

        /// <summary>In their order, written as their owner does.</summary>
        public static ReadOnlyCollection<string> Names(this Vocabulary vocabulary)
        {
            return names[(int)vocabulary];
        }

        /// <summary>Of the library: "major.minor.patch".</summary>
        public static string LibraryVersion { get { return Native.Text(Native.mien_version()); } }
    }
}
