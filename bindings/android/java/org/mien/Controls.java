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

    public float get(Control control) {
        return array[control.ordinal()];
    }

    public float get(String name) {
        return array[number(name)];
    }

    /** Whether this level of detail predicts it; otherwise it is always 0. */
    public boolean isSupported(String name) {
        return (supported >> number(name) & 1) != 0;
    }

    /** A copy, in the order of NAMES. */
    public float[] toArray() {
        return array.clone();
    }

    /** The controls in another vocabulary, in the order of its names. */
    public float[] to(Vocabulary vocabulary) {
        float[] values = new float[vocabulary.names.size()];
        MienException.check(Native.vocabularyValues(vocabulary.ordinal(), array, values));
        return values;
    }

    static int number(String name) {
        int number = NAMES.indexOf(name);
        if (number < 0) {
            throw new IllegalArgumentException("control: unknown (got '" + name + "')");
        }
        return number;
    }
}
