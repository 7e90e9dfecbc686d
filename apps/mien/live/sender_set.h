// The senders of a live run. Each can be paused.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "apps/mien/senders/sender.h"

namespace mien::app {

struct ReceiverState {
  std::string name;    // the destination, as given by the user
  std::string detail;  // may be empty
  bool paused = false;
};

class SenderSet {
 public:
  explicit SenderSet(const std::vector<std::string>& destinations);  // throws Failure

  // Returns the number of senders that dropped packets.
  std::uint64_t send(const Outgoing& outgoing);
  // Whether a sender still has a receiver, or there are no senders: the reader of a pipe may have
  // closed it.
  [[nodiscard]] bool wanted() const;
  // A paused sender sends nothing. Unknown numbers have no effect.
  void pause(std::size_t sender, bool paused);
  [[nodiscard]] std::vector<ReceiverState> states() const;

 private:
  struct Entry {
    std::unique_ptr<Sender> sender;
    bool paused = false;
  };
  std::vector<Entry> entries_;
};

}  // namespace mien::app
