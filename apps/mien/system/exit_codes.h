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
  kExitNoSound = 11,         // the input has no sound, or none that can be read
  kExitSomeFailed = 12,      // of a folder: some of its files failed, the others are done
  kExitDamaged = 13          // the outputs are whole, but lack frames that cannot be decoded
};

struct ExitMeaning {
  ExitCode code;
  const char* meaning;
};

// For the manual page, in the words of docs/cli.md.
inline constexpr ExitMeaning kExitMeanings[] = {
    {kExitOk, "done"},
    {kExitInternal, "a fault of mien itself"},
    {kExitUsage, "wrong usage"},
    {kExitNoInput, "the input does not exist, cannot be read, or is not what is wanted"},
    {kExitNoVideo, "no video stream, or none that can be decoded"},
    {kExitTruncated, "the video or its sound is truncated or damaged"},
    {kExitNoFfmpeg, "ffmpeg or ffprobe is missing"},
    {kExitOutput, "an output cannot be written"},
    {kExitModel, "a model file is missing, damaged, or of another version"},
    {kExitUnsupportedTier, "this CPU cannot run the tier asked for"},
    {kExitNoFace, "mien neutral: no 55 frames in a row show a face"},
    {kExitNoSound, "there is no sound where some was asked for, or none that can be read"},
    {kExitSomeFailed, "some files of a folder failed, the others are done"},
    {kExitDamaged, "done, but frames of the input could not be decoded"},
};

}  // namespace mien::app
