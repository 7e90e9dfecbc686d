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
    WEIGHTS_INCOMPLETE(-25),
    WEIGHTS_SHAPE(-26),
    WEIGHTS_VALUE(-27),
    WEIGHTS_TRAILING_BYTES(-100),
    WEIGHTS_BYTE_ORDER(-101),
    WEIGHTS_LIMIT(-102),
    WEIGHTS_RESERVED(-103),
    WEIGHTS_GAP(-104),
    WEIGHTS_PADDING(-105),
    WEIGHTS_NAME(-106),
    WEIGHTS_DUPLICATE_NAME(-107),
    WEIGHTS_METADATA(-108),
    WEIGHTS_TENSOR_TYPE(-110),
    WEIGHTS_TENSOR_DIMS(-111),
    WEIGHTS_TENSOR_BYTES(-112),
    WEIGHTS_TENSOR_VALUE(-113),
    WEIGHTS_TENSOR_UNUSED(-114),
    WEIGHTS_NETWORK(-120),
    WEIGHTS_LAYER_OP(-121),
    WEIGHTS_LAYER_ACTIVATION(-122),
    WEIGHTS_LAYER_INPUT(-123),
    WEIGHTS_LAYER_SHAPE(-124),
    WEIGHTS_LAYER_WINDOW(-125),
    WEIGHTS_LAYER_TENSORS(-126),
    WEIGHTS_PACKED_SIZE(-130),
    WEIGHTS_PACKED_BLOCK(-131),
    WEIGHTS_PACKED_TABLE(-132),
    WEIGHTS_PACKED_STATE(-133),
    WEIGHTS_PACKED_TRUNCATED(-134),
    WEIGHTS_PACKED_TRAILING(-135),
    UNSUPPORTED_CPU(-40),
    UNSUPPORTED_LAYER(-41),
    INTERNAL(-42),
    LEFT_OUT(-43),
    UNSUPPORTED_LAYOUT(-44),
    TOO_LARGE(-45),
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
