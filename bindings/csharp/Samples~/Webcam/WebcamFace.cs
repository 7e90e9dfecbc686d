using System.Collections;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using Mien;
using UnityEngine;
using UnityEngine.Networking;

/// <summary>A webcam moves the avatar on which this component lies: blend shapes with names of ARKit, Roblox, visemes or VRM, and the bone of
/// the head. The weights are basenet.mien, proposal.mien and, for finer motion, hifinet.mien in StreamingAssets/mien.</summary>
public sealed class WebcamFace : MonoBehaviour
{
    struct Shape
    {
        public SkinnedMeshRenderer Renderer;
        public int Index;
        public BlendShapeDriver Driver;
    }

    [SerializeField, Tooltip("The bone that turns; empty: that of the humanoid avatar, if there is one")] Transform head;
    [SerializeField, Tooltip("Files in StreamingAssets/mien")] string[] weights = { "basenet.mien", "proposal.mien", "hifinet.mien" };
    [SerializeField, Range(0, 1), Tooltip("Share of the head's rotation")] float headShare = 1;

    readonly List<Shape> shapes = new List<Shape>();
    Quaternion headAtRest;  // relative to the avatar
    Quaternion headTurn = Quaternion.identity;
    WebCamTexture webcam;
    Color32[] pixels;
    byte[] bytes;
    Tracker tracker;

    IEnumerator Start()
    {
        FindShapes();
        FindHead();
        var files = new List<byte[]>();
        foreach (string name in weights)
        {
            string path = Path.Combine(Application.streamingAssetsPath, "mien", name);
            if (path.Contains("://"))  // inside the package on Android, and on the web
            {
                using (UnityWebRequest request = UnityWebRequest.Get(path))
                {
                    yield return request.SendWebRequest();
                    if (!string.IsNullOrEmpty(request.error))
                    {
                        Debug.LogError("mien: " + path + ": " + request.error, this);
                        yield break;
                    }
                    files.Add(request.downloadHandler.data);
                }
            }
            else files.Add(File.ReadAllBytes(path));
        }
        yield return Application.RequestUserAuthorization(UserAuthorization.WebCam);
        using (var opened = new Weights(files.ToArray())) tracker = new Tracker(opened, new TrackerOptions { Sound = false });
        webcam = new WebCamTexture(640, 480, 30);
        webcam.Play();
    }

    void FindShapes()
    {
        SkinnedMeshRenderer[] renderers = GetComponentsInChildren<SkinnedMeshRenderer>();
        Dictionary<string, BlendShapeDriver> drivers = BlendShapes.Match(renderers.SelectMany(NamesOf));
        foreach (SkinnedMeshRenderer each in renderers)
        {
            string[] names = NamesOf(each).ToArray();
            for (int i = 0; i < names.Length; ++i)
            {
                BlendShapeDriver driver;
                if (drivers.TryGetValue(names[i], out driver)) shapes.Add(new Shape { Renderer = each, Index = i, Driver = driver });
            }
        }
        if (shapes.Count == 0) Debug.LogWarning("mien: no blend shape of " + this.name + " has a known name", this);
    }

    static IEnumerable<string> NamesOf(SkinnedMeshRenderer each)
    {
        return Enumerable.Range(0, each.sharedMesh.blendShapeCount).Select(i => each.sharedMesh.GetBlendShapeName(i));
    }

    void FindHead()
    {
        var animator = GetComponent<Animator>();
        if (head == null && animator != null && animator.isHuman) head = animator.GetBoneTransform(HumanBodyBones.Head);
        if (head != null) headAtRest = Quaternion.Inverse(transform.rotation) * head.rotation;
    }

    void Update()
    {
        if (tracker == null || !webcam.didUpdateThisFrame) return;
        FaceResult result = tracker.Track(Picture(), Time.realtimeSinceStartupAsDouble);
        if (!result.HasFace) return;
        var values = new Dictionary<Vocabulary, float[]>();
        foreach (Shape shape in shapes)
        {
            if (!values.ContainsKey(shape.Driver.Vocabulary)) values[shape.Driver.Vocabulary] = result.Controls.To(shape.Driver.Vocabulary);
            shape.Renderer.SetBlendShapeWeight(shape.Index, 100 * values[shape.Driver.Vocabulary][shape.Driver.Index]);
        }
        // Unity's x axis points to the other side of a face that looks along z.
        float[] turn = result.Pose.Rotation;
        headTurn = Quaternion.Slerp(Quaternion.identity, new Quaternion(turn[0], -turn[1], -turn[2], turn[3]), headShare);
    }

    // After animations, which would turn the head back.
    void LateUpdate()
    {
        if (head != null) head.rotation = transform.rotation * headTurn * headAtRest;
    }

    Mien.Image Picture()
    {
        if (pixels == null || pixels.Length != webcam.width * webcam.height)
        {
            pixels = new Color32[webcam.width * webcam.height];
            bytes = new byte[pixels.Length * 4];
        }
        webcam.GetPixels32(pixels);
        for (int i = 0; i < pixels.Length; ++i)
        {
            bytes[4 * i] = pixels[i].r;
            bytes[4 * i + 1] = pixels[i].g;
            bytes[4 * i + 2] = pixels[i].b;
        }
        return new Mien.Image(PixelFormat.Rgba, webcam.width, webcam.height, bytes)
        {
            BottomUp = !webcam.videoVerticallyMirrored,  // as Unity's textures are
            Rotation = webcam.videoRotationAngle,
        };
    }

    void OnDestroy()
    {
        if (webcam != null) webcam.Stop();
        if (tracker != null) tracker.Dispose();
    }
}
