using System.IO;
using Mien;
using UnityEngine;

/// <summary>A webcam moves the blend shapes of a face, which have ARKit's names. The weights lie in StreamingAssets/mien.</summary>
public sealed class WebcamFace : MonoBehaviour
{
    [SerializeField] SkinnedMeshRenderer face;
    WebCamTexture camera;
    Color32[] pixels;
    byte[] bytes;
    Tracker tracker;

    void Start()
    {
        tracker = new Tracker(Weights.Open(Path.Combine(Application.streamingAssetsPath, "mien")), new TrackerOptions { Sound = false });
        camera = new WebCamTexture(640, 480, 30);
        camera.Play();
    }

    void Update()
    {
        if (!camera.didUpdateThisFrame) return;
        if (pixels == null || pixels.Length != camera.width * camera.height)
        {
            pixels = new Color32[camera.width * camera.height];
            bytes = new byte[pixels.Length * 4];
        }
        camera.GetPixels32(pixels);
        for (int i = 0; i < pixels.Length; ++i)
        {
            bytes[4 * i] = pixels[i].r;
            bytes[4 * i + 1] = pixels[i].g;
            bytes[4 * i + 2] = pixels[i].b;
        }
        var image = new Mien.Image(PixelFormat.Rgba, camera.width, camera.height, bytes)
        {
            BottomUp = true, // as in Unity's textures
            Rotation = camera.videoRotationAngle,
        };
        FaceResult result = tracker.Track(image, Time.realtimeSinceStartupAsDouble);
        if (!result.HasFace) return;
        for (int i = 0; i < Controls.Names.Count; ++i)
        {
            int shape = face.sharedMesh.GetBlendShapeIndex(Controls.Names[i]);
            if (shape >= 0) face.SetBlendShapeWeight(shape, 100 * result.Controls[i]);
        }
    }

    void OnDestroy()
    {
        camera.Stop();
        tracker.Dispose();
    }
}
