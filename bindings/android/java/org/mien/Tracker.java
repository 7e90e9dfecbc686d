package org.mien;

import java.util.ArrayList;
import java.util.List;
import java.util.Objects;

/**
 * Tracks faces in a stream of images and audio. Must be closed. Its methods are synchronized, except queueAudio, which only waits for
 * close.
 */
public final class Tracker implements AutoCloseable {
    private static final int NEUTRAL_BYTES = 448;

    /** Options of a tracker. */
    public static final class Options {
        /** Level of detail, 1 (fastest) to 4 (most accurate); 0: automatic, the highest within budgetMs per frame. */
        public int lod = 0;
        /** Maximum number of faces, 1..8. */
        public int maxFaces = 1;
        /** Whether to use audio. */
        public boolean sound = true;
        /** Smooths controls, landmarks and pose while they hardly move. */
        public boolean smoothing = true;
        /** Average time budget of a frame with a face for lod 0, ms, 0.01..1e6. */
        public float budgetMs = 10;
        /** Horizontal field of view of the upright image, for images without a focal length, in radians, 0.01..3.1; 0: 60 degrees. */
        public float horizontalFov = 0;
        /** Capacity of the audio queue (queueAudio), in samples of one channel, 0..2^22; 0: no queue. */
        public int audioQueueSamples = 0;
        /** Factor of the controls predicted from audio, 0..4. */
        public float voiceStrength = 1;
    }

    private final Object queue = new Object();
    private final Weights weights; // kept alive as long as this object
    private long handle;

    public Tracker(Weights weights) {
        this(weights, new Options());
    }

    public Tracker(Weights weights, Options options) {
        this.weights = weights;
        long[] made = new long[1];
        String[] message = new String[1];
        int[] integers = {options.lod, options.maxFaces, options.smoothing ? 1 : 0, options.audioQueueSamples, options.lod == 1 ? 1 : 4,
            options.sound ? 1 : 0};
        float[] floats = {options.budgetMs, options.horizontalFov, options.voiceStrength};
        MienException.check(Native.createTracker(weights.handle(), weights.names, integers, floats, made, message), message);
        handle = made[0];
    }

    /** Tracks one image and returns the result of the face with the lowest id. timeNs: timestamp of the image in nanoseconds, on any clock. */
    public synchronized FaceResult track(Image image, long timeNs) {
        MienException.check(Native.pushVideo(open(), image.planes[0], image.planes[1], image.planes[2], image.array, image.integers(),
                image.floats, timeNs));
        return result();
    }

    /** Outputs a frame without an image, for audio without video. timeNs: nanoseconds, on the clock of the images. */
    public synchronized FaceResult advance(long timeNs) {
        MienException.check(Native.advance(open(), timeNs));
        return result();
    }

    /** The result of the latest frame, of the face with the lowest id. */
    public synchronized FaceResult result() {
        return new FaceResult(open(), -1);
    }

    /** The results of all known faces on the latest frame. */
    public synchronized List<FaceResult> faces() {
        List<FaceResult> faces = new ArrayList<>();
        for (int i = 0; i < Native.faceCount(open()); ++i) {
            faces.add(new FaceResult(handle, i));
        }
        return faces;
    }

    /** Processes interleaved samples of -1..1; timeNs is the timestamp of the first, nanoseconds. channels: 1..8; sampleRate: 8000..192000 Hz. */
    public synchronized void pushAudio(float[] samples, int channels, int sampleRate, long timeNs) {
        MienException.check(Native.pushAudio(open(), samples, frames(samples, channels), channels, sampleRate, timeNs));
    }

    /** Queues audio, as for pushAudio, from another thread for the next frame; Status.AUDIO_QUEUE_FULL if the queue is full. */
    public void queueAudio(float[] samples, int channels, int sampleRate, long timeNs) {
        synchronized (queue) {
            MienException.check(Native.queueAudio(open(), samples, frames(samples, channels), channels, sampleRate, timeNs));
        }
    }

    /** Delays audio relative to the images by offsetNs nanoseconds, for audio pushed from now on. */
    public synchronized void setAudioOffset(long offsetNs) {
        MienException.check(Native.setAudioOffset(open(), offsetNs));
    }

    /** Weights of audio and video for a control during speech, each 0..1. */
    public synchronized void setMix(String control, float audio, float video) {
        MienException.check(Native.setMix(open(), Controls.number(control), audio, video));
    }

    /** Sets the level of detail, 0..4, from the next image on. */
    public synchronized void setLod(int lod) {
        MienException.check(Native.setLod(open(), lod));
    }

    /** Captures a person's neutral controls over the next 55 frames with a face, and removes them from later frames. */
    public synchronized void calibrate() {
        MienException.check(Native.captureNeutral(open()));
    }

    /** The captured neutral values as a file of 448 bytes. */
    public synchronized byte[] saveNeutral() {
        byte[] file = new byte[NEUTRAL_BYTES];
        MienException.check(Native.saveNeutral(open(), file));
        return file;
    }

    /** Restores saved neutral values. */
    public synchronized void loadNeutral(byte[] file) {
        Objects.requireNonNull(file, "file");
        MienException.check(Native.loadNeutral(open(), file));
    }

    /** Resets the tracker to its state after creation. */
    public synchronized void reset() {
        MienException.check(Native.reset(open()));
    }

    /** Overwrites the memory with zeros and releases it. No other call is allowed afterwards. */
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
}
