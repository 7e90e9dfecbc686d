import java.io.IOException;
import java.nio.ByteBuffer;
import java.nio.file.Files;
import java.nio.file.Path;
import java.nio.file.Paths;
import java.util.ArrayList;
import java.util.Arrays;
import java.util.List;
import java.util.function.Function;
import org.mien.*;

/** The tracker on the clip that ships. MIEN_CLIP: 60 frames of it, 640x480, RGB; MIEN_MODELS: the weights; MIEN_C_API: bindings/c_api.py. */
public final class ClipTest {
    static final int WIDTH = 640, HEIGHT = 480, FRAME_BYTES = WIDTH * HEIGHT * 3;
    static final Path MODELS = Paths.get(System.getenv("MIEN_MODELS"));

    static List<byte[]> frames = new ArrayList<>();
    static Weights weights;
    static FaceResult reference;

    interface Test {
        void run() throws Exception;
    }

    public static void main(String[] arguments) throws Exception {
        byte[] clip = Files.readAllBytes(Paths.get(System.getenv("MIEN_CLIP")));
        for (int at = 0; at + FRAME_BYTES <= clip.length; at += FRAME_BYTES) {
            frames.add(Arrays.copyOfRange(clip, at, at + FRAME_BYTES));
        }
        weights = Weights.open(MODELS);
        reference = tracked(ClipTest::rgb, 1);
        Test[] tests = {ClipTest::constantsMatchTheHeader, ClipTest::tracksAFace, ClipTest::convertsControlsToEveryVocabulary,
            ClipTest::everyLayoutGivesTheSameResult, ClipTest::reportsErrors, ClipTest::acceptsAudioFromAnotherThread,
            ClipTest::calibrationAndReset, ClipTest::runsCustomNetworks};
        for (Test test : tests) {
            test.run();
        }
        System.out.println(tests.length + " passed, 0 failed");
    }

    static void require(boolean condition, String what) {
        if (!condition) {
            throw new AssertionError(what);
        }
    }

    static void near(float[] a, float[] b, float bound) {
        require(a.length == b.length, "as many");
        for (int i = 0; i < a.length; ++i) {
            require(Math.abs(a[i] - b[i]) <= bound, a[i] + " and " + b[i]);
        }
    }

    static <E extends Exception> E thrown(Class<E> kind, Test test) {
        try {
            test.run();
        } catch (Exception error) {
            if (kind.isInstance(error)) {
                return kind.cast(error);
            }
            throw new AssertionError("another error", error);
        }
        throw new AssertionError("nothing was thrown (expected " + kind + ")");
    }

    static void refuses(Status status, Test test) {
        MienException error = thrown(MienException.class, test);
        require(error.status == status, status + ", not " + error.status);
        require(!error.getMessage().equals("unknown status"), "a text");
    }

    static Image rgb(byte[] frame) {
        return Image.of(Image.Format.RGB, WIDTH, HEIGHT, frame);
    }

    static Tracker.Options level(int lod) {
        Tracker.Options options = new Tracker.Options();
        options.lod = lod;
        return options;
    }

    static FaceResult tracked(Function<byte[], Image> image, int lod) {
        try (Tracker tracker = new Tracker(weights, level(lod))) {
            for (int i = 0; i < 10; ++i) {
                tracker.track(image.apply(frames.get(i)), i * 1_000_000_000L / 30);
            }
            return tracker.result();
        }
    }

