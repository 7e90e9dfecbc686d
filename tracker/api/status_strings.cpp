// One line of English for each status of the C API.
#include <mien/mien.h>

namespace {

struct Text {
  mien_status status;
  const char* text;
};

constexpr Text kTexts[] = {
    {MIEN_OK, "ok"},
    {MIEN_ERROR_NULL_ARGUMENT, "a pointer argument is NULL"},
    {MIEN_ERROR_STRUCT_SIZE, "struct_size is too small"},
    {MIEN_ERROR_OUT_OF_RANGE, "a value is out of range"},
    {MIEN_ERROR_ALIGNMENT, "memory or samples are misaligned"},
    {MIEN_ERROR_MEMORY_TOO_SMALL, "the buffer is too small"},
    {MIEN_ERROR_OUT_OF_MEMORY, "the allocator returned NULL"},
    {MIEN_ERROR_UNSUPPORTED_LOD, "this level of detail is not supported"},
    {MIEN_ERROR_SEVERAL_FACES, "this needs a tracker with max_faces = 1"},
    {MIEN_ERROR_NO_AUDIONET, "audio is disabled: the tracker has no AudioNet weights"},
    {MIEN_ERROR_WEIGHTS_NOT_MIEN, "the weights are not a .mien file"},
    {MIEN_ERROR_WEIGHTS_VERSION, "the weight file has an unsupported format version"},
    {MIEN_ERROR_WEIGHTS_TRUNCATED, "the weight file is truncated"},
    {MIEN_ERROR_WEIGHTS_CHECKSUM, "the weight file is damaged: wrong checksum"},
    {MIEN_ERROR_WEIGHTS_INCOMPLETE, "the weight file lacks a required network or constant"},
    {MIEN_ERROR_WEIGHTS_SHAPE, "a network or constant in the weight file has the wrong shape"},
    {MIEN_ERROR_WEIGHTS_VALUE, "a constant in the weight file is out of range"},
    {MIEN_ERROR_WEIGHTS_TRAILING_BYTES, "the weight file has bytes after its end"},
    {MIEN_ERROR_WEIGHTS_BYTE_ORDER, "the weight file is not little-endian"},
    {MIEN_ERROR_WEIGHTS_LIMIT, "a count or size in the weight file exceeds its limit"},
    {MIEN_ERROR_WEIGHTS_RESERVED, "a reserved field of the weight file is not zero"},
    {MIEN_ERROR_WEIGHTS_GAP, "a part of the weight file does not follow the previous one"},
    {MIEN_ERROR_WEIGHTS_PADDING, "padding in the weight file is not zero"},
    {MIEN_ERROR_WEIGHTS_NAME,
     "a name in the weight file is too long, empty, or has other characters than a-z 0-9 _ "
     ". /"},
    {MIEN_ERROR_WEIGHTS_DUPLICATE_NAME, "a name in the weight file is used twice"},
    {MIEN_ERROR_WEIGHTS_METADATA, "a metadata value is too long or not plain UTF-8 text"},
    {MIEN_ERROR_WEIGHTS_TENSOR_TYPE, "a tensor has an unknown data type"},
    {MIEN_ERROR_WEIGHTS_TENSOR_DIMS, "rank or dimensions of a tensor are out of range"},
    {MIEN_ERROR_WEIGHTS_TENSOR_BYTES,
     "the size of a tensor does not match its dimensions and data type"},
    {MIEN_ERROR_WEIGHTS_TENSOR_VALUE, "a tensor has NaN or infinity"},
    {MIEN_ERROR_WEIGHTS_TENSOR_UNUSED, "a tensor is neither used by a layer nor named"},
    {MIEN_ERROR_WEIGHTS_NETWORK, "input, flags, layers or outputs of a network are out of range"},
    {MIEN_ERROR_WEIGHTS_LAYER_OP,
     "the operation of a layer is unknown or not allowed in its network"},
    {MIEN_ERROR_WEIGHTS_LAYER_ACTIVATION,
     "the activation of a layer is unknown or not allowed for its operation"},
    {MIEN_ERROR_WEIGHTS_LAYER_INPUT, "an input of a layer is not an earlier value"},
    {MIEN_ERROR_WEIGHTS_LAYER_SHAPE, "the output shape of a layer does not match its inputs"},
    {MIEN_ERROR_WEIGHTS_LAYER_WINDOW,
     "kernel, stride, padding or flags of a layer are out of range"},
    {MIEN_ERROR_WEIGHTS_LAYER_TENSORS, "the tensors of a layer do not match its operation"},
    {MIEN_ERROR_WEIGHTS_PACKED_SIZE, "the unpacked size of a packed weight file is out of range"},
    {MIEN_ERROR_WEIGHTS_PACKED_BLOCK,
     "the size of a block of a packed weight file is out of range"},
    {MIEN_ERROR_WEIGHTS_PACKED_TABLE, "a table of a packed weight file is malformed"},
    {MIEN_ERROR_WEIGHTS_PACKED_STATE, "a block of a packed weight file is damaged"},
    {MIEN_ERROR_WEIGHTS_PACKED_TRUNCATED, "the last block of a packed weight file is incomplete"},
    {MIEN_ERROR_WEIGHTS_PACKED_TRAILING, "a packed weight file has bytes after its last block"},
    {MIEN_ERROR_UNSUPPORTED_CPU, "no allowed tier runs on this CPU"},
    {MIEN_ERROR_UNSUPPORTED_LAYER, "no allowed tier has a kernel for a layer"},
    {MIEN_ERROR_INTERNAL, "internal error"},
    {MIEN_ERROR_LEFT_OUT, "not compiled in"},
    {MIEN_ERROR_UNSUPPORTED_LAYOUT, "a layer other than a convolution reads the interleaved image"},
    {MIEN_ERROR_TOO_LARGE, "the maps of the network are too large for this input"},
    {MIEN_ERROR_IMAGE_FORMAT, "the image format is unknown"},
    {MIEN_ERROR_IMAGE_SIZE, "the image's width, height or pixel aspect is out of range"},
    {MIEN_ERROR_IMAGE_STRIDE, "an image stride is shorter than a row"},
    {MIEN_ERROR_IMAGE_PLANE, "an image plane is NULL"},
    {MIEN_ERROR_IMAGE_ROTATION, "the image rotation is not 0, 90, 180 or 270"},
    {MIEN_ERROR_IMAGE_CAMERA, "the image's focal length or principal point is out of range"},
    {MIEN_ERROR_AUDIO_FORMAT, "the audio sample format is unknown"},
    {MIEN_ERROR_AUDIO_RATE, "the audio sample rate is out of range"},
    {MIEN_ERROR_AUDIO_CHANNELS, "the number of audio channels is out of range"},
    {MIEN_ERROR_AUDIO_SAMPLES, "a pointer to audio samples is NULL"},
    {MIEN_ERROR_IMAGE_REGION,
     "the image's region of interest is empty, outside the image, or at odd x or y in YUV"},
    {MIEN_ERROR_AUDIO_QUEUE_FULL, "the audio queue is full"},
    {MIEN_ERROR_NEUTRAL_FORMAT, "the file is not a neutral file"},
    {MIEN_ERROR_NEUTRAL_VERSION, "the neutral file has an unsupported format version"},
    {MIEN_ERROR_NEUTRAL_DAMAGED, "the neutral file is damaged"},
};

}  // namespace

const char* mien_status_string(mien_status status) {
  for (const Text& known : kTexts) {
    if (known.status == status) {
      return known.text;
    }
  }
  return "unknown status";
}
