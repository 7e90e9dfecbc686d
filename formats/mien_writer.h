// Writes .mien files, for tools and tests; not part of the library.
// apps/convert/mien_convert/weight_file.py writes the same bytes for the same input.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <vector>

#include "formats/mien_file.h"
#include "formats/mien_format.h"
#include "formats/mien_layers.h"
#include "formats/weight_packing.h"

namespace mien::formats {

// Floats in C order, as PyTorch lays out its parameters.
struct Array {
  std::vector<std::uint32_t> shape;
  std::vector<float> values;
};

// A value of a network: 0 is its input, k the output of its k-th layer.
using LayerIndex = std::uint32_t;

struct InputShape {
  std::uint32_t height, width, channels;
};

struct Padding {
  std::uint16_t top, left, bottom, right;
};

struct LayerOptions {
  LayerActivation activation = LayerActivation::kNone;
  float alpha = 0;            // kLeakyRelu and normalize only
  std::vector<float> slopes;  // kPrelu only, one per output channel
  std::uint16_t stride_y = 1;
  std::uint16_t stride_x = 1;
  Padding padding{};
  bool ceil_mode = false;  // max_pool only
  float input_bound = 0;   // pointwise only
};

class MienWriter;
struct FileSections;  // the sections of a file in progress

// Adds layers in sequence. Every function returns the value of the new layer. MienWriter::finish()
// reports inconsistent arguments. An empty bias stands for zeros.
class NetworkWriter {
 public:
  static constexpr LayerIndex kInput = 0;

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
  LayerIndex max_pool(LayerIndex x, std::uint32_t kernel_h, std::uint32_t kernel_w,
                      const LayerOptions& options = {});
  // a + the centre slice of b
  LayerIndex add(LayerIndex a, LayerIndex b, const LayerOptions& options = {});
  // mean over all pixels: [1, 1, c]
  LayerIndex global_average_pool(LayerIndex x, const LayerOptions& options = {});
  // the channels of a, then those of b
  LayerIndex concat(LayerIndex a, LayerIndex b, const LayerOptions& options = {});
  // `channels` channels from `first_channel` on, without the rows and columns of options.padding
  LayerIndex slice(LayerIndex x, std::uint16_t first_channel, std::uint32_t channels,
                   const LayerOptions& options = {});
  // a * b, a / b and a + b; each dimension of b is that of a or 1
  LayerIndex multiply(LayerIndex a, LayerIndex b, const LayerOptions& options = {});
  LayerIndex divide(LayerIndex a, LayerIndex b, const LayerOptions& options = {});
  LayerIndex broadcast_add(LayerIndex a, LayerIndex b, const LayerOptions& options = {});
  LayerIndex resize(LayerIndex x, std::uint32_t height, std::uint32_t width, ResizeGrid grid,
                    ResizeSampling sampling, const LayerOptions& options = {});
  // the elements of x, read in `order`, as a map of the given shape
  LayerIndex rearrange(LayerIndex x, ReadingOrder order, InputShape shape,
                       const LayerOptions& options = {});
  // mean 0 and variance 1 of the channels of each pixel; options.alpha is added to the variance
  LayerIndex normalize(LayerIndex x, const LayerOptions& options);
  LayerIndex activation(LayerIndex x, const LayerOptions& options);
  LayerIndex softmax(LayerIndex x, const LayerOptions& options = {});
  void output(LayerIndex x);

 private:
  friend class MienWriter;
  struct Tensor {
    TensorRecord record;
    std::vector<std::byte> data;
  };
  struct Layer {
    LayerRecord record;
    Tensor weights, bias, slopes;  // empty data: no such tensor
  };
  NetworkWriter(std::string name, InputShape input, bool any_size);

  ValueShape shape_of_value(LayerIndex value);
  Layer begin(LayerOp op, LayerIndex x, const LayerOptions& options);
  LayerIndex of_two(LayerOp op, LayerIndex a, LayerIndex b, const LayerOptions& options);
  static void set_window(LayerRecord* record, std::uint32_t kernel_h, std::uint32_t kernel_w,
                         const LayerOptions& options);
  LayerIndex dense(Layer layer, const Array& weight, const ReductionOrder& order,
                   const std::vector<float>& bias, const LayerOptions& options);
  LayerIndex append(Layer layer, const Halves& weights, std::vector<float> bias,
                    const LayerOptions& options);
  bool place(LayerRecord* record);
  Tensor tensor(const TensorDims& dims, const Halves& halves);
  bool require(bool condition, mien_status status);
  [[nodiscard]] bool uses(LayerIndex value) const;
  [[nodiscard]] mien_status status() const;

  std::string name_;
  NetworkRecord record_{};
  std::vector<LayerIndex> outputs_;
  std::vector<Layer> layers_;
  mien_status status_ = MIEN_OK;  // the first error
};

class MienWriter {
 public:
  // The reference stays valid until the writer is destroyed.
  NetworkWriter& network(std::string name, InputShape input, bool any_size = false);
  void constant(std::string name, const Array& array, DataType type = DataType::kFloat32);
  void metadata(const std::string& key, std::string value);

  // Returns the whole file, which is valid, on kOk; else `*file` is empty.
  [[nodiscard]] mien_error_detail finish(std::vector<std::byte>* file) const;

 private:
  struct Constant {
    std::string name;
    NetworkWriter::Tensor tensor;
  };

  mien_status add_networks(FileSections* sections) const;
  void add_tensors(FileSections* sections) const;

  std::deque<NetworkWriter> networks_;
  std::vector<Constant> constants_;
  std::map<std::string, std::string> metadata_;
  mien_status status_ = MIEN_OK;
};

}  // namespace mien::formats
