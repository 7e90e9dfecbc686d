// Counts the users of weights; the last release frees them.
#pragma once

#include <mien/mien.h>

namespace mien::tracker {

void acquire(const mien_weights& weights);
void release(const mien_weights& weights);

}  // namespace mien::tracker
