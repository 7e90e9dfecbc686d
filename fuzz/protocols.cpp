// The bytes are a datagram for the iFacialMocap sender, and a face that every protocol encodes. The
// packets are complete when parsed as receivers do.
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "apps/protocols/ifacialmocap.h"
#include "apps/protocols/live_link.h"
#include "apps/protocols/openseeface.h"
#include "apps/protocols/opentrack.h"
#include "apps/protocols/vmc.h"
#include "fuzz/bytes.h"
#include "fuzz/target.h"

namespace {

using mien::fuzz::Bytes;
using mien::fuzz::require;
namespace animation = mien::animation;
namespace formats = mien::formats;
namespace protocols = mien::protocols;

constexpr std::size_t kMaxBytes = 1500;  // maximum of a datagram, unless a single message is longer
constexpr std::size_t kValues = formats::kControlCount + formats::kRotationCount;

std::string_view name_of(Bytes& bytes) {
  const std::string_view text = bytes.text(bytes.between(0, 2000));
  return text.substr(0, text.find('\0'));
}

// 0..1, or unknown.
double control(Bytes& bytes) {
  const auto level = bytes.take<std::uint8_t>();
  return level == 255 ? formats::kNoNumber : level / 254.0;
}

// Up to a million, in steps of 1 / 2147.
double number(Bytes& bytes) { return bytes.take<std::int32_t>() / 2147.0; }

animation::Angles angles(Bytes& bytes) { return {number(bytes), number(bytes), number(bytes)}; }

animation::Frame frame_of(Bytes& bytes) {
  animation::Frame frame;
  frame.state = bytes.coin() ? animation::FaceState::kTracking : animation::FaceState::kLost;
  frame.face_id = bytes.take<std::int64_t>();
  frame.face_probability = control(bytes);
  if (bytes.coin()) {
    frame.head = angles(bytes);
  }
  if (bytes.coin()) {
    frame.position_m = {number(bytes), number(bytes), number(bytes)};
  }
  if (bytes.coin()) {
    frame.eyes = {angles(bytes), angles(bytes)};
  }
  for (double& value : frame.controls) {
    value = control(bytes);
  }
  return frame;
}

// Reads an OSC packet from its start.
class OscReader {
 public:
  explicit OscReader(std::string_view packet) : left_(packet) {}

  [[nodiscard]] bool empty() const { return left_.empty(); }

  std::string_view take(std::size_t count) {
    require(count <= left_.size());
    const std::string_view taken = left_.substr(0, count);
    left_.remove_prefix(count);
    return taken;
  }
  std::uint32_t big() {
    std::uint32_t value = 0;
    for (const char byte : take(4)) {
      value = value << 8 | static_cast<std::uint8_t>(byte);
    }
    return value;
  }
  std::string_view text() {
    const std::size_t length = left_.find('\0');
    require(length != std::string_view::npos);
    const std::string_view filled = take((length / 4 + 1) * 4);
    require(filled.find_first_not_of('\0', length) == std::string_view::npos);
    return filled.substr(0, length);
  }

 private:
  std::string_view left_;
};

void check_message(OscReader message) {
  require(message.text().starts_with("/VMC/Ext/"));
  const std::string_view tags = message.text();
  require(tags.starts_with(','));
  for (const char tag : tags.substr(1)) {
    if (tag == 's') {
      static_cast<void>(message.text());
    } else {
      require(tag == 'i' || tag == 'f');
      static_cast<void>(message.big());
    }
  }
  require(message.empty());
}

void check_vmc(const animation::Frame& frame, Bytes& bytes) {
  std::vector<protocols::NamedValue> blends(static_cast<std::size_t>(bytes.between(0, 60)));
  for (protocols::NamedValue& blend : blends) {
    blend = {name_of(bytes), control(bytes)};
  }
  std::size_t messages = 0;
  for (const std::string& packet :
       protocols::vmc_packets({number(bytes), bytes.coin(), blends, frame.head})) {
    OscReader bundle(packet);
    require(bundle.text() == "#bundle" && bundle.big() == 0 && bundle.big() == 1);
    const std::size_t before = messages;
    for (; !bundle.empty(); ++messages) {
      check_message(OscReader(bundle.take(bundle.big())));
    }
    require(packet.size() <= kMaxBytes || messages == before + 1);
  }
  require(messages == 3 + blends.size() + (frame.head ? 1 : 0));
}

void check_ifacialmocap(const animation::Frame& frame, std::string_view datagram) {
  const std::optional<char> separator = protocols::ifacialmocap_separator(datagram);
  const std::string hello(protocols::kIfacialmocapHello);
  require(separator.has_value() ==
          (datagram == hello || datagram == hello + "|sendDataVersion=v2"));
  const std::string text = protocols::ifacialmocap_text(frame, separator.value_or('-'));
  require(static_cast<std::size_t>(std::count(text.begin(), text.end(), '|')) ==
          formats::kControlCount + 3);
  require(text.find("nan") == std::string::npos && text.find("inf") == std::string::npos);
}

void check_openseeface(const animation::Frame& frame, Bytes& bytes) {
  protocols::OpenSeeFaceImage image{
      number(bytes), number(bytes), 1.0 + std::abs(number(bytes)), {}, {}};
  for (protocols::ImagePoint& point : image.landmarks) {
    point = {number(bytes), number(bytes)};
  }
  const std::string packet = protocols::openseeface_packet(frame, image, number(bytes));
  require(packet.size() == protocols::kOpenSeeFaceBytes);
}

void check_live_link(const animation::Frame& frame, Bytes& bytes) {
  const protocols::LiveLinkSubject subject{std::string(36, '0'), std::string(name_of(bytes))};
  const std::string packet = protocols::live_link_packet(frame, subject, number(bytes));
  const std::size_t head = 62 + subject.name.size(), values = kValues * sizeof(float);
  const bool nothing = animation::is_blank(frame);
  require(packet.size() == (nothing ? head : head + values));
  require(packet[head - 1] == (nothing ? 0 : static_cast<char>(kValues)));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Bytes bytes(data, size);
  const animation::Frame frame = frame_of(bytes);
  check_vmc(frame, bytes);
  check_openseeface(frame, bytes);
  check_live_link(frame, bytes);
  require(protocols::opentrack_packet(frame).size() == 6 * sizeof(double));
  check_ifacialmocap(frame, {reinterpret_cast<const char*>(data), size});
  return 0;
}
