// Results of a live face go out, each frame as it is there. What cannot go at once is dropped:
// nothing that is late is any use.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "formats/animation/clip.h"
#include "formats/protocols/openseeface.h"

namespace mien::app {

// A frame as it is sent.
struct Outgoing {
  formats::Frame frame;                 // of a lost face held, then eased to rest
  formats::OpenSeeFacePicture picture;  // meaningful while the frame's state is tracking
  double since_start_s = 0.0;
  double unix_time_s = 0.0;
  double time_of_day_s = 0.0;  // local
};

class Sender {
 public:
  explicit Sender(std::string name) : name_(std::move(name)) {}
  virtual ~Sender() = default;
  Sender(const Sender&) = delete;
  Sender& operator=(const Sender&) = delete;

  // False where something of it was dropped. Throws Failure(kExitOutput) when there is no more use
  // in sending.
  virtual bool send(const Outgoing& outgoing) = 0;

  // False once nobody takes it any more.
  [[nodiscard]] virtual bool wanted() const { return true; }
  // A line for the screen about who takes it; empty: nothing to say.
  [[nodiscard]] virtual std::string state() const { return {}; }
  [[nodiscard]] const std::string& name() const { return name_; }  // as it was asked for

 private:
  std::string name_;
};

// What --send names: a URL, or "-" for JSON lines on standard output. Throws Failure.
std::unique_ptr<Sender> open_sender(const std::string& destination);

}  // namespace mien::app
