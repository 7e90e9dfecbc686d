/* Uses the API from C. Called by c_program_test.cpp and network_test.cpp. */
#include <mien/mien.h>
#include <string.h>

int mien_c_program(void);
int mien_c_network(const void* file, size_t file_bytes, const float* image, size_t image_bytes,
                   float* features);

int mien_c_program(void) {
  mien_tracker_config config;
  mien_image image;
  mien_result result;
  mien_tracker* tracker = (mien_tracker*)&config; /* must be overwritten */
  size_t bytes = 1;
  mien_tracker_config_default(&config);
  mien_image_default(&image);
  mien_result_default(&result);
  if (config.struct_size != sizeof config || image.struct_size != sizeof image ||
      result.struct_size != sizeof result) {
    return 1;
  }
  if (mien_tracker_create(&config, &tracker, NULL) != MIEN_ERROR_NULL_ARGUMENT || tracker != NULL) {
    return 2;
  }
  if (mien_tracker_required_bytes(&config, &bytes, NULL) != MIEN_ERROR_NULL_ARGUMENT ||
      bytes != 0) {
    return 3;
  }
  return strcmp(mien_control_name(MIEN_CONTROL_JAW_OPEN), "jawOpen") == 0 ? 0 : 4;
}

/* The example of mien_network. */
int mien_c_network(const void* file, size_t file_bytes, const float* image, size_t image_bytes,
                   float* features) {
  mien_weights_config files;
  mien_weights* weights = NULL;
  mien_network_config config;
  mien_network* network = NULL;
  mien_shape shape;
  const float* output = NULL;
  mien_network_config_default(&config);
  mien_weights_config_default(&files);
  files.files[0] = file;
  files.file_bytes[0] = file_bytes;
  if (mien_weights_create(&files, &weights, NULL) != MIEN_OK) {
    return 3;
  }
  config.weights = weights;
  config.name = "encoder";
  if (mien_network_create(&config, &network, NULL) != MIEN_OK) {
    return 1;
  }
  mien_weights_destroy(weights); /* the network keeps them */
  memcpy(mien_network_input(network, NULL), image, image_bytes);
  if (mien_network_run(network) != MIEN_OK) {
    return 2;
  }
  output = mien_network_output(network, 0, &shape);
  memcpy(features, output, (size_t)shape.channels * sizeof(float));
  mien_network_destroy(network);
  return 0;
}
