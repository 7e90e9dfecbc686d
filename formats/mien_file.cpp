// Look-up by name.
#include "formats/mien_file.h"

namespace mien::formats {

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
