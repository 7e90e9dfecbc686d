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
      return "a value is out of its range";
    case MIEN_ERROR_ALIGNMENT:
      return "weights, memory or samples are not aligned as they must be";
    case MIEN_ERROR_MEMORY_TOO_SMALL:
      return "the memory is smaller than what is to be put into it";
    case MIEN_ERROR_OUT_OF_MEMORY:
      return "the allocator has no memory";
    case MIEN_ERROR_UNSUPPORTED_LOD:
      return "this level of detail is not supported";
    case MIEN_ERROR_SEVERAL_FACES:
      return "only a tracker of one face can do this";
    case MIEN_ERROR_NO_AUDIONET:
      return "the tracker has no weights for sound";
    case MIEN_ERROR_WEIGHTS_NOT_MIEN:
      return "the weights are not a .mien file";
    case MIEN_ERROR_WEIGHTS_VERSION:
      return "the weight file has an unsupported format version";
    case MIEN_ERROR_WEIGHTS_TRUNCATED:
      return "the weight file is truncated";
    case MIEN_ERROR_WEIGHTS_CHECKSUM:
      return "the weight file is damaged: wrong checksum";
    case MIEN_ERROR_WEIGHTS_MALFORMED:
      return "the weight file breaks the rules of its format";
    case MIEN_ERROR_WEIGHTS_INCOMPLETE:
      return "the weight file lacks a network or constant that is needed";
    case MIEN_ERROR_WEIGHTS_SHAPE:
      return "a network or constant in the weight file has the wrong shape";
    case MIEN_ERROR_WEIGHTS_NOT_PACKED:
      return "these are no packed weights";
    case MIEN_ERROR_UNSUPPORTED_CPU:
      return "no allowed tier of kernels runs on this CPU";
    case MIEN_ERROR_UNSUPPORTED_LAYER:
      return "a layer has no kernel in the allowed tiers";
    case MIEN_ERROR_INTERNAL:
      return "a fault of mien itself";
    case MIEN_ERROR_LEFT_OUT:
      return "this build of mien was made without that part";
    case MIEN_ERROR_IMAGE_FORMAT:
      return "the image format is unknown";
    case MIEN_ERROR_IMAGE_SIZE:
      return "the image's width, height or pixel aspect is out of range";
    case MIEN_ERROR_IMAGE_STRIDE:
      return "an image stride is smaller than what a row needs";
    case MIEN_ERROR_IMAGE_PLANE:
      return "an image plane is NULL";
    case MIEN_ERROR_IMAGE_ROTATION:
      return "the image rotation is not 0, 90, 180 or 270";
    case MIEN_ERROR_IMAGE_CAMERA:
      return "the image's focal length or principal point is out of range";
    case MIEN_ERROR_AUDIO_FORMAT:
      return "the format of the sound's samples is unknown";
    case MIEN_ERROR_AUDIO_RATE:
      return "the sound's sample rate is out of range";
    case MIEN_ERROR_AUDIO_CHANNELS:
      return "the sound's number of channels is out of range";
    case MIEN_ERROR_AUDIO_SAMPLES:
      return "samples of the sound are NULL";
    case MIEN_ERROR_IMAGE_REGION:
      return "the image's region of interest is empty, beyond the image, or at an odd place in YUV";
    case MIEN_ERROR_AUDIO_QUEUE_FULL:
      return "there is no room for more sound to wait";
    case MIEN_ERROR_NEUTRAL_FORMAT:
      return "not a neutral file";
    case MIEN_ERROR_NEUTRAL_VERSION:
      return "the neutral file has an unsupported format version";
    case MIEN_ERROR_NEUTRAL_DAMAGED:
      return "the neutral file is damaged";
  }
  return "unknown status";
}
