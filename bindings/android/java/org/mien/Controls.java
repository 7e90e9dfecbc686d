package org.mien;

import java.util.List;

/** 52 animation weights, 0..1, by ARKit name. */
public final class Controls {
    public static final List<String> NAMES = Vocabulary.ARKIT.names;

    private final float[] array;
    private final long supported;

    Controls(float[] array, long supported) {
        this.array = array;
        this.supported = supported;
    }

    /** In the order of NAMES. */
    public float get(int control) {
        return array[control];
    }

    public float get(String name) {
        return array[number(name)];
    }

    /** Whether it is driven at this level of detail; else it is always 0. */
    public boolean isSupported(String name) {
        return (supported >> number(name) & 1) != 0;
    }

    /** A copy, in the order of NAMES. */
    public float[] toArray() {
        return array.clone();
    }

    /** The same face in other words, in the order of their names. */
    public float[] to(Vocabulary vocabulary) {
        float[] values = new float[vocabulary.names.size()];
        MienException.check(Native.vocabularyValues(vocabulary.ordinal(), array, values));
        return values;
    }

    static int number(String name) {
        int number = NAMES.indexOf(name);
        if (number < 0) {
            throw new IllegalArgumentException("no control '" + name + "'");
        }
        return number;
    }
}
