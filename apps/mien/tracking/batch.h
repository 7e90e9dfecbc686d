// `mien track DIR --out DIR`: all videos and sounds of a folder, several at once.
#pragma once

#include <string>

#include "apps/mien/tracking/track.h"

namespace mien::app {

struct BatchOptions {
  TrackOptions each;  // but for its input, its outputs and its word about them
  std::string folder;
  std::string out;       // made where it is not there
  int jobs = 0;          // files at once; 0: as many as there are cores
  bool reports = false;  // a page of each, too
  bool again = false;    // also what is done already
  bool json = false;     // the summary
};

// Whether the name's ending is one of a video or a sound that a folder is searched for.
bool is_recording(const std::string& path);

// Tracks every recording in the folder and below it, into files of the same names with the format's
// ending behind them: a/b.mp4 becomes OUT/a/b.mp4.csv, and .html for reports. Files whose outputs
// are all there, and newer, are done already. Ends with a table on standard output; throws
// Failure(kExitSomeFailed) when that names a file that failed.
void track_folder(const BatchOptions& options);

}  // namespace mien::app
