// Weight files for tests, whose faces are bright discs on a dark background. Their networks are
// linear measurements, so that the expected results are known without training: BaseNet measures
// the disc's centroid and area in its crop; P-Net and R-Net detect a bright centre with a dark
// border. The temporal decoders and some of the features are random.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace mien::tests {

// Bytes with an alignment of 64.
class AlignedBytes {
 public:
  explicit AlignedBytes(std::span<const std::byte> bytes);
  [[nodiscard]] std::span<const std::byte> get() const { return {lines_.data()->bytes, size_}; }

 private:
  struct alignas(64) Line {
    std::byte bytes[64];
  };
  std::vector<Line> lines_;
  std::size_t size_;
};

struct BlobOptions {
  unsigned seed = 1;
  // Added to the logit of the face probability: with 100 everything is a face, with -100 nothing.
  float face_bias = 0.0f;
  float refine_bias = 0.0f;  // added to the logit of R-Net's score
  std::uint64_t supported_controls = 0xfffffffffffffULL;
  std::uint32_t features = 256;  // other values than 256 make the file invalid
  bool with_pose_decoder = true;
  std::uint32_t head_points = 0;  // 0: none; other values than 175 make the file invalid
};

// Diameter of the disc relative to the side of a correct crop.
inline constexpr float kDiscPerCrop = 0.7f;

[[nodiscard]] AlignedBytes blob_basenet(const BlobOptions& options = {});
// All features are random. Landmarks are shifted to the right of BaseNet's by this fraction of the
// crop's side.
inline constexpr float kRefinedBy = 0.02f;
[[nodiscard]] AlignedBytes blob_hifinet(const BlobOptions& options = {});
[[nodiscard]] AlignedBytes blob_proposal(const BlobOptions& options = {});

// Loudness stands for speech: jawOpen and voice activity are 0 for silence and 1 for loud noise, at
// the middle of AudioNet's windows. The other controls of speech are random over time.
[[nodiscard]] AlignedBytes blob_audionet();
inline constexpr std::size_t kSpeechOutputs = 18;
// The same, but the decoder always outputs these values.
[[nodiscard]] AlignedBytes blob_audionet(std::span<const float, kSpeechOutputs> controls);
inline constexpr float kJawAudioWeight = 0.75f;    // mix_audio of jawOpen
inline constexpr float kMouthAudioWeight = 0.5f;   // of the other controls of speech
inline constexpr float kMouthVideoWeight = 0.25f;  // mix_video of all of them

}  // namespace mien::tests
