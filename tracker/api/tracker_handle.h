// The type behind the C API's mien_tracker.
#pragma once

#include <mien/mien.h>

#include <cstddef>

#include "tracker/detection/mtcnn_detector.h"
#include "tracker/faces/face.h"
#include "tracker/tracker.h"

struct mien_tracker {
  explicit mien_tracker(const mien_tracker_config& config)
      : tracker(config, encoders, proposal), allocator(config.allocator), weights(config.weights) {}

  mien::tracker::Encoders encoders;
  mien::tracker::MtcnnDetector proposal;
  mien::tracker::Tracker tracker;
  mien_allocator allocator;
  const mien_weights* weights;
  std::size_t bytes = 0;
  bool allocated = false;  // by the allocator; false: memory of the caller
};
