// The parts of Unity's API that the sample uses, so that it compiles without Unity. They do nothing.
using System.Collections;

namespace UnityEngine
{
    public class Object
    {
        public string name;
        public static bool operator ==(Object a, Object b) { return ReferenceEquals(a, b); }
        public static bool operator !=(Object a, Object b) { return !ReferenceEquals(a, b); }
        public override bool Equals(object other) { return ReferenceEquals(this, other); }
        public override int GetHashCode() { return 0; }
    }
    public class Component : Object
    {
        public Transform transform;
        public T GetComponent<T>() { return default(T); }
        public T[] GetComponentsInChildren<T>() { return new T[0]; }
    }
    public class MonoBehaviour : Component { }
    public class YieldInstruction { }
    public class AsyncOperation : YieldInstruction { }
    public class Transform : Component { public Quaternion rotation; }
    public enum HumanBodyBones { Head = 10 }
    public class Animator : Component
    {
        public bool isHuman;
        public Transform GetBoneTransform(HumanBodyBones bone) { return null; }
    }
    public struct Quaternion
    {
        public static readonly Quaternion identity = new Quaternion(0, 0, 0, 1);
        public float x, y, z, w;
        public Quaternion(float x, float y, float z, float w) { this.x = x; this.y = y; this.z = z; this.w = w; }
        public static Quaternion operator *(Quaternion a, Quaternion b) { return a; }
        public static Quaternion Inverse(Quaternion of) { return of; }
        public static Quaternion Slerp(Quaternion a, Quaternion b, float share) { return a; }
    }
    public struct Color32 { public byte r, g, b, a; }
    public class Mesh : Object
    {
        public int blendShapeCount;
        public string GetBlendShapeName(int index) { return null; }
    }
    public class SkinnedMeshRenderer : Component
    {
        public Mesh sharedMesh;
        public void SetBlendShapeWeight(int index, float weight) { }
    }
    public class WebCamTexture : Object
    {
        public int width, height, videoRotationAngle;
        public bool didUpdateThisFrame, videoVerticallyMirrored;
        public WebCamTexture(int width, int height, int rate) { }
        public void Play() { }
        public void Stop() { }
        public Color32[] GetPixels32(Color32[] pixels) { return pixels; }
    }
    public enum UserAuthorization { WebCam = 1 }
    public static class Application
    {
        public static string streamingAssetsPath;
        public static AsyncOperation RequestUserAuthorization(UserAuthorization mode) { return null; }
    }
    public static class Time { public static double realtimeSinceStartupAsDouble; }
    public static class Debug
    {
        public static void LogError(object message, Object about) { }
        public static void LogWarning(object message, Object about) { }
    }
    public sealed class SerializeField : System.Attribute { }
    public sealed class Tooltip : System.Attribute { public Tooltip(string text) { } }
    public sealed class Range : System.Attribute { public Range(float least, float most) { } }
}

namespace UnityEngine.Networking
{
    public class DownloadHandler { public byte[] data; }
    public class UnityWebRequest : System.IDisposable
    {
        public string error;
        public DownloadHandler downloadHandler;
        public static UnityWebRequest Get(string url) { return null; }
        public AsyncOperation SendWebRequest() { return null; }
        public void Dispose() { }
    }
}
