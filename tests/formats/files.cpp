// Reads, opens and describes weight files for tests.
#include "tests/formats/files.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <locale>
#include <new>
#include <sstream>

#include "formats/xxhash64.h"

namespace mien::formats {

AlignedBytes::AlignedBytes(std::span<const std::byte> bytes)
    : bytes_(static_cast<std::byte*>(
          ::operator new (std::max<std::size_t>(bytes.size(), 1), std::align_val_t{64}))),
      size_(bytes.size()) {
  std::copy(bytes.begin(), bytes.end(), bytes_);
}

AlignedBytes::~AlignedBytes() { ::operator delete (bytes_, std::align_val_t{64}); }

std::string name_of(const std::string& path) {
  return std::filesystem::path(path).filename().string();
}

std::string golden_folder() { return MIEN_SOURCE_DIR "/tests/golden/format/"; }

std::vector<std::byte> read_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  EXPECT_TRUE(in) << path;
  const std::vector<char> text{std::istreambuf_iterator<char>(in), {}};
  std::vector<std::byte> bytes(text.size());
  std::transform(text.begin(), text.end(), bytes.begin(), [](char c) { return std::byte(c); });
  return bytes;
}

std::vector<std::string> files_in(const std::string& folder, const std::string& ending) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ending) {
      names.push_back(entry.path().string());
    }
  }
  std::sort(names.begin(), names.end());
  return names;
}

void fix_checksum(std::span<std::byte> file) {
  constexpr std::size_t kAt = offsetof(FileHeader, checksum);
  const std::uint64_t checksum = xxhash64_with_hole(file, kAt);
  std::memcpy(file.data() + kAt, &checksum, sizeof checksum);
}

mien_error_detail open_copy(std::span<const std::byte> file) {
  AlignedBytes copy(file);
  FileView view;
  const mien_error_detail validation = open(copy.get(), view);
  if (validation.status == MIEN_OK) {
    EXPECT_FALSE(described(view).empty());
  } else {
    EXPECT_TRUE(view.networks().empty() && view.tensors().empty() && view.file_bytes() == 0);
  }
  return validation;
}

std::string status_name(std::int32_t status) {
  const std::pair<mien_status, const char*> names[] = {
      {MIEN_OK, "kOk"},
      {MIEN_ERROR_ALIGNMENT, "kMisaligned"},
      {MIEN_ERROR_WEIGHTS_TRUNCATED, "kTruncated"},
      {MIEN_ERROR_WEIGHTS_TRAILING_BYTES, "kTrailingBytes"},
      {MIEN_ERROR_WEIGHTS_NOT_MIEN, "kBadMagic"},
      {MIEN_ERROR_WEIGHTS_VERSION, "kUnsupportedVersion"},
      {MIEN_ERROR_WEIGHTS_BYTE_ORDER, "kWrongEndian"},
      {MIEN_ERROR_WEIGHTS_CHECKSUM, "kBadChecksum"},
      {MIEN_ERROR_WEIGHTS_LIMIT, "kLimitExceeded"},
      {MIEN_ERROR_WEIGHTS_RESERVED, "kReservedNotZero"},
      {MIEN_ERROR_WEIGHTS_GAP, "kHole"},
      {MIEN_ERROR_WEIGHTS_PADDING, "kPaddingNotZero"},
      {MIEN_ERROR_WEIGHTS_NAME, "kBadName"},
      {MIEN_ERROR_WEIGHTS_DUPLICATE_NAME, "kDuplicateName"},
      {MIEN_ERROR_WEIGHTS_METADATA, "kBadMetadata"},
      {MIEN_ERROR_WEIGHTS_TENSOR_TYPE, "kBadType"},
      {MIEN_ERROR_WEIGHTS_TENSOR_DIMS, "kBadDims"},
      {MIEN_ERROR_WEIGHTS_TENSOR_BYTES, "kBadTensorBytes"},
      {MIEN_ERROR_WEIGHTS_TENSOR_VALUE, "kNonFinite"},
      {MIEN_ERROR_WEIGHTS_NETWORK, "kBadNetwork"},
      {MIEN_ERROR_WEIGHTS_LAYER_OP, "kBadOp"},
      {MIEN_ERROR_WEIGHTS_LAYER_ACTIVATION, "kBadActivation"},
      {MIEN_ERROR_WEIGHTS_LAYER_INPUT, "kBadReference"},
      {MIEN_ERROR_WEIGHTS_LAYER_SHAPE, "kBadShape"},
      {MIEN_ERROR_WEIGHTS_LAYER_WINDOW, "kBadKernel"},
      {MIEN_ERROR_WEIGHTS_LAYER_TENSORS, "kBadTensor"},
      {MIEN_ERROR_WEIGHTS_TENSOR_UNUSED, "kUnusedTensor"},
  };
  return name_in(names, static_cast<mien_status>(status));
}

namespace {

void describe_network(const FileView& view, const NetworkRecord& network, std::ostream& out) {
  out << "network " << view.text(network.name) << ' ' << network.input_height << 'x'
      << network.input_width << 'x' << network.input_channels << " flags " << network.flags
      << " outputs";
  for (std::uint32_t i = 0; i < network.output_count; ++i) {
    out << ' ' << output_value(network, i);
  }
  out << '\n';
  for (const LayerRecord& layer : view.layers(network)) {
    out << "layer " << layer.op << " activation " << layer.activation << " inputs " << layer.input
        << ' ' << layer.second_input << " output " << layer.height << 'x' << layer.width << 'x'
        << layer.channels << '\n';
    for (const std::uint32_t index : {layer.weights, layer.bias, layer.slopes}) {
      EXPECT_TRUE(index == kNoIndex || !view.data(view.tensors()[index]).empty());
    }
  }
}

}  // namespace

std::string described(const FileView& view) {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  for (const NetworkRecord& network : view.networks()) {
    EXPECT_EQ(view.find_network(view.text(network.name)), &network);
    describe_network(view, network, out);
  }
  for (const TensorRecord& tensor : view.tensors()) {
    const std::string_view name = view.text(tensor.name);
    if (name.empty()) {
      continue;
    }
    EXPECT_EQ(view.find_constant(name), &tensor);
    EXPECT_EQ(view.data(tensor).size(), tensor.bytes);
    const bool half = tensor.type == static_cast<std::uint16_t>(DataType::kFloat16);
    out << "constant " << name << (half ? " fp16 " : " fp32 ");
    for (std::uint32_t i = 0; i < tensor.rank; ++i) {
      out << (i > 0 ? "x" : "") << tensor.dims[i];
    }
    out << '\n';
  }
  for (const MetadataRecord& record : view.metadata()) {
    out << "metadata " << view.text(record.key) << ' ' << view.text(record.value).size() << '\n';
  }
  return out.str();
}

std::string output_of(const std::string& command) {
  std::FILE* pipe = popen(command.c_str(), "r");
  std::string output;
  char part[4096];
  while (const std::size_t bytes = std::fread(part, 1, sizeof part, pipe)) {
    output.append(part, bytes);
  }
  EXPECT_EQ(pclose(pipe), 0) << command;
  return output;
}

}  // namespace mien::formats
