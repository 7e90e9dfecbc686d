// Writes packets of frames, for decoders that share no code with the encoders.
// usage: protocol_packets PROTOCOL < FRAMES.jsonl
// Output per frame, little-endian: the number of packets, then for each its size and its bytes.
#include <cstdio>
#include <functional>
#include <iostream>
#include <iterator>
#include <map>
#include <string>
#include <vector>

#include "apps/animation/fault.h"
#include "apps/animation/frames_jsonl.h"
#include "apps/protocols/bytes.h"
#include "apps/protocols/ifacialmocap.h"
#include "apps/protocols/live_link.h"
#include "apps/protocols/openseeface.h"
#include "apps/protocols/opentrack.h"
#include "apps/protocols/vmc.h"
#include "apps/protocols/vrchat.h"
#include "apps/protocols/vts.h"

namespace {

using namespace mien;
using namespace mien::protocols;
using Packets = std::vector<std::string>;

double seconds(const animation::Frame& frame) { return static_cast<double>(frame.time_ns) * 1e-9; }

Packets vmc(const animation::Frame& frame) {
  std::vector<NamedValue> blends;
  for (std::size_t i = 0; i < formats::kControlCount; ++i) {
    blends.push_back({formats::kArkitNames[i], formats::or_zero(frame.controls[i])});
  }
  return vmc_packets(
      {seconds(frame), frame.state == animation::FaceState::kTracking, blends, frame.head});
}

Packets live_link(const animation::Frame& frame) {
  const LiveLinkSubject subject = {std::string(36, 'A'), "M\xc3\xbcller",
                                   animation::RotationUnit::kRadians};
  return {live_link_packet(frame, subject, seconds(frame))};
}

// Landmarks on a diagonal of the box.
Packets openseeface(const animation::Frame& frame) {
  const auto [x, y, width, height] = frame.box.value_or(std::array<double, 4>{});
  OpenSeeFaceImage image;
  image.width = 640;
  image.height = 480;
  image.focal_length_px = 500;
  for (std::size_t i = 0; i < image.landmarks.size(); ++i) {
    const double fraction = static_cast<double>(i) / 67.0;
    image.landmarks[i] = {x + fraction * width, y + (1.0 - fraction) * height};
  }
  image.pupils = {ImagePoint{x, y}, ImagePoint{x + width, y}};
  return {openseeface_packet(frame, image, seconds(frame))};
}

const std::map<std::string, std::function<Packets(const animation::Frame&)>> kProtocols = {
    {"vmc", vmc},
    {"llf", live_link},
    {"osf", openseeface},
    {"vrchat",
     [](const animation::Frame& frame) {
       return vrchat_packets(frame, {"FT/", true});
     }},
    {"vts",
     [](const animation::Frame& frame) {
       return Packets{vts_injection_request(frame, VtsControls().set())};
     }},
    {"ifm", [](const animation::Frame& frame) { return Packets{ifacialmocap_text(frame, '-')}; }},
    {"ifm2", [](const animation::Frame& frame) { return Packets{ifacialmocap_text(frame, '&')}; }},
    {"opentrack", [](const animation::Frame& frame) { return Packets{opentrack_packet(frame)}; }}};

}  // namespace

int main(int argc, char** argv) {
  const auto protocol = kProtocols.find(argc == 2 ? argv[1] : "");
  const std::string text{std::istreambuf_iterator<char>(std::cin), {}};
  animation::Clip clip;
  animation::Fault fault;
  if (protocol == kProtocols.end() || !animation::read_frames_jsonl(text, clip, fault)) {
    std::fprintf(stderr, "protocol_packets: %s\n", fault.what.c_str());
    return 2;
  }
  for (const animation::Frame& frame : clip.frames) {
    const Packets packets = protocol->second(frame);
    std::string out;
    append_little(out, static_cast<std::uint32_t>(packets.size()));
    for (const std::string& packet : packets) {
      append_little(out, static_cast<std::uint32_t>(packet.size()));
      out += packet;
    }
    std::fwrite(out.data(), 1, out.size(), stdout);
  }
  return 0;
}