    static void constantsMatchTheHeader() throws IOException {
        int statuses = 0, landmarks = 0;
        for (String line : Files.readAllLines(Paths.get(System.getenv("MIEN_C_API")))) {
            String[] fact = line.split(" ");
            if (fact[0].equals("status")) {
                ++statuses;
                String name = fact[1].equals("MIEN_OK") ? "OK" : fact[1].substring("MIEN_ERROR_".length());
                require(Status.valueOf(name).number == Integer.parseInt(fact[2]), line);
            } else if (fact[1].startsWith("MIEN_IMAGE_")) {
                require(Image.Format.valueOf(fact[1].substring("MIEN_IMAGE_".length())).ordinal() == Integer.parseInt(fact[2]), line);
            } else if (fact[1].startsWith("MIEN_VOCABULARY_")) {
                require(Vocabulary.valueOf(fact[1].substring("MIEN_VOCABULARY_".length())).ordinal() == Integer.parseInt(fact[2]), line);
            } else if (fact[1].startsWith("MIEN_CONTROL_") && fact[0].equals("enum")) {
                Control control = Control.valueOf(fact[1].substring("MIEN_CONTROL_".length()));
                require(control.ordinal() == Integer.parseInt(fact[2]), line);
                require(Controls.NAMES.get(control.ordinal()).replaceAll("([A-Z])", "_$1").toUpperCase().equals(control.name()), line);
            } else if (fact[1].startsWith("MIEN_LANDMARKS_")) {
                LandmarkGroup group = LandmarkGroup.valueOf(fact[1].substring("MIEN_LANDMARKS_".length()));
                require(group.ordinal() == Integer.parseInt(fact[2]) && group.first == landmarks, line);
                landmarks += group.count;
            } else if (fact[1].startsWith("MIEN_FACE_")) {
                require(FaceResult.Status.valueOf(fact[1].substring("MIEN_FACE_".length())).ordinal() == Integer.parseInt(fact[2]), line);
            }
        }
        require(statuses + 1 == Status.values().length, "all of them, and UNKNOWN");
        require(landmarks == 175, "groups cover all landmarks");
    }

