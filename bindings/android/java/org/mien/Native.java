package org.mien;

import java.nio.ByteBuffer;

/** The functions of jni/mien_jni.c, which calls mien.h. They trust handles and the sizes of buffers. */
final class Native {
    static {
        System.loadLibrary("mien_jni");
    }

    /** Indices of the values that result() writes. */
    static final int STATUS = 0, TIME_NS = 1, SUPPORTED = 2, LOD = 3, FLAGS = 4, FACE_ID = 5, LONGS = 6;
    static final int FACE_PROBABILITY = 0, VOICE_ACTIVITY = 1, BOX = 2, ROTATION = 6, PITCH = 10, YAW = 11, ROLL = 12, TRANSLATION = 13,
            CONTROLS = 16, LANDMARKS = 68, FLOATS = 418;

    static native String version();

    static native String statusString(int status);

    /** First landmark and number of landmarks. */
    static native int[] landmarkGroup(int group);

    static native int vocabularySize(int vocabulary);

    static native String vocabularyName(int vocabulary, int index);

    static native int vocabularyValues(int vocabulary, float[] controls, float[] values);

    /** handle[0] receives the weights, which use aligned files in place; message[0] an error. names: of the files. */
    static native int createWeights(ByteBuffer[] files, String[] names, long[] handle, String[] message);

    static native void destroyWeights(long weights);

    /** handle[0] receives the tracker; message[0] an error. integers: lod, maxFaces, smoothing, audioQueueSamples, maxLod, audio.
     *  floats: budgetMs, horizontalFov (0: default), voiceStrength. */
    static native int createTracker(long weights, String[] names, int[] integers, float[] floats, long[] handle, String[] message);

    static native void destroyTracker(long tracker);

    /** Planes are direct buffers, or the image is in `array`. integers: Image.integers(); floats: focal length, principal x, y. */
    static native int pushVideo(long tracker, ByteBuffer plane0, ByteBuffer plane1, ByteBuffer plane2, byte[] array, int[] integers,
            float[] floats, long timeNs);

    static native int advance(long tracker, long timeNs);

    static native int pushAudio(long tracker, float[] samples, int frames, int channels, int sampleRate, long timeNs);

    static native int queueAudio(long tracker, float[] samples, int frames, int channels, int sampleRate, long timeNs);

    static native int setAudioOffset(long tracker, long offsetNs);

    static native int setMix(long tracker, int control, float audio, float video);

    static native int setLod(long tracker, int lod);

    static native int faceCount(long tracker);

    /** index -1: the face with the lowest id. */
    static native int result(long tracker, int index, long[] longs, float[] floats);

    static native int captureNeutral(long tracker);

    static native int saveNeutral(long tracker, byte[] file);

    static native int loadNeutral(long tracker, byte[] file);

    static native int reset(long tracker);

    /** handle[0] receives the network; message[0] an error. */
    static native int createNetwork(long weights, String[] names, String name, int height, int width, long[] handle, String[] message);

    static native void destroyNetwork(long network);

    /** index -1: of the input. shape: channels, height, width. */
    static native void networkShape(long network, int index, int[] shape);

    static native int runNetwork(long network, float[] input);

    static native int networkOutputs(long network);

    static native void networkOutput(long network, int index, float[] values);

    static native void resetNetwork(long network);

    private Native() {}
}
