package org.mien;

import java.util.ArrayList;
import java.util.Collections;
import java.util.List;

/** The words of a house for a face. */
public enum Vocabulary {
    ARKIT, MEDIAPIPE, ROBLOX, VRM0, VRM1, VISEMES;

    /** In their order, written as their owner does. */
    public final List<String> names;

    Vocabulary() {
        List<String> all = new ArrayList<>();
        for (int i = 0; i < Native.vocabularySize(ordinal()); ++i) {
            all.add(Native.vocabularyName(ordinal(), i));
        }
        names = Collections.unmodifiableList(all);
    }
}
