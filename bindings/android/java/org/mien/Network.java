package org.mien;

/** A custom network of a weight file, for example converted from ONNX. Must be closed. */
public final class Network implements AutoCloseable {
    private final Weights weights; // kept alive as long as this object
    private long handle;

    /** A map: [channels][height][width]. */
    public static final class Map {
        public final int channels, height, width;
        public final float[] values;

        private Map(int[] shape) {
            channels = shape[0];
            height = shape[1];
            width = shape[2];
            values = new float[channels * height * width];
        }
    }

    /** The first network of the weights. */
    public Network(Weights weights) {
        this(weights, null, 0, 0);
    }

    /** name: of a network of the weights; null: the first. height, width: for networks that accept several sizes; 0: the declared size. */
    public Network(Weights weights, String name, int height, int width) {
        this.weights = weights;
        long[] made = new long[1];
        String[] message = new String[1];
        MienException.check(Native.createNetwork(weights.handle(), weights.names, name, height, width, made, message), message);
        handle = made[0];
    }

    /** Shape of the input: channels, height, width. */
    public synchronized int[] inputShape() {
        int[] shape = new int[3];
        Native.networkShape(open(), -1, shape);
        return shape;
    }

    /** Runs the network once, one step of a temporal network. Input and outputs are [channels][height][width]. */
    public synchronized Map[] run(float[] input) {
        int[] shape = inputShape();
        if (input.length != shape[0] * shape[1] * shape[2]) {
            throw new IllegalArgumentException("input: wrong length (got " + input.length + ", expected " + shape[0] + " x " + shape[1] + " x " + shape[2] + ")");
        }
        MienException.check(Native.runNetwork(handle, input));
        Map[] outputs = new Map[Native.networkOutputs(handle)];
        for (int i = 0; i < outputs.length; ++i) {
            Native.networkShape(handle, i, shape);
            outputs[i] = new Map(shape);
            Native.networkOutput(handle, i, outputs[i].values);
        }
        return outputs;
    }

    /** Resets the state of temporal layers to the start of a stream. */
    public synchronized void reset() {
        Native.resetNetwork(open());
    }

    @Override
    public synchronized void close() {
        Native.destroyNetwork(handle);
        handle = 0;
    }

    private long open() {
        if (handle == 0) {
            throw new IllegalStateException("the network is closed");
        }
        return handle;
    }
}
