using System.Collections.Generic;
using System.Linq;
using Mien;

/// <summary>Names of blend shapes.</summary>
class BlendShapesTest
{
    static string Names(params string[] shapes)
    {
        Dictionary<string, BlendShapeDriver> drivers = BlendShapes.Match(shapes);
        return string.Join(" ", shapes.Select(shape => drivers.ContainsKey(shape)
            ? drivers[shape].Vocabulary + "." + drivers[shape].Vocabulary.Names()[drivers[shape].Index] : "-"));
    }

    public void FindsNamesOfArkitWithPrefixesAndSides()
    {
        Assert.Equal("Arkit.jawOpen Arkit.mouthSmileLeft Arkit.mouthSmileRight Arkit.eyeBlinkLeft -",
            Names("Face.M_F.jawOpen", "mouthSmile_L", "head:MouthSmileRight", "Body|EYE_BLINK_L", "Custom"));
    }

    public void APrefixBeforeAnUnderscoreIsSharedByThreeNames()
    {
        Assert.Equal("Arkit.jawOpen Arkit.mouthSmileLeft Arkit.eyeBlinkLeft - -",
            Names("Head_jawOpen", "Head_mouthSmile_L", "Head_EyeBlinkLeft", "Head_Custom", "Teeth_jawOpen"));
        Assert.Equal("Arkit.jawOpen Arkit.mouthFunnel Arkit.eyeBlinkLeft Arkit.jawLeft",
            Names("My_Head_jawOpen", "My_Head_mouthFunnel", "My_Head_eyeBlinkLeft", "jawLeft"));
        Assert.Equal("- - Arkit.eyeBlinkLeft", Names("Head_jawOpen", "Head_mouthFunnel", "eyeBlinkLeft"));
    }

    public void FindsNamesOfRoblox()
    {
        Assert.Equal("Roblox.JawDrop Roblox.LeftEyeClosed", Names("JawDrop", "LeftEyeClosed"));
    }

    public void VisemesMoveOnlyAMouthWithoutAJaw()
    {
        Assert.Equal("Visemes.aa Visemes.ih Visemes.PP Arkit.eyeBlinkLeft", Names("vrc.v_aa", "viseme_I", "viseme_PP", "eyeBlinkLeft"));
        Assert.Equal("- - - Arkit.jawOpen", Names("vrc.v_aa", "viseme_I", "viseme_PP", "jawOpen"));
        Assert.Equal("- -", Names("viseme_aa", "E"));
    }

    public void FindsExpressionsOfVrmAndVroid()
    {
        Assert.Equal("Vrm0.A Vrm0.Joy Vrm0.Blink_L -", Names("Fcl_MTH_A", "Fcl_ALL_Joy", "Fcl_EYE_Close_L", "Fcl_HA_Hide"));
        Assert.Equal("Vrm1.aa Vrm1.happy Vrm1.blinkLeft", Names("aa", "happy", "blinkLeft"));
    }
}
