// Implements `mien track DIR --out DIR`, which tracks all recordings of a folder in parallel.
#pragma once

#include <string>

#include "apps/mien/tracking/track.h"

namespace mien::app {

struct BatchOptions {
  TrackOptions each;  // except input, outputs and messages
  std::string folder;
  std::string out;       // created if missing
  int jobs = 0;          // files at a time; 0: one per core
  bool reports = false;  // write a report for each file as well
  bool again = false;    // process files with existing outputs as well
  bool json = false;     // print the summary as JSON
};

// Whether the ending of a name is that of a video or audio file.
bool is_recording(const std::string& path);

// Tracks every recording in the folder and its subfolders. Outputs have the same names with the
// ending of the format: a/b.mp4 becomes OUT/a/b.mp4.csv, or .html for reports. Skips files whose
// outputs exist and are newer. Prints a table to standard output. Throws Failure(kExitSomeFailed)
// if a file failed.
void track_folder(const BatchOptions& options);

}  // namespace mien::app
