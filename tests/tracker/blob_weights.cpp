// Writes the weight files of blob_weights.h.
#include "tests/tracker/blob_weights.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <random>
#include <string>

#include "formats/mien_writer.h"

namespace mien::tests {
namespace {

using formats::Array;
using formats::LayerIndex;
using formats::LayerOptions;
using formats::MienWriter;
using formats::NetworkWriter;

constexpr std::uint32_t kCrop = 65;
constexpr std::uint32_t kCell = 5;  // pixels averaged to one cell
constexpr std::uint32_t kStep = 4;  // pixels from cell to cell
constexpr std::uint32_t kGrid = (kCrop - kCell) / kStep + 1;
constexpr std::uint32_t kLandmarks = 175;
constexpr std::uint32_t kControls = 52;
constexpr std::uint32_t kPose = 9;

// Features with a meaning; the others are random.
enum Feature : std::uint32_t { kCentroidX, kCentroidY, kArea, kMeaningful };

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  // Uses the polar method (Marsaglia 1962), because std::normal_distribution differs between
  // standard libraries, and the expected values of tests depend on these networks.
  float normal(float deviation) {
    if (has_other_) {
      has_other_ = false;
      return deviation * other_;
    }
    float x = 0.0f, y = 0.0f, square = 0.0f;
    do {
      x = 2.0f * uniform() - 1.0f;
      y = 2.0f * uniform() - 1.0f;
      square = x * x + y * y;
    } while (square > 1.0f || square == 0.0f);
    const float scale = std::sqrt(-2.0f * std::log(square) / square);
    other_ = x * scale;
    has_other_ = true;
    return deviation * (y * scale);
  }
  std::vector<float> normals(std::size_t count, float deviation) {
    std::vector<float> values(count);
    for (float& value : values) {
      value = normal(deviation);
    }
    return values;
  }

 private:
  float uniform() { return static_cast<float>(engine_()) / 4294967296.0f; }