    static void tracksAFace() {
        require(reference.hasFace() && reference.status() == FaceResult.Status.TRACKING, "a face");
        require(reference.faceId() == 1 && reference.lod() == 1 && reference.timeNs() == 300_000_000L, "which and when");
        require(reference.faceProbability() > 0.9f && reference.voiceActivity() == 0, "how sure");
        float[] box = reference.box();
        require(box[0] > 0 && box[0] + box[2] < WIDTH && box[1] > 0 && box[1] + box[3] < HEIGHT && box[2] > 50, "where");
        require(reference.landmarks().length == 350, "landmarks");
        float[] q = reference.rotation();
        require(Math.abs(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3] - 1) < 1e-4, "a unit quaternion");
        require(reference.translation()[2] < 0 && Math.abs(reference.yaw()) < 1, "a pose");
        require(tracked(ClipTest::rgb, 4).lod() == 4, "a level");
    }

    static void convertsControlsToEveryVocabulary() {
        Controls controls = reference.controls();
        require(Controls.NAMES.get(17).equals("jawOpen") && controls.get(17) == controls.get("jawOpen"), "by name");
        require(controls.isSupported("jawOpen") && !controls.isSupported("eyeLookUpLeft"), "supported controls");
        near(controls.toArray(), controls.to(Vocabulary.ARKIT), 0);
        require(controls.to(Vocabulary.ROBLOX)[Vocabulary.ROBLOX.names.indexOf("JawDrop")] == controls.get("jawOpen"), "Roblox");
        int[] sizes = {52, 52, 50, 11, 11, 15};
        for (Vocabulary vocabulary : Vocabulary.values()) {
            require(vocabulary.names.size() == sizes[vocabulary.ordinal()], vocabulary.name());
        }
        thrown(IllegalArgumentException.class, () -> controls.get("nothing"));
    }

    static void same(Function<byte[], Image> image, float pixels, float share) {
        FaceResult last = tracked(image, 1);
        near(reference.landmarks(), last.landmarks(), pixels);
        near(reference.controls().toArray(), last.controls().toArray(), share);
    }

    static int luma(byte[] frame, int pixel) {
        int r = frame[3 * pixel] & 255, g = frame[3 * pixel + 1] & 255, b = frame[3 * pixel + 2] & 255;
        return Math.round(0.299f * r + 0.587f * g + 0.114f * b);
    }

    /** BT.601 chroma of one in four pixels. */
    static int chroma(byte[] frame, int pixel, int color) {
        float scale = color == 2 ? 1.772f : 1.402f;
        return Math.max(0, Math.min(255, Math.round(((frame[3 * pixel + color] & 255) - luma(frame, pixel)) / scale + 128)));
    }

    static byte[] nv21(byte[] frame) {
        byte[] picture = new byte[WIDTH * HEIGHT * 3 / 2];
        for (int pixel = 0; pixel < WIDTH * HEIGHT; ++pixel) {
            picture[pixel] = (byte) luma(frame, pixel);
        }
        for (int i = 0; i < WIDTH * HEIGHT / 4; ++i) {
            int pixel = i / (WIDTH / 2) * 2 * WIDTH + i % (WIDTH / 2) * 2;
            picture[WIDTH * HEIGHT + 2 * i] = (byte) chroma(frame, pixel, 0);
            picture[WIDTH * HEIGHT + 2 * i + 1] = (byte) chroma(frame, pixel, 2);
        }
        return picture;
    }

    static ByteBuffer direct(byte[] bytes, int from) {
        ByteBuffer buffer = ByteBuffer.allocateDirect(bytes.length - from);
        buffer.put(bytes, from, bytes.length - from).rewind();
        return buffer;
    }

    static void everyLayoutGivesTheSameResult() {
        same(frame -> Image.of(Image.Format.RGB, WIDTH, HEIGHT, new ByteBuffer[] {direct(frame, 0)}, new int[] {3 * WIDTH}), 0, 0);
        same(frame -> {
            byte[] turned = new byte[FRAME_BYTES];
            for (int i = 0; i < FRAME_BYTES; ++i) {
                turned[i] = frame[FRAME_BYTES - 3 - i / 3 * 3 + i % 3];
            }
            return rgb(turned).rotated(180);
        }, 0.5f, 0.01f);
        same(frame -> Image.of(Image.Format.NV21, WIDTH, HEIGHT, nv21(frame)), 1, 0.05f);
        same(frame -> { // as from Android: V and U interleaved, planes that start one byte apart
            byte[] picture = nv21(frame);
            ByteBuffer[] planes = {direct(picture, 0), direct(picture, WIDTH * HEIGHT + 1), direct(picture, WIDTH * HEIGHT)};
            return Image.yuv420(WIDTH, HEIGHT, planes, new int[] {WIDTH, WIDTH, WIDTH}, 2);
        }, 1, 0.05f);
        same(frame -> { // pixels twice as wide as high; landmarks may differ by one of them
            byte[] narrow = new byte[FRAME_BYTES / 2];
            for (int i = 0; i < narrow.length; ++i) {
                int left = i / 3 * 6 + i % 3;
                narrow[i] = (byte) (((frame[left] & 255) + (frame[left + 3] & 255)) / 2);
            }
            return Image.of(Image.Format.RGB, WIDTH / 2, HEIGHT, narrow).pixelAspect(2);
        }, 2, 0.2f);
        float[] box = reference.box();
        same(frame -> rgb(frame).region((int) box[0] - 40, (int) box[1] - 40, (int) box[2] + 80, (int) box[3] + 80), 4, 0.2f);
    }

    static void reportsErrors() throws IOException {
        thrown(IllegalArgumentException.class, () -> Image.of(Image.Format.RGB, WIDTH, HEIGHT, new byte[FRAME_BYTES - 1]));
        thrown(IllegalArgumentException.class, () -> Image.of(Image.Format.GRAY8, 4, 4, new ByteBuffer[] {ByteBuffer.allocate(16)}, new int[] {4}));
        thrown(IllegalArgumentException.class,
                () -> Image.of(Image.Format.GRAY8, 4, 4, new ByteBuffer[] {ByteBuffer.allocateDirect(15)}, new int[] {4}));
        Weights deaf = Weights.of(Files.readAllBytes(MODELS.resolve("basenet.mien")), Files.readAllBytes(MODELS.resolve("proposal.mien")));
        try (Tracker tracker = new Tracker(deaf, level(1))) {
            refuses(Status.IMAGE_SIZE, () -> tracker.track(Image.of(Image.Format.GRAY8, 0, 0, new byte[0]), 0));
            refuses(Status.IMAGE_ROTATION, () -> tracker.track(rgb(frames.get(0)).rotated(45), 0));
            refuses(Status.IMAGE_SIZE, () -> tracker.track(rgb(frames.get(0)).pixelAspect(11), 0));
            refuses(Status.NO_AUDIONET, () -> tracker.pushAudio(new float[10], 1, 16000, 0));
            refuses(Status.NEUTRAL_FORMAT, () -> tracker.loadNeutral(new byte[448]));
            thrown(NullPointerException.class, () -> tracker.loadNeutral(null));
            require(tracker.result().status() == FaceResult.Status.SEARCHING, "nothing happened");
        }
        refuses(Status.UNSUPPORTED_LOD, () -> new Tracker(weights, level(5)));
        refuses(Status.WEIGHTS_NOT_MIEN, () -> Weights.of(new byte[640]));
        Tracker.Options many = level(1);
        many.maxFaces = 9;
        try {
            new Tracker(weights, many);
            require(false, "refused");
        } catch (MienException error) {
            require(error.getMessage().equals("max_faces: a value is out of range (got 9, expected 1..8)"), error.getMessage());
        }
        thrown(IOException.class, () -> Weights.open(Paths.get("/nowhere")));
        Tracker closed = new Tracker(weights);
        closed.close();
        closed.close();
        thrown(IllegalStateException.class, () -> closed.track(rgb(frames.get(0)), 0));
        thrown(IllegalStateException.class, () -> closed.queueAudio(new float[1], 1, 16000, 0));
    }

    static void acceptsAudioFromAnotherThread() throws InterruptedException {
        float[] sound = new float[32000];
        for (int i = 0; i < sound.length; ++i) {
            double t = i / 16000.0, sum = 0;
            for (int k = 1; k < 25; ++k) {
                sum += Math.sin(2 * Math.PI * 120 * k * t) / k;
            }
            sound[i] = (float) (0.25 * sum * Math.max(Math.sin(2 * Math.PI * 4 * t), 0));
        }
        Tracker.Options options = level(1);
        options.audioQueueSamples = 48000;
        try (Tracker pushed = new Tracker(weights, options); Tracker queued = new Tracker(weights, options)) {
            pushed.pushAudio(sound, 1, 16000, 0);
            Thread thread = new Thread(() -> {
                for (int i = 0; i < 20; ++i) {
                    queued.queueAudio(Arrays.copyOfRange(sound, 1600 * i, 1600 * (i + 1)), 1, 16000, i * 100_000_000L);
                }
            });
            thread.start();
            thread.join();
            float most = 0;
            for (int i = 0; i < 60; ++i) {
                FaceResult a = pushed.advance(i * 1_000_000_000L / 30), b = queued.advance(i * 1_000_000_000L / 30);
                near(a.controls().toArray(), b.controls().toArray(), 0);
                most = Math.max(most, a.voiceActivity());
            }
            require(most > 0.2f, "somebody speaks");
            refuses(Status.AUDIO_QUEUE_FULL, () -> queued.queueAudio(new float[100000], 1, 16000, 9_000_000_000L));
            refuses(Status.OUT_OF_RANGE, () -> pushed.setMix("jawOpen", 2, 1));
        }
    }

    static void calibrationAndReset() {
        try (Tracker tracker = new Tracker(weights, level(1))) {
            tracker.calibrate();
            int capturing = 0;
            for (int i = 0; i < 70; ++i) {
                capturing += tracker.track(rgb(frames.get(i % 60)), i * 1_000_000_000L / 30).isCapturingNeutral() ? 1 : 0;
            }
            require(capturing >= 45 && !tracker.result().isCapturingNeutral(), "captured " + capturing);
            byte[] neutral = tracker.saveNeutral();
            tracker.reset();
            tracker.loadNeutral(neutral);
            require(Arrays.equals(neutral, tracker.saveNeutral()), "kept");
        }
        Tracker.Options options = level(1);
        options.maxFaces = 2;
        try (Tracker several = new Tracker(weights, options)) {
            several.track(rgb(frames.get(0)), 0);
            require(several.faces().size() == 1, "one");
            refuses(Status.SEVERAL_FACES, several::calibrate);
        }
    }

    static void runsCustomNetworks() throws IOException {
        Weights model = Weights.of(Files.readAllBytes(MODELS.resolve("proposal.mien")));
        try (Network network = new Network(model, "rnet", 0, 0)) {
            require(Arrays.equals(network.inputShape(), new int[] {3, 24, 24}), "its input");
            float[] input = new float[3 * 24 * 24], other = new float[input.length];
            for (int i = 0; i < input.length; ++i) {
                input[i] = i % 17 / 17f;
                other[i] = i % 5 / 5f;
            }
            Network.Map[] outputs = network.run(input);
            require(outputs.length > 0 && outputs[0].values.length == outputs[0].channels * outputs[0].height * outputs[0].width, "outputs");
            near(outputs[0].values, network.run(input)[0].values, 0);
            require(!Arrays.equals(outputs[0].values, network.run(other)[0].values), "they depend on the input");
            thrown(IllegalArgumentException.class, () -> network.run(new float[1]));
            network.reset();
        }
        refuses(Status.WEIGHTS_INCOMPLETE, () -> new Network(model, "nothing", 0, 0));
    }
}
