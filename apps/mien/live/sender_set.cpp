// Sends a frame to all destinations.
#include "apps/mien/live/sender_set.h"

#include <algorithm>

namespace mien::app {

SenderSet::SenderSet(const std::vector<std::string>& destinations) {
  for (const std::string& destination : destinations) {
    entries_.push_back({open_sender(destination)});
  }
}

std::uint64_t SenderSet::send(const Outgoing& outgoing) {
  std::uint64_t dropped = 0;
  for (const Entry& entry : entries_) {
    dropped += entry.paused || entry.sender->send(outgoing) ? 0 : 1;
  }
  return dropped;
}

bool SenderSet::wanted() const {
  return entries_.empty() || std::any_of(entries_.begin(), entries_.end(),
                                         [](const Entry& entry) { return entry.sender->wanted(); });
}

void SenderSet::pause(std::size_t sender, bool paused) {
  if (sender < entries_.size()) {
    entries_[sender].paused = paused;
  }
}

std::vector<ReceiverState> SenderSet::states() const {
  std::vector<ReceiverState> states;
  for (const Entry& entry : entries_) {
    states.push_back({entry.sender->name(), entry.sender->state(), entry.paused});
  }
  return states;
}

}  // namespace mien::app
