// Encodes Open Sound Control.
#include "apps/protocols/osc.h"

#include "apps/protocols/bytes.h"

namespace mien::protocols {
namespace {

// Terminated by NUL and padded with NUL to a multiple of 4.
void append_string(std::string& packet, std::string_view text) {
  packet.append(text).append(4 - text.size() % 4, '\0');
}

struct AppendArgument {
  std::string& packet;
  void operator()(std::int32_t value) const {
    append_big(packet, static_cast<std::uint32_t>(value));
  }
  void operator()(float value) const { append_big_float(packet, double{value}); }
  void operator()(std::string_view value) const { append_string(packet, value); }
  void operator()(bool /*value*/) const {}  // the type tag is the value
};

char type_tag(const OscArgument& argument) {
  const bool* truth = std::get_if<bool>(&argument);
  return truth != nullptr ? (*truth ? 'T' : 'F') : "ifs"[argument.index()];
}

std::string empty_bundle() {
  std::string bundle;
  append_string(bundle, "#bundle");
  append_big(bundle, std::uint64_t{1});  // the time tag for "immediately"
  return bundle;
}

}  // namespace

std::string osc_message(std::string_view address, std::span<const OscArgument> arguments) {
  std::string message;
  append_string(message, address);
  std::string tags = ",";
  for (const OscArgument& argument : arguments) {
    tags += type_tag(argument);
  }
  append_string(message, tags);
  for (const OscArgument& argument : arguments) {
    std::visit(AppendArgument{message}, argument);
  }
  return message;
}

std::vector<std::string> osc_bundles(std::span<const std::string> messages, std::size_t max_bytes) {
  const std::string empty = empty_bundle();
  std::vector<std::string> bundles;
  for (const std::string& message : messages) {
    const std::size_t bytes = sizeof(std::uint32_t) + message.size();
    if (bundles.empty() ||
        (bundles.back().size() + bytes > max_bytes && bundles.back().size() > empty.size())) {
      bundles.push_back(empty);
    }
    append_big(bundles.back(), static_cast<std::uint32_t>(message.size()));
    bundles.back() += message;
  }
  return bundles;
}

}  // namespace mien::protocols
