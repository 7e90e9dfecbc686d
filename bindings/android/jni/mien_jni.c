/* The functions of org.mien.Native on mien.h. The Java classes have checked the sizes of buffers
 * and arrays. */
#include <jni.h>
#include <mien/mien.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#define NATIVE(result, name) JNIEXPORT result JNICALL Java_org_mien_Native_##name
#define UNUSED_CLASS JNIEnv *env, jclass unused

enum { kBlock = 8, kInterleaved = 4 }; /* the layout of mien_network */

static mien_tracker* tracker_of(jlong handle) { return (mien_tracker*)(intptr_t)handle; }
static mien_network* network_of(jlong handle) { return (mien_network*)(intptr_t)handle; }

static mien_weights* weights_of(jlong handle) { return (mien_weights*)(intptr_t)handle; }

/* Sets message[0] to the line of an error, behind the name of its file. */
static jint describe(JNIEnv* env, mien_status status, const mien_error_detail* error,
                     jobjectArray names, jobjectArray message) {
  char line[256];
  char text[1024];
  if (status == MIEN_OK) return status;
  mien_error_message(error, line, sizeof line);
  snprintf(text, sizeof text, "%s", line);
  if (error->file >= 0 && error->file < (*env)->GetArrayLength(env, names)) {
    jstring name = (*env)->GetObjectArrayElement(env, names, error->file);
    const char* path = (*env)->GetStringUTFChars(env, name, NULL);
    if (path != NULL) {
      snprintf(text, sizeof text, "%.700s: %s", path, line);
      (*env)->ReleaseStringUTFChars(env, name, path);
    }
  }
  (*env)->SetObjectArrayElement(env, message, 0, (*env)->NewStringUTF(env, text));
  return status;
}

static uint64_t clock_ns(void* user) {
  struct timespec now;
  (void)user;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (uint64_t)now.tv_sec * 1000000000u + (uint64_t)now.tv_nsec;
}

NATIVE(jstring, version)(UNUSED_CLASS) {
  (void)unused;
  return (*env)->NewStringUTF(env, mien_version());
}

NATIVE(jstring, statusString)(UNUSED_CLASS, jint status) {
  (void)unused;
  return (*env)->NewStringUTF(env, mien_status_string((mien_status)status));
}

NATIVE(jintArray, landmarkGroup)(UNUSED_CLASS, jint group) {
  jint range[2];
  jintArray array = (*env)->NewIntArray(env, 2);
  (void)unused;
  range[1] = mien_landmark_group_range(group, &range[0]);
  if (array != NULL) (*env)->SetIntArrayRegion(env, array, 0, 2, range);
  return array;
}

NATIVE(jint, vocabularySize)(UNUSED_CLASS, jint vocabulary) {
  (void)env, (void)unused;
  return mien_vocabulary_size(vocabulary);
}

NATIVE(jstring, vocabularyName)(UNUSED_CLASS, jint vocabulary, jint index) {
  (void)unused;
  return (*env)->NewStringUTF(env, mien_vocabulary_name(vocabulary, index));
}

NATIVE(jint, vocabularyValues)
(UNUSED_CLASS, jint vocabulary, jfloatArray controls, jfloatArray values) {
  float from[MIEN_CONTROL_COUNT], to[64];
  const jsize count = (*env)->GetArrayLength(env, values);
  (void)unused;
  if (count > 64) return MIEN_ERROR_OUT_OF_RANGE;
  (*env)->GetFloatArrayRegion(env, controls, 0, MIEN_CONTROL_COUNT, from);
  const mien_status status = mien_vocabulary_values(vocabulary, from, to, count);
  if (status == MIEN_OK) (*env)->SetFloatArrayRegion(env, values, 0, count, to);
  return status;
}

static void* place_of(JNIEnv* env, jobject buffer) {
  return buffer == NULL ? NULL : (*env)->GetDirectBufferAddress(env, buffer);
}
static size_t bytes_of(JNIEnv* env, jobject buffer) {
  return buffer == NULL ? 0 : (size_t)(*env)->GetDirectBufferCapacity(env, buffer);
}

NATIVE(jint, createWeights)
(UNUSED_CLASS, jobjectArray files, jobjectArray names, jlongArray handle, jobjectArray message) {
  mien_weights_config config;
  mien_error_detail error;
  mien_weights* weights = NULL;
  (void)unused;
  mien_weights_config_default(&config);
  mien_error_detail_default(&error);
  const jsize count = (*env)->GetArrayLength(env, files); /* Weights.java limits it */
  for (jsize i = 0; i < count && i < MIEN_MAX_WEIGHT_FILES; ++i) {
    jobject file = (*env)->GetObjectArrayElement(env, files, i);
    config.files[i] = place_of(env, file);
    config.file_bytes[i] = bytes_of(env, file);
  }
  const mien_status status = mien_weights_create(&config, &weights, &error);
  const jlong made = (jlong)(intptr_t)weights;
  (*env)->SetLongArrayRegion(env, handle, 0, 1, &made);
  return describe(env, status, &error, names, message);
}

