package org.mien;

/** The library refused; the message is its own. */
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
