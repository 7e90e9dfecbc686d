// Stored samples of WAV files -> floats, as WavReader::read has them.
#pragma once

#include <cstddef>
#include <span>

#include "formats/wav.h"

namespace mien::formats {

// `stored` holds samples.size() samples of the format, which is one that WavReader accepts.
void convert_wav_samples(const WavFormat& format, std::span<const std::byte> stored,
                         std::span<float> samples);

}  // namespace mien::formats
