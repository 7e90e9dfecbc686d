// A program without weight files inside.
#include "apps/mien/networks/embedded_models.h"

namespace mien::app {

std::span<const EmbeddedModel> embedded_models() { return {}; }

}  // namespace mien::app
