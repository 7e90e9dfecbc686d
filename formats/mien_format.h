// The byte layout of weight files (.mien), version 1.3, as specified in docs/format.md. All numbers
// are little-endian; enumerators are never reused.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

static_assert(std::endian::native == std::endian::little,
              "mien requires a little-endian machine, because it reads weight files in place");

namespace mien::formats {

inline constexpr std::uint8_t kMagic[8] = {0x89, 'M', 'I', 'E', 'N', 0x0D, 0x0A, 0x1A};
inline constexpr std::uint16_t kMajorVersion = 1;
inline constexpr std::uint16_t kMinorVersion = 3;
inline constexpr std::uint32_t kEndianTag = 0x01020304;

// Alignment of sections, of tensors, and of the file in memory.
inline constexpr std::size_t kFileAlignment = 64;

// Limits, which keep every sum in a valid file far below 2^63.
inline constexpr std::uint32_t kMaxNetworks = 64;
inline constexpr std::uint32_t kMaxLayers = 1024;
inline constexpr std::uint32_t kMaxTensors = 4096;
inline constexpr std::uint32_t kMaxMetadata = 256;
inline constexpr std::uint32_t kMaxNameBytes = 63;
inline constexpr std::uint32_t kMaxKeyBytes = 63;
inline constexpr std::uint32_t kMaxValueBytes = 4096;
inline constexpr std::uint32_t kMaxRank = 4;
inline constexpr std::uint32_t kMaxDim = 1u << 20;
inline constexpr std::uint64_t kMaxFileBytes = std::uint64_t{1} << 31;
inline constexpr std::uint64_t kMaxMapElems = std::uint64_t{1} << 28;  // per blocked map
inline constexpr std::uint32_t kMaxOutputs = 14;
inline constexpr std::uint32_t kMaxWideOutputs =
    4;  // up to this many outputs are stored as 32-bit numbers
inline constexpr std::uint16_t kMaxKernel = 15;
inline constexpr std::uint16_t kMaxStride = 15;
inline constexpr float kMinInputBound = 0x1p-64f, kMaxInputBound = 0x1p64f;

inline constexpr std::uint32_t kNoIndex = 0xFFFFFFFF;  // no tensor, no second input

enum class LayerOp : std::uint16_t {
  kConv2d = 1,
  kDepthwise = 2,
  kPointwise = 3,
  kFullyConnected = 4,
  kCausalConv = 5,
  kLstm = 6,
  kMaxPool = 7,
  kAdd = 8,
  kActivation = 9,
  kSoftmax = 10,
  kGlobalAveragePool = 11,  // this and the following: since version 1.1
  kConcat = 12,
  kSlice = 13,
  kMultiply = 14,  // this and the following: since version 1.2
  kDivide = 15,
  kBroadcastAdd = 16,
  kResize = 17,
  kRearrange = 18,
  kNormalize = 19,
};

enum class LayerActivation : std::uint16_t {
  kNone = 0,
  kRelu = 1,
  kRelu6 = 2,
  kLeakyRelu = 3,  // slope in LayerRecord::alpha
  kPrelu = 4,      // slopes in a tensor
  kSigmoid = 5,
  kTanh = 6,
  kClamp01 = 7,
  kHardSwish = 8,  // this and the following: since version 1.2, kActivation only
  kSwish = 9,
  kGelu = 10,
  kGeluTanh = 11,
  kErf = 12,
  kExp = 13,
  kSqrt = 14,
};

enum class DataType : std::uint16_t {
  kFloat16 = 1,
  kFloat32 = 2,
};

struct FileHeader {
  std::uint8_t magic[8];
  std::uint16_t major_version;
  std::uint16_t minor_version;
  std::uint32_t endian_tag;
  std::uint32_t header_bytes;  // sizeof(FileHeader)
  std::uint32_t network_count;
  std::uint32_t layer_count;
  std::uint32_t tensor_count;
  std::uint32_t metadata_count;
  std::uint32_t string_bytes;
  std::uint64_t total_bytes;
  std::uint64_t data_offset;  // start of the first tensor
  std::uint64_t checksum;     // XXH64 of the whole file with this field 0, seed 0
};

struct StringRef {
  std::uint32_t offset;  // into the string section
  std::uint32_t bytes;
};

struct NetworkRecord {
  StringRef name;
  std::uint32_t input_height, input_width, input_channels;
  std::uint32_t flags;  // kAnySize
  std::uint32_t first_layer;
  std::uint32_t layer_count;
  std::uint32_t output_count;
  // Values of the network (see LayerRecord), unused ones 0. Up to kMaxWideOutputs outputs are
  // 32-bit numbers in two elements each: output_value reads them, output_place is their index.
  std::uint16_t outputs[kMaxOutputs];
};
[[nodiscard]] constexpr std::uint32_t output_place(std::uint32_t output_count, std::uint32_t i) {
  return output_count <= kMaxWideOutputs ? 2 * i : i;
}
[[nodiscard]] constexpr std::uint32_t output_value(const NetworkRecord& network, std::uint32_t i) {
  return network.outputs[output_place(network.output_count, i)];
}
// kAnySize: the network accepts every input at least as large as the declared one.
inline constexpr std::uint32_t kAnySize = 1;

// A network's values are numbered: 0 is its input, k the output of its k-th layer.
struct LayerRecord {
  std::uint16_t op;
  std::uint16_t activation;
  std::uint32_t input;                    // an earlier value
  std::uint32_t second_input;             // for ops with two inputs, else kNoIndex
  std::uint32_t height, width, channels;  // output shape for the declared input
  std::uint16_t kernel_height, kernel_width;
  std::uint16_t stride_height, stride_width;               // kResize: see format.md
  std::uint16_t pad_top, pad_left, pad_bottom, pad_right;  // kSlice: rows and columns removed
  std::uint16_t flags;          // kCeilMode; kResize and kRearrange: see below
  std::uint16_t first_channel;  // kSlice, else 0
  float alpha;
  std::uint32_t weights, bias, slopes;  // tensors, or kNoIndex
  // Since version 1.3: largest magnitude of the inputs of kPointwise, which may have 8 bits; 0 if
  // they need more, and in other layers.
  float input_bound;
};
inline constexpr std::uint16_t kCeilMode = 1;  // pooling: includes a last, partly filled window

// Flags of kResize: ResizeGrid + kResizeGrids * ResizeSampling.
enum class ResizeGrid : std::uint16_t { kHalfPixel = 0, kAsymmetric = 1, kAlignCorners = 2 };
enum class ResizeSampling : std::uint16_t {
  kRoundHalfDown = 0,
  kRoundHalfUp = 1,
  kFloor = 2,
  kCeil = 3,
  kBilinear = 4,
};
inline constexpr std::uint16_t kResizeGrids = 4;
[[nodiscard]] constexpr std::uint16_t resize_flags(ResizeGrid grid, ResizeSampling sampling) {
  return static_cast<std::uint16_t>(static_cast<std::uint16_t>(grid) +
                                    kResizeGrids * static_cast<std::uint16_t>(sampling));
}

// Flags of kRearrange: the order in which the input is read, outermost axis first.
enum class ReadingOrder : std::uint16_t {
  kRowColumnChannel = 0,
  kRowChannelColumn = 1,
  kColumnRowChannel = 2,
  kColumnChannelRow = 3,
  kChannelRowColumn = 4,
  kChannelColumnRow = 5,
};

struct TensorRecord {
  StringRef name;  // empty except for constants
  std::uint16_t type;
  std::uint16_t rank;
  std::uint32_t reserved;
  std::uint32_t dims[kMaxRank];  // unused ones 0
  std::uint64_t offset;          // from the start of the file
  std::uint64_t bytes;
  std::uint32_t reserved_tail[4];
};

struct MetadataRecord {
  StringRef key;
  StringRef value;
};

static_assert(sizeof(FileHeader) == 64);
static_assert(sizeof(NetworkRecord) == 64);
static_assert(sizeof(LayerRecord) == 64);
static_assert(sizeof(TensorRecord) == 64);
static_assert(sizeof(MetadataRecord) == 16);

}  // namespace mien::formats
