package org.mien;

import java.util.Arrays;

/** One face on one frame. Owns its data. */
public final class FaceResult {
    private static final int CAPTURING_NEUTRAL = 0x10;

    /** Status of a face. */
    public enum Status {
        /** No face since the start or reset. */
        SEARCHING,
        TRACKING,
        /** The face is lost: it keeps its last position, and its controls fade. */
        LOST
    }

    private final long[] longs = new long[Native.LONGS];
    private final float[] floats = new float[Native.FLOATS];

    /** index of the face; -1: the face with the lowest id. */
    FaceResult(long tracker, int index) {
        MienException.check(Native.result(tracker, index, longs, floats));
    }

    public Status status() {
        return Status.values()[(int) longs[Native.STATUS]];
    }

    public boolean hasFace() {
        return status() == Status.TRACKING;
    }

    /** Timestamp of the frame, nanoseconds. */
    public long timeNs() {
        return longs[Native.TIME_NS];
    }

    /** Number of the face, from 1 in the order of detection; 0 before the first. */
    public int faceId() {
        return (int) longs[Native.FACE_ID];
    }

    /** The level of detail of this frame, 1..4. */
    public int lod() {
        return (int) longs[Native.LOD];
    }

    public float faceProbability() {
        return floats[Native.FACE_PROBABILITY];
    }

    /** 0..1: voice activity; 0 without audio. */
    public float voiceActivity() {
        return floats[Native.VOICE_ACTIVITY];
    }

    /** Whether this frame contributes to Tracker.calibrate. */
    public boolean isCapturingNeutral() {
        return (longs[Native.FLAGS] & CAPTURING_NEUTRAL) != 0;
    }

    /** x, y, width, height in pixels of the upright image. */
    public float[] box() {
        return part(Native.BOX, Native.ROTATION);
    }

    public Controls controls() {
        return new Controls(part(Native.CONTROLS, Native.LANDMARKS), longs[Native.SUPPORTED]);
    }

    /** 175 points x, y in pixels of the upright image. */
    public float[] landmarks() {
        return part(Native.LANDMARKS, Native.FLOATS);
    }

    /** The landmarks of a group, x, y in pixels of the upright image. */
    public float[] landmarksOf(LandmarkGroup group) {
        return part(Native.LANDMARKS + 2 * group.first, Native.LANDMARKS + 2 * (group.first + group.count));
    }

    /** Head to camera, x to the right, y up, z towards the viewer: unit quaternion x, y, z, w. */
    public float[] rotation() {
        return part(Native.ROTATION, Native.PITCH);
    }

    /** The head in camera space, metres. */
    public float[] translation() {
        return part(Native.TRANSLATION, Native.CONTROLS);
    }

    /** Radians, positive: looks down. */
    public float pitch() {
        return floats[Native.PITCH];
    }

    /** Radians, positive: turns to the subject's left. */
    public float yaw() {
        return floats[Native.YAW];
    }

    /** Radians, about z by the right-hand rule. */
    public float roll() {
        return floats[Native.ROLL];
    }

    private float[] part(int from, int to) {
        return Arrays.copyOfRange(floats, from, to);
    }
}
