// The .mien weight file, byte for byte; docs/format.md is normative and explains every field.
// All integers and floats are little-endian. Numbers of enumerators are fixed and never reused.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace mien::formats {

static_assert(std::endian::native == std::endian::little,
              "files are read in place, and they are little-endian");

// 0x89 and the line endings expose a transfer that stripped bit 7 or translated text.
inline constexpr std::array<std::uint8_t, 8> kMagic = {0x89, 'M', 'I', 'E', 'N', '\r', '\n', 0x1a};
inline constexpr std::uint16_t kVersionMajor = 1;
inline constexpr std::uint16_t kVersionMinor = 0;
inline constexpr std::uint32_t kEndianTag = 0x01020304;

inline constexpr std::uint64_t kSectionAlignment = 64;  // of sections and tensors in the file
inline constexpr std::uint64_t kBaseAlignment = 16;     // of the file's first byte in memory

// Limits, all inclusive.
inline constexpr std::uint64_t kMaxFileBytes = std::uint64_t{1} << 31;
inline constexpr std::uint32_t kMaxNetworks = 64;
inline constexpr std::uint32_t kMaxLayers = 1024;
inline constexpr std::uint32_t kMaxTensors = 4096;
inline constexpr std::uint32_t kMaxMetadata = 256;
inline constexpr std::uint32_t kMaxPoolBytes = 1u << 21;
inline constexpr std::uint32_t kMaxNameBytes = 63;
inline constexpr std::uint32_t kMaxTextBytes = 4096;
inline constexpr std::uint32_t kMaxDim = 1u << 20;
inline constexpr std::uint32_t kMaxRank = 4;
inline constexpr std::uint32_t kMaxKernel = 32;  // kernel height, width and strides
inline constexpr std::uint32_t kMaxOutputs = 4;  // of a network
inline constexpr std::uint32_t kMaxInterleavedChannels = 4;
inline constexpr std::uint64_t kMaxMapElems = std::uint64_t{1} << 28;  // of one blocked feature map

// Values of references to layers and tensors that are not an index.
inline constexpr std::uint32_t kNone = 0xffffffffu;          // there is none
inline constexpr std::uint32_t kNetworkInput = 0xfffffffeu;  // the network's own input

enum class LayerOp : std::uint16_t {
  kConv2d = 1,
  kDepthwise = 2,
  kPointwise = 3,
  kFullyConnected = 4,
  kCausalConv = 5,  // over time, kernel 2: the previous and the current input vector
  kLstm = 6,
  kMaxPool = 7,
  kAdd = 8,         // y = a + centre slice of b
  kActivation = 9,  // the layer's activation and nothing else
  kSoftmax = 10,    // over channels
};

enum class Activation : std::uint16_t {
  kNone = 0,
  kRelu = 1,
  kRelu6 = 2,
  kLeakyRelu = 3,  // slope for x < 0: `alpha`
  kPrelu = 4,      // slope for x < 0: tensor `slope`, one per channel
  kSigmoid = 5,
  kTanh = 6,
  kClamp01 = 7,
};

enum class DataType : std::uint16_t { kFp16 = 1, kFp32 = 2 };

enum class InputLayout : std::uint8_t {
  kInterleaved = 1,  // [h][w][c], c <= 4
  kBlocked = 2,      // [ceil(c/8)][h][w][8]
};

struct FileHeader {
  std::array<std::uint8_t, 8> magic;
  std::uint16_t version_major;
  std::uint16_t version_minor;
  std::uint32_t endian_tag;
  std::uint32_t header_bytes;
  std::uint32_t network_count;
  std::uint32_t layer_count;
  std::uint32_t tensor_count;
  std::uint32_t metadata_count;
  std::uint32_t pool_bytes;  // names and texts, without the padding behind them
  std::uint64_t data_bytes;  // tensors, with the padding behind each
  std::uint64_t total_bytes;
  std::uint64_t reserved0;
  std::array<std::uint8_t, 32> sha256;  // of the whole file with this field zero
  std::array<std::uint8_t, 32> reserved1;
};

// A string in the pool, without terminator.
struct StringRef {
  std::uint32_t offset;  // from the pool's start
  std::uint32_t bytes;
};

struct Shape {
  std::uint32_t height;
  std::uint32_t width;
  std::uint32_t channels;
  friend bool operator==(const Shape&, const Shape&) = default;
};

struct NetworkRecord {
  StringRef name;
  std::uint32_t first_layer;  // index into the file's layers
  std::uint32_t layer_count;
  Shape input;
  InputLayout input_layout;
  std::uint8_t any_size;  // 1: runs on every height and width not below the declared ones
  std::uint16_t reserved0;
  std::uint32_t output_count;
  std::array<std::uint32_t, kMaxOutputs> outputs;  // layers, counted from first_layer; else kNone
  std::array<std::uint8_t, 12> reserved1;
};

struct Padding {
  std::uint8_t top;
  std::uint8_t left;
  std::uint8_t bottom;
  std::uint8_t right;
  friend bool operator==(const Padding&, const Padding&) = default;
};

struct LayerRecord {
  StringRef name;
  LayerOp op;
  Activation activation;
  float alpha;  // of kLeakyRelu, else 0
  std::array<std::uint32_t, 2>
      inputs;  // earlier layers, counted from first_layer; kNetworkInput; kNone
  Shape output;
  std::uint8_t kernel_height;
  std::uint8_t kernel_width;
  std::uint8_t stride_y;
  std::uint8_t stride_x;
  Padding padding;
  std::uint32_t weight;  // tensors of the file, kNone where the op has none
  std::uint32_t bias;
  std::uint32_t slope;
  std::array<std::uint8_t, 8> reserved;
};

struct TensorRecord {
  StringRef name;  // empty for the tensors of layers
  DataType type;
  std::uint16_t rank;
  std::array<std::uint32_t, kMaxRank> dims;  // outermost first, 1 behind the rank
  std::uint32_t reserved0;
  std::uint64_t data_offset;  // from the file's start
  std::uint64_t data_bytes;   // without the padding behind the tensor
  std::array<std::uint8_t, 16> reserved1;
};

struct MetadataRecord {
  StringRef key;
  StringRef value;
};

static_assert(sizeof(FileHeader) == 128 && std::is_trivial_v<FileHeader>);
static_assert(sizeof(NetworkRecord) == 64 && std::is_trivial_v<NetworkRecord>);
static_assert(sizeof(LayerRecord) == 64 && std::is_trivial_v<LayerRecord>);
static_assert(sizeof(TensorRecord) == 64 && std::is_trivial_v<TensorRecord>);
static_assert(sizeof(MetadataRecord) == 16 && std::is_trivial_v<MetadataRecord>);
static_assert(offsetof(FileHeader, sha256) == 64 && offsetof(NetworkRecord, outputs) == 36 &&
              offsetof(LayerRecord, weight) == 44 && offsetof(TensorRecord, data_offset) == 32);

}  // namespace mien::formats
