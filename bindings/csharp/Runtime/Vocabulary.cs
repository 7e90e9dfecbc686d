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
