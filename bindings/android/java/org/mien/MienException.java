package org.mien;

/** An error of the library, with its message. */
public final class MienException extends RuntimeException {
    private static final long serialVersionUID = 1;

    public final Status status;

    MienException(int number) {
        super(Native.statusString(number));
        status = Status.of(number);
    }

    private MienException(int number, String message) {
        super(message);
        status = Status.of(number);
    }

    /** message: [0] is the message of a native function. */
    static void check(int number, String[] message) {
        if (number != 0) {
            throw new MienException(number, message[0]);
        }
    }

    static void check(int number) {
        if (number != 0) {
            throw new MienException(number);
        }
    }
}
