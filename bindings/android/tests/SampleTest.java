import androidx.camera.core.ImageInfo;
import androidx.camera.core.ImageProxy;
import java.nio.ByteBuffer;
import java.nio.file.Files;
import java.nio.file.Path;
import java.nio.file.Paths;
import java.util.ArrayList;
import java.util.List;
import kotlin.Unit;
import org.mien.*;
import org.mien.sample.FaceAnalyzer;

/** The sample's analyzer on the clip that ships, as images of CameraX. Argument: frames of it, 640x480, YUV 4:2:0. */
public final class SampleTest {
    static final int WIDTH = 640, HEIGHT = 480;

    public static void main(String[] arguments) throws Exception {
        byte[] clip = Files.readAllBytes(Paths.get(arguments[0]));
        List<FaceResult> results = new ArrayList<>();
        int frames = clip.length / (WIDTH * HEIGHT * 3 / 2), closed = 0;
        try (Weights weights = Weights.open(Paths.get(System.getenv("MIEN_MODELS"))); Tracker tracker = new Tracker(weights)) {
            FaceAnalyzer analyzer = new FaceAnalyzer(tracker, result -> {
                results.add(result);
                return Unit.INSTANCE;
            });
            for (int i = 0; i < frames; ++i) {
                CameraImage image = new CameraImage(clip, i);
                analyzer.analyze(image);
                closed += image.isClosed ? 1 : 0;
            }
        }
        FaceResult last = results.get(results.size() - 1);
        if (frames == 0 || results.size() != frames || closed != frames || !last.hasFace() || last.timeNs() != (frames - 1) * 33_000_000L) {
            throw new AssertionError("results: " + results.size() + ", closed: " + closed + ", face: " + last.hasFace() + ", time: " + last.timeNs());
        }
        System.out.println("FaceAnalyzer tracked " + frames + " images");
    }

    /** A frame of the clip, in direct buffers as on Android. */
    static final class CameraImage implements ImageProxy, ImageInfo {
        final PlaneProxy[] planes = new PlaneProxy[3];
        final int index;
        boolean isClosed;

        CameraImage(byte[] clip, int index) {
            this.index = index;
            int at = index * WIDTH * HEIGHT * 3 / 2;
            for (int i = 0; i < planes.length; ++i) {
                int width = i == 0 ? WIDTH : WIDTH / 2, bytes = width * (i == 0 ? HEIGHT : HEIGHT / 2);
                ByteBuffer buffer = ByteBuffer.allocateDirect(bytes);
                buffer.put(clip, at, bytes).flip();
                planes[i] = new Plane(buffer, width);
                at += bytes;
            }
        }

        @Override public int getWidth() {
            return WIDTH;
        }

        @Override public int getHeight() {
            return HEIGHT;
        }

        @Override public PlaneProxy[] getPlanes() {
            return planes;
        }

        @Override public ImageInfo getImageInfo() {
            return this;
        }

        @Override public long getTimestamp() {
            return index * 33_000_000L;
        }

        @Override public int getRotationDegrees() {
            return 0;
        }

        @Override public void close() {
            isClosed = true;
        }
    }

    static final class Plane implements ImageProxy.PlaneProxy {
        final ByteBuffer buffer;
        final int rowBytes;

        Plane(ByteBuffer buffer, int rowBytes) {
            this.buffer = buffer;
            this.rowBytes = rowBytes;
        }

        @Override public int getRowStride() {
            return rowBytes;
        }

        @Override public int getPixelStride() {
            return 1;
        }

        @Override public ByteBuffer getBuffer() {
            return buffer;
        }
    }
}
