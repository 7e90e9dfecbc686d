using System;
using System.Collections.Generic;
using System.Linq;

namespace Mien
{
    /// <summary>A value of a vocabulary that moves a blend shape.</summary>
    public sealed class BlendShapeDriver
    {
        public readonly Vocabulary Vocabulary;
        /// <summary>In the vocabulary's names, and in Controls.To(Vocabulary).</summary>
        public readonly int Index;

        internal BlendShapeDriver(Vocabulary vocabulary, int index)
        {
            Vocabulary = vocabulary;
            Index = index;
        }
    }

    /// <summary>Finds what moves an avatar's blend shapes by their names: those of ARKit, Roblox, visemes and VRM, with any prefix before
    /// a dot, colon or bar (Face.jawOpen) or a shared one before an underscore (Head_jawOpen), and with _L and _R for left and right.</summary>
    public static class BlendShapes
    {
        const int MinWithPrefix = 3;  // names that confirm a prefix before an underscore, which is also a part of names

        /// <summary>Drivers by name. Visemes and the vowels of VRM move the mouth only if no name of ARKit or Roblox opens the jaw.</summary>
        public static Dictionary<string, BlendShapeDriver> Match(IEnumerable<string> names)
        {
            string[] all = names.Distinct().ToArray();
            BlendShapeDriver[] best = Drivers(all);
            string[] unknown = all.Where((name, i) => best[i] == null).ToArray();
            int least = Known(best) + MinWithPrefix;
            foreach (string prefix in SharedPrefixes(unknown))
            {
                BlendShapeDriver[] found = Drivers(all.Select(name => unknown.Contains(name) && Starts(name, prefix) ? name.Substring(prefix.Length) : name).ToArray());
                if (Known(found) < least) continue;
                best = found;
                least = Known(found) + 1;
            }
            return Enumerable.Range(0, all.Length).Where(i => best[i] != null).ToDictionary(i => all[i], i => best[i]);
        }

        static BlendShapeDriver[] Drivers(string[] names)
        {
            int[] vocabularies = new int[names.Length], indices = new int[names.Length];
            Native.Check(Native.mien_vocabulary_match(names, names.Length, vocabularies, indices));
            return names.Select((name, i) => indices[i] < 0 ? null : new BlendShapeDriver((Vocabulary)vocabularies[i], indices[i])).ToArray();
        }

        static int Known(BlendShapeDriver[] drivers)
        {
            return drivers.Count(driver => driver != null);
        }

        static bool Starts(string name, string prefix)
        {
            return name.Length > prefix.Length && name.StartsWith(prefix, StringComparison.Ordinal);
        }

        static string[] SharedPrefixes(string[] names)
        {
            return names.SelectMany(name => Enumerable.Range(0, name.Length).Where(i => name[i] == '_').Select(i => name.Substring(0, i + 1)))
                .GroupBy(prefix => prefix).Where(same => same.Count() >= MinWithPrefix).Select(same => same.Key).ToArray();
        }
    }
}
