// Bring your own network: load a weight file (.mien, docs/format.md) and run one of its networks.
// scripts/convert/onnx_to_mien.py makes such files of ONNX files (docs/convert.md). In C++:
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
// Through the C interface (mien/mien.h):
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
// `bytes` must be MIEN_ALIGNMENT-aligned (a mapped file is) and outlive everything made from it.
//
// Layout: an input of up to 4 channels and more than one pixel is [h][w][c]; every other map is
// stored in blocks of 8 channels, [ceil(c/8)][h][w][8], unused lanes zero. A vector of n values is
// therefore n floats, rounded up to a multiple of 8.
//
// Temporal layers (causal convolution, LSTM) keep what they need of earlier inputs in the runner:
// one `run` is one step of the stream. The LSTM's state is flushed to zero below 1e-30, so that
// silence does not end in denormal numbers, which are slow.
//
// Threads: objects of these classes may be used by one thread at a time; runners of one file are
// independent of each other. `run` and `reset` neither allocate nor lock, and nothing here throws,
// prints or does I/O.
//
// Stack: making a runner, required_memory and WeightFile::network take some 70 KB, opening a file
// and WeightFile::layer some 13 KB, `run` about 1 KB.
#pragma once

#include <mien/mien.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace mien {

// Numbers are never reused.
enum class [[nodiscard]] EngineStatus : std::int32_t{
    kOk = 0,
    kBadFile = 1,            // the weight file breaks a rule of its format
    kNoSuchNetwork = 2,      // the file has no network of that name
    kShapeMismatch = 3,      // a layer's declared output is not what its input gives
    kWrongInput = 4,         // the network does not run on that input shape
    kUnsupportedLayout = 5,  // a layer other than a convolution reads the interleaved image
    kNoKernel = 6,  // no allowed tier has a kernel for a layer, or MIEN_TRIM_LAYERS left it out
    kMemoryTooSmall = 7,  // the caller's memory is less than required_memory
    kMisaligned = 8,      // the caller's memory is not MIEN_ALIGNMENT-aligned
    kTooLarge = 9,        // a map of that input shape would be beyond 2^28 floats
    kOutOfMemory = 10,    // the allocator returned nothing
};

// One line of English, static.
[[nodiscard]] MIEN_API const char* message(EngineStatus status);

struct TensorShape {
  std::int32_t height = 0, width = 0, channels = 0;
  friend bool operator==(const TensorShape&, const TensorShape&) = default;
};

struct NetworkInfo {
  std::string_view name;
  TensorShape input;
  bool any_size = false;  // also runs on larger maps
  std::int32_t layers = 0;
  std::int32_t outputs = 0;
  std::uint64_t parameters = 0;
  std::uint64_t macs = 0;          // multiply-accumulates of one run at the declared size
  std::uint64_t weight_bytes = 0;  // as stored
  std::uint64_t session_bytes = 0, arena_bytes = 0;  // of a runner with default options
};

struct LayerInfo {
  const char* op = "";
  const char* activation = "";
  TensorShape output;
  std::int32_t input = 0;          // 0: the network's input, k: the output of its k-th layer
  std::int32_t second_input = -1;  // the same; -1: none
  std::int32_t kernel[2] = {0, 0}, stride[2] = {0, 0};  // h, w
  // Top, left, bottom, right. Of a slice: rows and columns that it leaves out.
  std::int32_t padding[4] = {0, 0, 0, 0};
  std::int32_t first_channel = 0;  // of a slice
  std::uint64_t parameters = 0;
  std::uint64_t macs = 0;
};

struct MetadataInfo {
  std::string_view key, value;
};

struct ConstantInfo {
  std::string_view name;
  const char* type = "";
  std::span<const std::uint32_t> dims;
};

// A validated view of a weight file. Does not own the bytes, nor what the infos refer to.
class MIEN_API WeightFile {
 public:
  WeightFile();

  // `bytes`: aligned to MIEN_ALIGNMENT; must outlive this object and everything made from it. On
  // kBadFile, `fault` and `fault_offset` say what is wrong where in the file.
  EngineStatus open(std::span<const std::byte> bytes);
  [[nodiscard]] const char* fault() const { return fault_; }
  [[nodiscard]] std::uint64_t fault_offset() const { return fault_offset_; }

  // Of a file that was opened. Indices run from 0 to the count, less one.
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

// What a runner needs, in bytes.
struct RunnerMemory {
  std::size_t session = 0;  // its input, outputs, temporal state: its own
  std::size_t arena = 0;    // maps in between: runners that run in turns may share one
};

// One network ready to run, in memory of its own or of the caller's.
class MIEN_API NetworkRunner {
 public:
  NetworkRunner() = default;
  ~NetworkRunner();
  NetworkRunner(const NetworkRunner&) = delete;
  NetworkRunner& operator=(const NetworkRunner&) = delete;

  struct Options {
    TensorShape input = {};  // all zero: as declared
    // Tiers that may be used, MIEN_CPU_FUSED. Half precision has to be asked for: nobody knows how
    // large the values of a network become.
    std::uint32_t cpu_mask = MIEN_CPU_ALL & ~MIEN_CPU_HALF;
    mien_allocator allocator = {};  // callbacks NULL: the C library's
  };
  // On error the runner is left empty, and nothing stays allocated.
  EngineStatus create(const WeightFile& file, std::string_view network, const Options& options);
  EngineStatus create(const WeightFile& file, std::string_view network) {
    return create(file, network, Options());
  }

  // The same in the caller's memory, both parts MIEN_ALIGNMENT-aligned, which must outlive the
  // runner. The allocator is not called.
  EngineStatus create_in(const WeightFile& file, std::string_view network, const Options& options,
                         std::span<std::byte> session, std::span<std::byte> arena);
  // How large these must be at least.
  static EngineStatus required_memory(const WeightFile& file, std::string_view network,
                                      const Options& options, RunnerMemory& memory);

  // The following need a runner that was created.
  [[nodiscard]] std::span<float> input();  // zeros at first
  [[nodiscard]] TensorShape input_shape() const;
  void run();
  // `run` in parts, to time each: running step 0 .. step_count() - 1 once each, in this order, is
  // one `run`. A step performs one layer, or several where they are fused.
  struct StepLayers {
    std::int32_t first = 0, count = 0;
  };
  [[nodiscard]] std::int32_t step_count() const;
  [[nodiscard]] StepLayers step_layers(std::int32_t step) const;
  void run_step(std::int32_t step);
  [[nodiscard]] std::int32_t output_count() const;
  [[nodiscard]] std::span<const float> output(std::int32_t index) const;  // until the next run
  [[nodiscard]] TensorShape output_shape(std::int32_t index) const;
  void reset();  // temporal state to that of a stream's beginning

 private:
  void release();

  void* session_ = nullptr;
  void* memory_ = nullptr;  // nullptr if it is the caller's
  mien_allocator allocator_ = {};
};

// Runs a loop of fused multiply-adds in registers, `rounds` times, on the best tier of the mask;
// returns how many it did. A benchmark times this to know the peak.
MIEN_API std::int64_t run_fma_loop(std::uint32_t cpu_mask, std::int64_t rounds);

}  // namespace mien
