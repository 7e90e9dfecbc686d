#include "apps/mien/senders/line_sender.h"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include "apps/mien/outputs/output_file.h"
#include "formats/animation/frames_jsonl.h"

namespace mien::app {
namespace {

class LineSender : public Sender {
 public:
  LineSender() : Sender("-") {
#ifdef F_SETPIPE_SZ
    // A pipe holds 64 KB unless told otherwise, which is a second of lines that are late.
    constexpr int kLeastBytes = 8192;
    fcntl(STDOUT_FILENO, F_SETPIPE_SZ, kLeastBytes);
#endif
  }

  bool send(const Outgoing& outgoing) override {
    // A pipe that can be written to takes a page at once, which is more than a line has.
    pollfd room{STDOUT_FILENO, POLLOUT, 0};
    if (poll(&room, 1, 0) == 0) {
      return false;
    }
    write_standard_output(formats::frame_json(outgoing.frame) + "\n", wanted_);
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
