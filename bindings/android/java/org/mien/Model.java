package org.mien;

import java.io.IOException;
import java.io.InputStream;
import java.nio.ByteBuffer;
import java.nio.channels.FileChannel;
import java.nio.file.Path;

/** A weight file in aligned memory. Trackers and networks may share one. */
public final class Model {
    private static final int ALIGNMENT = 64;

    final ByteBuffer bytes;

    private Model(ByteBuffer bytes) {
        this.bytes = bytes;
    }

    /** Maps a file without a copy. */
    public static Model open(Path path) throws IOException {
        try (FileChannel channel = FileChannel.open(path)) {
            return new Model(channel.map(FileChannel.MapMode.READ_ONLY, 0, channel.size()));
        }
    }

    /** Reads a stream to its end, for example an asset of an Android application. */
    public static Model read(InputStream stream) throws IOException {
        java.io.ByteArrayOutputStream all = new java.io.ByteArrayOutputStream();
        byte[] some = new byte[1 << 16];
        for (int n = stream.read(some); n >= 0; n = stream.read(some)) {
            all.write(some, 0, n);
        }
        return of(all.toByteArray());
    }

    /** Copies bytes of any alignment. */
    public static Model of(byte[] data) {
        ByteBuffer memory = ByteBuffer.allocateDirect(data.length + ALIGNMENT);
        int first = (int) ((ALIGNMENT - Native.address(memory) % ALIGNMENT) % ALIGNMENT);
        memory.position(first).limit(first + data.length);
        ByteBuffer bytes = memory.slice();
        bytes.put(data).rewind();
        return new Model(bytes);
    }
}
