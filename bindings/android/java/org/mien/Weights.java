package org.mien;

import java.io.IOException;
import java.nio.file.Files;
import java.nio.file.Path;

/** The weights of trackers. Several trackers may share them. */
public final class Weights {
    final Model basenet, proposal, hifinet, audionet;

    /**
     * @param basenet for tracking and level of detail 1
     * @param proposal for detection
     * @param hifinet levels of detail 2 to 4; may be null
     * @param audionet for audio; may be null
     */
    public Weights(Model basenet, Model proposal, Model hifinet, Model audionet) {
        this.basenet = basenet;
        this.proposal = proposal;
        this.hifinet = hifinet;
        this.audionet = audionet;
    }

    /** The files of a folder: basenet.mien and proposal.mien, and hifinet.mien and audionet.mien if present. */
    public static Weights open(Path folder) throws IOException {
        return new Weights(Model.open(folder.resolve("basenet.mien")), Model.open(folder.resolve("proposal.mien")),
                optional(folder.resolve("hifinet.mien")), optional(folder.resolve("audionet.mien")));
    }

    private static Model optional(Path path) throws IOException {
        return Files.exists(path) ? Model.open(path) : null;
    }
}
