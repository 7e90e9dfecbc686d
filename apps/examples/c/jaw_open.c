/* Prints how far the mouth of the face in an image is open, 0 to 1.
 *
 * usage: jaw_open MODELS IMAGE.ppm
 *   MODELS: the folder with basenet.mien and proposal.mien
 *   IMAGE.ppm: created by, for example, ffmpeg -i face.jpg face.ppm */
#include <mien/mien.h>
#include <stdio.h>
#include <stdlib.h>

typedef struct file {
  void* data;
  size_t bytes;
} file;

/* The content of FOLDER/NAME; no data if it cannot be read. */
static file read_file(const char* folder, const char* name) {
  file content = {NULL, 0};
  char path[1024];
  snprintf(path, sizeof path, "%s/%s", folder, name);
  FILE* stream = fopen(path, "rb");
  if (stream == NULL) {
    return content;
  }
  fseek(stream, 0, SEEK_END);
  const long bytes = ftell(stream);
  rewind(stream);
  if (bytes > 0 && (content.data = malloc((size_t)bytes)) != NULL) {
    content.bytes = fread(content.data, 1, (size_t)bytes, stream);
  }
  fclose(stream);
  return content;
}

static mien_weights* open_weights(const char* folder) {
  const file files[] = {read_file(folder, "basenet.mien"), read_file(folder, "proposal.mien")};
  mien_weights_config config;
  mien_weights_config_default(&config);
  config.copy = 1; /* so that the files can be freed below */
  for (int i = 0; i < 2; ++i) {
    config.files[i] = files[i].data;
    config.file_bytes[i] = files[i].bytes;
  }
  mien_weights* weights = NULL;
  mien_error_detail error;
  mien_error_detail_default(&error);
  if (mien_weights_create(&config, &weights, &error) != MIEN_OK) {
    char message[256];
    mien_error_message(&error, message, sizeof message);
    fprintf(stderr, "jaw_open: %s: %s\n", folder, message);
  }
  free(files[0].data);
  free(files[1].data);
  return weights;
}

/* Reads a binary PPM of 8 bits. Returns its pixels, which the caller frees; NULL on error. */
static unsigned char* read_image(const char* path, mien_image* image) {
  FILE* stream = fopen(path, "rb");
  int maximum = 0;
  unsigned char* pixels = NULL;
  if (stream != NULL &&
      fscanf(stream, "P6 %d %d %d", &image->width, &image->height, &maximum) == 3 &&
      fgetc(stream) != EOF && maximum == 255 && image->width > 0 && image->width <= 16384 &&
      image->height > 0 && image->height <= 16384) {
    const size_t bytes = (size_t)image->width * (size_t)image->height * 3;
    pixels = malloc(bytes);
    if (pixels != NULL && fread(pixels, 1, bytes, stream) != bytes) {
      free(pixels);
      pixels = NULL;
    }
  }
  if (stream != NULL) {
    fclose(stream);
  }
  image->format = MIEN_IMAGE_RGB;
  image->planes[0] = pixels;
  image->row_stride_bytes[0] = image->width * 3;
  return pixels;
}

static int track(const mien_weights* weights, const mien_image* image) {
  mien_tracker_config config;
  mien_tracker_config_default(&config);
  config.weights = weights;
  mien_tracker* tracker = NULL;
  mien_result result;
  mien_result_default(&result);
  mien_status status = mien_tracker_create(&config, &tracker, NULL);
  if (status == MIEN_OK) {
    status = mien_tracker_push_video(tracker, image, 0); /* a video passes the time of each image */
  }
  if (status == MIEN_OK) {
    status = mien_tracker_get_result(tracker, &result);
  }
  mien_tracker_destroy(tracker);
  if (status != MIEN_OK) {
    fprintf(stderr, "jaw_open: %s\n", mien_status_string(status));
    return 1;
  }
  if (result.status != MIEN_FACE_TRACKING) {
    puts("no face");
    return 0;
  }
  printf("jawOpen %.2f\n", result.controls[MIEN_CONTROL_JAW_OPEN]);
  return 0;
}

int main(int argc, char** argv) {
  if (argc != 3) {
    fputs("usage: jaw_open MODELS IMAGE.ppm\n", stderr);
    return 2;
  }
  mien_image image;
  mien_image_default(&image);
  unsigned char* pixels = read_image(argv[2], &image);
  if (pixels == NULL) {
    fprintf(stderr, "jaw_open: %s: cannot be read as a binary PPM of 8 bits\n", argv[2]);
    return 1;
  }
  mien_weights* weights = open_weights(argv[1]);
  const int exit_code = weights != NULL ? track(weights, &image) : 1;
  mien_weights_destroy(weights);
  free(pixels);
  return exit_code;
}
