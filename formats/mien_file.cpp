#include "formats/mien_file.h"

namespace mien::formats {
namespace {

struct Message {
  FileStatus status;
  const char* text;
};

constexpr Message kMessages[] = {
    {FileStatus::kOk, "ok"},
    {FileStatus::kMisaligned, "the file is not aligned to 64 bytes in memory"},
    {FileStatus::kTruncated, "the file is shorter than it says"},
    {FileStatus::kTrailingBytes, "there are bytes after the end of the file"},
    {FileStatus::kBadMagic, "not a .mien file"},
    {FileStatus::kUnsupportedVersion, "a version of the format that is not supported"},
    {FileStatus::kWrongEndian, "the file's byte order is not this machine's"},
    {FileStatus::kBadChecksum, "the checksum does not match: the file is damaged"},
    {FileStatus::kLimitExceeded, "a count or size exceeds the format's limits"},
    {FileStatus::kReservedNotZero, "a reserved field is not zero"},
    {FileStatus::kHole, "a section, string or tensor does not begin where the one before it ends"},
    {FileStatus::kPaddingNotZero, "padding bytes are not zero"},
    {FileStatus::kBadName, "a name is empty, too long, or has other characters than a-z 0-9 _ . /"},
    {FileStatus::kDuplicateName, "two networks, constants or metadata keys have the same name"},
    {FileStatus::kBadMetadata, "a metadata value is too long or not plain UTF-8 text"},
    {FileStatus::kBadType, "unknown data type"},
    {FileStatus::kBadDims, "rank or dimensions of a tensor are out of range"},
    {FileStatus::kBadTensorBytes, "a tensor's bytes are not its dimensions times its type's size"},
    {FileStatus::kNonFinite, "a tensor holds an infinity or a NaN"},
    {FileStatus::kBadNetwork, "a network's input, flags, layers or outputs are out of range"},
    {FileStatus::kBadOp, "unknown layer operation, or one that the network cannot have"},
    {FileStatus::kBadActivation, "unknown activation, or one the operation cannot have"},
    {FileStatus::kBadReference, "a layer refers to a value that is not before it"},
    {FileStatus::kBadShape, "a layer's output shape is not what its inputs make of it"},
    {FileStatus::kBadKernel, "kernel, stride, padding or flags of a layer are out of range"},
    {FileStatus::kBadTensor, "a layer's tensors are not those its operation asks for"},
    {FileStatus::kUnusedTensor, "a tensor belongs to no layer and has no name"},
};

}  // namespace

const char* message(FileStatus status) {
  for (const Message& known : kMessages) {
    if (known.status == status) {
      return known.text;
    }
  }
  return "unknown status";
}

const NetworkRecord* FileView::find_network(std::string_view name) const {
  for (const NetworkRecord& record : networks_) {
    if (text(record.name) == name) {
      return &record;
    }
  }
  return nullptr;
}

const TensorRecord* FileView::find_constant(std::string_view name) const {
  for (const TensorRecord& record : tensors_) {
    if (record.name.bytes != 0 && text(record.name) == name) {
      return &record;
    }
  }
  return nullptr;
}

}  // namespace mien::formats