NATIVE(void, destroyWeights)(UNUSED_CLASS, jlong weights) {
  (void)env, (void)unused;
  mien_weights_destroy(weights_of(weights));
}

NATIVE(jint, createTracker)
(UNUSED_CLASS, jlong weights, jobjectArray names, jintArray integers, jfloatArray floats,
 jlongArray handle, jobjectArray message) {
  mien_tracker_config config;
  mien_error_detail error;
  mien_tracker* tracker = NULL;
  jint integer[6];
  jfloat number[3];
  (void)unused;
  (*env)->GetIntArrayRegion(env, integers, 0, 6, integer);
  (*env)->GetFloatArrayRegion(env, floats, 0, 3, number);
  mien_tracker_config_default(&config);
  mien_error_detail_default(&error);
  config.weights = weights_of(weights);
  config.lod = integer[0];
  config.max_faces = integer[1];
  config.smoothing = integer[2];
  config.audio_queue_samples = integer[3];
  config.max_lod = integer[4];
  config.audio = integer[5];
  config.budget_ms = number[0];
  if (number[1] != 0) config.horizontal_fov = number[1];
  config.voice_strength = number[2];
  config.clock_ns = clock_ns;
  const mien_status status = mien_tracker_create(&config, &tracker, &error);
  const jlong made = (jlong)(intptr_t)tracker;
  (*env)->SetLongArrayRegion(env, handle, 0, 1, &made);
  return describe(env, status, &error, names, message);
}

NATIVE(void, destroyTracker)(UNUSED_CLASS, jlong tracker) {
  (void)env, (void)unused;
  mien_tracker_destroy(tracker_of(tracker));
}

/* In the order of Image.integers(). */
enum {
  kFormat,
  kWidth,
  kHeight,
  kRowStride0,
  kRowStride1,
  kRowStride2,
  kChromaPixelStride,
  kRotation,
  kMirrored,
  kFullRange,
  kMatrix,
  kRegion,
  kPlane0Bytes = kRegion + 4,
  kPlane1Bytes,
  kIntegers
};

NATIVE(jint, pushVideo)
(UNUSED_CLASS, jlong tracker, jobject plane0, jobject plane1, jobject plane2, jbyteArray array,
 jintArray integers, jfloatArray floats, jlong time_ns) {
  mien_image image;
  jint integer[kIntegers];
  jfloat real[4]; /* in the order of Image.floats */
  jbyte* pixels = NULL;
  (void)unused;
  (*env)->GetIntArrayRegion(env, integers, 0, kIntegers, integer);
  (*env)->GetFloatArrayRegion(env, floats, 0, 4, real);
  mien_image_default(&image);
  image.format = integer[kFormat];
  image.width = integer[kWidth];
  image.height = integer[kHeight];
  memcpy(image.row_stride_bytes, integer + kRowStride0, sizeof image.row_stride_bytes);
  image.chroma_pixel_stride_bytes = integer[kChromaPixelStride];
  image.rotation = integer[kRotation];
  image.mirrored = integer[kMirrored];
  image.full_range = integer[kFullRange];
  image.yuv_matrix = integer[kMatrix];
  memcpy(image.region, integer + kRegion, sizeof image.region);
  image.focal_length_px = real[0];
  image.principal_x = real[1];
  image.principal_y = real[2];
  image.pixel_aspect = real[3];
  if (array == NULL) {
    image.planes[0] = place_of(env, plane0);
    image.planes[1] = place_of(env, plane1);
    image.planes[2] = place_of(env, plane2);
  } else {
    pixels = (*env)->GetPrimitiveArrayCritical(env, array, NULL);
    if (pixels == NULL) return MIEN_ERROR_OUT_OF_MEMORY;
    image.planes[0] = pixels;
    image.planes[1] = pixels + integer[kPlane0Bytes];
    image.planes[2] = pixels + integer[kPlane0Bytes] + integer[kPlane1Bytes];
  }
  const mien_status status = mien_tracker_push_video(tracker_of(tracker), &image, time_ns);
  if (pixels != NULL) (*env)->ReleasePrimitiveArrayCritical(env, array, pixels, JNI_ABORT);
  return status;
}

NATIVE(jint, advance)(UNUSED_CLASS, jlong tracker, jlong time_ns) {
  (void)env, (void)unused;
  return mien_tracker_advance(tracker_of(tracker), time_ns);
}

typedef mien_status (*AudioFunction)(mien_tracker*, const mien_audio*, int64_t);

