// Writes .mien files, for tools and tests; not part of the library. Same bytes for the same input
// as scripts/train/mien_file.py.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "formats/file_status.h"
#include "formats/mien_format.h"

namespace mien::formats {

// Floats in C order, as PyTorch lays out its parameters.
struct Array {
  std::vector<std::uint32_t> shape;
  std::vector<float> values;
};

// A layer of the network it came from, or that network's input.
using LayerIndex = std::uint32_t;

struct LayerOptions {
  Activation activation = Activation::kNone;
  float alpha = 0;            // of kLeakyRelu
  std::vector<float> slopes;  // of kPrelu, one per output channel
  std::uint8_t stride_y = 1;
  std::uint8_t stride_x = 1;
  Padding padding{};
  std::string name;  // default: network/index
};

class MienWriter;

// Adds layers in order. Every function returns the new layer's index. Arguments that do not fit
// together are reported by MienWriter::finish(). An empty bias is a bias of zeros.
class NetworkWriter {
 public:
  static constexpr LayerIndex kInput = kNetworkInput;

  // weight [out, in, kernel_h, kernel_w], bias [out]
  LayerIndex conv2d(LayerIndex x, const Array& weight, const std::vector<float>& bias,
                    const LayerOptions& options = {});
  // weight [channels, 1, kernel_h, kernel_w], bias [channels]
  LayerIndex depthwise(LayerIndex x, const Array& weight, const std::vector<float>& bias,
                       const LayerOptions& options = {});
  // weight [out, in] or [out, in, 1, 1], bias [out]
  LayerIndex pointwise(LayerIndex x, const Array& weight, const std::vector<float>& bias,
                       const LayerOptions& options = {});
  // weight [out, in * h * w], inputs in the order channel, row, column; bias [out]
  LayerIndex fully_connected(LayerIndex x, const Array& weight, const std::vector<float>& bias,
                             const LayerOptions& options = {});
  // weight [out, in, 2], the previous input first; bias [out]
  LayerIndex causal_conv(LayerIndex x, const Array& weight, const std::vector<float>& bias,
                         const LayerOptions& options = {});
  // weight_ih [4 * hidden, in], weight_hh [4 * hidden, hidden], gates i, f, g, o; bias [4 *
  // hidden], the sum of PyTorch's two
  LayerIndex lstm(LayerIndex x, const Array& weight_ih, const Array& weight_hh,
                  const std::vector<float>& bias, const LayerOptions& options = {});
  LayerIndex max_pool(LayerIndex x, std::uint8_t kernel_h, std::uint8_t kernel_w,
                      const LayerOptions& options = {});
  // a + the centre slice of b
  LayerIndex add(LayerIndex a, LayerIndex b, const LayerOptions& options = {});
  LayerIndex activation(LayerIndex x, const LayerOptions& options);
  LayerIndex softmax(LayerIndex x, const LayerOptions& options = {});
  void output(LayerIndex x);

 private:
  friend class MienWriter;
  struct Layer {
    LayerRecord record;
    std::string name;
    std::vector<std::vector<std::uint16_t>> tensors;  // weight, bias, slope: those it has
  };
  NetworkWriter(std::string name, Shape input, InputLayout layout, bool any_size);

  Shape shape_of(LayerIndex x);
  LayerRecord begin(LayerOp op, LayerIndex x, const LayerOptions& options);
  LayerIndex dense(LayerRecord record, const std::vector<float>& values, std::size_t outputs,
                   const std::vector<std::int64_t>& reduction, const std::vector<float>& bias,
                   const LayerOptions& options);
  LayerIndex append(LayerRecord record, std::vector<std::vector<std::uint16_t>> tensors,
                    const LayerOptions& options);
  bool require(bool condition, FileStatus status);

  std::string name_;
  NetworkRecord record_{};
  std::vector<Layer> layers_;
  FileStatus status_ = FileStatus::kOk;
};

class MienWriter {
 public:
  // The reference stays valid until the writer is destroyed. Default layout: interleaved for up to
  // four channels, else blocked.
  NetworkWriter& network(std::string name, Shape input, bool any_size = false);
  NetworkWriter& network(std::string name, Shape input, InputLayout layout, bool any_size = false);
  void constant(std::string name, const Array& array, DataType type = DataType::kFp32);
  void metadata(std::string key, std::string value);

  // The whole file, or where the description is at fault. A file handed out always validates.
  FileError finish(std::vector<std::byte>* file) const;

 private:
  struct Constant {
    std::string name;
    TensorRecord record;
    std::vector<std::byte> data;
  };

  std::deque<NetworkWriter> networks_;
  std::vector<Constant> constants_;
  std::map<std::string, std::string> metadata_;
  FileStatus status_ = FileStatus::kOk;
};

}  // namespace mien::formats
