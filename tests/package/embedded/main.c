/* Succeeds if a tracker with embedded weights detects no face in a black image. */
#include <mien/mien.h>
#include <mien_weights.h>

int main(void) {
  static const unsigned char black[64 * 64] = {0};
  mien_weights_config files;
  mien_weights* weights = NULL;
  mien_tracker_config config;
  mien_tracker* tracker = NULL;
  mien_image image;
  mien_result result;
  mien_weights_config_default(&files);
  mien_use_embedded_weights(&files);
  if (mien_weights_create(&files, &weights, NULL) != MIEN_OK) return 1;
  mien_tracker_config_default(&config);
  config.weights = weights;
  if (mien_tracker_create(&config, &tracker, NULL) != MIEN_OK) return 2;
  mien_weights_destroy(weights);
  mien_image_default(&image);
  mien_result_default(&result);
  image.format = MIEN_IMAGE_GRAY8;
  image.width = image.height = image.row_stride_bytes[0] = 64;
  image.planes[0] = black;
  if (mien_tracker_push_video(tracker, &image, 0) != MIEN_OK) return 3;
  if (mien_tracker_get_result(tracker, &result) != MIEN_OK) return 4;
  mien_tracker_destroy(tracker);
  return result.frames == 1 && result.status == MIEN_FACE_SEARCHING ? 0 : 5;
}
