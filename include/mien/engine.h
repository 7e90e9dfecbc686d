// Bring your own network: load a weight file (.mien, docs/format.md) and run one of its networks.
//
//   mien::WeightFile file;
//   if (file.open(bytes) != mien::EngineStatus::kOk) return;   // bytes: 64-byte aligned, must
//   outlive all mien::NetworkRunner runner; if (runner.create(file, "encoder") !=
//   mien::EngineStatus::kOk) return; std::copy(pixels.begin(), pixels.end(),
//   runner.input().begin()); runner.run(); use(runner.output(0)); // std::span<const float>
//
// Layout: an input of up to 4 channels and more than one pixel is [h][w][c]; every other map is
// stored in blocks of 8 channels, [ceil(c/8)][h][w][8], unused lanes zero. A vector of n values is
// therefore n floats, rounded up to a multiple of 8.
//
// Threads: objects of these classes may be used by one thread at a time. `run` and `reset` neither
// allocate nor lock, and nothing here throws, prints or does I/O.
#pragma once

#include <mien/mien.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace mien {

// Numbers are never reused.
enum class [[nodiscard]] EngineStatus : std::int32_t{
    kOk = 0,         kBadFile = 1,           kNoSuchNetwork = 2, kShapeMismatch = 3,
    kWrongInput = 4, kUnsupportedLayout = 5, kNoKernel = 6,      kMemoryTooSmall = 7,
    kMisaligned = 8, kTooLarge = 9,          kOutOfMemory = 10,
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
  std::uint64_t session_bytes = 0, arena_bytes = 0;  // memory of a runner
};

struct LayerInfo {
  const char* op = "";
  const char* activation = "";
  TensorShape output;
  std::int32_t input = 0,
               second_input = -1;  // values: 0 the network's input, k the output of its k-th layer
  std::int32_t kernel[2] = {0, 0}, stride[2] = {0, 0};  // h, w
  std::int32_t padding[4] = {0, 0, 0, 0};               // top, left, bottom, right
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

// One network ready to run, in memory of its own.
class MIEN_API NetworkRunner {
 public:
  NetworkRunner() = default;
  ~NetworkRunner();
  NetworkRunner(const NetworkRunner&) = delete;
  NetworkRunner& operator=(const NetworkRunner&) = delete;

  struct Options {
    TensorShape input = {};                 // all zero: as declared
    std::uint32_t cpu_mask = MIEN_CPU_ALL;  // tiers that may be used
    mien_allocator allocator = {};          // callbacks NULL: the C library's
  };
  // On error the runner is left empty, and nothing stays allocated.
  EngineStatus create(const WeightFile& file, std::string_view network, const Options& options);
  EngineStatus create(const WeightFile& file, std::string_view network) {
    return create(file, network, Options());
  }

  // The following need a runner that was created.
  [[nodiscard]] std::span<float> input();
  [[nodiscard]] TensorShape input_shape() const;
  void run();
  [[nodiscard]] std::int32_t output_count() const;
  [[nodiscard]] std::span<const float> output(std::int32_t index) const;  // until the next run
  [[nodiscard]] TensorShape output_shape(std::int32_t index) const;
  void reset();  // temporal state to that of a stream's beginning

 private:
  void release();

  void* session_ = nullptr;
  void* memory_ = nullptr;
  mien_allocator allocator_ = {};
};

// Runs a loop of fused multiply-adds in registers, `rounds` times, on the best tier of the mask;
// returns how many it did. A benchmark times this to know the peak.
MIEN_API std::int64_t run_fma_loop(std::uint32_t cpu_mask, std::int64_t rounds);

}  // namespace mien