  std::mt19937 engine_;
  float other_ = 0.0f;
  bool has_other_ = false;
};

Array filled(std::vector<std::uint32_t> shape, const std::function<float(std::size_t)>& value) {
  std::size_t count = 1;
  for (std::uint32_t dim : shape) {
    count *= dim;
  }
  Array array = {std::move(shape), std::vector<float>(count)};
  for (std::size_t i = 0; i < count; ++i) {
    array.values[i] = value(i);
  }
  return array;
}

Array random_array(std::vector<std::uint32_t> shape, float deviation, Random& random) {
  return filled(std::move(shape), [&](std::size_t) { return random.normal(deviation); });
}

LayerOptions activated(formats::LayerActivation activation, float alpha = 0.0f) {
  LayerOptions options;
  options.activation = activation;
  options.alpha = alpha;
  return options;
}

AlignedBytes finished(const MienWriter& writer) {
  std::vector<std::byte> file;
  const mien_error_detail validation = writer.finish(&file);
  if (validation.status != MIEN_OK) {  // no test is meaningful then
    std::fprintf(stderr, "blob_weights: %s\n",
                 mien_status_string(static_cast<mien_status>(validation.status)));
    std::abort();
  }
  return AlignedBytes(file);
}

// Points on an elliptic spiral around the centre, 0.8 high. Without symmetry, so that tests detect
// exchanged coordinates.
Array landmark_template() {
  return filled({kLandmarks, 2}, [](std::size_t i) {
    const auto point = static_cast<float>(i / 2);
    const float radius = 0.1f + 0.3f * point / (kLandmarks - 1);
    const float angle = 0.37f * point;
    return 0.5f + radius * (i % 2 == 0 ? 0.9f * std::cos(angle) : std::sin(angle));
  });
}

// Area of a disc in a correct crop, in cells.
float nominal_area() {
  const float radius = kDiscPerCrop / 2 * kCrop / kStep;
  return static_cast<float>(M_PI) * radius * radius;
}

// Weights over the grid of cell brightness (0 dark, 1 bright) that measure `feature`.
float measure(Feature feature, std::size_t cell) {
  const auto middle = [](std::size_t i) {
    return (static_cast<float>(kStep * i) + 0.5f * kCell) / kCrop - 0.5f;
  };
  switch (feature) {
    case kCentroidX:
      return middle(cell % kGrid) / nominal_area();
    case kCentroidY:
      return middle(cell / kGrid) / nominal_area();
    default:
      return 1.0f / nominal_area();
  }
}

// Pixels -1..1 -> grid of brightness 0..1 in channel 0, random textures in the others -> features.
void add_encoder(MienWriter& writer, const BlobOptions& options, Random& random) {
  constexpr std::uint32_t kChannels = 8;
  constexpr std::uint32_t kWindow = 3 * kCell * kCell;
  NetworkWriter& network = writer.network("encoder", {kCrop, kCrop, 3});
  const Array cells = filled({kChannels, 3, kCell, kCell}, [&](std::size_t i) {
    return i < kWindow ? 0.5f / kWindow : random.normal(0.3f / std::sqrt(float{kWindow}));
  });
  std::vector<float> bias(kChannels, 0.0f);
  bias[0] = 0.5f;
  LayerOptions strided;
  strided.stride_y = strided.stride_x = kStep;
  const LayerIndex grid = network.conv2d(NetworkWriter::kInput, cells, bias, strided);
  constexpr std::uint32_t kInputs = kChannels * kGrid * kGrid;
  const Array mixing = filled({options.features, kInputs}, [&](std::size_t i) {
    const std::size_t input = i % kInputs;
    const std::size_t feature = i / kInputs;
    if (feature < kMeaningful) {
      return input < kGrid * kGrid ? measure(static_cast<Feature>(feature), input) : 0.0f;
    }
    return random.normal(1.0f / std::sqrt(float{kInputs}));
  });
  network.output(network.fully_connected(grid, mixing, std::vector<float>(options.features, 0.0f)));
}

// The template, moved with the centroid and scaled with the area: an area of 1 + 2 e means a scale
// of 1 + e.
void add_landmarks(MienWriter& writer, const BlobOptions& options) {
  NetworkWriter& network = writer.network("landmarks", {1, 1, options.features});
  const Array shape = landmark_template();
  const Array weight = filled({2 * kLandmarks, options.features}, [&](std::size_t i) {
    const std::size_t output = i / options.features;
    const std::size_t feature = i % options.features;
    if (feature == kArea) {
      return 0.5f * (shape.values[output] - 0.5f);
    }
    return feature == (output % 2 == 0 ? kCentroidX : kCentroidY) ? 1.0f : 0.0f;
  });
  std::vector<float> bias = shape.values;
  for (float& value : bias) {
    value -= 0.5f * (value - 0.5f);
  }
  network.output(network.fully_connected(NetworkWriter::kInput, weight, bias));
}

// The template, shifted by kRefinedBy.
void add_refined_landmarks(MienWriter& writer, const BlobOptions& options) {
  NetworkWriter& network = writer.network("landmarks", {1, 1, options.features});
  std::vector<float> bias = landmark_template().values;
  for (std::size_t i = 0; i < bias.size(); i += 2) {
    bias[i] += kRefinedBy;
  }
  const Array weight = filled({2 * kLandmarks, options.features}, [](std::size_t) { return 0.0f; });
  network.output(network.fully_connected(NetworkWriter::kInput, weight, bias));
}

// At least half of the nominal area is a face.
void add_face_probability(MienWriter& writer, const BlobOptions& options) {
  NetworkWriter& network = writer.network("face_probability", {1, 1, options.features});
  const Array weight =
      filled({1, options.features}, [](std::size_t i) { return i == kArea ? 20.0f : 0.0f; });
  network.output(network.fully_connected(NetworkWriter::kInput, weight,
                                         {-10.0f + options.face_bias},
                                         activated(formats::LayerActivation::kSigmoid)));
}

void add_decoder(MienWriter& writer, const std::string& name, const BlobOptions& options,
                 const std::vector<float>& output_bias, formats::LayerActivation activation,
                 Random& random) {
  constexpr std::uint32_t kWidth = 16;
  NetworkWriter& network = writer.network(name, {1, 1, options.features});
  // Draws in separate statements, because compilers evaluate arguments in different orders.
  const std::vector<float> conv_bias = random.normals(kWidth, 0.1f);
  const Array taps = random_array({kWidth, options.features, 2}, 0.05f, random);
  const std::vector<float> gate_bias = random.normals(4 * kWidth, 0.3f);
  const Array of_state = random_array({4 * kWidth, kWidth}, 0.3f, random);
  const Array of_input = random_array({4 * kWidth, kWidth}, 0.3f, random);
  LayerIndex x = network.causal_conv(NetworkWriter::kInput, taps, conv_bias,
                                     activated(formats::LayerActivation::kLeakyRelu, 0.1f));
  x = network.lstm(x, of_input, of_state, gate_bias);
  const auto outputs = static_cast<std::uint32_t>(output_bias.size());
  x = network.fully_connected(x, random_array({outputs, kWidth}, 0.3f, random), output_bias,
                              activated(activation));
  network.output(x);
}

void add_controls_decoder(MienWriter& writer, const BlobOptions& options, Random& random) {
  add_decoder(writer, "controls_decoder", options, std::vector<float>(kControls, 0.5f),
              formats::LayerActivation::kClamp01, random);
  writer.constant("control_supported", filled({kControls}, [&](std::size_t i) {
                    return static_cast<float>(options.supported_controls >> i & 1u);
                  }));
}

// A window of 12 x 12 cells of `cell` pixels. A face has bright 8 x 8 cells in the centre and a
// dark border: logit 16 for a perfect face, -8 for a uniform window.
void add_window_network(MienWriter& writer, const std::string& name, std::uint16_t cell,
                        bool any_size, float bias) {
  constexpr std::uint32_t kCells = 12;
  NetworkWriter& network = writer.network(name, {kCells * cell, kCells * cell, 3}, any_size);
  LayerOptions strided;
  strided.stride_y = strided.stride_x = cell;
  const float per_cell = static_cast<float>(3 * cell * cell);
  const LayerIndex grey = network.conv2d(
      NetworkWriter::kInput,
      filled({8, 3, cell, cell},
             [&](std::size_t i) { return i < 3 * cell * cell ? 1.0f / per_cell : 0.0f; }),
      std::vector<float>(8, 0.0f), strided);
  const auto inside = [](std::size_t at) { return at >= 2 && at < 10; };
  LayerOptions every_other;
  every_other.stride_y = every_other.stride_x = 2;
  const LayerIndex contrast = network.conv2d(
      grey,
      filled({8, 8, kCells, kCells},
             [&](std::size_t i) {
               if (i >= kCells * kCells) {
                 return 0.0f;
               }
               const bool bright = inside(i % kCells) && inside(i / kCells);
               return bright ? 1.0f / 64.0f : -1.0f / 80.0f;  // sums to 2 for a perfect face
             }),
      std::vector<float>(8, 0.0f), every_other);
  const Array logit = filled({1, 8}, [](std::size_t i) { return i == 0 ? 12.0f : 0.0f; });
  network.output(network.pointwise(contrast, logit, {-8.0f + bias},
                                   activated(formats::LayerActivation::kSigmoid)));
  network.output(network.pointwise(contrast, filled({3, 8}, [](std::size_t) { return 0.0f; }),
                                   {0.0f, 0.0f, 0.0f}));
}

constexpr std::uint32_t kEmbedding = 80;
constexpr std::uint32_t kSpeechControls = kSpeechOutputs;

// Embedding 0 is the loudness: -0.85 for silence, about 1 for noise at a third of full scale.
void add_audio_encoder(MienWriter& writer, Random& random) {
  constexpr std::uint32_t kCoefficients = 26, kAudioFeatures = 5 * kCoefficients;
  constexpr std::size_t kMiddle = 2 * kCoefficients;  // c0 of the middle window
  NetworkWriter& network = writer.network("encoder", {1, 1, kAudioFeatures});
  std::vector<float> bias(kEmbedding, 0.0f);
  bias[0] = 1.5f;
  const Array weight = filled({kEmbedding, kAudioFeatures}, [&](std::size_t i) {
    if (i < kAudioFeatures) {
      return i == kMiddle ? 0.025f : 0.0f;
    }
    return random.normal(0.003f);
  });
  network.output(network.fully_connected(NetworkWriter::kInput, weight, bias));
}

void add_speech(MienWriter& writer, Random& random) {
  NetworkWriter& network = writer.network("controls_decoder", {1, 1, kEmbedding});
  std::vector<float> bias(kSpeechControls, 0.5f);
  bias[0] = 0.0f;
  const Array weight = filled({kSpeechControls, kEmbedding, 2}, [&](std::size_t i) {
    if (i < 2 * kEmbedding) {
      return i == 1 ? 1.0f : 0.0f;  // jawOpen is the current loudness
    }
    return random.normal(0.05f);
  });
  network.output(network.causal_conv(NetworkWriter::kInput, weight, bias,
                                     activated(formats::LayerActivation::kClamp01)));
}

void add_constant_speech(MienWriter& writer, std::span<const float, kSpeechOutputs> controls) {
  NetworkWriter& network = writer.network("controls_decoder", {1, 1, kEmbedding});
  const Array weight = filled({kSpeechControls, kEmbedding}, [](std::size_t) { return 0.0f; });
  network.output(network.fully_connected(NetworkWriter::kInput, weight,
                                         {controls.begin(), controls.end()},
                                         activated(formats::LayerActivation::kClamp01)));
}

void add_activity(MienWriter& writer) {
  NetworkWriter& network = writer.network("activity_decoder", {1, 1, kEmbedding});
  const Array weight =
      filled({2, kEmbedding}, [](std::size_t i) { return i == kEmbedding ? 8.0f : 0.0f; });
  network.output(
      network.softmax(network.fully_connected(NetworkWriter::kInput, weight, {0.0f, 0.0f})));
}

// Indices of the controls that audio drives.
void add_mix(MienWriter& writer) {
  constexpr std::size_t kJawOpen = 17;
  constexpr std::size_t kMouth[] = {14, 18, 19, 20, 29, 30, 31, 32, 33,
                                    34, 35, 36, 37, 38, 39, 40, 51};
  const auto weights = [&](float jaw, float mouth, float others) {
    Array array = filled({kControls}, [&](std::size_t) { return others; });
    array.values[kJawOpen] = jaw;
    for (const std::size_t control : kMouth) {
      array.values[control] = mouth;
    }
    return array;
  };
  writer.constant("mix_audio", weights(kJawAudioWeight, kMouthAudioWeight, 0.0f));
  writer.constant("mix_video", weights(kMouthVideoWeight, kMouthVideoWeight, 1.0f));
}

}  // namespace

