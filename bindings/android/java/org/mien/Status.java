package org.mien;

/** Statuses of the library: mien_status of mien.h. */
public enum Status {
    OK(0),
    NULL_ARGUMENT(-1),
    STRUCT_SIZE(-2),
    OUT_OF_RANGE(-3),
    ALIGNMENT(-4),
    MEMORY_TOO_SMALL(-5),
    OUT_OF_MEMORY(-6),
    UNSUPPORTED_LOD(-7),
    SEVERAL_FACES(-8),
    NO_AUDIONET(-9),
    WEIGHTS_NOT_MIEN(-20),
    WEIGHTS_VERSION(-21),
    WEIGHTS_TRUNCATED(-22),
    WEIGHTS_CHECKSUM(-23),
    WEIGHTS_MALFORMED(-24),
    WEIGHTS_INCOMPLETE(-25),
    WEIGHTS_SHAPE(-26),
    WEIGHTS_NOT_PACKED(-27),
    UNSUPPORTED_CPU(-40),
    UNSUPPORTED_LAYER(-41),
    INTERNAL(-42),
    LEFT_OUT(-43),
    IMAGE_FORMAT(-60),
    IMAGE_SIZE(-61),
    IMAGE_STRIDE(-62),
    IMAGE_PLANE(-63),
    IMAGE_ROTATION(-64),
    IMAGE_CAMERA(-65),
    AUDIO_FORMAT(-66),
    AUDIO_RATE(-67),
    AUDIO_CHANNELS(-68),
    AUDIO_SAMPLES(-69),
    IMAGE_REGION(-70),
    AUDIO_QUEUE_FULL(-71),
    NEUTRAL_FORMAT(-80),
    NEUTRAL_VERSION(-81),
    NEUTRAL_DAMAGED(-82),
    /** A status of a newer library. */
    UNKNOWN(Integer.MIN_VALUE);

    /** As in mien.h. */
    public final int number;

    Status(int number) {
        this.number = number;
    }

    static Status of(int number) {
        for (Status status : values()) {
            if (status.number == number) {
                return status;
            }
        }
        return UNKNOWN;
    }
}
