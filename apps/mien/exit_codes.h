// Exit codes of the program: a contract, documented in docs/cli.md. Numbers are never reused.
#pragma once

namespace mien::app {

enum ExitCode : int {
  kExitOk = 0,
  kExitInternal = 1,         // a fault of mien itself
  kExitUsage = 2,            // unknown option, missing or contradictory arguments
  kExitNoInput = 3,          // the input does not exist or cannot be read
  kExitNoVideo = 4,          // the input has no video stream, or none that can be decoded
  kExitTruncated = 5,        // the video ends before its container says it should
  kExitNoFfmpeg = 6,         // the ffmpeg or ffprobe program is missing
  kExitOutput = 7,           // an output cannot be written
  kExitModel = 8,            // a model file is missing, damaged or of another version
  kExitUnsupportedTier = 9,  // this CPU cannot run the tier asked for
  kExitNoFace = 10,          // too little of a face in the input to capture a neutral one
  kExitNoSound = 11          // the input has no sound, or none that can be read
};

}  // namespace mien::app
