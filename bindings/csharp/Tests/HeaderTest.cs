using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Reflection;
using System.Runtime.InteropServices;
using Mien;

/// <summary>Native.cs declares the same as mien.h. MIEN_C_API names the output of bindings/c_api.py.</summary>
class HeaderTest
{
    readonly string[][] header =
        File.ReadAllLines(Environment.GetEnvironmentVariable("MIEN_C_API")).Select(line => line.Split(' ')).ToArray();

    IEnumerable<string[]> Facts(string kind)
    {
        return header.Where(fact => fact[0] == kind);
    }

    public void StructLayoutsMatchTheHeader()
    {
        var said = new List<string>();
        foreach (Type type in typeof(Native).GetNestedTypes(BindingFlags.NonPublic).Where(type => type.IsValueType))
        {
            said.Add("struct " + type.Name + " " + Marshal.SizeOf(type));
            said.AddRange(type.GetFields().Select(field => "field " + type.Name + "." + field.Name + " " + Marshal.OffsetOf(type, field.Name)));
        }
        string[] expected = Facts("struct").Concat(Facts("field")).Select(fact => string.Join(" ", fact)).ToArray();
        Assert.Equal("", string.Join(", ", expected.Except(said)));
        Assert.Equal("", string.Join(", ", said.Except(expected)));
    }

    public void FunctionsMatchTheHeader()
    {
        var functions = Facts("function").ToDictionary(fact => fact[1], fact => int.Parse(fact[2]));
        foreach (MethodInfo method in typeof(Native).GetMethods(BindingFlags.NonPublic | BindingFlags.Static).Where(m => m.Name.StartsWith("mien_")))
        {
            Assert.That(functions.ContainsKey(method.Name), method.Name);
            Assert.Equal(functions[method.Name], method.GetParameters().Length);
        }
    }

    public void ConstantsMatchTheHeader()
    {
        Func<string, string> bare = name => name.Replace("_", "").ToLowerInvariant();
        var statuses = Enum.GetValues(typeof(Status)).Cast<Status>().ToDictionary(s => bare(s == Status.Ok ? "MIEN_OK" : "MIEN_ERROR_" + s), s => (int)s);
        foreach (string[] fact in Facts("status")) Assert.Equal(int.Parse(fact[2]), statuses[bare(fact[1])]);
        Assert.Equal(Facts("status").Count(), statuses.Count);
        var prefixes = new Dictionary<Type, string>
        {
            { typeof(PixelFormat), "MIEN_IMAGE_" }, { typeof(Vocabulary), "MIEN_VOCABULARY_" }, { typeof(FaceStatus), "MIEN_FACE_" },
            { typeof(Control), "MIEN_CONTROL_" }, { typeof(LandmarkGroup), "MIEN_LANDMARKS_" },
        };
        foreach (Type type in prefixes.Keys)
        {
            string prefix = prefixes[type];
            var expected = Facts("enum").Where(fact => fact[1].StartsWith(prefix)).Select(fact => bare(fact[1]) + fact[2]);
            var said = Enum.GetValues(type).Cast<object>().Select(value => bare(prefix + value) + (int)value);
            Assert.Equal(string.Join(" ", expected), string.Join(" ", said));
        }
        var constants = Facts("constant").ToDictionary(fact => fact[1], fact => (int)uint.Parse(fact[2]));
        Assert.Equal(constants["MIEN_CONTROL_COUNT"], Native.ControlCount);
        Assert.Equal(constants["MIEN_LANDMARK_COUNT"], Native.LandmarkCount);
        Assert.Equal(constants["MIEN_MAX_WEIGHT_FILES"], Native.MaxWeightFiles);
        Assert.Equal(constants["MIEN_NEUTRAL_BYTES"], Native.NeutralBytes);
        Assert.Equal((uint)constants["MIEN_RESULT_CAPTURING_NEUTRAL"], Native.CapturingNeutral);
    }
}
