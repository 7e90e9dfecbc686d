// An interface for sending the results of live tracking. Packets that cannot be sent at once are
// dropped, because late packets are useless.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "apps/animation/clip.h"
#include "apps/protocols/openseeface.h"

namespace mien::app {

// A frame to send.
struct Outgoing {
  animation::Frame frame;             // of a lost face: held, then eased to rest
  protocols::OpenSeeFaceImage image;  // valid only in the state tracking
  double since_start_s = 0.0;
  double unix_time_s = 0.0;
  double time_of_day_s = 0.0;  // local time
};

class Sender {
 public:
  explicit Sender(std::string name) : name_(std::move(name)) {}
  virtual ~Sender() = default;
  Sender(const Sender&) = delete;
  Sender& operator=(const Sender&) = delete;

  // Returns false if packets were dropped. Throws Failure(kExitOutput) if sending has become
  // impossible.
  virtual bool send(const Outgoing& outgoing) = 0;

  // False after the reader has closed.
  [[nodiscard]] virtual bool wanted() const { return true; }
  // A line for the screen about the receivers; may be empty.
  [[nodiscard]] virtual std::string state() const { return {}; }
  [[nodiscard]] const std::string& name() const { return name_; }  // as given by the user

 private:
  std::string name_;
};

// Opens the destination of --send: a URL, or "-" for JSON lines on standard output. Throws Failure.
std::unique_ptr<Sender> open_sender(const std::string& destination);

}  // namespace mien::app
