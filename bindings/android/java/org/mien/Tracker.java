package org.mien;

import java.util.ArrayList;
import java.util.List;
import java.util.Objects;

/**
 * Follows faces through a stream of pictures, and hears a voice. Has to be closed. Its methods exclude each other, but for queueAudio, which
 * waits for nothing but close.
 */
public final class Tracker implements AutoCloseable {
    private static final int NEUTRAL_BYTES = 448;

    /** What a tracker is asked for. */
    public static final class Options {
        /** Level of detail, 1 (cheapest) to 4; 0: as high as budgetMs a frame allows. */
        public int lod = 0;
        /** Faces followed at once, 1..8. */
        public int maxFaces = 1;
        /** Whether it can hear. */
        public boolean sound = true;
        /** Of what hardly moves. */
        public boolean smoothing = true;
        public float budgetMs = 10;
        /** Of the upright picture, radians, where pictures do not say a focal length; 0: 60 degrees. */
        public float horizontalFov = 0;
        /** Room for sound that another thread brings (queueAudio). */
        public int audioQueueSamples = 0;
        /** What the sound says of the mouth, times this, 0..4. */
        public float voiceStrength = 1;
    }

    private final Object queue = new Object();
    private final Weights weights; // which have to stay as long
    private long handle;

    public Tracker(Weights weights) {
        this(weights, new Options());
    }

    public Tracker(Weights weights, Options options) {
        this.weights = new Weights(weights.basenet, weights.proposal, weights.hifinet, options.sound ? weights.audionet : null);
        long[] made = new long[1];
        MienException.check(Native.createTracker(bytes(weights.basenet), bytes(weights.proposal), bytes(weights.hifinet),
                bytes(this.weights.audionet), new int[] {options.lod, options.maxFaces, options.smoothing ? 1 : 0, options.audioQueueSamples},
                new float[] {options.budgetMs, options.horizontalFov, options.voiceStrength}, made));
        handle = made[0];
    }

    /** Tracks one picture and tells of the face known longest. timeNs: of the picture, on any clock. */
    public synchronized FaceResult track(Image image, long timeNs) {
        MienException.check(Native.pushVideo(open(), image.planes[0], image.planes[1], image.planes[2], image.array, image.integers(),
                image.camera, timeNs));
        return result();
    }

    /** A frame of output without a picture: for sound alone. */
    public synchronized FaceResult advance(long timeNs) {
        MienException.check(Native.advance(open(), timeNs));
        return result();
    }

    /** Of the last picture, of the face known longest. */
    public synchronized FaceResult result() {
        return new FaceResult(open(), -1);
    }

    /** Of the last picture, every face known. */
    public synchronized List<FaceResult> faces() {
        List<FaceResult> faces = new ArrayList<>();
        for (int i = 0; i < Native.faceCount(open()); ++i) {
            faces.add(new FaceResult(handle, i));
        }
        return faces;
    }

    /** Hears samples of -1..1, channels in turns; timeNs is that of the first. */
    public synchronized void pushAudio(float[] samples, int channels, int sampleRate, long timeNs) {
        MienException.check(Native.pushAudio(open(), samples, frames(samples, channels), channels, sampleRate, timeNs));
    }

    /** The same from another thread, for the next frame; Status.AUDIO_QUEUE_FULL when there is no room. */
    public void queueAudio(float[] samples, int channels, int sampleRate, long timeNs) {
        synchronized (queue) {
            MienException.check(Native.queueAudio(open(), samples, frames(samples, channels), channels, sampleRate, timeNs));
        }
    }

    /** Sound pushed from now on belongs to pictures that much later. */
    public synchronized void setAudioOffset(long offsetNs) {
        MienException.check(Native.setAudioOffset(open(), offsetNs));
    }

    /** How much sound and picture count for a control while somebody speaks, each 0..1. */
    public synchronized void setMix(String control, float audio, float video) {
        MienException.check(Native.setMix(open(), Controls.number(control), audio, video));
    }

    public synchronized void setLod(int lod) {
        MienException.check(Native.setLod(open(), lod));
    }

    /** Captures, over the next 55 frames with a face, what it shows when it is neutral, to be taken out from then on. */
    public synchronized void calibrate() {
        MienException.check(Native.captureNeutral(open()));
    }

    /** What was captured, to be kept. */
    public synchronized byte[] saveNeutral() {
        byte[] file = new byte[NEUTRAL_BYTES];
        MienException.check(Native.saveNeutral(open(), file));
        return file;
    }

    public synchronized void loadNeutral(byte[] file) {
        Objects.requireNonNull(file, "file");
        MienException.check(Native.loadNeutral(open(), file));
    }

    /** Forgets everything seen and heard. */
    public synchronized void reset() {
        MienException.check(Native.reset(open()));
    }

    /** Gives the memory back, and wipes it. Nothing else may be called then. */
    @Override
    public synchronized void close() {
        synchronized (queue) {
            Native.destroyTracker(handle);
            handle = 0;
        }
    }

    private long open() {
        if (handle == 0) {
            throw new IllegalStateException("the tracker is closed");
        }
        return handle;
    }

    private static int frames(float[] samples, int channels) {
        return samples.length / Math.max(channels, 1);
    }

    private static java.nio.ByteBuffer bytes(Model model) {
        return model == null ? null : model.bytes;
    }
}
