package org.mien;

import java.io.IOException;
import java.io.InputStream;
import java.nio.ByteBuffer;
import java.nio.channels.FileChannel;
import java.nio.file.Files;
import java.nio.file.Path;
import java.util.ArrayList;
import java.util.List;

/**
 * Opened weight files. Any number of trackers and networks may share them, and keep what they use after close. Each file is a weight
 * file, a packed one, or a bundle of several, in any order.
 */
public final class Weights implements AutoCloseable {
    private static final int MAX_FILES = 8;

    private final ByteBuffer[] files; // used in place, and kept alive as long as this object
    final String[] names;
    private long handle;

    private Weights(List<ByteBuffer> files, List<String> names) {
        if (files.size() > MAX_FILES) {
            throw new IllegalArgumentException("files: too many (got " + files.size() + ", expected 8 at most)");
        }
        this.files = files.toArray(new ByteBuffer[0]);
        this.names = names.toArray(new String[0]);
        long[] made = new long[1];
        String[] message = new String[1];
        MienException.check(Native.createWeights(this.files, this.names, made, message), message);
        handle = made[0];
    }

    /** A file, or a folder: its basenet.mien and proposal.mien, and hifinet.mien and audionet.mien if present. Maps without a copy. */
    public static Weights open(Path path) throws IOException {
        List<Path> paths = new ArrayList<>();
        if (Files.isRegularFile(path)) {
            paths.add(path);
        } else {
            paths.add(path.resolve("basenet.mien"));
            paths.add(path.resolve("proposal.mien"));
            for (String name : new String[] {"hifinet.mien", "audionet.mien"}) {
                if (Files.exists(path.resolve(name))) {
                    paths.add(path.resolve(name));
                }
            }
        }
        List<ByteBuffer> files = new ArrayList<>();
        List<String> names = new ArrayList<>();
        for (Path one : paths) {
            try (FileChannel channel = FileChannel.open(one)) {
                files.add(channel.map(FileChannel.MapMode.READ_ONLY, 0, channel.size()));
            }
            names.add(one.toString());
        }
        return new Weights(files, names);
    }

    /** Reads streams to their ends, for example assets of an Android application. */
    public static Weights read(InputStream... streams) throws IOException {
        List<byte[]> all = new ArrayList<>();
        for (InputStream stream : streams) {
            java.io.ByteArrayOutputStream bytes = new java.io.ByteArrayOutputStream();
            byte[] some = new byte[1 << 16];
            for (int n = stream.read(some); n >= 0; n = stream.read(some)) {
                bytes.write(some, 0, n);
            }
            all.add(bytes.toByteArray());
        }
        return of(all.toArray(new byte[0][]));
    }

    /** Copies bytes. */
    public static Weights of(byte[]... files) {
        List<ByteBuffer> copies = new ArrayList<>();
        List<String> names = new ArrayList<>();
        for (byte[] file : files) {
            ByteBuffer copy = ByteBuffer.allocateDirect(file.length);
            copy.put(file).rewind();
            copies.add(copy);
            names.add("weights[" + names.size() + "]");
        }
        return new Weights(copies, names);
    }

    /** Trackers and networks keep the weights that they use. */
    @Override
    public synchronized void close() {
        Native.destroyWeights(handle);
        handle = 0;
    }

    synchronized long handle() {
        if (handle == 0) {
            throw new IllegalStateException("the weights are closed");
        }
        return handle;
    }
}
