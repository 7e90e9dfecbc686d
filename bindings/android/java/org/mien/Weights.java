package org.mien;

import java.io.IOException;
import java.nio.file.Files;
import java.nio.file.Path;

/** What trackers know. They may share one. */
public final class Weights {
    final Model basenet, proposal, hifinet, audionet;

    /**
     * @param basenet landmarks, and level of detail 1
     * @param proposal finds faces
     * @param hifinet levels of detail 2 to 4; may be null
     * @param audionet hears; may be null
     */
    public Weights(Model basenet, Model proposal, Model hifinet, Model audionet) {
        this.basenet = basenet;
        this.proposal = proposal;
        this.hifinet = hifinet;
        this.audionet = audionet;
    }

    /** The files of a folder: basenet.mien and proposal.mien, and the others where they are. */
    public static Weights open(Path folder) throws IOException {
        return new Weights(Model.open(folder.resolve("basenet.mien")), Model.open(folder.resolve("proposal.mien")),
                optional(folder.resolve("hifinet.mien")), optional(folder.resolve("audionet.mien")));
    }

    private static Model optional(Path path) throws IOException {
        return Files.exists(path) ? Model.open(path) : null;
    }
}
