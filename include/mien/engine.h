// The C++ interface for custom networks: opens a weight file (.mien, docs/format.md) and runs one
// of its networks. scripts/mien_convert converts ONNX files (docs/convert.md).
//
// In C++:
//
//   mien::WeightFile file;
//   if (file.open(bytes) != mien::EngineStatus::kOk) return;  // std::span<const std::byte>
//   mien::NetworkRunner runner;
//   if (runner.create(file, "encoder") != mien::EngineStatus::kOk) return;
//   for (const std::span<const float> image : images) {
//     std::copy(image.begin(), image.end(), runner.input().begin());
//     runner.run();
//     use(runner.output(0));  // std::span<const float>
//   }
//
// In C (mien/mien.h):
//
//   mien_network_config config;
//   mien_network_config_default(&config);
//   config.file = bytes;  config.file_bytes = size;  config.name = "encoder";
//   mien_network* network = NULL;
//   if (mien_network_create(&config, &network) != MIEN_OK) return 1;
//   for (int i = 0; i < count; ++i) {
//     memcpy(mien_network_input(network, NULL), images[i], image_bytes);
//     if (mien_network_run(network) == MIEN_OK) use(mien_network_output(network, 0, NULL));
//   }
//   mien_network_destroy(network);
//
// Lifetime: `bytes` must be MIEN_ALIGNMENT-aligned (a mapped file is) and must outlive every object
// created from it.
//
// Layout: an input of at most 4 channels and more than one pixel is [h][w][c]. Every other map is
// stored in blocks of 8 channels, [ceil(c/8)][h][w][8], with unused lanes zero. A vector of n
// values is therefore n floats, rounded up to a multiple of 8.
//
// State: temporal layers (causal convolution, LSTM) keep their state in the runner; one `run` is
// one step of the stream. LSTM state below 1e-30 is flushed to zero, because denormal numbers are
// slow.
//
// Threads: one thread at a time may use an object; runners of one file are independent. `run` and
// `reset` neither allocate nor lock. Nothing here throws, prints or does I/O.
//
// Stack: create, required_memory and WeightFile::network use about 70 KB, WeightFile::open and
// WeightFile::layer about 13 KB, `run` about 1 KB.
#pragma once

#include <mien/mien.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace mien {

// Result of a call. Values are never reused.
enum class [[nodiscard]] EngineStatus : std::int32_t{
    kOk = 0,
    kBadFile = 1,            // the weight file violates its format; see WeightFile::fault
    kNoSuchNetwork = 2,      // the file has no network with that name
    kShapeMismatch = 3,      // a layer's declared output shape does not match its input
    kWrongInput = 4,         // the network does not accept the input shape
    kUnsupportedLayout = 5,  // a layer other than a convolution reads the interleaved image
    kNoKernel = 6,  // no allowed tier has a kernel for a layer, or MIEN_TRIM_LAYERS excludes it
    kMemoryTooSmall = 7,  // the caller's memory is smaller than required_memory
    kMisaligned = 8,      // the caller's memory is not MIEN_ALIGNMENT-aligned
    kTooLarge = 9,        // a map would exceed 2^28 floats on that input shape
    kOutOfMemory = 10,    // the allocator returned NULL
};

// Returns a static string of one line that describes the status.
[[nodiscard]] MIEN_API const char* message(EngineStatus status);

// Shape of a map: rows, columns, channels.
struct TensorShape {
  std::int32_t height = 0, width = 0, channels = 0;
  friend bool operator==(const TensorShape&, const TensorShape&) = default;
};

// Describes a network of a file.
struct NetworkInfo {
  std::string_view name;
  TensorShape input;
  bool any_size = false;  // also accepts larger inputs
  std::int32_t layers = 0;
  std::int32_t outputs = 0;
  std::uint64_t parameters = 0;
  std::uint64_t macs = 0;          // multiply-accumulates per run on the declared input
  std::uint64_t weight_bytes = 0;  // in the file
  std::uint64_t session_bytes = 0, arena_bytes = 0;  // RunnerMemory with default options
};

// Describes a layer of a network.
struct LayerInfo {
  const char* op = "";
  const char* activation = "";
  TensorShape output;
  std::int32_t input = 0;          // 0: the network's input, k: the output of the k-th layer
  std::int32_t second_input = -1;  // likewise; -1: none
  std::int32_t kernel[2] = {0, 0}, stride[2] = {0, 0};  // h, w
  // Top, left, bottom, right. For a slice: the rows and columns that it removes.
  std::int32_t padding[4] = {0, 0, 0, 0};
  std::int32_t first_channel = 0;  // slice only
  std::uint64_t parameters = 0;
  std::uint64_t macs = 0;  // multiply-accumulates per run on the declared input
};

// A key and its value from the file's metadata.
struct MetadataInfo {
  std::string_view key, value;
};

