// Sends iFacialMocap packets.
#include "apps/mien/senders/ifacialmocap_sender.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "apps/mien/system/udp_socket.h"
#include "apps/protocols/ifacialmocap.h"

namespace mien::app {
namespace {

constexpr std::uint16_t kPort = 49983;
constexpr std::size_t kMaxReceivers = 8;
constexpr int kMaxHellosPerFrame = 64;       // others wait in the socket, or the system drops them
constexpr std::size_t kMaxHelloBytes = 256;  // enough to recognize a hello

struct Receiver {
  SocketAddress address;
  char separator;
};

class IfacialmocapSender : public Sender {
 public:
  IfacialmocapSender(const Destination& destination, std::optional<UdpSocket> extra_receiver,
                     std::optional<std::uint16_t> reply_port, bool reply_to_source)
      : Sender(destination.text),
        socket_(UdpSocket::at(destination.host.empty() ? kThisMachine : destination.host,
                              destination.port == 0 ? kPort : destination.port,
                              "--send " + destination.text)),
        extra_receiver_(std::move(extra_receiver)),
        reply_port_(reply_port),
        reply_to_source_(reply_to_source) {}

  bool send(const Outgoing& outgoing) override {
    take_hellos();
    bool all = true;
    if (extra_receiver_) {
      all = extra_receiver_->send(protocols::ifacialmocap_text(outgoing.frame, '-'));
    }
    for (const Receiver& receiver : receivers_) {
      all = socket_.send(protocols::ifacialmocap_text(outgoing.frame, receiver.separator),
                         receiver.address) &&
            all;
    }
    return all;
  }

  [[nodiscard]] std::string state() const override {
    return receivers_.empty() && !extra_receiver_
               ? "waiting for a hello"
               : std::to_string(receivers_.size() + (extra_receiver_ ? 1 : 0)) + " receivers";
  }

 private:
  void take_hellos() {
    for (int i = 0; i < kMaxHellosPerFrame; ++i) {
      const std::optional<Datagram> datagram = socket_.receive(kMaxHelloBytes);
      if (!datagram) {
        return;
      }
      if (const auto separator = protocols::ifacialmocap_separator(datagram->bytes)) {
        add_receiver({reply_address(datagram->from), *separator});
      }
    }
  }

  // The app replies to its own port number, whatever the source port. On one machine that port is
  // this socket's, so the reply goes to the source port.
  [[nodiscard]] SocketAddress reply_address(const SocketAddress& source) const {
    if (reply_to_source_ || (!reply_port_ && source.loopback())) {
      return source;
    }
    return source.with_port(reply_port_.value_or(kPort));
  }

  // The receiver with the latest hello is last. The first is removed when there are too many.
  void add_receiver(const Receiver& receiver) {
    std::erase_if(receivers_,
                  [&](const Receiver& known) { return known.address == receiver.address; });
    if (receivers_.size() == kMaxReceivers) {
      receivers_.erase(receivers_.begin());
    }
    receivers_.push_back(receiver);
  }

  UdpSocket socket_;
  std::optional<UdpSocket> extra_receiver_;
  std::optional<std::uint16_t> reply_port_;
  bool reply_to_source_;
  std::vector<Receiver> receivers_;
};

}  // namespace

std::unique_ptr<Sender> ifacialmocap_sender(const Destination& requested) {
  Destination destination = requested;
  const std::string to = destination.take("to", "");
  const std::string reply = destination.take("reply", "");
  destination.require_all_taken();
  std::optional<UdpSocket> extra_receiver;
  if (!to.empty()) {
    const Destination place = parse_destination("ifm://" + to);
    extra_receiver.emplace(UdpSocket::to(place.host.empty() ? kThisMachine : place.host,
                                         place.port == 0 ? kPort : place.port,
                                         "--send " + destination.text));
  }
  const bool to_source = reply == "source";
  std::optional<std::uint16_t> port;
  if (!reply.empty() && !to_source) {
    port = parse_port(reply, destination);
  }
  return std::make_unique<IfacialmocapSender>(destination, std::move(extra_receiver), port,
                                              to_source);
}

}  // namespace mien::app
