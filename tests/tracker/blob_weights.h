// Weight files for tests, in which a bright disc on a dark ground plays the face. Their networks
// are linear measurements by design, so that what the tracker must answer is known without
// training: BaseNet measures the disc's centroid and area in its crop, P-Net and R-Net answer to a
// bright middle in a dark frame. The temporal decoders, and some of the features, are random.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace mien::tests {

// Bytes at a multiple of 64.
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
  // Added to the logit of the face probability, which else is that of a disc: +-100 makes
  // everything or nothing a face.
  float face_bias = 0.0f;
  float refine_bias = 0.0f;  // the same of R-Net's score
  std::uint64_t supported_controls = 0xfffffffffffffULL;
  std::uint32_t features = 256;  // another number than 256 makes an unusable file
  bool with_pose_decoder = true;
  std::uint32_t head_points = 0;  // 0: the file has none; another number than 175 makes it unusable
};

// The disc's diameter is this share of the side of its crop, when the crop is right.
inline constexpr float kDiscPerCrop = 0.7f;

[[nodiscard]] AlignedBytes blob_basenet(const BlobOptions& options = {});
// All features random; landmarks lie to the right of BaseNet's by this share of the crop's side.
inline constexpr float kRefinedBy = 0.02f;
[[nodiscard]] AlignedBytes blob_hifinet(const BlobOptions& options = {});
[[nodiscard]] AlignedBytes blob_proposal(const BlobOptions& options = {});

// Loudness plays the voice: jawOpen and voice activity are 0 for silence, 1 for loud noise, and
// tell of the middle of AudioNet's windows. The other controls of speech are random, over time.
[[nodiscard]] AlignedBytes blob_audionet();
inline constexpr std::size_t kSpeechOutputs = 18;
// The same, but its decoder always answers with these values.
[[nodiscard]] AlignedBytes blob_audionet(std::span<const float, kSpeechOutputs> controls);
inline constexpr float kJawByEar = 0.75f;    // weight of the sound for jawOpen
inline constexpr float kMouthByEar = 0.5f;   // for the others
inline constexpr float kMouthByEye = 0.25f;  // weight of the picture for all of them

}  // namespace mien::tests
