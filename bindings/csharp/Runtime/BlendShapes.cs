using System.Collections.Generic;
using System.Linq;
using System.Text.RegularExpressions;

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
    /// a dot, colon or bar (Face.jawOpen), and with _L and _R for left and right.</summary>
    public static class BlendShapes
    {
        const int MinMouthNames = 3;  // fewer that may be of visemes or vowels, such as "A", mean something else

        static readonly string[,] vroid =
        {
            { "Fcl_ALL_Joy", "Joy" }, { "Fcl_ALL_Angry", "Angry" }, { "Fcl_ALL_Sorrow", "Sorrow" }, { "Fcl_ALL_Fun", "Fun" },
            { "Fcl_MTH_A", "A" }, { "Fcl_MTH_I", "I" }, { "Fcl_MTH_U", "U" }, { "Fcl_MTH_E", "E" }, { "Fcl_MTH_O", "O" },
            { "Fcl_EYE_Close_L", "Blink_L" }, { "Fcl_EYE_Close_R", "Blink_R" },
        };
        static readonly string[,] readyPlayerMe = { { "viseme_I", "ih" }, { "viseme_O", "oh" }, { "viseme_U", "ou" } };

        /// <summary>Drivers by name. Visemes and the vowels of VRM move the mouth only if no name of ARKit or Roblox opens the jaw.</summary>
        public static Dictionary<string, BlendShapeDriver> Match(IEnumerable<string> names)
        {
            string[] all = names.Distinct().ToArray();
            Dictionary<string, BlendShapeDriver> face = Found(all, Table(Vocabulary.Roblox), Table(Vocabulary.Arkit));
            if (face.Keys.Select(Plain).Any(name => name == "jawopen" || name == "jawdrop")) return face;
            Dictionary<string, BlendShapeDriver> mouth = new[] { Visemes(), Table(Vocabulary.Vrm1), Spelled(Vocabulary.Vrm0, vroid) }
                .Select(table => Found(all, table)).OrderByDescending(found => found.Count).First();
            if (mouth.Count < MinMouthNames) return face;
            foreach (var named in face) mouth[named.Key] = named.Value;
            return mouth;
        }

        static string Plain(string name)
        {
            string plain = Regex.Replace(name, @"^.*[.:|]", "").ToLowerInvariant();
            plain = Regex.Replace(Regex.Replace(plain, "_l$", "left"), "_r$", "right");
            return Regex.Replace(plain, "[^a-z0-9]", "");
        }

        static Dictionary<string, BlendShapeDriver> Table(Vocabulary vocabulary)
        {
            return vocabulary.Names().Select((name, i) => new { Key = Plain(name), Driver = new BlendShapeDriver(vocabulary, i) })
                .ToDictionary(named => named.Key, named => named.Driver);
        }

        // `others`: further spellings of names.
        static Dictionary<string, BlendShapeDriver> Spelled(Vocabulary vocabulary, string[,] others)
        {
            Dictionary<string, BlendShapeDriver> table = Table(vocabulary);
            for (int i = 0; i < others.GetLength(0); ++i) table[Plain(others[i, 0])] = table[Plain(others[i, 1])];
            return table;
        }

        static Dictionary<string, BlendShapeDriver> Visemes()
        {
            Dictionary<string, BlendShapeDriver> table = Spelled(Vocabulary.Visemes, readyPlayerMe);
            foreach (var named in Table(Vocabulary.Visemes))
            {
                table["viseme" + named.Key] = named.Value;
                table["v" + named.Key] = named.Value;
            }
            return table;
        }

        // Later tables have precedence.
        static Dictionary<string, BlendShapeDriver> Found(string[] names, params Dictionary<string, BlendShapeDriver>[] tables)
        {
            var found = new Dictionary<string, BlendShapeDriver>();
            foreach (var table in tables)
                foreach (string name in names.Where(name => table.ContainsKey(Plain(name)))) found[name] = table[Plain(name)];
            return found;
        }
    }
}