AlignedBytes::AlignedBytes(std::span<const std::byte> bytes)
    : lines_(bytes.size() / sizeof(Line) + 1), size_(bytes.size()) {
  std::copy(bytes.begin(), bytes.end(), lines_.data()->bytes);
}

AlignedBytes blob_basenet(const BlobOptions& options) {
  Random random(options.seed);
  MienWriter writer;
  add_encoder(writer, options, random);
  add_landmarks(writer, options);
  add_face_probability(writer, options);
  add_controls_decoder(writer, options, random);
  if (options.with_pose_decoder) {
    std::vector<float> frontal(kPose, 0.0f);
    frontal[0] = frontal[4] = 1.0f;
    add_decoder(writer, "pose_decoder", options, frontal, formats::LayerActivation::kNone, random);
  }
  writer.constant("landmark_template", landmark_template());
  if (options.head_points > 0) {
    writer.constant("head_points", random_array({options.head_points, 3}, 0.1f, random));
  }
  return finished(writer);
}

AlignedBytes blob_hifinet(const BlobOptions& options) {
  constexpr std::uint32_t kRows = 129, kColumns = 109, kSide = 9, kChannels = 8;
  constexpr std::uint32_t kCells = (kRows / kSide) * (kColumns / kSide);
  Random random(options.seed + 1000);
  MienWriter writer;
  NetworkWriter& network = writer.network("encoder", {kRows, kColumns, 3});
  LayerOptions strided;
  strided.stride_y = strided.stride_x = kSide;
  const LayerIndex cells = network.conv2d(NetworkWriter::kInput,
                                          random_array({kChannels, 3, kSide, kSide}, 0.05f, random),
                                          std::vector<float>(kChannels, 0.0f), strided);
  network.output(network.fully_connected(
      cells, random_array({options.features, kChannels * kCells}, 0.02f, random),
      std::vector<float>(options.features, 0.0f)));
  add_refined_landmarks(writer, options);
  add_controls_decoder(writer, options, random);
  return finished(writer);
}

AlignedBytes blob_audionet() {
  Random random(77);
  MienWriter writer;
  add_audio_encoder(writer, random);
  add_speech(writer, random);
  add_activity(writer);
  add_mix(writer);
  return finished(writer);
}

AlignedBytes blob_audionet(std::span<const float, kSpeechOutputs> controls) {
  Random random(77);
  MienWriter writer;
  add_audio_encoder(writer, random);
  add_constant_speech(writer, controls);
  add_activity(writer);
  add_mix(writer);
  return finished(writer);
}

AlignedBytes blob_proposal(const BlobOptions& options) {
  MienWriter writer;
  add_window_network(writer, "pnet", 1, true, 0.0f);
  add_window_network(writer, "rnet", 2, false, options.refine_bias);
  return finished(writer);
}

}  // namespace mien::tests