static jint with_audio(JNIEnv* env, jlong tracker, jfloatArray samples, jint frames, jint channels,
                       jint sample_rate, jlong time_ns, AudioFunction function) {
  mien_audio audio;
  jfloat* place = (*env)->GetPrimitiveArrayCritical(env, samples, NULL);
  if (place == NULL) return MIEN_ERROR_OUT_OF_MEMORY;
  mien_audio_default(&audio);
  audio.sample_rate = sample_rate;
  audio.channels = channels;
  audio.frames = (size_t)frames;
  audio.samples[0] = place;
  const mien_status status = function(tracker_of(tracker), &audio, time_ns);
  (*env)->ReleasePrimitiveArrayCritical(env, samples, place, JNI_ABORT);
  return status;
}

NATIVE(jint, pushAudio)
(UNUSED_CLASS, jlong tracker, jfloatArray samples, jint frames, jint channels, jint sample_rate,
 jlong time_ns) {
  (void)unused;
  return with_audio(env, tracker, samples, frames, channels, sample_rate, time_ns,
                    mien_tracker_push_audio);
}

NATIVE(jint, queueAudio)
(UNUSED_CLASS, jlong tracker, jfloatArray samples, jint frames, jint channels, jint sample_rate,
 jlong time_ns) {
  (void)unused;
  return with_audio(env, tracker, samples, frames, channels, sample_rate, time_ns,
                    mien_tracker_queue_audio);
}

NATIVE(jint, setAudioOffset)(UNUSED_CLASS, jlong tracker, jlong offset_ns) {
  (void)env, (void)unused;
  return mien_tracker_set_audio_offset(tracker_of(tracker), offset_ns);
}

NATIVE(jint, setMix)(UNUSED_CLASS, jlong tracker, jint control, jfloat audio, jfloat video) {
  (void)env, (void)unused;
  return mien_tracker_set_mix(tracker_of(tracker), control, audio, video);
}

NATIVE(jint, setLod)(UNUSED_CLASS, jlong tracker, jint lod) {
  (void)env, (void)unused;
  return mien_tracker_set_lod(tracker_of(tracker), lod);
}

NATIVE(jint, faceCount)(UNUSED_CLASS, jlong tracker) {
  (void)env, (void)unused;
  return mien_tracker_face_count(tracker_of(tracker));
}

/* In the order of Native.FACE_PROBABILITY .. LANDMARKS. */
typedef struct Numbers {
  float face_probability, voice_activity, box[4], rotation[4], pitch, yaw, roll, translation[3],
      controls[MIEN_CONTROL_COUNT], landmarks[2 * MIEN_LANDMARK_COUNT];
} Numbers;

NATIVE(jint, result)
(UNUSED_CLASS, jlong tracker, jint index, jlongArray longs, jfloatArray floats) {
  mien_result result;
  Numbers numbers;
  (void)unused;
  mien_result_default(&result);
  const mien_status status = index < 0 ? mien_tracker_get_result(tracker_of(tracker), &result)
                                       : mien_tracker_get_face(tracker_of(tracker), index, &result);
  if (status != MIEN_OK) return status;
  const jlong integers[] = {result.status, result.pts_ns, (jlong)result.supported_controls,
                            result.lod,    result.flags,  result.face_id};
  (*env)->SetLongArrayRegion(env, longs, 0, sizeof integers / sizeof *integers, integers);
  numbers.face_probability = result.face_probability;
  numbers.voice_activity = result.voice_activity;
  memcpy(numbers.box, result.box, sizeof numbers.box);
  memcpy(numbers.rotation, result.rotation, sizeof numbers.rotation);
  numbers.pitch = result.pitch;
  numbers.yaw = result.yaw;
  numbers.roll = result.roll;
  memcpy(numbers.translation, result.translation, sizeof numbers.translation);
  memcpy(numbers.controls, result.controls, sizeof numbers.controls);
  memcpy(numbers.landmarks, result.landmarks, sizeof numbers.landmarks);
  (*env)->SetFloatArrayRegion(env, floats, 0, sizeof numbers / sizeof(float),
                              &numbers.face_probability);
  return status;
}

NATIVE(jint, captureNeutral)(UNUSED_CLASS, jlong tracker) {
  (void)env, (void)unused;
  return mien_tracker_capture_neutral(tracker_of(tracker));
}

NATIVE(jint, saveNeutral)(UNUSED_CLASS, jlong tracker, jbyteArray file) {
  jbyte bytes[MIEN_NEUTRAL_BYTES];
  (void)unused;
  const mien_status status =
      mien_tracker_save_neutral(tracker_of(tracker), bytes, sizeof bytes, NULL);
  if (status == MIEN_OK) (*env)->SetByteArrayRegion(env, file, 0, sizeof bytes, bytes);
  return status;
}

