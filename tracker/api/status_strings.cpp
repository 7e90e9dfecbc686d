// One line of English for each status of the C API.
#include <mien/mien.h>

const char* mien_status_string(mien_status status) {
  switch (status) {
    case MIEN_OK:
      return "ok";
    case MIEN_ERROR_NULL_ARGUMENT:
      return "a pointer argument is NULL";
    case MIEN_ERROR_STRUCT_SIZE:
      return "struct_size is too small";
    case MIEN_ERROR_OUT_OF_RANGE:
      return "a value is out of range";
    case MIEN_ERROR_ALIGNMENT:
      return "memory or samples are misaligned";
    case MIEN_ERROR_MEMORY_TOO_SMALL:
      return "the buffer is too small";
    case MIEN_ERROR_OUT_OF_MEMORY:
      return "the allocator returned NULL";
    case MIEN_ERROR_UNSUPPORTED_LOD:
      return "this level of detail is not supported";
    case MIEN_ERROR_SEVERAL_FACES:
      return "this needs a tracker with max_faces = 1";
    case MIEN_ERROR_NO_AUDIONET:
      return "audio is disabled: the tracker has no AudioNet weights";
    case MIEN_ERROR_WEIGHTS_NOT_MIEN:
      return "the weights are not a .mien file";
    case MIEN_ERROR_WEIGHTS_VERSION:
      return "the weight file has an unsupported format version";
    case MIEN_ERROR_WEIGHTS_TRUNCATED:
      return "the weight file is truncated";
    case MIEN_ERROR_WEIGHTS_CHECKSUM:
      return "the weight file is damaged: wrong checksum";
    case MIEN_ERROR_WEIGHTS_INCOMPLETE:
      return "the weight file lacks a required network or constant";
    case MIEN_ERROR_WEIGHTS_SHAPE:
      return "a network or constant in the weight file has the wrong shape";
    case MIEN_ERROR_WEIGHTS_VALUE:
      return "a constant in the weight file is out of range";
    case MIEN_ERROR_WEIGHTS_TRAILING_BYTES:
      return "the weight file has bytes after its end";
    case MIEN_ERROR_WEIGHTS_BYTE_ORDER:
      return "the weight file is not little-endian";
    case MIEN_ERROR_WEIGHTS_LIMIT:
      return "a count or size in the weight file exceeds its limit";
    case MIEN_ERROR_WEIGHTS_RESERVED:
      return "a reserved field of the weight file is not zero";
    case MIEN_ERROR_WEIGHTS_GAP:
      return "a part of the weight file does not follow the previous one";
    case MIEN_ERROR_WEIGHTS_PADDING:
      return "padding in the weight file is not zero";
    case MIEN_ERROR_WEIGHTS_NAME:
      return "a name in the weight file is too long, empty, or has other characters than a-z 0-9 _ "
             ". /";
    case MIEN_ERROR_WEIGHTS_DUPLICATE_NAME:
      return "a name in the weight file is used twice";
    case MIEN_ERROR_WEIGHTS_METADATA:
      return "a metadata value is too long or not plain UTF-8 text";
    case MIEN_ERROR_WEIGHTS_TENSOR_TYPE:
      return "a tensor has an unknown data type";
    case MIEN_ERROR_WEIGHTS_TENSOR_DIMS:
      return "rank or dimensions of a tensor are out of range";
    case MIEN_ERROR_WEIGHTS_TENSOR_BYTES:
      return "the size of a tensor does not match its dimensions and data type";
    case MIEN_ERROR_WEIGHTS_TENSOR_VALUE:
      return "a tensor has NaN or infinity";
    case MIEN_ERROR_WEIGHTS_TENSOR_UNUSED:
      return "a tensor is neither used by a layer nor named";
    case MIEN_ERROR_WEIGHTS_NETWORK:
      return "input, flags, layers or outputs of a network are out of range";
    case MIEN_ERROR_WEIGHTS_LAYER_OP:
      return "the operation of a layer is unknown or not allowed in its network";
    case MIEN_ERROR_WEIGHTS_LAYER_ACTIVATION:
      return "the activation of a layer is unknown or not allowed for its operation";
    case MIEN_ERROR_WEIGHTS_LAYER_INPUT:
      return "an input of a layer is not an earlier value";
    case MIEN_ERROR_WEIGHTS_LAYER_SHAPE:
      return "the output shape of a layer does not match its inputs";
    case MIEN_ERROR_WEIGHTS_LAYER_WINDOW:
      return "kernel, stride, padding or flags of a layer are out of range";
    case MIEN_ERROR_WEIGHTS_LAYER_TENSORS:
      return "the tensors of a layer do not match its operation";
    case MIEN_ERROR_WEIGHTS_PACKED_SIZE:
      return "the unpacked size of a packed weight file is out of range";
    case MIEN_ERROR_WEIGHTS_PACKED_BLOCK:
      return "the size of a block of a packed weight file is out of range";
    case MIEN_ERROR_WEIGHTS_PACKED_TABLE:
      return "a table of a packed weight file is malformed";
    case MIEN_ERROR_WEIGHTS_PACKED_STATE:
      return "a block of a packed weight file is damaged";
    case MIEN_ERROR_WEIGHTS_PACKED_TRUNCATED:
      return "the last block of a packed weight file is incomplete";
    case MIEN_ERROR_WEIGHTS_PACKED_TRAILING:
      return "a packed weight file has bytes after its last block";
    case MIEN_ERROR_UNSUPPORTED_CPU:
      return "no allowed tier runs on this CPU";
    case MIEN_ERROR_UNSUPPORTED_LAYER:
      return "no allowed tier has a kernel for a layer";
    case MIEN_ERROR_INTERNAL:
      return "internal error";
    case MIEN_ERROR_LEFT_OUT:
      return "not compiled in";
    case MIEN_ERROR_UNSUPPORTED_LAYOUT:
      return "a layer other than a convolution reads the interleaved image";
    case MIEN_ERROR_TOO_LARGE:
      return "the maps of the network are too large for this input";
    case MIEN_ERROR_IMAGE_FORMAT:
      return "the image format is unknown";
    case MIEN_ERROR_IMAGE_SIZE:
      return "the image's width, height or pixel aspect is out of range";
    case MIEN_ERROR_IMAGE_STRIDE:
      return "an image stride is shorter than a row";
    case MIEN_ERROR_IMAGE_PLANE:
      return "an image plane is NULL";
    case MIEN_ERROR_IMAGE_ROTATION:
      return "the image rotation is not 0, 90, 180 or 270";
    case MIEN_ERROR_IMAGE_CAMERA:
      return "the image's focal length or principal point is out of range";
    case MIEN_ERROR_AUDIO_FORMAT:
      return "the audio sample format is unknown";
    case MIEN_ERROR_AUDIO_RATE:
      return "the audio sample rate is out of range";
    case MIEN_ERROR_AUDIO_CHANNELS:
      return "the number of audio channels is out of range";
    case MIEN_ERROR_AUDIO_SAMPLES:
      return "a pointer to audio samples is NULL";
    case MIEN_ERROR_IMAGE_REGION:
      return "the image's region of interest is empty, outside the image, or at odd x or y in YUV";
    case MIEN_ERROR_AUDIO_QUEUE_FULL:
      return "the audio queue is full";
    case MIEN_ERROR_NEUTRAL_FORMAT:
      return "the file is not a neutral file";
    case MIEN_ERROR_NEUTRAL_VERSION:
      return "the neutral file has an unsupported format version";
    case MIEN_ERROR_NEUTRAL_DAMAGED:
      return "the neutral file is damaged";
  }
  return "unknown status";
}
