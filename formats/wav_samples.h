// Converts stored samples of WAV files to floats, as specified at WavReader::read.
#pragma once

#include <cstddef>
#include <span>

#include "formats/wav.h"

namespace mien::formats {

// `stored` holds samples.size() samples of a format that WavReader accepts.
void convert_wav_samples(const WavFormat& format, std::span<const std::byte> stored,
                         std::span<float> samples);

}  // namespace mien::formats