// Describes a named constant of a file.
struct ConstantInfo {
  std::string_view name;
  const char* type = "";  // "fp16" or "fp32"
  std::span<const std::uint32_t> dims;
};

// A validated view of a weight file. It owns neither the bytes nor the strings of the infos.
class MIEN_API WeightFile {
 public:
  WeightFile();

  // Validates a file in memory.
  // `bytes`: MIEN_ALIGNMENT-aligned; must outlive this object and every object created from it.
  // Returns kOk; kBadFile (fault() describes the violation at byte fault_offset());
  // kShapeMismatch, kUnsupportedLayout or kTooLarge if a network is inconsistent.
  EngineStatus open(std::span<const std::byte> bytes);
  [[nodiscard]] const char* fault() const { return fault_; }
  [[nodiscard]] std::uint64_t fault_offset() const { return fault_offset_; }

  // The following require an open file. Indices are in [0, count).
  [[nodiscard]] std::int32_t network_count() const;
  [[nodiscard]] NetworkInfo network(std::int32_t index) const;
  [[nodiscard]] LayerInfo layer(std::int32_t network, std::int32_t index) const;
  [[nodiscard]] std::int32_t metadata_count() const;
  [[nodiscard]] MetadataInfo metadata(std::int32_t index) const;
  [[nodiscard]] std::int32_t constant_count() const;
  [[nodiscard]] ConstantInfo constant(std::int32_t index) const;
  [[nodiscard]] std::size_t file_bytes() const;

 private:
  friend class NetworkRunner;
  const char* fault_ = "";
  std::uint64_t fault_offset_ = 0;
  alignas(8) std::byte model_[128];
};

// Memory of a runner, in bytes.
struct RunnerMemory {
  std::size_t session = 0;  // input, outputs and temporal state; not shared
  std::size_t arena = 0;    // intermediate maps; runners that never run at once may share it
};

// One network, ready to run, in memory from an allocator or from the caller.
class MIEN_API NetworkRunner {
 public:
  NetworkRunner() = default;
  ~NetworkRunner();
  NetworkRunner(const NetworkRunner&) = delete;
  NetworkRunner& operator=(const NetworkRunner&) = delete;

  struct Options {
    TensorShape input = {};  // all zero: the declared shape
    // Allowed tiers and MIEN_CPU_FUSED. Half precision is opt-in, because the values of an
    // arbitrary network are unbounded.
    std::uint32_t cpu_mask = MIEN_CPU_ALL & ~MIEN_CPU_HALF;
    mien_allocator allocator = {};  // callbacks NULL: the C library's allocator
  };
  // Prepares a network to run; allocates its memory.
  // Returns kOk; kNoSuchNetwork, kWrongInput, kTooLarge, kNoKernel or kOutOfMemory. On error the
  // runner is empty and owns no memory.
  EngineStatus create(const WeightFile& file, std::string_view network, const Options& options);
  EngineStatus create(const WeightFile& file, std::string_view network) {
    return create(file, network, Options());
  }

  // Like create, but in the caller's memory, which must outlive the runner; calls no allocator.
  // `session`, `arena`: MIEN_ALIGNMENT-aligned, with at least the sizes of required_memory.
  // Also returns kMemoryTooSmall or kMisaligned.
  EngineStatus create_in(const WeightFile& file, std::string_view network, const Options& options,
                         std::span<std::byte> session, std::span<std::byte> arena);
  // Computes the sizes that create_in requires.
  // Returns kOk, kNoSuchNetwork, kWrongInput or kTooLarge.
  static EngineStatus required_memory(const WeightFile& file, std::string_view network,
                                      const Options& options, RunnerMemory& memory);

  // The following require a runner that was created.
  [[nodiscard]] std::span<float> input();  // zero after creation
  [[nodiscard]] TensorShape input_shape() const;
  void run();
  // `run` in parts, to time each: a call of run_step for 0 .. step_count() - 1 in this order equals
  // one `run`. A step computes one layer, or several fused layers.
  struct StepLayers {
    std::int32_t first = 0, count = 0;
  };
  [[nodiscard]] std::int32_t step_count() const;
  [[nodiscard]] StepLayers step_layers(std::int32_t step) const;
  void run_step(std::int32_t step);
  [[nodiscard]] std::int32_t output_count() const;
  [[nodiscard]] std::span<const float> output(
      std::int32_t index) const;  // valid until the next run
  [[nodiscard]] TensorShape output_shape(std::int32_t index) const;
  void reset();  // returns the temporal state to zero

 private:
  void release();

  void* session_ = nullptr;
  void* memory_ = nullptr;  // nullptr for memory of the caller
  mien_allocator allocator_ = {};
};

// Runs `rounds` rounds of fused multiply-adds in registers on the best tier of the mask and returns
// the number of multiply-adds. Benchmarks time it to measure the peak.
MIEN_API std::int64_t run_fma_loop(std::uint32_t cpu_mask, std::int64_t rounds);

}  // namespace mien
