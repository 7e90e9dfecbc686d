// Reads every byte of a view of a weight file.
#include "fuzz/read_all.h"

#include <algorithm>
#include <cstdlib>
#include <new>

#include "formats/mien_file.h"

namespace mien::fuzz {
namespace {

using formats::FileView;

void require(bool condition) {
  if (!condition) {
    std::abort();
  }
}

void read_networks(const FileView& view) {
  for (const auto& network : view.networks()) {
    require(view.find_network(view.text(network.name)) == &network);
    std::size_t value = 0;
    for (const auto& layer : view.layers(network)) {
      ++value;
      require(layer.input < value);
      for (const std::uint32_t tensor : {layer.weights, layer.bias, layer.slopes}) {
        require(tensor == formats::kNoIndex || tensor < view.tensors().size());
      }
    }
    for (std::uint32_t i = 0; i < network.output_count; ++i) {
      const std::uint32_t output = formats::output_value(network, i);
      require(output >= 1 && output <= value);
    }
  }
}

void read_tensors(const FileView& view) {
  std::size_t sum = 0;
  for (const auto& tensor : view.tensors()) {
    for (const std::byte one : view.data(tensor)) {
      sum += std::to_integer<std::size_t>(one);
    }
    const auto name = view.text(tensor.name);
    require(name.empty() || view.find_constant(name) == &tensor);
  }
  for (const auto& record : view.metadata()) {
    sum += view.text(record.key).size() + view.text(record.value).size();
  }
  require(view.file_bytes() == 0 || sum <= 255 * view.file_bytes());
}

}  // namespace

void read_all(std::span<const std::byte> file) {
  constexpr std::align_val_t kAlignment{formats::kFileAlignment};
  auto* copy =
      static_cast<std::byte*>(::operator new(std::max<std::size_t>(file.size(), 1), kAlignment));
  std::copy(file.begin(), file.end(), copy);
  FileView view;
  const mien_error_detail validation = formats::open({copy, file.size()}, view);
  require(validation.offset <= std::max<std::size_t>(file.size(), sizeof(formats::FileHeader)));
  require((validation.status == MIEN_OK) == !view.networks().empty());
  read_networks(view);
  read_tensors(view);
  ::operator delete(copy, kAlignment);
}

}  // namespace mien::fuzz
