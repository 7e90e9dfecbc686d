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
        /// <summary>Drivers by name. Visemes and the vowels of VRM move the mouth only if no name of ARKit or Roblox opens the jaw.</summary>
        public static Dictionary<string, BlendShapeDriver> Match(IEnumerable<string> names)
        {
            string[] all = names.Distinct().ToArray();
            int[] vocabularies = new int[all.Length], indices = new int[all.Length];
            Native.Check(Native.mien_vocabulary_match(all, all.Length, vocabularies, indices));
            return Enumerable.Range(0, all.Length).Where(i => indices[i] >= 0)
                .ToDictionary(i => all[i], i => new BlendShapeDriver((Vocabulary)vocabularies[i], indices[i]));
        }
    }
}
