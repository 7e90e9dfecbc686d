package org.mien;

/** An error of the library, with its message. */
public final class MienException extends RuntimeException {
    private static final long serialVersionUID = 1;

    public final Status status;

    MienException(int number) {
        super(Native.statusString(number));
        status = Status.of(number);
    }

    static void check(int number) {
        if (number != 0) {
            throw new MienException(number);
        }
    }
}
