/* usage: main VERSION; succeeds if that is the version and creating a tracker without weights
 * fails. */
#include <mien/mien.h>
#include <string.h>

int main(int argc, char** argv) {
  mien_tracker_config config;
  mien_tracker* tracker = NULL;
  mien_tracker_config_default(&config);
  return argc == 2 && strcmp(argv[1], mien_version()) == 0 &&
                 mien_version_api() == MIEN_API_VERSION &&
                 mien_tracker_create(&config, &tracker, NULL) == MIEN_ERROR_NULL_ARGUMENT
             ? 0
             : 1;
}
