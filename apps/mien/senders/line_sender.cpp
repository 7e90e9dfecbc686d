// Sends JSON lines.
#include "apps/mien/senders/line_sender.h"

#include "apps/animation/frames_jsonl.h"
#include "apps/mien/outputs/output_file.h"
#include "apps/mien/system/standard_streams.h"

namespace mien::app {
namespace {

class LineSender : public Sender {
 public:
  LineSender() : Sender("-") { shorten_standard_output(); }

  bool send(const Outgoing& outgoing) override {
    if (!standard_output_is_writable()) {
      return false;
    }
    write_standard_output(animation::frame_json(outgoing.frame) + "\n", wanted_);
    write_standard_output("", wanted_);
    return wanted_;
  }

  [[nodiscard]] bool wanted() const override { return wanted_; }

 private:
  bool wanted_ = true;
};

}  // namespace

std::unique_ptr<Sender> line_sender() { return std::make_unique<LineSender>(); }

}  // namespace mien::app
