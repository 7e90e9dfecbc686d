package org.mien;

import java.util.ArrayList;
import java.util.Collections;
import java.util.List;

/** Names of controls in another standard. */
public enum Vocabulary {
    ARKIT, MEDIAPIPE, ROBLOX, VRM0, VRM1, VISEMES;

    /** The names in order, spelled as in the standard. */
    public final List<String> names;

    Vocabulary() {
        List<String> all = new ArrayList<>();
        for (int i = 0; i < Native.vocabularySize(ordinal()); ++i) {
            all.add(Native.vocabularyName(ordinal(), i));
        }
        names = Collections.unmodifiableList(all);
    }
}
