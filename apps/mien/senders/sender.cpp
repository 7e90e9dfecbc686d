// Selects the sender of a destination.
#include "apps/mien/senders/sender.h"

#include <array>
#include <string_view>

#include "apps/mien/senders/ifacialmocap_sender.h"
#include "apps/mien/senders/line_sender.h"
#include "apps/mien/senders/packet_sender.h"
#include "apps/mien/senders/vts_sender.h"

namespace mien::app {
namespace {

struct Scheme {
  std::string_view name;
  std::unique_ptr<Sender> (*open)(const Destination& destination);
};

constexpr std::array<Scheme, 8> kSchemes = {{{"vmc", vmc_sender},
                                             {"llf", live_link_sender},
                                             {"ifm", ifacialmocap_sender},
                                             {"osf", openseeface_sender},
                                             {"opentrack", opentrack_sender},
                                             {"vrchat", vrchat_sender},
                                             {"vts", vts_sender},
                                             {"jsonl", json_sender}}};

}  // namespace

std::unique_ptr<Sender> open_sender(const std::string& destination) {
  if (destination == "-") {
    return line_sender();
  }
  const Destination parsed = parse_destination(destination);
  std::string known;
  for (const Scheme& scheme : kSchemes) {
    if (scheme.name == parsed.scheme) {
      return scheme.open(parsed);
    }
    known.append(scheme.name).append("://, ");
  }
  parsed.fail("unknown protocol '" + parsed.scheme + "://', supported are " + known + "and -");
}

}  // namespace mien::app
