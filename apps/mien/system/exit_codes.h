// Exit codes of the program: a contract, documented in docs/cli.md. Numbers are never reused.
#pragma once

namespace mien::app {

enum ExitCode : int {
  kExitOk = 0,
  kExitInternal = 1,         // an internal error
  kExitUsage = 2,            // unknown option, missing or contradictory arguments
  kExitNoInput = 3,          // the input does not exist or cannot be read
  kExitNoVideo = 4,          // the input has no video stream, or none that can be decoded
  kExitTruncated = 5,        // the video or audio ends before its container declares
  kExitNoFfmpeg = 6,         // the ffmpeg or ffprobe program is missing
  kExitOutput = 7,           // an output cannot be written
  kExitModel = 8,            // a model file is missing, damaged or of another version
  kExitUnsupportedTier = 9,  // this CPU cannot run the requested tier
  kExitNoFace = 10,          // the input shows a face on too few frames for neutral calibration
  kExitNoAudio = 11,         // requested audio is missing or cannot be read
  kExitSomeFailed = 12,      // folder: some files failed, the others are complete
  kExitDamaged = 13  // success, but frames could not be decoded and are missing from the outputs
};

struct ExitMeaning {
  ExitCode code;
  const char* meaning;
};

// Text of the manual page, as in docs/cli.md.
inline constexpr ExitMeaning kExitMeanings[] = {
    {kExitOk, "success"},
    {kExitInternal, "internal error"},
    {kExitUsage, "wrong usage"},
    {kExitNoInput, "the input does not exist or cannot be read, or has the wrong content"},
    {kExitNoVideo, "no video stream that can be decoded"},
    {kExitTruncated, "the video or its audio is truncated or damaged"},
    {kExitNoFfmpeg, "ffmpeg or ffprobe is missing"},
    {kExitOutput, "an output cannot be written"},
    {kExitModel, "a model file is missing, damaged, or of another version"},
    {kExitUnsupportedTier, "this CPU cannot run the requested tier"},
    {kExitNoFace, "mien neutral: fewer than 55 frames in a row show a face"},
    {kExitNoAudio, "requested audio is missing or cannot be read"},
    {kExitSomeFailed, "some files of a folder failed, the others are complete"},
    {kExitDamaged,
     "success, but frames of the input could not be decoded and are missing from the outputs"},
};

}  // namespace mien::app