NATIVE(jint, loadNeutral)(UNUSED_CLASS, jlong tracker, jbyteArray file) {
  const jsize bytes = (*env)->GetArrayLength(env, file);
  jbyte* place = (*env)->GetPrimitiveArrayCritical(env, file, NULL);
  (void)unused;
  if (place == NULL) return MIEN_ERROR_OUT_OF_MEMORY;
  const mien_status status = mien_tracker_load_neutral(tracker_of(tracker), place, (size_t)bytes);
  (*env)->ReleasePrimitiveArrayCritical(env, file, place, JNI_ABORT);
  return status;
}

NATIVE(jint, reset)(UNUSED_CLASS, jlong tracker) {
  (void)env, (void)unused;
  return mien_tracker_reset(tracker_of(tracker));
}

NATIVE(jint, createNetwork)
(UNUSED_CLASS, jlong weights, jobjectArray names, jstring name, jint height, jint width,
 jlongArray handle, jobjectArray message) {
  mien_network_config config;
  mien_error_detail error;
  mien_network* network = NULL;
  (void)unused;
  mien_network_config_default(&config);
  mien_error_detail_default(&error);
  config.weights = weights_of(weights);
  config.height = height;
  config.width = width;
  config.name = name == NULL ? NULL : (*env)->GetStringUTFChars(env, name, NULL);
  const mien_status status = mien_network_create(&config, &network, &error);
  if (name != NULL) (*env)->ReleaseStringUTFChars(env, name, config.name);
  const jlong made = (jlong)(intptr_t)network;
  (*env)->SetLongArrayRegion(env, handle, 0, 1, &made);
  return describe(env, status, &error, names, message);
}

NATIVE(void, destroyNetwork)(UNUSED_CLASS, jlong network) {
  (void)env, (void)unused;
  mien_network_destroy(network_of(network));
}

NATIVE(void, networkShape)(UNUSED_CLASS, jlong network, jint index, jintArray shape) {
  mien_shape is = {0, 0, 0};
  (void)unused;
  if (index < 0) {
    mien_network_input(network_of(network), &is);
  } else {
    mien_network_output(network_of(network), index, &is);
  }
  const jint numbers[] = {is.channels, is.height, is.width};
  (*env)->SetIntArrayRegion(env, shape, 0, 3, numbers);
}

/* Index of a value of [channels][pixels] in a map with blocks of `step` channels. */
static size_t place_in(int32_t channel, int32_t pixel, int32_t pixels, int32_t step) {
  return ((size_t)(channel / step) * (size_t)pixels + (size_t)pixel) * (size_t)step +
         (size_t)(channel % step);
}

NATIVE(jint, runNetwork)(UNUSED_CLASS, jlong network, jfloatArray input) {
  mien_shape shape;
  float* to = mien_network_input(network_of(network), &shape);
  const int32_t pixels = shape.height * shape.width;
  const int32_t step = shape.channels <= kInterleaved && pixels > 1 ? shape.channels : kBlock;
  const jfloat* from = (*env)->GetPrimitiveArrayCritical(env, input, NULL);
  (void)unused;
  if (from == NULL) return MIEN_ERROR_OUT_OF_MEMORY;
  for (int32_t channel = 0; channel < shape.channels; ++channel) {
    for (int32_t pixel = 0; pixel < pixels; ++pixel)
      to[place_in(channel, pixel, pixels, step)] = from[channel * pixels + pixel];
  }
  (*env)->ReleasePrimitiveArrayCritical(env, input, (void*)from, JNI_ABORT);
  return mien_network_run(network_of(network));
}

NATIVE(jint, networkOutputs)(UNUSED_CLASS, jlong network) {
  (void)env, (void)unused;
  return mien_network_output_count(network_of(network));
}

NATIVE(void, networkOutput)(UNUSED_CLASS, jlong network, jint index, jfloatArray values) {
  mien_shape shape;
  const float* from = mien_network_output(network_of(network), index, &shape);
  const int32_t pixels = shape.height * shape.width;
  jfloat* to = (*env)->GetPrimitiveArrayCritical(env, values, NULL);
  (void)unused;
  if (to == NULL) return;
  for (int32_t channel = 0; channel < shape.channels; ++channel) {
    for (int32_t pixel = 0; pixel < pixels; ++pixel)
      to[channel * pixels + pixel] = from[place_in(channel, pixel, pixels, kBlock)];
  }
  (*env)->ReleasePrimitiveArrayCritical(env, values, to, 0);
}

NATIVE(void, resetNetwork)(UNUSED_CLASS, jlong network) {
  (void)env, (void)unused;
  mien_network_reset(network_of(network));
}
