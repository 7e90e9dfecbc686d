// Sends VMC, Live Link, OpenSeeFace, OpenTrack, VRChat and JSON packets.
#include "apps/mien/senders/packet_sender.h"

#include <utility>
#include <vector>

#include "apps/animation/frames_jsonl.h"
#include "apps/mien/senders/blend_names.h"
#include "apps/mien/system/udp_socket.h"
#include "apps/protocols/live_link.h"
#include "apps/protocols/opentrack.h"
#include "apps/protocols/vmc.h"
#include "apps/protocols/vrchat.h"

namespace mien::app {
namespace {

// `Packets` creates the datagrams of a frame.
template <class Packets>
class PacketSender : public Sender {
 public:
  PacketSender(const Destination& destination, std::uint16_t default_port, Packets packets)
      : Sender(destination.text),
        socket_(UdpSocket::to(destination.host.empty() ? kThisMachine : destination.host,
                              destination.port == 0 ? default_port : destination.port,
                              "--send " + destination.text)),
        packets_(std::move(packets)) {}

  bool send(const Outgoing& outgoing) override {
    bool all = true;
    for (const std::string& packet : packets_(outgoing)) {
      all = socket_.send(packet) && all;
    }
    return all;
  }

 private:
  UdpSocket socket_;
  Packets packets_;
};

template <class Packets>
std::unique_ptr<Sender> sender(const Destination& destination, std::uint16_t default_port,
                               Packets packets) {
  destination.require_all_taken();
  return std::make_unique<PacketSender<Packets>>(destination, default_port, std::move(packets));
}

using Datagrams = std::vector<std::string>;

animation::RotationUnit rotation_unit(const std::string& name, const Destination& destination) {
  using animation::RotationUnit;
  if (name == "rad" || name == "norm180" || name == "deg") {
    return name == "rad"   ? RotationUnit::kRadians
           : name == "deg" ? RotationUnit::kDegrees
                           : RotationUnit::kDegreesBy180;
  }
  destination.fail("rot: expected rad, norm180 or deg (got '" + name + "')");
}

}  // namespace

std::unique_ptr<Sender> vmc_sender(const Destination& requested) {
  Destination destination = requested;
  constexpr std::uint16_t kMarionette = 39539;
  BlendNames names(destination.take("names", "vrm0,pascal"), destination);
  return sender(
      destination, kMarionette, [names = std::move(names)](const Outgoing& outgoing) mutable {
        return protocols::vmc_packets({outgoing.since_start_s,
                                       outgoing.frame.state == animation::FaceState::kTracking,
                                       names.values(outgoing.frame), outgoing.frame.head});
      });
}

std::unique_ptr<Sender> live_link_sender(const Destination& requested) {
  Destination destination = requested;
  constexpr std::uint16_t kLiveLinkFace = 11111;
  // Unreal distinguishes devices by this id; each machine is one device.
  protocols::LiveLinkSubject subject{destination.take("id", "6D69656E-0000-4000-8000-000000000001"),
                                     destination.take("subject", "mien"),
                                     {}};
  if (subject.device_id.size() != 36) {
    destination.fail("id: expected a UUID of 36 characters (got '" + subject.device_id + "')");
  }
  subject.rotation = rotation_unit(destination.take("rot", "rad"), destination);
  return sender(destination, kLiveLinkFace, [subject](const Outgoing& outgoing) {
    return Datagrams{protocols::live_link_packet(outgoing.frame, subject, outgoing.time_of_day_s)};
  });
}

// OpenSeeFace receivers detect a lost face by missing packets, and ease by themselves.
std::unique_ptr<Sender> openseeface_sender(const Destination& destination) {
  constexpr std::uint16_t kOpenSeeFace = 11573;
  return sender(destination, kOpenSeeFace, [](const Outgoing& outgoing) {
    if (outgoing.frame.state != animation::FaceState::kTracking) {
      return Datagrams();
    }
    return Datagrams{
        protocols::openseeface_packet(outgoing.frame, outgoing.image, outgoing.unix_time_s)};
  });
}

std::unique_ptr<Sender> opentrack_sender(const Destination& destination) {
  constexpr std::uint16_t kOpentrack = 4242;
  return sender(destination, kOpentrack, [](const Outgoing& outgoing) {
    // Before the first face the pose is unknown, which differs from a head at the camera.
    return outgoing.frame.head ? Datagrams{protocols::opentrack_packet(outgoing.frame)}
                               : Datagrams();
  });
}

std::unique_ptr<Sender> vrchat_sender(const Destination& requested) {
  Destination destination = requested;
  constexpr std::uint16_t kVrchat = 9000;
  constexpr std::string_view kReserved = " #*,?[]{}";  // in OSC addresses
  protocols::VrchatOptions options{destination.take("prefix", "")};
  const std::string eyes = destination.take("eyes", "native");
  if (options.prefix.find_first_of(kReserved) != std::string::npos) {
    destination.fail("prefix: contains a character that OSC reserves (got '" + options.prefix +
                     "')");
  }
  if (eyes != "native" && eyes != "none") {
    destination.fail("eyes: expected native or none (got '" + eyes + "')");
  }
  options.native_eyes = eyes == "native";
  if (!options.prefix.empty() && !options.prefix.ends_with('/')) {
    options.prefix += '/';
  }
  return sender(destination, kVrchat, [options](const Outgoing& outgoing) {
    return protocols::vrchat_packets(outgoing.frame, options);
  });
}

std::unique_ptr<Sender> json_sender(const Destination& destination) {
  if (destination.port == 0) {
    destination.fail("expected a port");
  }
  return sender(destination, destination.port, [](const Outgoing& outgoing) {
    return Datagrams{animation::frame_json(outgoing.frame)};
  });
}

}  // namespace mien::app
