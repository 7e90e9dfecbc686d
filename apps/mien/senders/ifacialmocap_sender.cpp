#include "apps/mien/senders/ifacialmocap_sender.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "apps/mien/system/udp_socket.h"
#include "formats/protocols/ifacialmocap.h"

namespace mien::app {
namespace {

constexpr std::uint16_t kPort = 49983;
constexpr std::size_t kMaxReceivers = 8;
constexpr int kMaxHellosAFrame = 64;         // the others wait, or are thrown away by the system
constexpr std::size_t kMaxHelloBytes = 256;  // of a longer one we see that it is none

struct Receiver {
  UdpAddress address;
  char separator;
};

class IfacialmocapSender : public Sender {
 public:
  IfacialmocapSender(const Destination& destination, std::optional<UdpSocket> unasked,
                     std::optional<std::uint16_t> reply_port, bool reply_to_source)
      : Sender(destination.text),
        socket_(UdpSocket::at(destination.host.empty() ? "127.0.0.1" : destination.host,
                              destination.port == 0 ? kPort : destination.port,
                              "--send " + destination.text)),
        unasked_(std::move(unasked)),
        reply_port_(reply_port),
        reply_to_source_(reply_to_source) {}

  bool send(const Outgoing& outgoing) override {
    take_hellos();
    bool all = true;
    if (unasked_) {
      all = unasked_->send(formats::ifacialmocap_text(outgoing.frame, '-'));
    }
    for (const Receiver& receiver : receivers_) {
      all = socket_.send(formats::ifacialmocap_text(outgoing.frame, receiver.separator),
                         receiver.address) &&
            all;
    }
    return all;
  }

  [[nodiscard]] std::string state() const override {
    return receivers_.empty() && !unasked_
               ? "nobody has said hello yet"
               : std::to_string(receivers_.size() + (unasked_ ? 1 : 0)) + " receivers";
  }

 private:
  void take_hellos() {
    for (int i = 0; i < kMaxHellosAFrame; ++i) {
      const std::optional<Datagram> datagram = socket_.receive(kMaxHelloBytes);
      if (!datagram) {
        return;
      }
      if (const auto separator = formats::ifacialmocap_separator(datagram->bytes)) {
        welcome({answer_address(datagram->from), *separator});
      }
    }
  }

  // The app answers to its own port number wherever it was asked from. On one machine that number
  // is ours, so there we answer to where the hello came from.
  [[nodiscard]] UdpAddress answer_address(const UdpAddress& asked_from) const {
    if (reply_to_source_ || (!reply_port_ && asked_from.loopback())) {
      return asked_from;
    }
    return asked_from.with_port(reply_port_.value_or(kPort));
  }

  // Who said hello last is at the end; when there are too many, whoever is silent longest goes.
  void welcome(const Receiver& receiver) {
    std::erase_if(receivers_,
                  [&](const Receiver& known) { return known.address == receiver.address; });
    if (receivers_.size() == kMaxReceivers) {
      receivers_.erase(receivers_.begin());
    }
    receivers_.push_back(receiver);
  }

  UdpSocket socket_;
  std::optional<UdpSocket> unasked_;
  std::optional<std::uint16_t> reply_port_;
  bool reply_to_source_;
  std::vector<Receiver> receivers_;
};

}  // namespace

std::unique_ptr<Sender> ifacialmocap_sender(const Destination& asked_for) {
  Destination destination = asked_for;
  const std::string to = destination.take("to", "");
  const std::string reply = destination.take("reply", "");
  destination.require_all_taken();
  std::optional<UdpSocket> unasked;
  if (!to.empty()) {
    const Destination place = parse_destination("ifm://" + to);
    unasked.emplace(UdpSocket::to(place.host.empty() ? "127.0.0.1" : place.host,
                                  place.port == 0 ? kPort : place.port,
                                  "--send " + destination.text));
  }
  const bool to_source = reply == "source";
  std::optional<std::uint16_t> port;
  if (!reply.empty() && !to_source) {
    port = parse_port(reply, destination);
  }
  return std::make_unique<IfacialmocapSender>(destination, std::move(unasked), port, to_source);
}

}  // namespace mien::app
