package org.mien;

/** Groups of landmarks: mien_landmark_group of mien.h, which describes them. */
public enum LandmarkGroup {
    RIGHT_EYE_LOWER, LEFT_EYE_LOWER, RIGHT_EYE_UPPER, LEFT_EYE_UPPER, RIGHT_IRIS, LEFT_IRIS, RIGHT_BROW_UPPER, LEFT_BROW_UPPER,
    RIGHT_BROW_LOWER, LEFT_BROW_LOWER, RIGHT_NOSE_SIDE, LEFT_NOSE_SIDE, RIGHT_CHEEK, LEFT_CHEEK, NOSE_BRIDGE, MIDLINE, LIPS_OUTER_UPPER,
    LIPS_OUTER_LOWER, LIPS_INNER_UPPER, LIPS_INNER_LOWER, FACE_OVAL;

    /** Index of the group's first landmark, and number of its landmarks. */
    public final int first, count;

    LandmarkGroup() {
        int[] range = Native.landmarkGroup(ordinal());
        first = range[0];
        count = range[1];
    }
}
